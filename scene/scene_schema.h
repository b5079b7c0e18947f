// The JSON Schema of a scene file.
#pragma once

#include <string>

namespace gyre {

std::string scene_schema();

}  // namespace gyre
