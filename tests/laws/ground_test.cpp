// Ground in pieces: ramps of few and of many segments, a mesh whose cells are tiny under a body that is large, a plate that only
// turns. What rolls and slides does so as on one whole plane.
#include "laws/kit.h"

#include "random.h"

#include <chrono>

namespace gyre::laws::ground_test {
namespace {

// A patch of ground of so many cells, from a corner, two triangles each.
Geometry cells(int across, int along, double cell_x, double cell_z, DVec3 corner) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  for (int z = 0; z <= along; ++z) {
    for (int x = 0; x <= across; ++x)
      v.push_back(to_float(corner + DVec3{cell_x * double(x), 0, cell_z * double(z)}));
  }
  const auto at = [&](int x, int z) { return std::uint32_t(z * (across + 1) + x); };
  for (int z = 0; z < along; ++z) {
    for (int x = 0; x < across; ++x) {
      const std::uint32_t a = at(x, z), b = at(x + 1, z), c = at(x + 1, z + 1), d = at(x, z + 1);
      for (const std::uint32_t i : {a, c, b, a, d, c}) t.push_back(i);
    }
  }
  return *cook_mesh({.vertices = v, .indices = t});
}

constexpr double kRampAngle = 10.0, kRampLength = 20.0;

enum class Ramp { mesh, boxes };

// Five balls beside each other, down a ramp of segments, for 2.5 s: how far each is off the exact way down and across.
struct RampRun {
  double down, across;
};
RampRun roll_down(Ramp kind, int segments) {
  World world = make_world({.sleeping = false});
  const double angle = kRampAngle * double(kDegree), length = kRampLength / segments;
  const Quat turn = from_axis_angle({0, 0, 1}, float(-angle));
  const DVec3 downhill = turned(turn, {1, 0, 0}), up = turned(turn, {0, 1, 0});
  const BodyDef still{.type = BodyType::fixed, .pose = {.orientation = turn}};
  if (kind == Ramp::mesh) {
    world.add_body(still,
                   {.geometry = cells(segments, 1, length, 6.0, {0, 0, -3}), .material = surface(0.6f)});
  } else {
    for (int i = 0; i < segments; ++i) {
      BodyDef piece = still;
      piece.pose.position = (double(i) + 0.5) * length * downhill - 0.5 * up;
      world.add_body(piece, {.geometry = Box{{float(0.5 * length), 0.5f, 3}}, .material = surface(0.6f)});
    }
  }
  std::vector<BodyId> balls;
  std::vector<DVec3> starts;
  for (int i = 0; i < 5; ++i) {
    starts.push_back(0.7 * downhill + 0.25 * up + DVec3{0, 0, 1.13 * (i - 2)});
    balls.push_back(world.add_body({.pose = {.position = starts.back()}},
                                   {.geometry = Sphere{0.25f}, .material = surface(0.6f)}));
  }
  run(world, 2.5);
  const double exact = 0.5 * 5.0 / 7.0 * kGravity * std::sin(angle) * 2.5 * 2.5;
  RampRun off{0, 0};
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const DVec3 moved = world.pose(balls[i]).position - starts[i];
    off.down = std::max(off.down, std::fabs(dot(moved, downhill) / exact - 1.0));
    off.across = std::max(off.across, std::fabs(moved.z) / exact);
  }
  return off;
}

TEST(Ramp, OfFewAndOfManySegmentsIsOneRamp) {
  for (const Ramp kind : {Ramp::mesh, Ramp::boxes}) {
    for (const int segments : {3, 30}) {
      const RampRun off = roll_down(kind, segments);
      say("[row] A-163 %d segments, %s\n", segments,
                  kind == Ramp::mesh ? "one mesh" : "boxes laid flush");
      EXPECT_TRUE(limit_row("A-163 way down off the exact one (relative)", off.down, 2e-2, 1e-3));
      EXPECT_TRUE(limit_row("A-163 way across (relative)", off.across, 2e-2, 1e-3));
    }
  }
}

// A box of 5 m on cells of 1 cm: a quarter of a million cells under it, none of which may hold it. It slides as on a plane, at a
// bounded cost.
TEST(DenseMesh, DoesNotStallALargeBox) {
  World world = make_world({.sleeping = false});
  world.add_body({.type = BodyType::fixed},
                 {.geometry = cells(760, 520, 0.01, 0.01, {-2.6, 0, -2.6}), .material = surface(0.3f)});
  const BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}, .linear_velocity = {3, 0, 0}},
                                    {.geometry = Box{{2.5f, 0.5f, 2.5f}}, .material = surface(0.3f)});
  const auto begin = std::chrono::steady_clock::now();
  double lowest = 1.0, highest = 0.0;
  for (int i = 0; i < 30; ++i) {
    world.step(kStep);
    const double y = world.pose(box).position.y;
    lowest = std::min(lowest, y), highest = std::max(highest, y);
  }
  const double each = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 30.0;
  say("[row] A-164 milliseconds a step: %.2f\n", 1e3 * each);
  const double t = 0.5;
  EXPECT_TRUE(relative_row("A-164 way of a 5 m box on 1 cm cells (m)", world.pose(box).position.x,
                           3.0 * t - 0.5 * 0.3 * kGravity * t * t, 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("A-164 bump (m)", std::max(highest - 0.5, 0.5 - lowest), 1e-3, 1e-4));
  EXPECT_TRUE(
      limit_row("A-164 heading (rad)", std::fabs(std::atan2(world.pose(box).position.z, 1.0)), 1e-3, 1e-5));
}

// a long plate that spins in its place, without any speed along a way, and a ball that lies within its reach but not
// where the plate is at the ends of steps: it is struck, at every spin and every phase.
TEST(TurningPlate, StrikesABallInItsPath) {
  int missed = 0;
  for (const float rate : {40.0f, 100.0f, 190.0f}) {
    for (int phase = 0; phase < 12; ++phase) {
      World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
      const float angle = 0.15f + 0.11f * float(phase);
      world.add_body({.pose = {.orientation = from_axis_angle({0, 1, 0}, angle)},
                      .angular_velocity = {0, rate, 0},
                      .continuous = true,
                      .mass = 100.0f},
                     {.geometry = Box{{2.0f, 0.2f, 0.01f}}});
      const BodyId ball =
          world.add_body({.pose = {.position = {1.6, 0, 0}}, .mass = 0.1f}, {.geometry = Sphere{0.02f}});
      run(world, 0.5);
      missed += world.linear_velocity(ball) == Vec3{};
    }
  }
  EXPECT_TRUE(limit_row("A-154 balls of 36 that a turning plate missed", missed, 0, 0));
}

// a settled heap of balls and boxes, made anew with other numbers: what it makes up stays what it was.
struct HeapBody {
  Pose pose;
  bool ball;
};
struct Heights {
  double mean, spread;
};
Heights heights(const World& world, const std::vector<BodyId>& bodies) {
  double sum = 0.0, squares = 0.0;
  for (const BodyId b : bodies) {
    const double y = world.pose(b).position.y;
    sum += y, squares += y * y;
  }
  const double n = double(bodies.size()), mean = sum / n;
  return {mean, std::sqrt(squares / n - mean * mean)};
}
std::vector<BodyId> pour(World& world, const std::vector<HeapBody>& heap) {
  add_ground(world);
  for (int k = 0; k < 4; ++k) {
    const double s = k % 2 == 0 ? 2.5 : -2.5;
    world.add_body({.type = BodyType::fixed, .pose = {.position = k < 2 ? DVec3{s, 10, 0} : DVec3{0, 10, s}}},
                   {.geometry = Box{k < 2 ? Vec3{0.5f, 10, 3} : Vec3{3, 10, 0.5f}}});
  }
  std::vector<BodyId> bodies;
  for (const HeapBody& it : heap) {
    bodies.push_back(
        world.add_body({.pose = it.pose},
                       {.geometry = it.ball ? AnyShape(Sphere{0.25f}) : AnyShape(Box{{0.2f, 0.2f, 0.2f}})}));
  }
  return bodies;
}
TEST(CreationOrder, DoesNotShowInAHeapsStatistics) {
  std::vector<HeapBody> heap(600);
  for (int i = 0; i < 600; ++i) {
    const int layer = i / 36, x = i % 6, z = i / 6 % 6;
    HeapBody& it = heap[std::size_t(i)];
    it.pose.position = {0.6 * (x - 2.5) + 0.04 * ((layer * 7 + z) % 3 - 1), 0.4 + 0.6 * layer,
                        0.6 * (z - 2.5) + 0.04 * ((layer * 5 + x) % 3 - 1)};
    it.pose.orientation = from_axis_angle({1, 0.4f, 0.2f}, 0.1f * float(i * 31 % 7));
    it.ball = i % 2 == 0;
  }
  World first = make_world();
  const std::vector<BodyId> settled = pour(first, heap);
  run(first, 20.0);  // a ball may roll on the ground under the heap, at a centimetre a second
  EXPECT_EQ(first.stats().awake_bodies, 0);
  for (std::size_t i = 0; i < heap.size(); ++i) heap[i].pose = first.pose(settled[i]);
  std::uint32_t state = 1;
  Heights before{};
  for (int shuffle = 0; shuffle < 4; ++shuffle) {
    for (std::size_t i = heap.size() - 1; i > 0 && shuffle > 0; --i) {
      state = state * 1664525u + 1013904223u;
      std::swap(heap[i], heap[(state >> 8) % (i + 1)]);
    }
    World again = make_world();
    const std::vector<BodyId> bodies = pour(again, heap);
    run(again, 5.0);
    const Heights after = heights(again, bodies);
    if (shuffle == 0) {
      // Contacts that begin bear nothing yet: a heap made anew gives way a little, in any order.
      before = after;
      say("[row] A-173 mean height %g m, of the heap that was copied %g m\n", before.mean,
                  heights(first, settled).mean);
      continue;
    }
    EXPECT_TRUE(relative_row("A-173 mean height, shuffled (m)", after.mean, before.mean, 1e-2, 2e-3));
    EXPECT_TRUE(
        relative_row("A-173 spread of heights, shuffled (m)", after.spread, before.spread, 1e-2, 2e-3));
  }
}

// Boxes of all proportions thrown onto rough ground, whose edges lie under their faces anyhow: where such an edge ran under a face and one
// edge of the box was nearest, only that end of it was known, and the box rocked from one end to the other in every step, for ever.
TEST(Ground, BoxesComeToRestOnRoughGround) {
  constexpr std::uint32_t kSamples = 24;
  int awake = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    testing_random::Random random;
    random.state += seed * 0x9e3779b97f4a7c15u;
    World world = make_world();
    std::vector<float> heights(kSamples * kSamples);
    for (float& height : heights) height = random.real(-0.1f, 0.1f);
    const Result<Geometry> ground =
        cook_height_field({.heights = heights, .columns = kSamples, .rows = kSamples, .spacing = 0.4f});
    world.add_body({.type = BodyType::fixed}, {.geometry = *ground, .material = surface(0.6f)});
    for (int i = 0; i < 36; ++i) {
      const BodyDef def{.pose = {{1.2 * (i % 6) - 3.0, 0.8, 1.2 * (i / 6) - 3.0}, random.turn(3.0f)},
                        .linear_velocity = random.vector(-1, 1),
                        .angular_velocity = random.vector(-3, 3)};
      const Vec3 half{random.real(0.06f, 0.3f), random.real(0.06f, 0.3f), random.real(0.06f, 0.3f)};
      world.add_body(def, {.geometry = Box{half}, .material = surface(0.6f)});
    }
    run(world, 15.0);
    awake += world.stats().awake_bodies;
  }
  EXPECT_TRUE(limit_row("boxes of 432 on rough ground that move after 15 s", awake, 3, 0));
}

}  // namespace
}  // namespace gyre::laws::ground_test
