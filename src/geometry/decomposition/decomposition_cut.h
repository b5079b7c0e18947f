// Where to cut a part: planes that could be good, and what each would leave.
//
// Candidates are parallel planes along a few directions (axes of the mesh, principal axes of the part's surface, normals of its
// largest flat concave sides), and the planes of those sides themselves: a beam with an L as its section is cut exactly along
// the side of its notch, however it is turned. The best plane is the one whose two hulls together have the least volume; a
// small weight on short cuts and on even halves decides where volumes do not, as for a ring, whose first cut gains nothing.
//
// Sources: K. Mamou, "Volumetric Hierarchical Approximate Convex Decomposition", 2016 (volume and balance); J.-M. Lien,
// N. Amato, 2007 (cuts through notches); D. Hoffman, M. Singh, "Salience of Visual Parts", 1997 (short cuts).
#pragma once

#include "geometry/decomposition/decomposition_part.h"

#include <vector>

namespace gyre {

// Parallel planes, by ascending offset.
struct CutFamily {
  DVec3 direction;  // unit
  std::vector<double> offsets;
  double gain =
      0.0;  // taken off the cost: for planes along concave sides, which are at the surface of no hull afterwards
};

struct Cut {
  HalfSpace plane;
  double cost = 1.0e300;  // in hull volumes of the part; 1e300: no plane
};

std::vector<CutFamily> find_families(const SampledSolid& solid, const Part& part);
// The best plane of the family; of equal ones the first.
Cut best_of_family(const SampledSolid& solid, const Part& part, const CutFamily& family);
// Whether `a` is better by more than rounding, so that mirrored and scaled meshes are cut alike.
bool clearly_better(const Cut& a, const Cut& b);

}  // namespace gyre
