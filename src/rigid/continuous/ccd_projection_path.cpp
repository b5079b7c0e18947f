#include "rigid/continuous/ccd_projection_path.h"

#include "math/rotation.h"

namespace gyre {

namespace {

constexpr float kPlay = 0.25f;          // of the size of a stopped body: its core stays where it was held
constexpr float kStoppedShare = 0.01f;  // of its inverse mass, with which it is moved
constexpr int kPartsOfRest = 2;         // of the rest of the way
constexpr float kShortTurn = 0.2f;      // rad: where nothing turns further, one is enough
constexpr int kCorrections = 4;         // at the end of each
constexpr float kOpen = 3.0e-4f;        // m or rad: less is left to the next step
constexpr float kClosed = 1.0e-3f;      // m or rad: more, and it is no way to go

}  // namespace

ProjectionPath::ProjectionPath(const RigidWorld& w, const ProjectionGroup& group,
                               const ProjectionBodies& bodies, bool stop_at_impact)
    : w_(&w), members_(group.members), bodies_(bodies), stays_(stop_at_impact) {
  find_displacements();
  parts_ = count_parts();
  for (const ProjectionMember& member : members_) {
    BodyMotion& motion = bodies_.motion[member.body] = BodyMotion{};
    motion.moved = member.start_moved;
    bodies_.orientations[member.body] = member.start_orientation;
    bodies_.inertia[member.body] = {};  // of those that do not move it stays so
  }
  place_inertia();
}

// All begin where the first was stopped.
void ProjectionPath::find_displacements() const {
  float first = 1.0f;
  for (const ProjectionMember& member : members_)
    if (member.stopped != nullptr) first = min(first, member.stopped->fraction);
  for (ProjectionMember& member : members_) {
    const BodyMotion& motion = w_->bodies.motion[member.body];
    const bool goes = is_simulated(w_->bodies.flags[member.body]);
    const HaltedBody* const stop = member.stopped;
    const Vec3 moved = stop != nullptr ? stop->moved : goes ? motion.moved : Vec3{};
    const Vec3 turned = stop != nullptr ? stop->turned : goes ? motion.turned : Vec3{};
    const Quat end = w_->bodies.orientations[member.body];
    member.start_moved = first * moved;
    member.start_orientation =
        normalized(from_rotation_vector(first * turned) * w_->bodies.poses[member.body].orientation);
    member.goes = member.moves || moved != Vec3{} || turned != Vec3{};
    member.held = false;
    member.rest_moved = member.rest_turned = {};
    if (!member.goes) continue;
    member.rest_moved = (goes ? motion.moved : Vec3{}) - member.start_moved;
    member.rest_turned = to_rotation_vector(end * conjugate(member.start_orientation));
  }
}

int ProjectionPath::count_parts() const {
  float most = 0.0f;
  for (const ProjectionMember& member : members_) most = max(most, length_squared(member.rest_turned));
  return most < kShortTurn * kShortTurn ? 1 : kPartsOfRest;
}

ProjectionPath::Next ProjectionPath::next(float open) {
  if (was_put_back_) {
    was_put_back_ = false;
    return begin_part();
  }
  if (!goes_ && corrections_ == 0) {
    first_open_ = open;
    keep();
  }
  if (!(open < kOpen) && corrections_ < kCorrections) return correct();
  return goes_ ? end_part(open) : end_start(open);
}

// What was off as the step began is no fault of the way. It may be more than the group alone can close, of a net that is stretched for
// one: then all begin as far off as they were.
ProjectionPath::Next ProjectionPath::end_start(float open) {
  const bool is_closer = open <= first_open_;
  if (!is_closer) put_back();
  least_ = max(kClosed, 1.1f * min(open, first_open_));
  keep();
  goes_ = true;
  if (is_closer && !stays_) return begin_part();
  set_velocities(0.0f);
  if (stays_) return Next::done;
  was_put_back_ = true;
  place_inertia();
  return Next::look;
}

ProjectionPath::Next ProjectionPath::correct() {
  ++corrections_;
  set_velocities(0.0f);
  return Next::solve;
}

ProjectionPath::Next ProjectionPath::begin_part() {
  corrections_ = 0;
  set_velocities(1.0f / float(parts_));
  return Next::solve;
}

ProjectionPath::Next ProjectionPath::end_part(float open) {
  const bool more_held = hold_those_moved_far();
  if (!more_held && open < least_) {
    keep();
    if (++part_ < parts_) return begin_part();
    set_velocities(0.0f);
    return Next::done;
  }
  put_back();
  set_velocities(0.0f);
  if (!more_held) return Next::done;
  was_put_back_ = true;
  place_inertia();
  return Next::look;
}

void ProjectionPath::keep() const {
  for (ProjectionMember& member : members_) {
    if (!member.goes) continue;
    member.kept_moved = bodies_.motion[member.body].moved;
    member.kept_orientation = bodies_.orientations[member.body];
  }
}
void ProjectionPath::put_back() const {
  for (const ProjectionMember& member : members_) {
    if (!member.goes) continue;
    bodies_.motion[member.body].moved = member.kept_moved;
    bodies_.orientations[member.body] = member.kept_orientation;
  }
}

void ProjectionPath::set_velocities(float share) const {
  const float speed = share / kProjectionStep;
  for (const ProjectionMember& member : members_) {
    if (!member.goes) continue;
    BodyMotion& motion = bodies_.motion[member.body];
    motion.linear_velocity = speed * member.rest_moved;
    motion.angular_velocity = speed * member.rest_turned;
  }
}

void ProjectionPath::advance() {
  for (const ProjectionMember& member : members_) {
    if (!member.goes) continue;
    BodyMotion& motion = bodies_.motion[member.body];
    Quat& orientation = bodies_.orientations[member.body];
    motion.moved += kProjectionStep * motion.linear_velocity;
    orientation = normalized(from_rotation_vector(kProjectionStep * motion.angular_velocity) * orientation);
    motion.linear_velocity = motion.angular_velocity = {};
  }
  place_inertia();
}

void ProjectionPath::place_inertia() const {
  for (const ProjectionMember& member : members_) {
    if (!member.moves) continue;
    BodyInertia& inertia = bodies_.inertia[member.body];
    inertia = world_inertia(w_->bodies.masses[member.body], w_->bodies.flags[member.body],
                            bodies_.orientations[member.body]);
    const float share = member.held ? 0.0f : member.stopped != nullptr ? kStoppedShare : 1.0f;
    inertia.inverse_mass *= share;
    inertia.inverse = share * inertia.inverse;
  }
}

// Holds stopped bodies that were moved further than they may be. Returns whether there are more of these than before.
bool ProjectionPath::hold_those_moved_far() const {
  const float share = float(part_ + 1) / float(parts_);
  bool any = false;
  for (ProjectionMember& member : members_) {
    if (member.stopped == nullptr || !member.moves || member.held) continue;
    const Vec3 way = bodies_.motion[member.body].moved - (member.start_moved + share * member.rest_moved);
    const Quat planned = from_rotation_vector(share * member.rest_turned) * member.start_orientation;
    const Vec3 turn = to_rotation_vector(bodies_.orientations[member.body] * conjugate(planned));
    const BodyMass& mass = w_->bodies.masses[member.body];
    member.held = length(way) + length(turn) * mass.bounding_radius > kPlay * mass.size;
    any = any || member.held;
  }
  return any;
}

}  // namespace gyre
