// Recordings as files: their bytes, and what a recording holds.
#pragma once

#include "scene/scene_limits.h"

#include <cstddef>
#include <string>
#include <vector>

namespace gyre {

// The limits of a scene, but for files of 4 GiB.
SceneLimits recording_limits();

// True if the file, or standard input ("-"), can be read and begins as a recording does.
bool is_recording(const std::string& path);

// All bytes of a recording, at most 4 GiB. Returns the reason if that fails, else an empty text.
std::string read_recording(const std::string& path, std::vector<std::byte>& bytes);

// gyre info of a recording: steps, frames, accuracy, bodies with their names. The exit status.
int show_recording(const std::string& path, bool as_json);

}  // namespace gyre
