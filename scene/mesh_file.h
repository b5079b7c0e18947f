// Mesh files of a scene: which paths a scene may name, and Wavefront OBJ, STL and PLY to vertices and triangles.
#pragma once

#include "scene/scene_error.h"
#include "scene/scene_limits.h"

#include <gyre/math.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gyre {

struct MeshData {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
};

// Why a scene may not name this file; empty if it may. Relative paths with forward slashes, never upward, nothing that any
// system reads as a drive, a share, a device or an address.
std::string refuse_mesh_path(std::string_view path);

constexpr std::string_view kStandardInput = "-";  // as a path of read_whole_file

// The whole file, at most limits.file_bytes; a regular file, or standard input. Returns the reason if that fails, else an empty text.
std::string read_whole_file(const std::string& path, const SceneLimits& limits, std::string& bytes);

// Reads a mesh file below `folder` (also through symbolic links it must stay there). `file` of an error is the mesh's path.
SceneResult<MeshData> load_mesh_file(const std::string& folder, const std::string& path,
                                     const SceneLimits& limits);

// Wavefront OBJ: v, f (polygons as fans; negative indices count from the end); normals, texture coordinates, groups and
// materials are passed over. Anything else, an index out of range or a number that is none is refused with its line.
SceneResult<MeshData> parse_obj(std::string_view text, const std::string& file, const SceneLimits& limits);

// STL, text or binary. Equal corners become one vertex; normals and attributes are passed over.
SceneResult<MeshData> parse_stl(std::string_view text, const std::string& file, const SceneLimits& limits);

// PLY, text or binary of either byte order: x, y, z of the element vertex, vertex_indices of the element face (polygons become
// triangles). Other elements and properties are passed over.
SceneResult<MeshData> parse_ply(std::string_view text, const std::string& file, const SceneLimits& limits);

enum class MeshFormat { none, obj, stl, ply };
// By the end of the name.
MeshFormat mesh_format_of(std::string_view path);
// The parser that the name of the file asks for; OBJ where the name says nothing.
SceneResult<MeshData> parse_mesh(std::string_view text, const std::string& file, const SceneLimits& limits);

}  // namespace gyre
