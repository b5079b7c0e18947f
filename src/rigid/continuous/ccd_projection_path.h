// How a group that hangs together follows what a sweep took back: from where all of it was when the first body was stopped (joints
// hold there: all have gone the same part of their way) along the rest of its way, in a few parts, each as far as the joints can be
// closed without moving stopped bodies further than they may be. Those that were are held, and where that is no way either, all stay
// where the last part left them.
//
// Whoever solves the joints asks for the next motion again and again: next() says what to do where the joints are as far off as they
// are, and sets velocities that would make a displacement in kProjectionStep seconds; the solver changes them, advance() goes there and
// leaves none.
#pragma once

#include "rigid/continuous/ccd_joint_groups.h"
#include "solver/core/body_motion.h"

namespace gyre {

// s: short, so that what solvers of speeds leave (rad/s) is little.
constexpr float kProjectionStep = 0.25f;

// Where bodies are meanwhile, and how hard they are to move. By body.
struct ProjectionBodies {
  std::span<BodyMotion> motion;
  std::span<BodyInertia> inertia;
  std::span<Quat> orientations;
};

class ProjectionPath {
 public:
  enum class Next : std::uint8_t {
    solve,
    measure,  // bodies have been put elsewhere: asks again how far the joints are off
    done,
  };

  ProjectionPath() = default;
  // Puts all where the first was stopped. `stays`: it goes no further.
  ProjectionPath(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                 bool stop_at_impact);

  // `open`: m or rad, the farthest that a joint or a limit is off.
  Next next(float error);
  void advance();

 private:
  void update_inertia() const;
  void find_displacements() const;
  int count_segments() const;
  void set_velocities(float share) const;
  Next correct();
  Next end_start(float error);
  Next begin_segment();
  Next end_segment(float error);
  bool fix_displaced_bodies() const;
  void save() const;
  void restore() const;

  const RigidWorld* w_ = nullptr;
  std::span<ProjectionMember> members_;
  ProjectionBodies bodies_;
  bool stop_at_impact_ = false, is_moving_ = false, was_restored_ = false;
  int segment_ = 0, segments_ = 0, corrections_ = 0;
  float initial_error_ = 0.0f;  // m or rad, as the step began
  float max_error_ = 0.0f;       // what is off by less is closed
};

}  // namespace gyre
