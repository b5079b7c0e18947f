// The public queries of World: checks, update of the broad phase, sorted results with ids, batches on the workers.
#include <gyre/world.h>

#include "base/float_mode.h"
#include "collision/query/query.h"
#include "task/parallel.h"
#include "world/query_sight.h"
#include "world/refusal.h"
#include "world/query/soft_query.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr int kBlock = 32;  // queries that a worker takes at a time

// ---------------------------------------------------------------------------------------------------------------- checks

Error check_vector(const char* what, const char* field, DVec3 p) {
  if (absolute(p.x) <= kMaxPosition && absolute(p.y) <= kMaxPosition && absolute(p.z) <= kMaxPosition)
    return {};
  return make_error(ErrorCode::invalid_argument,
                    "%s: %s is (%g, %g, %g); every component must be finite and within 1e12 m", what, field,
                    p.x, p.y, p.z);
}

Error check_place(const char* what, const AnyShape& shape, const Pose& pose) {
  const Error e = check_shape(shape);
  if (e) return e;
  const ShapeKind kind = make_shape(shape).kind;
  if (!is_convex(kind)) {
    return make_error(ErrorCode::invalid_geometry, "%s: shape is a %s; only a convex shape can be asked with",
                      what, to_string(kind));
  }
  const Quat q = pose.orientation;
  const float size = dot(q, q);
  if (!is_finite(size) || !(size > 1.0e-12f)) {
    return make_error(
        ErrorCode::invalid_argument,
        "%s: pose.orientation is (%g, %g, %g, %g); it must be a finite quaternion that is not zero", what,
        double(q.x), double(q.y), double(q.z), double(q.w));
  }
  return check_vector(what, "pose.position", pose.position);
}

Error check_distance(double max_distance) {
  if (max_distance >= 0.0) return {};
  return make_error(ErrorCode::invalid_argument, "max_distance is %g m; it must be 0 or more", max_distance);
}

Error check_question(const Ray& ray) { return check_ray(ray); }
Error check_question(const ShapeCast& cast) { return check_shape_cast(cast); }
Error check_question(const ShapePose& shape) { return check_shape_pose(shape); }

// ------------------------------------------------------------------------------------------------------------- the world

bool accepts(const RigidWorld& w, const QueryFilter& filter, std::uint32_t shape) {
  const Proxy& proxy = w.shapes.proxies[shape];
  if ((proxy.filter.layer & filter.layers) == 0 || (proxy.sensor && !filter.sensors)) return false;
  if (filter.ignored && filter.ignored == body_id(w, proxy.body)) return false;
  return filter.accepts == nullptr || filter.accepts(filter.user, shape_id(w, shape), body_id(w, proxy.body));
}

// Calls ask(input) with the input of the collision queries.
template <class Ask>
void ask_world(const WorldState& s, const QueryFilter& filter, Ask&& ask) {
  const RigidWorld& w = s.rigid;
  const auto pose_of = [&](std::uint32_t shape) {
    return origin_pose(w.bodies, w.shapes.bodies[shape]) * w.shapes.body_from_shape[shape];
  };
  const auto is_accepted = [&](std::uint32_t shape) { return accepts(w, filter, shape); };
  const QueryInput input{w.shapes.colliders, w.shapes.proxies, *w.broadphase, pose_of,
                         is_accepted,        filter.back_faces};
  ask(input);
}

WorldShape world_shape(const AnyShape& shape, const Pose& pose) {
  return {make_shape(shape), {pose.position, normalized(pose.orientation)}, {}, 0.0f};
}
WorldShape world_shape(const ShapePose& shape) { return world_shape(shape.shape, shape.pose); }
WorldShape world_shape(const ShapeCast& cast) {
  WorldShape out = world_shape(cast.shape, cast.pose);
  out.translation = cast.translation;
  out.skin = cast.skin;
  return out;
}

// -------------------------------------------------------------------------------------------------------------- answers

// Body, shape and triangle, with which all public results begin.
template <class Answer>
Answer named(const RigidWorld& w, std::uint32_t shape, std::uint32_t triangle) {
  Answer answer;
  answer.body = body_id(w, w.shapes.bodies[shape]);
  answer.shape = shape_id(w, shape);
  for (const ShapeId id : w.bodies.shapes[answer.body.index]) {
    if (id == answer.shape) break;
    ++answer.shape_index;
  }
  answer.triangle = triangle == kNoTriangle ? -1 : std::int32_t(triangle);
  return answer;
}
CastHit public_answer(const RigidWorld& w, const ShapeHit& hit) {
  auto out = named<CastHit>(w, hit.shape, hit.triangle);
  out.point = hit.point;
  out.normal = hit.normal;
  out.fraction = hit.fraction;
  out.inside = hit.inside;
  out.depth = hit.depth;
  return out;
}
ClosestPoint public_answer(const RigidWorld& w, const ShapeNear& near) {
  auto out = named<ClosestPoint>(w, near.shape, near.triangle);
  out.point = near.point;
  out.query_point = near.query_point;
  out.normal = near.normal;
  out.distance = near.distance;
  return out;
}
Penetration public_answer(const RigidWorld& w, const ShapePenetration& deep) {
  auto out = named<Penetration>(w, deep.shape, deep.triangle);
  out.point = deep.point;
  out.normal = deep.normal;
  out.depth = float(deep.depth);
  return out;
}

double measure(const CastHit& hit) { return hit.fraction; }
double measure(const ClosestPoint& near) { return near.distance; }
double measure(const Penetration& deep) { return -double(deep.depth); }
double measure(const Overlap&) { return 0.0; }

template <class Answer>
bool comes_before(const Answer& a, const Answer& b) {
  if (measure(a) != measure(b)) return measure(a) < measure(b);
  if constexpr (requires { a.soft; }) {
    if (a.soft != b.soft) return a.soft && b.soft ? a.soft.index < b.soft.index : bool(b.soft);
  }
  return a.shape.index != b.shape.index ? a.shape.index < b.shape.index : a.triangle < b.triangle;
}

// The first results in order, as many as fit.
template <class Answer>
class FirstAnswers {
 public:
  explicit FirstAnswers(std::span<Answer> out) : out_(out) {}

  void add(const Answer& answer) {
    ++count_;
    std::size_t place = kept_;
    while (place > 0 && comes_before(answer, out_[place - 1])) --place;
    if (place == out_.size()) return;
    if (kept_ < out_.size()) ++kept_;
    for (std::size_t i = kept_ - 1; i > place; --i) out_[i] = out_[i - 1];
    out_[place] = answer;
  }
  std::size_t count() const { return count_; }

 private:
  std::span<Answer> out_;
  std::size_t kept_ = 0, count_ = 0;
};

void cast(const QueryInput& input, const Ray& ray, HitVisit found) {
  cast_ray(input, {ray.origin, ray.translation}, found);
}
void cast(const QueryInput& input, const ShapeCast& shape, HitVisit found) {
  cast_shape(input, world_shape(shape), found);
}

// The nearest hit; an empty one if there is none.
template <class Question>
CastHit nearest_hit(WorldState& s, const Question& question, const QueryFilter& filter) {
  ShapeHit nearest;
  bool any = false;
  ask_world(s, filter, [&](const QueryInput& input) {
    cast(input, question, [&](const ShapeHit& hit) {
      const bool equal = any && hit.fraction == nearest.fraction;
      if (!any || hit.fraction < nearest.fraction || (equal && hit.shape < nearest.shape)) nearest = hit;
      any = true;
      return nearest.fraction;
    });
  });
  CastHit out = any ? public_answer(s.rigid, nearest) : CastHit{};
  if (asks_soft(s, filter)) {
    find_soft_hits(s, question, filter, out.fraction, [&](const CastHit& hit) {
      if (!out || hit.fraction < out.fraction) out = hit;
      return out.fraction;
    });
  }
  return out;
}

template <class Question>
bool hits_any(WorldState& s, const Question& question, const QueryFilter& filter) {
  bool any = false;
  ask_world(s, filter, [&](const QueryInput& input) {
    cast(input, question, [&](const ShapeHit&) {
      any = true;
      return -1.0;
    });
  });
  if (!any && asks_soft(s, filter)) {
    find_soft_hits(s, question, filter, 1.0, [&](const CastHit&) {
      any = true;
      return -1.0;
    });
  }
  return any;
}

template <class Question>
std::size_t all_hits(WorldState& s, const Question& question, std::span<CastHit> out,
                     const QueryFilter& filter) {
  FirstAnswers<CastHit> answers(out);
  ask_world(s, filter, [&](const QueryInput& input) {
    cast(input, question, [&](const ShapeHit& hit) {
      answers.add(public_answer(s.rigid, hit));
      return 1.0;
    });
  });
  if (asks_soft(s, filter)) {
    find_soft_hits(s, question, filter, 1.0, [&](const CastHit& hit) {
      answers.add(hit);
      return 1.0;
    });
  }
  return answers.count();
}

ClosestPoint nearest_point(const WorldState& s, const ShapePose& shape, double max_distance,
                           const QueryFilter& filter) {
  ShapeNear nearest;
  bool any = false;
  ask_world(s, filter, [&](const QueryInput& input) {
    any = find_nearest_shape(input, world_shape(shape), max_distance, nearest);
  });
  return any ? public_answer(s.rigid, nearest) : ClosestPoint{};
}

// Calls `found` for each shape within the distance, until it returns false.
template <class Found>
void for_each_near(const WorldState& s, const ShapePose& shape, double max_distance,
                   const QueryFilter& filter, Found&& found) {
  ask_world(s, filter,
            [&](const QueryInput& input) { find_near(input, world_shape(shape), max_distance, found); });
}

bool is_near_any(const WorldState& s, const ShapePose& shape, double max_distance,
                 const QueryFilter& filter) {
  bool any = false;
  for_each_near(s, shape, max_distance, filter, [&](const ShapeNear&) { return !(any = true); });
  return any;
}
std::size_t all_near(const WorldState& s, const ShapePose& shape, double max_distance,
                     std::span<ClosestPoint> out, const QueryFilter& filter) {
  FirstAnswers<ClosestPoint> answers(out);
  for_each_near(s, shape, max_distance, filter, [&](const ShapeNear& near) {
    answers.add(public_answer(s.rigid, near));
    return true;
  });
  return answers.count();
}
bool overlaps_any(WorldState& s, const ShapePose& shape, const QueryFilter& filter) {
  bool any = is_near_any(s, shape, 0.0, filter);
  if (!any && asks_soft(s, filter)) find_soft_overlaps(s, shape, filter, [&](const Overlap&) { return !(any = true); });
  return any;
}
std::size_t all_overlaps(WorldState& s, const ShapePose& shape, std::span<Overlap> out,
                         const QueryFilter& filter) {
  FirstAnswers<Overlap> answers(out);
  for_each_near(s, shape, 0.0, filter, [&](const ShapeNear& near) {
    answers.add(named<Overlap>(s.rigid, near.shape, near.triangle));
    return true;
  });
  if (asks_soft(s, filter)) {
    find_soft_overlaps(s, shape, filter, [&](const Overlap& overlap) {
      answers.add(overlap);
      return true;
    });
  }
  return answers.count();
}
std::size_t all_penetrations(const WorldState& s, const ShapePose& shape, std::span<Penetration> out,
                             const QueryFilter& filter) {
  FirstAnswers<Penetration> answers(out);
  ask_world(s, filter, [&](const QueryInput& input) {
    find_penetrations(input, world_shape(shape),
                      [&](const ShapePenetration& deep) { answers.add(public_answer(s.rigid, deep)); });
  });
  return answers.count();
}
Penetration deepest(const WorldState& s, const ShapePose& shape, const QueryFilter& filter) {
  Penetration out;
  all_penetrations(s, shape, std::span(&out, 1), filter);
  return out;
}

// Checks a single query and updates the broad phase.
template <class Question>
bool is_ready(WorldState& s, const Question& question) {
  if (s.stepping || check_question(question)) return false;
  show_changes(s);
  return true;
}

// Calls ask(i, question) for each query, on the workers, or on the calling thread if they are busy.
template <class Question, class Ask>
Error ask_each(WorldState& s, std::span<const Question> questions, std::size_t room, Ask&& ask) {
  if (s.stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  if (questions.size() != room) {
    return make_error(ErrorCode::invalid_argument, "%zu questions but room for %zu answers", questions.size(),
                      room);
  }
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const Error e = check_question(questions[i]);
    if (e) return make_error(e.code, "question %zu: %.200s", i, e.message);
  }
  show_changes(s);
  const std::unique_lock<std::mutex> workers(s.batch_lock, std::try_to_lock);
  constexpr std::size_t kMaxQuestions = 1u << 30;  // what a blocked loop can count
  for (std::size_t first = 0; first < questions.size(); first += kMaxQuestions) {
    const auto count = int(min(questions.size() - first, kMaxQuestions));
    const auto answer_some = [&](int begin, int end, int) {
      for (std::size_t i = first + std::size_t(begin); i < first + std::size_t(end); ++i)
        ask(i, questions[i]);
    };
    if (workers.owns_lock()) {
      for_blocks(*s.tasks, count, kBlock, answer_some);
    } else {
      const FloatMode mode;
      answer_some(0, count, 0);
    }
  }
  return {};
}

// One result for each query: out[i] = answer(question).
template <class Question, class Answer, class Ask>
Error answer_each(WorldState& s, std::span<const Question> questions, std::span<Answer> out, Ask&& answer) {
  return ask_each(s, questions, out.size(),
                  [&](std::size_t i, const Question& question) { out[i] = Answer(answer(question)); });
}

// All results of each query: counts[i] = fill(question, its part of out).
template <class Question, class Answer, class Ask>
Error fill_each(WorldState& s, std::span<const Question> questions, std::span<Answer> out,
                std::span<std::uint32_t> counts, Ask&& fill) {
  const std::size_t room = questions.empty() ? 0 : out.size() / questions.size();
  if (room * questions.size() != out.size()) {
    return make_error(ErrorCode::invalid_argument,
                      "room for %zu answers cannot be shared out alike among %zu questions", out.size(),
                      questions.size());
  }
  return ask_each(s, questions, counts.size(), [&](std::size_t i, const Question& question) {
    counts[i] = std::uint32_t(fill(question, out.subspan(i * room, room)));
  });
}

}  // namespace

void show_changes(WorldState& s) {
  RigidWorld& w = s.rigid;
  if (s.queried_changes.load(std::memory_order_acquire) == w.shapes.changed.size()) return;
  const std::lock_guard<std::mutex> lock(s.query_lock);
  const std::size_t shown = s.queried_changes.load(std::memory_order_relaxed);
  if (shown == w.shapes.changed.size()) return;
  if (shown == kNothingQueried && w.broadphase_stale) {
    w.broadphase->rebuild(w.shapes.proxies);
  } else {
    s.changes_to_show.assign(w.shapes.changed.view().subspan(shown == kNothingQueried ? 0 : shown));
    sort_changed(s.changes_to_show, s.change_keys, s.change_scratch);
    w.broadphase->update(w.shapes.proxies, s.changes_to_show);
  }
  s.queried_changes.store(w.shapes.changed.size(), std::memory_order_release);
}

bool is_in_sight(WorldState& s, DVec3 from, DVec3 to, std::uint32_t body) {
  QueryFilter filter;
  filter.ignored = body_id(s.rigid, body);
  filter.back_faces = true;
  const Ray ray{from, difference(to, from)};
  if (check_ray(ray)) return false;
  show_changes(s);
  bool hidden = false;
  ask_world(s, filter, [&](const QueryInput& input) {
    cast(input, ray, [&](const ShapeHit& hit) {
      hidden = hidden || !hit.inside;
      return hidden ? -1.0 : 1.0;
    });
  });
  return !hidden;
}

Error check_ray(const Ray& ray) {
  const Error e = check_vector("ray", "origin", ray.origin);
  return e.ok() ? check_vector("ray", "translation", DVec3(ray.translation)) : e;
}
Error check_shape_cast(const ShapeCast& cast) {
  Error e = check_place("shape cast", cast.shape, cast.pose);
  if (e.ok()) e = check_vector("shape cast", "translation", DVec3(cast.translation));
  if (e || (is_finite(cast.skin) && cast.skin >= 0.0f)) return e;
  return make_error(ErrorCode::invalid_argument, "shape cast: skin is %g m; it must be finite and 0 or more",
                    double(cast.skin));
}
Error check_shape_pose(const ShapePose& shape) { return check_place("shape", shape.shape, shape.pose); }

std::optional<CastHit> World::cast_ray(DVec3 origin, Vec3 translation, const QueryFilter& filter) const {
  const FloatMode mode;
  const Ray ray{origin, translation};
  if (!is_ready(*state_, ray)) return {};
  const CastHit hit = nearest_hit(*state_, ray, filter);
  return hit ? std::optional(hit) : std::nullopt;
}
bool World::cast_ray_any(DVec3 origin, Vec3 translation, const QueryFilter& filter) const {
  const FloatMode mode;
  const Ray ray{origin, translation};
  return is_ready(*state_, ray) && hits_any(*state_, ray, filter);
}
std::size_t World::cast_ray_all(DVec3 origin, Vec3 translation, std::span<CastHit> out,
                                const QueryFilter& filter) const {
  const FloatMode mode;
  const Ray ray{origin, translation};
  return is_ready(*state_, ray) ? all_hits(*state_, ray, out, filter) : 0;
}

std::optional<CastHit> World::cast_shape(const ShapeCast& cast, const QueryFilter& filter) const {
  const FloatMode mode;
  if (!is_ready(*state_, cast)) return {};
  const CastHit hit = nearest_hit(*state_, cast, filter);
  return hit ? std::optional(hit) : std::nullopt;
}
bool World::cast_shape_any(const ShapeCast& cast, const QueryFilter& filter) const {
  const FloatMode mode;
  return is_ready(*state_, cast) && hits_any(*state_, cast, filter);
}
std::size_t World::cast_shape_all(const ShapeCast& cast, std::span<CastHit> out,
                                  const QueryFilter& filter) const {
  const FloatMode mode;
  return is_ready(*state_, cast) ? all_hits(*state_, cast, out, filter) : 0;
}

bool World::overlap_any(const ShapePose& shape, const QueryFilter& filter) const {
  const FloatMode mode;
  return is_ready(*state_, shape) && overlaps_any(*state_, shape, filter);
}
std::size_t World::overlap_all(const ShapePose& shape, std::span<Overlap> out,
                               const QueryFilter& filter) const {
  const FloatMode mode;
  return is_ready(*state_, shape) ? all_overlaps(*state_, shape, out, filter) : 0;
}

std::optional<ClosestPoint> World::closest_point(const ShapePose& shape, double max_distance,
                                                 const QueryFilter& filter) const {
  const FloatMode mode;
  if (check_distance(max_distance) || !is_ready(*state_, shape)) return {};
  const ClosestPoint nearest = nearest_point(*state_, shape, max_distance, filter);
  return nearest ? std::optional(nearest) : std::nullopt;
}
bool World::closest_point_any(const ShapePose& shape, double max_distance, const QueryFilter& filter) const {
  const FloatMode mode;
  return check_distance(max_distance).ok() && is_ready(*state_, shape) &&
         is_near_any(*state_, shape, max_distance, filter);
}
std::size_t World::closest_point_all(const ShapePose& shape, double max_distance, std::span<ClosestPoint> out,
                                     const QueryFilter& filter) const {
  const FloatMode mode;
  if (check_distance(max_distance) || !is_ready(*state_, shape)) return 0;
  return all_near(*state_, shape, max_distance, out, filter);
}

std::optional<Penetration> World::penetration(const ShapePose& shape, const QueryFilter& filter) const {
  const FloatMode mode;
  if (!is_ready(*state_, shape)) return {};
  const Penetration out = deepest(*state_, shape, filter);
  return out ? std::optional(out) : std::nullopt;
}
std::size_t World::penetration_all(const ShapePose& shape, std::span<Penetration> out,
                                   const QueryFilter& filter) const {
  const FloatMode mode;
  return is_ready(*state_, shape) ? all_penetrations(*state_, shape, out, filter) : 0;
}

// --------------------------------------------------------------------------------------------------------------- batches

Error World::cast_ray_batch(std::span<const Ray> rays, std::span<CastHit> out,
                            const QueryFilter& filter) const {
  return answer_each(*state_, rays, out, [&](const Ray& ray) { return nearest_hit(*state_, ray, filter); });
}
Error World::cast_ray_any_batch(std::span<const Ray> rays, std::span<std::uint8_t> out,
                                const QueryFilter& filter) const {
  return answer_each(*state_, rays, out, [&](const Ray& ray) { return hits_any(*state_, ray, filter); });
}
Error World::cast_ray_all_batch(std::span<const Ray> rays, std::span<CastHit> out,
                                std::span<std::uint32_t> counts, const QueryFilter& filter) const {
  return fill_each(*state_, rays, out, counts, [&](const Ray& ray, std::span<CastHit> part) {
    return all_hits(*state_, ray, part, filter);
  });
}
Error World::cast_shape_batch(std::span<const ShapeCast> casts, std::span<CastHit> out,
                              const QueryFilter& filter) const {
  return answer_each(*state_, casts, out,
                     [&](const ShapeCast& cast) { return nearest_hit(*state_, cast, filter); });
}
Error World::cast_shape_any_batch(std::span<const ShapeCast> casts, std::span<std::uint8_t> out,
                                  const QueryFilter& filter) const {
  return answer_each(*state_, casts, out,
                     [&](const ShapeCast& cast) { return hits_any(*state_, cast, filter); });
}
Error World::cast_shape_all_batch(std::span<const ShapeCast> casts, std::span<CastHit> out,
                                  std::span<std::uint32_t> counts, const QueryFilter& filter) const {
  return fill_each(*state_, casts, out, counts, [&](const ShapeCast& cast, std::span<CastHit> part) {
    return all_hits(*state_, cast, part, filter);
  });
}

Error World::closest_point_batch(std::span<const ShapePose> shapes, double max_distance,
                                 std::span<ClosestPoint> out, const QueryFilter& filter) const {
  const Error e = check_distance(max_distance);
  if (e) return e;
  return answer_each(*state_, shapes, out, [&](const ShapePose& shape) {
    return nearest_point(*state_, shape, max_distance, filter);
  });
}
Error World::closest_point_any_batch(std::span<const ShapePose> shapes, double max_distance,
                                     std::span<std::uint8_t> out, const QueryFilter& filter) const {
  const Error e = check_distance(max_distance);
  if (e) return e;
  return answer_each(*state_, shapes, out, [&](const ShapePose& shape) {
    return is_near_any(*state_, shape, max_distance, filter);
  });
}
Error World::closest_point_all_batch(std::span<const ShapePose> shapes, double max_distance,
                                     std::span<ClosestPoint> out, std::span<std::uint32_t> counts,
                                     const QueryFilter& filter) const {
  const Error e = check_distance(max_distance);
  if (e) return e;
  return fill_each(*state_, shapes, out, counts, [&](const ShapePose& shape, std::span<ClosestPoint> part) {
    return all_near(*state_, shape, max_distance, part, filter);
  });
}

Error World::overlap_count_batch(std::span<const ShapePose> shapes, std::span<std::uint32_t> counts,
                                 const QueryFilter& filter) const {
  return overlap_all_batch(shapes, {}, counts, filter);
}
Error World::overlap_any_batch(std::span<const ShapePose> shapes, std::span<std::uint8_t> out,
                               const QueryFilter& filter) const {
  return answer_each(*state_, shapes, out, [&](const ShapePose& shape) { return overlaps_any(*state_, shape, filter); });
}
Error World::overlap_all_batch(std::span<const ShapePose> shapes, std::span<Overlap> out,
                               std::span<std::uint32_t> counts, const QueryFilter& filter) const {
  return fill_each(*state_, shapes, out, counts, [&](const ShapePose& shape, std::span<Overlap> part) {
    return all_overlaps(*state_, shape, part, filter);
  });
}

Error World::penetration_batch(std::span<const ShapePose> shapes, std::span<Penetration> out,
                               const QueryFilter& filter) const {
  return answer_each(*state_, shapes, out,
                     [&](const ShapePose& shape) { return deepest(*state_, shape, filter); });
}
Error World::penetration_all_batch(std::span<const ShapePose> shapes, std::span<Penetration> out,
                                   std::span<std::uint32_t> counts, const QueryFilter& filter) const {
  return fill_each(*state_, shapes, out, counts, [&](const ShapePose& shape, std::span<Penetration> part) {
    return all_penetrations(*state_, shape, part, filter);
  });
}

}  // namespace gyre
