// A fast body that CCD moved back leaves its joints open by the displacement that it lost, up to that of a
// whole step. Removed by velocities, the error would be visible for some steps and throw the connected bodies
// about. So a group is moved from its pose at the first impact along the rest of its displacement
// (rigid/continuous/ccd_projection_path.h). Each segment takes the motion nearest to the bodies' own, by
// mass, that satisfies the equations and limits of the joints. Halted bodies are heavier meanwhile, and fixed
// if that is not enough, or they could pass through their blocker. Penetrations of other bodies are left to
// contacts.
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

// Writes the new poses of the group.
void store_poses(RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                 Array<std::uint32_t>& moved) {
  for (const ProjectionMember& member : group.members) {
    if (!member.moves) continue;
    const std::uint32_t body = member.body;
    BodyMotion& motion = w.bodies.motion[body];
    const BodyMass& mass = w.bodies.masses[body];
    const Quat orientation = bodies.orientations[body];
    const Vec3 displacement = bodies.motion[body].delta_position - motion.delta_position;
    const Vec3 rotation = to_rotation_vector(orientation * conjugate(w.bodies.orientations[body]));
    if (is_fast(displacement, rotation, mass.bounding_radius, mass.size)) moved.push_back(body);
    motion.delta_position = bodies.motion[body].delta_position + Vec3{};
    motion.delta_rotation =
        to_rotation_vector(orientation * conjugate(w.bodies.poses[body].orientation)) + Vec3{};
    w.bodies.orientations[body] = orientation;
    w.bodies.inertia[body] = world_inertia(mass, w.bodies.flags[body], orientation);
  }
}

}  // namespace

bool constrains_position(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  return is_joint_enabled(w, joint) &&
         (kind == JointKind::ball || kind == JointKind::hinge || kind == JointKind::fixed ||
          kind == JointKind::cone || kind == JointKind::universal);
}

void project_joints_after_ccd(RigidWorld& w, std::span<const HaltedBody> halted, bool stop_at_impact,
                              const SolverKernels& kernels, TaskSystem& tasks, Array<std::uint32_t>& moved,
                              Arena& arena) {
  const ArenaScope scope(arena);
  const ProjectionBodies bodies = make_bodies(w, arena);
  const std::span<const ProjectionGroup> groups = find_projection_groups(w, halted, arena);
  const std::span<const std::uint8_t> is_projected =
      project_batched(w, groups, bodies, stop_at_impact, kernels, tasks, arena);
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (is_projected[i] != 0 || project_by_rows(w, groups[i], bodies, stop_at_impact, arena))
      store_poses(w, groups[i], bodies, moved);
}

}  // namespace gyre
