// Bitset: one bit for each id, visited in ascending order. Workers set bits in bitsets of their own, which are united
// and then visited, so the order of events never depends on the workers.
#pragma once

#include "base/container/array.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

class Bitset {
 public:
  Bitset() = default;
  explicit Bitset(std::size_t size) { resize(size); }

  std::size_t size() const { return size_; }

  // New bits are clear; those beyond the new size are dropped.
  void resize(std::size_t size) {
    words_.resize((size + 63) / 64);
    if (size < size_ && size % 64 != 0) words_.back() &= (std::uint64_t{1} << size % 64) - 1;
    size_ = size;
  }

  void set(std::size_t i) {
    GYRE_ASSERT(i < size_, "bit is inside the set");
    words_[i / 64] |= std::uint64_t{1} << i % 64;
  }
  void clear(std::size_t i) {
    GYRE_ASSERT(i < size_, "bit is inside the set");
    words_[i / 64] &= ~(std::uint64_t{1} << i % 64);
  }
  void assign(std::size_t i, bool value) { value ? set(i) : clear(i); }
  // False beyond the size, so that a set need not grow before a test.
  bool test(std::size_t i) const { return i < size_ && (words_[i / 64] >> i % 64 & 1) != 0; }

  // Bits 64 * word to 64 * word + 63 at once; those beyond the size must be clear. Workers may write different words at
  // once.
  void put_word(std::size_t word, std::uint64_t bits) { words_[word] = bits; }

  // Sets all bits up to the size.
  void set_all() {
    for (std::uint64_t& word : words_) word = ~std::uint64_t{0};
    if (size_ % 64 != 0) words_.back() = (std::uint64_t{1} << size_ % 64) - 1;
  }
  // Clears all bits; the size stays.
  void reset_all() {
    for (std::uint64_t& word : words_) word = 0;
  }

  // Adds all bits of `other`; grows to its size if that is larger.
  void unite(const Bitset& other) {
    if (other.size_ > size_) resize(other.size_);
    for (std::size_t w = 0; w < other.words_.size(); ++w) words_[w] |= other.words_[w];
  }

  std::size_t count() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
  }
  bool any() const {
    for (const std::uint64_t word : words_) {
      if (word != 0) return true;
    }
    return false;
  }

  // The first set bit at or after `from`; size() when there is none.
  std::size_t find_next(std::size_t from) const {
    if (from >= size_) return size_;
    std::size_t w = from / 64;
    std::uint64_t word = words_[w] & ~std::uint64_t{0} << from % 64;
    while (word == 0) {
      if (++w == words_.size()) return size_;
      word = words_[w];
    }
    return w * 64 + static_cast<std::size_t>(std::countr_zero(word));
  }

  // Calls fn(std::size_t) for each set bit, ascending. fn may set and clear bits up to its own; later changes may or
  // may not be seen.
  template <class Fn>
  void for_each_set(Fn&& fn) const {
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t word = words_[w]; word != 0; word &= word - 1) {
        fn(w * 64 + static_cast<std::size_t>(std::countr_zero(word)));
      }
    }
  }

  // The bits, 64 to a word from the lowest up; those beyond size() are clear. For snapshots and hashes.
  std::span<const std::uint64_t> words() const { return words_; }
  std::size_t bytes() const { return words_.bytes(); }

  friend bool operator==(const Bitset& a, const Bitset& b) {
    return a.size_ == b.size_ && a.words_ == b.words_;
  }

 private:
  Array<std::uint64_t> words_;
  std::size_t size_ = 0;
};

}  // namespace gyre
