// The table of methods by kinds. See manifold_convex.h.
#include "geometry/manifold_convex.h"

#include "geometry/manifold_box.h"
#include "geometry/manifold_core.h"
#include "geometry/manifold_hull.h"
#include "geometry/manifold_round.h"

namespace gyre {
namespace {

bool is_rounded(const Shape& shape) { return shape.kind == ShapeKind::box && shape.radius > 0.0f; }

constexpr ConvexMethod R = ConvexMethod::round, B = ConvexMethod::boxes, P = ConvexMethod::polyhedra,
                       C = ConvexMethod::cores;
constexpr ConvexMethod kMethods[6][6] = {
    //            sphere box capsule cylinder cone hull
    /* sphere   */ {R, R, R, R, R, R},
    /* box      */ {R, B, C, C, C, P},
    /* capsule  */ {R, C, R, C, C, C},
    /* cylinder */ {R, C, C, C, C, C},
    /* cone     */ {R, C, C, C, C, C},
    /* hull     */ {R, P, C, C, C, P},
};

}  // namespace

const char* to_string(ConvexMethod method) {
  switch (method) {
    case ConvexMethod::round:
      return "round";
    case ConvexMethod::boxes:
      return "boxes";
    case ConvexMethod::polyhedra:
      return "polyhedra";
    default:
      return "cores";
  }
}

ConvexMethod convex_method(ShapeKind a, ShapeKind b) { return kMethods[int(a)][int(b)]; }

void collide_convex(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                    PairCache& cache, LocalManifold& out) {
  out.count = 0;
  // Bodies that are about to be taken out of the world.
  if (!is_finite(a_from_b)) return;
  ConvexMethod method = convex_method(a.kind, b.kind);
  if ((method == B || method == P) && (is_rounded(a) || is_rounded(b))) method = C;
  switch (method) {
    case ConvexMethod::round:
      return collide_round(a, b, a_from_b, max_separation, cache, out);
    case ConvexMethod::boxes:
      return collide_boxes(a, b, a_from_b, max_separation, cache, out);
    case ConvexMethod::polyhedra:
      return collide_polyhedra(a, b, a_from_b, max_separation, cache, out);
    default:
      return collide_cores(a, b, a_from_b, max_separation, cache, out);
  }
}

}  // namespace gyre
