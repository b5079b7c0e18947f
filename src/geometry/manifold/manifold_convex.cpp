// The table of methods by kinds. See manifold_convex.h.
#include "geometry/manifold/manifold_convex.h"

#include "geometry/manifold/manifold_box.h"
#include "geometry/manifold/manifold_core.h"
#include "geometry/manifold/manifold_hull.h"
#include "geometry/manifold/manifold_round.h"
#include "math/wide.h"

namespace gyre {
namespace {

bool is_rounded(const Shape& shape) { return shape.kind == ShapeKind::box && shape.radius > 0.0f; }

// is_finite() for all seven numbers at once: a finite number less itself is 0.
bool all_finite(const Transform& t) {
  const Wide<4> position = Wide<4>::of(Wide<4>::Float{t.position.x, t.position.y, t.position.z, 0.0f});
  const Wide<4> rotation = Wide<4>::load_unaligned(&t.orientation.x);
  return all((position - position) + (rotation - rotation) == 0.0f);
}

constexpr ContactMethod R = ContactMethod::round, B = ContactMethod::boxes, P = ContactMethod::polyhedra,
                        C = ContactMethod::cores;
constexpr ContactMethod kMethods[6][6] = {
    //            sphere box capsule cylinder cone hull
    /* sphere   */ {R, R, R, R, R, R},
    /* box      */ {R, B, C, C, C, P},
    /* capsule  */ {R, C, R, C, C, C},
    /* cylinder */ {R, C, C, C, C, C},
    /* cone     */ {R, C, C, C, C, C},
    /* hull     */ {R, P, C, C, C, P},
};

}  // namespace

const char* to_string(ContactMethod method) {
  constexpr const char* kNames[kContactMethodCount] = {
      "none", "round", "boxes", "polyhedra", "cores", "plane", "seven_features", "axes", "nearest"};
  return kNames[int(method)];
}

ContactMethod contact_method(const Shape& a, const Shape& b) {
  const bool convex_a = is_convex(a.kind), convex_b = is_convex(b.kind);
  if (!convex_a && !convex_b) return ContactMethod::none;
  if (convex_a && convex_b) {
    const ContactMethod method = kMethods[int(a.kind)][int(b.kind)];
    return (method == B || method == P) && (is_rounded(a) || is_rounded(b)) ? C : method;
  }
  const Shape& convex = convex_a ? a : b;
  if ((convex_a ? b : a).kind == ShapeKind::plane) return ContactMethod::plane;
  if (convex.kind == ShapeKind::sphere) return ContactMethod::seven_features;
  const bool curved = convex.kind == ShapeKind::cylinder || convex.kind == ShapeKind::cone;
  return curved ? ContactMethod::nearest : ContactMethod::axes;
}

void collide_convex(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                    PairCache& cache, LocalManifold& out) {
  out.count = 0;
  // Bodies that are about to be removed from the world.
  if (!all_finite(a_from_b)) return;
  switch (contact_method(a, b)) {
    case ContactMethod::round:
      return collide_round(a, b, a_from_b, max_separation, cache, out);
    case ContactMethod::boxes:
      return collide_boxes(a, b, a_from_b, max_separation, cache, out);
    case ContactMethod::polyhedra:
      return collide_polyhedra(a, b, a_from_b, max_separation, cache, out);
    default:
      return collide_cores(a, b, a_from_b, max_separation, cache, out);
  }
}

}  // namespace gyre
