// Chooses how many pairs are filtered side by side on this machine.
#include "soft/contact/feature_filter.h"

#include "base/processor.h"
#include "soft/contact/feature_filter_lanes.h"

namespace gyre {

#if defined(__x86_64__)
extern const FeatureFilters kFeatureFilters_avx2;
#endif

namespace {
constexpr FeatureFilters kFeatureFilters = feature_filters<4>();
}

const FeatureFilters& select_feature_filters() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kFeatureFilters_avx2;
#endif
  return kFeatureFilters;
}

}  // namespace gyre
