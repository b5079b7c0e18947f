// Crowds of ragdolls fall down stairs: nothing is lost, joints hold, limits hold, no energy comes from nowhere, and in the end all sleep.
#include <gyre/gyre.h>
#include <gyre/kit/ragdoll.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace gyre::kit::ragdolls_on_stairs_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kDegree = kPiDouble / 180.0;
constexpr int kStairs = 24;
constexpr double kRise = 0.18, kRun = 0.28, kWidth = 10.0, kTop = kStairs * kRise;

// Down along x from a landing at x < 0; a wall on either side.
void add_stairs(World& world) {
  const auto block = [&](DVec3 low, DVec3 high) {
    const DVec3 half = 0.5 * (high - low);
    world.add_body({.type = BodyType::fixed, .pose = {0.5 * (low + high), {}}},
                   {.geometry = Box{to_float(half)}});
  };
  block({-8, -1, -kWidth / 2}, {0, kTop, kWidth / 2});
  for (int i = 1; i < kStairs; ++i)
    block({(i - 1) * kRun, -1, -kWidth / 2}, {i * kRun, kTop - i * kRise, kWidth / 2});
  block({-8, -1, -kWidth / 2 - 1}, {30, kTop + 6, -kWidth / 2});
  block({-8, -1, kWidth / 2}, {30, kTop + 6, kWidth / 2 + 1});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
}
double ground_at(DVec3 p) {
  if (p.x < 0) return kTop;
  return std::max(0.0, kTop - kRise * (std::floor(p.x / kRun) + 1));
}
// How far inside the stairs, by the nearest way out: up, or forward over an edge. Negative: above the ground by so much.
double depth_in_stairs(DVec3 p) {
  const double up = ground_at(p) - p.y;
  if (p.x < 0 || up <= 0) return up;
  const double forward = (std::ceil((kTop - p.y) / kRise) - 1) * kRun - p.x;
  return std::min(up, std::max(forward, 0.0));
}

struct Judged {
  std::vector<float> gaps;    // m, of every joint in every tenth step
  double inside = -1e9;       // m: how far a bone's centre was inside the stairs, at most
  double energy_gain = 0;     // J in a step
  std::vector<float> beyond;  // degrees, of every bone in every tenth step
  int awake = 0;
  double kinetic = 0;  // J, at the end
  double seconds = 0;
};

struct Fall {
  int count = 0;
  double seconds = 0;
  int threads = 1;
  float direction = 1.5f;  // m/s
};
Judged fall(const Fall& f) {
  const int count = f.count;
  WorldDef wd;
  wd.threads = f.threads;
  World world = std::move(*World::create(wd));
  add_stairs(world);
  const RagdollDef def = *stabilized(make_humanoid());
  std::vector<Ragdoll> crowd;
  for (int i = 0; i < count; ++i) {
    // Rows of five across the stairs, each above the last, all turned otherwise about the pelvis; they are pushed downstairs.
    const int row = i / 5, column = i % 5;
    const Quat turn =
        from_axis_angle({0, 1, 0}, 2.4f * float(i)) * from_axis_angle({1, 0, 0}, 0.9f * float(i % 7) - 2.7f);
    const Pose pelvis{{-1.0 + 0.9 * (row % 4), kTop + 1.2 + 1.9 * row, 1.95 * (column - 2)}, turn};
    const Pose at = pelvis * Transform{-1.0f * def.bones[0].rest.position, {}};
    const Result<Ragdoll> made = add_ragdoll(world, def, middle_pose(def, at));
    EXPECT_TRUE(made) << made.error().message;
    if (!made) return {};
    crowd.push_back(*made);
    for (const RagdollBone& bone : crowd.back().bones) world.set_velocity(bone.body, {f.direction, 0, 0}, {});
  }
  Judged j;
  double energy = world.energy().kinetic + world.energy().potential;
  for (int i = 0; i < int(f.seconds * 60); ++i) {
    EXPECT_TRUE(world.step(kStep));
    EXPECT_TRUE(world.problems().empty()) << world.problems()[0].message;
    if (::testing::Test::HasFailure()) return j;
    const double now = world.energy().kinetic + world.energy().potential;
    j.energy_gain = std::max(j.energy_gain, now - energy);
    energy = now;
    if (i % 10 != 9) continue;
    for (const Ragdoll& ragdoll : crowd) {
      const RagdollPose pose = read_ragdoll(world, def, ragdoll);
      for (std::size_t k = 0; k < def.bones.size(); ++k) {
        const DVec3 center = world.center_of_mass(ragdoll.bones[k].body);
        j.inside = std::max(j.inside, depth_in_stairs(center));
        if (k == 0) continue;
        const Pose parent = world.pose(ragdoll.bones[std::size_t(def.bones[k].parent)].body);
        j.gaps.push_back(
            float(length(parent * def.bones[k].rest.position - world.pose(ragdoll.bones[k].body).position)));
        j.beyond.push_back(float(double(limit_violation(def, pose, int(k))) / kDegree));
      }
    }
    j.awake = world.stats().awake_bodies;
    j.kinetic = world.energy().kinetic;
    j.seconds = (i + 1) / 60.0;
    if (j.awake == 0) break;
  }
  return j;
}

void judge(int count, Judged j) {
  ASSERT_FALSE(j.beyond.empty());
  std::sort(j.beyond.begin(), j.beyond.end());
  std::sort(j.gaps.begin(), j.gaps.end());
  const auto share = [](const std::vector<float>& of, double part) {
    return double(of[std::size_t(part * double(of.size() - 1))]);
  };
  std::printf(
      "[row] %d ragdolls on stairs: joints open by %.3f mm at p99, %.2f at p99.9, %.1f at most; beyond "
      "limits by %.2f degrees at "
      "p99, %.2f at p99.9, %.1f at most; centres %.3f m outside the stairs at least; %.2f J gained in a step "
      "at most; %d bodies "
      "awake after %.1f s, with %.4f J\n",
      count, 1e3 * share(j.gaps, 0.99), 1e3 * share(j.gaps, 0.999), 1e3 * share(j.gaps, 1),
      share(j.beyond, 0.99), share(j.beyond, 0.999), share(j.beyond, 1), -j.inside, j.energy_gain, j.awake,
      j.seconds, j.kinetic);
  EXPECT_LT(share(j.gaps, 0.999), 0.01);
  EXPECT_LT(share(j.gaps, 1), 0.05) << "a limb struck at 10 m/s, for a step";
  EXPECT_LT(share(j.beyond, 0.99), 3.0);
  // Nothing thin passes through: at 10 m/s and more under the weight of a crowd a limb is pressed in by less than its own thickness.
  EXPECT_LT(j.inside, 0.076) << "the thinnest limb is 76 mm thick";
  // One limb of three thousand slips now and then and keeps its heap awake, so rest is asked of the energy that is left: for each
  // ragdoll less than that of a hand that falls by two millimetres.
  EXPECT_LT(j.kinetic, 0.01 * count);
  // Places that are taken back (overlap, joints) lift something now and then, and limbs that are wedged in a heap slip: by less than
  // a millimetre of the crowd's weight.
  EXPECT_LT(j.energy_gain, 0.5 * count);
}

TEST(RagdollsOnStairs, TwentyComeToRest) {
  for (int draw = 0; draw < 5; ++draw) {
    const Judged j = fall({.count = 20, .seconds = 30, .direction = 1.5f + 0.001f * float(draw)});
    judge(20, j);
    EXPECT_EQ(j.awake, 0) << "fall " << draw;
  }
}

TEST(LongRagdollsOnStairs, TwoHundredComeToRest) {
  judge(200, fall({.count = 200, .seconds = 60, .threads = 2}));
}

// scenes/joints/ragdolls_on_stairs.gyre.json is what examples/ragdoll_scene.cpp writes, to the last digit.
TEST(RagdollsOnStairs, TheSceneIsWhatTheExampleWrites) {
  const auto read = [](std::FILE* file) {
    std::string text;
    char part[4096];
    while (const std::size_t got = std::fread(part, 1, sizeof part, file)) text.append(part, got);
    return text;
  };
  std::FILE* const program = popen(GYRE_BINARY_DIR "/bin/examples/ragdoll_scene", "r");
  ASSERT_NE(program, nullptr);
  const std::string written = read(program);
  if (pclose(program) != 0) GTEST_SKIP() << "built without examples";
  std::FILE* const file = std::fopen(GYRE_SOURCE_DIR "/scenes/joints/ragdolls_on_stairs.gyre.json", "rb");
  ASSERT_NE(file, nullptr);
  const std::string stored = read(file);
  std::fclose(file);
  EXPECT_TRUE(written == stored)
      << "write it anew: bin/examples/ragdoll_scene > scenes/joints/ragdolls_on_stairs.gyre.json";
}

}  // namespace
}  // namespace gyre::kit::ragdolls_on_stairs_test
