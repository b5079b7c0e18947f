// Makes the entry of a rope, cloth or solid from its definition, which is checked first. A pure function: the same definition gives the same
// bits.
#pragma once

#include "soft/store/soft_store.h"

#include <gyre/result.h>

namespace gyre {

constexpr int kMaxSoftVertices = 1 << 20;  // of one rope, cloth or solid

// Says why a definition is refused; code none if it is not. The message names the field, what was found and what is expected.
Error check_soft(const RopeDef& def);
Error check_soft(const ClothDef& def);
Error check_soft(const SolidDef& def);

// The definition must have passed its check.
SoftEntry build_soft(std::shared_ptr<const SoftDef> def);

// The body of a cloth or solid from the elements of its damage. Springs of such a cloth lie along the edges of its triangles.
SoftBody build_elements(const SoftEntry& entry);
// Where the particles of a cloth, or of a solid that may be damaged, were at rest before it was torn or broken.
Array<DVec3> whole_places(const SoftEntry& entry);
// Where the particles of such a body are at rest. The sides of the cracks of a solid are a thickness apart.
Array<DVec3> rest_places(const SoftEntry& entry);
// The triangles of the surface, from the elements of its damage, and what contacts need of them. The particles are where they are at rest, so that it is
// the same whenever it is made.
void build_surface(SoftEntry& entry);

}  // namespace gyre
