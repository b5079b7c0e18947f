// A world of soft matter and fluids that nobody chose: ropes, cloths, solids, gases and liquids with random settings among a few bodies,
// and commands on all of them while it runs, some of which break things.
//
// All choices follow from the number, the step and what the world holds. So a copy of the RandomMatter goes on with a copy of the world.
//
// No call draws two of its arguments from the dice: compilers take arguments in any order.
#pragma once

#include "random_choices.h"

#include <array>

namespace gyre::scenes {

class RandomMatter : public RandomChoices {
 public:
  explicit RandomMatter(std::uint32_t number) : RandomChoices(number) {
    Random random = dice(0, 1);
    const double far[] = {0, 0, 640, 1.0e5};
    origin_ = {far[pick(random, 4)], 0, -far[pick(random, 4)]};
    weightless_ = pick(random, 8) == 0;
    uneven_steps_ = pick(random, 3) == 0;
    wild_ = pick(random, 3) == 0;
    busy_ = pick(random, 4);
  }

  WorldDef def() const {
    Random random = dice(0, 2);
    WorldDef def;
    if (weightless_) def.gravity = {};
    def.sleeping = pick(random, 4) != 0;
    def.stepping.substeps = int(1 + pick(random, 5));
    if (pick(random, 10) == 0) def.stepping.time = TimeStepping(1 + pick(random, 2));
    def.stepping.tolerance = 0.0078125f;  // m; less takes many sub-steps
    if (pick(random, 6) == 0) def.stepping.solver = SolverKind(pick(random, 3));
    return def;
  }

  void build(World& world) {
    Random random = dice(0, 3);
    if (!weightless_) add_fixed(world, {origin_.x, 0, origin_.z}, Plane{});
    if (coin(random)) add_fixed(world, at(0.25, 0.5, 0), Sphere{0.375f});
    const std::uint32_t bodies = 2 + pick(random, 5);
    for (std::uint32_t i = 0; i < bodies; ++i) add_something_rigid(world, random);
    const std::uint32_t softs = 1 + pick(random, 4);
    for (std::uint32_t i = 0; i < softs; ++i) add_something_soft(world, random);
    const std::uint32_t fluids = pick(random, 3);
    for (std::uint32_t i = 0; i < fluids; ++i) add_fluid(world, random);
  }

  void drive(World& world, int step) const {
    Random random = dice(step, 4);
    if (pick(random, 4) < busy_) command(world, random);
    if (busy_ > 1 && coin(random)) command(world, random);
    if (wild_ && pick(random, 24) == 0) wild_command(world, random);
  }

  void step(World& world, int step) const {
    drive(world, step);
    world.step(seconds(step));
  }

 private:
  DVec3 at(double x, double y, double z) const { return origin_ + DVec3{x, y, z}; }

  // A place above the ground, within a metre or so of the origin.
  DVec3 place(Random& random) const {
    const Vec3 from_middle = random.next_vector(0.75f);
    return origin_ + DVec3{0, 1, 0} + from_middle;
  }

  void add_something_rigid(World& world, Random& random) const {
    BodyDef body;
    body.pose = {place(random), random.next_rotation()};
    body.linear_velocity = random.next_vector(pick(random, 8) == 0 ? 20.0f : 1.0f);
    body.angular_velocity = random.next_vector(4);
    if (pick(random, 4) == 0) body.type = BodyType::kinematic;
    ShapeDef shape;
    const int kind = int(pick(random, 7));
    shape.geometry = convex(kind, random.next(0.125f, 0.3125f));
    shape.density = random.next(200, 4000);
    shape.material.static_friction = random.next(0, 1);
    shape.material.dynamic_friction = 0.75f * shape.material.static_friction;
    shape.sensor = pick(random, 12) == 0;
    const BodyId added = world.add_body(body, shape);
    if (added && pick(random, 3) == 0) join_to_other(world, random, added);
  }
  static void join_to_other(World& world, Random& random, BodyId body) {
    const BodyId other = any_body(world, random);
    if (other != body) join(world, JointKind::ball, other, body, world.center_of_mass(body));
  }

  SoftSettings random_settings(Random& random) const {
    SoftSettings settings;
    const SoftIntegrator others[] = {
        SoftIntegrator::sdirk2, SoftIntegrator::visual, SoftIntegrator::semi_implicit_euler,
        SoftIntegrator::verlet, SoftIntegrator::rk4,    SoftIntegrator::explicit_euler};
    if (coin(random)) settings.integrator = others[pick(random, 6)];
    if (coin(random)) settings.damping = random.next(0, 0.0625f);
    settings.static_friction = random.next(0, 1);
    settings.dynamic_friction = 0.5f * settings.static_friction;
    if (pick(random, 8) == 0) settings.filter.group = -1;
    return settings;
  }

  void add_something_soft(World& world, Random& random) const {
    SoftId soft;
    const std::uint32_t kind = pick(random, 4);
    if (kind == 0) soft = add_random_rope(world, random);
    if (kind == 1) soft = add_random_cloth(world, random);
    if (kind == 2) soft = add_random_solid(world, random);
    if (kind == 3) soft = add_balloon(world, random);
    if (!soft) return;
    const std::uint32_t held = pick(random, 3);
    for (std::uint32_t i = 0; i < held; ++i) hold(world, random, soft);
  }

  SoftId add_random_rope(World& world, Random& random) const {
    RopeDef rope;
    const DVec3 begin = place(random), end = place(random);
    rope.points = {begin, end};
    rope.segments = int(2 + pick(random, 14));
    rope.links = RopeLinks(pick(random, 2));
    rope.radius = random.next(0.0078125f, 0.0625f);
    rope.linear_density = random.next(0.0625f, 2);
    if (coin(random)) rope.bend_stiffness = random.next(0, 0.5f);
    rope.settings = random_settings(random);
    return world.add_rope(rope);
  }

  SoftId add_random_cloth(World& world, Random& random) const {
    ClothDef cloth;
    const int across = int(2 + pick(random, 7)), along = int(2 + pick(random, 7));
    cloth.grid = ClothGrid{{0.125f * float(across), 0.125f * float(along)}, {across, along}};
    cloth.pose = {place(random), random.next_rotation()};
    cloth.links = ClothLinks(pick(random, 3));
    cloth.self_collision = pick(random, 4) != 0;
    cloth.stretch_stiffness = random.next(100, 3000);
    cloth.shear_stiffness = 0.375f * cloth.stretch_stiffness;
    cloth.bend_stiffness = random.next(0, 0.0009765625f);
    cloth.thickness = random.next(0.00390625f, 0.03125f);
    if (pick(random, 4) == 0) cloth.tear_strain = random.next(0.03125f, 0.5f);
    cloth.settings = random_settings(random);
    return world.add_cloth(cloth);
  }

  SoftId add_random_solid(World& world, Random& random) const {
    SolidDef solid;
    const Vec3 half{random.next(0.125f, 0.25f), 0.1875f, 0.15625f};
    const std::uint32_t form = pick(random, 5);
    if (form == 0) {
      solid.surface = SolidSurface{corners_of_box(half), triangles_of_box(), int(4 + pick(random, 2))};
    } else {
      const int x = int(1 + pick(random, 3)), y = int(1 + pick(random, 3));
      solid.box = SolidBox{half, {x, y, 2}};
    }
    solid.pose = {place(random), random.next_rotation()};
    solid.model = SolidModel(pick(random, 3));
    solid.density = random.next(100, 2000);
    solid.young_modulus = random.next(1.0e4f, pick(random, 4) == 0 ? 4.0e6f : 2.0e5f);
    solid.poisson_ratio = random.next(0, 0.484375f);
    if (form != 0 && pick(random, 4) == 0) solid.fracture_stress = random.next(1.0e3f, 2.0e4f);
    if (solid.model != SolidModel::linear && pick(random, 3) == 0) {
      solid.yield_stress = random.next(500, 1.0e4f);
      if (coin(random)) solid.creep_time = random.next(0, 0.25f);
    }
    solid.settings = random_settings(random);
    if (solid.settings.integrator == SoftIntegrator::visual)
      solid.settings.integrator = SoftIntegrator::implicit;
    return world.add_solid(solid);
  }
  static std::vector<Vec3> corners_of_box(Vec3 half) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
    return corners;
  }
  static std::vector<std::uint32_t> triangles_of_box() {
    return {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
            2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  }

  // An octahedron whose faces are divided once.
  SoftId add_balloon(World& world, Random& random) const {
    ClothDef balloon;
    balloon.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const std::uint32_t faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const Vec3 point = 0.6875f * (balloon.vertices[a] + balloon.vertices[b]);
      for (std::uint32_t i = 0; i < balloon.vertices.size(); ++i)
        if (balloon.vertices[i] == point) return i;
      balloon.vertices.push_back(point);
      return std::uint32_t(balloon.vertices.size() - 1);
    };
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const std::uint32_t corner : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
        balloon.triangles.push_back(corner);
    }
    const float size = random.next(0.1875f, 0.3125f);
    for (Vec3& vertex : balloon.vertices) vertex = size * vertex;
    balloon.pose = {place(random), random.next_rotation()};
    balloon.links = coin(random) ? ClothLinks::membrane : ClothLinks::springs;
    if (pick(random, 4) != 0) balloon.pressure = random.next(-200, 4000);
    balloon.shear_stiffness = 0.375f * balloon.stretch_stiffness;
    balloon.pressure_law = PressureLaw(pick(random, 2));
    if (pick(random, 4) == 0) balloon.tear_strain = random.next(0.0625f, 0.5f);
    balloon.settings = random_settings(random);
    return world.add_cloth(balloon);
  }

  void hold(World& world, Random& random, SoftId soft) const {
    const int vertex = int(pick(random, std::uint32_t(world.soft_info(soft).vertices)));
    if (coin(random)) {
      world.pin(soft, vertex);
    } else {
      world.attach(soft, vertex, any_body(world, random));
    }
  }

  Pose random_box_pose(Random& random) const {
    Pose pose{origin_, {}};
    if (pick(random, 3) == 0) pose.orientation = random.next_rotation();
    return pose;
  }
  static std::vector<FluidEmitter> random_emitters(Random& random) {
    std::vector<FluidEmitter> emitters(pick(random, 3));
    for (FluidEmitter& emitter : emitters) {
      const Vec3 from_middle = random.next_vector(0.5f);
      emitter.position = DVec3{0, 0.75, 0} + from_middle;
      emitter.radius = random.next(0.125f, 0.25f);
      emitter.temperature = random.next(280, 900);
      if (coin(random)) emitter.velocity = random.next_vector(1);
      emitter.end = random.next(0.25f, 2);
    }
    return emitters;
  }

  void add_fluid(World& world, Random& random) const {
    if (coin(random)) {
      add_random_gas(world, random);
    } else {
      add_random_liquid(world, random);
    }
  }

  void add_random_gas(World& world, Random& random) const {
    GasDef gas;
    gas.lower = {-0.875, 0, -0.875}, gas.upper = {0.875, 1.75, 0.875};
    const int cells = int(6 + pick(random, 4));
    gas.cells = {cells, cells, pick(random, 5) == 0 ? 1 : cells};
    gas.viscosity = coin(random) ? random.next(0, 0.0078125f) : 0.0f;
    gas.vorticity = coin(random) ? random.next(0, 0.5f) : 0.0f;
    gas.advection = Advection(pick(random, 2));
    gas.initial_velocity = random.next_vector(0.5f);
    const bool adaptive = pick(random, 4) == 0;
    if (adaptive) gas.adaptive_domain = AdaptiveDomain{2, 0.0625f}, gas.cells = {16, 16, 16};
    for (int axis = 0; axis < 3 && !adaptive; ++axis) {
      const std::uint32_t kind = pick(random, 4);
      for (int side = 0; side < 2; ++side)
        gas.sides[std::size_t(2 * axis + side)] =
            kind == 0 ? FluidBoundary::periodic : FluidBoundary(1 + pick(random, 3));
    }
    gas.emitters = random_emitters(random);
    if (pick(random, 4) == 0) {
      gas.combustion = Combustion{.smoke_yield = 0.125f};
      for (FluidEmitter& emitter : gas.emitters) emitter.fuel = 0.0625f;
    }
    gas.pose = random_box_pose(random);
    if (pick(random, 4) == 0) gas.linear_velocity = random.next_vector(0.5f);
    if (pick(random, 4) == 0) gas.angular_velocity = random.next_vector(0.5f);
    world.add_gas(gas);
  }

  void add_random_liquid(World& world, Random& random) const {
    LiquidDef liquid;
    liquid.lower = {-0.75, 0, -0.75}, liquid.upper = {0.75, 1.25, 0.75};
    liquid.cell_size = 0.15625f;
    liquid.fill = {{{-0.75, 0, -0.75}, {random.next(-0.5f, 0.75f), 0.75, 0.75}}};
    if (coin(random)) liquid.viscosity = random.next(0, 4);
    if (coin(random)) liquid.surface_tension = random.next(0, 0.25f);
    for (int axis = 0; axis < 3; axis += 2) {
      const std::uint32_t kind = pick(random, 4);
      for (int side = 0; side < 2; ++side)
        liquid.sides[std::size_t(2 * axis + side)] =
            kind == 0 ? FluidBoundary::periodic : FluidBoundary(1 + pick(random, 3));
    }
    liquid.emitters = random_emitters(random);
    liquid.pose = random_box_pose(random);
    if (pick(random, 4) == 0) liquid.linear_velocity = random.next_vector(0.5f);
    world.add_liquid(liquid);
  }

  static BodyId any_body(const World& world, Random& random) {
    const std::size_t count = world.bodies().ids.size();
    return count == 0 ? BodyId{} : body_number(world, pick(random, std::uint32_t(count)));
  }
  static SoftId any_soft(const World& world, Random& random) {
    std::vector<SoftId> softs(world.softs({}));
    world.softs(softs);
    return softs.empty() ? SoftId{} : softs[pick(random, std::uint32_t(softs.size()))];
  }
  static FluidId any_fluid(const World& world, Random& random) {
    std::vector<FluidId> fluids(world.fluids({}));
    world.fluids(fluids);
    return fluids.empty() ? FluidId{} : fluids[pick(random, std::uint32_t(fluids.size()))];
  }

  void command(World& world, Random& random) const {
    const SoftId soft = any_soft(world, random);
    if (soft && coin(random)) return command_soft(world, random, soft);
    const FluidId fluid = any_fluid(world, random);
    if (fluid && coin(random)) return command_fluid(world, random, fluid);
    command_body(world, random, any_body(world, random));
  }

  void command_soft(World& world, Random& random, SoftId soft) const {
    const int vertex = int(pick(random, std::uint32_t(world.soft_info(soft).vertices)));
    switch (pick(random, 8)) {
      case 0:
      case 1:
        hold(world, random, soft);
        break;
      case 2:
        world.release(soft, vertex);
        break;
      case 3:
        throw_vertices(world, random, soft, 4);
        break;
      case 4:
        limit_vertices(world, random, soft);
        break;
      case 5:
        world.remove_soft(soft);
        break;
      default:
        if (world.softs({}) < 5) add_something_soft(world, random);
        break;
    }
  }
  static void throw_vertices(World& world, Random& random, SoftId soft, float speed) {
    const std::size_t count = world.vertices(soft).size();
    std::vector<Vec3> velocities;
    for (std::size_t i = 0; i < count; ++i) velocities.push_back(random.next_vector(speed));
    world.set_vertices(soft, {}, velocities);
  }
  static void limit_vertices(World& world, Random& random, SoftId soft) {
    const SoftVertices vertices = world.vertices(soft);
    std::vector<DVec3> targets;
    std::vector<float> distances;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec3 away = random.next_vector(0.0625f);
      targets.push_back(vertices.position(i) + away);
      distances.push_back(random.next(-0.125f, 0.25f));
    }
    if (coin(random)) targets.clear(), distances.clear();
    world.set_vertex_limits(soft, targets, distances, {}, {});
  }

  void command_fluid(World& world, Random& random, FluidId fluid) const {
    switch (pick(random, 6)) {
      case 0:
        world.set_emitters(fluid, random_emitters(random));
        break;
      case 1:
        world.set_fluid_pose(fluid, random_box_pose(random));
        break;
      case 2: {
        const Vec3 linear = random.next_vector(0.5f), angular = random.next_vector(0.5f);
        world.set_fluid_velocity(fluid, linear, angular);
        break;
      }
      case 3:
        world.remove_fluid(fluid);
        break;
      default:
        if (world.fluids({}) < 3) add_fluid(world, random);
        break;
    }
  }

  void command_body(World& world, Random& random, BodyId body) const {
    const Vec3 direction = random.next_vector(1);
    switch (pick(random, 13)) {
      case 0:
        if (world.bodies().ids.size() > 3) world.remove_body(body);
        break;
      case 1:
        world.set_type(body, BodyType(pick(random, 3)));
        break;
      case 2:
        world.set_enabled(body, !world.enabled(body));
        break;
      case 3:
        world.set_pose(body, {place(random), random.next_rotation()});
        break;
      case 4:
        for (const ShapeId shape : world.shapes(body)) world.set_sensor(shape, coin(random));
        break;
      case 5:
        world.set_substeps(int(1 + pick(random, 5)));
        break;
      case 6:
        if (!weightless_) world.set_gravity({direction.x, -9.8125f, direction.z});
        break;
      case 7: {
        ExplosionDef blow;
        blow.center = place(random);
        blow.pressure = 50;
        world.explode(blow);
        break;
      }
      case 8:
        world.set_sleeping(pick(random, 4) != 0);
        break;
      case 9:
        world.set_awake(body, coin(random));
        break;
      case 10:
        world.set_velocity(body, 4.0f * direction, random.next_vector(8));
        break;
      default:
        add_something_rigid(world, random);
        break;
    }
  }

  // Numbers that no simulation survives: what stops being finite is frozen, the same everywhere.
  void wild_command(World& world, Random& random) const {
    const float huge[] = {1.0e5f, 1.0e15f, 3.0e38f};
    const float size = huge[pick(random, 3)];
    if (const SoftId soft = any_soft(world, random); soft && coin(random)) {
      throw_vertices(world, random, soft, size);
    } else {
      const BodyId body = any_body(world, random);
      world.set_velocity(body, random.next_vector(size), {1, 2, 3});
    }
  }

  bool weightless_ = false, wild_ = false;
  std::uint32_t busy_ = 0;  // 0: left alone, 3: commands in most steps
  DVec3 origin_;
};

}  // namespace gyre::scenes
