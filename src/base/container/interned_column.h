// InternedColumn<T>: a column that stores equal records once, such as the masses of a thousand equal boxes; each
// element costs the four bytes of an index. It reads like an array; set() writes.
//
// Records are equal if interning_key(record) is: an array of words, without padding, that is the same only for the same
// records. The order of stored records is a function of the calls alone, and nothing can visit it.
#pragma once

#include "base/container/array.h"
#include "base/container/slot_table.h"
#include "base/hash.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace gyre {

template <class T>
class InternedColumn {
 public:
  std::size_t size() const { return indices_.size(); }
  std::size_t bytes() const {
    return indices_.bytes() + records_.bytes() + keys_.bytes() + users_.bytes() + free_.bytes() +
           table_.bytes();
  }
  // The number of different records.
  std::size_t distinct() const { return table_.size(); }

  // Valid until the next set() or resize().
  template <class Index>
  const T& operator[](Index i) const {
    return records_[indices_[i]];
  }
  template <class Index>
  void set(Index i, const T& record) {
    const std::uint32_t index = acquire(record);
    release(indices_[i]);
    indices_[i] = index;
  }
  // New elements are as T().
  void resize(std::size_t count) {
    while (indices_.size() > count) {
      release(indices_.back());
      indices_.pop_back();
    }
    if (indices_.size() == count) return;
    const std::uint32_t index = acquire(T());
    users_[index] += static_cast<std::uint32_t>(count - indices_.size()) - 1;
    indices_.resize(count, index);
  }

  // For loops over the storage: element i is records()[indices()[i]].
  const T* records() const { return records_.data(); }
  const std::uint32_t* indices() const { return indices_.data(); }

 private:
  // The index of a record, which gets one user more.
  std::uint32_t acquire(const T& record) {
    const auto bits = interning_key(record);
    std::uint64_t key = hash_bytes(bits.data(), sizeof bits);
    const auto key_of = [this](std::uint32_t index) { return keys_[index]; };
    std::uint32_t index = table_.find(key, key_of);
    // A different record with the same hash uses the next key.
    while (index != SlotTable::kNone && interning_key(records_[index]) != bits)
      index = table_.find(++key, key_of);
    if (index == SlotTable::kNone) {
      index = make_record();
      records_[index] = record;
      keys_[index] = key;
      users_[index] = 0;
      table_.insert(key, index, key_of);
    }
    ++users_[index];
    return index;
  }

  void release(std::uint32_t index) {
    if (--users_[index] > 0) return;
    table_.erase(keys_[index], [this](std::uint32_t other) { return keys_[other]; });
    free_.push_back(index);
  }

  std::uint32_t make_record() {
    if (!free_.empty()) {
      const std::uint32_t index = free_.back();
      free_.pop_back();
      return index;
    }
    records_.emplace_back();
    keys_.push_back(0);
    users_.push_back(0);
    return static_cast<std::uint32_t>(records_.size() - 1);
  }

  Array<std::uint32_t> indices_;  // by element
  Array<T> records_;
  Array<std::uint64_t> keys_;   // by record: its hash, or the next free key
  Array<std::uint32_t> users_;  // by record
  Array<std::uint32_t> free_;   // records without users
  SlotTable table_;
};

// Helper for interning_key: the words of fields without padding, one after the other.
template <class... Fields>
auto words_of(const Fields&... fields) {
  constexpr std::size_t kBytes = (sizeof(Fields) + ...);
  static_assert(((sizeof(Fields) % 4 == 0) && ...), "fields are whole words");
  std::array<std::uint32_t, kBytes / 4> words;
  std::size_t at = 0;
  ((std::memcpy(reinterpret_cast<std::byte*>(words.data()) + at, &fields, sizeof(Fields)),
    at += sizeof(Fields)),
   ...);
  return words;
}

}  // namespace gyre
