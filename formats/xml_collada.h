// COLLADA meshes (.dae): the triangles of all geometries that the scene of the file shows, in metres.
//
// In: the bytes of a file. Out: one mesh, in the frame of the file; its up axis is passed over, as robots in URDF expect. Materials, skins,
// lines, cameras and lights are passed over. Refusals are thrown as SceneError.
#pragma once

#include "formats/import_parts.h"

#include <string>
#include <string_view>

namespace gyre {

bool is_collada(std::string_view path);  // by the end of the name

MeshData read_collada(const Import& import, std::string_view bytes, const std::string& file);

}  // namespace gyre
