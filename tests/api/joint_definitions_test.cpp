// One definition per kind of joint, and what becomes of it: the same command, the same state and the same refusals as the flat form
// that recordings hold.
#include "io/codec/command_codec.h"
#include "world/command.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gtest/gtest.h>

#include <gyre/gyre.h>

#include <limits>
#include <string>

namespace gyre::joint_definitions_test {
namespace {

// ------------------------------------------------------------------------------------------------- all kinds, in order

template <class Def, JointKind kind>
constexpr bool is_definition_of() {
  return std::is_same_v<std::variant_alternative_t<std::size_t(kind), JointDef>, Def>;
}
static_assert(std::variant_size_v<JointDef> == std::size_t(kJointKindCount));
static_assert(is_definition_of<BallDef, JointKind::ball>());
static_assert(is_definition_of<HingeDef, JointKind::hinge>());
static_assert(is_definition_of<SliderDef, JointKind::slider>());
static_assert(is_definition_of<FixedDef, JointKind::fixed>());
static_assert(is_definition_of<DistanceDef, JointKind::distance>());
static_assert(is_definition_of<ConeDef, JointKind::cone>());
static_assert(is_definition_of<UniversalDef, JointKind::universal>());
static_assert(is_definition_of<SixDofDef, JointKind::six_dof>());
static_assert(is_definition_of<GearDef, JointKind::gear>());
static_assert(is_definition_of<RackAndPinionDef, JointKind::rack_and_pinion>());
static_assert(is_definition_of<PulleyDef, JointKind::pulley>());
static_assert(is_definition_of<WheelDef, JointKind::wheel>());
static_assert(is_definition_of<PathDef, JointKind::path>());
static_assert(is_definition_of<MouseDef, JointKind::mouse>());
static_assert(is_definition_of<MotorDef, JointKind::motor>());

TEST(JointDefinitions, KindAndDefaultGoTogether) {
  for (int kind = 0; kind < kJointKindCount; ++kind) {
    const JointDef def = default_joint(JointKind(kind));
    EXPECT_EQ(def.index(), std::size_t(kind));
    EXPECT_EQ(kind_of(def), JointKind(kind));
    EXPECT_EQ(flatten(def).kind, JointKind(kind));
  }
}

// How many fields a definition has: a new one does not compile until it is counted here, and then must be in for_each_field.
int fields_of(BallDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, friction, force, torque, collide] = def;
  return 7;
}
int fields_of(HingeDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, limits, frequency, ratio, motor, stiffness, damping, friction,
                          force, torque, collide] = def;
  return 14;
}
int fields_of(SliderDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, limits, frequency, ratio, motor, stiffness, damping, friction,
                          force, torque, collide] = def;
  return 14;
}
int fields_of(FixedDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, force, torque, collide] = def;
  return 6;
}
int fields_of(DistanceDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, anchor_b, length, least, most, stiffness, damping, frequency, ratio,
                          force, torque, collide] = def;
  return 14;
}
int fields_of(ConeDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, swing_y, swing_z, limits, frequency, ratio, motor,
                          stiffness, damping, friction, drive, force, torque, collide] = def;
  return 18;
}
int fields_of(UniversalDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, limits, frequency, ratio, motor, stiffness, damping,
                          friction, angular_z, force, torque, collide] = def;
  return 16;
}
int fields_of(SixDofDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, x, y, z, about_x, about_y, about_z, force, torque,
                          collide] = def;
  return 14;
}
int fields_of(GearDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, ratio, force, torque, collide] = def;
  return 9;
}
int fields_of(RackAndPinionDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, ratio, force, torque, collide] = def;
  return 9;
}
int fields_of(PulleyDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, anchor_b, ground_a, ground_b, ratio, length, force, torque, collide] =
      def;
  return 11;
}
int fields_of(WheelDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, limits, frequency, ratio, stiffness, damping, motor,
                          friction, steering, force, torque, collide] = def;
  return 16;
}
int fields_of(PathDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, points, closed, orientation, limits, frequency, ratio, motor,
                          stiffness, damping, friction, force, torque, collide] = def;
  return 16;
}
int fields_of(MouseDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, drive, force, torque, collide] = def;
  return 7;
}
int fields_of(MotorDef& def) {
  [[maybe_unused]] auto& [a, b, anchor, axis, axis_b, drive, force, torque, collide] = def;
  return 9;
}

TEST(JointDefinitions, EveryFieldIsInTheFlatForm) {
  for (int kind = 0; kind < kJointKindCount; ++kind) {
    JointDef def = default_joint(JointKind(kind));
    FlatJoint flat;
    int passed = 0, fields = 0;
    std::visit(
        [&](auto& d) {
          fields = fields_of(d);
          for_each_field(d, flat, [&](const auto&, const auto&) { ++passed; });
        },
        def);
    EXPECT_EQ(passed, fields) << to_string(JointKind(kind));
  }
}

// ----------------------------------------------------------------------------------- the same command, the same state

struct Pair {
  JointDef def;
  FlatJoint flat;
};

// Every kind with every field, each of another value, written twice by hand.
std::vector<Pair> pairs(BodyId a, BodyId b) {
  const DVec3 at{1, 2, 3}, at_b{1.5, 2.25, 3};
  const Vec3 x{0, 1, 0}, z{0, 0.25f, 1};
  const Limits limits{-0.5f, 0.75f};
  const Motor motor{
      .target_velocity = 1, .target_position = 0.25f, .max_force = 3, .frequency = 4, .damping_ratio = 0.5f};
  const PoseDrive drive{
      .position = {0.1f, 0, 0}, .frequency = 3, .damping_ratio = 0.5f, .max_force = 6, .max_torque = 7};
  const JointAxisDef one{
      .motion = AxisMotion::limited, .limits = {-0.1f, 0.2f}, .limit_frequency = 2, .stiffness = 3};
  const JointAxisDef two{.motion = AxisMotion::free, .motor = motor, .friction = 0.5f};
  const std::vector<Vec3> curve{{-1, 0, 0}, {0, 0, 0}, {1, 0.2f, 0}};
  std::vector<Pair> all;
  const auto add = [&](const JointDef& def, FlatJoint flat) {
    flat.a = a, flat.b = b, flat.anchor = at;
    flat.break_force = 1.0e4f, flat.break_torque = 2.0e4f, flat.collide_connected = true;
    all.push_back({def, flat});
    std::visit(
        [&](auto& d) {
          d.a = a, d.b = b, d.anchor = at;
          d.break_force = 1.0e4f, d.break_torque = 2.0e4f, d.collide_connected = true;
        },
        all.back().def);
  };
  add(BallDef{.friction = 0.25f}, {.kind = JointKind::ball, .friction = 0.25f});
  add(HingeDef{.axis = x,
               .limits = limits,
               .limit_frequency = 5,
               .limit_damping_ratio = 0.7f,
               .motor = motor,
               .stiffness = 8,
               .damping = 9,
               .friction = 0.25f},
      {.kind = JointKind::hinge,
       .axis = x,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f});
  add(SliderDef{.axis = x,
                .limits = limits,
                .limit_frequency = 5,
                .limit_damping_ratio = 0.7f,
                .motor = motor,
                .stiffness = 8,
                .damping = 9,
                .friction = 0.25f},
      {.kind = JointKind::slider,
       .axis = x,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f});
  add(FixedDef{}, {.kind = JointKind::fixed});
  add(DistanceDef{.anchor_b = at_b,
                  .length = 1.0f,
                  .min_length = 0.5f,
                  .max_length = 2.0f,
                  .stiffness = 0.0f,
                  .damping = 9.0f},
      {.kind = JointKind::distance,
       .anchor_b = at_b,
       .length = 1.0f,
       .min_length = 0.5f,
       .max_length = 2.0f,
       .stiffness = 0.0f,
       .damping = 9.0f});
  add(DistanceDef{.frequency = 2.0f, .damping_ratio = 0.3f},
      {.kind = JointKind::distance, .frequency = 2.0f, .damping_ratio = 0.3f});
  add(ConeDef{.axis = x,
              .axis_b = z,
              .swing_y = 0.5f,
              .swing_z = 0.4f,
              .limits = limits,
              .limit_frequency = 5,
              .limit_damping_ratio = 0.7f,
              .motor = motor,
              .stiffness = 8,
              .damping = 9,
              .friction = 0.25f,
              .drive = drive},
      {.kind = JointKind::cone,
       .axis = x,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .axis_b = z,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f,
       .swing_y = 0.5f,
       .swing_z = 0.4f,
       .drive = drive});
  add(UniversalDef{.axis = x,
                   .axis_b = z,
                   .limits = limits,
                   .limit_frequency = 5,
                   .limit_damping_ratio = 0.7f,
                   .motor = motor,
                   .stiffness = 8,
                   .damping = 9,
                   .friction = 0.25f,
                   .angular_z = one},
      {.kind = JointKind::universal,
       .axis = x,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .axis_b = z,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f,
       .angular_z = one});
  add(SixDofDef{.axis = x,
                .axis_b = z,
                .linear_x = one,
                .linear_y = two,
                .angular_x = two,
                .angular_y = one,
                .angular_z = two},
      {.kind = JointKind::six_dof,
       .axis = x,
       .axis_b = z,
       .linear_x = one,
       .linear_y = two,
       .angular_x = two,
       .angular_y = one,
       .angular_z = two});
  add(SixDofDef{.linear_z = two}, {.kind = JointKind::six_dof, .linear_z = two});
  add(GearDef{.axis = x, .axis_b = z, .ratio = -2},
      {.kind = JointKind::gear, .axis = x, .axis_b = z, .ratio = -2});
  add(RackAndPinionDef{.axis = x, .axis_b = Vec3{1, 0, 0}, .ratio = 0.25f},
      {.kind = JointKind::rack_and_pinion, .axis = x, .axis_b = Vec3{1, 0, 0}, .ratio = 0.25f});
  add(
      PulleyDef{
          .anchor_b = at_b, .ground_a = {1, 5, 3}, .ground_b = {2, 6, 3}, .ratio = 1.5f, .length = 20.0f},
      {.kind = JointKind::pulley,
       .anchor_b = at_b,
       .length = 20.0f,
       .ratio = 1.5f,
       .ground_a = {1, 5, 3},
       .ground_b = {2, 6, 3}});
  add(WheelDef{.axis = x,
               .axis_b = z,
               .limits = limits,
               .limit_frequency = 5,
               .limit_damping_ratio = 0.7f,
               .stiffness = 8,
               .damping = 9,
               .motor = motor,
               .friction = 0.25f,
               .steering = one},
      {.kind = JointKind::wheel,
       .axis = x,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .axis_b = z,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f,
       .angular_x = one});
  add(PathDef{.points = curve,
              .closed = true,
              .orientation = PathOrientation::following,
              .limits = limits,
              .limit_frequency = 5,
              .limit_damping_ratio = 0.7f,
              .motor = motor,
              .stiffness = 8,
              .damping = 9,
              .friction = 0.25f},
      {.kind = JointKind::path,
       .limits = limits,
       .motor = motor,
       .stiffness = 8.0f,
       .damping = 9.0f,
       .friction = 0.25f,
       .limit_frequency = 5,
       .limit_damping_ratio = 0.7f,
       .path = curve,
       .path_closed = true,
       .path_orientation = PathOrientation::following});
  add(MouseDef{.drive = drive}, {.kind = JointKind::mouse, .drive = drive});
  add(MotorDef{.axis = x, .axis_b = z, .drive = drive},
      {.kind = JointKind::motor, .axis = x, .axis_b = z, .drive = drive});
  return all;
}

std::vector<std::byte> bytes_of(const FlatJoint& joint) {
  ByteWriter out;
  write_command(out, AddJoint{joint});
  return out.take();
}

struct Scene {
  World world = *World::create();
  BodyId a = world.add_body({.pose = {.position = {0, 2, 3}}}, {.geometry = Sphere{0.25f}});
  BodyId b = world.add_body({.pose = {.position = {2, 2, 3}}}, {.geometry = Box{{0.2f, 0.1f, 0.3f}}});
};

TEST(JointDefinitions, EveryKindIsTheSameCommandAndTheSameStateAsItsFlatForm) {
  const std::size_t count = pairs({}, {}).size();
  unsigned kinds = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Scene by_def, by_flat;
    const Pair from_def = pairs(by_def.a, by_def.b)[i], from_flat = pairs(by_flat.a, by_flat.b)[i];
    const char* const name = to_string(from_def.flat.kind);
    kinds |= 1u << int(from_def.flat.kind);
    EXPECT_EQ(bytes_of(flatten(from_def.def)), bytes_of(from_def.flat)) << name;
    ASSERT_TRUE(by_def.world.add_joint(from_def.def)) << name << ": " << by_def.world.problems()[0].message;
    ASSERT_TRUE(submit(state_of(by_flat.world), AddJoint{from_flat.flat}).joint) << name;
    for (int step = 0; step < 60; ++step) {
      EXPECT_EQ(by_def.world.hash(), by_flat.world.hash()) << name << ", step " << step;
      by_def.world.step(1.0f / 60.0f);
      by_flat.world.step(1.0f / 60.0f);
    }
  }
  EXPECT_EQ(kinds, (1u << kJointKindCount) - 1) << "a kind is missing in the table";
}

// A spring of zero is none: the joint is the one that was given none.
TEST(JointDefinitions, AZeroSpringIsNone) {
  EXPECT_FALSE(flatten(HingeDef{}).stiffness.has_value());
  EXPECT_FALSE(flatten(WheelDef{.damping = 0.0f}).damping.has_value());
  EXPECT_EQ(flatten(HingeDef{.stiffness = 2.0f}).stiffness, 2.0f);
}

// ------------------------------------------------------------------------------------------------------------ refusals

// A definition that is taken as it stands, of each kind.
JointDef good(JointKind kind, const Scene& scene) {
  JointDef def = default_joint(kind);
  std::visit(
      [&](auto& d) {
        d.a = scene.a, d.b = scene.b, d.anchor = {1, 2, 3};
        if constexpr (requires { d.axis_b; }) d.axis_b = Vec3{0, 0, 1};
        if constexpr (requires { d.points; }) d.points = {{-1, 0, 0}, {0, 0, 0}, {1, 0.2f, 0}};
      },
      def);
  return def;
}

// Gives `spoil` every kind; those that it says it spoilt must be refused with the words. Returns how many.
template <class Spoil>
int expect_refusals(const std::string& words, Spoil spoil) {
  int refused = 0;
  for (int kind = 0; kind < kJointKindCount; ++kind) {
    Scene scene;
    JointDef def = good(JointKind(kind), scene);
    if (!std::visit([&](auto& d) { return spoil(d); }, def)) continue;
    ++refused;
    EXPECT_FALSE(scene.world.add_joint(def)) << to_string(JointKind(kind)) << ": " << words;
    const std::span<const Problem> problems = scene.world.problems();
    if (problems.size() != 1u) {
      ADD_FAILURE() << to_string(JointKind(kind)) << ": " << problems.size() << " problems";
      continue;
    }
    EXPECT_EQ(std::string(problems[0].message), words) << to_string(JointKind(kind));
  }
  return refused;
}

// Spoils one field where the kind has it.
#define SPOIL(field, value)                \
  [](auto& d) {                            \
    if constexpr (requires { d.field; }) { \
      d.field = value;                     \
      return true;                         \
    } else {                               \
      return false;                        \
    }                                      \
  }

TEST(JointDefinitions, GoodOnesAreTaken) {
  for (int kind = 0; kind < kJointKindCount; ++kind) {
    Scene scene;
    EXPECT_TRUE(scene.world.add_joint(good(JointKind(kind), scene))) << to_string(JointKind(kind));
  }
}

TEST(JointDefinitions, BadValuesAreRefusedByTheNameOfTheirField) {
  const std::string range = "; it must lie within 0 and 1e+30";
  EXPECT_EQ(expect_refusals(
                "joint.anchor.position is (inf, 0, 0); every component must be finite and within 1e12 m",
                SPOIL(anchor, (DVec3{std::numeric_limits<double>::infinity(), 0, 0}))),
            15);
  EXPECT_EQ(expect_refusals("joint.axis is zero; it must have a direction", SPOIL(axis, Vec3{})), 9);
  EXPECT_EQ(expect_refusals("joint.axis_b is zero; it must have a direction", SPOIL(axis_b, Vec3{})), 7);
  EXPECT_EQ(expect_refusals("joint.limits.high is -2; it must lie within 1 and 1e+09",
                            SPOIL(limits, (Limits{1, -2}))),
            6);
  EXPECT_EQ(expect_refusals("joint.limit_frequency is -1; it must lie within 0 and 1e+06",
                            SPOIL(limit_frequency, -1.0f)),
            6);
  EXPECT_EQ(expect_refusals("joint.limit_damping_ratio is -1; it must lie within 0 and 1e+06",
                            SPOIL(limit_damping_ratio, -1.0f)),
            6);
  EXPECT_EQ(expect_refusals("motor.max_force is -1" + range, SPOIL(motor, (Motor{.max_force = -1}))), 6);
  EXPECT_EQ(expect_refusals("joint.stiffness is -1" + range, SPOIL(stiffness, -1.0f)), 7);
  EXPECT_EQ(expect_refusals("joint.damping is nan" + range,
                            SPOIL(damping, std::numeric_limits<float>::quiet_NaN())),
            7);
  EXPECT_EQ(expect_refusals("joint.friction is -1" + range, SPOIL(friction, -1.0f)), 7);
  EXPECT_EQ(
      expect_refusals("drive.frequency is -1; it must lie within 0 and 1e+06", SPOIL(drive.frequency, -1.0f)),
      3);
  EXPECT_EQ(expect_refusals("joint.break_force is -1" + range, SPOIL(break_force, -1.0f)), 15);
  EXPECT_EQ(expect_refusals("joint.break_torque is -1" + range, SPOIL(break_torque, -1.0f)), 15);
}

TEST(JointDefinitions, BadValuesOfSomeKindsAreRefused) {
  const std::string range = "; it must lie within 0 and 1e+30";
  EXPECT_EQ(expect_refusals("joint.length is -1" + range, SPOIL(length, -1.0f)), 2);
  EXPECT_EQ(expect_refusals("joint.min_length is -1" + range, SPOIL(min_length, -1.0f)), 1);
  EXPECT_EQ(expect_refusals("joint.max_length is -1" + range, SPOIL(max_length, -1.0f)), 1);
  EXPECT_EQ(
      expect_refusals("joint.frequency is -1; it must lie within 1e-06 and 1e+06", SPOIL(frequency, -1.0f)),
      1);
  EXPECT_EQ(expect_refusals("joint.damping_ratio is -1; it must lie within 0 and 1e+06",
                            SPOIL(damping_ratio, -1.0f)),
            1);
  EXPECT_EQ(expect_refusals("joint.swing_y is 4; it must lie within 0 and 3.1416", SPOIL(swing_y, 4.0f)), 1);
  EXPECT_EQ(expect_refusals("joint.swing_z is -1" + range, SPOIL(swing_z, -1.0f)), 1);
  EXPECT_EQ(expect_refusals("joint.points has 1 points; it must have 2 to 4096",
                            SPOIL(points, std::vector<Vec3>(1))),
            1);
  EXPECT_EQ(expect_refusals("joint.points[0] and the point after it are the same",
                            SPOIL(points, std::vector<Vec3>(2))),
            1);
  EXPECT_EQ(
      expect_refusals("joint.orientation is 7; there is no such", SPOIL(orientation, PathOrientation(7))), 1);
  EXPECT_EQ(
      expect_refusals("joint axis: motion is 7; there is no such", SPOIL(steering.motion, AxisMotion(7))), 1);
  EXPECT_EQ(expect_refusals("joint axis: friction is -1" + range, SPOIL(angular_z.friction, -1.0f)), 2);
  EXPECT_EQ(expect_refusals("joint axis: stiffness is -1" + range, SPOIL(linear_y.stiffness, -1.0f)), 1);
  EXPECT_EQ(expect_refusals(
                "joint.ground_b.position is (inf, 0, 0); every component must be finite and within 1e12 m",
                SPOIL(ground_b, (DVec3{std::numeric_limits<double>::infinity(), 0, 0}))),
            1);
}

TEST(JointDefinitions, ARackNeedsItsDirectionAndAGearItsRatio) {
  Scene scene;
  EXPECT_FALSE(scene.world.add_joint(RackAndPinionDef{.a = scene.a, .b = scene.b}));
  EXPECT_FALSE(scene.world.add_joint(GearDef{.a = scene.a, .b = scene.b, .ratio = 0.0f}));
  EXPECT_FALSE(scene.world.add_joint(PulleyDef{.b = scene.b}));
  EXPECT_FALSE(scene.world.add_joint(BallDef{.a = scene.a, .b = scene.a}));
  EXPECT_FALSE(scene.world.add_joint(BallDef{}));
  const char* const words[] = {
      "joint.axis_b, the rack's way, must be given and across joint.axis",
      "joint.ratio is 0; it must not be zero", "joint.a and joint.b of a pulley must both be bodies",
      "joint.a and joint.b are the same body", "joint.a and joint.b are both the world; one must be a body"};
  const std::span<const Problem> problems = scene.world.problems();
  ASSERT_EQ(problems.size(), std::size(words));
  for (std::size_t i = 0; i < std::size(words); ++i) {
    EXPECT_NE(std::string(problems[i].message).find(words[i]), std::string::npos) << problems[i].message;
  }
}

}  // namespace
}  // namespace gyre::joint_definitions_test
