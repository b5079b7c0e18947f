// For gyre info: what bounding volumes of a mesh cost, and how tight they are.
#pragma once

#include "scene/json_writer.h"
#include "scene/scene.h"

#include <string>

namespace gyre {

// A paragraph for people, and an object.
void append_mesh_bounds(std::string& out, const SceneMesh& mesh);
void write_mesh_bounds(JsonWriter& json, const SceneMesh& mesh);

}  // namespace gyre
