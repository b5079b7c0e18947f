#include "bench/scenes/builders.h"

namespace gyre::bench {

Shape box(V3 h) {
  Shape s;
  s.kind = Kind::box;
  s.half = h;
  return s;
}
Shape sphere(double r) {
  Shape s;
  s.kind = Kind::sphere;
  s.radius = r;
  return s;
}
Shape capsule(double r, double half_length) {
  Shape s;
  s.kind = Kind::capsule;
  s.radius = r;
  s.half_length = half_length;
  return s;
}
Shape hull(int i) {
  Shape s;
  s.kind = Kind::hull;
  s.data = i;
  return s;
}

int add(Scene& sc, Shape s, V3 p, Quat q, Motion m, double density) {
  Body b;
  b.motion = m;
  b.layer = m == Motion::fixed ? Layer::fixed : Layer::normal;
  b.pos = p;
  b.q = q;
  b.density = density;
  b.shapes.push_back(s);
  sc.bodies.push_back(std::move(b));
  return int(sc.bodies.size()) - 1;
}
void ground(Scene& sc, double half) { add(sc, box({half, 1, half}), {0, -1, 0}, {}, Motion::fixed); }

// A square pit: floor at y = 0, inner half width w, walls up to height h.
void pit(Scene& sc, double w, double h) {
  ground(sc, w + 2);
  add(sc, box({1, h / 2, w + 2}), {w + 1, h / 2, 0}, {}, Motion::fixed);
  add(sc, box({1, h / 2, w + 2}), {-w - 1, h / 2, 0}, {}, Motion::fixed);
  add(sc, box({w, h / 2, 1}), {0, h / 2, w + 1}, {}, Motion::fixed);
  add(sc, box({w, h / 2, 1}), {0, h / 2, -w - 1}, {}, Motion::fixed);
}

// Faces, edges, volume and centroid of the convex hull of a few points, by brute force.
static Hull make_hull(std::vector<V3> pts) {
  Hull h;
  auto build = [&](std::vector<V3>& normals, std::vector<V3>& edges, double& vol, V3& cen) {
    normals.clear();
    edges.clear();
    vol = 0;
    cen = {};
    int n = int(pts.size());
    std::vector<double> off;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j)
        for (int k = j + 1; k < n; ++k) {
          V3 m = cross(pts[j] - pts[i], pts[k] - pts[i]);
          if (len(m) < 1e-9) continue;
          m = unit(m);
          double d = dot(m, pts[i]);
          bool pos = false, neg = false;
          for (auto& p : pts) {
            double s = dot(m, p) - d;
            if (s > 1e-9) pos = true;
            if (s < -1e-9) neg = true;
          }
          if (pos && neg) continue;
          if (pos) {
            m = -m;
            d = -d;
          }
          V3 a = pts[i], b = pts[pos ? k : j], c = pts[pos ? j : k];
          double v6 = dot(a, cross(b, c));
          vol += v6 / 6;
          cen = cen + (v6 / 24) * (a + b + c);
          normals.push_back(m);
          off.push_back(d);
        }
    cen = (1 / vol) * cen;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) {
        int shared = 0;
        for (size_t f = 0; f < normals.size(); ++f)
          if (std::fabs(dot(normals[f], pts[i]) - off[f]) < 1e-9 &&
              std::fabs(dot(normals[f], pts[j]) - off[f]) < 1e-9)
            ++shared;
        if (shared >= 2) edges.push_back(unit(pts[j] - pts[i]));
      }
  };
  V3 c;
  build(h.face_normals, h.edge_directions, h.volume, c);
  for (auto& p : pts) p = p - c;
  build(h.face_normals, h.edge_directions, h.volume, c);
  h.v = pts;
  return h;
}

// Points on an ellipsoid: every one of them is a vertex of the hull.
static Hull random_hull(Lcg& g, int vertices, double size) {
  V3 r{size * g.range(0.8, 1.2), size * g.range(0.8, 1.2), size * g.range(0.8, 1.2)};
  std::vector<V3> p;
  while (int(p.size()) < vertices) {
    V3 d = g.dir();
    bool near = false;
    for (auto& o : p)
      if (len(V3{o.x / r.x, o.y / r.y, o.z / r.z} - d) < 0.35) near = true;
    if (!near) p.push_back({d.x * r.x, d.y * r.y, d.z * r.z});
  }
  return make_hull(p);
}
void add_hulls(Scene& sc, int templates, int vertices, double size, uint64_t seed) {
  Lcg g(seed);
  for (int i = 0; i < templates; ++i) sc.hulls.push_back(random_hull(g, vertices, size));
}

// Volume of one shape, so that a driver whose engine does not take densities can set the mass.
double volume(const Scene& sc, const Shape& s) {
  switch (s.kind) {
    case Kind::sphere:
      return 4.0 / 3 * kPi * s.radius * s.radius * s.radius;
    case Kind::box:
      return 8 * s.half.x * s.half.y * s.half.z;
    case Kind::capsule:
      return kPi * s.radius * s.radius * 2 * s.half_length + 4.0 / 3 * kPi * s.radius * s.radius * s.radius;
    case Kind::hull:
      return sc.hulls[s.data].volume;
    default:
      return 0;
  }
}
double mass(const Scene& sc, const Body& b) { return b.density * volume(sc, b.shapes[0]); }

}  // namespace gyre::bench
