// Many copies of one world, stepped over all cores: In: a row of actions for each world. Out: a row of observations for each.
//
// Each world is stepped by one thread, so neither their number nor the order in which they take worlds changes a bit of a result.
#include "capi/convert.h"

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace gyre {
namespace {

// Threads that wait for work. The calling thread works too.
class Workers {
 public:
  explicit Workers(int threads) {
    for (int i = 1; i < threads; ++i) threads_.emplace_back([this] { wait_for_work(); });
  }
  ~Workers() {
    {
      const std::lock_guard lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  // Calls work(i) for each i below count, and returns when all are done.
  void run(std::size_t count, const std::function<void(std::size_t)>& work) {
    {
      const std::lock_guard lock(mutex_);
      work_ = &work;
      count_ = count;
      next_ = 0;
      busy_ = threads_.size();
      ++round_;
    }
    wake_.notify_all();
    do_work();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
  }

 private:
  void do_work() {
    for (std::size_t i = next_++; i < count_; i = next_++) (*work_)(i);
  }
  void wait_for_work() {
    std::unique_lock lock(mutex_);
    for (std::uint64_t seen = 0;;) {
      wake_.wait(lock, [&] { return ending_ || round_ != seen; });
      if (ending_) return;
      seen = round_;
      lock.unlock();
      do_work();
      lock.lock();
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0, busy_ = 0;
  std::atomic<std::size_t> next_{0};
  std::uint64_t round_ = 0;
  bool ending_ = false;
};

int components_of(const GyreChannel& channel, int most) {
  int count = 0;
  for (int i = 0; i < most; ++i) count += channel.components == 0 || (channel.components >> i & 1) != 0;
  return count;
}
int reading_width(const GyreChannel& channel) {
  switch (channel.what) {
    case GYRE_READING_ORIENTATION:
      return components_of(channel, 4);
    case GYRE_READING_POSITION:
    case GYRE_READING_LINEAR_VELOCITY:
    case GYRE_READING_ANGULAR_VELOCITY:
      return components_of(channel, 3);
    default:
      return 1;
  }
}
bool is_of_joint(const GyreChannel& channel, bool action) {
  return action ? channel.what >= GYRE_ACTION_MOTOR_VELOCITY && channel.what <= GYRE_ACTION_MOTOR_FORCE
                : channel.what >= GYRE_READING_JOINT_POSITION && channel.what <= GYRE_READING_JOINT_FORCE;
}
int action_width(const GyreChannel& channel) {
  return is_of_joint(channel, true) ? 1 : components_of(channel, 3);
}

BodyId body_in(const GyreChannel& channel, std::uint16_t world) {
  BodyId id = c::same<BodyId>(channel.body);
  id.world = world;
  return id;
}
JointId joint_in(const GyreChannel& channel, std::uint16_t world) {
  JointId id = c::same<JointId>(channel.joint);
  id.world = world;
  return id;
}

// Writes the chosen components.
template <class Value, int Count>
float* put(float* out, const Value (&parts)[Count], const GyreChannel& channel) {
  for (int i = 0; i < Count; ++i) {
    if (channel.components == 0 || (channel.components >> i & 1) != 0) *out++ = float(parts[i]);
  }
  return out;
}
template <class Vector>
float* put_vector(float* out, const Vector& v, const GyreChannel& channel) {
  const decltype(v.x) parts[3] = {v.x, v.y, v.z};
  return put(out, parts, channel);
}
Vec3 vector_of(const float* in, const GyreChannel& channel) {
  float parts[3] = {};
  for (int i = 0; i < 3; ++i) {
    if (channel.components == 0 || (channel.components >> i & 1) != 0) parts[i] = *in++;
  }
  return {parts[0], parts[1], parts[2]};
}

float touching_force(const World& world, BodyId body, float seconds, std::vector<ContactPoint>& points) {
  const std::size_t count = world.contacts(points);
  if (count > points.size()) {
    points.resize(count);
    world.contacts(points);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (points[i].body_a == body || points[i].body_b == body) sum += double(points[i].normal_impulse);
  }
  return seconds > 0.0f ? float(sum / double(seconds)) : 0.0f;
}

struct BatchWorld {
  GyreWorld handle;
  std::uint16_t number = 0;  // in ids
  std::vector<ContactPoint> points;
  bool refused = false;
};

}  // namespace
}  // namespace gyre

struct GyreBatch {
  explicit GyreBatch(int threads) : workers(threads) {}

  std::vector<std::byte> start;  // snapshot
  std::vector<std::unique_ptr<gyre::BatchWorld>> worlds;
  std::vector<GyreChannel> observations, actions;
  std::size_t observation_width = 0, action_width = 0;
  float seconds = 0.0f;  // of the last step
  gyre::Workers workers;
};

namespace gyre {
namespace {

void observe(const GyreBatch& batch, BatchWorld& in, float* out) {
  const World& world = *in.handle.value;
  for (const GyreChannel& channel : batch.observations) {
    const BodyId body = body_in(channel, in.number);
    if (is_of_joint(channel, false)) {
      const JointAxisState state =
          world.joint_axis_state(joint_in(channel, in.number), c::same<JointAxis>(channel.axis));
      *out++ = channel.what == GYRE_READING_JOINT_POSITION   ? state.position
               : channel.what == GYRE_READING_JOINT_VELOCITY ? state.velocity
                                                             : state.force;
    } else if (channel.what == GYRE_READING_POSITION) {
      out = put_vector(out, world.pose(body).position, channel);
    } else if (channel.what == GYRE_READING_ORIENTATION) {
      const Quat q = world.pose(body).orientation;
      const float parts[4] = {q.x, q.y, q.z, q.w};
      out = put(out, parts, channel);
    } else if (channel.what == GYRE_READING_LINEAR_VELOCITY) {
      out = put_vector(out, world.linear_velocity(body), channel);
    } else if (channel.what == GYRE_READING_ANGULAR_VELOCITY) {
      out = put_vector(out, world.angular_velocity(body), channel);
    } else {
      *out++ = touching_force(world, body, batch.seconds, in.points);
    }
  }
}

// A motor with the channel's settings.
Motor motor_of(const GyreChannel& channel, float value) {
  Motor motor{
      .max_force = channel.max_force, .frequency = channel.frequency, .damping_ratio = channel.damping_ratio};
  if (channel.what == GYRE_ACTION_MOTOR_POSITION) {
    motor.target_position = value;
  } else if (channel.what == GYRE_ACTION_MOTOR_FORCE) {
    // A motor that never reaches its target speed acts with its largest force.
    motor.target_velocity = value < 0.0f ? -1.0e4f : 1.0e4f;
    motor.max_force = absolute(value);
  } else {
    motor.target_velocity = value;
  }
  return motor;
}

// Forces act for one step, so they are added in each; the rest is set before the first.
bool act(const GyreBatch& batch, BatchWorld& in, const float* actions, bool first) {
  World& world = *in.handle.value;
  bool done = true;
  for (const GyreChannel& channel : batch.actions) {
    const BodyId body = body_in(channel, in.number);
    if (is_of_joint(channel, true)) {
      if (first) done = world.set_motor(joint_in(channel, in.number), motor_of(channel, *actions)) && done;
    } else if (channel.what == GYRE_ACTION_FORCE) {
      done = world.add_force(body, vector_of(actions, channel)) && done;
    } else if (channel.what == GYRE_ACTION_TORQUE) {
      done = world.add_torque(body, vector_of(actions, channel)) && done;
    } else if (first) {
      done = world.set_velocity(body, vector_of(actions, channel), world.angular_velocity(body)) && done;
    }
    actions += action_width(channel);
  }
  return done;
}

bool refuse_argument(const char* why) {
  c::refuse(make_error(ErrorCode::invalid_argument, "%s", why));
  return false;
}

bool set_channels(GyreBatch* batch, const GyreChannel* channels, std::size_t count, bool action) {
  if (batch == nullptr || (channels == nullptr && count > 0))
    return refuse_argument("gyre_batch: a pointer is NULL");
  const BatchWorld& first = *batch->worlds.front();
  const World& world = *first.handle.value;
  std::size_t width = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const GyreChannel& channel = channels[i];
    if (channel.what > (action ? int(GYRE_ACTION_VELOCITY) : int(GYRE_READING_TOUCHING)) ||
        channel.axis > GYRE_JOINT_AXIS_ANGULAR_Z ||
        channel.components > (!action && channel.what == GYRE_READING_ORIENTATION ? 15 : 7)) {
      c::refuse(make_error(ErrorCode::invalid_argument,
                           "gyre_batch: channel %zu: what, components or axis is out of range", i));
      return false;
    }
    const bool exists = is_of_joint(channel, action) ? world.exists(joint_in(channel, first.number))
                                                     : world.exists(body_in(channel, first.number));
    if (!exists) {
      c::refuse(make_error(ErrorCode::stale_id, "gyre_batch: channel %zu: the world has no such %s", i,
                           is_of_joint(channel, action) ? "joint" : "body"));
      return false;
    }
    width += std::size_t(action ? action_width(channel) : reading_width(channel));
  }
  (action ? batch->actions : batch->observations).assign(channels, channels + count);
  (action ? batch->action_width : batch->observation_width) = width;
  return true;
}

std::uint16_t number_of(const World& world) {
  const std::span<const BodyId> ids = world.bodies().ids;
  return ids.empty() ? std::uint16_t(0) : ids.front().world;
}

}  // namespace
}  // namespace gyre

using namespace gyre;
using namespace gyre::c;

extern "C" {

GyreBatch* gyre_batch_create(const GyreWorld* world, int32_t worlds, int32_t threads) noexcept {
  if (world == nullptr || worlds < 1 || worlds > 60000 || threads < 0 || threads > 1024) {
    refuse_argument("gyre_batch_create: expected a world, 1 to 60,000 worlds and 0 to 1,024 threads");
    return nullptr;
  }
  if (threads == 0) threads = std::max(1, int(std::thread::hardware_concurrency()));
  auto batch = std::make_unique<GyreBatch>(std::min(threads, worlds));
  batch->start = save_snapshot(*world->value);
  for (int i = 0; i < worlds; ++i) {
    Result<World> made = load_snapshot(batch->start, WorldDef{});
    if (!made) {
      refuse(made.error());
      return nullptr;
    }
    auto& in = *batch->worlds.emplace_back(std::make_unique<BatchWorld>());
    in.handle.value = &in.handle.own.emplace(*std::move(made));
    in.number = number_of(*in.handle.value);
  }
  return batch.release();
}
void gyre_batch_destroy(GyreBatch* batch) noexcept { delete batch; }

bool gyre_batch_set_observations(GyreBatch* batch, const GyreChannel* channels, size_t count) noexcept {
  return set_channels(batch, channels, count, false);
}
bool gyre_batch_set_actions(GyreBatch* batch, const GyreChannel* channels, size_t count) noexcept {
  return set_channels(batch, channels, count, true);
}
size_t gyre_batch_size(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->worlds.size() : 0;
}
size_t gyre_batch_observation_width(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->observation_width : 0;
}
size_t gyre_batch_action_width(const GyreBatch* batch) noexcept {
  return batch != nullptr ? batch->action_width : 0;
}

bool gyre_batch_step(GyreBatch* batch, const float* actions, float* observations, int32_t steps,
                     float seconds) noexcept {
  if (batch == nullptr || steps < 1 || !(seconds > 0.0f && seconds <= 1.0f)) {
    return refuse_argument(
        "gyre_batch_step: expected a batch, at least one step, and seconds above 0 and at most 1");
  }
  batch->seconds = seconds;
  batch->workers.run(batch->worlds.size(), [&](std::size_t i) {
    BatchWorld& in = *batch->worlds[i];
    in.refused = false;
    for (int step = 0; step < steps; ++step) {
      if (actions != nullptr && !act(*batch, in, actions + i * batch->action_width, step == 0))
        in.refused = true;
      if (in.refused || !in.handle.value->step(seconds)) {
        in.refused = true;
        break;
      }
    }
    if (observations != nullptr) observe(*batch, in, observations + i * batch->observation_width);
  });
  for (std::size_t i = 0; i < batch->worlds.size(); ++i) {
    if (!batch->worlds[i]->refused) continue;
    const std::span<const Problem> problems = batch->worlds[i]->handle.value->problems();
    refuse(make_error(problems.empty() ? ErrorCode::invalid_argument : problems.back().code,
                      "world %zu: %.200s", i, problems.empty() ? "refused" : problems.back().message));
    return false;
  }
  return true;
}

bool gyre_batch_reset(GyreBatch* batch, const uint8_t* which) noexcept {
  if (batch == nullptr) return refuse_argument("gyre_batch_reset: batch is NULL");
  batch->workers.run(batch->worlds.size(), [&](std::size_t i) {
    // Only bytes that were made by this program are restored, so none can be refused.
    if (which == nullptr || which[i] != 0)
      static_cast<void>(restore_snapshot(*batch->worlds[i]->handle.value, batch->start));
  });
  return true;
}
void gyre_batch_observe(GyreBatch* batch, float* observations) noexcept {
  if (batch == nullptr || observations == nullptr) return;
  batch->workers.run(batch->worlds.size(), [&](std::size_t i) {
    observe(*batch, *batch->worlds[i], observations + i * batch->observation_width);
  });
}

GyreWorld* gyre_batch_world(GyreBatch* batch, size_t index) noexcept {
  return batch != nullptr && index < batch->worlds.size() ? &batch->worlds[index]->handle : nullptr;
}
GyreBodyId gyre_batch_body(const GyreBatch* batch, size_t index, GyreBodyId body) noexcept {
  if (batch == nullptr || index >= batch->worlds.size()) return {};
  body.world = batch->worlds[index]->number;
  return body;
}
GyreJointId gyre_batch_joint(const GyreBatch* batch, size_t index, GyreJointId joint) noexcept {
  if (batch == nullptr || index >= batch->worlds.size()) return {};
  joint.world = batch->worlds[index]->number;
  return joint;
}

}  // extern "C"
