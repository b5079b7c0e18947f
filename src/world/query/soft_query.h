// Ray casts, shape casts and overlaps against all soft matter of a world, as public results. In: questions that were checked. Out: results one
// by one in the order of slots, which the caller sorts. Boxes are fitted by the first query after a change.
#pragma once

#include "base/function_ref.h"

#include <gyre/queries.h>

namespace gyre {

struct WorldState;

// True if the filter asks for soft matter and there is any.
bool asks_soft(const WorldState& s, const QueryFilter& filter);

// Reports the first hit of each rope, cloth and solid up to a fraction. `found` returns the new fraction, below 0 to end.
using SoftHitVisit = FunctionRef<double(const CastHit& hit)>;
void find_soft_hits(WorldState& s, const Ray& ray, const QueryFilter& filter, double max_fraction,
                    SoftHitVisit found);
void find_soft_hits(WorldState& s, const ShapeCast& cast, const QueryFilter& filter, double max_fraction,
                    SoftHitVisit found);
// Reports overlaps until `found` returns false.
void find_soft_overlaps(WorldState& s, const ShapePose& shape, const QueryFilter& filter,
                        FunctionRef<bool(const Overlap& overlap)> found);

}  // namespace gyre
