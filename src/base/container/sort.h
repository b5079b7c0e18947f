// Sorts whose order of equal items is the same with every standard library: radix sort (least significant byte first;
// bytes that are the same in all keys are skipped) for integer keys, merge sort for all else. Both are stable. The
// caller provides the scratch memory, at least as many elements as there are items.
#pragma once

#include "base/check.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace gyre {

namespace sort_detail {

// Below this, insertion sort is faster.
constexpr std::size_t kFewKeys = 48;
constexpr std::size_t kRun = 16;

// The number of occurrences of each value of each byte.
struct ByteCounts {
  std::uint32_t count[8][256];

  explicit ByteCounts(std::span<const std::uint64_t> keys) : count{} {
    for (const std::uint64_t key : keys) {
      for (int byte = 0; byte < 8; ++byte) ++count[byte][key >> 8 * byte & 0xff];
    }
  }

  // Turns the counts of one byte into the start of each value. False if all keys have the same value there.
  bool make_starts(int byte, std::uint64_t any_key, std::size_t total) {
    std::uint32_t* const counts = count[byte];
    if (counts[any_key >> 8 * byte & 0xff] == total) return false;
    std::uint32_t start = 0;
    for (int value = 0; value < 256; ++value) start += std::exchange(counts[value], start);
    return true;
  }
};

template <class T, class Less>
void insertion_sort(T* items, std::size_t count, const Less& less) {
  for (std::size_t i = 1; i < count; ++i) {
    if (!less(items[i], items[i - 1])) continue;
    T item = std::move(items[i]);
    std::size_t k = i;
    do {
      items[k] = std::move(items[k - 1]);
      --k;
    } while (k > 0 && less(item, items[k - 1]));
    items[k] = std::move(item);
  }
}

// Merges two sorted neighbours, [begin, middle) and [middle, end), into the same range of `to`.
template <class T, class Less>
void merge(T* from, T* to, std::size_t begin, std::size_t middle, std::size_t end, const Less& less) {
  std::size_t left = begin;
  std::size_t right = middle;
  for (std::size_t out = begin; out < end; ++out) {
    const bool take_right = left == middle || (right < end && less(from[right], from[left]));
    to[out] = std::move(from[take_right ? right++ : left++]);
  }
}

}  // namespace sort_detail

// Sorts keys ascending.
inline void radix_sort_u64(std::span<std::uint64_t> keys, std::span<std::uint64_t> scratch) {
  using namespace sort_detail;
  const std::size_t count = keys.size();
  GYRE_ASSERT(scratch.size() >= count && count <= UINT32_MAX, "scratch has room for all keys");
  if (count < kFewKeys) {
    insertion_sort(keys.data(), count, [](std::uint64_t a, std::uint64_t b) { return a < b; });
    return;
  }
  ByteCounts counts(keys);
  std::uint64_t* from = keys.data();
  std::uint64_t* to = scratch.data();
  for (int byte = 0; byte < 8; ++byte) {
    if (!counts.make_starts(byte, from[0], count)) continue;
    std::uint32_t* const next = counts.count[byte];
    for (std::size_t i = 0; i < count; ++i) to[next[from[i] >> 8 * byte & 0xff]++] = from[i];
    std::swap(from, to);
  }
  if (from == keys.data()) return;
  for (std::size_t i = 0; i < count; ++i) keys[i] = from[i];
}

// Sorts keys ascending together with their values; equal keys keep their order.
inline void radix_sort_pairs(std::span<std::uint64_t> keys, std::span<std::uint32_t> values,
                             std::span<std::uint64_t> scratch_keys, std::span<std::uint32_t> scratch_values) {
  using namespace sort_detail;
  const std::size_t count = keys.size();
  GYRE_ASSERT(values.size() == count && count <= UINT32_MAX, "each key has one value");
  GYRE_ASSERT(scratch_keys.size() >= count && scratch_values.size() >= count,
              "scratch has room for all pairs");
  if (count < 2) return;
  ByteCounts counts(keys);
  std::uint64_t* from = keys.data();
  std::uint64_t* to = scratch_keys.data();
  std::uint32_t* from_values = values.data();
  std::uint32_t* to_values = scratch_values.data();
  for (int byte = 0; byte < 8; ++byte) {
    if (!counts.make_starts(byte, from[0], count)) continue;
    std::uint32_t* const next = counts.count[byte];
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t index = next[from[i] >> 8 * byte & 0xff]++;
      to[index] = from[i];
      to_values[index] = from_values[i];
    }
    std::swap(from, to);
    std::swap(from_values, to_values);
  }
  if (from == keys.data()) return;
  for (std::size_t i = 0; i < count; ++i) {
    keys[i] = from[i];
    values[i] = from_values[i];
  }
}

// Sorts by less(a, b), a strict weak order; items that are equal by it keep their order.
template <class T, class Less>
void merge_sort(std::span<T> items, std::span<T> scratch, const Less& less) {
  using namespace sort_detail;
  const std::size_t count = items.size();
  for (std::size_t begin = 0; begin < count; begin += kRun) {
    insertion_sort(items.data() + begin, count - begin < kRun ? count - begin : kRun, less);
  }
  if (count <= kRun) return;
  GYRE_ASSERT(scratch.size() >= count, "scratch has room for all items");
  T* from = items.data();
  T* to = scratch.data();
  for (std::size_t width = kRun; width < count; width *= 2) {
    for (std::size_t begin = 0; begin < count; begin += 2 * width) {
      const std::size_t middle = count - begin < width ? count : begin + width;
      const std::size_t end = count - begin < 2 * width ? count : begin + 2 * width;
      merge(from, to, begin, middle, end, less);
    }
    std::swap(from, to);
  }
  if (from == items.data()) return;
  for (std::size_t i = 0; i < count; ++i) items[i] = std::move(from[i]);
}

}  // namespace gyre
