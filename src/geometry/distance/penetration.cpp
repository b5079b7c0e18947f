// The expanding polytope algorithm in double. See penetration.h.
#include "geometry/distance/penetration.h"

#include "geometry/distance/closest.h"

#include <cstdint>

namespace gyre {
namespace {

constexpr int kMaxPolytopeVertices = 100;
constexpr int kMaxPolytopeFaces = 2 * kMaxPolytopeVertices;
// The search ends when the best face moves out by less than this fraction of the size of the shapes. On curved shapes
// the normal is then within about 5e-5 rad.
constexpr double kDepthGap = 1.0e-9;
// A tetrahedron thinner than this fraction of the size counts as flat.
constexpr double kFlat = 1.0e-9;

struct Face {
  std::uint8_t v[3];         // counter-clockwise seen from outside
  std::uint8_t neighbor[3];  // the face across the edge from v[i] to v[i + 1]
  bool alive;
  bool visible;
  DVec3 normal;     // outward, unit
  double distance;  // of the plane from the origin; negative when the origin lies outside
};
static_assert(kMaxPolytopeFaces <= 256 && kMaxPolytopeVertices <= 256);

// Cosine between the found normal and the normals of faces that may contain the witness points.
constexpr double kSameSide = 0.999;
// Cosine between the best normal and the normals of faces that are still expanded when memory runs short.
constexpr double kNearBest = 0.9;

// Distance of a face without area. Such a face closes the surface and says nothing about the distance.
constexpr double kNoDistance = 1.0e300;

class ExpandingPolytope {
 public:
  explicit ExpandingPolytope(const CorePair& pair) : pair_(pair) {}

  // Builds a tetrahedron from the points of `start` and from extreme points of the shapes. Returns false if B - A is
  // flat; `flat_normal` is then a direction across it.
  bool start(const CoreDistance& start, DVec3& flat_normal);
  // The live face closest to the origin, of all faces or of those within a cosine of `outward`. -1 if there is none.
  int nearest() const;
  int nearest(DVec3 outward, double cosine) const;
  int vertex_count() const { return vertex_count_; }
  // Adds a point outside `face`. Returns false if the surface cannot take it (memory, or rounding broke the horizon).
  bool add(const DifferencePoint& point, int face);

  const Face& face(int i) const { return faces_[i]; }
  // The pair of points behind the surface point closest to `target`, among faces that look along `outward`.
  void witness(DVec3 target, DVec3 outward, DVec3& on_a, DVec3& on_b) const;

 private:
  int new_face(int a, int b, int c);
  bool extend(int known, DVec3& flat_normal);
  bool take_extreme(DVec3 direction, int count, double threshold);

  const CorePair& pair_;
  // Not cleared: only the counted elements are read.
  union {
    DifferencePoint vertices_[kMaxPolytopeVertices];
  };
  union {
    Face faces_[kMaxPolytopeFaces];
  };
  double distances_[kMaxPolytopeFaces];  // of live faces; kNoDistance for all others
  int vertex_count_ = 0;
  int face_count_ = 0;
  int free_[kMaxPolytopeFaces];
  int free_count_ = 0;
};

int ExpandingPolytope::new_face(int a, int b, int c) {
  const int i = free_count_ > 0 ? free_[--free_count_] : face_count_++;
  Face& face = faces_[i];
  face.v[0] = std::uint8_t(a), face.v[1] = std::uint8_t(b), face.v[2] = std::uint8_t(c);
  face.alive = true;
  face.visible = false;
  const DVec3 p = vertices_[a].difference, u = vertices_[b].difference - p, v = vertices_[c].difference - p;
  const DVec3 n = cross(u, v);
  const double area = length(n), longest = max(dot(u, u), max(dot(v, v), length_squared(v - u)));
  if (area > 1.0e-13 * longest) {
    face.normal = n / area;
    // The corner closest to the origin gives the smallest rounding error.
    DVec3 corner = p;
    if (length_squared(vertices_[b].difference) < length_squared(corner)) corner = vertices_[b].difference;
    if (length_squared(vertices_[c].difference) < length_squared(corner)) corner = vertices_[c].difference;
    face.distance = dot(face.normal, corner);
  } else {
    face.normal = {};
    face.distance = kNoDistance;
  }
  distances_[i] = face.distance;
  return i;
}

// Writes the extreme point along +-direction behind the first `count` vertices, if it is farther than `threshold` from
// vertex 0 along the direction.
bool ExpandingPolytope::take_extreme(DVec3 direction, int count, double threshold) {
  const DVec3 origin = vertices_[0].difference;
  const DifferencePoint up = pair_.support(direction), down = pair_.support(-direction);
  const double far_up = dot(up.difference - origin, direction),
               far_down = dot(origin - down.difference, direction);
  if (!(max(far_up, far_down) > threshold)) return false;
  vertices_[count] = far_up >= far_down ? up : down;
  return true;
}

// Extends `known` points that span a point, a line or a plane to four points that span a volume.
bool ExpandingPolytope::extend(int known, DVec3& flat_normal) {
  const double thin = kFlat * pair_.size();
  const DVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (known < 2) {
    int i = 0;
    while (i < 3 && !take_extreme(axes[i], 1, thin)) ++i;
    flat_normal = {0, 1, 0};
    if (i == 3) return false;
  }
  const DVec3 along = vertices_[1].difference - vertices_[0].difference;
  if (known < 3) {
    const DVec3 size{absolute(along.x), absolute(along.y), absolute(along.z)};
    const DVec3 crosswise = size.x <= size.y && size.x <= size.z ? axes[0]
                            : size.y <= size.z                   ? axes[1]
                                                                 : axes[2];
    DVec3 u = cross(along, crosswise);
    u = u / length(u);
    DVec3 v = cross(along, u);
    v = v / length(v);
    flat_normal = u;
    if (!take_extreme(u, 2, thin) && !take_extreme(v, 2, thin)) return false;
  }
  DVec3 normal = cross(along, vertices_[2].difference - vertices_[0].difference);
  normal = normal / length(normal);
  flat_normal = normal;
  return take_extreme(normal, 3, thin);
}

bool ExpandingPolytope::start(const CoreDistance& start, DVec3& flat_normal) {
  // Take the corners of the GJK simplex that are well apart.
  const double thin = 1.0e-6 * pair_.size();
  int known = 0;
  for (int i = 0; i < start.simplex_count; ++i) {
    const DVec3 p = start.simplex[i].difference;
    bool is_apart = true;
    if (known == 1) is_apart = length(p - vertices_[0].difference) > thin;
    if (known >= 2) {
      const DVec3 along = vertices_[1].difference - vertices_[0].difference;
      const DVec3 across = cross(along, p - vertices_[0].difference);
      is_apart = length(across) > thin * length(along);
      if (is_apart && known == 3) {
        const DVec3 normal = cross(along, vertices_[2].difference - vertices_[0].difference);
        is_apart = absolute(dot(normal, p - vertices_[0].difference)) > thin * length(normal);
      }
    }
    if (is_apart) vertices_[known++] = start.simplex[i];
  }
  if (known == 0) {
    vertices_[0] = pair_.support({0, 1, 0});
    known = 1;
  }
  if (known < 4 && !extend(known, flat_normal)) return false;
  vertex_count_ = 4;
  const DVec3 o = vertices_[0].difference;
  if (dot(cross(vertices_[1].difference - o, vertices_[2].difference - o), vertices_[3].difference - o) >
      0.0) {
    const DifferencePoint swap = vertices_[1];
    vertices_[1] = vertices_[2];
    vertices_[2] = swap;
  }
  // Corner 3 lies below the face 0 1 2.
  constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  constexpr std::uint8_t kNeighbors[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
  for (int f = 0; f < 4; ++f) {
    new_face(kFaces[f][0], kFaces[f][1], kFaces[f][2]);
    for (int e = 0; e < 3; ++e) faces_[f].neighbor[e] = kNeighbors[f][e];
  }
  return true;
}

int ExpandingPolytope::nearest() const {
  double smallest = kNoDistance;
  for (int i = 0; i < face_count_; ++i) smallest = min(smallest, distances_[i]);
  for (int i = 0; i < face_count_; ++i) {
    if (distances_[i] == smallest && faces_[i].alive) return i;
  }
  return -1;
}

int ExpandingPolytope::nearest(DVec3 outward, double cosine) const {
  int best = -1;
  for (int i = 0; i < face_count_; ++i) {
    if (!faces_[i].alive || dot(faces_[i].normal, outward) < cosine) continue;
    if (best < 0 || faces_[i].distance < faces_[best].distance) best = i;
  }
  return best;
}

bool ExpandingPolytope::add(const DifferencePoint& point, int first) {
  if (vertex_count_ == kMaxPolytopeVertices) return false;
  const int apex = vertex_count_;
  vertices_[vertex_count_++] = point;
  // Flood over the faces that the point lies above. The edges at their border are the horizon.
  std::uint8_t visible_faces[kMaxPolytopeFaces];
  int visible_count = 0;
  struct Edge {
    std::uint8_t from, to, outside;
  };
  Edge horizon[kMaxPolytopeFaces];
  int horizon_count = 0;
  faces_[first].visible = true;
  visible_faces[visible_count++] = std::uint8_t(first);
  for (int k = 0; k < visible_count; ++k) {
    for (int e = 0; e < 3; ++e) {
      const int beyond = faces_[visible_faces[k]].neighbor[e];
      Face& other = faces_[beyond];
      if (other.visible) continue;
      // A face without area goes with the faces around it.
      if (other.distance == kNoDistance || dot(other.normal, point.difference) > other.distance) {
        other.visible = true;
        visible_faces[visible_count++] = std::uint8_t(beyond);
      }
    }
  }
  for (int k = 0; k < visible_count; ++k) {
    const Face& face = faces_[visible_faces[k]];
    for (int e = 0; e < 3; ++e) {
      if (faces_[face.neighbor[e]].visible) continue;
      horizon[horizon_count++] = {face.v[e], face.v[e == 2 ? 0 : e + 1], face.neighbor[e]};
    }
  }
  const auto refuse = [&] {
    for (int k = 0; k < visible_count; ++k) faces_[visible_faces[k]].visible = false;
    --vertex_count_;
    return false;
  };
  // At each corner of the horizon exactly one edge must start and one must end, or the surface would fold.
  std::int16_t starting_at[kMaxPolytopeVertices], ending_at[kMaxPolytopeVertices];
  for (int i = 0; i < vertex_count_; ++i) starting_at[i] = ending_at[i] = -1;
  for (int k = 0; k < horizon_count; ++k) {
    if (starting_at[horizon[k].from] >= 0 || ending_at[horizon[k].to] >= 0) return refuse();
    starting_at[horizon[k].from] = std::int16_t(k);
    ending_at[horizon[k].to] = std::int16_t(k);
  }
  if (horizon_count < 3 || face_count_ + horizon_count - free_count_ > kMaxPolytopeFaces) return refuse();
  for (int k = 0; k < visible_count; ++k) {
    faces_[visible_faces[k]].alive = false;
    distances_[visible_faces[k]] = kNoDistance;
    free_[free_count_++] = visible_faces[k];
  }
  std::uint8_t made[kMaxPolytopeFaces];
  for (int k = 0; k < horizon_count; ++k)
    made[k] = std::uint8_t(new_face(horizon[k].from, horizon[k].to, apex));
  for (int k = 0; k < horizon_count; ++k) {
    Face& face = faces_[made[k]];
    face.neighbor[0] = horizon[k].outside;
    face.neighbor[1] = made[starting_at[horizon[k].to]];
    face.neighbor[2] = made[ending_at[horizon[k].from]];
    Face& outside = faces_[horizon[k].outside];
    for (int e = 0; e < 3; ++e) {
      if (outside.v[e] == horizon[k].to && outside.v[e == 2 ? 0 : e + 1] == horizon[k].from)
        outside.neighbor[e] = made[k];
    }
  }
  return true;
}

void ExpandingPolytope::witness(DVec3 target, DVec3 outward, DVec3& on_a, DVec3& on_b) const {
  double squared_limit = kNoDistance;
  // A flat side of the difference consists of many triangles; the one below the target has the pair. A face that looks
  // the other way may be as close (both exits may be equally long) but has other points. It serves only if the face
  // that gave the direction has been expanded since.
  double side = -2.0;
  for (int i = 0; i < face_count_; ++i) {
    if (faces_[i].alive && faces_[i].distance < kNoDistance) side = max(side, dot(faces_[i].normal, outward));
  }
  side = min(side, kSameSide);
  for (int i = 0; i < face_count_; ++i) {
    const Face& face = faces_[i];
    if (!face.alive || face.distance == kNoDistance || dot(face.normal, outward) < side) continue;
    // No point of a face is closer than its plane.
    if (square(dot(face.normal, target) - face.distance) > kSurelyFarther * squared_limit) continue;
    const DifferencePoint &a = vertices_[face.v[0]], &b = vertices_[face.v[1]], &c = vertices_[face.v[2]];
    const SimplexPoint near = closest_on_triangle(target, a.difference, b.difference, c.difference);
    const double squared = length_squared(near.point - target);
    if (!(squared < squared_limit)) continue;
    squared_limit = squared;
    on_a = near.weights[0] * a.on_a + near.weights[1] * b.on_a + near.weights[2] * c.on_a;
    on_b = near.weights[0] * a.on_b + near.weights[1] * b.on_b + near.weights[2] * c.on_b;
  }
}

// Flat differences (two segments, a point and a square ...) overlap without depth. The shortest exit is perpendicular
// to them.
CorePenetration across(const CorePair& pair, const CoreDistance& start, DVec3 normal) {
  CorePenetration out;
  // The side on which the support is closer, or the one towards B's centre if both are equal.
  if (dot(pair.center_of_b(), normal) < 0.0) normal = -normal;
  const double forward = pair.separation(normal), backward = pair.separation(-normal);
  out.normal = forward >= backward ? normal : -normal;
  out.depth = -max(forward, backward);
  out.on_a = start.on_a;
  out.on_b = start.on_a - out.depth * out.normal;
  return out;
}

}  // namespace

CorePenetration core_penetration(const CorePair& pair, const CoreDistance& start) {
  ExpandingPolytope polytope(pair);
  DVec3 flat_normal;
  if (!polytope.start(start, flat_normal)) return across(pair, start, flat_normal);
  CorePenetration best;
  best.depth = kNoDistance;
  const double gap = kDepthGap * pair.size();
  while (true) {
    ++best.iterations;
    // If a whole ring of directions is equally good (a capsule inside a cone, on one axis), the search would spread
    // over all of it. Past half of the memory it stays close to the best direction.
    const bool everywhere = polytope.vertex_count() < kMaxPolytopeVertices / 2;
    const int i = everywhere ? polytope.nearest() : polytope.nearest(-best.normal, kNearBest);
    if (i < 0) break;
    const Face face = polytope.face(i);
    if (face.distance == kNoDistance) break;
    const DifferencePoint w = pair.support(face.normal);
    const double depth = dot(w.difference, face.normal);
    // This is the depth along the normal, whatever the rest of the polytope looks like.
    if (depth < best.depth) {
      best.depth = depth;
      best.normal = -face.normal;
    }
    if (depth - face.distance <= gap || !polytope.add(w, i)) break;
  }
  polytope.witness(-best.depth * best.normal, -best.normal, best.on_a, best.on_b);
  return best;
}

}  // namespace gyre
