#include "rigid/sleep/support.h"

#include "base/container/small_array.h"
#include "geometry/shape/mesh.h"

namespace gyre {

namespace {

bool moves_like_a_belt(const RigidWorld& w, std::uint32_t shape) {
  const std::uint16_t id = w.shapes.materials[shape].id;
  const Shape& form = w.shapes.colliders[shape].shape;
  const bool has_triangles_of_materials = form.kind == ShapeKind::mesh && !form.mesh->materials.empty();
  for (const SurfaceRule& rule : w.surface_rules) {
    if (rule.velocity != Vec3{} && ((id != 0 && rule.id == id) || has_triangles_of_materials)) return true;
  }
  return false;
}

// N s: the impulse with which friction at the points of a contact may stop a body in a step like the last.
float grip_of(const RigidWorld& w, const Contact& contact) {
  float load = 0.0f;
  for (const Manifold& manifold : manifolds_of(w.contacts, contact))
    for (int k = 0; k < manifold.count; ++k) load += max(manifold.points[k].total_impulse, 0.0f);
  return load * min(contact.surface.static_friction, contact.surface.dynamic_friction);
}

void add_motor(JointDrives& drives, float velocity, bool has_target, float force, float lever) {
  if (!(force > 0.0f)) return;
  if (has_target || velocity != 0.0f) drives.any = true;
  if (velocity != 0.0f) drives.slowest = min(drives.slowest, lever * absolute(velocity));
}

void add_velocity(JointDrives& drives, Vec3 velocity, float force, float lever) {
  add_motor(drives, length(velocity), true, force, lever);
}

}  // namespace

bool is_held_by_friction(const RigidWorld& w, std::uint32_t body, float speed, float time, float seconds) {
  // In order of slot: the lists of contacts have none, and sums depend on theirs.
  SmallArray<std::uint32_t, 16> slots;
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) {
    std::size_t at = slots.size();
    while (at > 0 && slots[at - 1] > slot) --at;
    slots.insert_at(at, slot);
  });
  float grip = 0.0f;
  for (const std::uint32_t slot : slots) {
    const Contact& contact = w.contacts.contacts[slot];
    if (contact.sensor != 0 || contact.manifold_count == 0) continue;
    const float own = grip_of(w, contact);
    const bool on_belt = !w.surface_rules.empty() &&
                         (moves_like_a_belt(w, contact.shape_a) || moves_like_a_belt(w, contact.shape_b));
    if (on_belt && own > 0.0f) return false;
    grip += own;
  }
  return grip * w.bodies.masses[body].inverse_mass * time >= speed * seconds;
}

JointDrives find_joint_drives(const RigidWorld& w, std::uint32_t body, float radius) {
  JointDrives drives;
  for (const std::uint32_t slot : joints_of(w.bodies, body)) {
    const JointRecord& joint = w.joints.records[slot];
    const JointDetail* const detail = detail_of(w.joints, slot);
    if (!is_joint_enabled(w, slot)) continue;
    if (joint.is_spring || joint.stiffness > 0.0f) drives.any = true;
    const bool is_linear = joint.kind == JointKind::slider || joint.kind == JointKind::path ||
                           joint.kind == JointKind::distance || joint.kind == JointKind::pulley;
    add_motor(drives, joint.motor_velocity, joint.has_motor_target, joint.motor_force,
              is_linear ? 1.0f : radius);
    if (detail == nullptr) continue;
    for (int axis = 0; axis < 6; ++axis) {
      const JointAxisRecord& record = detail->axes[axis];
      if (record.stiffness > 0.0f) drives.any = true;
      add_motor(drives, record.motor_velocity, record.has_motor_target, record.motor_force,
                axis < 3 ? 1.0f : radius);
    }
    add_velocity(drives, detail->drive.linear_velocity, detail->drive.max_force, 1.0f);
    add_velocity(drives, detail->drive.angular_velocity, detail->drive.max_torque, radius);
  }
  return drives;
}

}  // namespace gyre
