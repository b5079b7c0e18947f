// Batches in C: the handle of a WorldBatch (gyre/batch.h), and its channels from C's structs.
#include "capi/convert.h"

#include <gyre/batch.h>

namespace gyre {
namespace {

BatchReading reading_of(const GyreChannel& in) {
  return {.kind = ReadingKind(in.what),
          .components = in.components,
          .axis = c::same<JointAxis>(in.axis),
          .body = c::same<BodyId>(in.body),
          .joint = c::same<JointId>(in.joint)};
}
BatchAction action_of(const GyreChannel& in) {
  return {.kind = ActionKind(in.what),
          .components = in.components,
          .body = c::same<BodyId>(in.body),
          .joint = c::same<JointId>(in.joint),
          .max_force = in.max_force,
          .frequency = in.frequency,
          .damping_ratio = in.damping_ratio};
}
BatchDraw draw_of(const GyreBatchDraw& in) {
  return {.kind = DrawKind(in.what),
          .body = c::same<BodyId>(in.body),
          .low = c::same<Vec3>(in.low),
          .high = c::same<Vec3>(in.high)};
}

bool refuse_argument(const char* why) {
  c::refuse(make_error(ErrorCode::invalid_argument, "%s", why));
  return false;
}
bool accept(const Error& error) {
  if (error) c::refuse(error);
  return error.ok();
}

template <class Out, class In, class Convert>
std::vector<Out> converted(const In* rows, std::size_t count, Convert convert) {
  std::vector<Out> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(convert(rows[i]));
  return out;
}

}  // namespace
}  // namespace gyre

struct GyreBatch {
  explicit GyreBatch(gyre::WorldBatch made) : value(std::move(made)), handles(value.size()) {
    for (std::size_t i = 0; i < handles.size(); ++i) {
      handles[i] = std::make_unique<GyreWorld>();
      handles[i]->value = &value.world(i);
    }
  }
  gyre::WorldBatch value;
  std::vector<std::unique_ptr<GyreWorld>> handles;
};

using namespace gyre;
using namespace gyre::c;

extern "C" {

GyreBatch* gyre_batch_create(const GyreWorld* world, int32_t worlds, int32_t threads) noexcept {
  if (world == nullptr) {
    refuse_argument("gyre_batch_create: world is NULL");
    return nullptr;
  }
  Result<WorldBatch> made = WorldBatch::create(*world->value, worlds, threads);
  if (made) return new GyreBatch(*std::move(made));
  refuse(made.error());
  return nullptr;
}
void gyre_batch_destroy(GyreBatch* batch) noexcept { delete batch; }

bool gyre_batch_set_observations(GyreBatch* batch, const GyreChannel* channels, size_t count) noexcept {
  if (batch == nullptr || (channels == nullptr && count > 0))
    return refuse_argument("gyre_batch_set_observations: a pointer is NULL");
  return accept(batch->value.set_observations(converted<BatchReading>(channels, count, reading_of)));
}
bool gyre_batch_set_actions(GyreBatch* batch, const GyreChannel* channels, size_t count) noexcept {
  if (batch == nullptr || (channels == nullptr && count > 0))
    return refuse_argument("gyre_batch_set_actions: a pointer is NULL");
  return accept(batch->value.set_actions(converted<BatchAction>(channels, count, action_of)));
}
bool gyre_batch_set_draws(GyreBatch* batch, const GyreBatchDraw* draws, size_t count,
                          uint64_t seed) noexcept {
  if (batch == nullptr || (draws == nullptr && count > 0))
    return refuse_argument("gyre_batch_set_draws: a pointer is NULL");
  return accept(batch->value.set_draws(converted<BatchDraw>(draws, count, draw_of), seed));
}
size_t gyre_batch_size(const GyreBatch* batch) noexcept { return batch != nullptr ? batch->value.size() : 0; }
size_t gyre_batch_body_count(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->value.body_count() : 0;
}
size_t gyre_batch_observation_width(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->value.observation_width() : 0;
}
size_t gyre_batch_action_width(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->value.action_width() : 0;
}

bool gyre_batch_step(GyreBatch* batch, const float* actions, float* observations, int32_t steps,
                     float seconds) noexcept {
  if (batch == nullptr) return refuse_argument("gyre_batch_step: batch is NULL");
  WorldBatch& value = batch->value;
  return accept(value.step(seconds, steps, view<const float>(actions, value.size() * value.action_width()),
                           view<float>(observations, value.size() * value.observation_width())));
}
bool gyre_batch_reset(GyreBatch* batch, const uint8_t* which) noexcept {
  if (batch == nullptr) return refuse_argument("gyre_batch_reset: batch is NULL");
  return accept(batch->value.reset(view<const uint8_t>(which, batch->value.size())));
}
void gyre_batch_observe(GyreBatch* batch, float* observations) noexcept {
  if (batch == nullptr || observations == nullptr) return;
  static_cast<void>(
      batch->value.observe({observations, batch->value.size() * batch->value.observation_width()}));
}
bool gyre_batch_columns(const GyreBatch* batch, GyrePose* poses, GyreVec3* linear_velocities,
                        GyreVec3* angular_velocities) noexcept {
  if (batch == nullptr) return refuse_argument("gyre_batch_columns: batch is NULL");
  const std::size_t count = batch->value.size() * batch->value.body_count();
  return accept(batch->value.columns(view<Pose>(poses, count), view<Vec3>(linear_velocities, count),
                                     view<Vec3>(angular_velocities, count)));
}
void gyre_batch_hashes(const GyreBatch* batch, uint64_t* out) noexcept {
  if (batch != nullptr && out != nullptr) static_cast<void>(batch->value.hashes({out, batch->value.size()}));
}
GyreVec3 gyre_batch_drawn(const GyreBatch* batch, size_t index, size_t draw) noexcept {
  return same<GyreVec3>(batch != nullptr ? batch->value.drawn(index, draw) : Vec3{});
}

GyreWorld* gyre_batch_world(GyreBatch* batch, size_t index) noexcept {
  return batch != nullptr && index < batch->handles.size() ? batch->handles[index].get() : nullptr;
}
GyreBodyId gyre_batch_body(const GyreBatch* batch, size_t index, GyreBodyId body) noexcept {
  if (batch == nullptr || index >= batch->value.size()) return {};
  return same<GyreBodyId>(batch->value.body(index, same<BodyId>(body)));
}
GyreJointId gyre_batch_joint(const GyreBatch* batch, size_t index, GyreJointId joint) noexcept {
  if (batch == nullptr || index >= batch->value.size()) return {};
  return same<GyreJointId>(batch->value.joint(index, same<JointId>(joint)));
}

}  // extern "C"
