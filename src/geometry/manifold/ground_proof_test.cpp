// Every convex kind against planes, single triangles, meshes and height fields, a million degenerate pairs of each.
// Distances, overlaps and manifolds are proven from the definitions of the shapes (surface_oracle.h).
//
// A distance is right if its points lie on the surface and in the shape and are that far apart, and if for every
// triangle some direction separates the shape by that much. A manifold of separated shapes is right if its deepest
// point has their distance and exists only within the largest separation. Every point lies on both surfaces, and
// following the deepest point leads out of an overlap.
//
// All pairs with planes are proven. Of triangles one pair in two thousand may stay without proof: plates and needles at
// sliver triangles, and shapes that hang over the border of a mesh or a hole, where a manifold has one normal for all
// its points.
#include "geometry/manifold/manifold.h"
#include "geometry/query/closest_points.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/mesh.h"
#include "geometry/testing/surface_oracle.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <string>

namespace gyre::ground_proof_test {
namespace {

using namespace oracle;

using Corners = std::array<DVec3, 3>;

// The static shape: a plane, or triangles.
struct Ground {
  Geometry geometry;  // none: a plane
  Shape shape;
  std::vector<Corners> triangles;
  double size = 1.0;  // of its coordinates
  bool both_sides = false;
};

void take_triangles(Ground& ground) {
  ground.shape = make_shape(AnyShape(ground.geometry));
  const auto add = [&](const TriangleView& view) {
    ground.triangles.push_back({DVec3(view.v[0]), DVec3(view.v[1]), DVec3(view.v[2])});
  };
  if (ground.shape.kind == ShapeKind::mesh) {
    for (std::uint32_t i = 0; i < ground.shape.mesh->triangle_count(); ++i)
      add(view_triangle(*ground.shape.mesh, i));
  } else {
    const HeightField& field = *ground.shape.field;
    for (std::uint32_t cell = 0; cell < field.cell_columns() * field.cell_rows(); ++cell) {
      if (!is_solid_cell(field, cell % field.cell_columns(), cell / field.cell_columns())) continue;
      add(view_triangle(field, 2 * cell));
      add(view_triangle(field, 2 * cell + 1));
    }
  }
  for (const Corners& corners : ground.triangles) {
    for (const DVec3& p : corners)
      ground.size = max(ground.size, max(absolute(p.x), max(absolute(p.y), absolute(p.z))));
  }
}

Ground make_plane_ground(Random& random) {
  Ground ground;
  ground.shape = make_plane(random.below(2) == 0 ? Vec3{0, 1, 0} : random.direction(), random(-1.0f, 1.0f));
  return ground;
}

// Alone, and seen from both sides; one in four is a sliver.
Ground make_triangle_ground(Random& random) {
  for (;;) {
    const float thin = random.below(4) == 0 ? one_of(random, {1e-2f, 1e-4f}) : 1.0f;
    const float size = one_of(random, {1, 1, 0.05f, 30});
    const Vec3 a = size * random.in_cube(), b = size * random.in_cube();
    const Vec3 c = lerp(a, b, random(-0.5f, 1.5f)) + thin * size * random.in_cube();
    const Vec3 vertices[3] = {a, b, c};
    const std::uint32_t indices[3] = {0, 1, 2};
    const Result<Geometry> made = cook_mesh({.vertices = vertices, .indices = indices, .double_sided = true});
    if (!made || made->data()->mesh->triangle_count() != 1) continue;
    Ground ground;
    ground.geometry = *made;
    ground.both_sides = true;
    take_triangles(ground);
    return ground;
  }
}

// A patch of ground over a square, `height` at each of 5 x 5 places: flat, a slope, steps, or rough.
void patch(Random& random, float cell, float (&height)[25]) {
  const int sort = random.below(4);
  const float steep = cell * one_of(random, {0.02f, 0.3f, 1.0f});
  for (int i = 0; i < 25; ++i) {
    if (sort == 0) height[i] = 0.0f;
    if (sort == 1) height[i] = steep * float(i % 5);
    if (sort == 2) height[i] = steep * float((i % 5) / 2);
    if (sort == 3) height[i] = steep * random(-1.0f, 1.0f);
  }
}

Ground make_mesh_ground(Random& random) {
  const float cell = one_of(random, {0.1f, 0.5f, 2.0f});
  float height[25];
  patch(random, cell, height);
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int z = 0; z < 5; ++z) {
    for (int x = 0; x < 5; ++x)
      vertices.push_back({cell * float(x - 2), height[5 * z + x], cell * float(z - 2)});
  }
  for (std::uint32_t z = 0; z < 4; ++z) {
    for (std::uint32_t x = 0; x < 4; ++x) {
      const std::uint32_t a = 5 * z + x, b = a + 1, c = a + 5, d = a + 6;
      if (random.below(2) == 0) {
        indices.insert(indices.end(), {a, c, b, b, c, d});
      } else {
        indices.insert(indices.end(), {a, d, b, a, c, d});
      }
    }
  }
  Ground ground;
  ground.geometry = *cook_mesh({.vertices = vertices, .indices = indices});
  take_triangles(ground);
  return ground;
}

Ground make_field_ground(Random& random) {
  const float cell = one_of(random, {0.1f, 0.5f, 2.0f});
  float height[25];
  patch(random, cell, height);
  if (random.below(4) == 0) height[6 + random.below(3)] = std::numeric_limits<float>::quiet_NaN();
  Ground ground;
  ground.geometry = *cook_height_field({.heights = height, .columns = 5, .rows = 5, .spacing = cell});
  take_triangles(ground);
  return ground;
}

enum class GroundKind { plane, triangle, mesh, height_field };
Ground make_ground(Random& random, GroundKind kind) {
  switch (kind) {
    case GroundKind::plane:
      return make_plane_ground(random);
    case GroundKind::triangle:
      return make_triangle_ground(random);
    case GroundKind::mesh:
      return make_mesh_ground(random);
    default:
      return make_field_ground(random);
  }
}

// The point of a triangle nearest to another, from its definition: below it on the face, or of one of three edges.
DVec3 nearest_of(const Corners& t, DVec3 p) {
  const DVec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const double squared_area = dot(n, n);
  bool over = squared_area > 0.0;
  double least = 1.0e300;
  DVec3 best;
  for (std::size_t i = 0; i < 3; ++i) {
    const DVec3 from = t[i], along = t[(i + 1) % 3] - from;
    const double squared = dot(along, along);
    const double s = squared > 0.0 ? clamp(dot(p - from, along) / squared, 0.0, 1.0) : 0.0;
    const DVec3 found = from + s * along;
    if (length(p - found) < least) least = length(p - found), best = found;
    over = over && dot(cross(along, p - from), n) >= 0.0;
  }
  return over ? p - (dot(p - t[0], n) / squared_area) * n : best;
}

class GroundProof {
 public:
  GroundProof(const Ground& ground, const Shape& shape, const Transform& pose)
      : ground_(ground), shape_(shape), pose_(pose), turn_(normalized(to_double(pose.orientation))) {
    long_ = long_side(shape);
    thin_ = thin_side(shape);
    place_ =
        max(ground.size,
            max(absolute(pose.position.x), max(absolute(pose.position.y), absolute(pose.position.z))) * 1.0);
    rounding_ = 4.0e-6 * (long_ + place_);
  }
  const char* wrong = nullptr;
  double by = 0.0;
  ClosestPair near;
  LocalManifold found[kMaxMeshManifolds];
  int count = 0;
  float deepest = kUnbounded;

  void say(const char* what, double amount) {
    if (wrong == nullptr) wrong = what, by = amount;
  }
  double rounding() const { return rounding_; }
  double thin() const { return thin_; }
  double long_way() const { return long_; }

  double outside_shape(DVec3 p) const {
    return outside_surface(shape_, rotate_inverse(turn_, p - DVec3(pose_.position)));
  }
  DVec3 nearest_of_ground(DVec3 p) const {
    if (ground_.triangles.empty())
      return p - outside_surface(ground_.shape, p) * DVec3(ground_.shape.extents);
    DVec3 best;
    double least = 1.0e300;
    for (const Corners& t : ground_.triangles) {
      const DVec3 look = nearest_of(t, p);
      if (length(look - p) < least) least = length(look - p), best = look;
    }
    return best;
  }
  double distance_to_ground(DVec3 p) const { return length(nearest_of_ground(p) - p); }
  // How far the shape extends before all corners of a triangle along a unit direction.
  double parted(const Corners& t, DVec3 n) const {
    const double top = max(dot(t[0], n), max(dot(t[1], n), dot(t[2], n)));
    return dot(DVec3(pose_.position), n) - extent(shape_, rotate_inverse(turn_, -n)) -
           double(core_radius(shape_)) - top;
  }

  void look_nearest() {
    if (!find_closest_points(ground_.shape, {&shape_, DVec3(pose_.position), turn_}, 1.0e30, near))
      return say("nothing nearest", 0);
    if (outside_shape(near.on_convex) > rounding_)
      say("nearest point outside the shape", outside_shape(near.on_convex));
    const bool plane = ground_.triangles.empty();
    if (near.overlap) {
      // A point of the ground, close to the reported one, lies in the shape.
      const DVec3 shared = plane ? near.on_target : nearest_of_ground(near.on_target);
      if (plane && outside_surface(ground_.shape, shared) > rounding_) say("overlap that is none", 0);
      if (outside_shape(shared) > rounding_) say("overlap that is none", outside_shape(shared));
      return;
    }
    if (distance_to_ground(near.on_target) > rounding_)
      say("nearest point off the ground", distance_to_ground(near.on_target));
    const double gap = length(near.on_convex - near.on_target);
    if (absolute(gap - near.distance) > rounding_) say("nearest points elsewhere", gap - near.distance);
    if (plane) {
      const DVec3 n(ground_.shape.extents);
      const double height = dot(DVec3(pose_.position), n) - extent(shape_, rotate_inverse(turn_, -n)) -
                            double(core_radius(shape_)) - double(ground_.shape.offset);
      if (absolute(height - near.distance) > rounding_) say("another height", height - near.distance);
      return;
    }
    for (const Corners& t : ground_.triangles) {
      double lower = parted(t, near.normal);
      if (lower < near.distance - rounding_) {
        const DVec3 corners[3] = {{}, t[1] - t[0], t[2] - t[0]};
        const CorePair pair(corners, shape_, DVec3(pose_.position) - t[0], turn_);
        lower = max(lower, parted(t, core_distance(pair, 1.0e30, {}).normal));
      }
      if (lower < near.distance - rounding_) say("a triangle is nearer", near.distance - lower);
    }
  }

  void collide(float reach) {
    PairCache cache;
    count = collide_shapes(ground_.shape, shape_, pose_, reach, cache, found);
    deepest = kUnbounded;
    for (int i = 0; i < count; ++i) {
      const LocalManifold& m = found[i];
      if (m.count < 1 || m.count > kMaxManifoldPoints) return say("strange count", m.count);
      if (absolute(length(DVec3(m.normal)) - 1.0) > 1.0e-5) say("normal not unit", length(DVec3(m.normal)));
      for (int k = 0; k < m.count; ++k) {
        if (!is_finite(m.points[k].position) || !is_finite(m.points[k].separation))
          return say("point not finite", 0);
        deepest = min(deepest, m.points[k].separation);
        points_lie_on_both(m, m.points[k]);
      }
    }
  }

  void points_lie_on_both(const LocalManifold& m, const ManifoldPoint& point) {
    const DVec3 n = DVec3(m.normal) / length(DVec3(m.normal)), middle(point.position);
    const double half = 0.5 * double(point.separation);
    // A sunk shape leaves through the front of a face, pushed at its lowest point, wherever that is.
    if (-2.0 * half > 0.1 * thin_ + rounding_) return;
    // Contacts whose normals differ by less than two degrees share one; segments may lie a little beside an edge.
    const double slack = 2.0 * rounding_ + 3.0e-3 * thin_ + 0.1 * max(-2.0 * half, 0.0) +
                         // An axis search reports corners beside edges slightly closer than they are.
                         1.0 * max(half, 0.0) +
                         (shape_.kind != ShapeKind::sphere ? 0.1 * double(shape_.radius) : 0.0);
    const double off = distance_to_ground(middle - half * n);
    if (off > slack && half >= 0.0) say("point off the ground", off);
    const double out = outside_shape(middle + half * n);
    if (out > slack) say("point outside the shape", out);
  }

 private:
  const Ground& ground_;
  const Shape& shape_;
  Transform pose_;
  DQuat turn_;
  double long_, thin_, place_, rounding_;
};

// True if shape and closest point are on the front side of every triangle around it; surfaces have no contacts from
// behind. The front of a double-sided surface is the side of the shape's centre.
bool seen_from_front(const Ground& ground, const ClosestPair& near, DVec3 middle, double slack) {
  for (const Corners& t : ground.triangles) {
    DVec3 n = cross(t[1] - t[0], t[2] - t[0]);
    if (length(nearest_of(t, near.on_target) - near.on_target) > slack) continue;
    if (ground.both_sides && dot(n, middle - t[0]) < 0.0) n = -n;
    if (dot(n, near.normal) < 0.05 * length(n) || dot(n, middle - t[0]) < 0.0) return false;
  }
  return true;
}

// Moves the shape along a direction until it is `left` from the ground, or in it.
bool bring_to(const Ground& ground, const Shape& shape, Transform& pose, Vec3 back, double left) {
  ClosestPair near;
  for (int i = 0; i < 40; ++i) {
    if (!find_closest_points(ground.shape,
                             {&shape, DVec3(pose.position), normalized(to_double(pose.orientation))}, 1.0e30,
                             near))
      return false;
    if (near.overlap) {
      pose.position += 0.3f * outer_radius(shape, {}) * back;
      continue;
    }
    if (absolute(near.distance - max(left, 1.0e-4)) < 1.0e-5) break;
    const double closing = dot(near.normal, DVec3(back));
    if (closing < 0.05) return false;
    pose.position -= float((near.distance - max(left, 1.0e-4)) / closing * (i < 20 ? 0.9 : 0.5)) * back;
  }
  const DVec3 middle(pose * (shape.kind == ShapeKind::hull ? shape.hull->centroid : Vec3{}));
  if (left < 0.0) pose.position += float(left) * to_float(near.normal);
  return seen_from_front(ground, near, middle, 1.0e-3 * ground.size + 1.0e-3 * long_side(shape));
}

struct Kinds {
  int shape;
  GroundKind ground;
};

Shape draw_shape(Random& random, Hulls& hulls, int kind) {
  const int odd = random.below(6);
  const float thin = odd == 1 ? one_of(random, {0.02f, 1e-3f}) : 1.0f;
  const float low = odd == 2 ? one_of(random, {0.02f, 1e-3f}) : 1.0f;
  const float size = odd == 3 ? one_of(random, {0.03f, 20.0f}) : 1.0f;
  return degenerate_shape(random, hulls, kind, size, thin, low);
}

std::string describe(const Shape& s, const Transform& t) {
  char text[300];
  std::snprintf(text, sizeof text, "%s r %.9g e %.9g %.9g %.9g at %.9g %.9g %.9g turn %.9g %.9g %.9g %.9g",
                to_string(s.kind), double(s.radius), double(s.extents.x), double(s.extents.y),
                double(s.extents.z), double(t.position.x), double(t.position.y), double(t.position.z),
                double(t.orientation.x), double(t.orientation.y), double(t.orientation.z),
                double(t.orientation.w));
  return text;
}

// Tests one pair at its pose and, if it overlaps, on the path out of the overlap.
void prove_one(const Ground& ground, const Shape& shape, Transform pose, GroundProof& proof, float reach,
               bool in_front) {
  proof.look_nearest();
  proof.collide(reach);
  if (proof.wrong != nullptr) return;
  // The closest point after the move may differ by rounding from the one before.
  const DVec3 middle(pose * (shape.kind == ShapeKind::hull ? shape.hull->centroid : Vec3{}));
  in_front = in_front && (ground.triangles.empty() || proof.near.overlap ||
                          seen_from_front(ground, proof.near, middle, 1.0e-6 * ground.size));
  // A direction must be better by a two-thousandth of the size to replace that of the face, and an axis search reports
  // corners beside edges about as much closer than they are.
  const double exact = 3.0e-3 * proof.thin() + 1.2e-3 * proof.long_way() + 2.0 * proof.rounding();
  if (!proof.near.overlap) {
    if (proof.near.distance > double(reach) + proof.rounding() && proof.count > 0)
      proof.say("contact out of reach", proof.near.distance);
    if (!in_front || proof.near.distance > double(reach) - exact) return;
    if (proof.count == 0) return proof.say("no contact within reach", proof.near.distance);
    const double off = double(proof.deepest) - proof.near.distance;
    if (absolute(off) > exact) proof.say(off < 0 ? "nearer than it is" : "farther than it is", absolute(off));
    return;
  }
  if (!in_front) return;
  if (proof.count == 0) return proof.say("no contact although they overlap", 0);
  Vec3 out = proof.found[0].normal;
  for (int look = 0; look < 12; ++look) {
    GroundProof now(ground, shape, pose);
    now.collide(reach);
    const LocalManifold* worst = nullptr;
    float deepest = float(-2.0 * proof.rounding());
    for (int i = 0; i < now.count; ++i) {
      for (int k = 0; k < now.found[i].count; ++k) {
        if (now.found[i].points[k].separation >= deepest) continue;
        deepest = now.found[i].points[k].separation;
        worst = &now.found[i];
      }
    }
    if (worst == nullptr) break;
    out = worst->normal;
    pose.position -= deepest * out;
  }
  // Out of it, except for the depth that contacts leave.
  GroundProof after(ground, shape, {pose.position + float(4.0 * exact) * out, pose.orientation});
  after.look_nearest();
  if (after.near.overlap) proof.say("following the contacts does not lead out", 0);
}

// Points that are reported closer than they are lie between the shapes: there are too many to print them all.
bool is_point(const char* reason) { return std::string(reason).starts_with("point"); }

void prove(Kinds kinds, int pairs, unsigned seed) {
  Random random(seed + unsigned(kinds.shape * 4 + int(kinds.ground)));
  int wrong = 0, touching = 0, apart = 0;
  std::map<std::string, int> reasons;
  Ground ground;
  for (int begin = 0; begin < pairs; begin += 1000) {
    Hulls hulls;
    for (int i = begin; i < min(pairs, begin + 1000); ++i) {
      if (i % 10 == 0) ground = make_ground(random, kinds.ground);
      const Shape shape = draw_shape(random, hulls, kinds.shape);
      Transform pose = random_pose(random, float(ground.size));
      // Half of the pairs at random from any side; half brought close from above.
      bool in_front = kinds.ground == GroundKind::plane;
      const float reach = 0.02f * float(long_side(shape));
      if (random.below(3) != 0 && kinds.ground != GroundKind::plane) {
        const Vec3 back = kinds.ground == GroundKind::triangle ? random.direction() : Vec3{0, 1, 0};
        pose.position =
            Vec3{pose.position.x, 0, pose.position.z} + 3.0f * float(long_side(shape) + ground.size) * back;
        const float depth = float(thin_side(shape));
        const double left = double(one_of(random, {0.7f * reach, 0.3f * reach, 0.01f * reach, 1.3f * reach,
                                                   -0.01f * depth, -0.1f * depth}));
        in_front = bring_to(ground, shape, pose, back, left);
      } else if (kinds.ground == GroundKind::plane) {
        const float height = dot(ground.shape.extents, pose.position) - ground.shape.offset;
        pose.position += (random(-0.9f, 1.1f) * float(long_side(shape)) - height) * ground.shape.extents;
      }
      GroundProof proof(ground, shape, pose);
      prove_one(ground, shape, pose, proof, reach, in_front);
      touching += proof.count > 0;
      apart += !proof.near.overlap;
      if (proof.wrong == nullptr) continue;
      ++reasons[proof.wrong];
      if (++wrong > 5 && is_point(proof.wrong)) continue;
      std::ostringstream text;
      text << proof.wrong << " by " << proof.by << ", pair " << i << ": " << describe(shape, pose)
           << ", nearest " << proof.near.distance << (proof.near.overlap ? " overlap" : "") << ", "
           << proof.count << " manifolds, deepest " << proof.deepest << " reach " << reach;
      std::printf("%s\n", text.str().c_str());
    }
  }
  std::printf("%d of %d pairs are not proven\n", wrong, pairs);
  for (const auto& [reason, times] : reasons) std::printf("  %d: %s\n", times, reason.c_str());
  EXPECT_LE(wrong, kinds.ground == GroundKind::plane ? 0 : max(pairs / 2000, 1)) << "of " << pairs;
  // No proof is required here, but no contact may be missed or invented.
  for (const char* fault : {"contact out of reach", "no contact within reach", "farther than it is",
                            "no contact although they overlap"})
    EXPECT_EQ(reasons.count(fault), 0u) << fault;
  EXPECT_GT(touching, pairs / 6);
  EXPECT_GT(apart, pairs / 25);
}

std::vector<Kinds> all_pairs() {
  std::vector<Kinds> all;
  for (const GroundKind ground :
       {GroundKind::plane, GroundKind::triangle, GroundKind::mesh, GroundKind::height_field}) {
    for (int shape = 0; shape < kKinds; ++shape) all.push_back({shape, ground});
  }
  return all;
}
std::string name_of(const testing::TestParamInfo<Kinds>& info) {
  const char* grounds[4] = {"plane", "triangle", "mesh", "height_field"};
  std::string name = std::string(kind_name(info.param.shape)) + "_and_" + grounds[int(info.param.ground)];
  for (char& c : name) {
    if (c == ' ') c = '_';
  }
  return name;
}

class GroundProofOf : public testing::TestWithParam<Kinds> {};
class LongGroundProofOf : public testing::TestWithParam<Kinds> {};
TEST_P(GroundProofOf, OddPairs) { prove(GetParam(), 1000, 81); }
TEST_P(LongGroundProofOf, AMillionOddPairs) { prove(GetParam(), 1000000, 82); }
INSTANTIATE_TEST_SUITE_P(Kinds, GroundProofOf, testing::ValuesIn(all_pairs()), name_of);
INSTANTIATE_TEST_SUITE_P(Kinds, LongGroundProofOf, testing::ValuesIn(all_pairs()), name_of);

}  // namespace
}  // namespace gyre::ground_proof_test
