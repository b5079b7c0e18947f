// 64-bit hashes for state and content, the same on every platform. The function is XXH64, written from its published
// specification ("xxHash fast digest algorithm", section XXH64): four lanes take 32 bytes at a time, so it runs near
// memory speed with 64-bit multiplies alone, and reference values exist to test against. Not for secrets.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace gyre {

namespace hash_detail {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5u;

// Byte by byte, so that the byte order is fixed and constant expressions can use it; compilers make one load of it.
template <class Byte>
constexpr std::uint64_t read_32(const Byte* p) {
  std::uint64_t word = 0;
  for (int i = 0; i < 4; ++i) word |= std::uint64_t{static_cast<unsigned char>(p[i])} << 8 * i;
  return word;
}

template <class Byte>
constexpr std::uint64_t read_64(const Byte* p) {
  if constexpr (std::endian::native == std::endian::little) {
    if (!__builtin_is_constant_evaluated()) {
      std::uint64_t word;
      std::memcpy(&word, p, sizeof word);
      return word;
    }
  }
  return read_32(p) | read_32(p + 4) << 32;
}

constexpr std::uint64_t round(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * kPrime2, 31) * kPrime1;
}

struct Lanes {
  std::uint64_t a, b, c, d;

  constexpr explicit Lanes(std::uint64_t seed)
      : a(seed + kPrime1 + kPrime2), b(seed + kPrime2), c(seed), d(seed - kPrime1) {}

  constexpr void update(std::uint64_t w, std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    a = round(a, w);
    b = round(b, x);
    c = round(c, y);
    d = round(d, z);
  }
  template <class Byte>
  constexpr void update(const Byte* block) {
    update(read_64(block), read_64(block + 8), read_64(block + 16), read_64(block + 24));
  }

  constexpr std::uint64_t merge() const {
    std::uint64_t hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    for (const std::uint64_t lane : {a, b, c, d}) hash = (hash ^ round(0, lane)) * kPrime1 + kPrime4;
    return hash;
  }
};

// The last 0 to 31 bytes, then the final scrambling.
template <class Byte>
constexpr std::uint64_t finish(std::uint64_t hash, const Byte* p, std::size_t left) {
  for (; left >= 8; left -= 8, p += 8) hash = std::rotl(hash ^ round(0, read_64(p)), 27) * kPrime1 + kPrime4;
  if (left >= 4) {
    hash = std::rotl(hash ^ read_32(p) * kPrime1, 23) * kPrime2 + kPrime3;
    left -= 4;
    p += 4;
  }
  for (; left > 0; --left, ++p) {
    hash = std::rotl(hash ^ std::uint64_t{static_cast<unsigned char>(*p)} * kPrime5, 11) * kPrime1;
  }
  hash = (hash ^ hash >> 33) * kPrime2;
  hash = (hash ^ hash >> 29) * kPrime3;
  return hash ^ hash >> 32;
}

template <class Byte>
constexpr std::uint64_t hash_all(const Byte* p, std::size_t size, std::uint64_t seed) {
  std::uint64_t hash = seed + kPrime5;
  std::size_t left = size;
  if (left >= 32) {
    Lanes lanes(seed);
    for (; left >= 32; left -= 32, p += 32) lanes.update(p);
    hash = lanes.merge();
  }
  return finish(hash + size, p, left);
}

}  // namespace hash_detail

// Hash of `size` bytes.
inline std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0) {
  return hash_detail::hash_all(static_cast<const unsigned char*>(data), size, seed);
}

// The same for text, also at compile time.
constexpr std::uint64_t hash_text(std::string_view text, std::uint64_t seed = 0) {
  return hash_detail::hash_all(text.data(), text.size(), seed);
}

// Spreads every bit of a word over the whole result, one to one: the start of a probe from a key. The final step of
// splitmix64, published in "Fast splittable pseudorandom number generators" (2014), variant 13.
constexpr std::uint64_t mix_bits(std::uint64_t word) {
  word = (word ^ word >> 30) * 0xBF58476D1CE4E5B9u;
  word = (word ^ word >> 27) * 0x94D049BB133111EBu;
  return word ^ word >> 31;
}

// Hashes input in pieces, independent of the cuts. value() equals hash_bytes of everything so far, and more may follow.
class Hasher {
 public:
  explicit Hasher(std::uint64_t seed = 0) : lanes_(seed), seed_(seed) {}

  void add(std::span<const std::byte> bytes) {
    const std::byte* p = bytes.data();
    std::size_t left = bytes.size();
    if (left == 0) return;
    total_ += left;
    if (waiting_ + left < 32) {
      std::memcpy(buffer_ + waiting_, p, left);
      waiting_ += left;
      return;
    }
    if (waiting_ != 0) {
      const std::size_t missing = 32 - waiting_;
      std::memcpy(buffer_ + waiting_, p, missing);
      lanes_.update(buffer_);
      p += missing;
      left -= missing;
    }
    // in registers: the compiler must assume that the bytes may alias `lanes_`
    hash_detail::Lanes lanes = lanes_;
    for (; left >= 32; left -= 32, p += 32) lanes.update(p);
    lanes_ = lanes;
    if (left != 0) std::memcpy(buffer_, p, left);
    waiting_ = left;
  }

  // Eight bytes, the lowest first on every platform.
  void add(std::uint64_t word) {
    std::byte bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(word >> 8 * i & 0xff);
    add(std::span<const std::byte>(bytes));
  }

  std::uint64_t value() const {
    const std::uint64_t hash = total_ >= 32 ? lanes_.merge() : seed_ + hash_detail::kPrime5;
    return hash_detail::finish(hash + total_, buffer_, waiting_);
  }

 private:
  hash_detail::Lanes lanes_;
  std::uint64_t seed_;
  std::uint64_t total_ = 0;
  std::size_t waiting_ = 0;  // bytes in the buffer, fewer than 32
  std::byte buffer_[32] = {};
};

}  // namespace gyre
