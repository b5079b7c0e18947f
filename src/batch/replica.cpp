// Bodies that follow another process. In: their motion there. Out: columns of this world. See gyre/replica.h.
#include "rigid/rigid_step.h"
#include "world/world_access.h"

#include <gyre/replica.h>

#include <cmath>

namespace gyre {

namespace {

bool is_finite(const ReplicaMotion& m) {
  const Quat q = m.orientation;
  const Vec3 v = m.linear_velocity, w = m.angular_velocity;
  const double sum = m.center.x + m.center.y + m.center.z + double(q.x) + double(q.y) + double(q.z) +
                     double(q.w) + double(v.x) + double(v.y) + double(v.z) + double(w.x) + double(w.y) +
                     double(w.z);
  return std::isfinite(sum);
}

}  // namespace

ReplicaMotion replica_motion(const World& world, BodyId body) {
  if (!world.exists(body)) return {};
  const BodyStore& bodies = state_of(world).rigid.bodies;
  const BodyMotion& motion = bodies.motion[body.index];
  const BodyPose& pose = bodies.poses[body.index];
  return {pose.center, pose.orientation, motion.linear_velocity, motion.angular_velocity};
}

bool set_replica_motion(World& world, BodyId body, const ReplicaMotion& motion) {
  if (!world.exists(body) || !is_finite(motion)) return false;
  WorldState& state = state_of(world);
  RigidWorld& w = state.rigid;
  if (state.stepping || state.log != nullptr || w.bodies.flags[body.index].type == BodyType::fixed)
    return false;
  if (replica_motion(world, body) == motion) return true;
  w.bodies.poses[body.index] = {motion.center, motion.orientation};
  w.bodies.orientations[body.index] = motion.orientation;
  w.bodies.motion[body.index].linear_velocity = motion.linear_velocity;
  w.bodies.motion[body.index].angular_velocity = motion.angular_velocity;
  refresh_inertia(w.bodies, body.index);
  for (const ShapeId id : w.bodies.shapes[body.index]) refit_placed_shape(w, id.index);
  mark_moved(w, body.index);
  note_change(state);
  return true;
}

float bounding_radius(const World& world, BodyId body) {
  return world.exists(body) ? state_of(world).rigid.bodies.masses[body.index].bounding_radius : 0.0f;
}

}  // namespace gyre
