// JSON text to a document, with limits. Strict JSON (RFC 8259): no comments, no NaN, no repeated keys. Never recurses on the
// input's depth. Inside the scene folder errors travel as exceptions of type SceneError; the public functions return them.
#pragma once

#include "scene/scene_error.h"
#include "scene/scene_limits.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace gyre {

// Keeps the order of keys.
using Json = nlohmann::ordered_json;

// `file` is named in errors. Throws SceneError.
Json parse_document(std::string_view text, const std::string& file, const SceneLimits& limits);

// One step of a JSON pointer, with '~' and '/' escaped as RFC 6901 says.
void append_pointer(std::string& pointer, std::string_view key);

}  // namespace gyre
