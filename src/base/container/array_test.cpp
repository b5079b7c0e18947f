// Array against std::vector under random calls, for plain and for owning elements; alignment and reuse of storage.
#include "base/container/array.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

namespace gyre::array_test {
namespace {

std::size_t length(std::span<const int> items) { return items.size(); }

TEST(Array, StartsWithoutMemory) {
  const std::uint64_t before = allocation_count();
  Array<int> numbers;
  EXPECT_TRUE(numbers.empty());
  EXPECT_EQ(numbers.bytes(), 0u);
  EXPECT_EQ(length(numbers), 0u);
  EXPECT_EQ(numbers.begin(), numbers.end());
  numbers.clear();
  numbers.assign(std::span<const int>{});
  Array<int> copy = numbers;
  EXPECT_TRUE(copy == numbers);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Array, StorageIsAlignedAndKept) {
  Array<char> text;
  for (int i = 0; i < 5000; ++i) {
    text.push_back('x');
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(text.data()) % 64, 0u);
  }
  const std::size_t room = text.capacity();
  EXPECT_LE(room, 2u * 5000);
  text.clear();
  EXPECT_EQ(text.capacity(), room);
  const std::uint64_t before = allocation_count();
  text.resize(room);
  text.assign(room, 'y');
  EXPECT_EQ(allocation_count(), before) << "what fits needs no memory";
}

TEST(Array, GrowthIsGeometric) {
  Array<std::uint64_t> numbers;
  const std::uint64_t before = allocation_count();
  for (std::uint64_t i = 0; i < 1000000; ++i) numbers.push_back(i);
  // Capacity doubles up to 16 KiB and then grows by an eighth: 8 MB are reached in a bounded number of moves, with
  // little to spare.
  EXPECT_LE(allocation_count() - before, 75u);
  EXPECT_LE(numbers.capacity(), numbers.size() / 8 * 9 + 8);
  for (std::uint64_t i = 0; i < 1000000; ++i) ASSERT_EQ(numbers[i], i);
}

TEST(Array, ResizeGivesZeroOrTheValue) {
  Array<float> numbers;
  numbers.resize(3, 2.5f);
  numbers.clear();
  numbers.resize(5);
  for (const float number : numbers) EXPECT_EQ(number, 0.0f);
  numbers.resize(8, 1.5f);
  EXPECT_EQ(numbers[4], 0.0f);
  EXPECT_EQ(numbers[5], 1.5f);
  numbers.resize(2);
  EXPECT_EQ(numbers.size(), 2u);
}

TEST(Array, TakesItsOwnElements) {
  Array<std::string> names{"a long enough name to be on the heap"};
  for (int i = 0; i < 100; ++i) names.push_back(names[0]);
  for (const std::string& name : names) ASSERT_EQ(name, names[0]);
  Array<std::uint64_t> numbers{7};  // plain elements, through the sizes at which the heap changes the block
  for (int i = 0; i < 100'000; ++i) numbers.push_back(numbers[0]);
  for (const std::uint64_t number : numbers) ASSERT_EQ(number, 7u);
  names.resize(names.capacity() + 1, names[0]);
  EXPECT_EQ(names.back(), names[0]);
  names.assign(3, names.back());
  EXPECT_EQ(names[2], "a long enough name to be on the heap");
  names.insert_at(1, names[2]);
  EXPECT_EQ(names[1], names[0]);
}

TEST(Array, ExpectsManyAtOnce) {
  Array<std::uint64_t> numbers;
  const std::uint64_t before = allocation_count();
  numbers.expect(100'000);
  for (std::uint64_t i = 0; i < 100'000; ++i) numbers.push_back(i);
  EXPECT_EQ(allocation_count(), before + 1);
  numbers.expect(100'001);
  EXPECT_GE(numbers.capacity(), 112'500u) << "an eighth more, so that the next few find room";
  numbers.expect(10);
  EXPECT_EQ(allocation_count(), before + 2);
  EXPECT_EQ(numbers.size(), 100'000u);
}

TEST(Array, TrimReleasesMemory) {
  const auto trims = [](auto& items, std::size_t kept) {
    const auto last = items[kept - 1];
    items.resize(kept);
    items.trim(kept + 10);
    EXPECT_EQ(items.capacity(), kept + 10);
    items.trim(kept + 20);
    EXPECT_EQ(items.capacity(), kept + 10) << "it never takes more";
    EXPECT_EQ(items.size(), kept);
    EXPECT_EQ(items.back(), last);
    items.clear();
    items.trim(0);
    EXPECT_EQ(items.bytes(), 0u);
  };
  Array<std::uint64_t> numbers;
  for (std::uint64_t i = 0; i < 100'000; ++i) numbers.push_back(i);
  trims(numbers, 40'000);
  Array<std::string> names;
  for (int i = 0; i < 1000; ++i) names.push_back("name " + std::to_string(i));
  trims(names, 300);
}

TEST(Array, ConvertsToSpans) {
  Array<int> numbers{1, 2, 3};
  const Array<int>& constant = numbers;
  const std::span<int> writable = numbers;
  const std::span<const int> readable = constant;
  const std::span<const int> from_writable = numbers;
  writable[1] = 7;
  EXPECT_EQ(readable[1], 7);
  EXPECT_EQ(from_writable.size(), 3u);
  EXPECT_EQ(length(numbers) + length(constant), 6u);
}

TEST(Array, MovesWithoutCopying) {
  Array<std::unique_ptr<int>> owners;
  for (int i = 0; i < 100; ++i) owners.push_back(std::make_unique<int>(i));
  owners.insert_at(0, std::make_unique<int>(-1));
  owners.erase_at(1);
  owners.swap_remove(5);
  EXPECT_EQ(*owners[0], -1);
  EXPECT_EQ(*owners[5], 99);
  const std::unique_ptr<int>* const storage = owners.data();
  Array<std::unique_ptr<int>> other = std::move(owners);
  EXPECT_EQ(other.data(), storage);
  EXPECT_EQ(other.size(), 99u);
  Array<std::unique_ptr<int>> third;
  third.push_back(nullptr);
  third = std::move(other);
  EXPECT_EQ(third.data(), storage);
}

TEST(Array, RunsEveryDestructorOnce) {
  const auto shared = std::make_shared<int>(1);
  {
    Array<std::shared_ptr<int>> holders;
    holders.resize(50, shared);
    EXPECT_EQ(shared.use_count(), 51);
    holders.resize(20);
    EXPECT_EQ(shared.use_count(), 21);
    holders.pop_back();
    holders.swap_remove(3);
    holders.swap_remove(holders.size() - 1);
    holders.erase_at(0);
    EXPECT_EQ(shared.use_count(), 17);
    const Array<std::shared_ptr<int>> copy = holders;
    EXPECT_EQ(shared.use_count(), 33);
    holders = copy;
    EXPECT_EQ(shared.use_count(), 33);
    holders = Array<std::shared_ptr<int>>{};
    EXPECT_EQ(shared.use_count(), 17);
  }
  EXPECT_EQ(shared.use_count(), 1);
}

template <class T, class Make>
void compare_with_vector(unsigned seed, const Make& make) {
  std::mt19937 random(seed);
  Array<T> array;
  std::vector<T> vector;
  for (int step = 0; step < 4000; ++step) {
    const std::size_t n = vector.size();
    const T value = make(step);
    const std::size_t at = random() % (n + 1);
    switch (random() % 9) {
      case 0:
      case 1:
      case 2:
        array.push_back(value), vector.push_back(value);
        break;
      case 3:
        array.insert_at(at, value), vector.insert(vector.begin() + static_cast<std::ptrdiff_t>(at), value);
        break;
      case 4:
        if (at == n) break;
        array.erase_at(at), vector.erase(vector.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 5:
        if (at == n) break;
        array.swap_remove(at), vector[at] = vector.back(), vector.pop_back();
        break;
      case 6:
        array.append(std::span<const T>(&value, 1)), vector.push_back(value);
        break;
      case 7:
        array.resize(at), vector.resize(at);
        break;
      case 8:
        array.resize(n + 3, value), vector.resize(n + 3, value);
        break;
    }
    ASSERT_EQ(array.size(), vector.size());
    for (std::size_t i = 0; i < vector.size(); ++i) ASSERT_EQ(array[i], vector[i]) << "step " << step;
  }
}

TEST(Array, BehavesLikeVector) {
  compare_with_vector<int>(1, [](int i) { return i; });
  compare_with_vector<std::string>(
      2, [](int i) { return std::to_string(i) + " and enough letters for the heap"; });
}

TEST(Array, ComparesByElement) {
  EXPECT_TRUE((Array<int>{1, 2} == Array<int>{1, 2}));
  EXPECT_FALSE((Array<int>{1, 2} == Array<int>{1, 3}));
  EXPECT_FALSE((Array<int>{1, 2} == Array<int>{1}));
}

int failures = 0;

TEST(Array, IndexOutsideIsNoticed) {
  if (!kAssertsActive) GTEST_SKIP() << "asserts are not compiled in";
  failures = 0;
  set_check_handler([](const char*, const char*, const char*, int) { ++failures; });
  Array<int> numbers{1, 2, 3};
  numbers.reserve(8);
  static_cast<void>(&numbers[3]);
  EXPECT_EQ(failures, 1);
  set_check_handler(nullptr);
}

}  // namespace
}  // namespace gyre::array_test
