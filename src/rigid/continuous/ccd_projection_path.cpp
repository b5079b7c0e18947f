#include "rigid/continuous/ccd_projection_path.h"

#include "math/rotation.h"

namespace gyre {

namespace {

constexpr float kMaxHaltedDisplacement = 0.25f;   // of the size of a halted body: its core stays at
                                                  // the impact
constexpr float kHaltedInverseMassShare = 0.01f;  // of its inverse mass, in the projection
constexpr int kMaxSegments = 2;                   // of the rest of the displacement
constexpr float kShortRotation = 0.2f;            // rad: below this rotation one segment is enough
constexpr int kCorrections = 4;                   // at the end of each segment
constexpr float kErrorTolerance = 3.0e-4f;        // m or rad: smaller errors are left to the next step
constexpr float kMaxErrorAtEnd = 1.0e-3f;         // m or rad: a segment with larger errors is undone

}  // namespace

ProjectionPath::ProjectionPath(const RigidWorld& w, const ProjectionGroup& group,
                               const ProjectionBodies& bodies, bool stop_at_impact)
    : w_(&w), members_(group.members), bodies_(bodies), stop_at_impact_(stop_at_impact) {
  find_displacements();
  segments_ = count_segments();
  for (const ProjectionMember& member : members_) {
    BodyMotion& motion = bodies_.motion[member.body] = BodyMotion{};
    motion.delta_position = member.start_displacement;
    bodies_.orientations[member.body] = member.start_orientation;
    bodies_.inertia[member.body] = {};  // zero for bodies that do not move
  }
  update_inertia();
}

// All bodies begin at the first impact.
void ProjectionPath::find_displacements() const {
  float first = 1.0f;
  for (const ProjectionMember& member : members_)
    if (member.halted != nullptr) first = min(first, member.halted->fraction);
  for (ProjectionMember& member : members_) {
    const BodyMotion& motion = w_->bodies.motion[member.body];
    const bool is_simulated_body = is_simulated(w_->bodies.flags[member.body]);
    const HaltedBody* const halt = member.halted;
    const Vec3 delta_position = halt != nullptr     ? halt->delta_position
                                : is_simulated_body ? motion.delta_position
                                                    : Vec3{};
    const Vec3 delta_rotation = halt != nullptr     ? halt->delta_rotation
                                : is_simulated_body ? motion.delta_rotation
                                                    : Vec3{};
    const Quat end = w_->bodies.orientations[member.body];
    member.start_displacement = first * delta_position;
    member.start_orientation =
        normalized(from_rotation_vector(first * delta_rotation) * w_->bodies.poses[member.body].orientation);
    member.is_in_motion = member.moves || delta_position != Vec3{} || delta_rotation != Vec3{};
    member.fixed = false;
    member.remaining_displacement = member.remaining_rotation = {};
    if (!member.is_in_motion) continue;
    member.remaining_displacement =
        (is_simulated_body ? motion.delta_position : Vec3{}) - member.start_displacement;
    member.remaining_rotation = to_rotation_vector(end * conjugate(member.start_orientation));
  }
}

int ProjectionPath::count_segments() const {
  float largest = 0.0f;
  for (const ProjectionMember& member : members_)
    largest = max(largest, length_squared(member.remaining_rotation));
  return largest < kShortRotation * kShortRotation ? 1 : kMaxSegments;
}

ProjectionPath::Next ProjectionPath::next(float error) {
  if (was_restored_) {
    was_restored_ = false;
    return begin_segment();
  }
  if (!is_moving_ && corrections_ == 0) {
    initial_error_ = error;
    save();
  }
  if (!(error < kErrorTolerance) && corrections_ < kCorrections) return correct();
  return is_moving_ ? end_segment(error) : end_start(error);
}

// Errors at the beginning of the step are no fault of the path. The group alone may be unable to close them,
// as in a stretched net; then all begin with their errors.
ProjectionPath::Next ProjectionPath::end_start(float error) {
  const bool is_closer = error <= initial_error_;
  if (!is_closer) restore();
  max_error_ = max(kMaxErrorAtEnd, 1.1f * min(error, initial_error_));
  save();
  is_moving_ = true;
  if (is_closer && !stop_at_impact_) return begin_segment();
  set_velocities(0.0f);
  if (stop_at_impact_) return Next::done;
  was_restored_ = true;
  update_inertia();
  return Next::measure;
}

ProjectionPath::Next ProjectionPath::correct() {
  ++corrections_;
  set_velocities(0.0f);
  return Next::solve;
}

ProjectionPath::Next ProjectionPath::begin_segment() {
  corrections_ = 0;
  set_velocities(1.0f / float(segments_));
  return Next::solve;
}

ProjectionPath::Next ProjectionPath::end_segment(float error) {
  const bool more_fixed = fix_displaced_bodies();
  if (!more_fixed && error < max_error_) {
    save();
    if (++segment_ < segments_) return begin_segment();
    set_velocities(0.0f);
    return Next::done;
  }
  restore();
  set_velocities(0.0f);
  if (!more_fixed) return Next::done;
  was_restored_ = true;
  update_inertia();
  return Next::measure;
}

void ProjectionPath::save() const {
  for (ProjectionMember& member : members_) {
    if (!member.is_in_motion) continue;
    member.saved_displacement = bodies_.motion[member.body].delta_position;
    member.saved_orientation = bodies_.orientations[member.body];
  }
}
void ProjectionPath::restore() const {
  for (const ProjectionMember& member : members_) {
    if (!member.is_in_motion) continue;
    bodies_.motion[member.body].delta_position = member.saved_displacement;
    bodies_.orientations[member.body] = member.saved_orientation;
  }
}

void ProjectionPath::set_velocities(float share) const {
  const float speed = share / kProjectionStep;
  for (const ProjectionMember& member : members_) {
    if (!member.is_in_motion) continue;
    BodyMotion& motion = bodies_.motion[member.body];
    motion.linear_velocity = speed * member.remaining_displacement;
    motion.angular_velocity = speed * member.remaining_rotation;
  }
}

void ProjectionPath::advance() {
  for (const ProjectionMember& member : members_) {
    if (!member.is_in_motion) continue;
    BodyMotion& motion = bodies_.motion[member.body];
    Quat& orientation = bodies_.orientations[member.body];
    motion.delta_position += kProjectionStep * motion.linear_velocity;
    orientation = normalized(from_rotation_vector(kProjectionStep * motion.angular_velocity) * orientation);
    motion.linear_velocity = motion.angular_velocity = {};
  }
  update_inertia();
}

void ProjectionPath::update_inertia() const {
  for (const ProjectionMember& member : members_) {
    if (!member.moves) continue;
    BodyInertia& inertia = bodies_.inertia[member.body];
    inertia = world_inertia(w_->bodies.masses[member.body], w_->bodies.flags[member.body],
                            bodies_.orientations[member.body]);
    const float share = member.fixed ? 0.0f : member.halted != nullptr ? kHaltedInverseMassShare : 1.0f;
    inertia.inverse_mass *= share;
    inertia.inverse = share * inertia.inverse;
  }
}

// Fixes halted bodies that moved further than they may. Returns true if there are more of them than before.
bool ProjectionPath::fix_displaced_bodies() const {
  const float share = float(segment_ + 1) / float(segments_);
  bool any = false;
  for (ProjectionMember& member : members_) {
    if (member.halted == nullptr || !member.moves || member.fixed) continue;
    const Vec3 displacement = bodies_.motion[member.body].delta_position -
                              (member.start_displacement + share * member.remaining_displacement);
    const Quat planned = from_rotation_vector(share * member.remaining_rotation) * member.start_orientation;
    const Vec3 rotation = to_rotation_vector(bodies_.orientations[member.body] * conjugate(planned));
    const BodyMass& mass = w_->bodies.masses[member.body];
    member.fixed = length(displacement) + length(rotation) * mass.bounding_radius > kMaxHaltedDisplacement * mass.size;
    any = any || member.fixed;
  }
  return any;
}

}  // namespace gyre
