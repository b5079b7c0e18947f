// SmallArray<T, N>: a list with room for N elements inside, which allocates only for more. Most bodies have one shape
// and no joint, and there are many bodies.
#pragma once

#include "base/check.h"
#include "base/memory/memory.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace gyre {

template <class T, std::uint32_t N>
class SmallArray {
  static_assert(std::is_trivially_copyable_v<T> && N > 0, "elements are moved by memcpy");

 public:
  SmallArray() = default;
  SmallArray(const SmallArray& other) { *this = other; }
  SmallArray(SmallArray&& other) noexcept { *this = std::move(other); }
  SmallArray& operator=(const SmallArray& other) {
    if (this == &other) return *this;
    clear();
    for (const T& item : other) insert_at(size_, item);
    return *this;
  }
  SmallArray& operator=(SmallArray&& other) noexcept {
    if (this == &other) return *this;
    free_storage();
    std::memcpy(static_cast<void*>(this), &other, sizeof *this);
    other.size_ = 0;
    other.capacity_ = N;
    return *this;
  }
  ~SmallArray() { free_storage(); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  // Bytes of memory beside the list itself.
  std::size_t bytes() const { return capacity_ > N ? capacity_ * sizeof(T) : 0; }
  const T* data() const { return capacity_ > N ? heap_ : reinterpret_cast<const T*>(own_); }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  const T& operator[](std::size_t i) const {
    GYRE_ASSERT(i < size_, "index is inside the list");
    return data()[i];
  }
  const T& front() const { return (*this)[0]; }

  // Inserts before element i; later elements move up by one.
  void insert_at(std::size_t i, T item) {
    GYRE_ASSERT(i <= size_, "index is inside the list or at its end");
    if (size_ == capacity_) enlarge();
    T* const items = own();
    std::memmove(static_cast<void*>(items + i + 1), items + i, (size_ - i) * sizeof(T));
    std::memcpy(static_cast<void*>(items + i), &item, sizeof(T));
    ++size_;
  }
  void push_back(const T& item) { insert_at(size_, item); }
  // Removes element i; later elements move down by one.
  void erase_at(std::size_t i) {
    GYRE_ASSERT(i < size_, "index is inside the list");
    T* const items = own();
    std::memmove(static_cast<void*>(items + i), items + i + 1, (size_ - i - 1) * sizeof(T));
    --size_;
  }
  // Removes all elements and frees their memory.
  void clear() {
    free_storage();
    size_ = 0;
    capacity_ = N;
  }

 private:
  T* own() { return const_cast<T*>(data()); }

  void enlarge() {
    const std::uint32_t room = 2 * capacity_ < 4 ? 4 : 2 * capacity_;
    T* const storage = static_cast<T*>(allocate(room * sizeof(T)));
    std::memcpy(static_cast<void*>(storage), data(), size_ * sizeof(T));
    free_storage();
    heap_ = storage;
    capacity_ = room;
  }
  void free_storage() {
    if (capacity_ > N) deallocate(heap_, bytes());
  }

  std::uint32_t size_ = 0;
  std::uint32_t capacity_ = N;
  union {
    T* heap_;
    alignas(T) std::byte own_[N * sizeof(T)];
  };
};

}  // namespace gyre
