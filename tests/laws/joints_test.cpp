// Every kind of joint: what it leaves free moves as if alone, what it holds stays, and what acts on it does what its name
// says. Closed forms.
#include "laws/any_joint.h"
#include "laws/kit.h"

namespace gyre::laws::joints_test {
namespace {

// ---------------------------------------------------------------------------------------------------- frees and holds

// What a kind leaves free of a body that stands on the world: which of six motions of its frame.
struct Freedom {
  const char* name;
  FlatJoint def;
  bool free[6];  // slides along x, y, z; turns about x, y, z
};

JointAxisDef of(AxisMotion motion) { return {.motion = motion}; }

std::vector<Freedom> freedoms() {
  std::vector<Freedom> all = {
      {"ball", {.kind = JointKind::ball}, {false, false, false, true, true, true}},
      {"hinge", {.kind = JointKind::hinge}, {false, false, false, true, false, false}},
      {"slider", {.kind = JointKind::slider}, {true, false, false, false, false, false}},
      {"fixed", {.kind = JointKind::fixed}, {false, false, false, false, false, false}},
      {"cone", {.kind = JointKind::cone}, {false, false, false, true, true, true}},
      {"universal",
       {.kind = JointKind::universal, .axis_b = Vec3{0, 0, 1}},
       {false, false, false, true, false, true}},
      {"wheel",
       {.kind = JointKind::wheel, .axis_b = Vec3{0, 0, 1}},
       {true, false, false, false, false, true}},
      {"steered wheel",
       {.kind = JointKind::wheel, .axis_b = Vec3{0, 0, 1}, .angular_x = of(AxisMotion::free)},
       {true, false, false, true, false, true}},
      {"path",
       {.kind = JointKind::path, .path = {{-9, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {9, 0, 0}}},
       {true, false, false, true, true, true}},
      {"path, fixed",
       {.kind = JointKind::path,
        .path = {{-9, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {9, 0, 0}},
        .path_orientation = PathOrientation::fixed},
       {true, false, false, false, false, false}},
      // Long enough that a way of half a metre across it is no bend of it, to 2e-4.
      {"rod", {.kind = JointKind::distance, .anchor = {-1001, 0, 0}}, {false, true, true, true, true, true}},
      {"rope, slack",
       {.kind = JointKind::distance, .anchor = {-3, 0, 0}, .max_length = 9.0f},
       {true, true, true, true, true, true}},
      // With the world as the other wheel, which does not turn. (A rack that turns is moved by its teeth: see RackAndPinion.)
      {"gear", {.kind = JointKind::gear}, {true, true, true, false, true, true}},
      {"mouse that lets go", {.kind = JointKind::mouse}, {true, true, true, true, true, true}},
      {"motor without force", {.kind = JointKind::motor}, {true, true, true, true, true, true}},
  };
  // Of six axes every single one, and all but one.
  for (int axis = 0; axis < 6; ++axis) {
    for (const bool inverted : {false, true}) {
      Freedom f{"six_dof", {.kind = JointKind::six_dof, .axis_b = Vec3{0, 0, 1}}, {}};
      JointAxisDef* const axes[] = {&f.def.linear_x,  &f.def.linear_y,  &f.def.linear_z,
                                    &f.def.angular_x, &f.def.angular_y, &f.def.angular_z};
      for (int i = 0; i < 6; ++i) {
        f.free[i] = (i == axis) != inverted;
        if (f.free[i]) axes[i]->motion = AxisMotion::free;
      }
      all.push_back(f);
    }
  }
  return all;
}

constexpr Vec3 kUnits[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// A free motion is that of a body without a joint; a held one does not happen, however it is pushed.
TEST(EveryKind, LeavesFreeWhatItSaysAndHoldsTheRest) {
  for (const Freedom& kind : freedoms()) {
    for (int axis = 0; axis < 6; ++axis) {
      World world = weightless();
      const BodyId body = world.add_body(point_body(2.0, {0.3f, 0.5f, 0.7f}, {1, 2, 3}));
      FlatJoint def = kind.def;
      def.b = body;
      def.anchor = def.anchor + DVec3{1, 2, 3};
      ASSERT_TRUE(world.add_joint(definition_of(def))) << kind.name;
      const Vec3 unit = kUnits[axis % 3];
      const double moments[3] = {0.3, 0.5, 0.7};
      double expected = 0.0;
      for (int i = 0; i < 60; ++i) {
        if (axis < 3) {
          world.add_force(body, 2.0f * unit);
        } else {
          world.add_torque(body, 0.5f * unit);
        }
        world.step(kStep);
      }
      expected = axis < 3 ? 1.0 : 0.5 / moments[axis - 3];
      const Vec3 velocity = axis < 3 ? world.linear_velocity(body) : world.angular_velocity(body);
      const double speed = double(dot(velocity, unit));
      const DVec3 off = world.pose(body).position - DVec3{1, 2, 3};
      const Vec3 turn = to_rotation_vector(world.pose(body).orientation);
      const double moved = axis < 3 ? dot(off, DVec3(unit)) : double(dot(turn, unit));
      const char* const label = axis < 3 ? "slides" : "turns";
      SCOPED_TRACE(testing::Message() << kind.name << " " << label << " along or about axis " << axis % 3);
      if (kind.free[axis]) {
        EXPECT_NEAR(speed, expected, 1e-4 * expected);
        EXPECT_NEAR(moved, 0.5 * expected, 0.01 * expected);  // first order in the sub-step: h / 2 of 1 s
      } else {
        EXPECT_NEAR(speed, 0.0, 1e-4 * expected);
        EXPECT_NEAR(moved, 0.0, 1e-4);
      }
    }
  }
}

// Held axes do not creep under a weight at an arm: 1 kg 1 m out, beside a wall.
TEST(EveryKind, CarriesAWeightAtAnArm) {
  for (const Freedom& kind : freedoms()) {
    for (int down = 0; down < 3; ++down) {
      World world = make_world({.gravity = -9.81f * kUnits[down], .sleeping = false});
      const BodyId body = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}));
      FlatJoint def = kind.def;
      def.b = body;
      const Vec3 arm = kUnits[(down + 1) % 3];  // across gravity
      def.anchor = -1.0 * DVec3(arm);
      const int about = 3 + (down + 2) % 3;
      if (kind.free[down] || kind.free[about]) continue;
      bool couples =
          false;  // Cardan angles turn each other's axes: only where nothing else is free they hold alone
      for (int i = 3; i < 6; ++i) couples = couples || kind.free[i];
      if (couples) continue;
      const JointId joint = world.add_joint(definition_of(def));
      ASSERT_TRUE(joint);
      run(world, 2.0);
      SCOPED_TRACE(testing::Message() << kind.name << " weight along axis " << down);
      EXPECT_LE(length(world.pose(body).position), 1e-3);
      const JointState reading = world.joint_state(joint);
      EXPECT_NEAR(double(length(reading.force)), 9.81, 0.01 * 9.81);
      EXPECT_NEAR(double(length(reading.torque)), 9.81, 0.01 * 9.81);
    }
  }
}

// ------------------------------------------------------------------------------------------------ what acts on an axis

// The single axes that something may act on, as bodies of inertia 1 on the world.
struct Axis {
  const char* name;
  FlatJoint def;
  JointAxis axis;
  bool turns;
  Vec3 unit;  // of the motion
};
std::vector<Axis> axes() {
  const FlatJoint universal{.kind = JointKind::universal, .axis_b = Vec3{0, 0, 1}};
  const FlatJoint wheel{.kind = JointKind::wheel, .axis_b = Vec3{0, 0, 1}, .angular_x = of(AxisMotion::free)};
  std::vector<Axis> all = {
      {"hinge", {.kind = JointKind::hinge}, JointAxis::angular_x, true, {1, 0, 0}},
      {"slider", {.kind = JointKind::slider}, JointAxis::linear_x, false, {1, 0, 0}},
      {"cone's twist", {.kind = JointKind::cone}, JointAxis::angular_x, true, {1, 0, 0}},
      {"universal about a's axis", universal, JointAxis::angular_x, true, {1, 0, 0}},
      {"universal about b's axis", universal, JointAxis::angular_z, true, {0, 0, 1}},
      {"wheel's suspension", wheel, JointAxis::linear_x, false, {1, 0, 0}},
      {"wheel's steering", wheel, JointAxis::angular_x, true, {1, 0, 0}},
      {"wheel's spin", wheel, JointAxis::angular_z, true, {0, 0, 1}},
      {"path",
       {.kind = JointKind::path, .path = {{-99, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {99, 0, 0}}},
       JointAxis::linear_x,
       false,
       {1, 0, 0}},
  };
  // Each of the six of a six_dof, the others locked.
  const char* const names[] = {"six_dof, linear_x",  "six_dof, linear_y",  "six_dof, linear_z",
                               "six_dof, angular_x", "six_dof, angular_y", "six_dof, angular_z"};
  for (int i = 0; i < kJointAxisCount; ++i) {
    Axis axis{names[i], {.kind = JointKind::six_dof, .axis_b = Vec3{0, 0, 1}}, JointAxis(i), i >= 3, kUnits[i % 3]};
    JointAxisDef* const defs[] = {&axis.def.linear_x,  &axis.def.linear_y,  &axis.def.linear_z,
                                  &axis.def.angular_x, &axis.def.angular_y, &axis.def.angular_z};
    defs[i]->motion = AxisMotion::free;
    all.push_back(axis);
  }
  return all;
}

struct Rig {
  World world;
  BodyId body;
  JointId joint;
  const Axis& axis;

  Rig(const Axis& a, const JointAxisDef& def, Vec3 gravity = {})
      : world(make_world({.gravity = gravity, .sleeping = false})), axis(a) {
    body = world.add_body(point_body(1.0, {1, 1, 1}));
    FlatJoint made = a.def;
    made.b = body;
    joint = world.add_joint(definition_of(made));
    EXPECT_TRUE(world.set_joint_axis(joint, a.axis, def)) << a.name;
  }
  void direction(float by) {
    if (axis.turns) {
      world.add_torque(body, by * axis.unit);
    } else {
      world.add_force(body, by * axis.unit);
    }
  }
  JointAxisState reading() const { return world.joint_axis_state(joint, axis.axis); }
  double speed() const {
    return double(dot(axis.turns ? world.angular_velocity(body) : world.linear_velocity(body), axis.unit));
  }
  void set_speed(float speed) {
    world.set_velocity(body, axis.turns ? Vec3{} : speed * axis.unit,
                       axis.turns ? speed * axis.unit : Vec3{});
  }
};

TEST(EveryAxis, StopsAtItsLimits) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    for (const float way : {-1.0f, 1.0f}) {
      Rig rig(axis, {.motion = AxisMotion::limited, .limits = {-0.3f, 0.5f}});
      double most = 0.0;
      for (int i = 0; i < 240; ++i) {
        rig.direction(2.0f * way);
        rig.world.step(kStep);
        most = std::max(most, double(way) * double(rig.reading().position));
      }
      const double stop = way > 0.0f ? 0.5 : 0.3;
      EXPECT_NEAR(double(rig.reading().position), double(way) * stop, 2e-3);
      EXPECT_LE(most, stop + 5e-3);
      EXPECT_NEAR(rig.speed(), 0.0, 1e-3);
      EXPECT_NEAR(double(rig.reading().force), -2.0 * double(way), 1e-2);
    }
  }
}

// A soft limit gives way like a spring of its frequency on the body: load / (2 pi f)^2.
TEST(EveryAxis, GivesWayAtSoftLimits) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::limited,
                   .limits = {-0.1f, 0.1f},
                   .limit_frequency = 2.0f,
                   .limit_damping_ratio = 1.0f});
    for (int i = 0; i < 600; ++i) {
      rig.direction(5.0f);
      rig.world.step(kStep);
    }
    const double omega = 2.0 * kPiDouble * 2.0;
    EXPECT_NEAR(double(rig.reading().position), 0.1 + 5.0 / (omega * omega), 1e-4);
  }
}

// inertia 1, at most 2 N m or N, to 10: 2 a second each second, there after 5 s, and then nothing.
TEST(EveryAxis, ReachesASpeedAsItsForceSays) {
  for (const Axis& axis : axes()) {
    if (axis.axis == JointAxis::angular_y) continue;  // ends at a quarter turn
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::free, .motor = {.target_velocity = 10.0f, .max_force = 2.0f}});
    run(rig.world, 4.0);
    EXPECT_TRUE(relative_row("A-38 acceleration", rig.speed() / 4.0, 2.0, 1e-2, 1e-4));
    double reached = 4.0;
    while (rig.speed() < 10.0 * (1.0 - 1e-5) && reached < 6.0) {
      rig.world.step(kStep);
      reached += double(kStep);
    }
    EXPECT_TRUE(row("A-38 time until it has its speed (s)", reached, 5.0, 5e-2, 1.5 * double(kStep)));
    run(rig.world, 1.0);
    EXPECT_TRUE(relative_row("A-38 speed then", rig.speed(), 10.0, 1e-2, 1e-4));
    EXPECT_TRUE(limit_row("A-38 force then", std::fabs(double(rig.reading().force)), 2e-2, 2e-4));
  }
}

// A motor of limited force brings what is free to its speed at force / inertia, and holds it there with none.
TEST(EveryAxis, IsDrivenToASpeed) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::free, .motor = {.target_velocity = 1.0f, .max_force = 2.0f}});
    for (int i = 0; i < 15; ++i) rig.world.step(kStep);
    EXPECT_NEAR(rig.speed(), 0.5, 1e-4) << "still at full force";
    EXPECT_NEAR(double(rig.reading().force), 2.0, 1e-3);
    run(rig.world, 0.5);
    EXPECT_NEAR(rig.speed(), 1.0, 1e-4);
    run(rig.world, 0.1);
    EXPECT_NEAR(double(rig.reading().force), 0.0, 1e-3);
    EXPECT_NEAR(double(rig.reading().velocity), 1.0, 1e-4);
  }
}

TEST(EveryAxis, IsDrivenToAPlace) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    for (const float frequency : {0.0f, 2.0f}) {
      Rig rig(axis, {.motion = AxisMotion::free,
                     .motor = {.target_position = 0.4f, .max_force = 1000.0f, .frequency = frequency}});
      run(rig.world, 3.0);
      EXPECT_NEAR(double(rig.reading().position), 0.4, 1e-4);
      // Under a load it gives way as its spring does, or not at all.
      for (int i = 0; i < 300; ++i) {
        rig.direction(3.0f);
        rig.world.step(kStep);
      }
      const double omega = 2.0 * kPiDouble * double(frequency);
      const double sag = frequency > 0.0f ? 3.0 / (omega * omega) : 0.0;
      EXPECT_NEAR(double(rig.reading().position), 0.4 + sag, frequency > 0.0f ? 1e-3 : 2e-3);
    }
  }
}

TEST(EveryAxis, IsSprungAsHookeSays) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::free, .stiffness = 39.478418f, .rest_position = 0.25f});
    ZeroCrossings through;
    for (int i = 0; i < 600; ++i) {
      through.add(double(i) * double(kStep), double(rig.reading().position) - 0.25);
      rig.world.step(kStep);
    }
    EXPECT_NEAR(through.mean_period(), 1.0, 1e-3);
    EXPECT_NEAR(rig.world.energy().elastic + rig.world.energy().kinetic, 0.5 * 39.478418 * 0.25 * 0.25, 0.02);
    // And it carries a load where force is stiffness times displacement.
    Rig damped(axis,
               {.motion = AxisMotion::free, .stiffness = 40.0f, .damping = 6.0f, .rest_position = 0.25f});
    for (int i = 0; i < 900; ++i) {
      damped.direction(4.0f);
      damped.world.step(kStep);
    }
    EXPECT_NEAR(double(damped.reading().position), 0.35, 1e-5);
  }
}

TEST(EveryAxis, IsBrakedByFriction) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::free, .friction = 2.0f});
    rig.set_speed(1.0f);
    for (int i = 0; i < 15; ++i) rig.world.step(kStep);
    EXPECT_NEAR(rig.speed(), 0.5, 1e-3);
    run(rig.world, 1.0);
    EXPECT_NEAR(rig.speed(), 0.0, 1e-6);
    EXPECT_NEAR(double(rig.reading().position), 0.25, 5e-3);
    const double there = double(rig.reading().position);
    for (int i = 0; i < 120; ++i) {
      rig.direction(1.9f);
      rig.world.step(kStep);
    }
    EXPECT_NEAR(double(rig.reading().position), there, 1e-4) << "stiction holds below its force";
    for (int i = 0; i < 60; ++i) {
      rig.direction(3.0f);
      rig.world.step(kStep);
    }
    EXPECT_NEAR(rig.speed(), 1.0, 1e-2);
  }
}

// what acts on one axis adds up.
TEST(EveryAxis, AddsSpringAndMotor) {
  for (const Axis& axis : axes()) {
    SCOPED_TRACE(axis.name);
    Rig rig(axis, {.motion = AxisMotion::free,
                   .motor = {.target_velocity = 1.0f, .max_force = 3.0f},
                   .stiffness = 10.0f,
                   .damping = 5.0f,
                   .rest_position = -0.2f});
    rig.world.step(kStep);
    EXPECT_GT(rig.speed(), 0.0) << "A-55: 3 and 10 * -0.2 together push up";
    run(rig.world, 10.0);
    EXPECT_TRUE(relative_row("A-55 place of spring and motor", double(rig.reading().position), -0.2 + 3.0 / 10.0,
                             1e-2, 1e-4));
  }
}

}  // namespace
}  // namespace gyre::laws::joints_test
