// Worlds that a number makes: ground, bodies, joints, and in every step a few commands of any kind. Made with the public
// interface alone, by arithmetic that IEEE 754 fixes, so that every build makes the same ones.
//
// What drive() does follows from the number, the step and what the world holds. So a copy of the RandomWorld goes on with a
// copy of the world: a loaded snapshot, a world that was rolled back, a replay.
//
// No call draws two of its arguments from the dice: compilers take arguments in any order.
#pragma once

#include "random_choices.h"

namespace gyre::scenes {

class RandomWorld : public RandomChoices {
 public:
  explicit RandomWorld(std::uint32_t number) : RandomChoices(number) {
    Random random = dice(0, 1);
    weightless_ = pick(random, 8) == 0;
    uneven_steps_ = pick(random, 3) == 0;
    wild_ = pick(random, 4) == 0;
    busy_ = pick(random, 4);
    const double far[] = {0, 0, 0, 640, 1.0e6};
    origin_ = {far[pick(random, 5)], far[pick(random, 3)], -far[pick(random, 5)]};
  }

  // Of the def, only what is part of the state: how the world is computed is the caller's.
  WorldDef def() const {
    Random random = dice(0, 2);
    WorldDef def;
    if (weightless_) def.gravity = {};
    def.sleeping = pick(random, 4) != 0;
    def.stepping.substeps = int(1 + pick(random, 6));
    def.friction_rule = CombineRule(pick(random, 5));
    def.restitution_rule = CombineRule(pick(random, 5));
    return def;
  }

  void build(World& world) {
    Random random = dice(0, 3);
    add_ground(world, random);
    const std::uint32_t count = 10 + pick(random, 30);
    const bool tidy = pick(random, 3) == 0;  // stacks that come to rest
    const std::uint32_t joined = pick(random, 3);
    BodyId previous;
    for (std::uint32_t i = 0; i < count; ++i) {
      BodyDef body;
      body.pose.position = origin_ + DVec3{1.125 * (i % 4), 0.5 + i / 12, 1.125 * (i / 4 % 3)};
      if (!tidy) body.pose.position = body.pose.position + random.next_vector(0.1875f);
      if (!tidy) body.pose.orientation = random.next_rotation();
      if (!tidy || pick(random, 8) == 0) set_motion(body, random);
      set_mass(body, random);
      const BodyId added = world.add_body(body, random_shapes(random, tidy));
      if (joined != 0 && previous && pick(random, 4) < joined) add_joint(world, random, previous, added);
      previous = added;
    }
    for (std::uint32_t i = 0; i < pick(random, 3); ++i) set_pair(world, random);
  }

  void drive(World& world, int step) {
    Random random = dice(step, 4);
    if (pick(random, 4) < busy_) command(world, random);
    if (busy_ > 1 && pick(random, 4) < busy_) command(world, random);
    if (wild_ && pick(random, 64) == 0) wild_command(world, random);
  }

  void step(World& world, int step) {
    drive(world, step);
    world.step(seconds(step));
  }

 private:
  void add_ground(World& world, Random& random) {
    const std::uint32_t kind = pick(random, 5);
    if (weightless_) return;
    if (kind == 0) add_fixed(world, {origin_.x, 0, 0}, Plane{{0.03125f, 1, 0}, float(origin_.y)});
    if (kind == 1 || kind == 4) add_fixed(world, origin_ + DVec3{2, -0.5, 1}, Box{{8, 0.5f, 8}});
    if (kind == 2) {
      std::vector<float> heights;
      for (int i = 0; i < 15 * 15; ++i) heights.push_back(random.next(-0.5f, 0.25f));
      if (const Result<Geometry> field = cook_height_field({heights, 15, 15, 1.0f}))
        add_fixed(world, origin_, *field);
    }
    if (kind == 3) add_bumpy_mesh(world, random);
    if (kind != 4) return;
    for (const double side : {-1.0, 1.0}) {
      add_fixed(world, origin_ + DVec3{2 + 3.25 * side, 1.5, 1}, Box{{0.25f, 1.5f, 4}});
      add_fixed(world, origin_ + DVec3{2, 1.5, 1 + 3.25 * side}, Box{{4, 1.5f, 0.25f}});
    }
  }

  void add_bumpy_mesh(World& world, Random& random) {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 81; ++i)
      vertices.push_back({1.25f * float(i % 9 - 3), random.next(-0.5f, 0.125f), 1.25f * float(i / 9 - 4)});
    for (std::uint32_t i = 0; i < 71; ++i) {
      if (i % 9 == 8) continue;
      for (const std::uint32_t corner : {i, i + 9, i + 1, i + 1, i + 9, i + 10}) indices.push_back(corner);
    }
    if (const Result<Geometry> mesh = cook_mesh({vertices, indices, coin(random)}))
      add_fixed(world, origin_, *mesh);
  }

  void set_motion(BodyDef& body, Random& random) {
    body.linear_velocity = random.next_vector(weightless_ ? 3.0f : 1.0f);
    body.angular_velocity = random.next_vector(4);
    if (pick(random, 10) != 0) return;
    body.linear_velocity = random.next_vector(150);  // goes through walls unless it is swept
    body.continuous = coin(random);
  }

  void set_mass(BodyDef& body, Random& random) {
    body.type = BodyType(pick(random, 16) == 0 ? pick(random, 2) : 2);
    if (pick(random, 12) == 0)
      body.linear_damping = random.next(0, 2), body.angular_damping = random.next(0, 2);
    if (pick(random, 12) == 0) body.gravity_scale = random.next(-0.5f, 1.5f);
    if (pick(random, 16) == 0) body.can_sleep = false;
    if (pick(random, 16) == 0) body.locked.angular[pick(random, 3)] = true;
    if (pick(random, 24) == 0) body.locked.linear[pick(random, 3)] = true;
    if (pick(random, 12) == 0) body.mass = random.next(0.25f, 900);
    if (pick(random, 16) == 0) body.center_of_mass = random.next_vector(0.25f);
    if (pick(random, 16) == 0) body.inertia = Sym3{20, 24, 30, 0.5f, -0.25f, 1};
  }

  Material random_material(Random& random) {
    Material material;
    material.static_friction = random.next(0, 1);
    material.dynamic_friction = 0.75f * material.static_friction;
    material.restitution = pick(random, 3) == 0 ? random.next(0, 1) : 0.0f;
    if (pick(random, 4) == 0) material.rolling_friction = random.next(0, 0.0625f);
    if (pick(random, 4) == 0) material.spinning_friction = random.next(0, 0.0625f);
    material.id = std::uint16_t(pick(random, 4));
    return material;
  }

  ShapeDef random_shape(Random& random, bool tidy) {
    ShapeDef shape;
    const int kind = int(pick(random, 7));
    shape.geometry = tidy ? AnyShape(Box{}) : convex(kind, random.next(0.1875f, 0.5625f));
    if (!tidy || pick(random, 4) == 0) shape.material = random_material(random);
    if (pick(random, 16) == 0) shape.density = random.next(10, 8000);
    if (pick(random, 24) == 0) shape.sensor = true;
    if (pick(random, 16) == 0) shape.filter = random_filter(random);
    return shape;
  }
  std::vector<ShapeDef> random_shapes(Random& random, bool tidy) {
    std::vector<ShapeDef> shapes(1 + (pick(random, 6) == 0 ? pick(random, 3) : 0));
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      shapes[i] = random_shape(random, tidy);
      if (i > 0) shapes[i].local = {random.next_vector(0.5f), random.next_rotation()};
    }
    return shapes;
  }
  Filter random_filter(Random& random) {
    return {1u << pick(random, 2), 1u + pick(random, 3), std::int32_t(pick(random, 4)) - 2};
  }

  void set_pair(World& world, Random& random) {
    world.set_material_pair({std::uint16_t(1 + pick(random, 3)), std::uint16_t(1 + pick(random, 3)),
                             random.next(0, 1), random.next(0, 0.5f), random.next(0, 1)});
  }

  Motor random_motor(Random& random) {
    Motor motor;
    motor.target_velocity = random.next(-3, 3);
    if (coin(random)) motor.target_position = random.next(-1, 1);
    motor.max_force = random.next(0, 400);
    motor.frequency = random.next(0, 4);
    return motor;
  }

  void add_joint(World& world, Random& random, BodyId a, BodyId b) {
    FlatJoint joint;
    joint.kind = JointKind(pick(random, 5));
    joint.a = pick(random, 5) == 0 ? BodyId{} : a;
    joint.b = b;
    joint.anchor = world.center_of_mass(b) + random.next_vector(0.75f);
    joint.axis = random.next_vector(1) + Vec3{0, 2, 0};
    joint.collide_connected = pick(random, 4) == 0;
    if (joint.kind == JointKind::hinge || joint.kind == JointKind::slider) {
      if (coin(random)) joint.limits = Limits{random.next(-1, 0), random.next(0, 1)};
      if (coin(random)) joint.motor = random_motor(random);
    }
    if (joint.kind == JointKind::distance) {
      if (coin(random)) joint.stiffness = random.next(50, 5000), joint.damping = random.next(0, 50);
      if (coin(random)) joint.max_length = random.next(1, 3);
    }
    if (pick(random, 3) == 0) joint.break_force = random.next(2000, 60000);
    if (const JointId added = scenes::add_flat_joint(world, joint)) joints_.push_back(added);
  }

  static BodyId any_body(const World& world, Random& random) {
    const std::size_t count = world.bodies().ids.size();
    return count == 0 ? BodyId{} : body_number(world, pick(random, std::uint32_t(count)));
  }
  static ShapeId any_shape(const World& world, Random& random) {
    const std::span<const ShapeId> shapes = world.shapes(any_body(world, random));
    return shapes.empty() ? ShapeId{} : shapes[pick(random, std::uint32_t(shapes.size()))];
  }
  // One of those that were ever added, as this world knows it; it may be gone.
  JointId any_joint(const World& world, Random& random) const {
    if (joints_.empty()) return {};
    JointId joint = joints_[pick(random, std::uint32_t(joints_.size()))];
    joint.world = any_body(world, random).world;
    return joint;
  }

  void command(World& world, Random& random) {
    const BodyId body = any_body(world, random);
    const ShapeId shape = any_shape(world, random);
    const Vec3 direction = random.next_vector(600);
    switch (pick(random, 26)) {
      case 0:
      case 1:
      case 2:
        throw_in(world, random);
        break;
      case 3:
      case 4:
        if (world.bodies().ids.size() > 6) world.remove_body(body);
        break;
      case 5:
        add_joint(world, random, any_body(world, random), body);
        break;
      case 6:
      case 7:
        world.remove_joint(any_joint(world, random));
        break;
      case 8: {
        ShapeDef added = random_shape(random, false);
        added.local.position = random.next_vector(0.5f);
        world.add_shape(body, added);
        break;
      }
      case 9:
        if (world.shapes(body).size() > 1) world.remove_shape(world.shapes(body)[0]);
        break;
      case 10:
        world.set_pose(body, {origin_ + DVec3{2, 3, 1} + random.next_vector(2), random.next_rotation()});
        break;
      case 11:
        world.set_type(body, BodyType(pick(random, 3)));
        world.set_velocity(body, random.next_vector(1), {0.5f, -1, 0.25f});
        break;
      case 12:  // what was nailed down comes loose again
        for (std::size_t i = 1; i < world.bodies().ids.size(); ++i) {
          if (coin(random) && !is_ground(world, body_number(world, i)))
            world.set_type(body_number(world, i), BodyType::dynamic);
        }
        break;
      case 13:
        world.set_awake(body, coin(random));
        break;
      case 14:
        world.set_filter(shape, random_filter(random));
        break;
      case 15:
        world.set_material(shape, random_material(random));
        break;
      case 16:
        set_pair(world, random);
        break;
      default:
        push_something(world, random, body, direction);
        break;
    }
  }

  void push_something(World& world, Random& random, BodyId body, Vec3 direction) {
    const DVec3 point = world.center_of_mass(body) + random.next_vector(0.25f);
    const JointId joint = any_joint(world, random);
    const float speed = coin(random) ? 0.0078125f : 0.25f;  // m/s for each N s
    switch (pick(random, 10)) {
      case 0:
        world.add_force_at(body, 20 * direction, point);
        break;
      case 1:
        world.add_torque(body, direction);
        break;
      case 2:
        world.add_impulse_at(body, direction, point);
        break;
      case 3:
        world.add_angular_impulse(body, 0.25f * direction);
        break;
      case 4:
        world.set_velocity(body, speed * direction, random.next_vector(4));
        break;
      case 5: {
        const Pose pose{point, random.next_rotation()};
        world.move_kinematic(body, pose, 8 * kStepSeconds);
        break;
      }
      case 6:
        world.set_motor(joint, random_motor(random));
        break;
      case 7:
        world.set_damping(body, random.next(0, 1), 0.5f);
        world.set_gravity_scale(body, random.next(0.25f, 1.25f));
        break;
      case 8:
        world.set_sleeping(pick(random, 4) != 0);
        break;
      default:
        if (!weightless_) world.set_gravity({random.next(-1, 1), -9.8125f, random.next(-1, 1)});
        world.set_substeps(int(1 + pick(random, 6)));
        break;
    }
  }

  // A new body from above, often fast, sometimes right into others.
  void throw_in(World& world, Random& random) {
    if (world.bodies().ids.size() > 60) return;
    BodyDef body;
    body.pose.position = origin_ + DVec3{2, 2.5, 1} + random.next_vector(2);
    body.pose.orientation = random.next_rotation();
    set_motion(body, random);
    set_mass(body, random);
    const BodyId other = any_body(world, random);
    const BodyId added = world.add_body(body, random_shapes(random, false));
    if (added && pick(random, 4) == 0) add_joint(world, random, other, added);
  }

  // Numbers that no simulation survives: what stops being finite is frozen, the same everywhere.
  void wild_command(World& world, Random& random) {
    const BodyId body = any_body(world, random);
    const float huge[] = {1.0e15f, 1.0e25f, 3.0e38f};
    const float size = huge[pick(random, 3)];
    const Vec3 much = random.next_vector(size);
    if (coin(random)) {
      world.set_velocity(body, much, random.next_vector(coin(random) ? size : 1.0f));
    } else {
      world.add_force_at(body, much, world.center_of_mass(body) + Vec3{0.25f, 0, 0});
    }
  }

  // Meshes, height fields and planes cannot move.
  static bool is_ground(const World& world, BodyId body) {
    for (const ShapeId shape : world.shapes(body)) {
      const AnyShape* const geometry = world.geometry(shape);
      if (std::holds_alternative<Plane>(*geometry)) return true;
      const Geometry* const cooked = std::get_if<Geometry>(geometry);
      if (cooked != nullptr && cooked->kind() != ShapeKind::hull) return true;
    }
    return false;
  }

  bool weightless_ = false, wild_ = false;
  std::uint32_t busy_ = 0;  // 0: left alone, 3: commands in most steps
  DVec3 origin_;
  std::vector<JointId> joints_;
};

}  // namespace gyre::scenes
