#include "io/codec/bytes.h"

#include "io/codec/enum_counts.h"

#include <gtest/gtest.h>

namespace gyre::bytes_test {
namespace {

TEST(Bytes, EveryTypeComesBack) {
  ByteWriter out;
  out.put(std::uint8_t(200)), out.put(std::int32_t(-5)), out.put(std::uint64_t(1) << 60), out.put(true);
  out.put(-0.0f), out.put(1e300), out.put(BodyType::kinematic);
  ByteReader in(out.view());
  EXPECT_EQ(in.get<std::uint8_t>(), 200);
  EXPECT_EQ(in.get<std::int32_t>(), -5);
  EXPECT_EQ(in.get<std::uint64_t>(), std::uint64_t(1) << 60);
  EXPECT_TRUE(in.get<bool>());
  EXPECT_EQ(to_bits(in.get<float>()), 0x80000000u);
  EXPECT_EQ(in.get<double>(), 1e300);
  EXPECT_EQ(in.get<BodyType>(), BodyType::kinematic);
  EXPECT_TRUE(in.finished());
}

TEST(Bytes, LowestByteFirst) {
  ByteWriter out;
  out.put(std::uint32_t(0x04030201));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(out.view()[i], std::byte(i + 1));
}

TEST(Bytes, BitsOfNanSurvive) {
  const float odd = __builtin_bit_cast(float, 0x7fa12345u);
  ByteWriter out;
  const float values[] = {odd};
  out.put_all(std::span<const float>(values));
  ByteReader in(out.view());
  EXPECT_EQ(to_bits(in.get_all<float>().at(0)), 0x7fa12345u);
}

TEST(Bytes, NothingIsReadPastTheEnd) {
  const std::byte three[3] = {};
  ByteReader in(three);
  EXPECT_EQ(in.get<std::uint32_t>(), 0u);
  EXPECT_TRUE(in.failed());
  EXPECT_EQ(in.get<std::uint8_t>(), 0);  // stays failed, though a byte is there
  EXPECT_EQ(in.left(), 0u);
  EXPECT_FALSE(in.finished());
}

TEST(Bytes, AbsurdCountsAllocateNothing) {
  for (const std::uint64_t count : {UINT64_MAX, std::uint64_t(1) << 62, std::uint64_t(3)}) {
    ByteWriter out;
    out.put(count);
    out.put(std::uint64_t(0));
    ByteReader in(out.view());
    EXPECT_TRUE(in.get_all<float>().empty());
    EXPECT_TRUE(in.failed());
  }
}

TEST(Bytes, BytesBeyondTheEndFail) {
  const std::byte two[2] = {};
  ByteReader in(two);
  EXPECT_EQ(in.get_bytes(2).size(), 2u);
  EXPECT_TRUE(in.finished());
  EXPECT_TRUE(in.get_bytes(UINT64_MAX).empty());
  EXPECT_TRUE(in.failed());
}

TEST(Bytes, EnumsAndBoolsThatDoNotExistFail) {
  const std::byte three[1] = {std::byte(3)};
  ByteReader body(three);
  body.get<BodyType>();
  EXPECT_TRUE(body.failed());
  ByteReader truth(three);
  truth.get<bool>();
  EXPECT_TRUE(truth.failed());
}

}  // namespace
}  // namespace gyre::bytes_test
