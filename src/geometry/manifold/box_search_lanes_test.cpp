// The axis search of two boxes in lanes against the search of one pair, at every width.
#include "geometry/manifold/box_search_lanes.h"

#include "geometry/manifold/manifold_box.h"
#include "random.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::box_search_lanes_test {
namespace {

using testing_random::Random;

struct BoxCase {
  Shape a, b;
  Transform a_from_b;
  float max_separation = 0.0f;
  PairCache cache;
};

// Level, all but level, or anyhow; near each other.
BoxCase random_case(Random& random) {
  BoxCase pair;
  pair.a = make_shape(Box{random.vector(0.2f, 1.0f)});
  pair.b = make_shape(Box{random.vector(0.2f, 1.0f)});
  const float tilts[] = {0.0f, 1.0e-5f, 1.0e-2f, 3.0f};
  const Vec3 axis = random.vector(-1.0f, 1.0f);
  pair.a_from_b = {random.vector(-1.5f, 1.5f), from_axis_angle(axis, tilts[random.next(4)])};
  pair.max_separation = random.real(0.0f, 0.2f);
  pair.cache.words[0] = random.next(17);
  return pair;
}

bool same_manifold(const LocalManifold& a, const LocalManifold& b) {
  return a.count == b.count &&
         (a.count == 0 || (a.normal == b.normal &&
                           std::memcmp(a.points, b.points, std::size_t(a.count) * sizeof a.points[0]) == 0));
}

// Lane `lane` has the case, all others have noise. Returns true if the search knew the axis.
template <int W>
bool expect_same(const BoxCase& pair, int lane) {
  const auto put = [&](float value) {
    Wide<W> lanes(1.0f);
    lanes.set(lane, value);
    return lanes;
  };
  const auto put_vector = [&](Vec3 v) { return Vec3W<W>{put(v.x), put(v.y), put(v.z)}; };
  const Quat q = pair.a_from_b.orientation;
  WideInt<W> favoured(boxes::kNoAxis);
  const std::uint32_t last = pair.cache.words[0] - 1u;
  if (last < std::uint32_t(boxes::kAxisCount)) favoured.set(lane, std::int32_t(last));
  const BoxPairLanes<W> lanes(put_vector(pair.a.extents), put_vector(pair.b.extents),
                              put_vector(pair.a_from_b.position), {put(q.x), put(q.y), put(q.z), put(q.w)});
  const AxisLanes<W> found = search_axes<W>(lanes, put(pair.max_separation), favoured);
  if (!found.known[lane]) return false;
  PairCache cache = pair.cache, cache_along = pair.cache;
  LocalManifold whole, along;
  collide_boxes(pair.a, pair.b, pair.a_from_b, pair.max_separation, cache, whole);
  collide_boxes_along({found.number[lane], found.separation[lane]}, pair.a, pair.b, pair.a_from_b,
                      pair.max_separation, cache_along, along);
  EXPECT_EQ(std::uint32_t(found.number[lane] + 1), cache.words[0]);
  EXPECT_EQ(std::memcmp(&cache, &cache_along, sizeof cache), 0);
  EXPECT_TRUE(same_manifold(whole, along));
  return true;
}

TEST(BoxSearchLanes, FindsWhatTheSearchOfOnePairFinds) {
  Random random(8);
  int known = 0;
  constexpr int kCases = 20000;
  for (int i = 0; i < kCases; ++i) {
    const BoxCase pair = random_case(random);
    const bool of_one = expect_same<1>(pair, 0);
    EXPECT_EQ(expect_same<4>(pair, i % 4), of_one);
    EXPECT_EQ(expect_same<8>(pair, i % 8), of_one);
    known += of_one;
    if (HasFailure()) return;
  }
  EXPECT_GT(known, kCases / 2);
  EXPECT_LT(known, kCases);
}

TEST(BoxSearchLanes, KnowsNothingOfWhatIsNotFinite) {
  Random random(9);
  BoxCase pair = random_case(random);
  pair.a_from_b.position.y = INFINITY;
  EXPECT_FALSE(expect_same<4>(pair, 2));
  pair.a_from_b = {{}, {NAN, 0, 0, 1}};
  EXPECT_FALSE(expect_same<4>(pair, 2));
}

}  // namespace
}  // namespace gyre::box_search_lanes_test
