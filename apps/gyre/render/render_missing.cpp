// gyre render in a build without the libraries that draw: says what to install. See render.h.
#include "exit_code.h"
#include "render/render.h"

#include <cstdio>

namespace gyre {

int render(const RenderOptions&) {
  std::fprintf(stderr, "gyre: this gyre was built without pictures, for want of " GYRE_RENDER_MISSING
                       "; install libepoxy-dev libegl-dev libpng-dev libgif-dev libegl1 libgl1 "
                       "libgl1-mesa-dri (Debian's names), "
                       "then configure and build again\n");
  return kExitInvalid;
}

}  // namespace gyre
