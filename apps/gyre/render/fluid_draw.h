// Gases and liquids as things to draw: smoke as a volume, a flat gas as a picture on a plane, a liquid as its surface.
#pragma once

#include "render/draw_list.h"

namespace gyre {

void add_fluid(const SeenFluid& fluid, const Subject& subject, DrawList& list);

}  // namespace gyre
