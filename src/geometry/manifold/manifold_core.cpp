// Support features and GJK or EPA normals to contact points. See manifold_core.h.
#include "geometry/manifold/manifold_core.h"

#include "geometry/distance/gjk.h"
#include "geometry/distance/penetration.h"
#include "geometry/manifold/clip.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

// Cosine (10 degrees) between the contact normal and the normal of a face below which the face is not used. Its points
// have their exact distance along the contact normal, so nothing jumps when a face comes in or drops out.
constexpr float kFacing = 0.985f;
// The lateral offset of cones, which taper, as a fraction of the radius.
constexpr float kMaxLateralOffsetCone = 0.01f;
// B's face becomes the reference only if it faces the normal better than A's face by this much. So the roles do not
// flip.
constexpr float kPreferA = 1.0e-3f;

// The closest or deepest points of two cores.
struct CoreContact {
  Vec3 normal;        // unit, from A to B
  Vec3 on_a, on_b;    // of the cores, in A's frame
  float separation;   // of the cores
  float size = 0.0f;  // of the smaller shape
};

// Not cleared: only the counted elements are read.
struct Candidates {
  union {
    ManifoldPoint points[kMaxClipPoints + 1];
  };
  Candidates() {}
};

void transform_to_a(const Transform& a_from_b, FacePolygon& face) {
  for (int i = 0; i < face.count; ++i) face.vertices[i] = a_from_b * face.vertices[i];
  face.normal = rotate(a_from_b.orientation, face.normal);
}

bool nearly_parallel(const FacePolygon& a, const FacePolygon& b) {
  const Vec3 da = a.vertices[1] - a.vertices[0], db = b.vertices[1] - b.vertices[0];
  return length_squared(cross(da, db)) <=
         square(kParallelSegmentSine) * length_squared(da) * length_squared(db);
}

// Reduces a polygon to its edge that is farthest along `direction`.
void reduce_to_leading_edge(FacePolygon& face, Vec3 direction) {
  int best = 0;
  float highest = -kUnbounded;
  for (int i = 0; i < face.count; ++i) {
    const int next = i + 1 == face.count ? 0 : i + 1;
    const float height = dot(face.vertices[i] + face.vertices[next], direction);
    if (height > highest) {
      highest = height;
      best = i;
    }
  }
  const int next = best + 1 == face.count ? 0 : best + 1;
  const Vec3 from = face.vertices[best], to = face.vertices[next];
  const std::uint8_t id_from = face.ids[best], id_to = face.ids[next];
  face.count = 2;
  face.vertices[0] = from, face.vertices[1] = to;
  face.ids[0] = id_from, face.ids[1] = id_to;
}

// How far apart two parallel segments may pass and still touch in two points.
float max_lateral_offset(const Shape& a, const Shape& b) {
  const bool tapers = a.kind == ShapeKind::cone || b.kind == ShapeKind::cone;
  // A sharp edge has no radius; the other shape decides.
  const float radius = a.radius > 0.0f && b.radius > 0.0f ? min(a.radius, b.radius) : max(a.radius, b.radius);
  return (tapers ? kMaxLateralOffsetCone : kMaxLateralOffset) * radius;
}

// The candidate points of the features that face each other. At most kMaxClipPoints.
int facing_points(const Shape& a, const Shape& b, const Transform& a_from_b, const CoreContact& contact,
                  float max_separation, ManifoldPoint* points) {
  FacePolygon fa, fb;
  support_face(a, contact.normal, fa);
  if (fa.count == 1) return 0;
  support_face(b, rotate_inverse(a_from_b.orientation, -contact.normal), fb);
  if (fb.count == 1) return 0;
  transform_to_a(a_from_b, fb);
  const FacePair pair{
      &fa, &fb, contact.normal, core_radius(a), core_radius(b), max_separation, max_lateral_offset(a, b)};
  const float facing_a = fa.count > 2 ? dot(fa.normal, contact.normal) : -1.0f;
  const float facing_b = fb.count > 2 ? -dot(fb.normal, contact.normal) : -1.0f;
  const bool reference_is_a = facing_a >= kFacing && facing_a >= facing_b - kPreferA;
  if (reference_is_a || facing_b >= kFacing) {
    const int count = clip_faces(pair, reference_is_a, points);
    if (count > 0) return count;
  }
  // Edge along edge, a capsule along an edge, or a feature beyond the edge of the face.
  if (fa.count > 2) reduce_to_leading_edge(fa, contact.normal);
  if (fb.count > 2) reduce_to_leading_edge(fb, -contact.normal);
  if (fa.count == 2 && fb.count == 2 && nearly_parallel(fa, fb)) return clip_segments(pair, points);
  return 0;
}

ManifoldPoint nearest_point(const Shape& a, const Shape& b, const CoreContact& contact) {
  const float radius_a = core_radius(a), radius_b = core_radius(b);
  ManifoldPoint point;
  point.position =
      0.5f * ((contact.on_a + radius_a * contact.normal) + (contact.on_b - radius_b * contact.normal));
  point.separation = contact.separation - radius_a - radius_b;
  point.feature = kFeatureNearest;
  return point;
}

void fill(const Shape& a, const Shape& b, const Transform& a_from_b, const CoreContact& contact,
          float max_separation, LocalManifold& out) {
  Candidates candidates;
  ManifoldPoint* const points = candidates.points;
  int count = facing_points(a, b, a_from_b, contact, max_separation, points);
  float deepest = kUnbounded;
  for (int i = 0; i < count; ++i) deepest = min(deepest, points[i].separation);
  const ManifoldPoint nearest = nearest_point(a, b, contact);
  if (count == 0 || nearest.separation < deepest - kMissTolerance * contact.size) points[count++] = nearest;
  out.normal = contact.normal;
  out.count = reduce_points(points, count, contact.normal);
  for (int i = 0; i < out.count; ++i) out.points[i] = points[i];
}

Vec3 remembered(const PairCache& cache) {
  const Vec3 guess{__builtin_bit_cast(float, cache.words[1]), __builtin_bit_cast(float, cache.words[2]),
                   __builtin_bit_cast(float, cache.words[3])};
  return is_finite(guess) ? guess : Vec3{};
}

void remember(PairCache& cache, Vec3 direction) {
  cache.words[1] = __builtin_bit_cast(std::uint32_t, direction.x);
  cache.words[2] = __builtin_bit_cast(std::uint32_t, direction.y);
  cache.words[3] = __builtin_bit_cast(std::uint32_t, direction.z);
}

}  // namespace

void collide_cores(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out) {
  const CorePair pair(a, b, a_from_b);
  const double max_distance = double(core_radius(a)) + double(core_radius(b)) + double(max_separation);
  const CoreDistance distance = core_distance(pair, max_distance, remembered(cache));
  remember(cache, to_float(distance.normal));
  if (distance.beyond || (!distance.overlap && distance.distance > max_distance)) return;
  CoreContact contact;
  contact.size = min(inner_radius(a), inner_radius(b));
  if (distance.overlap) {
    const CorePenetration deep = core_penetration(pair, distance);
    contact.normal = to_float(deep.normal);
    contact.on_a = to_float(deep.on_a);
    contact.on_b = to_float(deep.on_b);
    contact.separation = float(-deep.depth);
  } else {
    contact.normal = to_float(distance.normal);
    contact.on_a = to_float(distance.on_a);
    contact.on_b = to_float(distance.on_b);
    contact.separation = float(distance.distance);
  }
  fill(a, b, a_from_b, contact, max_separation, out);
}

}  // namespace gyre
