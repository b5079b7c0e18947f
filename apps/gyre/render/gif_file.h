// Movies as GIF: one palette for all frames, and of each frame only what changed.
#pragma once

#include "render/picture.h"

#include <string>
#include <vector>

namespace gyre {

// The bytes of a file that shows the frames over and over, each for `seconds` (kept in hundredths on average, as the format has
// no finer). Empty and an error if that fails.
std::string gif_bytes(const std::vector<Picture>& frames, double seconds, std::string& error);

}  // namespace gyre
