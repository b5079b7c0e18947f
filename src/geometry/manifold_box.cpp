// Box against box. See manifold_box.h.
#include "geometry/manifold_box.h"

#include "geometry/clip.h"
#include "geometry/manifold_core.h"
#include "geometry/manifold_crossing.h"
#include "math/rotation.h"
#include "math/wide.h"

#include <bit>

namespace gyre {
namespace {

// Axes by number: 0 to 2 A's face normals, 3 to 5 B's, 6 + 3 i + j the cross product of A's axis i and B's axis j.
constexpr int kFirstB = 3, kFirstEdge = 6, kAxisCount = 15, kNoAxis = -1;
constexpr int kNext[3] = {1, 2, 0}, kAfter[3] = {2, 0, 1};

// How much better an axis must be to replace the favoured one: a part of the depth and of the thinnest half extent.
constexpr float kDepthBias = 0.05f, kSizeBias = 1.0e-3f;
// Squared sine between two edges below which they have no axis of their own (the faces' axes serve), and below which
// float rounding would show, so that the axis is worked out again in double.
constexpr float kParallel = 1.0e-8f, kShallow = 1.0e-2f;
// A face's points stand for the contact if the deepest of them is within this part of the thinnest half extent, and of an
// overlap within that part of the depth too.
constexpr float kMissed = 1.0e-3f, kLost = 0.1f;
// Error of a separation times a cross product's length, relative to the sum of all lengths in it.
constexpr float kRounding = 4.0e-7f;

// Both boxes in A's frame: r[i][j] is the component along A's axis i of B's axis j; c the same without signs.
struct Boxes {
  float a[3], b[3];  // half extents
  float r[3][3], c[3][3];
  float t[3];  // B's centre in A's frame
  float u[3];  // the same vector in B's axes
};

void fill(Boxes& boxes, const Shape& a, const Shape& b, const Transform& a_from_b) {
  const Mat3 m = to_matrix(a_from_b.orientation);
  const Vec3 columns[3] = {m.x, m.y, m.z};
  const Vec3 t = a_from_b.position;
  boxes.a[0] = a.extents.x, boxes.a[1] = a.extents.y, boxes.a[2] = a.extents.z;
  boxes.b[0] = b.extents.x, boxes.b[1] = b.extents.y, boxes.b[2] = b.extents.z;
  boxes.t[0] = t.x, boxes.t[1] = t.y, boxes.t[2] = t.z;
  for (int j = 0; j < 3; ++j) {
    boxes.r[0][j] = columns[j].x, boxes.r[1][j] = columns[j].y, boxes.r[2][j] = columns[j].z;
    boxes.u[j] = dot(columns[j], t);
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) boxes.c[i][j] = absolute(boxes.r[i][j]);
  }
}

inline float thinnest(const Boxes& x) {
  return min(min(min(x.a[0], x.a[1]), x.a[2]), min(min(x.b[0], x.b[1]), x.b[2]));
}
inline float face_a(const Boxes& x, int i) {
  return absolute(x.t[i]) - x.a[i] - (x.b[0] * x.c[i][0] + x.b[1] * x.c[i][1] + x.b[2] * x.c[i][2]);
}
inline float face_b(const Boxes& x, int j) {
  return absolute(x.u[j]) - x.b[j] - (x.a[0] * x.c[0][j] + x.a[1] * x.c[1][j] + x.a[2] * x.c[2][j]);
}

// Separation times the length of the cross product (the same, for three of them at once, in EdgeRow).
inline float edge_product(const Boxes& x, int i, int j) {
  const int i1 = kNext[i], i2 = kAfter[i], j1 = kNext[j], j2 = kAfter[j];
  const float apart = absolute(x.t[i2] * x.r[i1][j] - x.t[i1] * x.r[i2][j]);
  const float reach_a = x.a[i1] * x.c[i2][j] + x.a[i2] * x.c[i1][j];
  const float reach_b = x.b[j1] * x.c[i][j2] + x.b[j2] * x.c[i][j1];
  return apart - reach_a - reach_b;
}
inline float edge_length_squared(const Boxes& x, int i, int j) {
  return x.r[kNext[i]][j] * x.r[kNext[i]][j] + x.r[kAfter[i]][j] * x.r[kAfter[i]][j];
}

// The edges of A's axis i with all three of B's, side by side: as edge_product() and edge_length_squared().
struct EdgeRow {
  using Floats = Wide<4>;
  Floats product, squared;

  EdgeRow(const Boxes& x, int i) {
    const int i1 = kNext[i], i2 = kAfter[i];
    const Floats r1 = row(x.r[i1], 0), r2 = row(x.r[i2], 0), c1 = row(x.c[i1], 0), c2 = row(x.c[i2], 0);
    const Floats apart = absolute(Floats(x.t[i2]) * r1 - Floats(x.t[i1]) * r2);
    const Floats reach_a = Floats(x.a[i1]) * c2 + Floats(x.a[i2]) * c1;
    const Floats reach_b = row(x.b, 1) * row(x.c[i], 2) + row(x.b, 2) * row(x.c[i], 1);
    product = apart - reach_a - reach_b;
    squared = r1 * r1 + r2 * r2;
  }

 private:
  // Three numbers, from the k-th on.
  static Floats row(const float* n, int k) {
    return Floats::of(Floats::Float{n[k], n[(k + 1) % 3], n[(k + 2) % 3], 0.0f});
  }
};

// Separation along the cross product of two nearly parallel edges, free of cancellation.
float shallow_edge(const Boxes& x, const Transform& a_from_b, int i, int j) {
  const DQuat q = normalized(to_double(a_from_b.orientation));
  const DVec3 columns[3] = {rotate(q, DVec3{1, 0, 0}), rotate(q, DVec3{0, 1, 0}), rotate(q, DVec3{0, 0, 1})};
  const DVec3 edge_a{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
  const DVec3 axis = cross(edge_a, columns[j]);
  double reach = 0.0;
  for (int k = 0; k < 3; ++k) {
    reach += double(x.a[k]) * absolute(axis[k]) + double(x.b[k]) * absolute(dot(columns[k], axis));
  }
  const double n = length(axis);
  return n > 0.0 ? float((absolute(dot(DVec3(a_from_b.position), axis)) - reach) / n) : -kUnbounded;
}

float edge_separation(const Boxes& x, const Transform& a_from_b, int i, int j) {
  const float squared = edge_length_squared(x, i, j);
  if (squared <= kParallel) return -kUnbounded;
  if (squared < kShallow) return shallow_edge(x, a_from_b, i, j);
  return edge_product(x, i, j) / std::sqrt(squared);
}

float separation_along(const Boxes& x, const Transform& a_from_b, int axis) {
  if (axis < kFirstB) return face_a(x, axis);
  if (axis < kFirstEdge) return face_b(x, axis - kFirstB);
  return edge_separation(x, a_from_b, (axis - kFirstEdge) / 3, (axis - kFirstEdge) % 3);
}

struct Axis {
  int number = kNoAxis;
  float separation = -kUnbounded;
};

// The axis that decides. Stops at the first along which the boxes are farther apart than allowed.
Axis search(const Boxes& x, const Transform& a_from_b, float max_separation, int favoured) {
  float s[kFirstEdge];
  for (int i = 0; i < 3; ++i) s[i] = face_a(x, i);
  for (int j = 0; j < 3; ++j) s[kFirstB + j] = face_b(x, j);
  Axis face{0, s[0]};
  for (int k = 1; k < kFirstEdge; ++k) {
    if (s[k] > face.separation) face = {k, s[k]};
  }
  if (face.separation > max_separation) return face;
  const float bias = kDepthBias * absolute(face.separation) + kSizeBias * thinnest(x);

  // Edges are worth a look only when they beat the face by more than half of the bias.
  Axis edge;
  const float floor = face.separation + 0.5f * bias;
  float extent = 0.0f;
  for (int i = 0; i < 3; ++i) extent += x.a[i] + x.b[i] + absolute(x.t[i]);
  const float rounding = kRounding * extent;
  const Wide<4> low(min(floor, 0.0f)), shallow(kShallow), parallel(kParallel);
  for (int i = 0; i < 3; ++i) {
    const EdgeRow row(x, i);
    // Without the root: a length is at most 1, so a product below a negative floor, or below 0, cannot win.
    const Mask<4> steep = row.squared >= shallow;
    const Mask<4> hopeless = (steep & (row.product <= low)) | and_not(row.squared <= parallel, steep);
    for (std::uint32_t left = to_bits(~hopeless) & 7u; left != 0; left &= left - 1) {
      const int j = std::countr_zero(left);
      const float squared = row.squared[j], product = row.product[j];
      float separation;
      if (squared >= kShallow) {
        separation = product / std::sqrt(squared);
      } else {
        if (product + rounding <= floor * std::sqrt(squared)) continue;
        separation = shallow_edge(x, a_from_b, i, j);
      }
      if (separation > edge.separation) edge = {kFirstEdge + 3 * i + j, separation};
    }
  }
  if (edge.separation > max_separation) return edge;

  // Among nearly equal ones: the favoured, then the lowest face, then edges.
  if (favoured >= kFirstEdge) {
    const float kept = separation_along(x, a_from_b, favoured);
    if (kept > floor && kept >= edge.separation - bias) return {favoured, kept};
  } else if (favoured >= 0 && s[favoured] >= face.separation - bias &&
             edge.separation <= face.separation + bias) {
    return {favoured, s[favoured]};
  }
  if (edge.number != kNoAxis && edge.separation > face.separation + bias) return edge;
  for (int k = 0; k < kFirstEdge; ++k) {
    if (s[k] >= face.separation - 0.5f * bias) return {k, s[k]};
  }
  return face;
}

// ---------------------------------------------------------------------------------------------------------- clipping

// The reference box and the other one in its frame.
struct Roles {
  const float* reference;  // half extents
  const float* incident;
  float m[3][3];  // reference_from_incident: m[i][k] component along axis i of the incident's axis k
  float c[3];     // the incident's centre
  bool reference_is_a;
};

void assign(Roles& roles, const Boxes& x, bool reference_is_a) {
  roles.reference_is_a = reference_is_a;
  roles.reference = reference_is_a ? x.a : x.b;
  roles.incident = reference_is_a ? x.b : x.a;
  for (int i = 0; i < 3; ++i) {
    roles.c[i] = reference_is_a ? x.t[i] : -x.u[i];
    for (int k = 0; k < 3; ++k) roles.m[i][k] = reference_is_a ? x.r[i][k] : x.r[k][i];
  }
}

// A corner of the incident face over the reference face: u and v along that face, w its height above it.
struct Corner {
  float u, v, w;
  std::uint32_t feature;
  std::uint32_t edge;  // the edge that leaves it: one of the incident's 12, or kSide + one of the four sides
};
constexpr std::uint32_t kSide = 16;

// Corners are numbered by the signs of their coordinates (bit 0: x positive ...), edges by the axis they follow and the
// signs of the two others.
std::uint32_t edge_number(int axis, std::uint32_t corner) {
  return std::uint32_t(axis) * 4u + ((corner >> kNext[axis]) & 1u) + 2u * ((corner >> kAfter[axis]) & 1u);
}

struct Sides {
  std::uint32_t edge[4];  // the reference's edge at u = +, u = -, v = +, v = -
  std::uint32_t corner;   // corner bits of the reference face with u and v negative
  std::uint32_t bit_u, bit_v;
  bool reference_is_a;

  std::uint32_t name(std::uint32_t polygon_edge, std::uint32_t side) const {
    if (polygon_edge < kSide) {
      return reference_is_a ? feature_edges(edge[side], polygon_edge)
                            : feature_edges(polygon_edge, edge[side]);
    }
    const std::uint32_t other = polygon_edge - kSide;
    const std::uint32_t side_u = side < 2 ? side : other, side_v = side < 2 ? other : side;
    const std::uint32_t id = corner | (side_u == 0 ? bit_u : 0u) | (side_v == 2 ? bit_v : 0u);
    return reference_is_a ? feature_vertex_a(id) : feature_vertex_b(id);
  }
};

// Cuts the polygon at u <= limit (or, mirrored, u >= -limit; or the same of v). Returns the corners left.
template <bool kAlongV>
int cut(const Corner* in, int count, float sign, float limit, std::uint32_t side, const Sides& sides,
        Corner* out) {
  int kept = 0;
  float distance = sign * (kAlongV ? in[0].v : in[0].u) - limit;
  for (int i = 0; i < count; ++i) {
    const Corner& from = in[i];
    const Corner& to = in[i + 1 == count ? 0 : i + 1];
    const float distance_to = sign * (kAlongV ? to.v : to.u) - limit;
    const bool inside = distance <= 0.0f;
    if (inside) out[kept++] = from;
    if (inside != (distance_to <= 0.0f) && kept < 8) {
      const float t = distance / (distance - distance_to);
      Corner& corner = out[kept++];
      corner.u = kAlongV ? from.u + t * (to.u - from.u) : sign * limit;
      corner.v = kAlongV ? sign * limit : from.v + t * (to.v - from.v);
      corner.w = from.w + t * (to.w - from.w);
      corner.feature = sides.name(from.edge, side);
      corner.edge = inside ? kSide + side : from.edge;
    }
    distance = distance_to;
  }
  return kept;
}

// The four corners of the incident face whose normal is +-axis k, in order around it.
void incident_corners(const Roles& roles, int axis, float facing, int k, Corner* out) {
  const int iu = kNext[axis], iv = kAfter[axis], k1 = kNext[k], k2 = kAfter[k];
  const float down = facing * roles.m[axis][k] > 0.0f ? -1.0f : 1.0f;
  const float hk = down * roles.incident[k], h1 = roles.incident[k1], h2 = roles.incident[k2];
  const float top = roles.reference[axis];
  const float cu = roles.c[iu] + hk * roles.m[iu][k], cv = roles.c[iv] + hk * roles.m[iv][k];
  const float cw = facing * (roles.c[axis] + hk * roles.m[axis][k]) - top;
  const float u1 = h1 * roles.m[iu][k1], v1 = h1 * roles.m[iv][k1], w1 = facing * h1 * roles.m[axis][k1];
  const float u2 = h2 * roles.m[iu][k2], v2 = h2 * roles.m[iv][k2], w2 = facing * h2 * roles.m[axis][k2];
  const std::uint32_t base = down > 0.0f ? 1u << k : 0u, bit1 = 1u << k1, bit2 = 1u << k2;
  const std::uint32_t corner[4] = {base | bit1 | bit2, base | bit2, base, base | bit1};
  out[0] = {cu + u1 + u2, cv + v1 + v2, cw + w1 + w2, corner[0], edge_number(k1, corner[0])};
  out[1] = {cu - u1 + u2, cv - v1 + v2, cw - w1 + w2, corner[1], edge_number(k2, corner[1])};
  out[2] = {cu - u1 - u2, cv - v1 - v2, cw - w1 - w2, corner[2], edge_number(k1, corner[2])};
  out[3] = {cu + u1 - u2, cv + v1 - v2, cw + w1 - w2, corner[3], edge_number(k2, corner[3])};
  for (int i = 0; i < 4; ++i) {
    out[i].feature = roles.reference_is_a ? feature_vertex_b(corner[i]) : feature_vertex_a(corner[i]);
  }
}

// Cuts the incident face to the reference rectangle; corners above max_separation are dropped. At most 8.
int clip_rectangle(const Roles& roles, int axis, float facing, int k, float max_separation, Corner* out) {
  const int iu = kNext[axis], iv = kAfter[axis];
  const float hu = roles.reference[iu], hv = roles.reference[iv];
  Corner first[9], second[9];
  Corner* polygon = first;
  Corner* other = second;
  incident_corners(roles, axis, facing, k, polygon);
  float low_u = polygon[0].u, high_u = low_u, low_v = polygon[0].v, high_v = low_v;
  for (int i = 1; i < 4; ++i) {
    low_u = min(low_u, polygon[i].u), high_u = max(high_u, polygon[i].u);
    low_v = min(low_v, polygon[i].v), high_v = max(high_v, polygon[i].v);
  }
  if (low_u > hu || high_u < -hu || low_v > hv || high_v < -hv) return 0;
  Sides sides;
  sides.reference_is_a = roles.reference_is_a;
  sides.corner = facing > 0.0f ? 1u << axis : 0u;
  sides.bit_u = 1u << iu;
  sides.bit_v = 1u << iv;
  sides.edge[0] = edge_number(iv, sides.corner | sides.bit_u);
  sides.edge[1] = edge_number(iv, sides.corner);
  sides.edge[2] = edge_number(iu, sides.corner | sides.bit_v);
  sides.edge[3] = edge_number(iu, sides.corner);
  int count = 4;
  const auto advance = [&](int kept) {
    count = kept;
    Corner* swap = polygon;
    polygon = other;
    other = swap;
  };
  if (high_u > hu) advance(cut<false>(polygon, count, 1.0f, hu, 0, sides, other));
  if (low_u < -hu) advance(cut<false>(polygon, count, -1.0f, hu, 1, sides, other));
  if (high_v > hv && count > 0) advance(cut<true>(polygon, count, 1.0f, hv, 2, sides, other));
  if (low_v < -hv && count > 0) advance(cut<true>(polygon, count, -1.0f, hv, 3, sides, other));
  int kept = 0;
  for (int i = 0; i < count && kept < 8; ++i) {
    if (polygon[i].w <= max_separation) out[kept++] = polygon[i];
  }
  return kept;
}

// Leaves out.count at 0 when no face of one lies over the other's.
void collide_face(const Boxes& x, const Transform& a_from_b, const Axis& found, float max_separation,
                  LocalManifold& out) {
  const bool reference_is_a = found.number < kFirstB;
  const int axis = reference_is_a ? found.number : found.number - kFirstB;
  Roles roles;
  assign(roles, x, reference_is_a);
  const float facing = roles.c[axis] < 0.0f ? -1.0f : 1.0f;
  // The incident face opposes the reference most; if it lies beside it, the next two are tried.
  const float slope[3] = {absolute(roles.m[axis][0]), absolute(roles.m[axis][1]), absolute(roles.m[axis][2])};
  int order[3];
  order[0] = slope[0] >= slope[1] ? (slope[0] >= slope[2] ? 0 : 2) : (slope[1] >= slope[2] ? 1 : 2);
  order[1] = kNext[order[0]], order[2] = kAfter[order[0]];
  if (slope[order[2]] > slope[order[1]]) order[1] = kAfter[order[0]], order[2] = kNext[order[0]];
  Corner corners[8];
  int count = 0;
  for (int i = 0; i < 3 && count == 0; ++i) {
    count = clip_rectangle(roles, axis, facing, order[i], max_separation, corners);
  }
  if (count == 0) return;
  ManifoldPoint points[8];
  const int iu = kNext[axis], iv = kAfter[axis];
  const float top = facing * roles.reference[axis];
  for (int i = 0; i < count; ++i) {
    float p[3];
    p[iu] = corners[i].u;
    p[iv] = corners[i].v;
    p[axis] = top + 0.5f * facing * corners[i].w;
    const Vec3 position{p[0], p[1], p[2]};
    points[i] = {position, corners[i].w, corners[i].feature};
  }
  float n[3] = {0, 0, 0};
  n[axis] = facing;
  Vec3 normal{n[0], n[1], n[2]};
  if (count > kMaxManifoldPoints) count = reduce_points(points, count, normal);
  if (!reference_is_a) {
    const auto turn = [&](Vec3 v) {
      return Vec3{x.r[0][0] * v.x + x.r[0][1] * v.y + x.r[0][2] * v.z,
                  x.r[1][0] * v.x + x.r[1][1] * v.y + x.r[1][2] * v.z,
                  x.r[2][0] * v.x + x.r[2][1] * v.y + x.r[2][2] * v.z};
    };
    normal = normalized(turn(-normal));
    for (int i = 0; i < count; ++i) points[i].position = turn(points[i].position) + a_from_b.position;
  }
  out.normal = normal;
  out.count = count;
  for (int i = 0; i < count; ++i) out.points[i] = points[i];
}

// In float for edges that cross at an angle, in double for those nearly parallel: where they cross is then a quotient of small
// differences, and the normal one of nothing else.
struct FloatEdges {
  using Real = float;
  using Vector = Vec3;
  Vector columns[3];  // B's axes in A's frame
  FloatEdges(const Boxes& x, const Transform&)
      : columns{{x.r[0][0], x.r[1][0], x.r[2][0]},
                {x.r[0][1], x.r[1][1], x.r[2][1]},
                {x.r[0][2], x.r[1][2], x.r[2][2]}} {}
  static Vec3 unit(Vec3 v) { return normalized(v); }
  static Vec3 to_float(Vec3 v) { return v; }
};
struct DoubleEdges {
  using Real = double;
  using Vector = DVec3;
  Vector columns[3];
  DoubleEdges(const Boxes&, const Transform& a_from_b) {
    const DQuat q = normalized(to_double(a_from_b.orientation));
    for (int k = 0; k < 3; ++k)
      columns[k] = rotate(q, DVec3{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0});
  }
  static DVec3 unit(DVec3 v) { return v / length(v); }
  static Vec3 to_float(DVec3 v) { return gyre::to_float(v); }
};

// Leaves out.count at 0 when the edges pass beside each other: of boxes apart another feature is nearer, and of those that
// overlap the faces beside nearly parallel edges were as good.
template <class Edges>
void collide_edges(const Boxes& x, const Transform& a_from_b, const Axis& found, LocalManifold& out) {
  using Real = typename Edges::Real;
  using Vector = typename Edges::Vector;
  const Edges edges(x, a_from_b);
  const int i = (found.number - kFirstEdge) / 3, j = (found.number - kFirstEdge) % 3;
  const Vector edge_a{Real(i == 0), Real(i == 1), Real(i == 2)};
  const Vector edge_b = edges.columns[j];
  const Vector across = cross(edge_a, edge_b);
  Vector normal = Edges::unit(across);
  const Vector t{Real(a_from_b.position.x), Real(a_from_b.position.y), Real(a_from_b.position.z)};
  if (dot(normal, t) < Real(0)) normal = -normal;
  // The edge of each box that is farthest along the normal towards the other.
  Real on_a[3], on_b_local[3];
  std::uint32_t corner_a = 0, corner_b = 0;
  for (int k = 0; k < 3; ++k) {
    const bool up_a = normal[k] > Real(0);
    on_a[k] = k == i ? Real(0) : Real(up_a ? x.a[k] : -x.a[k]);
    corner_a |= up_a ? 1u << k : 0u;
    const bool up_b = dot(normal, edges.columns[k]) < Real(0);
    on_b_local[k] = k == j ? Real(0) : Real(up_b ? x.b[k] : -x.b[k]);
    corner_b |= up_b ? 1u << k : 0u;
  }
  const Vector pa{on_a[0], on_a[1], on_a[2]};
  Vector pb = t;
  for (int k = 0; k < 3; ++k) pb += on_b_local[k] * edges.columns[k];
  // Nearest points of the two lines: both edges are unit, and not parallel.
  const Vector d = pb - pa;
  const Real c = dot(edge_a, edge_b), da = dot(d, edge_a), db = dot(d, edge_b);
  const Real det = across[kNext[i]] * across[kNext[i]] + across[kAfter[i]] * across[kAfter[i]];
  const Real along_a = (da - c * db) / det, along_b = (c * da - db) / det;
  const Real end_a = clamp(along_a, Real(-x.a[i]), Real(x.a[i])),
             end_b = clamp(along_b, Real(-x.b[j]), Real(x.b[j]));
  const Vector on_edge_a = pa + end_a * edge_a, on_edge_b = pb + end_b * edge_b;
  // Not across each other: an end is nearest.
  if ((end_a != along_a || end_b != along_b) &&
      (found.separation > 0.0f ||
       length(on_edge_b - on_edge_a) > Real((1.0f + kLost) * -found.separation + kMissed * thinnest(x))))
    return;
  out.normal = Edges::to_float(normal);
  out.count = 1;
  out.points[0].position = Edges::to_float(Real(0.5) * (on_edge_a + on_edge_b));
  out.points[0].separation = found.separation;
  out.points[0].feature = feature_edges(edge_number(i, corner_a), edge_number(j, corner_b));
}

// The face whose normal is within kNearFace of the axis of two edges; none if there is none.
Axis face_near_edges(const Boxes& x, const Axis& edges) {
  const int i = (edges.number - kFirstEdge) / 3, j = (edges.number - kFirstEdge) % 3;
  const Vec3 edge_a{i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
  const Vec3 normal = normalized(cross(edge_a, Vec3{x.r[0][j], x.r[1][j], x.r[2][j]}));
  Axis best;
  float nearest = kNearFace;
  for (int k = 0; k < 3; ++k) {
    const float along_a = absolute(normal[k]);
    if (along_a > nearest) nearest = along_a, best = {k, face_a(x, k)};
    const float along_b = absolute(dot(normal, Vec3{x.r[0][k], x.r[1][k], x.r[2][k]}));
    if (along_b > nearest) nearest = along_b, best = {kFirstB + k, face_b(x, k)};
  }
  return best;
}

float deepest_of(const LocalManifold& manifold) {
  float least = kUnbounded;
  for (int i = 0; i < manifold.count; ++i) least = min(least, manifold.points[i].separation);
  return least;
}

// See manifold_crossing.h.
void collide_crossing(const Boxes& x, const Transform& a_from_b, const Axis& edges, float max_separation,
                      LocalManifold& out) {
  const Axis face = face_near_edges(x, edges);
  if (face.number != kNoAxis) {
    collide_face(x, a_from_b, face, max_separation, out);
    if (stands_for_crossing(out, edges.separation, thinnest(x))) return;
    out.count = 0;
  }
  const int i = (edges.number - kFirstEdge) / 3, j = (edges.number - kFirstEdge) % 3;
  if (edge_length_squared(x, i, j) < kShallow) {
    collide_edges<DoubleEdges>(x, a_from_b, edges, out);
  } else {
    collide_edges<FloatEdges>(x, a_from_b, edges, out);
  }
}

}  // namespace

void collide_boxes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out) {
  Boxes x;
  fill(x, a, b, a_from_b);
  out.count = 0;
  // The axis that decided last time: most pairs that did not touch then do not touch now.
  const int favoured = cache.words[0] <= std::uint32_t(kAxisCount) ? int(cache.words[0]) - 1 : kNoAxis;
  if (favoured >= 0 && separation_along(x, a_from_b, favoured) > max_separation) return;
  const Axis found = search(x, a_from_b, max_separation, favoured);
  cache.words[0] = std::uint32_t(found.number + 1);
  if (found.separation > max_separation) return;
  if (found.number >= kFirstEdge) {
    collide_crossing(x, a_from_b, found, max_separation, out);
  } else {
    collide_face(x, a_from_b, found, max_separation, out);
    // Nearest, or deepest, beside the face.
    const float lost = deepest_of(out) - found.separation;
    if (lost > kMissed * thinnest(x) + kLost * max(-found.separation, 0.0f)) out.count = 0;
  }
  // Near, or even overlapping, but beside each other's faces.
  if (out.count == 0) collide_cores(a, b, a_from_b, max_separation, cache, out);
}

}  // namespace gyre
