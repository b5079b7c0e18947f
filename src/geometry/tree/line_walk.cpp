// Chooses how many boxes are tested side by side on this machine.
#include "geometry/tree/line_walk.h"

#include "base/processor.h"
#include "geometry/tree/line_walk_lanes.h"

namespace gyre {

#if defined(__x86_64__)
extern const WalkLine<StaticNode> kWalkStaticLine_avx2;
#endif

WalkLine<StaticNode> select_static_line_walk() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kWalkStaticLine_avx2;
#endif
  return walk_line<4, StaticNode>;
}

}  // namespace gyre
