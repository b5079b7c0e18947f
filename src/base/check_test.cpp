// Failed checks reach the handler with words, condition and location; checks that pass do not.
#include "base/check.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace gyre::check_test {
namespace {

std::string told;
int told_line = 0;

void listen(const char* condition, const char* words, const char* file, int line) {
  told = std::string(condition) + " | " + words + " | " +
         (std::strstr(file, "check_test") != nullptr ? "here" : file);
  told_line = line;
}

class Check : public testing::Test {
 protected:
  void SetUp() override {
    told.clear();
    set_check_handler(listen);
  }
  void TearDown() override { set_check_handler(nullptr); }
};

TEST_F(Check, HandlerReceivesTheFailure) {
  check_failed("1 + 1 == 3", "sums are right", __FILE__, 17);
  EXPECT_EQ(told, "1 + 1 == 3 | sums are right | here");
  EXPECT_EQ(told_line, 17);
}

TEST_F(Check, AssertTellsOnlyWhenFalseAndActive) {
  int looks = 0;
  const auto look = [&looks](bool answer) {
    ++looks;
    return answer;
  };
  GYRE_ASSERT(look(true), "it holds");
  EXPECT_EQ(told, "");
  GYRE_ASSERT(look(false), "it holds");
  EXPECT_EQ(told, kAssertsActive ? "look(false) | it holds | here" : "");
  EXPECT_EQ(looks, kAssertsActive ? 2 : 0);
}

TEST_F(Check, AssertIsOneStatement) {
  bool other = false;
  if (told_line < 0)
    GYRE_ASSERT(false, "never reached");
  else
    other = true;
  EXPECT_TRUE(other);
}

TEST(CheckDeath, DefaultPrintsAndAborts) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(check_failed("a < b", "a is below b", "file.cpp", 3), "file.cpp:3: a is below b \\(a < b\\)");
}

TEST(Validate, KeepsTheStatementOnlyIfEnabled) {
  int walks = 0;
  GYRE_VALIDATE_ONLY(walks += 1, walks += 1);
#if defined(GYRE_VALIDATE) && GYRE_VALIDATE
  EXPECT_EQ(walks, 2);
#else
  EXPECT_EQ(walks, 0);
#endif
}

}  // namespace
}  // namespace gyre::check_test
