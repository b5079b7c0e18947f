// Bytes between the ranks of MPI. All functions are collective: every rank calls them in the same order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace gyre {

// Records in a row, to be read in the same order.
class Packet {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, bytes_.data() + read_, sizeof value);
    read_ += sizeof value;
    return value;
  }
  bool at_end() const { return read_ >= bytes_.size(); }
  void clear() { bytes_.clear(), read_ = 0; }
  std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t read_ = 0;
};

class Transport {
 public:
  Transport();
  int rank() const { return rank_; }
  int size() const { return size_; }
  // Sends out[r] to rank r, and returns what rank r sent to this one as element r. `out` is empty afterwards.
  std::vector<Packet>& exchange(std::vector<Packet>& out);
  double sum(double value) const;
  double max(double value) const;
  std::uint64_t bytes_sent() const { return bytes_sent_; }  // to other ranks, so far
  std::uint64_t messages_sent() const { return messages_sent_; }

 private:
  int rank_ = 0, size_ = 1;
  std::uint64_t bytes_sent_ = 0, messages_sent_ = 0;
  std::vector<Packet> in_;
  std::vector<int> counts_out_, counts_in_;
};

}  // namespace gyre
