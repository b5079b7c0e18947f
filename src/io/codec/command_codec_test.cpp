#include "io/codec/command_codec.h"

#include "determinism/scenes.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::command_codec_test {
namespace {

constexpr std::uint16_t kWorld = 77;

std::vector<std::byte> bytes_of(const Command& command) {
  ByteWriter out;
  write_command(out, command);
  return out.take();
}

// One command of each kind, with a different value in every field.
std::vector<Command> all_commands() {
  const BodyId body{3, 5, kWorld};
  const ShapeId shape{8, 1, kWorld};
  const JointId joint{2, 7, kWorld};
  const Material material{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 6};
  const Pose pose{{1, 2, 3}, {0.5f, -0.5f, 0.5f, 0.5f}};
  ShapeDef shape_def{.geometry = Capsule{0.25f, 1},
                     .local = {{1, 2, 3}, {0, 1, 0, 0}},
                     .density = 7,
                     .material = material,
                     .filter = {2, 4, -3},
                     .sensor = true,
                     .user_data = 1234567890123};
  BodyDef body_def;
  body_def.type = BodyType::kinematic;
  body_def.pose = pose;
  body_def.linear_velocity = {1, 2, 3}, body_def.angular_velocity = {4, 5, 6};
  body_def.linear_damping = 0.5f, body_def.angular_damping = 0.25f, body_def.gravity_scale = -1;
  body_def.continuous = true, body_def.can_sleep = false;
  body_def.locked = {{true, false, true}, {false, true, false}};
  body_def.mass = 5.0f, body_def.center_of_mass = Vec3{1, 1, 2}, body_def.inertia = Sym3{1, 2, 3, 4, 5, 6};
  body_def.user_data = 99;
  FlatJoint joint_def{
      .kind = JointKind::distance, .a = body, .b = {}, .anchor = {1, 2, 3}, .axis = {0, 0, 1}};
  joint_def.anchor_b = DVec3{4, 5, 6}, joint_def.limits = Limits{-1, 2};
  joint_def.motor = {
      .target_velocity = 1, .target_position = 2.0f, .max_force = 3, .frequency = 4, .damping_ratio = 5};
  joint_def.length = 1.0f, joint_def.min_length = 2.0f, joint_def.max_length = 3.0f,
  joint_def.stiffness = 4.0f;
  joint_def.damping = 5.0f, joint_def.break_force = 6.0f, joint_def.break_torque = 7.0f;
  joint_def.collide_connected = true;
  return {AddBody{body_def, {shape_def, ShapeDef{}}},
          RemoveBody{body},
          AddShape{body, shape_def},
          RemoveShape{shape},
          AddJoint{joint_def},
          RemoveJoint{joint},
          SetPose{body, pose},
          SetVelocity{body, {1, 2, 3}, {4, 5, 6}},
          MoveKinematic{body, pose, 0.5f},
          SetType{body, BodyType::fixed},
          SetGravity{{1, 2, 3}},
          SetGravityScale{body, 2},
          SetDamping{body, 3, 4},
          SetMaterial{shape, material},
          SetMaterialPair{{1, 2, 0.1f, 0.2f, 0.3f}},
          SetFilter{shape, {5, 6, 7}},
          SetMotor{joint, joint_def.motor},
          SetSleeping{false},
          SetAwake{body, false},
          SetSubsteps{9},
          AddForce{body, {1, 2, 3}, {4, 5, 6}},
          AddImpulse{body, {1, 2, 3}, {4, 5, 6}},
          Step{0.25f},
          SetCombineRules{CombineRule::minimum, CombineRule::product},
          SetSurfaceRule{{4, {.static_friction = 0.1f, .id = 4}, {1, 2, 3}, {0, 1, 0}}},
          AddField{{.kind = FieldKind::vortex,
                    .bounds = FieldBounds{{1, 2, 3}, {4, 5, 6}},
                    .strength = 7,
                    .axis = {0, 0, 1}}},
          SetField{{1, 1, 1}, {.kind = FieldKind::buoyancy, .density = 900, .offset = 2}},
          RemoveField{{1, 1, 1}},
          Explode{{.center = {1, 2, 3}, .pressure = 4, .occlusion = false}},
          SetJointAxis{
              joint, JointAxis::angular_y, {.motion = AxisMotion::limited, .limits = {1, 2}, .friction = 3}},
          SetDrive{joint, {.position = {1, 2, 3}, .frequency = 4, .max_torque = 5}},
          SetJointEnabled{joint, false},
          SetMotion{IntegratorKind::rk4, SpringKind::explicit_force, TimeStepping::adaptive, 0.5f, 7},
          SetSolver{SolverKind::lcp, {LcpMethod::lemke, 8, 30, 90}},
          AddSoft{std::make_shared<const SoftDef>(ClothDef{.grid = ClothGrid{{2, 1}, {4, 3}},
                                                           .bend_stiffness = 0.5f,
                                                           .pressure = 300.0f,
                                                           .ambient_pressure = 7.0f,
                                                           .pressure_law = PressureLaw::constant})},
          RemoveSoft{SoftId{3, 1, kWorld}},
          AttachSoft{SoftId{3, 1, kWorld}, 7, BodyId{5, 3, kWorld}},
          ReleaseSoft{SoftId{3, 1, kWorld}, 7},
          SetVertices{SoftId{3, 1, kWorld}, {{1, 2, 3}}, {{4, 5, 6}}},
          AddFluid{std::make_shared<const FluidDef>(LiquidDef{
              .fill = {{{0, 0, 0}, {1, 0.5, 1}}},
              .emitters = {{.position = {0.5, 0.5, 0.5}, .velocity = Vec3{1, 2, 3}}},
              .particles = LiquidParticles{.positions = {{0.5, 0.5, 0.5}}, .velocities = {{1, 2, 3}}}})},
          RemoveFluid{FluidId{2, 1, kWorld}},
          SetEmitters{FluidId{2, 1, kWorld},
                      {{.position = {1, 2, 3}, .radius = 0.5f, .fuel = 0.25f},
                       {.velocity = Vec3{3, 2, 1}, .fuel = 2.0f}}},
          SetSleepShare{0.25f},
          SetSleepSpeed{body, 0.125f},
          SetMass{body, {.mass = 2.0f, .center_of_mass = Vec3{1, 2, 3}, .inertia = Sym3{1, 2, 3, 4, 5, 6}}},
          SetDensity{shape, 3.5f},
          SetLockedAxes{body, {{true, false, true}, {false, true, false}}},
          SetContinuous{body, true},
          SetCanSleep{body, false},
          SetSensor{shape, true},
          SetShape{shape, Capsule{0.25f, 1}, Transform{{1, 2, 3}, {0, 1, 0, 0}}},
          SetBodyUserData{body, 1234567890123},
          SetShapeUserData{shape, 1234567890124},
          SetBreakLoad{joint, 1.5f, 2.5f},
          SetPairIgnored{body, BodyId{4, 6, kWorld}, true},
          SetEnabled{body, false},
          AddCoupling{{.terms = {{joint, JointAxis::linear_y, 2.5f}, {JointId{1, 2, kWorld}, JointAxis::angular_z, -3.0f}},
                       .offset = 0.75f}},
          RemoveCoupling{CouplingId{4, 3, kWorld}},
          SetFluidPose{FluidId{2, 1, kWorld}, Pose{{1, 2, 3}, {0, 1, 0, 0}}},
          SetFluidVelocity{FluidId{2, 1, kWorld}, {1, 2, 3}, {4, 5, 6}},
          SetVertexLimits{SoftId{3, 1, kWorld}, {{1, 2, 3}}, {0.5f}, {{0, 1, 0}}, {0.25f}},
          AttachPoint{SoftId{3, 1, kWorld}, {{1, 2, 3, 0}, {0.25f, 0.25f, 0.5f, 0.0f}}, BodyId{5, 3, kWorld}},
          ReleasePoints{SoftId{3, 1, kWorld}, BodyId{5, 3, kWorld}}};
}

// Fields of certain kinds of joints are restored as well.
TEST(CommandCodec, JointsOfEveryKindComeBack) {
  for (int kind = 0; kind < kJointKindCount; ++kind) {
    FlatJoint def{
        .kind = JointKind(kind), .friction = 0.5f, .limit_frequency = 6.0f, .limit_damping_ratio = 0.7f};
    if (def.kind > JointKind::distance) {
      def.axis_b = Vec3{0, 0, 1}, def.swing_y = 0.3f, def.swing_z = 0.2f, def.ratio = 4.0f;
      def.ground_a = {1, 2, 3}, def.ground_b = {4, 5, 6};
      def.linear_y = {.motion = AxisMotion::free, .stiffness = 7.0f},
      def.angular_z = {.motor = {.target_position = 2.0f}};
      def.drive = {.orientation = {0, 0, 1, 0}, .linear_velocity = {1, 0, 0}, .max_force = 8.0f};
      def.path = {{1, 2, 3}, {4, 5, 6}}, def.path_closed = true,
      def.path_orientation = PathOrientation::following;
    }
    const std::vector<std::byte> bytes = bytes_of(AddJoint{def});
    ByteReader in(bytes);
    const Command back = read_command(in, {}, kWorld);
    EXPECT_TRUE(in.finished()) << kind;
    EXPECT_EQ(bytes_of(back), bytes) << kind;
    const FlatJoint& read = std::get<AddJoint>(back).def;
    EXPECT_EQ(read.friction, 0.5f);
    EXPECT_EQ(read.path.size(), def.path.size());
    EXPECT_EQ(read.linear_y.stiffness, def.linear_y.stiffness);
    EXPECT_EQ(read.drive.max_force, def.drive.max_force);
  }
}

// A gas that burns has members which came later than those of other gases.
TEST(CommandCodec, AGasThatBurnsComesBack) {
  const AddFluid add{std::make_shared<const FluidDef>(
      GasDef{.emitters = {{.position = {0.5, 0.5, 0.5}, .velocity = Vec3{1, 2, 3}}, {.fuel = 0.5f}},
             .fields = GasFields{.density = {1, 2}, .fuel = {3, 4}},
             .combustion = Combustion{600.5f, 1, 2, 3, 4}})};
  const std::vector<std::byte> bytes = bytes_of(add);
  ByteReader in(bytes);
  const Command back = read_command(in, {}, kWorld);
  EXPECT_TRUE(in.finished());
  EXPECT_EQ(bytes_of(back), bytes);
  const GasDef& read = std::get<GasDef>(*std::get<AddFluid>(back).def);
  EXPECT_EQ(read.combustion->smoke_yield, 4.0f);
  EXPECT_EQ(read.fields->fuel, (std::vector<float>{3, 4}));
  EXPECT_EQ(read.emitters[1].fuel, 0.5f);
  EXPECT_EQ(read.emitters[0].velocity->z, 3.0f);
}

// The box of a fluid in axes of its own, which came later still.
TEST(CommandCodec, AFluidInAxesOfItsOwnComesBack) {
  const Pose pose{{1, 2, 3}, {0.6f, 0, 0.8f, 0}};
  for (const FluidDef& def :
       {FluidDef(GasDef{.combustion = Combustion{}, .pose = pose, .angular_velocity = {1, 2, 3}}),
        FluidDef(
            GasDef{.pose = pose, .angular_velocity = {1, 2, 3}, .adaptive_domain = AdaptiveDomain{5, 0.5f}}),
        FluidDef(GasDef{.combustion = Combustion{},
        .pose = pose,
        .angular_velocity = {1, 2, 3},
        .adaptive_domain = AdaptiveDomain{}}),
        FluidDef(LiquidDef{.pose = pose, .angular_velocity = {1, 2, 3}})}) {
    const std::vector<std::byte> bytes = bytes_of(AddFluid{std::make_shared<const FluidDef>(def)});
    ByteReader in(bytes);
    const Command back = read_command(in, {}, kWorld);
    EXPECT_TRUE(in.finished());
    EXPECT_EQ(bytes_of(back), bytes);
    std::visit(
        [&](const auto& one) {
          EXPECT_EQ(one.pose, pose);
          EXPECT_EQ(one.angular_velocity, (Vec3{1, 2, 3}));
        },
        *std::get<AddFluid>(back).def);
  }
}

TEST(CommandCodec, EveryCommandComesBack) {
  const std::vector<Command> commands = all_commands();
  ASSERT_EQ(commands.size(), std::variant_size_v<Command>);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    ASSERT_EQ(commands[i].index(), i);
    const std::vector<std::byte> bytes = bytes_of(commands[i]);
    ByteReader in(bytes);
    const Command back = read_command(in, {}, kWorld);
    EXPECT_TRUE(in.finished()) << i;
    EXPECT_EQ(bytes_of(back), bytes) << i;
  }
}

// The bytes must depend on every field: a command with one changed field must give other bytes.
TEST(CommandCodec, SpotChecksOfValues) {
  const std::vector<Command> commands = all_commands();
  const std::vector<std::byte> bytes = bytes_of(commands[0]);
  ByteReader in(bytes);
  const Command back = read_command(in, {}, kWorld);
  const AddBody& body = std::get<AddBody>(back);
  EXPECT_EQ(body.def.user_data, 99u);
  EXPECT_EQ(body.def.inertia->yz, 6.0f);
  EXPECT_TRUE(body.def.locked.linear[2]);
  EXPECT_FALSE(body.def.can_sleep);
  ASSERT_EQ(body.shapes.size(), 2u);
  EXPECT_EQ(body.shapes[0].filter.group, -3);
  EXPECT_EQ(std::get<Capsule>(body.shapes[0].geometry).half_height, 1.0f);
  EXPECT_FALSE(AddBody{}.def.mass.has_value());
}

TEST(CommandCodec, IdsBecomeThoseOfTheReadersWorld) {
  const std::vector<std::byte> bytes = bytes_of(AddJoint{{.a = {3, 5, kWorld}, .b = {}}});
  ByteReader in(bytes);
  const Command back = read_command(in, {}, 9);
  EXPECT_EQ(std::get<AddJoint>(back).def.a, (BodyId{3, 5, 9}));
  EXPECT_EQ(std::get<AddJoint>(back).def.b, BodyId{}) << "null stays null in every world";
}

TEST(CommandCodec, EveryCutIsRefused) {
  for (const Command& command : all_commands()) {
    const std::vector<std::byte> bytes = bytes_of(command);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      ByteReader in(std::span<const std::byte>(bytes).first(length));
      read_command(in, {}, kWorld);
      EXPECT_TRUE(in.failed());
    }
  }
}

TEST(CommandCodec, DamagedBytesNeverHarm) {
  for (const Command& command : all_commands()) {
    const std::vector<std::byte> good = bytes_of(command);
    for (std::size_t place = 0; place < good.size(); ++place) {
      for (int bit = 0; bit < 8; ++bit) {
        std::vector<std::byte> bytes = good;
        bytes[place] ^= std::byte(1 << bit);
        ByteReader in(bytes);
        read_command(in, {}, kWorld);
      }
    }
  }
  const std::byte unknown[1] = {std::byte(200)};
  ByteReader in(unknown);
  read_command(in, {}, kWorld);
  EXPECT_TRUE(in.failed());
}

}  // namespace
}  // namespace gyre::command_codec_test
