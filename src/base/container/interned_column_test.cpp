// An interned column reads like a plain array, whatever was written.
#include "base/container/interned_column.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace gyre::interned_column_test {
namespace {

struct Record {
  float a = 0.0f;
  std::uint32_t b = 7;
};
std::array<std::uint32_t, 2> interning_key(const Record& r) { return words_of(r.a, r.b); }

TEST(InternedColumn, AgreesWithAnArray) {
  std::mt19937 random(3);
  InternedColumn<Record> column;
  std::vector<Record> expected;
  for (int round = 0; round < 5000; ++round) {
    if (random() % 50 == 0) {
      const std::size_t count = random() % 300;
      column.resize(count);
      expected.resize(count);
    }
    if (expected.empty()) continue;
    const std::size_t i = random() % expected.size();
    // Zeros of both signs are different records.
    const Record record{(random() % 2 == 0 ? -1.0f : 1.0f) * float(random() % 4),
                        static_cast<std::uint32_t>(random() % 5)};
    column.set(i, record);
    expected[i] = record;
    ASSERT_EQ(column.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_EQ(interning_key(column[k]), interning_key(expected[k]));
    ASSERT_LE(column.distinct(), 41u);
  }
  const InternedColumn<Record> copy = column;
  for (std::size_t k = 0; k < expected.size(); ++k)
    ASSERT_EQ(interning_key(copy[k]), interning_key(expected[k]));
}

TEST(InternedColumn, EqualRecordsCostFourBytes) {
  InternedColumn<Record> column;
  column.resize(100000);
  for (std::size_t i = 0; i < column.size(); ++i) column.set(i, Record{float(i % 3), 1});
  EXPECT_EQ(column.distinct(), 3u);
  EXPECT_LE(column.bytes(), 100000u * 4 + 1000);
}

}  // namespace
}  // namespace gyre::interned_column_test
