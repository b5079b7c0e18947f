// A fast body that a sweep takes back leaves its joints open by what it lost, up to the way of a whole step; taken back by speeds,
// that would show for some steps and throw what hangs there about. So what hangs together is led from where all of it was when the
// first body was stopped along the rest of its way (rigid/continuous/ccd_projection_path.h). Of all motions that keep to the equations and limits of the
// joints, each part takes the one nearest to the bodies' own, by mass. Stopped bodies weigh more meanwhile, and are held where that is
// not enough, or they could be moved through what stopped them. What another goes into by that, its contacts take back.
#include "rigid/continuous/ccd_joint_projection.h"

#include "collision/continuous/continuous.h"
#include "math/rotation.h"
#include "rigid/continuous/ccd_joint_projection_rows.h"
#include "rigid/continuous/ccd_joint_projection_simd.h"

namespace gyre {

namespace {

ProjectionBodies make_bodies(const RigidWorld& w, Arena& arena) {
  const std::size_t count = w.bodies.motion.size();
  return {arena.make<BodyMotion>(count), arena.make<BodyInertia>(count), arena.make<Quat>(count)};
}

// Puts the group where it was led to.
void write(RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
           Array<std::uint32_t>& moved) {
  for (const ProjectionMember& member : group.members) {
    if (!member.moves) continue;
    const std::uint32_t body = member.body;
    BodyMotion& motion = w.bodies.motion[body];
    const BodyMass& mass = w.bodies.masses[body];
    const Quat orientation = bodies.orientations[body];
    const Vec3 way = bodies.motion[body].moved - motion.moved;
    const Vec3 turn = to_rotation_vector(orientation * conjugate(w.bodies.orientations[body]));
    if (is_fast(way, turn, mass.bounding_radius, mass.size)) moved.push_back(body);
    motion.moved = bodies.motion[body].moved + Vec3{};
    motion.turned = to_rotation_vector(orientation * conjugate(w.bodies.poses[body].orientation)) + Vec3{};
    w.bodies.orientations[body] = orientation;
    w.bodies.inertia[body] = world_inertia(mass, w.bodies.flags[body], orientation);
  }
}

}  // namespace

bool constrains_position(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  const JointDetail* const detail = detail_of(w.joints, joint);
  return (detail == nullptr || !detail->disabled) &&
         (kind == JointKind::ball || kind == JointKind::hinge || kind == JointKind::fixed ||
          kind == JointKind::cone || kind == JointKind::universal);
}

void project_joints_after_ccd(RigidWorld& w, std::span<const HaltedBody> stopped, bool stop_at_impact,
                              const SolverKernels& kernels, TaskSystem& tasks, Array<std::uint32_t>& moved,
                              Arena& arena) {
  const ArenaScope scope(arena);
  const ProjectionBodies bodies = make_bodies(w, arena);
  const std::span<const ProjectionGroup> groups = find_projection_groups(w, stopped, arena);
  const std::span<const std::uint8_t> is_led =
      project_batched(w, groups, bodies, stop_at_impact, kernels, tasks, arena);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (is_led[i] != 0 || follow_by_rows(w, groups[i], bodies, stop_at_impact, arena))
      write(w, groups[i], bodies, moved);
}

}  // namespace gyre
