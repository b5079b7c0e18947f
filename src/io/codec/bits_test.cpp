#include "io/codec/bits.h"

#include <gtest/gtest.h>

namespace gyre::bits_test {
namespace {

TEST(Bits, NumbersOfEveryWidthComeBack) {
  BitWriter writer;
  const std::uint64_t pattern = 0x9e3779b97f4a7c15u;
  for (int width = 0; width <= 64; ++width) {
    writer.code_bits(width == 64 ? pattern : pattern & ((std::uint64_t(1) << width) - 1), width);
  }
  const std::vector<std::byte> bytes = writer.take();
  EXPECT_EQ(bytes.size(), 260u);  // 64 * 65 / 2 bits
  BitReader reader(bytes);
  for (int width = 0; width <= 64; ++width) {
    std::uint64_t value = 0;
    reader.code_bits(value, width);
    EXPECT_EQ(value, width == 64 ? pattern : pattern & ((std::uint64_t(1) << width) - 1)) << width;
  }
  EXPECT_TRUE(reader.finished());
}

TEST(Bits, TheLowestBitComesFirst) {
  BitWriter writer;
  writer.code_bits(1, 1);
  writer.code_bits(0, 2);
  writer.code_bits(0x15, 5);
  writer.code_bits(0x3, 2);
  EXPECT_EQ(writer.take(), (std::vector<std::byte>{std::byte(0xa9), std::byte(0x03)}));
  EXPECT_TRUE(writer.take().empty());
}

TEST(Bits, CountsComeBackAndSmallOnesAreShort) {
  std::vector<std::uint64_t> counts = {0, 1, 2, 3, 7, 8, 100, 65535, 65536};
  for (int bit = 17; bit < 62; ++bit)
    counts.push_back((std::uint64_t(1) << bit) - 1), counts.push_back(std::uint64_t(1) << bit);
  for (const int order : {0, 1, 4, 16}) {
    BitWriter writer;
    for (std::uint64_t count : counts) code_count(writer, count, order);
    const std::vector<std::byte> bytes = writer.take();
    BitReader reader(bytes);
    for (const std::uint64_t count : counts) {
      std::uint64_t value = 12345;
      code_count(reader, value, order);
      EXPECT_EQ(value, count) << order;
    }
    EXPECT_TRUE(reader.finished()) << order;
  }
  BitWriter zeros;
  std::uint64_t zero = 0;
  for (int i = 0; i < 16; ++i) code_count(zeros, zero, 0);
  EXPECT_EQ(zeros.take().size(), 2u);
}

TEST(Bits, ReadingPastTheEndFails) {
  const std::vector<std::byte> bytes(3, std::byte(0));
  BitReader reader(bytes);
  std::uint64_t value = 1;
  reader.code_bits(value, 20);
  EXPECT_FALSE(reader.failed());
  EXPECT_EQ(reader.left(), 4u);
  reader.code_bits(value, 5);
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(value, 0u);
  EXPECT_FALSE(reader.finished());
  EXPECT_EQ(reader.left(), 0u);
  BitReader counts(bytes);  // nothing but zeros: a count that never ends
  code_count(counts, value, 0);
  EXPECT_TRUE(counts.failed());
}

TEST(Bits, WhatIsLeftOverIsNotFinished) {
  const std::vector<std::byte> longer = {std::byte(0x01), std::byte(0x00)};
  BitReader reader(longer);
  std::uint64_t value = 0;
  reader.code_bits(value, 3);
  EXPECT_FALSE(reader.finished());  // a byte too many
  const std::vector<std::byte> dirty = {std::byte(0x81)};
  BitReader other(dirty);
  other.code_bits(value, 3);
  EXPECT_FALSE(other.finished());  // the padding is not zero
}

TEST(Bits, SignsFoldAndUnfold) {
  const std::int64_t values[] = {0, -1, 1, -2, 2, INT64_MAX, INT64_MIN};
  const std::uint64_t folded[] = {0, 1, 2, 3, 4, UINT64_MAX - 1, UINT64_MAX};
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(fold_sign(values[i]), folded[i]);
    EXPECT_EQ(unfold_sign(folded[i]), values[i]);
  }
}

}  // namespace
}  // namespace gyre::bits_test
