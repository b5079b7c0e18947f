// docs/collision.md shows tables that are made here from the code: which method serves which two shapes, who can be asked what,
// and which structures there are. A stale table fails; with UPDATE_DOCS set it is written anew.
#include "collision/continuous/continuous.h"
#include "collision/continuous/time_of_impact.h"
#include "geometry/manifold/manifold_convex.h"
#include "geometry/query/cast.h"
#include "geometry/query/closest_points.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/mesh.h"

#include <gyre/bounds.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace gyre::collision_table_test {
namespace {

struct Named {
  std::string name;
  AnyShape any;
  Shape shape;
};

Geometry flat_mesh() {
  const Vec3 v[4] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
  const std::uint32_t t[6] = {0, 1, 2, 0, 2, 3};
  return *cook_mesh({.vertices = v, .indices = t});
}
Geometry flat_field() {
  const float heights[4] = {0, 0, 0, 0};
  return *cook_height_field({.heights = heights, .columns = 2, .rows = 2, .spacing = 2.0f});
}

// One shape of every kind, and the rounded box.
std::vector<Named> all_shapes() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f});
  std::vector<Named> all;
  const auto add = [&](const AnyShape& any, const char* name) {
    all.push_back({name, any, make_shape(any)});
  };
  add(Sphere{0.5f}, "sphere");
  add(Box{}, "box");
  add(Box{{0.5f, 0.5f, 0.5f}, 0.1f}, "rounded box");
  add(Capsule{}, "capsule");
  add(Cylinder{}, "cylinder");
  add(Cone{}, "cone");
  add(*cook_hull(corners), "hull");
  add(Plane{}, "plane");
  add(flat_mesh(), "mesh");
  add(flat_field(), "height field");
  return all;
}

std::string row(const std::vector<std::string>& cells) {
  std::string out = "|";
  for (const std::string& cell : cells) out += " " + cell + " |";
  return out + "\n";
}
std::string rule(std::size_t columns) {
  std::string out = "|";
  for (std::size_t i = 0; i < columns; ++i) out += "---|";
  return out + "\n";
}

// By what collide_shapes itself asks; that the method answers at all is tried out on two that overlap a little.
std::string contact_table() {
  const std::vector<Named> all = all_shapes();
  std::vector<std::string> cells = {""};
  for (const Named& b : all) cells.push_back(b.name);
  std::string out = row(cells) + rule(cells.size());
  for (const Named& a : all) {
    cells = {"**" + a.name + "**"};
    for (const Named& b : all) {
      const ContactMethod method = contact_method(a.shape, b.shape);
      const bool up = is_convex(b.shape.kind);
      PairCache cache;
      LocalManifold found[kMaxMeshManifolds];
      const float lift = is_convex(a.shape.kind) && is_convex(b.shape.kind) ? 0.9f : 0.45f;
      const int count =
          collide_shapes(a.shape, b.shape, {{0, up ? lift : -lift, 0}, {}}, 0.02f, cache, found);
      EXPECT_EQ(count > 0, method != ContactMethod::none) << a.name << " " << b.name;
      cells.push_back(method == ContactMethod::none ? "–" : std::string("`") + to_string(method) + "`");
    }
    out += row(cells);
  }
  return out;
}

// Every cell is tried out.
std::string kind_table() {
  const std::vector<Named> all = all_shapes();
  const Shape ball = make_shape(AnyShape(Sphere{0.25f}));
  const std::vector<std::string> head = {"",
                                         "ray meets it",
                                         "moving shape meets it",
                                         "may itself be moved",
                                         "closest point",
                                         "way out of overlap",
                                         "stops a fast body",
                                         "is swept when fast"};
  std::string out = row(head) + rule(head.size());
  for (const Named& it : all) {
    std::vector<std::string> cells = {"**" + it.name + "**"};
    const auto tell = [&](bool yes) { cells.push_back(yes ? "yes" : "–"); };
    LocalHit hit;
    tell(cast_ray(it.shape, {{0.1, 3, 0.1}, {0, -4, 0}}, 1.0, false, hit));
    tell(cast_shape(it.shape, {&ball, {0.1, 3, 0.1}, {}, {0, -4, 0}}, 1.0, false, hit));
    const bool convex = is_convex(it.shape.kind);
    tell(convex && cast_shape(ball, {&it.shape, {0.1, 3, 0.1}, {}, {0, -4, 0}}, 1.0, false, hit));
    ClosestPair nearest;
    tell(find_closest_points(it.shape, {&ball, {0.1, 3, 0.1}, {}}, 10.0, nearest) && nearest.distance > 1.0);
    PairCache cache;
    LocalManifold found[kMaxMeshManifolds];
    tell(collide_shapes(it.shape, ball, {{0.1f, 0.2f, 0.1f}, {}}, 0.0f, cache, found) > 0);
    // A ball that falls through the whole of it in one step, and the other way round.
    const Sweep falls{{{0.1, 3, 0.1}, {}}, {}, {0, -6, 0}, {}}, rests{{{0, 0, 0}, {}}, {}, {}, {}};
    const SweptShape ball_falls = make_swept_shape(ball, {}, falls),
                     it_rests = make_swept_shape(it.shape, {}, rests);
    const Core core = make_core(ball, {});
    const SweptShape core_falls = make_swept_shape(core.shape, core.body_from_core, falls);
    const ImpactScale scale{0.001, 0.003, 0.001};
    TriangleHull triangle;
    const bool surface = !convex && it.shape.kind != ShapeKind::plane;
    tell(surface ? surface_time_of_impact(ball_falls, core_falls, it_rests, 1.0, scale, triangle).hit
                 : convex_time_of_impact(ball_falls, core_falls, it_rests, 0.0, 1.0, scale).hit);
    tell(convex && time_of_impact(make_swept_shape(it.shape, {}, falls), make_swept_shape(ball, {}, rests),
                                  0.0, 1.0, 0.001)
                       .hit);
    out += row(cells);
  }
  return out;
}

std::string structure_table() {
  std::string broad, bounds;
  for (int i = 0; i < kBroadPhaseKindCount; ++i)
    broad += std::string(i > 0 ? ", `" : "`") + to_string(BroadPhaseKind(i)) + "`";
  for (int i = 0; i < kBoundKindCount; ++i)
    bounds += std::string(i > 0 ? ", `" : "`") + to_string(BoundKind(i)) + "`";
  // What a cooked shape of each kind carries.
  std::string with_tree, with_pyramid;
  for (const Named& it : all_shapes()) {
    const bool tree = it.shape.kind == ShapeKind::mesh && !it.shape.mesh->tree.nodes.empty();
    const bool pyramid = it.shape.kind == ShapeKind::height_field && !it.shape.field->levels.empty();
    if (tree) with_tree += (with_tree.empty() ? "" : ", ") + it.name;
    if (pyramid) with_pyramid += (with_pyramid.empty() ? "" : ", ") + it.name;
  }
  const std::string lanes = std::to_string(StaticTree::kWidth);
  const std::string cells = std::to_string(1u << HeightField::kBlockShift);
  return row({"structure", "which", "choose by"}) + rule(3) +
         row({"broad phases", broad, "`World::set_broad_phase`, `broad_phase` of a scene"}) +
         row({"bounding volumes", bounds, "`gyre/bounds.h`, `gyre info`"}) +
         row({"tree of bounding boxes, " + lanes + " children a node", "the triangles of a " + with_tree,
              "–"}) +
         row({"pyramid of height ranges over blocks of " + cells + " x " + cells + " cells",
              "the cells of a " + with_pyramid, "–"});
}

std::string with_table(const std::string& text, const std::string& mark, const std::string& table) {
  const std::string begin = "<!-- " + mark + " -->\n";
  const std::size_t from = text.find(begin);
  const std::size_t to = text.find("<!-- end -->", from);
  if (from == std::string::npos || to == std::string::npos) return text;
  return text.substr(0, from + begin.size()) + table + text.substr(to);
}

TEST(CollisionTable, IsWhatTheCodeDoes) {
  const std::string path = std::string(GYRE_SOURCE_DIR) + "/docs/collision.md";
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(text.empty());
  std::string wanted = with_table(text, "contacts", contact_table());
  wanted = with_table(wanted, "kinds", kind_table());
  wanted = with_table(wanted, "structures", structure_table());
  ASSERT_NE(wanted.find("`seven_features`"), std::string::npos);
  if (std::getenv("UPDATE_DOCS") != nullptr) {
    std::ofstream(path) << wanted;
    return;
  }
  EXPECT_EQ(text, wanted) << "docs/collision.md is stale: run this test with UPDATE_DOCS=1";
}

}  // namespace
}  // namespace gyre::collision_table_test
