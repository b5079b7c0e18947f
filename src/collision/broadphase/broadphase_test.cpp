// Every broad phase against plain loops: it finds exactly the pairs that overlap, may pair, and have a moved proxy.
// Random, clustered and degenerate worlds change from frame to frame, for any number of threads.
#include "collision/broadphase/broadphase.h"

#include "base/memory/memory.h"
#include "collision/broadphase/broadphase_bvh.h"
#include "collision/broadphase/fat_box.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace gyre::broadphase_test {
namespace {

using testing_random::Random;

enum class Layout { spread, clustered, one_place, mixed_sizes, flat, line, far_away, wild };

struct World {
  Random random;
  Layout layout;
  std::vector<Proxy> proxies;

  World(Layout with_layout, int count) : layout(with_layout) {
    for (int i = 0; i < count; ++i) proxies.push_back(make(std::uint32_t(i)));
  }

  Aabb box() {
    Vec3 middle = random.vector(-20, 20), half = random.vector(0.2f, 1.0f);
    switch (layout) {
      case Layout::spread:
        break;
      case Layout::clustered:
        middle = random.vector(-2, 2) + float(random.next(6)) * Vec3{10, 3, -7};
        break;
      case Layout::one_place:
        middle = {5, 5, 5};
        half = {0.5f, 0.5f, 0.5f};
        break;
      case Layout::mixed_sizes: {
        const float scale = random.next(40) == 0 ? 1000.0f : random.next(10) == 0 ? 30.0f : 0.05f;
        half = half * scale;
        break;
      }
      case Layout::flat:
        middle.y = 0.0f;
        half.y = 0.0f;
        break;
      case Layout::line:
        middle = {random.real(-500, 500), 0, 0};
        break;
      case Layout::far_away:
        middle = random.vector(-20, 20) + Vec3{3.0e6f, -7.0e6f, 1.0e6f};
        break;
      case Layout::wild:  // from micrometres to the largest floats
        middle = std::ldexp(1.0f, int(random.next(60)) - 30) * random.vector(-1, 1);
        half = std::ldexp(1.0f, int(random.next(50)) - 25) * random.vector(0, 1);
        break;
    }
    Aabb made{middle - half, middle + half};
    if (random.next(150) == 0)
      made = {{-kUnbounded, -kUnbounded, -kUnbounded}, {kUnbounded, middle.y, kUnbounded}};
    return made;
  }

  Proxy make(std::uint32_t index) {
    Proxy proxy;
    proxy.fat_box = box();
    proxy.body = random.next(3) == 0 ? index / 2 : index;
    proxy.motion = random.next(3) == 0 ? ProxyMotion::fixed : ProxyMotion::moving;
    proxy.pushes = proxy.motion == ProxyMotion::moving && random.next(8) != 0;
    proxy.sensor = random.next(12) == 0;
    proxy.filter.layer = 1u << random.next(3);
    proxy.filter.collides_with = random.next(4) == 0 ? 3u : 0xffffffffu;
    proxy.filter.group = random.next(10) == 0 ? int(random.next(5)) - 2 : 0;
    return proxy;
  }

  // Moves, adds, removes and rotates some; returns their indices, ascending.
  std::vector<std::uint32_t> change(std::uint32_t share) {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < proxies.size(); ++i) {
      if (random.next(share) != 0) continue;
      changed.push_back(i);
      Proxy& proxy = proxies[i];
      switch (random.next(12)) {
        case 0:
          proxy.motion = ProxyMotion::none;
          break;
        case 1:
          proxy = make(i);
          break;
        case 2:
          proxy.motion = ProxyMotion::fixed;
          break;
        case 3:
          proxy.motion = ProxyMotion::moving;
          break;
        default: {
          const Vec3 by = random.next(20) == 0 ? random.vector(-15, 15) : random.vector(-0.3f, 0.3f);
          proxy.fat_box = {proxy.fat_box.low + by, proxy.fat_box.high + by};
        }
      }
    }
    for (std::uint32_t n = random.next(4); n > 0; --n) {
      changed.push_back(std::uint32_t(proxies.size()));
      proxies.push_back(make(std::uint32_t(proxies.size())));
    }
    return changed;
  }

  std::vector<std::uint64_t> expected(const std::vector<std::uint32_t>& moved) const {
    std::vector<std::uint64_t> keys;
    for (const std::uint32_t i : moved) {
      for (std::uint32_t k = 0; k < proxies.size(); ++k) {
        if (k == i || !overlap(proxies[i].fat_box, proxies[k].fat_box) || !may_pair(proxies[i], proxies[k]))
          continue;
        keys.push_back(pair_key(i, k));
      }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  }
};

std::vector<std::uint64_t> to_vector(const Array<std::uint64_t>& keys) { return {keys.begin(), keys.end()}; }

std::vector<BroadPhaseKind> all_kinds() {
  std::vector<BroadPhaseKind> kinds;
  for (int i = 0; i < kBroadPhaseKindCount; ++i) kinds.push_back(BroadPhaseKind(i));
  return kinds;
}

// A caller that keeps the nearest hit of a cast; the distance to each box replaces an exact test.
struct NearestHit {
  float max_fraction = 1.0f;
  std::uint32_t index = 0xffffffffu;
  bool operator==(const NearestHit&) const = default;
};
NearestHit nearest(const Broadphase& broadphase, const std::vector<Proxy>& proxies, const CastBox& cast_box) {
  NearestHit best;
  broadphase.cast(proxies, cast_box, 1.0f, [&](std::uint32_t index, float max_fraction) {
    float low = 0.0f, high = 1.0f;
    if (!meets(cast_box, 0.0f, proxies[index].fat_box)) {
      for (int i = 0; i < 30; ++i) {
        const float middle = 0.5f * (low + high);
        (meets(cast_box, middle, proxies[index].fat_box) ? high : low) = middle;
      }
    } else {
      high = 0.0f;
    }
    if (high < best.max_fraction || (high == best.max_fraction && index < best.index)) best = {high, index};
    return std::min(max_fraction, best.max_fraction);
  });
  return best;
}

CastBox random_cast(World& world) {
  Random& random = world.random;
  CastBox cast_box{DVec3(random.vector(-25, 25)), random.vector(-40, 40), {}};
  if (random.next(3) == 0) cast_box.half_extents = random.vector(0, 1);
  if (random.next(3) == 0) cast_box.translation = {0, random.real(-30, 30), 0};
  if (random.next(12) == 0) cast_box.translation = {};
  if (world.layout == Layout::flat && random.next(2) == 0) cast_box.start.y = cast_box.translation.y = 0.0f;
  if (world.layout == Layout::line)
    cast_box = {{random.real(-600, 600), 0, 0}, {random.real(-900, 900), 0, 0}, {}};
  return cast_box;
}

void expect_same_answers(World& world, const Broadphase& broadphase, const Broadphase& brute) {
  const Aabb box = world.box();
  Array<std::uint32_t> a{7u}, b{7u};
  brute.query(world.proxies, box, a);
  broadphase.query(world.proxies, box, b);
  ASSERT_EQ(a, b);
  for (int i = 0; i < 20; ++i) {
    const CastBox cast_box = random_cast(world);
    std::vector<std::uint32_t> expected, found;
    for (std::uint32_t k = 0; k < world.proxies.size(); ++k) {
      if (world.proxies[k].motion != ProxyMotion::none && meets(cast_box, 0.8f, world.proxies[k].fat_box))
        expected.push_back(k);
    }
    EXPECT_EQ(broadphase.cast(world.proxies, cast_box, 0.8f,
                              [&](std::uint32_t index, float max_fraction) {
                                found.push_back(index);
                                return max_fraction;
                              }),
              0.8f);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected);
    ASSERT_EQ(nearest(broadphase, world.proxies, cast_box), nearest(brute, world.proxies, cast_box));
    if (expected.empty()) continue;
    int visits = 0;
    broadphase.cast(world.proxies, cast_box, 0.8f, [&](std::uint32_t, float) {
      ++visits;
      return -1.0f;
    });
    ASSERT_EQ(visits, 1);
  }
}

class BroadphaseOracle : public testing::TestWithParam<Layout> {};

TEST_P(BroadphaseOracle, EqualsPlainLoopsInAChangingWorld) {
  World world(GetParam(), 700);
  std::vector<std::unique_ptr<Broadphase>> broadphases;
  for (const BroadPhaseKind kind : all_kinds()) broadphases.push_back(make_broadphase(kind));
  const auto brute = make_broadphase(BroadPhaseKind::brute_force);
  TaskSystem one(1), three(3);
  std::size_t found = 0;
  for (int frame = 0; frame < 110; ++frame) {
    // The first frame adds all at once; some frames change almost everything, some almost nothing.
    std::vector<std::uint32_t> changed = world.change(frame == 0        ? 1
                                                      : frame % 20 == 0 ? 2
                                                      : frame % 3 == 0  ? 60
                                                                        : 12);
    const std::vector<std::uint64_t> expected = world.expected(changed);
    for (const auto& broadphase : broadphases) {
      SCOPED_TRACE(std::to_string(frame) + ", " +
                   to_string(BroadPhaseKind(&broadphase - broadphases.data())));
      broadphase->update(world.proxies, changed);
      ASSERT_STREQ(broadphase->find_fault(world.proxies, {}), nullptr);
      Array<std::uint64_t> pairs, by_threads;
      broadphase->find_pairs(world.proxies, changed, one, pairs);
      broadphase->find_pairs(world.proxies, changed, three, by_threads);
      ASSERT_EQ(to_vector(pairs), expected);
      ASSERT_EQ(to_vector(by_threads), expected);
      if (frame % 10 == 5) expect_same_answers(world, *broadphase, *brute);
      broadphase->trim();
    }
    found += expected.size();
  }
  EXPECT_GT(found, 500u) << "the world is too empty to test anything";
}

INSTANTIATE_TEST_SUITE_P(Layouts, BroadphaseOracle,
                         testing::Values(Layout::spread, Layout::clustered, Layout::one_place,
                                         Layout::mixed_sizes, Layout::flat, Layout::line, Layout::far_away,
                                         Layout::wild));

TEST(Broadphase, EveryThreadCountFindsTheSame) {
  World world(Layout::spread, 3000);
  std::vector<std::uint32_t> all(world.proxies.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::vector<std::uint64_t> expected = world.expected(all);
  for (int threads = 1; threads <= 4; ++threads) {
    TaskSystem tasks(threads);
    for (const BroadPhaseKind kind : all_kinds()) {
      const auto broadphase = make_broadphase(kind);
      broadphase->rebuild(world.proxies);
      Array<std::uint64_t> pairs;
      broadphase->find_pairs(world.proxies, all, tasks, pairs);
      ASSERT_EQ(to_vector(pairs), expected) << threads;
    }
  }
}

// So many that trees are deep, and all of them move: the upkeep from step to step must not degrade.
TEST(Broadphase, ManyThatAllMove) {
  TaskSystem tasks(2);
  for (const Layout layout : {Layout::spread, Layout::clustered, Layout::mixed_sizes}) {
    World world(layout, 2500);
    std::vector<Vec3> velocities;
    for (std::size_t i = 0; i < world.proxies.size(); ++i) velocities.push_back(world.random.vector(-1, 1));
    std::vector<std::unique_ptr<Broadphase>> broadphases;
    for (const BroadPhaseKind kind : all_kinds()) {
      broadphases.push_back(make_broadphase(kind));
      broadphases.back()->rebuild(world.proxies);
    }
    for (int frame = 0; frame < 18; ++frame) {
      std::vector<std::uint32_t> moved;
      for (std::uint32_t i = 0; i < world.proxies.size(); ++i) {
        if (world.proxies[i].motion == ProxyMotion::fixed || (frame % 3 != 0 && i % 7 == 0)) continue;
        Aabb& box = world.proxies[i].fat_box;
        box = {box.low + velocities[i], box.high + velocities[i]};
        moved.push_back(i);
      }
      Array<std::uint64_t> expected;
      for (std::size_t k = broadphases.size(); k-- > 0;) {
        broadphases[k]->update(world.proxies, moved);
        if (frame % 9 != 8) continue;
        Array<std::uint64_t> pairs;
        broadphases[k]->find_pairs(world.proxies, moved, tasks, pairs);
        if (expected.empty()) expected = pairs;
        ASSERT_EQ(to_vector(pairs), to_vector(expected)) << to_string(BroadPhaseKind(k)) << ", " << frame;
        ASSERT_STREQ(broadphases[k]->find_fault(world.proxies, {}), nullptr) << to_string(BroadPhaseKind(k));
      }
    }
  }
}

TEST(Broadphase, RebuildReplacesEverything) {
  World world(Layout::spread, 300);
  World other(Layout::clustered, 120);
  for (const BroadPhaseKind kind : all_kinds()) {
    const auto broadphase = make_broadphase(kind);
    broadphase->rebuild(world.proxies);
    broadphase->rebuild(other.proxies);
    EXPECT_STREQ(broadphase->find_fault(other.proxies, {}), nullptr) << to_string(kind);
    expect_same_answers(other, *broadphase, *make_broadphase(BroadPhaseKind::brute_force));
  }
}

// All proxies are added, removed one by one, and added again.
TEST(Broadphase, EmptiesAndFillsAgain) {
  World world(Layout::clustered, 150);
  const std::vector<Proxy> all = world.proxies;
  TaskSystem tasks(1);
  for (const BroadPhaseKind kind : all_kinds()) {
    const auto broadphase = make_broadphase(kind);
    world.proxies = all;
    broadphase->rebuild(world.proxies);
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      world.proxies[i].motion = ProxyMotion::none;
      broadphase->update(world.proxies, {&i, 1});
      ASSERT_STREQ(broadphase->find_fault(world.proxies, {}), nullptr) << to_string(kind) << " without " << i;
    }
    expect_same_answers(world, *broadphase, *make_broadphase(BroadPhaseKind::brute_force));
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      world.proxies[i] = all[i];
      broadphase->update(world.proxies, {&i, 1});
      Array<std::uint64_t> pairs;
      broadphase->find_pairs(world.proxies, {&i, 1}, tasks, pairs);
      ASSERT_EQ(to_vector(pairs), world.expected({i})) << to_string(kind) << " with " << i;
    }
    ASSERT_STREQ(broadphase->find_fault(world.proxies, {}), nullptr) << to_string(kind);
  }
}

TEST(Broadphase, NothingAtAll) {
  TaskSystem tasks(1);
  for (const BroadPhaseKind kind : all_kinds()) {
    const auto broadphase = make_broadphase(kind);
    Array<std::uint64_t> pairs;
    Array<std::uint32_t> found;
    broadphase->rebuild({});
    broadphase->update({}, {});
    broadphase->find_pairs({}, {}, tasks, pairs);
    broadphase->query({}, {{-1, -1, -1}, {1, 1, 1}}, found);
    EXPECT_EQ(broadphase->cast({}, {{}, {1, 0, 0}, {}}, 1.0f, [](std::uint32_t, float) { return -1.0f; }),
              1.0f);
    EXPECT_TRUE(pairs.empty());
    EXPECT_TRUE(found.empty());
  }
}

TEST(Broadphase, FixedProxiesPairWithFixedSensorsAlone) {
  World world(Layout::one_place, 50);
  for (Proxy& proxy : world.proxies) proxy.motion = ProxyMotion::fixed, proxy.sensor = false;
  std::vector<std::uint32_t> all(world.proxies.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  EXPECT_TRUE(world.expected(all).empty());
  for (std::uint32_t i = 0; i < all.size(); ++i) world.proxies[i].filter = {}, world.proxies[i].body = i;
  world.proxies[7].sensor = true;
  EXPECT_EQ(world.expected(all).size(), world.proxies.size() - 1);
}

TEST(Broadphase, AllocatesNothingOnceWarm) {
  for (const BroadPhaseKind kind : all_kinds()) {
    World world(Layout::spread, 1000);
    const auto broadphase = make_broadphase(kind);
    TaskSystem tasks(2);
    Array<std::uint64_t> pairs;
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < world.proxies.size(); i += 3) changed.push_back(i);
    broadphase->rebuild(world.proxies);
    std::uint64_t allocations = 0;
    for (int frame = 0; frame < 280; ++frame) {
      if (frame == 200) allocations = allocation_count();
      const Vec3 by = frame % 2 == 0 ? Vec3{0.7f, 0, 0} : Vec3{-0.7f, 0, 0};
      for (const std::uint32_t i : changed) {
        Aabb& box = world.proxies[i].fat_box;
        box = {box.low + by, box.high + by};
      }
      broadphase->update(world.proxies, changed);
      pairs.clear();
      broadphase->find_pairs(world.proxies, changed, tasks, pairs);
    }
    EXPECT_EQ(allocation_count(), allocations) << to_string(kind);
  }
}

// After a long random walk the tree is not much worse than a new one.
TEST(BoxTree, KeepsItsQuality) {
  Random random;
  BoxTree tree;
  std::vector<Aabb> boxes;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec3 middle = random.vector(-20, 20);
    boxes.push_back({middle - Vec3{0.5f, 0.5f, 0.5f}, middle + Vec3{0.5f, 0.5f, 0.5f}});
    tree.insert(i, boxes.back());
  }
  ASSERT_STREQ(tree.find_fault(), nullptr);
  for (int frame = 0; frame < 300; ++frame) {
    for (int n = 0; n < 100; ++n) {
      const std::uint32_t i = random.next(2000);
      const Vec3 by = random.vector(-2, 2);
      boxes[i] = {boxes[i].low + by, boxes[i].high + by};
      tree.move(i, boxes[i]);
    }
    tree.improve(4 * 128);
  }
  ASSERT_STREQ(tree.find_fault(), nullptr);
  std::vector<std::uint32_t> items(boxes.size());
  for (std::uint32_t i = 0; i < items.size(); ++i) items[i] = i;
  BoxTree fresh;
  fresh.build(items, boxes);
  ASSERT_STREQ(fresh.find_fault(), nullptr);
  EXPECT_LT(tree.cost(), 1.6 * fresh.cost());
}

// A tree whose boxes all move is refitted, and rebuilt once it is much worse; queries find the overlaps either way.
TEST(BoxTree, RefitsWhileThatIsGood) {
  Random random;
  BoxTree tree, fresh;
  std::vector<Aabb> boxes;
  std::vector<std::uint32_t> items;
  std::vector<Vec3> velocities;
  const Vec3 half{0.5f, 0.5f, 0.5f};
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec3 middle = random.vector(-20, 20);
    boxes.push_back({middle - half, middle + half});
    items.push_back(i);
    velocities.push_back(random.vector(-1, 1));
  }
  tree.build(items, boxes);
  int built = 0;
  for (int frame = 0; frame < 60; ++frame) {
    // First all together, then each by itself.
    for (std::uint32_t i = 0; i < items.size(); ++i) {
      const Vec3 by = frame < 20 ? Vec3{0.3f, -0.5f, 0.1f} : velocities[i];
      boxes[i] = {boxes[i].low + by, boxes[i].high + by};
      tree.set_box(i, boxes[i]);
    }
    if (!tree.refit()) {
      tree.build(items, boxes);
      ++built;
    }
    ASSERT_STREQ(tree.find_fault(), nullptr) << frame;
    if (frame == 19) {
      EXPECT_EQ(built, 0);
    }
    if (frame % 10 != 9) continue;
    fresh.build(items, boxes);
    EXPECT_LT(tree.cost(), 1.6 * fresh.cost()) << frame;
    const Aabb asked = boxes[std::size_t(frame)];
    std::vector<std::uint32_t> found, expected;
    tree.for_each_overlap(asked, [&](std::uint32_t item) { found.push_back(item); });
    for (const std::uint32_t i : items) {
      if (overlap(boxes[i], asked)) expected.push_back(i);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << frame;
  }
  EXPECT_GT(built, 0);
  EXPECT_LT(built, 40);
}

TEST(BoxTree, PartitionPutsTheLowerOnesFirst) {
  Random random;
  struct Entry {
    Aabb box;
    std::uint32_t child;
  };
  for (int round = 0; round < 300; ++round) {
    const std::size_t count = 1 + random.next(60);
    std::vector<Entry> entries(count);
    for (Entry& entry : entries) {
      const float x = float(random.next(round % 2 == 0 ? 4 : 1000));
      entry.box = {{x, x, x}, {x, x, x}};
    }
    const std::size_t middle = random.next(std::uint32_t(count) + 1);
    partition_by_center(std::span<Entry>(entries), middle, round % 3);
    float highest = -1.0f;
    for (std::size_t i = 0; i < middle; ++i) highest = std::max(highest, entries[i].box.low.x);
    for (std::size_t i = middle; i < count; ++i) ASSERT_LE(highest, entries[i].box.low.x);
  }
}

}  // namespace
}  // namespace gyre::broadphase_test
