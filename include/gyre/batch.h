// WorldBatch: many worlds that begin alike, stepped over all cores, with one array for all observations and one for all actions.
#pragma once

#include <gyre/ids.h>
#include <gyre/joints.h>
#include <gyre/math.h>
#include <gyre/result.h>
#include <gyre/world.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace gyre {

enum class ReadingKind : std::uint8_t {
  position,          // m, of the body's origin, world frame: 3 numbers
  orientation,       // x y z w: 4 numbers
  linear_velocity,   // m/s, of the centre of mass, world frame: 3 numbers
  angular_velocity,  // rad/s, world frame: 3 numbers
  joint_position,    // m or rad, of an axis of a joint
  joint_velocity,    // m/s or rad/s
  joint_force,       // N or N m, by limits, motor, spring and friction together
  contact_force,     // N, the sum of the normal forces on a body, mean over the last step
};
constexpr int kReadingKindCount = 8;

enum class ActionKind : std::uint8_t {
  force,           // N, on the centre of mass, world frame, in each step: 3 numbers
  torque,          // N m, world frame, in each step: 3 numbers
  motor_velocity,  // m/s or rad/s, the target of the motor of a joint
  motor_position,  // m or rad, the target of the motor of a joint
  motor_force,     // N or N m of the motor of a joint, constant through the steps
  velocity,        // m/s, set before the first step; components that are left out become 0: 3 numbers
};
constexpr int kActionKindCount = 6;

// Components of a vector as bits: 1 is x, 2 is y, 4 is z, 8 is w, and their sums. 0 means all.
struct BatchReading {
  ReadingKind kind = ReadingKind::position;
  std::uint8_t components = 0;
  JointAxis axis = JointAxis::angular_x;
  BodyId body{};  // of the world that the batch was made of
  JointId joint{};
};

struct BatchAction {
  ActionKind kind = ActionKind::force;
  std::uint8_t components = 0;
  BodyId body{};  // of the world that the batch was made of
  JointId joint{};
  float max_force = 0;  // N or N m, of motor velocities and positions
  float frequency = 0;  // Hz, of motor positions; 0: as stiff as the step allows
  float damping_ratio = 1;
};

// A parameter that each world draws anew when it begins, evenly between `low` and `high`, component by component.
enum class DrawKind : std::uint8_t {
  position,          // m, added to that of the start, world frame
  linear_velocity,   // m/s, added
  angular_velocity,  // rad/s, added
  gravity,           // m/s^2, added to that of the world; no body
  gravity_scale,     // a factor in x
  friction,          // a factor in x for static and dynamic friction of all shapes of the body
  restitution,       // 0 to 1 in x, of all shapes of the body
};
constexpr int kDrawKindCount = 7;

struct BatchDraw {
  DrawKind kind = DrawKind::position;
  BodyId body{};  // of the world that the batch was made of
  Vec3 low{}, high{};
};

// Row i of every array belongs to world i. A world has the bits of one that is stepped alone, so the number of threads changes no
// result. Once every world has made its first steps and its first reset, neither step() nor reset() allocates memory, unless a world
// needs more than ever before. Cooked geometry is shared by all worlds. One thread at a time may use a batch.
class WorldBatch {
 public:
  // `worlds` copies (1 to 60,000) of a world as it is; `threads` as WorldDef::threads. Each copy has the settings of `start` and one thread.
  static Result<WorldBatch> create(const World& start, int worlds, int threads = 0);
  ~WorldBatch();
  WorldBatch(WorldBatch&&) noexcept;
  WorldBatch& operator=(WorldBatch&&) noexcept;

  // The numbers of every row, in order. Refused if a body or joint does not exist in `start`.
  Error set_observations(std::span<const BatchReading> readings);
  Error set_actions(std::span<const BatchAction> actions);
  // The parameters that worlds draw, and resets every world. A draw is a function of seed, world, number of the reset and place in the
  // list: nothing else changes it. At most 64.
  Error set_draws(std::span<const BatchDraw> draws, std::uint64_t seed);

  std::size_t size() const;               // worlds
  std::size_t body_count() const;         // bodies of `start`
  std::size_t observation_width() const;  // numbers a row
  std::size_t action_width() const;

  // Applies a row of actions to each world (empty: none), steps each `steps` times by `seconds`, and reads a row of observations (empty:
  // none). The error names the first world that refused an action; worlds that refused make no further steps.
  Error step(float seconds, int steps = 1, std::span<const float> actions = {},
             std::span<float> observations = {});
  // Sets the worlds whose element is not 0 back to the start, and draws their parameters; empty: all.
  Error reset(std::span<const std::uint8_t> which = {});
  // The observations of the present state; `out` has room for size() rows.
  Error observe(std::span<float> out) const;
  // All bodies of `start` in the order of World::bodies(), world after world: size() times body_count() elements, or none where a span is
  // empty. Bodies that a world has no more are zero.
  Error columns(std::span<Pose> poses, std::span<Vec3> linear_velocities,
                std::span<Vec3> angular_velocities) const;
  // World::hash() of each.
  Error hashes(std::span<std::uint64_t> out) const;
  // The values of a draw in the present run of a world; zero without such a draw.
  Vec3 drawn(std::size_t world, std::size_t draw) const;

  // One of the worlds, to be read and changed between two steps; body() and joint() turn ids of `start` into its own. `index` is below size().
  World& world(std::size_t index);
  const World& world(std::size_t index) const;
  BodyId body(std::size_t index, BodyId body) const;
  JointId joint(std::size_t index, JointId joint) const;

 private:
  struct Worlds;
  explicit WorldBatch(std::unique_ptr<Worlds> worlds);
  std::unique_ptr<Worlds> worlds_;
};

}  // namespace gyre
