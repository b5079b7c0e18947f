// Ragdolls: their description, limits, stabilisation, and that nothing explodes. What drives them is in ragdoll_drives_test.
#include "kit/ragdoll_scenes.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace gyre::kit::ragdoll_test {
namespace {

using namespace ragdoll_test;

// --------------------------------------------------------------------------------------------------------- description

TEST(Ragdoll, AHumanoidIsAsItsTableSays) {
  const RagdollDef def = make_humanoid(1.8f, 80.0f);
  ASSERT_EQ(check_ragdoll(def).code, ErrorCode::none) << check_ragdoll(def).message;
  EXPECT_EQ(def.bones.size(), 16u);
  double sum = 0;
  for (const BoneDef& bone : def.bones) sum += double(*bone.mass);
  EXPECT_NEAR(sum, 80.0, 1e-4);
  EXPECT_NEAR(double(*def.bones[std::size_t(find_bone(def, "left thigh"))].mass), 0.1416 * 80, 1e-4);
  World world = make_world();
  add(world, def, rest_pose(def));
  const auto top = world.cast_ray({0, 5, 0.01}, {0, -9, 0}), sole = world.cast_ray({0.085, -5, 0}, {0, 9, 0});
  ASSERT_TRUE(top && sole);
  EXPECT_NEAR(top->point.y, 1.8, 0.01);
  EXPECT_NEAR(sole->point.y, 0.0, 1e-3);
  EXPECT_EQ(find_bone(def, "tail"), -1);
  EXPECT_LT(max_beyond(def, rest_pose(def)), 1e-6);
  EXPECT_LT(max_beyond(def, middle_pose(def)), 1e-6);
}

TEST(Ragdoll, SaysWhatIsWrongWithADescription) {
  const std::function<void(RagdollDef&)> broken[] = {
      [](RagdollDef& d) { d.bones.clear(); },
      [](RagdollDef& d) { d.bones[3].name = ""; },
      [](RagdollDef& d) { d.bones[3].name = "pelvis"; },
      [](RagdollDef& d) { d.bones[0].parent = 0; },
      [](RagdollDef& d) { d.bones[3].parent = 7; },
      [](RagdollDef& d) { d.bones[3].parent = -1; },
      [](RagdollDef& d) { d.bones[3].shapes.clear(); },
      [](RagdollDef& d) { d.bones[3].mass = -1.0f; },
      [](RagdollDef& d) { d.bones[3].inertia = Sym3{1, 1, 5, 0, 0, 0}; },
      [](RagdollDef& d) { d.bones[3].shapes[0].geometry = Plane{}; },
      [](RagdollDef& d) { d.bones[3].shapes[0].density = 0, d.bones[3].mass = {}; },
      [](RagdollDef& d) {
        d.bones[3].rest.orientation = {1, 1, 1, 1};
      },
      [](RagdollDef& d) { d.bones[3].joint.axis = {}; },
      [](RagdollDef& d) {
        d.bones[3].joint.across = {0, 2, 0};
      },
      [](RagdollDef& d) {
        d.bones[3].joint.swing_y = {1, -1};
      },
      [](RagdollDef& d) {
        d.bones[3].joint.twist = {-4, 4};
      },
      [](RagdollDef& d) { d.bones[3].joint.friction = -1; },
      [](RagdollDef& d) { d.neighbours = 0; },
      [](RagdollDef& d) {
        d.filtered_pairs = {{3, 99}};
      },
      [](RagdollDef& d) { d.angular_damping = -1; },
  };
  const char* const words[] = {"0 bones",
                               "no name",
                               "both called 'pelvis'",
                               "first is the root",
                               "parents stand before",
                               "parents stand before",
                               "'head' has no shapes",
                               "mass is -1",
                               "'head'",
                               "'head'",
                               "weighs 0",
                               "orientation of length 1",
                               "axis",
                               "across",
                               "swing_y is 1 to -1",
                               "twist is -4 to 4",
                               "friction",
                               "neighbours is 0",
                               "pair 3, 99",
                               "dampings"};
  static_assert(std::size(broken) == std::size(words));
  for (std::size_t i = 0; i < std::size(broken); ++i) {
    RagdollDef def = make_humanoid();
    broken[i](def);
    const Error e = check_ragdoll(def);
    EXPECT_NE(e.code, ErrorCode::none) << "case " << i;
    EXPECT_NE(std::string(e.message).find(words[i]), std::string::npos) << "case " << i << ": " << e.message;
    World world = make_world();
    EXPECT_FALSE(add_ragdoll(world, def, {{}, std::vector<Transform>(def.bones.size())}));
    EXPECT_EQ(world.stats().bodies, 0) << "case " << i;
    EXPECT_FALSE(stabilized(def));
  }
  World world = make_world();
  const RagdollDef def = make_humanoid();
  EXPECT_FALSE(add_ragdoll(world, def, {}));
  Ragdoll ragdoll = add(world, def, rest_pose(def));
  const std::uint64_t hash = world.hash();
  const BoneDrive odd[] = {{.key = {.strength = 2}},
                           {.motor = {.strength = -1}},
                           {.key = {.strength = 1, .frequency = -1}},
                           {.key = {.strength = 1, .max_force = std::nanf("")}}};
  for (const BoneDrive& d : odd)
    EXPECT_NE(drive_ragdoll(world, def, ragdoll, rest_pose(def), {&d, 1}, kStep).code, ErrorCode::none);
  const BoneDrive limp;
  EXPECT_NE(drive_ragdoll(world, def, ragdoll, {}, {&limp, 1}, kStep).code, ErrorCode::none);
  EXPECT_NE(drive_ragdoll(world, def, ragdoll, rest_pose(def), {&limp, 1}, 0).code, ErrorCode::none);
  EXPECT_NE(drive_ragdoll(world, def, ragdoll, rest_pose(def), {}, kStep).code, ErrorCode::none);
  EXPECT_EQ(world.hash(), hash);
  remove_ragdoll(world, ragdoll);
  EXPECT_EQ(world.stats().bodies, 0);
  EXPECT_EQ(world.stats().joints, 0);
}

// What a bone is turned by is told as it was asked for, and beyond limits by as much as it is.
TEST(Ragdoll, TellsTheAnglesOfItsJoints) {
  const RagdollDef def = make_humanoid();
  const int knee = find_bone(def, "left shank"), shoulder = find_bone(def, "right upper arm");
  for (const float angle : {-0.4f, 0.3f, 2.0f, 2.5f}) {
    RagdollPose pose = rest_pose(def);
    rotate_bone(def, pose, knee, {angle, 0, 0});
    EXPECT_NEAR(bone_rotation(def, pose, knee).x, angle, 1e-5f);
    const float expected = std::max({0.0f, -angle, angle - 135 * kDegree});
    EXPECT_NEAR(limit_violation(def, pose, knee), expected, 1e-5f);
    const std::size_t foot = std::size_t(find_bone(def, "left foot"));
    EXPECT_NEAR(pose.bones[foot].position.y, 0.502f - 0.434f * std::cos(angle), 1e-4f)
        << "the foot hangs on it";
  }
  // Straight forward from the middle of a round cone.
  RagdollPose pose = middle_pose(def);
  rotate_bone(def, pose, shoulder, {0, 0.8f, 1.7f});
  EXPECT_NEAR(limit_violation(def, pose, shoulder), std::sqrt(0.8f * 0.8f + 1.7f * 1.7f) - 100 * kDegree,
              1e-4f);
  pose = middle_pose(def);
  rotate_bone(def, pose, shoulder, {2.0f, 0, 0});
  EXPECT_NEAR(limit_violation(def, pose, shoulder), 2.0f - 80 * kDegree, 1e-4f);
  // Along the axes of an ellipse.
  const int hip = find_bone(def, "left thigh");
  pose = middle_pose(def);
  rotate_bone(def, pose, hip, {0, 0.7f, 0});
  EXPECT_NEAR(limit_violation(def, pose, hip), 0.7f - 35 * kDegree, 1e-4f);
}

TEST(Ragdoll, StandsWhereItIsPut) {
  const RagdollDef def = make_humanoid();
  std::mt19937 random(5);
  World world = make_world({});
  const Pose at{{1000, 2, -3e5}, random_turn(random)};
  const RagdollPose start = random_pose(def, at, random, 1.0f);
  const Ragdoll ragdoll = add(world, def, start);
  EXPECT_LT(farthest(world, ragdoll, start), 1e-5);
  EXPECT_LT(max_turned(world, ragdoll, start), 1e-6);
  const RagdollPose read = read_ragdoll(world, def, ragdoll);
  for (std::size_t i = 0; i < start.bones.size(); ++i) {
    EXPECT_LT(length(read.bones[i].position - start.bones[i].position), 1e-5f);
    EXPECT_NEAR(absolute(dot(read.bones[i].orientation, start.bones[i].orientation)), 1.0f, 1e-6f);
  }
}

// -------------------------------------------------------------------------------------------------------------- limits

// Each joint in turn, pushed against its limits from all sides, with its parent held.
TEST(Ragdoll, LimitsHold) {
  RagdollDef def = make_humanoid();
  def.angular_damping = 5;  // nothing else brings a hand to rest that is pulled about
  double most = 0, min_turn = 9;
  for (std::size_t bone = 1; bone < def.bones.size(); ++bone) {
    World world = make_world({});
    Ragdoll ragdoll = add(world, def, middle_pose(def));
    std::vector<BoneDrive> drives(def.bones.size());
    for (std::size_t i = 0; i < def.bones.size(); ++i) {
      bool hangs = i == bone;
      for (int p = int(i); p > 0 && !hangs; p = def.bones[std::size_t(p)].parent)
        hangs = std::size_t(p) == bone;
      drives[i].kinematic = !hangs;
    }
    const RagdollPose target = middle_pose(def);
    // Twice its weight, at its end. Stops give way by leak h^2 / rate = 9.5e-6 s^2 of the acceleration that they stop: of the
    // hands', 1,500 rad/s^2, by 0.8 degrees.
    const float force = 2.0f * *def.bones[bone].mass * float(kGravity);
    const Vec3 end = 1.8f * def.bones[bone].shapes[0].local.position;
    double far = 0;
    for (int i = 0; i < 360; ++i) {
      const Vec3 axis = rotate(from_axis_angle({0, 0, 1}, float(i / 60) * 1.047f) *
                                   from_axis_angle({0, 1, 0}, float(i / 60) * 1.3f),
                               {1, 0, 0});
      world.add_force_at(ragdoll.bones[bone].body, force * axis, world.pose(ragdoll.bones[bone].body) * end);
      drive(world, def, ragdoll, target, drives);
      const RagdollPose now = read_ragdoll(world, def, ragdoll);
      if (i % 60 >= 45) most = std::max(most, double(limit_violation(def, now, int(bone))));
      far = std::max(far, double(length(bone_rotation(def, now, int(bone)) - bone_rotation(def, target, int(bone)))));
    }
    min_turn = std::min(min_turn, far);
  }
  std::printf("[row] limits under twice the bone's weight: beyond by %.3f degrees at most\n",
              most / double(kDegree));
  EXPECT_LT(most / double(kDegree), 1.0);
  EXPECT_GT(min_turn, 0.2) << "every joint was turned";
}

// ------------------------------------------------------------------------------------------------------ stabilisation

TEST(Ragdoll, StabilisationKeepsTheMassAndItsWord) {
  std::mt19937 random(3);
  for (int k = 0; k < 200; ++k) {
    RagdollDef def = make_humanoid();
    for (BoneDef& bone : def.bones) bone.mass = std::exp(random_in(random, -5, 5));
    const StableDef stable{.mass_ratio = random_in(random, 1, 6),
                           .slenderness = random_in(random, 1.5f, 10),
                           .inertia_ratio = random_in(random, 1, 10)};
    const Result<RagdollDef> made = stabilized(def, stable);
    ASSERT_TRUE(made);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < def.bones.size(); ++i) {
      before += double(*def.bones[i].mass), after += double(*made->bones[i].mass);
      EXPECT_EQ(check_inertia(*made->bones[i].inertia).code, ErrorCode::none);
      const Vec3 moments = principal_axes(*made->bones[i].inertia).moments;
      EXPECT_LE(moments.z, moments.x * stable.slenderness * 1.001f);
      if (i == 0) continue;
      const BoneDef& parent = made->bones[std::size_t(def.bones[i].parent)];
      const float ratio = *made->bones[i].mass / *parent.mass;
      EXPECT_LE(std::max(ratio, 1 / ratio), stable.mass_ratio * 1.001f);
      EXPECT_LE(moments.z, principal_axes(*parent.inertia).moments.x * stable.inertia_ratio * 1.001f);
    }
    EXPECT_NEAR(after / before, 1.0, 1e-6);
  }
  // What is alike enough stays as it is.
  const RagdollDef def = arm_def(BoneJointKind::hinge, 7.0f, 0.25f);
  const Result<RagdollDef> same = stabilized(def, {.mass_ratio = 2, .slenderness = 20, .inertia_ratio = 20});
  ASSERT_TRUE(same);
  EXPECT_FLOAT_EQ(*same->bones[1].mass, 7.0f);
  EXPECT_FALSE(stabilized(def, {.mass_ratio = 0.5f}));
}

// --------------------------------------------------------------------------------------------------------- the whole

// Poses that no joint allows, bones through bones, at the ground and above it. Limbs that lie on the wrong side of others may
// stay there; without contact between the bones all are taken back to within their limits. One of eighty such starts takes more than
// 7 s until its bones have passed each other, and until then they move by a few cm/s; after 20 s all are at rest.
TEST(Ragdoll, NoStartMakesItExplode) {
  for (const bool contacts : {true, false}) {
    std::mt19937 random;
    double fastest = 0, gap = 0;
    std::vector<double> beyond, kinetic;
    int late = 0;
    const unsigned starts = contacts ? 160 : 40;
    for (unsigned k = 0; k < starts; ++k) {
      if (k % 40 == 0) random.seed(17 + k / 40);
      RagdollDef def = k % 2 == 0 ? make_humanoid() : *stabilized(make_humanoid());
      if (!contacts) {
        for (BoneDef& bone : def.bones) bone.shapes[0].filter.group = -1;
      }
      World world = make_world();
      add_ground(world);
      RagdollPose start = rest_pose(def, {{0, k % 3 == 0 ? 0.5 : 3.0, 0}, random_turn(random)});
      for (Transform& bone : start.bones) bone.orientation = random_turn(random);
      Ragdoll ragdoll = add(world, def, start);
      const auto watch = [&](double seconds) {
        for (int i = 0; i < int(60 * seconds); ++i) {
          ASSERT_TRUE(world.step(kStep));
          ASSERT_TRUE(world.problems().empty()) << world.problems()[0].message;
          for (const RagdollBone& bone : ragdoll.bones)
            fastest = std::max(fastest, double(length(world.linear_velocity(bone.body))));
        }
      };
      watch(7);
      if (HasFatalFailure()) return;
      gap = std::max(gap, largest_gap(world, def, ragdoll));
      kinetic.push_back(world.energy().kinetic);
      beyond.push_back(max_beyond(def, read_ragdoll(world, def, ragdoll)) / double(kDegree));
      if (kinetic.back() < 0.05) continue;
      ++late;
      watch(13);
      EXPECT_LT(world.energy().kinetic, 0.05) << "start " << k << " after 20 s";
    }
    std::sort(beyond.begin(), beyond.end());
    std::sort(kinetic.begin(), kinetic.end());
    std::printf(
        "[row] %u impossible starts, bones %s: fastest %.1f m/s; after 7 s joints open by %.2f mm, %d have "
        "0.05 J, the most "
        "%.4f J, beyond limits by %.1f degrees, half of them by less than %.2f\n",
        starts, contacts ? "touch" : "do not touch", fastest, 1e3 * gap, late, kinetic.back(), beyond.back(),
        beyond[starts / 2]);
    // A fall from 4 m is 9 m/s, and four limbs of 0.3 m in a row, each taken back by 8 rad/s against the one before, add 24.
    EXPECT_LT(fastest, contacts ? 50.0 : 33.0);
    EXPECT_LE(late, contacts ? 2 : 0);
    EXPECT_LT(kinetic.back(), 0.5)
        << "a speed of 4 cm/s at the humanoid's 70 kg is 0.06 J, ten times that no rest";
    EXPECT_LT(gap, contacts ? 0.05 : 1e-3);
    if (!contacts) {
      EXPECT_LT(beyond.back(), 3.0);
    }
  }
}

// Without friction nothing brakes what a bad start flings. Among these are limbs that point straight back, where the nearest stop of a
// cone goes over to the other side at once, and joints whose equations are as ill-conditioned as their give allows.
TEST(Ragdoll, NoStartFlingsALimbWithoutFriction) {
  std::mt19937 random;
  double fastest = 0;
  constexpr unsigned kStarts = 1200;
  for (unsigned k = 0; k < kStarts; ++k) {
    if (k % 40 == 0) random.seed(17 + k / 40);
    RagdollDef def = k % 2 == 0 ? make_humanoid() : *stabilized(make_humanoid());
    for (BoneDef& bone : def.bones) bone.joint.friction = 0;
    World world = make_world();
    add_ground(world);
    RagdollPose start = rest_pose(def, {{0, k % 3 == 0 ? 0.5 : 3.0, 0}, random_turn(random)});
    for (Transform& bone : start.bones) bone.orientation = random_turn(random);
    const Ragdoll ragdoll = add(world, def, start);
    for (int i = 0; i < 12; ++i) {
      ASSERT_TRUE(world.step(kStep));
      ASSERT_TRUE(world.problems().empty()) << "start " << k << ": " << world.problems()[0].message;
      for (const RagdollBone& bone : ragdoll.bones)
        fastest = std::max(fastest, double(length(world.linear_velocity(bone.body))));
    }
  }
  std::printf("[row] %u impossible starts without friction: fastest %.1f m/s\n", kStarts, fastest);
  EXPECT_LT(fastest, 33.0) << "a fall, and four limbs in a row taken back by 8 rad/s each";
}

// Those that differ in what acts on their joints share no lanes: each falls as it does alone.
TEST(Ragdoll, FallsTheSameBesideOneWithoutFriction) {
  const RagdollDef rubs = make_humanoid(), free = free_humanoid();
  // The velocities of a thigh: of those that rub, of those that do not.
  const auto fall = [&](bool with_rubbing, bool with_free) {
    World world = make_world();
    std::vector<Ragdoll> all[2];
    for (int i = 0; i < 4; ++i) {
      const bool is_free = i % 2 != 0;
      if (!(is_free ? with_free : with_rubbing)) continue;
      const RagdollDef& def = is_free ? free : rubs;
      RagdollPose start = rest_pose(def, {{4.0 * (i / 2), 3.0, 4.0 * (i % 2)}, {}});
      rotate_bone(def, start, find_bone(def, "left thigh"), {0, 0, 0.4f});
      all[is_free].push_back(add(world, def, start));
      world.set_velocity(all[is_free].back().bones[0].body, {0, 1, 0}, {3, 2, 1});
    }
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(world.step(kStep));
    std::vector<Vec3> found[2];
    for (int kind = 0; kind < 2; ++kind)
      for (const Ragdoll& one : all[kind])
        found[kind].push_back(
            world.angular_velocity(one.bones[std::size_t(find_bone(rubs, "left thigh"))].body));
    return std::pair{found[0], found[1]};
  };
  const auto [rubbing, sliding] = fall(true, true);
  EXPECT_EQ(rubbing, fall(true, false).first);
  EXPECT_EQ(sliding, fall(false, true).second);
  EXPECT_NE(rubbing, sliding);
}

TEST(Ragdoll, IsTheSameOnAnyNumberOfThreadsAndAfterASnapshot) {
  const RagdollDef def = *stabilized(make_humanoid());
  std::uint64_t hashes[3];
  for (const int threads : {1, 3}) {
    World world = make_world({0, -9.81f, 0}, threads);
    add_ground(world);
    std::vector<Ragdoll> ragdolls;
    for (int k = 0; k < 4; ++k) ragdolls.push_back(add(world, def, rest_pose(def, {{1.2 * k, 0.3, 0}, {}})));
    const auto go = [&](int from, int to) {
      for (int i = from; i < to; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
          RagdollPose target = moving(def, i / 60.0);
          target.world_from_model.position = {1.2 * double(k) + 0.1 * i / 60.0, 0.3, 0};
          BoneDrive d;
          if (k == 0) d.motor.strength = 1;
          if (k == 1) d.key.strength = i > 60 ? 0.5f : 0.0f, d.key.frequency = 3, d.motor.strength = 0.3f;
          if (k == 2) d.kinematic = i < 90;
          ASSERT_EQ(drive_ragdoll(world, def, ragdolls[k], target, {&d, 1}, kStep).code, ErrorCode::none);
        }
        ASSERT_TRUE(world.step(kStep));
      }
    };
    go(1, 40);
    const auto moment = save_snapshot(world);
    const std::vector<Ragdoll> then = ragdolls;
    go(40, 150);
    hashes[threads == 1 ? 0 : 1] = world.hash();
    ASSERT_EQ(restore_snapshot(world, moment).code, ErrorCode::none);
    ragdolls = then;
    go(40, 150);
    hashes[2] = world.hash();
    EXPECT_EQ(hashes[2], hashes[threads == 1 ? 0 : 1]);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Limp it comes to rest on the ground; on motors towards a pose that does not move, too.
TEST(Ragdoll, FallsAsleep) {
  for (const bool motors : {false, true}) {
    const RagdollDef def = make_humanoid();
    World world = make_world();
    add_ground(world);
    Ragdoll ragdoll = add(world, def, rest_pose(def, {{0, 0.5, 0}, from_axis_angle({1, 0, 0}, 0.6f)}));
    const BoneDrive d{.motor = {.strength = motors ? 0.3f : 0.0f}};
    int asleep = 0;
    for (int i = 0; i < 1200 && asleep == 0; ++i) {
      drive(world, def, ragdoll, rest_pose(def), {&d, 1});
      if (world.stats().awake_bodies == 0) asleep = i;
    }
    std::printf("[row] %s: asleep after %.1f s\n", motors ? "on weak motors" : "limp", asleep / 60.0);
    EXPECT_GT(asleep, 0) << motors;
    EXPECT_LT(largest_gap(world, def, ragdoll), 1e-3);
    EXPECT_LT(max_beyond(def, read_ragdoll(world, def, ragdoll)), 2 * double(kDegree));
  }
}

}  // namespace
}  // namespace gyre::kit::ragdoll_test
