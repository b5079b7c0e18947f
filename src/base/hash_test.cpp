// Hash against values of the reference program (xxhsum -H1, version 0.8.1), and pieces against the whole.
#include "base/hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <set>
#include <vector>

namespace gyre::hash_test {
namespace {

static_assert(hash_text("abc") == 0x44bc2cf5ad770999u, "works at compile time");

std::vector<unsigned char> pattern(std::size_t size) {
  std::vector<unsigned char> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(i * 7 + 3);
  return bytes;
}

TEST(Hash, ReferenceValues) {
  EXPECT_EQ(hash_bytes(nullptr, 0), 0xef46db3751d8e999u);
  EXPECT_EQ(hash_text("a"), 0xd24ec4f1a98c6e5bu);
  EXPECT_EQ(hash_text("Nobody inspects the spammish repetition"), 0xfbcea83c8a378bf1u);
  const struct {
    std::size_t size;
    std::uint64_t hash;
  } cases[] = {{1, 0x1f25c8d0bc1f4bb6u},   {3, 0x31d2363f52e564c9u},  {4, 0x9bb64b7d66ee9fdau},
               {7, 0x9a7b149959ce60d8u},   {8, 0xdab99d95c6f90092u},  {12, 0xd52e407833af5133u},
               {31, 0xa2aa5f33cc4a6119u},  {32, 0x23c3c17ef790fd97u}, {33, 0x50a7cfc7ba588784u},
               {63, 0x5e3e54b431c7493cu},  {64, 0x0eb64b3ef6eeb01fu}, {100, 0xa61f8d4c170fe531u},
               {1000, 0x5f235fa033f1a3fbu}};
  const std::vector<unsigned char> bytes = pattern(1000);
  for (const auto& [size, hash] : cases) EXPECT_EQ(hash_bytes(bytes.data(), size), hash) << size << " bytes";
}

TEST(Hash, PiecesEqualTheWhole) {
  std::mt19937 random(9);
  for (std::size_t size = 0; size < 300; ++size) {
    const std::vector<unsigned char> bytes = pattern(size);
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{0x123456789abcdef}}) {
      Hasher hasher(seed);
      for (std::size_t at = 0; at < size;) {
        const std::size_t room = size - at;
        const std::size_t piece = std::min<std::size_t>(room, random() % 70);
        hasher.add(std::as_bytes(std::span(bytes).subspan(at, piece)));
        at += piece;
      }
      ASSERT_EQ(hasher.value(), hash_bytes(bytes.data(), size, seed)) << size << " bytes";
      ASSERT_EQ(hasher.value(), hasher.value()) << "asking changes nothing";
    }
  }
}

TEST(Hash, WordsAreBytesLowestFirst) {
  const unsigned char bytes[] = {8, 7, 6, 5, 4, 3, 2, 1};
  Hasher hasher;
  hasher.add(std::uint64_t{0x0102030405060708});
  EXPECT_EQ(hasher.value(), hash_bytes(bytes, 8));
}

TEST(Hash, EveryBitMatters) {
  for (const std::size_t size : {1u, 8u, 31u, 40u, 100u}) {
    std::vector<unsigned char> bytes = pattern(size);
    std::set<std::uint64_t> seen{hash_bytes(bytes.data(), size), hash_bytes(bytes.data(), size, 1)};
    int flipped = 0;
    for (std::size_t i = 0; i < size * 8; ++i) {
      bytes[i / 8] = static_cast<unsigned char>(bytes[i / 8] ^ 1 << i % 8);
      const std::uint64_t hash = hash_bytes(bytes.data(), size);
      flipped += std::popcount(hash ^ *seen.begin());
      seen.insert(hash);
      bytes[i / 8] = static_cast<unsigned char>(bytes[i / 8] ^ 1 << i % 8);
    }
    EXPECT_EQ(seen.size(), size * 8 + 2);
    EXPECT_NEAR(flipped / static_cast<double>(size * 8), 32.0, 4.0) << "half of the result changes";
  }
}

TEST(Hash, MixIsOneToOneAndSpreads) {
  std::set<std::uint32_t> low;
  for (std::uint64_t i = 0; i < 4096; ++i) low.insert(static_cast<std::uint32_t>(mix_bits(i << 32) >> 44));
  EXPECT_GT(low.size(), 4060u) << "4096 keys that differ in high bits only, in a million bins";
  EXPECT_EQ(mix_bits(0), 0u);
}

}  // namespace
}  // namespace gyre::hash_test
