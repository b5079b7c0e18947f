// Tests of draw_debug: layers as runs of the arrays, counts that follow from the tables, positions relative to the
// origin. Drawing changes no world.
#include "laws/kit.h"

#include <gyre/debug.h>

namespace gyre::laws::draw_test {
namespace {

struct Scene {
  World world = make_world();
  int boxes = 0;
};
Scene make_scene(DVec3 at = {}) {
  Scene scene;
  World& world = scene.world;
  world.add_body({.type = BodyType::fixed, .pose = {.position = at + DVec3{0, -1, 0}}},
                 {.geometry = Box{{30, 1, 30}}});
  BodyId last;
  for (int i = 0; i < 12; ++i) {
    const BodyId body = world.add_body({.pose = {.position = at + DVec3{1.5 * (i % 4), 0.5 + i / 4, 0}}},
                                       {.geometry = Box{}});
    if (i == 8) {
      world.add_joint(
          HingeDef{.b = body, .anchor = at + DVec3{0, 3.2, 0}, .axis = {0, 0, 1}, .limits = Limits{-1, 1}});
    }
    last = body;
  }
  world.add_joint(SliderDef{.b = last, .anchor = at, .axis = {0, 1, 0}, .limits = Limits{-1, 1}});
  scene.boxes = 13;
  const SoftId sheet = world.add_cloth(
      {.grid = ClothGrid{.size = {0.3f, 0.2f}, .cells = {3, 2}}, .pose = {at + DVec3{-9, 0.01, 0}, {}}});
  world.pin(sheet, 0);
  world.add_rope({.points = {at + DVec3{-12, 0.03, 0}, at + DVec3{-11, 0.03, 0}}, .segments = 4});
  run(world, 0.2);
  return scene;
}

DebugDraw draw(const World& world, DrawOptions options) {
  DebugDraw out;
  draw_debug(world, options, out);
  return out;
}
DebugDraw::Range layer(const DebugDraw& drawing, DrawLayer which) { return drawing.layers[int(which)]; }

TEST(Draw, LayersAreRunsOfTheArrays) {
  const Scene scene = make_scene();
  const DebugDraw all = draw(scene.world, {});
  EXPECT_EQ(all.line_colors.size(), 8 * all.line_count());
  EXPECT_EQ(all.point_colors.size(), 4 * all.point_count());
  std::size_t lines = 0, points = 0;
  for (int i = 0; i < kDrawLayerCount; ++i) {
    const DrawLayer which = DrawLayer(i);
    const DebugDraw::Range range = layer(all, which);
    EXPECT_EQ(range.first_line, lines) << to_string(which);
    EXPECT_EQ(range.first_point, points) << to_string(which);
    EXPECT_GT(range.lines + range.points, 0u) << to_string(which) << " shows nothing of this scene";
    lines += range.lines;
    points += range.points;
    // Alone it is the same.
    const DebugDraw alone = draw(scene.world, {.layers = draw_bit(which)});
    ASSERT_EQ(alone.line_count(), range.lines) << to_string(which);
    for (std::size_t k = 0; k < alone.line_positions.size(); ++k)
      ASSERT_EQ(alone.line_positions[k], all.line_positions[6 * range.first_line + k]);
    for (std::size_t k = 0; k < alone.point_colors.size(); ++k)
      ASSERT_EQ(alone.point_colors[k], all.point_colors[4 * range.first_point + k]);
  }
  EXPECT_EQ(lines, all.line_count());
  EXPECT_EQ(points, all.point_count());
  EXPECT_FALSE(all.cut);
}

TEST(Draw, CountsFollowFromTheTables) {
  const Scene scene = make_scene();
  const DebugDraw all = draw(scene.world, {});
  ContactTable contacts;
  BodyTable bodies;
  BoxTable nodes;
  read_contacts(scene.world, {}, contacts);
  read_bodies(scene.world, {}, bodies);
  read_boxes(scene.world, box_bit(BoxKind::fixed_tree) | box_bit(BoxKind::moving_tree), {}, nodes);
  EXPECT_EQ(layer(all, DrawLayer::geometry).lines, 12u * unsigned(scene.boxes));
  EXPECT_EQ(layer(all, DrawLayer::tight_bounds).lines, 12u * unsigned(scene.boxes));
  EXPECT_EQ(layer(all, DrawLayer::broad_phase).lines, 12u * nodes.size());
  EXPECT_EQ(layer(all, DrawLayer::contact_points).points, contacts.size());
  EXPECT_EQ(layer(all, DrawLayer::contact_normals).lines, contacts.size());
  EXPECT_EQ(layer(all, DrawLayer::friction_basis).lines, 2 * contacts.size());
  EXPECT_EQ(layer(all, DrawLayer::mass_centers).points, bodies.size() - 1) << "all but the ground";
  EXPECT_EQ(layer(all, DrawLayer::joints).points, 4u) << "two joints with two anchors";
}

// A far scene drawn from nearby equals the same scene at the origin, up to the last digits of a float.
TEST(Draw, PlacesAreRelativeToTheOrigin) {
  const DVec3 far{4e6, 0, -8e6};
  const Scene home = make_scene(), away = make_scene(far);
  const std::uint32_t layers =
      kAllDrawLayers & ~draw_bit(DrawLayer::fat_bounds) & ~draw_bit(DrawLayer::broad_phase);
  const DebugDraw here = draw(home.world, {.layers = layers});
  const DebugDraw there = draw(away.world, {.layers = layers, .origin = far});
  ASSERT_EQ(here.line_count(), there.line_count());
  for (std::size_t i = 0; i < here.line_positions.size(); ++i) {
    ASSERT_NEAR(here.line_positions[i], there.line_positions[i], 2e-4f) << i;
  }
}

TEST(Draw, SoftMatterShowsEachEdgeOnceAndItsContacts) {
  const Scene scene = make_scene();
  const DebugDraw all = draw(scene.world, {});
  const DebugDraw::Range edges = layer(all, DrawLayer::soft_edges);
  // A grid of 3 by 2 cells with a diagonal each, and a rope of 4 segments.
  EXPECT_EQ(edges.lines, 3u * 3 + 2u * 4 + 6 + 4);
  EXPECT_EQ(edges.points, 1u) << "the pinned vertex";
  int contacts = 0;
  std::vector<SoftId> ids(scene.world.softs({}));
  scene.world.softs(ids);
  for (const SoftId id : ids) contacts += scene.world.soft_info(id).contacts;
  EXPECT_GT(contacts, 5);
  const DebugDraw::Range touching = layer(all, DrawLayer::soft_contacts);
  EXPECT_EQ(touching.points, unsigned(contacts));
  ASSERT_EQ(touching.lines, unsigned(contacts));
  for (std::uint32_t i = touching.first_line; i < touching.first_line + touching.lines; ++i)
    EXPECT_GT(all.line_positions[6 * i + 4], all.line_positions[6 * i + 1]) << "out of the ground";
}

TEST(Draw, StopsAtTheMostLines) {
  const Scene scene = make_scene();
  const DebugDraw some = draw(scene.world, {.max_lines = 100});
  EXPECT_EQ(some.line_count(), 100u);
  EXPECT_TRUE(some.cut);
}

TEST(Draw, ForcesAreAsLongAsAsked) {
  World world = make_world();
  add_ground(world);
  world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 1.0);
  const DebugDraw drawing =
      draw(world, {.layers = draw_bit(DrawLayer::contact_forces), .meters_per_newton = 1e-4f});
  double sum = 0.0;
  for (std::size_t i = 0; i < drawing.line_count(); ++i)
    sum += double(drawing.line_positions[6 * i + 4]) - double(drawing.line_positions[6 * i + 1]);
  EXPECT_NEAR(sum, 1e-4 * 1000 * kGravity, 1e-3 * kGravity) << "four normal forces carry the box";
}

TEST(Draw, ColoursTellRestAndIslands) {
  World world = make_world();
  add_ground(world);
  const BodyId a = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  const BodyId b = world.add_body({.pose = {.position = {0, 1.5, 0}}}, {.geometry = Box{}});
  const BodyId far = world.add_body({.pose = {.position = {30, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 0.1);
  const auto color = [&](ColorBy by, BodyId body) {
    const DebugDraw drawing = draw(world, {.layers = draw_bit(DrawLayer::mass_centers), .color_by = by});
    std::uint32_t packed = 0;
    for (std::size_t i = 0; i < 4; ++i) packed = packed << 8 | drawing.point_colors[4 * (body.index - 1) + i];
    return packed;
  };
  EXPECT_EQ(color(ColorBy::island, a), color(ColorBy::island, b));
  EXPECT_NE(color(ColorBy::island, a), color(ColorBy::island, far));
  const std::uint32_t awake = color(ColorBy::rest_state, a);
  run(world, 3.0);
  ASSERT_FALSE(world.is_awake(a));
  EXPECT_NE(color(ColorBy::rest_state, a), awake);
}

// Reading a world any number of times changes no bit of it.
TEST(Draw, LookingChangesNothing) {
  Scene watched = make_scene(), alone = make_scene();
  set_timing(watched.world, true);
  DebugDraw drawing;
  BodyTable bodies;
  ContactTable contacts;
  BoxTable boxes;
  JointTable joints;
  StepTimes times;
  for (int step = 0; step < 120; ++step) {
    watched.world.step(kStep);
    alone.world.step(kStep);
    draw_debug(watched.world, {.color_by = ColorBy(step % 3)}, drawing);
    read_bodies(watched.world, {1, 2, 3}, bodies);
    read_contacts(watched.world, {}, contacts);
    read_boxes(watched.world, kAllBoxes, {}, boxes);
    read_joints(watched.world, {}, joints);
    read_times(watched.world, times);
    for (const BodyId id : bodies.ids) {
      const Explanation e = explain(watched.world, id);
      ASSERT_NE(e.words[0], 0);
    }
    EXPECT_EQ(validate(watched.world).code, ErrorCode::none) << validate(watched.world).message;
    if (step == 60) set_timing(watched.world, false);
    ASSERT_EQ(watched.world.hash(), alone.world.hash()) << "in step " << step;
  }
}

// Edges are drawn once, and all of them.
TEST(Wireframe, DrawsEachEdgeOnce) {
  const auto lines_of = [](const AnyShape& shape) {
    std::vector<float> lines;
    add_wireframe(shape, lines, 16);
    return lines.size() / 6;
  };
  EXPECT_EQ(lines_of(Box{}), 12u);
  EXPECT_EQ(lines_of(Box{{1, 1, 1}, 0.2f}), 24u + 24u * 4u);
  EXPECT_EQ(lines_of(Sphere{}), 48u);
  EXPECT_EQ(lines_of(Cylinder{}), 36u);
  EXPECT_EQ(lines_of(Cone{}), 20u);
  EXPECT_EQ(lines_of(Capsule{}), 2u * 16u + 4u * 8u + 4u);
  EXPECT_EQ(lines_of(Geometry{}), 0u);
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                          {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const Result<Geometry> hull = cook_hull(corners);
  ASSERT_TRUE(hull);
  EXPECT_EQ(lines_of(*hull), 12u);
  // Two triangles with a common edge, and one apart: five edges and three.
  const Vec3 points[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0.3f, 1}, {5, 0, 0}, {5, 0, 1}, {6, 0, 0}};
  const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3, 4, 5, 6};
  const Result<Geometry> mesh = cook_mesh({points, indices});
  ASSERT_TRUE(mesh);
  EXPECT_EQ(lines_of(*mesh), 8u);
  // Three by three samples: two by two cells. Whole: 6 + 6 sides and 4 diagonals.
  std::vector<float> heights(9, 1.0f);
  Result<Geometry> field = cook_height_field({.heights = heights, .columns = 3, .rows = 3});
  ASSERT_TRUE(field);
  EXPECT_EQ(lines_of(*field), 16u);
  // A corner sample missing: its cell is a hole, and two of its sides belong to no other.
  heights[0] = std::nanf("");
  field = cook_height_field({.heights = heights, .columns = 3, .rows = 3});
  ASSERT_TRUE(field);
  EXPECT_EQ(lines_of(*field), 13u);
}

}  // namespace
}  // namespace gyre::laws::draw_test
