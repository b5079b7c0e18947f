// The filter of pairs for one kind of CPU, in a namespace of its own so that the linker cannot mix kinds.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "soft/contact/feature_filter_lanes.h"

namespace gyre {

extern const FeatureFilters kFeatureFilters_avx2;
const FeatureFilters kFeatureFilters_avx2 = feature_filters<8>();

}  // namespace gyre
