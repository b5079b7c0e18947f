// Poses for drawing between two steps: a game draws at the rate of its screen and steps at a fixed rate.
//
//   FixedTimestep clock{1.0f / 60.0f};
//   Interpolation poses;
//   for (each frame that took `seconds`) {
//     for (int i = clock.advance(seconds); i > 0; --i) {
//       world.step(clock.step);
//       poses.capture(world);
//     }
//     draw(poses.pose(body, clock.alpha()));
//   }
//
// The picture lags behind the simulation by up to one step. Nothing here changes the world.
#pragma once

#include <gyre/world.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre::kit {

// Divides the time of frames into steps of one length.
class FixedTimestep {
 public:
  explicit FixedTimestep(float step_seconds, int max_steps_per_frame = 8)
      : step(step_seconds), max_steps(max_steps_per_frame) {}

  // The number of steps to make in a frame that took `seconds`. A frame that took longer than max_steps steps is cut, so that a slow machine
  // does not fall behind more and more: simulated time then runs slower than the clock. Time that is not finite or below 0 counts as 0.
  int advance(double seconds);
  // How far the present moment lies between the last two steps, 0 to 1.
  float alpha() const { return float(left_ / double(step)); }

  float step;     // s
  int max_steps;  // in a frame

 private:
  double left_ = 0;  // s, less than a step
};

// The poses of all bodies at the last two captures.
class Interpolation {
 public:
  // Call it after each step. The first capture of a body is both of its poses.
  void capture(const World& world);
  // The next capture of this body is both of its poses: call it after World::set_pose, so that a teleported body does not fly.
  void teleport(BodyId body);

  // The pose at `alpha` of the way from the capture before the last to the last. A body that was not captured is at the origin.
  Pose pose(BodyId body, float alpha) const;
  // All captured bodies, in order of index; and their poses. Fills up to out.size() poses.
  std::span<const BodyId> ids() const { return ids_; }
  void poses(float alpha, std::span<Pose> out) const;

 private:
  Pose blend(std::size_t i, float alpha) const;

  std::vector<BodyId> ids_, old_ids_;
  std::vector<Pose> now_, before_, old_now_;
  std::vector<std::uint32_t> at_;  // by index of a body: its number in ids_, or kNowhere
  std::vector<BodyId> teleported_;
};

}  // namespace gyre::kit
