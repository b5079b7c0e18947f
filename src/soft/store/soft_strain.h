// The strain in the elements of ropes, cloths and solids, for readings: stretch less 1, above 0 where they are drawn and below where they are pressed. Of the principal strains of a
// triangle or tetrahedron it is the one of largest size.
#pragma once

#include "soft/store/soft_store.h"

namespace gyre {

// Segments of a rope, triangles of a cloth in the order of SoftEntry::triangles, tetrahedra of a solid in that of their blocks.
Array<float> find_strains(const SoftEntry& entry);

}  // namespace gyre
