// Programs for the graphics card.
#pragma once

#include <epoxy/gl.h>

#include <string>

namespace gyre {

// The texts of a vertex and a pixel shader as one program; `error` in words if they are refused, else empty.
GLuint make_program(const char* vertex, const char* pixel, std::string& error);

}  // namespace gyre
