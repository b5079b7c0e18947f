// PagedArray<T, N>: an array in pages of N elements, for many large records. It grows by a page at a time: at most a
// page is unused, and elements never move, so pointers stay valid. Elements of one page are contiguous.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace gyre {

template <class T, std::size_t N>
class PagedArray {
  static_assert(std::is_trivially_copyable_v<T>, "pages are copied by memcpy");
  static_assert(N > 0 && (N & (N - 1)) == 0, "a power of two");

 public:
  PagedArray() = default;
  PagedArray(const PagedArray& other) { *this = other; }
  PagedArray(PagedArray&& other) noexcept
      : pages_(std::move(other.pages_)), size_(std::exchange(other.size_, 0)) {}
  PagedArray& operator=(const PagedArray& other) {
    if (this == &other) return *this;
    set_page_count(pages_of(other.size_));
    size_ = other.size_;
    for (std::size_t page = 0; page < pages_.size(); ++page) {
      std::memcpy(static_cast<void*>(pages_[page]), other.pages_[page], N * sizeof(T));
    }
    return *this;
  }
  PagedArray& operator=(PagedArray&& other) noexcept {
    if (this == &other) return *this;
    set_page_count(0);
    pages_ = std::move(other.pages_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }
  ~PagedArray() { set_page_count(0); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  // Bytes of memory, used or not.
  std::size_t bytes() const { return pages_.bytes() + pages_.size() * N * sizeof(T); }

  T& operator[](std::size_t i) {
    GYRE_ASSERT(i < size_, "index is inside the array");
    return pages_[i / N][i % N];
  }
  const T& operator[](std::size_t i) const {
    GYRE_ASSERT(i < size_, "index is inside the array");
    return pages_[i / N][i % N];
  }
  void set(std::size_t i, const T& value) { (*this)[i] = value; }

  // New elements are as T(). Unused pages are released.
  void resize(std::size_t count) {
    set_page_count(pages_of(count));
    for (std::size_t i = size_; i < count; ++i) pages_[i / N][i % N] = T();
    size_ = count;
  }

 private:
  static std::size_t pages_of(std::size_t count) { return (count + N - 1) / N; }

  void set_page_count(std::size_t count) {
    while (pages_.size() > count) {
      deallocate(pages_.back(), N * sizeof(T));
      pages_.pop_back();
    }
    while (pages_.size() < count) {
      T* const page = static_cast<T*>(allocate(N * sizeof(T)));
      // Elements beyond the end are copied with their page, so they must be initialised.
      std::memset(static_cast<void*>(page), 0, N * sizeof(T));
      pages_.push_back(page);
    }
  }

  Array<T*> pages_;
  std::size_t size_ = 0;
};

}  // namespace gyre
