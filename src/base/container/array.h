// Array<T>: the growable array of the engine. Storage is aligned to 64 bytes, so that wide loads never straddle a line
// at its start, and counted by base/memory/memory. clear() keeps it, so a world at its working size no longer
// allocates. A large array of trivially copyable elements keeps its pages when it grows.
#pragma once

#include "base/check.h"
#include "base/memory/memory.h"
#include "base/noinline.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

namespace gyre {

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T> || std::is_nothrow_move_constructible_v<T>,
                "elements move to larger storage without failing");
  static_assert(alignof(T) <= kMemoryAlign, "storage is aligned to 64 bytes");

 public:
  using value_type = T;

  Array() = default;
  explicit Array(std::span<const T> items) { assign(items); }
  Array(std::initializer_list<T> items) { assign(std::span<const T>(items.begin(), items.size())); }
  Array(const Array& other) { assign(other.view()); }
  Array(Array&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  Array& operator=(const Array& other) {
    if (this != &other) assign(other.view());
    return *this;
  }
  Array& operator=(Array&& other) noexcept {
    if (this == &other) return *this;
    clear();
    deallocate(data_, bytes());
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
  }
  ~Array() {
    destroy(data_, size_);
    deallocate(data_, bytes());
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t capacity() const { return capacity_; }
  // Bytes of storage, used or not.
  std::size_t bytes() const { return capacity_ * sizeof(T); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }

  // Any integer type may index; a negative index is out of range like any other.
  template <class Index>
  requires std::is_integral_v<Index> T& operator[](Index i) {
    GYRE_ASSERT(static_cast<std::size_t>(i) < size_, "index is inside the array");
    return data_[static_cast<std::size_t>(i)];
  }
  template <class Index>
  requires std::is_integral_v<Index>
  const T& operator[](Index i) const {
    GYRE_ASSERT(static_cast<std::size_t>(i) < size_, "index is inside the array");
    return data_[static_cast<std::size_t>(i)];
  }
  T& front() { return (*this)[0u]; }
  const T& front() const { return (*this)[0u]; }
  T& back() { return (*this)[size_ - 1]; }
  const T& back() const { return (*this)[size_ - 1]; }

  // Array also converts to std::span<T> and std::span<const T>, whose own constructor takes data() and size().
  std::span<T> view() { return {data_, size_}; }
  std::span<const T> view() const { return {data_, size_}; }

  // Makes room for `count` elements in all.
  void reserve(std::size_t count) {
    if (count > capacity_) change_room(count);
  }
  // To be called before about `count` elements are added one by one: allocates for them at once, with the usual eighth
  // more.
  void expect(std::size_t count) { grow_to(count); }
  // Releases storage beyond `count` elements, which must be no fewer than there are.
  void trim(std::size_t count) {
    GYRE_ASSERT(count >= size_, "there is room for all elements");
    if (count < capacity_) change_room(count);
  }

  // New elements are value-initialised: zero for plain numbers.
  void resize(std::size_t count) {
    grow_to(count);
    for (std::size_t i = size_; i < count; ++i) new (data_ + i) T();
    shrink_to(count);
    size_ = count;
  }
  // New elements are copies of `value`, which may be one of this array's own.
  void resize(std::size_t count, const T& value) {
    if (count > size_) {
      const T copy = value;
      grow_to(count);
      for (std::size_t i = size_; i < count; ++i) new (data_ + i) T(copy);
    }
    shrink_to(count);
    size_ = count;
  }
  // New elements are not initialised: for elements about to be written.
  void resize_uninitialized(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>, "only plain data may be left unwritten");
    grow_to(count);
    size_ = count;
  }
  // Removes all elements and keeps the storage.
  void clear() {
    destroy(data_, size_);
    size_ = 0;
  }

  T& push_back(const T& value) { return emplace_back(value); }
  T& push_back(T&& value) { return emplace_back(std::move(value)); }

  // The arguments may refer into this array: the new element is made before the old ones move.
  template <class... Args>
  T& emplace_back(Args&&... args) {
    if (size_ == capacity_) return emplace_in_larger(std::forward<Args>(args)...);
    T* const made = new (data_ + size_) T(std::forward<Args>(args)...);
    ++size_;
    return *made;
  }

  void pop_back() {
    GYRE_ASSERT(size_ > 0, "there is an element to remove");
    --size_;
    destroy(data_ + size_, 1);
  }

  // Removes element i in constant time: the last element moves to its index.
  void swap_remove(std::size_t i) {
    GYRE_ASSERT(i < size_, "index is inside the array");
    if (i + 1 < size_) data_[i] = std::move(data_[size_ - 1]);
    pop_back();
  }

  // Inserts before element i; later elements move up by one.
  void insert_at(std::size_t i, T value) {
    GYRE_ASSERT(i <= size_, "index is inside the array or at its end");
    emplace_back(std::move(value));
    for (std::size_t k = size_ - 1; k > i; --k) std::swap(data_[k], data_[k - 1]);
  }
  // Removes element i; later elements move down by one.
  void erase_at(std::size_t i) {
    GYRE_ASSERT(i < size_, "index is inside the array");
    for (std::size_t k = i + 1; k < size_; ++k) data_[k - 1] = std::move(data_[k]);
    pop_back();
  }

  // Replaces all elements by copies of `items`, which must not be part of this array.
  void assign(std::span<const T> items) {
    GYRE_ASSERT(items.empty() || items.data() + items.size() <= data_ || items.data() >= data_ + capacity_,
                "the items lie outside this array");
    clear();
    append(items);
  }
  void assign(std::size_t count, const T& value) {
    const T copy = value;
    clear();
    resize(count, copy);
  }
  // Adds copies of `items`, which must not be part of this array.
  void append(std::span<const T> items) {
    if (items.empty()) return;
    grow_to(size_ + items.size());
    if constexpr (std::is_trivially_copyable_v<T>) {
      std::memcpy(static_cast<void*>(data_ + size_), items.data(), items.size() * sizeof(T));
    } else {
      for (std::size_t i = 0; i < items.size(); ++i) new (data_ + size_ + i) T(items[i]);
    }
    size_ += items.size();
  }

  friend bool operator==(const Array& a, const Array& b) {
    if (a.size_ != b.size_) return false;
    for (std::size_t i = 0; i < a.size_; ++i) {
      if (!(a.data_[i] == b.data_[i])) return false;
    }
    return true;
  }

 private:
  static std::size_t bytes_of(std::size_t count) {
    if (count > SIZE_MAX / sizeof(T)) out_of_memory(SIZE_MAX);
    return count * sizeof(T);
  }

  static void destroy([[maybe_unused]] T* items, [[maybe_unused]] std::size_t count) {
    if constexpr (!std::is_trivially_destructible_v<T>) {
      for (std::size_t i = 0; i < count; ++i) items[i].~T();
    }
  }

  // Starts at one cache line and doubles while small. A large array grows by an eighth: each element is then copied
  // eight times in all, which is little, and at most an eighth of the memory is unused.
  std::size_t next_capacity(std::size_t needed) const {
    constexpr std::size_t kLarge = 16 * 1024;  // bytes
    const std::size_t min_capacity = sizeof(T) < kMemoryAlign ? kMemoryAlign / sizeof(T) : 1;
    const std::size_t more = bytes() < kLarge ? capacity_ : capacity_ / 8;
    const std::size_t enlarged = more < SIZE_MAX - capacity_ ? capacity_ + more : SIZE_MAX;
    const std::size_t grown = enlarged < min_capacity ? min_capacity : enlarged;
    return grown < needed ? needed : grown;
  }

  template <class... Args>
  GYRE_COLD T& emplace_in_larger(Args&&... args) {
    T made(std::forward<Args>(args)...);
    change_room(next_capacity(size_ + 1));
    T* const placed = new (data_ + size_) T(std::move(made));
    ++size_;
    return *placed;
  }

  void grow_to(std::size_t count) {
    if (count > capacity_) enlarge(count);
  }
  GYRE_COLD void enlarge(std::size_t count) { change_room(next_capacity(count)); }

  void shrink_to(std::size_t count) {
    if (count < size_) destroy(data_ + count, size_ - count);
  }

  void change_room(std::size_t room) {
    const std::size_t new_bytes = bytes_of(room);
    if constexpr (std::is_trivially_copyable_v<T>) {
      data_ = static_cast<T*>(reallocate(data_, bytes(), new_bytes, size_ * sizeof(T)));
    } else {
      T* const storage = static_cast<T*>(allocate(new_bytes));
      for (std::size_t i = 0; i < size_; ++i) {
        new (storage + i) T(std::move(data_[i]));
        data_[i].~T();
      }
      deallocate(data_, bytes());
      data_ = storage;
    }
    capacity_ = room;
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

// The index of an unused item: the last free one, or a new one. The caller sets its content.
template <class T>
std::uint32_t take_slot(Array<T>& items, Array<std::uint32_t>& free) {
  if (free.empty()) {
    items.emplace_back();
    return std::uint32_t(items.size() - 1);
  }
  const std::uint32_t index = free.back();
  free.pop_back();
  return index;
}

}  // namespace gyre
