// Little-endian bytes on every machine. The reader accepts any bytes: it never reads past their end and checks counts
// against the remaining bytes before it allocates. After an error it stays failed and returns zeros, so callers may
// check once at the end.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace gyre {

// The bits of a number as the unsigned integer of its size; bool and enums take one byte.
template <class T>
auto to_bits(T value) {
  if constexpr (std::is_same_v<T, float>) {
    return __builtin_bit_cast(std::uint32_t, value);
  } else if constexpr (std::is_same_v<T, double>) {
    return __builtin_bit_cast(std::uint64_t, value);
  } else if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>) {
    static_assert(sizeof(T) == 1);
    return static_cast<std::uint8_t>(value);
  } else {
    return static_cast<std::make_unsigned_t<T>>(value);
  }
}
template <class T>
using BitsOf = decltype(to_bits(T()));

template <class Bits>
void store_little(std::byte* to, Bits bits) {
  for (std::size_t i = 0; i < sizeof(Bits); ++i) to[i] = static_cast<std::byte>(bits >> 8 * i & 0xff);
}
template <class Bits>
Bits load_little(const std::byte* from) {
  Bits bits = 0;
  for (std::size_t i = 0; i < sizeof(Bits); ++i) bits = static_cast<Bits>(bits | Bits(from[i]) << 8 * i);
  return bits;
}

// The number of values of an enum; values read must be below. Every stored enum has its line here or beside its
// codec.
template <class E>
constexpr int kEnumCount = E::missing_enum_count;

// Turns bits back into a value. False for a bool or enum value that does not exist.
template <class T>
bool from_bits(BitsOf<T> bits, T& value) {
  if constexpr (std::is_same_v<T, float> || std::is_same_v<T, double>) {
    value = __builtin_bit_cast(T, bits);
  } else if constexpr (std::is_same_v<T, bool>) {
    if (bits > 1) return false;
    value = bits != 0;
  } else if constexpr (std::is_enum_v<T>) {
    if (bits >= kEnumCount<T>) return false;
    value = static_cast<T>(bits);
  } else {
    value = static_cast<T>(bits);
  }
  return true;
}

class ByteWriter {
 public:
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void put(T value) {
    store_little(grow(sizeof(BitsOf<T>)), to_bits(value));
  }
  void put_bytes(std::span<const std::byte> bytes) {
    if (!bytes.empty()) std::memcpy(grow(bytes.size()), bytes.data(), bytes.size());
  }
  // Writes a count and the values.
  template <class T>
  void put_all(std::span<const T> values) {
    put(std::uint64_t(values.size()));
    std::byte* to = grow(values.size() * sizeof(BitsOf<T>));
    for (const T& value : values) {
      store_little(to, to_bits(value));
      to += sizeof(BitsOf<T>);
    }
  }
  // Overwrites the bytes at `offset`.
  template <class T>
  void patch(std::size_t offset, T value) {
    store_little(bytes_.data() + offset, to_bits(value));
  }
  // Makes room for `count` bytes and returns their address, which is valid until the next call.
  std::byte* grow(std::size_t count) {
    const std::size_t old = bytes_.size();
    bytes_.resize(old + count);
    return bytes_.data() + old;
  }

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::byte> view() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }
  void clear() { bytes_.clear(); }

 private:
  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) T get() {
    T value{};
    const std::byte* const from = take(sizeof(BitsOf<T>));
    if (from != nullptr && !from_bits(load_little<BitsOf<T>>(from), value)) fail();
    return value;
  }
  // The next `count` bytes. If fewer remain, the result is empty and the reader fails.
  std::span<const std::byte> get_bytes(std::uint64_t count) {
    if (count > left()) {
      fail();
      return {};
    }
    const std::span<const std::byte> bytes = bytes_.subspan(offset_, std::size_t(count));
    offset_ += std::size_t(count);
    return bytes;
  }
  // A count of items of at least `min_bytes` each. If fewer bytes remain, the result is 0 and the reader fails.
  std::size_t get_count(std::size_t min_bytes) {
    const std::uint64_t count = get<std::uint64_t>();
    if (count <= left() / min_bytes) return std::size_t(count);
    fail();
    return 0;
  }
  // Reads the output of put_all.
  template <class T>
  std::vector<T> get_all() {
    constexpr std::size_t kSize = sizeof(BitsOf<T>);
    std::vector<T> values(get_count(kSize));
    const std::byte* from = take(values.size() * kSize);
    for (T& value : values) {
      if (!from_bits(load_little<BitsOf<T>>(from), value)) fail();
      from += kSize;
    }
    return values;
  }

  void fail() { failed_ = true; }
  bool failed() const { return failed_; }
  // True if all bytes were read without an error.
  bool finished() const { return !failed_ && left() == 0; }
  std::size_t offset() const { return offset_; }
  std::size_t left() const { return failed_ ? 0 : bytes_.size() - offset_; }

 private:
  const std::byte* take(std::size_t count) {
    if (count > left()) fail();
    if (failed_) return nullptr;
    const std::byte* const from = bytes_.data() + offset_;
    offset_ += count;
    return from;
  }

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  bool failed_ = false;
};

}  // namespace gyre
