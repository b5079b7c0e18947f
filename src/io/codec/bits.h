// Numbers of any number of bits in sequence, the lowest bit of a number and of a byte first. Writer and reader have
// the same calls, which take their value by reference: the writer reads it, the reader sets it. A code that is one
// template over both cannot disagree with itself.
//
// The reader accepts any bytes: past their end it returns zeros and stays failed.
#pragma once

#include "io/codec/bytes.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gyre {

class BitWriter {
 public:
  static constexpr bool kReads = false;

  // Appends the lowest `count` bits of `value`, which has no others; count is 0 to 64.
  void code_bits(const std::uint64_t& value, int count) {
    if (count > 32) {
      put(value & 0xffffffffu, 32);
      put(value >> 32, count - 32);
    } else {
      put(value, count);
    }
  }
  // The number of bits written.
  std::size_t size() const { return 8 * used_ + std::size_t(filled_); }
  // Pads the last byte with zeros and returns all bytes; the writer is empty again.
  std::vector<std::byte> take() {
    const std::size_t size = used_ + (std::size_t(filled_) + 7) / 8;
    spill();
    bytes_.resize(size);
    word_ = 0;
    filled_ = 0;
    used_ = 0;
    return std::exchange(bytes_, {});
  }
  bool failed() const { return false; }

 private:
  void put(std::uint64_t value, int count) {
    word_ |= value << filled_;
    filled_ += count;
    if (filled_ < 32) return;
    spill();
    used_ += 4;
    word_ >>= 32;
    filled_ -= 32;
  }
  // Stores four bytes of the word at the end of the data.
  void spill() {
    constexpr std::size_t kMinRoom = 256;
    if (used_ + 4 > bytes_.size()) bytes_.resize(2 * used_ + kMinRoom);
    store_little(bytes_.data() + used_, std::uint32_t(word_));
  }

  std::vector<std::byte> bytes_;  // with spare room at the end
  std::size_t used_ = 0;
  std::uint64_t word_ = 0;
  int filled_ = 0;  // bits of `word_` in use, fewer than 32 between calls
};

class BitReader {
 public:
  static constexpr bool kReads = true;

  explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  void code_bits(std::uint64_t& value, int count) {
    if (count > 32) {
      const std::uint64_t low = get(32);
      value = get(count - 32) << 32 | low;
    } else {
      value = get(count);
    }
  }
  void fail() { failed_ = true; }
  bool failed() const { return failed_; }
  // True if nothing failed and only the zeros remain that pad the last byte.
  bool finished() const { return !failed_ && offset_ == bytes_.size() && filled_ < 8 && word_ == 0; }
  // An upper bound of the remaining bits.
  std::uint64_t left() const {
    return failed_ ? 0 : 8 * std::uint64_t(bytes_.size() - offset_) + std::uint64_t(filled_);
  }

 private:
  std::uint64_t get(int count) {
    for (; filled_ < count; filled_ += 8) {
      if (offset_ == bytes_.size()) {
        failed_ = true;
        return 0;
      }
      word_ |= std::uint64_t(bytes_[offset_++]) << filled_;
    }
    const std::uint64_t value = word_ & ((std::uint64_t(1) << count) - 1);
    word_ >>= count;
    filled_ -= count;
    return value;
  }

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  std::uint64_t word_ = 0;
  int filled_ = 0;  // bits of `word_` not yet returned
  bool failed_ = false;
};

// Codes a number of which small values are likely: Exp-Golomb code of order `order` (value below 2^62). With v =
// value + 2^order and n the bits of v: n - 1 - order zeros, a one, and the n - 1 bits of v below its highest. J.
// Teuhola, "A compression method for clustered bit-vectors", 1978.
template <class Bits>
void code_count(Bits& bits, std::uint64_t& value, int order) {
  constexpr int kMaxBits = 62;
  const std::uint64_t shifted = value + (std::uint64_t(1) << order);
  int extra = Bits::kReads ? 0 : int(std::bit_width(shifted)) - 1 - order;
  for (int zeros = 0;; ++zeros) {
    std::uint64_t end_bit = zeros == extra;
    bits.code_bits(end_bit, 1);
    if constexpr (Bits::kReads) extra = end_bit ? zeros : zeros + 1;
    if (end_bit) break;
    if (bits.failed() || order + zeros >= kMaxBits) {
      if constexpr (Bits::kReads) bits.fail();
      value = 0;
      return;
    }
  }
  std::uint64_t low = shifted & ((std::uint64_t(1) << (order + extra)) - 1);
  bits.code_bits(low, order + extra);
  if constexpr (Bits::kReads)
    value = (low | std::uint64_t(1) << (order + extra)) - (std::uint64_t(1) << order);
}

// Maps signed numbers to unsigned ones: 0, -1, 1, -2, 2 ... become 0, 1, 2, 3, 4 ...
constexpr std::uint64_t fold_sign(std::int64_t value) {
  return std::uint64_t(value) << 1 ^ std::uint64_t(value >> 63);
}
constexpr std::int64_t unfold_sign(std::uint64_t folded) {
  return std::int64_t(folded >> 1) ^ -std::int64_t(folded & 1);
}

}  // namespace gyre
