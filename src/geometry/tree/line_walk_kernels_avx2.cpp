// Walks along lines for one kind of CPU, in a namespace of its own so that the linker can never mix it with others'.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "geometry/tree/line_walk_lanes.h"

namespace gyre {

extern const WalkLine<StaticNode> kWalkStaticLine_avx2;
const WalkLine<StaticNode> kWalkStaticLine_avx2 = walk_line<8, StaticNode>;

}  // namespace gyre
