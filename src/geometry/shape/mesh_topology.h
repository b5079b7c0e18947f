// The neighbourhood of a mesh's triangles: the triangle beyond each edge, flat patches, and active edges and corners.
//
// Fills twins, flags, normals and flat_lanes of a Mesh whose vertices, indices and tree are set.
#pragma once

#include "geometry/shape/mesh.h"

namespace gyre {

void connect_triangles(Mesh& mesh);

}  // namespace gyre
