// The surroundings of a mesh's triangles: which triangle lies beyond each edge, what is one flat patch, and which edges and
// corners are real ones.
//
// Fills twins, flags, normals and flat_lanes of a Mesh whose vertices, indices and tree are set.
#pragma once

#include "geometry/shape/mesh.h"

namespace gyre {

void connect_triangles(Mesh& mesh);

}  // namespace gyre
