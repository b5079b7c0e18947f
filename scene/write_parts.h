// Parts of the scene writer: what its files share. See scene_writer.h.
#pragma once

#include "scene/json_writer.h"
#include "scene/scene.h"
#include "scene/scene_color.h"

#include <optional>

namespace gyre {

// Writes the member only if it differs from what its absence means.
template <class T>
void unless_default(JsonWriter& json, const char* key, const T& value, const T& otherwise) {
  if (!(value == otherwise)) json.field(key, value);
}

template <class T>
void if_given(JsonWriter& json, const char* key, const std::optional<T>& value) {
  if (value) json.field(key, *value);
}

inline void write_color(JsonWriter& json, const std::optional<SceneColor>& color) {
  if (color) json.field("color", color_text(*color));
}

template <class V>
void write_points(JsonWriter& json, const char* key, const std::vector<V>& points) {
  json.key(key).begin_array();
  for (const V& point : points) json.value(point);
  json.end_array();
}

// Writes the members ropes, cloths and soft_bodies of a scene, those that are not empty.
void write_soft_matter(JsonWriter& json, const Scene& scene);
// Writes the members gases and liquids.
void write_fluids(JsonWriter& json, const Scene& scene);

}  // namespace gyre
