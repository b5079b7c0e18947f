#include "world/query/soft_query.h"

#include "geometry/shape/shape.h"
#include "math/rotation.h"
#include "world/soft_commands.h"
#include "world/world_state.h"

namespace gyre {

namespace {

// Fits the boxes of all soft matter to its present vertices, once after a change.
void show_soft(WorldState& s) {
  if (s.soft_boxes_made_at.load(std::memory_order_acquire) == s.changes) return;
  const std::lock_guard<std::mutex> lock(s.query_lock);
  if (s.soft_boxes_made_at.load(std::memory_order_relaxed) == s.changes) return;
  s.soft_box_memory.reset();
  s.soft_boxes.resize(s.soft.entries.size());
  for (std::size_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    if (s.soft.entries[slot].def != nullptr)
      s.soft_boxes[slot] = fit_soft_boxes(s.soft.entries[slot], s.soft_box_memory);
  }
  s.soft_boxes_made_at.store(s.changes, std::memory_order_release);
}

bool accepts(const WorldState& s, const QueryFilter& filter, std::uint32_t slot) {
  const SoftEntry& entry = s.soft.entries[slot];
  if (entry.def == nullptr || (entry.settings().filter.layer & filter.layers) == 0) return false;
  return filter.accepts_soft == nullptr || filter.accepts_soft(filter.user, soft_id(s, slot));
}

void find_hits(WorldState& s, const SoftCast& cast, const QueryFilter& filter, double max_fraction,
               SoftHitVisit found) {
  show_soft(s);
  for (std::uint32_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    SoftHit hit;
    if (!accepts(s, filter, slot)) continue;
    if (!cast_at_soft(s.soft.entries[slot], s.soft_boxes[slot], cast, max_fraction, filter.back_faces, hit))
      continue;
    CastHit out;
    out.soft = soft_id(s, slot);
    out.triangle = std::int32_t(hit.part);
    out.point = hit.point, out.normal = hit.normal, out.fraction = hit.fraction;
    out.inside = hit.inside, out.depth = hit.depth;
    out.weights = {hit.weights[0], hit.weights[1], hit.weights[2]};
    max_fraction = min(max_fraction, found(out));
    if (max_fraction < 0.0) return;
  }
}

}  // namespace

bool asks_soft(const WorldState& s, const QueryFilter& filter) { return filter.soft && !s.soft.empty(); }

void find_soft_hits(WorldState& s, const Ray& ray, const QueryFilter& filter, double max_fraction,
                    SoftHitVisit found) {
  SoftCast cast;
  cast.position = ray.origin, cast.translation = DVec3(ray.translation);
  find_hits(s, cast, filter, max_fraction, found);
}

void find_soft_hits(WorldState& s, const ShapeCast& question, const QueryFilter& filter, double max_fraction,
                    SoftHitVisit found) {
  const Shape shape = make_shape(question.shape);
  SoftCast cast;
  cast.shape = &shape;
  cast.position = question.pose.position, cast.orientation = normalized(to_double(question.pose.orientation));
  cast.translation = DVec3(question.translation), cast.skin = question.skin;
  find_hits(s, cast, filter, max_fraction, found);
}

void find_soft_overlaps(WorldState& s, const ShapePose& question, const QueryFilter& filter,
                        FunctionRef<bool(const Overlap& overlap)> found) {
  const Shape shape = make_shape(question.shape);
  SoftCast place;
  place.shape = &shape;
  place.position = question.pose.position,
  place.orientation = normalized(to_double(question.pose.orientation));
  show_soft(s);
  for (std::uint32_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    std::uint32_t part = kNoTriangle;
    if (!accepts(s, filter, slot) || !overlaps_soft(s.soft.entries[slot], s.soft_boxes[slot], place, part))
      continue;
    Overlap out;
    out.soft = soft_id(s, slot);
    out.triangle = part == kNoTriangle ? -1 : std::int32_t(part);
    if (!found(out)) return;
  }
}

}  // namespace gyre
