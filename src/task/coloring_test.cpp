// Colourings are valid for random graphs, use few colours if few are enough, and depend on the input alone.
#include "task/coloring.h"

#include "base/container/bitset.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace gyre::coloring_test {
namespace {

using Pairs = std::vector<ColoringPair>;
constexpr std::uint32_t kNone = ColoringPair::kNone;

int colors_used(const Coloring& coloring) {
  int used = 0;
  for (int g = 0; g < coloring.overflow_group(); ++g) used += coloring.group(g).empty() ? 0 : 1;
  return used;
}

Pairs random_pairs(std::size_t count, std::uint32_t bodies, unsigned seed) {
  std::mt19937 random(seed);
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i) {
    ColoringPair pair{static_cast<std::uint32_t>(random() % bodies),
                      static_cast<std::uint32_t>(random() % bodies)};
    if (random() % 10 == 0) pair.a = kNone;
    if (random() % 10 == 0) pair.b = kNone;
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(Coloring, NothingToColour) {
  Coloring coloring;
  color_constraints({}, {}, 0, {}, {}, coloring);
  EXPECT_TRUE(validate_coloring({}, 0, {}, {}, coloring));
  EXPECT_EQ(coloring.group_count(), 33);
  EXPECT_TRUE(coloring.group(coloring.overflow_group()).empty());
}

TEST(Coloring, RandomGraphsAreValid) {
  Coloring coloring;
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const int max_colors : {1, 4, 32, 64}) {
      const std::uint32_t bodies = 1 + seed * 37;
      const Pairs pairs = random_pairs(seed * 100, bodies, seed);
      Bitset fixed(bodies / 2 + 1);
      for (std::uint32_t i = 0; i < fixed.size(); i += 5) fixed.set(i);
      for (const bool statics_last : {false, true}) {
        const ColoringOptions options{.max_colors = max_colors, .statics_last = statics_last};
        color_constraints(pairs, {}, bodies, fixed.words(), options, coloring);
        ASSERT_TRUE(validate_coloring(pairs, bodies, fixed.words(), options, coloring));
        ASSERT_EQ(coloring.group_count(), max_colors + 1);
      }
    }
  }
}

TEST(Coloring, AChainNeedsTwoColours) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < 100; ++i) pairs.push_back({i, i + 1});
  Coloring coloring;
  color_constraints(pairs, {}, 101, {}, {}, coloring);
  EXPECT_EQ(colors_used(coloring), 2);
  EXPECT_EQ(coloring.group(0).size(), 50u);
}

TEST(Coloring, ACompleteGraphStaysWithinTheGreedyBound) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < 16; ++i) {
    for (std::uint32_t k = i + 1; k < 16; ++k) pairs.push_back({i, k});
  }
  Coloring coloring;
  color_constraints(pairs, {}, 16, {}, {}, coloring);
  EXPECT_GE(colors_used(coloring), 15) << "each body has 15 constraints";
  EXPECT_LE(colors_used(coloring), 29);
  EXPECT_TRUE(coloring.group(coloring.overflow_group()).empty());
}

TEST(Coloring, StaticBodiesDoNotConflict) {
  Pairs pairs;
  for (std::uint32_t i = 1; i <= 1000; ++i) pairs.push_back({0, i});
  Bitset fixed(1);
  fixed.set(0);
  Coloring coloring;
  color_constraints(pairs, {}, 1001, fixed.words(), {}, coloring);
  EXPECT_EQ(coloring.group(0).size(), 1000u);
  for (ColoringPair& pair : pairs) pair.a = kNone;
  color_constraints(pairs, {}, 1001, {}, {}, coloring);
  EXPECT_EQ(coloring.group(0).size(), 1000u);
}

TEST(Coloring, ABusyBodyOverflows) {
  Pairs pairs;
  for (std::uint32_t i = 1; i <= 100; ++i) pairs.push_back({i, 0});
  Coloring coloring;
  color_constraints(pairs, {}, 101, {}, {.max_colors = 24}, coloring);
  const std::span<const std::uint32_t> overflow = coloring.group(coloring.overflow_group());
  ASSERT_EQ(overflow.size(), 76u);
  for (std::uint32_t i = 0; i < 76; ++i) EXPECT_EQ(overflow[i], 24 + i) << "the last ones, in order";
}

TEST(Coloring, StaticsComeLast) {
  // A pile: neighbours touch, and all touch the ground.
  Pairs pairs;
  for (std::uint32_t i = 0; i < 50; ++i) {
    pairs.push_back({kNone, i});
    if (i > 0) pairs.push_back({i - 1, i});
  }
  Coloring coloring;
  const ColoringOptions options{.max_colors = 12, .statics_last = true};
  color_constraints(pairs, {}, 50, {}, options, coloring);
  ASSERT_TRUE(validate_coloring(pairs, 50, {}, options, coloring));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].a == kNone) {
      EXPECT_EQ(coloring.color[i], 11);
    } else {
      EXPECT_LT(coloring.color[i], 3);
    }
  }
}

// A row of bricks on a row of bricks, each on two: counts those whose left contact chooses first.
int bricks_with_left_before_right(std::span<const std::uint32_t> names_of_one_row, std::uint32_t rows) {
  const std::uint32_t width = static_cast<std::uint32_t>(names_of_one_row.size()) / 2;
  Pairs pairs;
  std::vector<std::uint32_t> names;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t i = 0; i < 2 * width; ++i) {
      pairs.push_back({row * (width + 1) + (i + 1) / 2, (row + 1) * (width + 1) + i / 2});
      names.push_back(names_of_one_row[i] + 2 * width * row);
    }
  }
  Coloring coloring;
  color_constraints(pairs, names, (rows + 1) * (width + 1), {}, {}, coloring);
  EXPECT_TRUE(validate_coloring(pairs, (rows + 1) * (width + 1), {}, {}, coloring));
  EXPECT_LE(colors_used(coloring), 6);
  int left_first = 0;
  for (std::size_t i = 0; i < pairs.size(); i += 2)
    left_first += coloring.color[i] < coloring.color[i + 1] ? 1 : 0;
  return left_first;
}

TEST(Coloring, RunsFavourNoDirection) {
  std::vector<std::uint32_t> names(100);
  for (std::uint32_t i = 0; i < 100; ++i) names[i] = i;
  const int bricks = 50 * 50, left_first = bricks_with_left_before_right(names, 50);
  EXPECT_GT(left_first, bricks * 4 / 10);
  EXPECT_LT(left_first, bricks * 6 / 10);
}

TEST(Coloring, OtherConstraintsOfTheirOwnChangeNothing) {
  // As for islands solved together or separately: colours follow from names, not from positions in the list.
  const std::uint32_t bodies = 40;
  const Pairs alone = random_pairs(300, bodies, 3);
  Pairs both;
  std::vector<std::uint32_t> names, names_of_both;
  for (std::uint32_t i = 0; i < alone.size(); ++i) {
    names.push_back(3 * i);
    both.push_back(alone[i]), names_of_both.push_back(3 * i);
    both.push_back({bodies + i, bodies + i + 1}), names_of_both.push_back(3 * i + 1);
  }
  Coloring of_alone, of_both;
  color_constraints(alone, names, bodies, {}, {}, of_alone);
  color_constraints(both, names_of_both, bodies + 301, {}, {}, of_both);
  for (std::size_t i = 0; i < alone.size(); ++i) ASSERT_EQ(of_alone.color[i], of_both.color[2 * i]);
}

TEST(Coloring, SameInputSameResultWithoutAllocating) {
  const Pairs pairs = random_pairs(3000, 400, 1);
  Coloring first, second;
  color_constraints(pairs, {}, 400, {}, {}, first);
  color_constraints(random_pairs(5000, 700, 2), {}, 700, {}, {.statics_last = true}, second);
  const std::uint64_t before = allocation_count();
  color_constraints(pairs, {}, 400, {}, {}, second);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(first.color == second.color);
  EXPECT_TRUE(first.order == second.order);
  EXPECT_TRUE(first.offsets == second.offsets);
}

TEST(Coloring, ValidateFindsDamage) {
  const Pairs pairs = {{0, 1}, {1, 2}, {2, 3}};
  Coloring good;
  color_constraints(pairs, {}, 4, {}, {}, good);
  ASSERT_TRUE(validate_coloring(pairs, 4, {}, {}, good));
  EXPECT_FALSE(validate_coloring(Pairs{{0, 1}, {1, 2}, {0, 3}}, 4, {}, {}, good))
      << "a body twice in a colour";
  EXPECT_FALSE(validate_coloring(Pairs{{0, 1}, {1, 2}}, 4, {}, {}, good)) << "another number of constraints";
  Coloring bad = good;
  bad.color[0] = 1;
  EXPECT_FALSE(validate_coloring(pairs, 4, {}, {}, bad)) << "a colour that is not the group";
  bad = good;
  std::swap(bad.order[0], bad.order[1]);
  EXPECT_FALSE(validate_coloring(pairs, 4, {}, {}, bad)) << "not ascending";
  bad = good;
  bad.order[1] = 0;
  EXPECT_FALSE(validate_coloring(pairs, 4, {}, {}, bad)) << "one twice";
  bad = good;
  bad.offsets[1] = 9;
  EXPECT_FALSE(validate_coloring(pairs, 4, {}, {}, bad)) << "offsets beyond the end";
}

}  // namespace
}  // namespace gyre::coloring_test
