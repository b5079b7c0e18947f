// The path of a projection group: after CCD halts a body, the group moves from its pose at the first impact
// (joints are closed there, since all bodies have the same fraction of their displacement) along the rest of
// its displacement, in a few segments. Each ends where the joints can be closed without moving halted bodies
// further than they may. Halted bodies that would are fixed, and if that does not help, all stay at the end
// of the last segment.
//
// The solver of the joints calls next() with the present error: it returns what to do, and sets velocities
// that would make a displacement in kProjectionStep seconds. The solver changes the velocities; advance()
// applies and clears them.
#pragma once

#include "rigid/continuous/ccd_joint_groups.h"
#include "solver/core/body_motion.h"

namespace gyre {

// s: short, so that residuals of velocity solvers (rad/s) matter little.
constexpr float kProjectionStep = 0.25f;

// Poses and mobility of the bodies meanwhile. By body.
struct ProjectionBodies {
  std::span<BodyMotion> motion;
  std::span<BodyInertia> inertia;
  std::span<Quat> orientations;
};

class ProjectionPath {
 public:
  enum class Next : std::uint8_t {
    solve,
    measure,  // bodies have been moved: call again with the new error
    done,
  };

  ProjectionPath() = default;
  // Puts all bodies at the first impact. `stop_at_impact`: they go no further.
  ProjectionPath(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                 bool stop_at_impact);

  // `error`: m or rad, the largest error of a joint or limit.
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
  float initial_error_ = 0.0f;  // m or rad, at the beginning of the step
  float max_error_ = 0.0f;      // smaller errors count as closed
};

}  // namespace gyre
