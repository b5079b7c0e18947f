// Errors carry their words, cut to the room there is; results hold a value or an error, never both.
#include <gyre/result.h>

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

namespace gyre::result_test {
namespace {

TEST(Result, ErrorFormatsItsWords) {
  const Error error =
      make_error(ErrorCode::invalid_argument, "radius of %s is %g, must be above %d", "ball", -2.5, 0);
  EXPECT_EQ(error.code, ErrorCode::invalid_argument);
  EXPECT_STREQ(error.message, "radius of ball is -2.5, must be above 0");
}

TEST(Result, LongWordsAreCutAndStillEnd) {
  const std::string text(1000, 'x');
  const Error error = make_error(ErrorCode::invalid_data, "%s", text.c_str());
  EXPECT_EQ(std::strlen(error.message), sizeof error.message - 1);
}

TEST(Result, HoldsValueOrError) {
  Result<int> good = 7;
  ASSERT_TRUE(good.has_value());
  EXPECT_EQ(*good, 7);
  EXPECT_EQ(good.error().code, ErrorCode::none);

  const Result<int> bad = make_error(ErrorCode::busy, "stepping");
  EXPECT_FALSE(bool(bad));
  EXPECT_EQ(bad.error().code, ErrorCode::busy);
}

TEST(Result, MovesOwnedValuesOut) {
  Result<std::unique_ptr<int>> made = std::make_unique<int>(3);
  ASSERT_TRUE(made.has_value());
  const std::unique_ptr<int> taken = *std::move(made);
  EXPECT_EQ(*taken, 3);
}

TEST(Result, ErrorsTestAsTruthValues) {
  const Error none;
  EXPECT_FALSE(bool(none));
  EXPECT_TRUE(none.ok());
  const Error stale = make_error(ErrorCode::stale_id, "gone");
  EXPECT_TRUE(bool(stale));
  EXPECT_FALSE(stale.ok());
}

// In every build type: otherwise memory that holds no value would be read.
TEST(ResultDeathTest, TheValueOfAnErrorSaysWhyAndStops) {
  Result<std::string> bad = make_error(ErrorCode::invalid_argument, "radius is -1");
  const Result<std::string>& fixed = bad;
  EXPECT_DEATH(static_cast<void>(*bad), "radius is -1");
  EXPECT_DEATH(static_cast<void>(*fixed), "radius is -1");
  EXPECT_DEATH(static_cast<void>(bad->size()), "radius is -1");
  EXPECT_DEATH(static_cast<void>(fixed->size()), "radius is -1");
  EXPECT_DEATH(static_cast<void>(*std::move(bad)), "radius is -1");
}

}  // namespace
}  // namespace gyre::result_test
