// Tells a recorder what a scene knows and its world does not, so that who looks at the recording sees the same: names, colours,
// and where a good picture is taken from.
#pragma once

#include "scene/scene_runner.h"

#include <gyre/replay.h>

#include <optional>
#include <string>
#include <string_view>

namespace gyre {

void label_bodies(Recorder& recorder, const SceneRunner& runner);

// The note "scene": a JSON object with name, time_step (s) and, if the scene has one, view {eye, target, field_of_view}.
std::string scene_note(const Scene& scene);
// The view in such a note; none if it has none or cannot be read.
std::optional<SceneView> view_of_note(std::string_view note);

}  // namespace gyre
