// Layers of ropes, cloths and solids in draw_debug.
#pragma once

#include "debug/painter.h"
#include "soft/store/soft_store.h"

namespace gyre {

// Every edge of a surface once, and the segments of ropes; a point for each vertex that is pinned (red) or attached to a body (blue).
void draw_soft_edges(const SoftStore& softs, Painter& paint);
// A point for each contact of a vertex, and its normal out of the shape.
void draw_soft_contacts(const SoftStore& softs, Painter& paint);

}  // namespace gyre
