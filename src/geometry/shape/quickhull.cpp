// Quickhull with exact side tests on an integer grid. See quickhull.h.
#include "geometry/shape/quickhull.h"

namespace gyre {
namespace {

using Int = std::int64_t;

constexpr int kNone = -1;

struct HullFace {
  int vertex[3];
  int neighbor[3];  // across the edge from vertex[i] to the next
  Int normal[3];    // exact: each component is below 2^53
  double inverse_length;
  int first_outside;  // list of the points that see this triangle and are not inserted yet
  int farthest;
  double farthest_distance;
  bool alive;
  bool sees_point;  // from the point that is being inserted
};

DVec3 to_double(const GridPoint& p) { return {double(p.x), double(p.y), double(p.z)}; }

// An order in which the first and the last point of any set are corners of its hull.
bool lexicographic_less(const GridPoint& a, const GridPoint& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

// The exact sign of n . d for |n| components up to 2^53 and |d| components up to 2^27, in two words of 28 and 64 bits.
int exact_sign(const Int n[3], const Int d[3]) {
  constexpr int kBits = 28;
  constexpr Int kMask = (Int(1) << kBits) - 1;
  Int high = 0, low = 0;
  for (int i = 0; i < 3; ++i) {
    high += (n[i] >> kBits) * d[i];
    low += (n[i] & kMask) * d[i];
  }
  high += low >> kBits;
  low &= kMask;
  if (high != 0) return high < 0 ? -1 : 1;
  return low != 0 ? 1 : 0;
}

class GridHullBuilder {
 public:
  GridHullBuilder(std::span<const GridPoint> points, const QuickhullLimits& limits)
      : points_(points), limits_(limits), next_(points.size(), kNone), start_at_(points.size(), kNone) {}

  GridSpan start(std::span<const int> candidates);
  void insert_all(std::span<const int> first);
  bool grow();
  GridHull result(GridSpan span, bool complete) const;

 private:
  int count(std::span<const int> some) const { return some.empty() ? int(points_.size()) : int(some.size()); }
  static int pick(std::span<const int> some, int i) { return some.empty() ? i : some[std::size_t(i)]; }
  const GridPoint& at(int point) const { return points_[std::size_t(point)]; }
  HullFace& face(int i) { return faces_[std::size_t(i)]; }
  const HullFace& face(int i) const { return faces_[std::size_t(i)]; }

  int side(const HullFace& t, int point, double& distance) const;
  int add_face(int a, int b, int c);
  void assign(int point, std::span<const int> faces);
  int find_visible(int point) const;
  void insert(int point, int visible);
  void find_horizon(int point, int visible);
  bool find_farthest_from_plane(int& point, int& visible) const;
  bool find_farthest_from_hull(int& point, int& visible);
  double descend(int point, int from) const;
  double distance_to(int point, int f) const;

  std::span<const GridPoint> points_;
  QuickhullLimits limits_;
  std::vector<HullFace> faces_;
  std::vector<int> free_;
  std::vector<int> order_;
  std::vector<int> next_;      // list of waiting points of a face
  std::vector<int> start_at_;  // the new face whose edge on the horizon starts at this point
  // Scratch of one insertion.
  struct HorizonEdge {
    int from, to, beyond;
  };
  std::vector<HorizonEdge> horizon_;
  std::vector<int> removed_, fresh_, orphans_;
};

// The side of the triangle's plane on which the point lies, and its distance (rounded, so not reliable for the sign).
int GridHullBuilder::side(const HullFace& t, int point, double& distance) const {
  const GridPoint& p = at(point);
  const GridPoint& a = at(t.vertex[0]);
  const Int d[3] = {Int(p.x) - a.x, Int(p.y) - a.y, Int(p.z) - a.z};
  const double value = double(t.normal[0]) * double(d[0]) + double(t.normal[1]) * double(d[1]) +
                       double(t.normal[2]) * double(d[2]);
  distance = value * t.inverse_length;
  // Five roundings of at most 2^81 * 2^-53 each.
  constexpr double kCertain = 2147483648.0;
  if (value > kCertain) return 1;
  if (value < -kCertain) return -1;
  return exact_sign(t.normal, d);
}

int GridHullBuilder::add_face(int a, int b, int c) {
  HullFace t{};
  t.vertex[0] = a;
  t.vertex[1] = b;
  t.vertex[2] = c;
  const GridPoint &pa = at(a), &pb = at(b), &pc = at(c);
  const Int u[3] = {Int(pb.x) - pa.x, Int(pb.y) - pa.y, Int(pb.z) - pa.z};
  const Int v[3] = {Int(pc.x) - pa.x, Int(pc.y) - pa.y, Int(pc.z) - pa.z};
  t.normal[0] = u[1] * v[2] - u[2] * v[1];
  t.normal[1] = u[2] * v[0] - u[0] * v[2];
  t.normal[2] = u[0] * v[1] - u[1] * v[0];
  t.inverse_length = 1.0 / length(DVec3(double(t.normal[0]), double(t.normal[1]), double(t.normal[2])));
  for (int& neighbor : t.neighbor) neighbor = kNone;
  t.first_outside = t.farthest = kNone;
  t.farthest_distance = 0.0;
  t.alive = true;
  if (free_.empty()) {
    faces_.push_back(t);
    return int(faces_.size()) - 1;
  }
  const int slot = free_.back();
  free_.pop_back();
  face(slot) = t;
  return slot;
}

// Puts the point on the list of the face from which it is farthest. A point that sees no face is inside.
void GridHullBuilder::assign(int point, std::span<const int> faces) {
  int best = kNone;
  double best_distance = 0.0;
  for (const int f : faces) {
    double distance;
    if (side(face(f), point, distance) <= 0) continue;
    if (best == kNone || distance > best_distance) {
      best = f;
      best_distance = distance;
    }
  }
  if (best == kNone) return;
  HullFace& t = face(best);
  next_[std::size_t(point)] = t.first_outside;
  t.first_outside = point;
  // Among equally far points the last in order, which is a corner of their hull.
  if (t.farthest == kNone || best_distance > t.farthest_distance ||
      (best_distance == t.farthest_distance && lexicographic_less(at(t.farthest), at(point)))) {
    t.farthest = point;
    t.farthest_distance = best_distance;
  }
}

// The first tetrahedron: the ends along the longest axis, the point farthest from their line, and the one farthest from
// the plane of these three.
GridSpan GridHullBuilder::start(std::span<const int> candidates) {
  const int n = count(candidates);
  int low[3], high[3];
  const auto axis_of = [&](int point, int axis) {
    const GridPoint& p = at(point);
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  };
  for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = pick(candidates, 0);
  for (int i = 1; i < n; ++i) {
    const int p = pick(candidates, i);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t value = axis_of(p, axis);
      const std::int32_t lowest = axis_of(low[axis], axis), highest = axis_of(high[axis], axis);
      if (value < lowest || (value == lowest && lexicographic_less(at(p), at(low[axis])))) low[axis] = p;
      if (value > highest || (value == highest && lexicographic_less(at(high[axis]), at(p)))) high[axis] = p;
    }
  }
  int longest = 0;
  const auto extent = [&](int axis) { return axis_of(high[axis], axis) - axis_of(low[axis], axis); };
  for (int axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
  if (double(extent(longest)) <= limits_.flat) return GridSpan::point;

  const int a = low[longest], b = high[longest];
  const auto farthest = [&](auto&& measure, double& best) {
    int winner = kNone;
    best = 0.0;
    for (int i = 0; i < n; ++i) {
      const int p = pick(candidates, i);
      const double distance = measure(to_double(at(p)));
      if (distance > best || (distance == best && winner != kNone && lexicographic_less(at(winner), at(p)))) {
        best = distance;
        winner = p;
      }
    }
    return winner;
  };
  const DVec3 pa = to_double(at(a));
  const DVec3 ab = to_double(at(b)) - pa;
  const DVec3 along = ab / length(ab);
  double far = 0.0;
  const int c = farthest([&](DVec3 p) { return length(cross(along, p - pa)); }, far);
  if (c == kNone || far <= limits_.flat) return GridSpan::line;
  const DVec3 across = cross(ab, to_double(at(c)) - pa);
  const DVec3 n_abc = across / length(across);
  const int d = farthest([&](DVec3 p) { return absolute(dot(n_abc, p - pa)); }, far);
  if (d == kNone || far <= limits_.flat) return GridSpan::plane;

  const bool d_above = dot(n_abc, to_double(at(d)) - pa) > 0.0;
  const int v[4] = {a, d_above ? c : b, d_above ? b : c, d};  // (v0, v1, v2) faces away from v3
  add_face(v[0], v[1], v[2]);
  add_face(v[0], v[3], v[1]);
  add_face(v[1], v[3], v[2]);
  add_face(v[2], v[3], v[0]);
  constexpr int kNeighbors[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
  for (int f = 0; f < 4; ++f) {
    for (int e = 0; e < 3; ++e) face(f).neighbor[e] = kNeighbors[f][e];
  }
  order_ = {v[0], v[1], v[2], v[3]};
  return GridSpan::volume;
}

int GridHullBuilder::find_visible(int point) const {
  int best = kNone;
  double best_distance = 0.0;
  for (int f = 0; f < int(faces_.size()); ++f) {
    double distance;
    if (!face(f).alive || side(face(f), point, distance) <= 0) continue;
    if (best == kNone || distance > best_distance) {
      best = f;
      best_distance = distance;
    }
  }
  return best;
}

// Inserts the points of `first`, then assigns all others to the faces that they see.
void GridHullBuilder::insert_all(std::span<const int> first) {
  for (const int p : first) {
    const int visible = find_visible(p);
    if (visible != kNone) insert(p, visible);
  }
  if (limits_.vertices <= int(order_.size())) return;
  std::vector<int> alive;
  for (int f = 0; f < int(faces_.size()); ++f) {
    if (face(f).alive) alive.push_back(f);
  }
  for (int p = 0; p < int(points_.size()); ++p) assign(p, alive);
}

// Collects the faces that see `point` (they are connected) in removed_, and the edges around them in horizon_.
void GridHullBuilder::find_horizon(int point, int visible_face) {
  removed_.assign(1, visible_face);
  horizon_.clear();
  face(visible_face).sees_point = true;
  for (std::size_t i = 0; i < removed_.size(); ++i) {
    const HullFace& t = face(removed_[i]);
    for (int e = 0; e < 3; ++e) {
      HullFace& other = face(t.neighbor[e]);
      if (other.sees_point) continue;
      double distance;
      if (side(other, point, distance) > 0) {
        other.sees_point = true;
        removed_.push_back(t.neighbor[e]);
      } else {
        horizon_.push_back({t.vertex[e], t.vertex[(e + 1) % 3], t.neighbor[e]});
      }
    }
  }
}

void GridHullBuilder::insert(int point, int visible_face) {
  find_horizon(point, visible_face);
  orphans_.clear();
  for (const int f : removed_) {
    for (int p = face(f).first_outside; p != kNone; p = next_[std::size_t(p)]) {
      if (p != point) orphans_.push_back(p);
    }
    face(f).alive = face(f).sees_point = false;
  }
  // `point` is on no line of a horizon edge, because the removed face at the edge sees it. So no new face is flat.
  fresh_.clear();
  for (const HorizonEdge& edge : horizon_) {
    const int f = add_face(edge.from, edge.to, point);
    fresh_.push_back(f);
    face(f).neighbor[0] = edge.beyond;
    HullFace& beyond = face(edge.beyond);
    for (int e = 0; e < 3; ++e) {
      if (beyond.vertex[e] == edge.to) beyond.neighbor[e] = f;
    }
    start_at_[std::size_t(edge.from)] = f;
  }
  for (const int f : fresh_) {
    const int after = start_at_[std::size_t(face(f).vertex[1])];
    face(f).neighbor[1] = after;
    face(after).neighbor[2] = f;
  }
  for (const int f : removed_) free_.push_back(f);
  order_.push_back(point);
  for (const int p : orphans_) assign(p, fresh_);
}

// Finds the point farthest outside any plane.
bool GridHullBuilder::find_farthest_from_plane(int& point, int& visible) const {
  double best = limits_.tolerance;
  visible = kNone;
  for (int f = 0; f < int(faces_.size()); ++f) {
    const HullFace& t = face(f);
    if (!t.alive || t.farthest == kNone || !(t.farthest_distance > best)) continue;
    best = t.farthest_distance;
    visible = f;
    point = t.farthest;
  }
  return visible != kNone;
}

double GridHullBuilder::distance_to(int point, int f) const {
  const HullFace& t = face(f);
  return distance_to_triangle(to_double(at(point)), to_double(at(t.vertex[0])), to_double(at(t.vertex[1])),
                              to_double(at(t.vertex[2])));
}

// The distance of an outside point from the hull, by steps from face to face while it falls; never too small.
double GridHullBuilder::descend(int point, int from) const {
  double best = distance_to(point, from);
  for (int current = from, before = kNone; current != before;) {
    before = current;
    for (const int neighbor : face(before).neighbor) {
      const double distance = distance_to(point, neighbor);
      if (distance < best) {
        best = distance;
        current = neighbor;
      }
    }
  }
  return best;
}

// Beyond a sharp edge a point can be close to all planes and yet far from the hull. If no plane is exceeded, this tests
// the true distances. Points that are close enough are dropped, because the hull only grows.
bool GridHullBuilder::find_farthest_from_hull(int& point, int& visible) {
  double best = limits_.tolerance;
  visible = kNone;
  for (int f = 0; f < int(faces_.size()); ++f) {
    HullFace& t = face(f);
    if (!t.alive) continue;
    int remaining = kNone;
    for (int p = t.first_outside, following; p != kNone; p = following) {
      following = next_[std::size_t(p)];
      const double distance = descend(p, f);
      if (!(distance > limits_.tolerance)) continue;
      next_[std::size_t(p)] = remaining;
      remaining = p;
      if (distance > best) {
        best = distance;
        visible = f;
        point = p;
      }
    }
    t.first_outside = remaining;
    if (remaining == kNone) t.farthest = kNone;
  }
  return visible != kNone;
}

// Inserts the farthest points until none is outside (true) or the vertices run out (false).
bool GridHullBuilder::grow() {
  int point = kNone, visible = kNone;
  while (find_farthest_from_plane(point, visible) || find_farthest_from_hull(point, visible)) {
    if (int(order_.size()) >= limits_.vertices) return false;
    insert(point, visible);
  }
  return true;
}

GridHull GridHullBuilder::result(GridSpan span, bool complete) const {
  GridHull out;
  out.span = span;
  out.complete = complete;
  std::vector<bool> used(points_.size(), false);
  for (const HullFace& t : faces_) {
    if (!t.alive) continue;
    out.triangles.push_back({{t.vertex[0], t.vertex[1], t.vertex[2]}});
    for (const int v : t.vertex) used[std::size_t(v)] = true;
  }
  // A vertex can lose all its faces to later points.
  for (const int v : order_) {
    if (used[std::size_t(v)]) out.vertices.push_back(v);
  }
  return out;
}

}  // namespace

// Distance of `p` from the triangle (a, b, c), by the closest region of the triangle. C. Ericson, "Real-Time Collision
// Detection", 2005, section 5.1.5.
double distance_to_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return length(ap);
  const DVec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return length(bp);
  const DVec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return length(cp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return length(ap - (d1 / (d1 - d3)) * ab);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return length(ap - (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return length(bp - t * (c - b));
  }
  const DVec3 n = cross(ab, ac);
  const double size = length(n);
  // A triangle without area, after rounding: the corners give an upper bound.
  if (!(size > 0.0)) return min(length(ap), min(length(bp), length(cp)));
  return absolute(dot(n, ap)) / size;
}

GridHull quickhull(std::span<const GridPoint> points, std::span<const int> first,
                   const QuickhullLimits& limits) {
  GridHullBuilder builder(points, limits);
  const GridSpan span = builder.start(first);
  if (span != GridSpan::volume) return builder.result(span, false);
  builder.insert_all(first);
  const bool complete = builder.grow();
  return builder.result(span, complete);
}

double distance_outside(std::span<const GridPoint> points, std::span<const GridTriangle> triangles,
                        const GridPoint& p) {
  bool outside = false;
  double best = 0.0;
  const DVec3 position = to_double(p);
  for (const GridTriangle& t : triangles) {
    const DVec3 a = to_double(points[std::size_t(t.vertices[0])]);
    const DVec3 b = to_double(points[std::size_t(t.vertices[1])]);
    const DVec3 c = to_double(points[std::size_t(t.vertices[2])]);
    const double distance = distance_to_triangle(position, a, b, c);
    if (dot(cross(b - a, c - a), position - a) > 0.0) outside = true;
    if (&t == triangles.data() || distance < best) best = distance;
  }
  return outside ? best : 0.0;
}

}  // namespace gyre
