// Numbers to text and back: shortest, exact, and nothing but decimals.
#include "scene/number_text.h"

#include "scene/json_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

namespace gyre::number_text_test {
namespace {

template <class T>
std::string shortest(T value) {
  std::string out;
  append_number(out, value);
  return out;
}
std::string rounded(double value, int digits) {
  std::string out;
  append_rounded(out, value, digits);
  return out;
}

TEST(NumberText, ShortestForm) {
  EXPECT_EQ(shortest(0.1f), "0.1");
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(1.0 / 3.0), "0.3333333333333333");
  EXPECT_EQ(shortest(-9.81f), "-9.81");
  EXPECT_EQ(shortest(4294967296.0), "4294967296");
  EXPECT_EQ(shortest(-0.0f), "-0.0");
  EXPECT_EQ(shortest(0.0f), "0");
}

TEST(NumberText, EveryFloatComesBack) {
  // A walk over all exponents with changing mantissas.
  std::uint32_t bits = 1;
  for (int i = 0; i < 200000; ++i) {
    bits = bits * 1664525u + 1013904223u;
    const float value = __builtin_bit_cast(float, bits);
    if (!std::isfinite(value)) continue;
    double back = 0;
    ASSERT_TRUE(parse_number(shortest(value), back)) << shortest(value);
    ASSERT_EQ(__builtin_bit_cast(std::uint32_t, float(back)), bits) << shortest(value);
  }
}

TEST(NumberText, EveryDoubleComesBack) {
  std::uint64_t bits = 1;
  for (int i = 0; i < 50000; ++i) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    const double value = __builtin_bit_cast(double, bits);
    if (!std::isfinite(value)) continue;
    double back = 0;
    ASSERT_TRUE(parse_number(shortest(value), back)) << shortest(value);
    ASSERT_EQ(__builtin_bit_cast(std::uint64_t, back), bits) << shortest(value);
  }
}

TEST(NumberText, RoundedForm) {
  EXPECT_EQ(rounded(1.0 / 3.0, 9), "0.333333333");
  EXPECT_EQ(rounded(2.0, 9), "2");
  EXPECT_EQ(rounded(std::numeric_limits<double>::quiet_NaN(), 9), "nan");
  EXPECT_EQ(rounded(std::numeric_limits<double>::infinity(), 9), "inf");
  EXPECT_EQ(rounded(-std::numeric_limits<double>::infinity(), 9), "-inf");
}

TEST(NumberText, ParsesDecimalsOnly) {
  double value = 0;
  for (const char* good : {"0", "-1", "+1", "1.5", ".5", "5.", "1e3", "1E-3", "-.5e+2"}) {
    EXPECT_TRUE(parse_number(good, value)) << good;
    EXPECT_EQ(value, std::strtod(good, nullptr)) << good;
  }
  for (const char* bad : {"", "-", ".", "e3", "1e", "1e+", "0x10", "nan", "inf", "infinity", "1,5", "1 ",
                          " 1", "1e999", "--1", "1f"}) {
    EXPECT_FALSE(parse_number(bad, value)) << bad;
  }
  EXPECT_FALSE(parse_number(std::string(500, '1'), value));
  EXPECT_FALSE(parse_number(std::string_view("1\0", 2), value));
}

TEST(JsonWriter, QuotesAndLayout) {
  JsonWriter json;
  json.begin_object();
  json.field("text", "a\"b\\c\n\t\x01");
  json.field("number", std::numeric_limits<double>::infinity());
  json.key("list").begin_array(JsonLayout::one_line);
  json.value(1);
  json.value(Vec3{1, 2, 3});
  json.begin_object();
  json.end_object();
  json.end_array();
  json.key("empty").begin_array();
  json.end_array();
  json.key("lines").begin_array();
  json.value(true);
  json.null();
  json.end_array();
  json.end_object();
  EXPECT_EQ(json.take(),
            "{\n  \"text\": \"a\\\"b\\\\c\\n\\u0009\\u0001\",\n  \"number\": null,\n  \"list\": [1, [1, 2, "
            "3], {}],\n"
            "  \"empty\": [],\n  \"lines\": [\n    true,\n    null\n  ]\n}\n");
}

}  // namespace
}  // namespace gyre::number_text_test
