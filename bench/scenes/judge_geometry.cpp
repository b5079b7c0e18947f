#include "bench/scenes/judge_geometry.h"

#include <algorithm>
#include <limits>

namespace gyre::bench {

Core make_core(const Scene& sc, const Shape& s, const Pose& t, int body) {
  Core c;
  c.body = body;
  switch (s.kind) {
    case Kind::sphere:
      c.v = {t.p};
      c.r = s.radius;
      break;
    case Kind::capsule:
      c.v = {apply(t, {0, s.half_length, 0}), apply(t, {0, -s.half_length, 0})};
      c.edges = {rot(t.q, {0, 1, 0})};
      c.r = s.radius;
      break;
    case Kind::box:
      for (int i = 0; i < 8; ++i)
        c.v.push_back(apply(
            t, {i & 1 ? s.half.x : -s.half.x, i & 2 ? s.half.y : -s.half.y, i & 4 ? s.half.z : -s.half.z}));
      c.normals = {rot(t.q, {1, 0, 0}), rot(t.q, {0, 1, 0}), rot(t.q, {0, 0, 1})};
      c.edges = c.normals;
      break;
    case Kind::hull:
      for (auto& p : sc.hulls[s.data].v) c.v.push_back(apply(t, p));
      for (auto& p : sc.hulls[s.data].face_normals) c.normals.push_back(rot(t.q, p));
      for (auto& p : sc.hulls[s.data].edge_directions) c.edges.push_back(rot(t.q, p));
      break;
    case Kind::mesh:
      break;
  }
  const double inf = std::numeric_limits<double>::infinity();
  c.lo = {inf, inf, inf};
  c.hi = {-inf, -inf, -inf};
  for (auto& p : c.v) {
    c.lo = {std::min(c.lo.x, p.x - c.r), std::min(c.lo.y, p.y - c.r), std::min(c.lo.z, p.z - c.r)};
    c.hi = {std::max(c.hi.x, p.x + c.r), std::max(c.hi.y, p.y + c.r), std::max(c.hi.z, p.z + c.r)};
  }
  return c;
}

namespace {

// Closest point to the origin on the hull of up to four points, by trying every sub-simplex.
V3 closest_on_simplex(std::vector<V3>& s) {
  int n = int(s.size()), best_mask = 0;
  double best = std::numeric_limits<double>::infinity();
  V3 best_point;
  for (int mask = 1; mask < (1 << n); ++mask) {
    int id[4] = {}, k = 0;
    for (int i = 0; i < n; ++i)
      if (mask & (1 << i)) id[k++] = i;
    // Minimise |p0 + sum l_i e_i| with e_i = p_i - p0.
    V3 p0 = s[id[0]];
    double a[3][4] = {};
    V3 e[3];
    for (int i = 1; i < k; ++i) e[i - 1] = s[id[i]] - p0;
    int m = k - 1;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) a[i][j] = dot(e[i], e[j]);
      a[i][m] = -dot(e[i], p0);
    }
    bool ok = true;
    for (int c = 0; c < m && ok; ++c) {
      int piv = c;
      for (int i = c + 1; i < m; ++i)
        if (std::fabs(a[i][c]) > std::fabs(a[piv][c])) piv = i;
      if (std::fabs(a[piv][c]) < 1e-14) {
        ok = false;
        break;
      }
      for (int j = 0; j <= m; ++j) std::swap(a[c][j], a[piv][j]);
      for (int i = 0; i < m; ++i)
        if (i != c) {
          double f = a[i][c] / a[c][c];
          for (int j = c; j <= m; ++j) a[i][j] -= f * a[c][j];
        }
    }
    if (!ok) continue;
    double sum = 0;
    V3 p = p0;
    for (int i = 0; i < m; ++i) {
      double l = a[i][m] / a[i][i];
      if (l < -1e-12) ok = false;
      sum += l;
      p = p + l * e[i];
    }
    if (!ok || sum > 1 + 1e-12) continue;
    double d = dot(p, p);
    if (d < best - 1e-18) {
      best = d;
      best_point = p;
      best_mask = mask;
    }
  }
  std::vector<V3> kept;
  for (int i = 0; i < n; ++i)
    if (best_mask & (1 << i)) kept.push_back(s[i]);
  s.swap(kept);
  return best_point;
}

V3 support(const std::vector<V3>& v, V3 d) {
  double b = -std::numeric_limits<double>::infinity();
  V3 r;
  for (auto& p : v)
    if (dot(p, d) > b) {
      b = dot(p, d);
      r = p;
    }
  return r;
}

double gjk_distance(const std::vector<V3>& a, const std::vector<V3>& b) {
  V3 d = a[0] - b[0];
  std::vector<V3> s{d};
  for (int it = 0; it < 40; ++it) {
    V3 v = closest_on_simplex(s);
    double vv = dot(v, v);
    if (vv < 1e-20 || s.size() == 4) return 0;
    V3 w = support(a, -v) - support(b, v);
    if (vv - dot(v, w) < 1e-10 * vv) return std::sqrt(vv);
    s.push_back(w);
    d = v;
  }
  return len(d);
}

}  // namespace

double gap(const Core& a, const Core& b) {
  double r = a.r + b.r, best = -std::numeric_limits<double>::infinity();
  auto axis = [&](V3 n) {
    double a0 = 1e300, a1 = -1e300, b0 = 1e300, b1 = -1e300;
    for (auto& p : a.v) {
      double s = dot(n, p);
      a0 = std::min(a0, s);
      a1 = std::max(a1, s);
    }
    for (auto& p : b.v) {
      double s = dot(n, p);
      b0 = std::min(b0, s);
      b1 = std::max(b1, s);
    }
    best = std::max(best, std::max(b0 - a1, a0 - b1));
    return best > r + 0.02;
  };
  for (auto& n : a.normals)
    if (axis(n)) return best - r;
  for (auto& n : b.normals)
    if (axis(n)) return best - r;
  for (auto& e : a.edges)
    for (auto& f : b.edges) {
      V3 n = cross(e, f);
      double l = len(n);
      if (l < 1e-6) continue;
      if (axis((1 / l) * n)) return best - r;
    }
  if (best < 0 && best > -1e290 && (!a.normals.empty() || !b.normals.empty())) return best - r;
  return gjk_distance(a.v, b.v) - r;
}

}  // namespace gyre::bench
