// Support features and GJK or EPA normals to contact points. See manifold_core.h.
#include "geometry/manifold/manifold_core.h"

#include "geometry/manifold/clip.h"
#include "geometry/distance/gjk.h"
#include "geometry/distance/penetration.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

// A face takes part if the contact normal leans less than this cosine (10 degrees) from its own: its points keep their
// exact distance along the contact normal, so nothing jumps when a face comes in or drops out.
constexpr float kFacing = 0.985f;
// kMaxLateralOffset of cones, which taper.
constexpr float kMaxLateralOffsetCone = 0.01f;
// B's face becomes the reference only if it faces the normal better than A's by this much: no flipping.
constexpr float kPreferA = 1.0e-3f;

// Where two cores are nearest or deepest.
struct CoreContact {
  Vec3 normal;        // unit, from A to B
  Vec3 on_a, on_b;    // of the cores, A's frame
  float separation;   // of the cores
  float size = 0.0f;  // of the smaller shape
};

// Not cleared: only the counted ones are ever read.
struct Candidates {
  union {
    ManifoldPoint points[kMaxClipPoints + 1];
  };
  Candidates() {}
};

void put_in_a(const Transform& a_from_b, FacePolygon& face) {
  for (int i = 0; i < face.count; ++i) face.vertices[i] = a_from_b * face.vertices[i];
  face.normal = rotate(a_from_b.orientation, face.normal);
}

bool side_by_side(const FacePolygon& a, const FacePolygon& b) {
  const Vec3 da = a.vertices[1] - a.vertices[0], db = b.vertices[1] - b.vertices[0];
  return length_squared(cross(da, db)) <= square(kParallelSegmentSine) * length_squared(da) * length_squared(db);
}

// Of a polygon only its edge that is farthest along `direction`.
void keep_leading_edge(FacePolygon& face, Vec3 direction) {
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

// How far two segments may lie beside each other.
float sideways(const Shape& a, const Shape& b) {
  const bool tapers = a.kind == ShapeKind::cone || b.kind == ShapeKind::cone;
  // A sharp edge has no radius; the other shape's decides.
  const float radius = a.radius > 0.0f && b.radius > 0.0f ? min(a.radius, b.radius) : max(a.radius, b.radius);
  return (tapers ? kMaxLateralOffsetCone : kMaxLateralOffset) * radius;
}

// The candidate points of the features of both cores that face each other. At most kMaxClipPoints.
int facing_points(const Shape& a, const Shape& b, const Transform& a_from_b, const CoreContact& contact,
                  float max_separation, ManifoldPoint* points) {
  FacePolygon fa, fb;
  support_face(a, contact.normal, fa);
  if (fa.count == 1) return 0;
  support_face(b, rotate_inverse(a_from_b.orientation, -contact.normal), fb);
  if (fb.count == 1) return 0;
  put_in_a(a_from_b, fb);
  const FacePair pair{&fa,           &fb, contact.normal, core_radius(a), core_radius(b), max_separation,
                      sideways(a, b)};
  const float facing_a = fa.count > 2 ? dot(fa.normal, contact.normal) : -1.0f;
  const float facing_b = fb.count > 2 ? -dot(fb.normal, contact.normal) : -1.0f;
  const bool refer_to_a = facing_a >= kFacing && facing_a >= facing_b - kPreferA;
  if (refer_to_a || facing_b >= kFacing) {
    const int count = clip_faces(pair, refer_to_a, points);
    if (count > 0) return count;
  }
  // Edge along edge, a capsule along one, or what hangs over the edge of the face.
  if (fa.count > 2) keep_leading_edge(fa, contact.normal);
  if (fb.count > 2) keep_leading_edge(fb, -contact.normal);
  if (fa.count == 2 && fb.count == 2 && side_by_side(fa, fb)) return clip_segments(pair, points);
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
  const double reach = double(core_radius(a)) + double(core_radius(b)) + double(max_separation);
  const CoreDistance distance = core_distance(pair, reach, remembered(cache));
  remember(cache, to_float(distance.normal));
  if (distance.beyond || (!distance.overlap && distance.distance > reach)) return;
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
