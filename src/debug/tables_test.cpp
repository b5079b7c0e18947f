// Tests of the tables of bodies, contacts, boxes and joints: counts and values against other readings of the world,
// and against slow and plain versions.
#include "laws/kit.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

#include <map>
#include <set>

namespace gyre::laws::tables_test {
namespace {

DVec3 place(const std::vector<float>& from, std::size_t i, DVec3 origin = {}) {
  return origin + DVec3{double(from[3 * i]), double(from[3 * i + 1]), double(from[3 * i + 2])};
}
Vec3 vector(const std::vector<float>& from, std::size_t i) {
  return {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
}
Quat turn(const std::vector<float>& from, std::size_t i) {
  return {from[4 * i], from[4 * i + 1], from[4 * i + 2], from[4 * i + 3]};
}

// Boxes on a ground, some in stacks, one pair joined, one in flight.
struct Yard {
  World world = make_world();
  std::vector<BodyId> boxes;
  JointId joint;
};
Yard make_yard(DVec3 at = {}) {
  Yard yard;
  yard.world.add_body({.type = BodyType::fixed, .pose = {.position = at + DVec3{0, -1, 0}}},
                      {.geometry = Box{{50, 1, 50}}});
  for (int stack = 0; stack < 4; ++stack) {
    for (int i = 0; i <= stack; ++i) {
      yard.boxes.push_back(yard.world.add_body({.pose = {.position = at + DVec3{4.0 * stack, 0.5 + i, 0}}},
                                               {.geometry = Box{{0.5f, 0.5f, 0.4f}}}));
    }
  }
  yard.boxes.push_back(
      yard.world.add_body({.pose = {.position = at + DVec3{0, 30, 0}}}, {.geometry = Sphere{}}));
  yard.joint = yard.world.add_joint(DistanceDef{.a = yard.boxes[0],
                                                .b = yard.boxes[1],
                                                .anchor = at + DVec3{0, 0.5, 0},
                                                .anchor_b = at + DVec3{4, 0.5, 0}});
  return yard;
}

TEST(BodyTable, TellsWhatTheWorldTells) {
  const DVec3 at{1e6, 0, -2e6};
  Yard yard = make_yard(at);
  run(yard.world, 0.3);
  BodyTable table;
  read_bodies(yard.world, at, table);
  const BodyColumns bodies = yard.world.bodies();
  ASSERT_EQ(table.size(), bodies.ids.size());
  ASSERT_EQ(table.axes.size(), 4 * table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(table.ids[i], bodies.ids[i]);
    EXPECT_EQ(vector(table.linear_velocities, i), bodies.linear_velocities[i]);
    EXPECT_EQ(vector(table.angular_velocities, i), bodies.angular_velocities[i]);
    EXPECT_LT(length(place(table.centers, i, at) - yard.world.center_of_mass(table.ids[i])), 3e-6);
    const bool fixed = yard.world.type(table.ids[i]) == BodyType::fixed;
    EXPECT_EQ(table.states[i] == RestState::fixed, fixed);
    EXPECT_EQ(table.islands[i] == kNoIsland, fixed);
  }
}

// The ellipsoid of the semi-axes, turned by the axes, has the mass properties of the body.
TEST(BodyTable, SemiAxesGiveTheInertiaBack) {
  World world = weightless();
  const Quat q = from_axis_angle({0.3f, 1, -0.4f}, 0.9f);
  const BodyId body = world.add_body({.pose = {.orientation = q}}, {.geometry = Box{{0.2f, 0.5f, 0.9f}}});
  BodyTable table;
  read_bodies(world, {}, table);
  const MassProperties mass = world.mass_properties(body);
  const Vec3 sides = vector(table.semi_axes, 0);
  const float volume = 4.0f / 3.0f * kPi * sides.x * sides.y * sides.z;
  MassProperties same = ellipsoid_mass(sides, mass.mass / volume);
  same = transformed(same, {{}, turn(table.axes, 0)});
  const MassProperties turned = transformed(mass, {{}, q});
  EXPECT_NEAR(same.mass, mass.mass, 1e-3f * mass.mass);
  const float scale = mass.inertia.xx + mass.inertia.yy + mass.inertia.zz;
  EXPECT_NEAR(same.inertia.xx, turned.inertia.xx, 2e-6f * scale);
  EXPECT_NEAR(same.inertia.yy, turned.inertia.yy, 2e-6f * scale);
  EXPECT_NEAR(same.inertia.zz, turned.inertia.zz, 2e-6f * scale);
  EXPECT_NEAR(same.inertia.xy, turned.inertia.xy, 2e-6f * scale);
  EXPECT_NEAR(same.inertia.xz, turned.inertia.xz, 2e-6f * scale);
  EXPECT_NEAR(same.inertia.yz, turned.inertia.yz, 2e-6f * scale);
}

TEST(BodyTable, ABallsEllipsoidIsTheBall) {
  World world = weightless();
  world.add_body({}, {.geometry = Sphere{0.7f}});
  BodyTable table;
  read_bodies(world, {}, table);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(table.semi_axes[std::size_t(axis)], 0.7f, 1e-6f);
}

// Islands from contact points between dynamic bodies, and joints, alone.
std::map<std::uint32_t, std::set<std::uint32_t>> islands_by_flooding(const World& world) {
  std::map<std::uint32_t, std::set<std::uint32_t>> linked;
  for (const BodyId id : world.bodies().ids) {
    if (world.type(id) == BodyType::dynamic) linked[id.index];
  }
  std::vector<ContactPoint> points(world.contacts({}));
  world.contacts(points);
  for (const ContactPoint& p : points) {
    if (linked.count(p.body_a.index) == 0 || linked.count(p.body_b.index) == 0) continue;
    linked[p.body_a.index].insert(p.body_b.index);
    linked[p.body_b.index].insert(p.body_a.index);
  }
  JointTable joints;
  read_joints(world, {}, joints);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::uint32_t a = joints.bodies[2 * i].index, b = joints.bodies[2 * i + 1].index;
    if (linked.count(a) == 0 || linked.count(b) == 0) continue;
    linked[a].insert(b);
    linked[b].insert(a);
  }
  std::map<std::uint32_t, std::set<std::uint32_t>> island_of;
  for (const auto& [body, neighbours] : linked) {
    std::set<std::uint32_t> island{body};
    std::vector<std::uint32_t> open{body};
    while (!open.empty()) {
      const std::uint32_t at = open.back();
      open.pop_back();
      for (const std::uint32_t next : linked[at]) {
        if (island.insert(next).second) open.push_back(next);
      }
    }
    island_of[body] = island;
  }
  return island_of;
}

TEST(BodyTable, IslandsAreThoseOfContactsAndJoints) {
  Yard yard = make_yard();
  for (int step = 0; step < 90; ++step) {
    yard.world.step(kStep);
    BodyTable table;
    read_bodies(yard.world, {}, table);
    auto expected = islands_by_flooding(yard.world);
    std::set<std::uint32_t> roots;
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table.islands[i] == kNoIsland) {
        EXPECT_EQ(table.island_sizes[i], 0u);
        continue;
      }
      roots.insert(table.islands[i]);
      const std::set<std::uint32_t>& island = expected[table.ids[i].index];
      EXPECT_EQ(table.islands[i], *island.begin()) << "body " << table.ids[i].index << " in step " << step;
      EXPECT_EQ(table.island_sizes[i], island.size());
    }
    EXPECT_EQ(table.island_count, roots.size());
  }
  BodyTable table;
  read_bodies(yard.world, {}, table);
  // The joined pair, two stacks, and the ball in flight.
  EXPECT_EQ(table.island_count, 4u);
}

TEST(ContactTable, TellsWhatTheWorldTells) {
  const DVec3 at{-3e5, 0, 7e5};
  Yard yard = make_yard(at);
  run(yard.world, 0.4);
  std::vector<ContactPoint> points(yard.world.contacts({}));
  yard.world.contacts(points);
  ContactTable table;
  read_contacts(yard.world, at, table);
  ASSERT_EQ(table.size(), points.size());
  ASSERT_GT(points.size(), 20u);
  double load = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(table.bodies[2 * i], points[i].body_a.index);
    EXPECT_EQ(table.bodies[2 * i + 1], points[i].body_b.index);
    EXPECT_EQ(table.shapes[2 * i + 1], points[i].shape_b.index);
    EXPECT_LT(length(place(table.positions, i, at) - points[i].position), 1e-6);
    EXPECT_EQ(vector(table.normals, i), points[i].normal);
    EXPECT_EQ(vector(table.tangents, 2 * i), points[i].tangent_1);
    EXPECT_EQ(vector(table.tangents, 2 * i + 1), points[i].tangent_2);
    EXPECT_EQ(table.separations[i], points[i].separation);
    EXPECT_NEAR(table.forces[i] * kStep, points[i].normal_impulse, 1e-6f + 1e-5f * points[i].normal_impulse);
    EXPECT_EQ(table.states[i] == ContactState::idle, points[i].normal_impulse <= 0.0f);
    EXPECT_NE(table.colors[i], kNoColor);
    if (table.bodies[2 * i] == 0) load += double(table.forces[i]);
  }
  // Ten boxes of 0.8 m^3 of 1000 kg/m^3 rest on the ground.
  EXPECT_NEAR(load, 10 * 800 * kGravity, 0.01 * 10 * 800 * kGravity);
}

TEST(ContactTable, GroupsOfTheSolverShareNoMovingBody) {
  Yard yard = make_yard();
  run(yard.world, 0.2);
  ContactTable table;
  read_contacts(yard.world, {}, table);
  std::map<std::pair<int, std::uint32_t>, std::pair<std::uint32_t, std::uint32_t>> owner;
  std::set<int> colors;
  for (std::size_t i = 0; i < table.size(); ++i) {
    colors.insert(table.colors[i]);
    const std::pair<std::uint32_t, std::uint32_t> pair{table.shapes[2 * i], table.shapes[2 * i + 1]};
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t body = table.bodies[2 * i + side];
      if (body == 0) continue;  // the ground
      const auto found = owner.emplace(std::pair{int(table.colors[i]), body}, pair).first;
      EXPECT_EQ(found->second, pair) << "two contacts of body " << body << " in one group";
    }
  }
  EXPECT_EQ(int(colors.size()), yard.world.stats().colors);
}

TEST(ContactTable, WhatSlidesIsToldFromWhatHolds) {
  World world = make_world();
  add_ground(world);
  const BodyId still = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  const BodyId sliding =
      world.add_body({.pose = {.position = {0, 0.5, 5}}, .linear_velocity = {8, 0, 0}}, {.geometry = Box{}});
  run(world, 0.25);
  ContactTable table;
  read_contacts(world, {}, table);
  int seen = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!(table.forces[i] > 0.0f)) continue;
    ++seen;
    const std::uint32_t body = table.bodies[2 * i + 1];
    EXPECT_EQ(table.states[i], body == sliding.index ? ContactState::sliding : ContactState::pressing)
        << body;
    EXPECT_TRUE(body == sliding.index || body == still.index);
  }
  EXPECT_GE(seen, 4);
}

bool holds(const BoxTable& boxes, std::size_t box, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < boxes.corners[6 * box + std::size_t(axis)] ||
        p[axis] > boxes.corners[6 * box + 3 + std::size_t(axis)])
      return false;
  }
  return true;
}

// Every kind of shape, tumbling: its tight box contains the wireframe, the fat box the tight box, the trees the fat
// box.
TEST(BoxTable, BoundsHoldTheShapesAndNodesHoldTheBounds) {
  World world = make_world({.gravity = {0, -1, 0}, .sleeping = false});
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0.2f}, {0.1f, 1, 0}, {0, 0.3f, 1}, {0.8f, 0.9f, 0.7f}};
  const std::vector<float> heights(25, 0.3f);
  const Result<Geometry> hull = cook_hull(corners);
  const std::uint32_t indices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  const Result<Geometry> mesh = cook_mesh({corners, indices});
  const Result<Geometry> field =
      cook_height_field({.heights = heights, .columns = 5, .rows = 5, .spacing = 0.7f});
  ASSERT_TRUE(hull && mesh && field);
  const AnyShape moving[] = {Sphere{0.4f},        Box{{0.2f, 0.5f, 0.7f}, 0.1f},
                             Capsule{0.2f, 0.6f}, Cylinder{0.5f, 0.2f},
                             Cone{0.4f, 0.5f},    *hull};
  int i = 0;
  for (int copy = 0; copy < 5; ++copy) {
    for (const AnyShape& shape : moving) {
      world.add_body({.pose = {.position = {3.0 * (i % 6) - 7e4, 3.0 * copy, 2.0 * (i % 5)},
                               .orientation = from_axis_angle({1, float(i), 2}, float(i))},
                      .angular_velocity = {1, 2, float(i % 3)}},
                     {.geometry = shape, .local = {{0.3f, 0, 0}, from_axis_angle({0, 1, 1}, 0.4f)}});
      ++i;
    }
  }
  for (const AnyShape& shape : {AnyShape(*mesh), AnyShape(*field), AnyShape(Plane{})}) {
    world.add_body({.type = BodyType::fixed, .pose = {.position = {3.0 * i++ - 7e4, -20, 0}}},
                   {.geometry = shape});
  }
  const DVec3 origin{-7e4, 1, 2};
  BoxTable boxes;
  for (int step = 0; step < 20; ++step) world.step(kStep);
  // The trees get changed boxes at the beginning of the next step.
  const Array<std::uint32_t>& changed = state_of(world).rigid.shapes.changed;
  read_boxes(world, kAllBoxes, origin, boxes);
  ASSERT_EQ(boxes.corners.size(), 6 * boxes.size());
  int tight = 0, fat = 0, roots = 0;
  std::map<std::uint32_t, std::size_t> tight_of, fat_of;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (boxes.kinds[b] == BoxKind::tight) tight_of[boxes.shapes[b]] = b, ++tight;
    if (boxes.kinds[b] == BoxKind::fat) fat_of[boxes.shapes[b]] = b, ++fat;
    if (boxes.shapes[b] == kNoShape && boxes.depths[b] == 0) ++roots;
  }
  // All but the plane.
  EXPECT_EQ(tight, world.stats().shapes - 1);
  EXPECT_EQ(fat, world.stats().shapes - 1);
  EXPECT_EQ(roots, 2);
  for (const BodyId body : world.bodies().ids) {
    for (const ShapeId id : world.shapes(body)) {
      if (std::holds_alternative<Plane>(*world.geometry(id))) continue;
      std::vector<float> lines;
      add_wireframe(*world.geometry(id), lines, 17);
      ASSERT_FALSE(lines.empty());
      const Pose seen = world.pose(body) * world.local_transform(id);
      const Transform from_origin{difference(seen.position, origin), seen.orientation};
      for (std::size_t v = 0; v < lines.size() / 3; ++v) {
        EXPECT_TRUE(holds(boxes, tight_of[id.index], from_origin * vector(lines, v))) << "shape " << id.index;
      }
      const float* const inner = &boxes.corners[6 * tight_of[id.index]];
      EXPECT_TRUE(holds(boxes, fat_of[id.index], {inner[0], inner[1], inner[2]}));
      EXPECT_TRUE(holds(boxes, fat_of[id.index], {inner[3], inner[4], inner[5]}));
      bool waits = false;
      for (const std::uint32_t shape : changed) waits = waits || shape == id.index;
      if (waits) continue;
      const BoxKind tree = world.type(body) == BodyType::fixed ? BoxKind::fixed_tree : BoxKind::moving_tree;
      const float* const outer = &boxes.corners[6 * fat_of[id.index]];
      int deepest = -1, holders = 0;
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        if (boxes.kinds[b] != tree || !holds(boxes, b, {outer[0], outer[1], outer[2]}) ||
            !holds(boxes, b, {outer[3], outer[4], outer[5]})) {
          continue;
        }
        ++holders;
        deepest = std::max(deepest, int(boxes.depths[b]));
      }
      EXPECT_GE(holders, deepest + 1) << "one node at least on every level";
      EXPECT_GE(deepest, tree == BoxKind::moving_tree ? 1 : 0);
    }
  }
}

TEST(BoxTable, OnlyWhatWasAskedFor) {
  Yard yard = make_yard();
  run(yard.world, 0.1);
  BoxTable boxes;
  read_boxes(yard.world, box_bit(BoxKind::fat), {}, boxes);
  EXPECT_EQ(int(boxes.size()), yard.world.stats().shapes);
  for (const BoxKind kind : boxes.kinds) EXPECT_EQ(kind, BoxKind::fat);
  Result<World> brute = World::create({.stepping = {.broad_phase = BroadPhaseKind::brute_force}});
  brute->add_body({}, {.geometry = Box{}});
  brute->step(kStep);
  read_boxes(*brute, box_bit(BoxKind::moving_tree) | box_bit(BoxKind::fixed_tree), {}, boxes);
  EXPECT_EQ(boxes.size(), 0u) << "no trees, no nodes";
}

TEST(JointTable, TellsFramesLimitsAndLoads) {
  World world = make_world();
  const BodyId lamp =
      world.add_body({.pose = {.position = {2, 3, 0}}}, {.geometry = Box{{0.1f, 0.1f, 0.1f}}});
  const JointId rope = world.add_joint(
      DistanceDef{.b = lamp, .anchor = {2, 5, 0}, .anchor_b = DVec3{2, 3.1, 0}, .max_length = 2.0f});
  const BodyId door =
      world.add_body({.pose = {.position = {0.5, 0, 7}}}, {.geometry = Box{{0.5f, 1, 0.02f}}});
  const JointId hinge = world.add_joint(
      HingeDef{.b = door, .anchor = {0, 0, 7}, .axis = {0, 1, 0}, .limits = Limits{-1.0f, 0.5f}});
  run(world, 3.0);
  JointTable table;
  const DVec3 origin{1, 2, 3};
  read_joints(world, origin, table);
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table.ids[0], rope);
  EXPECT_EQ(table.ids[1], hinge);
  EXPECT_EQ(table.bodies[0], BodyId{});
  EXPECT_EQ(table.bodies[1], lamp);
  EXPECT_EQ(table.kinds[1], JointKind::hinge);
  EXPECT_LT(length(place(table.anchors, 0, origin) - DVec3{2, 5, 0}), 1e-6);
  const double length_now = length(place(table.anchors, 1, origin) - place(table.anchors, 0, origin));
  EXPECT_NEAR(length_now, 2.0, 1e-3);
  EXPECT_NEAR(table.positions[0], length_now, 1e-4);
  ASSERT_EQ(table.motors.size(), 2 * table.size());
  EXPECT_EQ(table.has_limits[0], 1);
  EXPECT_EQ(table.limits[1], 2.0f);
  // The rope bears the lamp: 8 kg.
  EXPECT_NEAR(table.forces[1], 8 * kGravity, 0.01 * 8 * kGravity);
  EXPECT_EQ(table.has_limits[1], 1);
  EXPECT_EQ(table.limits[2], -1.0f);
  EXPECT_EQ(table.limits[3], 0.5f);
  // The axis is the frame's x, on both sides.
  for (std::size_t side = 2; side < 4; ++side) {
    const Vec3 axis = rotate(turn(table.frames, side), {1, 0, 0});
    EXPECT_NEAR(axis.y, 1.0f, 1e-5f);
  }
  // The hinge carries the door: 80 kg.
  EXPECT_NEAR(table.forces[4], 80 * kGravity, 0.01 * 80 * kGravity);
  EXPECT_EQ(table.motors[3], 0.0f) << "nothing drives it";
  world.set_motor(hinge, {.target_velocity = 0.5f, .max_force = 3.0f});
  read_joints(world, origin, table);
  EXPECT_EQ(table.motors[2], 0.5f);
  EXPECT_EQ(table.motors[3], 3.0f);
  world.set_motor(hinge, {.target_position = 0.25f, .max_force = 3.0f});
  read_joints(world, origin, table);
  EXPECT_EQ(table.motors[2], 0.25f - table.positions[1]) << "the way that is left";
}

TEST(Tables, OfAnEmptyWorldAreEmpty) {
  const World world = make_world();
  BodyTable bodies;
  ContactTable contacts;
  BoxTable boxes;
  JointTable joints;
  DebugDraw drawing;
  read_bodies(world, {}, bodies);
  read_contacts(world, {}, contacts);
  read_boxes(world, kAllBoxes, {}, boxes);
  read_joints(world, {}, joints);
  draw_debug(world, {}, drawing);
  EXPECT_EQ(bodies.size() + contacts.size() + boxes.size() + joints.size(), 0u);
  EXPECT_EQ(drawing.line_count() + drawing.point_count(), 0u);
}

}  // namespace
}  // namespace gyre::laws::tables_test
