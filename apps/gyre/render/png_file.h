// Pictures as PNG.
#pragma once

#include "render/picture.h"

#include <string>

namespace gyre {

// The bytes of the file; empty and an error if there is no memory for it.
std::string png_bytes(const Picture& picture, std::string& error);

}  // namespace gyre
