// Stress and strain as colours: what is read at vertices, the range of a movie, the words of the key.
#include "render/soft_reading.h"

#include <gtest/gtest.h>

#include <limits>

namespace gyre::soft_reading_test {
namespace {

World weightless() { return std::move(*World::create({.gravity = {}})); }

TEST(SoftReading, AVertexHasTheMeanOfItsElements) {
  World world = weightless();
  const SoftId rope =
      world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .links = RopeLinks::springs});
  ASSERT_TRUE(world.set_vertices(rope, std::vector<DVec3>{{0, 0, 0}, {1.5, 0, 0}, {2.5, 0, 0}}, {}));
  const std::vector<float> strain = read_by_vertex(world, rope, SoftReading::strain);
  ASSERT_EQ(strain.size(), 3u);
  EXPECT_NEAR(strain[0], 0.5f, 1e-6f);
  EXPECT_NEAR(strain[1], 0.25f, 1e-6f);
  EXPECT_NEAR(strain[2], 0.0f, 1e-6f);
  EXPECT_TRUE(read_by_vertex(world, rope, SoftReading::stress).empty());
  EXPECT_TRUE(read_by_vertex(world, rope, SoftReading::none).empty());
  const SoftId solid = world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {2, 2, 2}}});
  EXPECT_EQ(read_by_vertex(world, solid, SoftReading::stress).size(), 27u);
}

// One element in a thousand does not make the others look alike, and what is not finite is left out.
TEST(SoftReading, TheRangeHoldsWhatIsSeenInAllFrames) {
  RangeFinder finder;
  std::vector<float> first(1000, 0.1f), second(1000, -0.05f);
  first[7] = 50.0f, first[8] = std::numeric_limits<float>::infinity();
  finder.add(first), finder.add(second), finder.add({});
  EXPECT_NEAR(finder.range().high, 0.1, 1e-6);
  EXPECT_NEAR(finder.range().low, -0.05, 1e-6);
}

TEST(SoftReading, ColorsGoFromBlueToRed) {
  const ReadingRange range{-1.0, 3.0};
  const SceneColor low = reading_color(-1.0f, range), high = reading_color(3.0f, range);
  EXPECT_GT(low.blue, low.red + 100);
  EXPECT_GT(high.red, high.blue + 100);
  EXPECT_EQ(reading_color(-9.0f, range), low);
  EXPECT_EQ(reading_color(9.0f, range), high);
  EXPECT_EQ(reading_color(5.0f, {}), reading_color(0.0f, {}));
}

TEST(SoftReading, TheKeySaysItsUnit) {
  EXPECT_EQ(key_label(0.0123, SoftReading::strain), "1.2 %");
  EXPECT_EQ(key_label(-0.5, SoftReading::strain), "-50 %");
  EXPECT_EQ(key_label(1.0, SoftReading::strain), "100 %");
  EXPECT_EQ(key_label(25.0, SoftReading::strain), "2500 %");
  EXPECT_EQ(key_label(12.0, SoftReading::stress), "12 Pa");
  EXPECT_EQ(key_label(5100.0, SoftReading::stress), "5.1 kPa");
  EXPECT_EQ(key_label(2.5e6, SoftReading::stress), "2.5 MPa");
  EXPECT_EQ(key_label(7.0e9, SoftReading::stress), "7 GPa");
}

}  // namespace
}  // namespace gyre::soft_reading_test
