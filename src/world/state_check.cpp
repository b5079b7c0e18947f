// Checks loaded columns: every index is valid, every ring closes, every count fits its array. A state that passes can
// be stepped safely, whatever its numbers are.
#include "world/joint_commands.h"
#include "world/field_commands.h"
#include "world/world_state.h"

namespace gyre {

namespace {

Error inconsistent(const char* what) {
  return make_error(ErrorCode::invalid_data, "the state does not hang together: %s", what);
}

const char* fault_in_settings(const RigidSettings& settings) {
  if (settings.substeps < 1 || settings.substeps > 64) return "substeps beyond 1 to 64";
  if (!is_finite(settings.gravity)) return "gravity is not finite";
  if (!is_finite(settings.last_substep) || settings.last_substep < 0.0f)
    return "the last sub-step has no length";
  if (!is_finite(settings.last_step) || settings.last_step < 0.0f) return "the last step has no length";
  return nullptr;
}

const char* fault_in_motion(const RigidWorld& w) {
  if (w.motion_settings.size() > 1) return "settings of motion that contradict each other";
  for (const MotionSettings& m : w.motion_settings) {
    if (!is_finite(m.tolerance) || m.tolerance < kMinTolerance) return "a tolerance that nothing can keep";
    if (m.max_impacts < 1 || m.max_impacts > kMaxImpacts) return "a bound of impacts beyond 1 to 4096";
    if (m.planned_substeps < 0 || m.planned_substeps > 64) return "planned sub-steps beyond 0 to 64";
  }
  if (w.bodies.last_moves.size() > w.bodies.ids.capacity()) return "last moves of bodies that are not there";
  for (const LastMove& move : w.bodies.last_moves) {
    if (!is_finite(move.moved) || !is_finite(move.turned) || !is_finite(move.seconds) || move.seconds < 0.0)
      return "a last move that is not finite";
  }
  return nullptr;
}

const char* fault_in_sleep_speeds(const RigidWorld& w) {
  if (w.sleep_settings.size() > 1) return "settings of sleep that contradict each other";
  for (const SleepSettings& sleep : w.sleep_settings)
    if (!is_finite(sleep.share) || sleep.share < 0.0f) return "a sleep speed below zero";
  if (w.bodies.sleep_speeds.size() > w.bodies.ids.capacity()) return "sleep speeds of bodies that are not there";
  for (const BodySleepSpeed& sleep : w.bodies.sleep_speeds)
    if (!is_finite(sleep.speed) || sleep.speed < 0.0f) return "a sleep speed below zero";
  return nullptr;
}

const char* fault_in_ignored_pairs(const RigidWorld& w) {
  const IgnoredPair* before = nullptr;
  for (const IgnoredPair& pair : w.ignored_pairs) {
    if (pair.a >= pair.b || pair.b >= w.bodies.ids.capacity() || !w.bodies.ids.live(pair.a) ||
        !w.bodies.ids.live(pair.b)) {
      return "an ignored pair of bodies that are not there";
    }
    if (before != nullptr && (before->a > pair.a || (before->a == pair.a && before->b >= pair.b)))
      return "ignored pairs that are not in order";
    before = &pair;
  }
  return nullptr;
}

const char* fault_in_sizes(const RigidWorld& w) {
  const BodyStore& b = w.bodies;
  const std::size_t bodies = b.ids.capacity();
  if (b.motion.size() != bodies || b.poses.size() != bodies || b.masses.size() != bodies ||
      b.forces.size() != bodies || b.flags.size() != bodies || b.sleep.size() != bodies ||
      b.overrides.size() != bodies || b.user_data.size() != bodies) {
    return "the body columns differ in length";
  }
  const ShapeStore& s = w.shapes;
  const std::size_t shapes = s.ids.capacity();
  if (s.bodies.size() != shapes || s.body_from_shape.size() != shapes || s.proxies.size() != shapes ||
      s.materials.size() != shapes || s.geometry.size() != shapes || s.density.size() != shapes ||
      s.user_data.size() != shapes) {
    return "the shape columns differ in length";
  }
  if (w.joints.records.size() != w.joints.ids.capacity() || w.joints.details.size() > w.joints.records.size())
    return "the joint columns differ in length";
  if (w.contacts.manifolds.size() % kMaxMeshManifolds != 0) return "manifolds do not fill chunks";
  return nullptr;
}

const char* fault_in_body(const BodyStore& bodies, std::uint32_t i) {
  const BodyFlags& flags = bodies.flags[i];
  if (flags.type > BodyType::dynamic) return "a body of unknown type";
  if (flags.frozen > kDisabled) return "a body that is neither enabled nor disabled";
  const BodyPose& body_pose = bodies.poses[i];
  if (!is_finite(body_pose.center) || !is_finite(body_pose.orientation))
    return "a body whose place is not finite";
  if (!is_finite(bodies.motion[i].linear_velocity) || !is_finite(bodies.motion[i].angular_velocity)) {
    return "a body whose velocity is not finite";
  }
  const bool asleep = bodies.ids.live(i) && is_movable(flags) && flags.awake == 0;
  if (asleep != (bodies.sleep[i].group != kNoGroup))
    return "a body that sleeps outside a group, or wakes in one";
  return nullptr;
}

// Each group must be one ring that starts at its lowest body, since waking a member visits the whole ring.
const char* fault_in_groups(const BodyStore& bodies) {
  const std::uint32_t count = std::uint32_t(bodies.sleep.size());
  std::uint32_t members = 0, walked = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const BodySleep& sleep = bodies.sleep[i];
    if (sleep.group == kNoGroup) continue;
    ++members;
    if (sleep.group > i || bodies.sleep[sleep.group].group != sleep.group)
      return "a sleeping group without its first body";
    if (sleep.group != i) continue;
    std::uint32_t at = i;
    do {
      at = bodies.sleep[at].next_in_group;
      if (at >= count || bodies.sleep[at].group != i || ++walked > count)
        return "a sleeping group that is no ring";
    } while (at != i);
  }
  return members == walked ? nullptr : "a sleeping body outside its group's ring";
}

const char* fault_in_shape(const RigidWorld& w, std::uint32_t i) {
  const Proxy& proxy = w.shapes.proxies[i];
  const bool live = w.shapes.ids.live(i);
  if (proxy.motion > ProxyMotion::moving) return "a proxy of unknown motion";
  if (proxy.motion != ProxyMotion::none && !live) return "a proxy without a shape";
  if (check_shape(w.shapes.geometry[i])) return "a shape that cannot be";
  if (!live) return nullptr;
  const std::uint32_t body = w.shapes.bodies[i];
  if (!w.bodies.ids.live(body)) return "a shape without a body";
  if ((proxy.motion == ProxyMotion::none) != is_disabled(w.bodies.flags[body])) return "a shape without a proxy";
  if (proxy.body != body) return "a proxy of another body than its shape";
  const Transform& local = w.shapes.body_from_shape[i];
  if (!is_finite(local.position) || !is_finite(local.orientation)) return "a shape whose place is not finite";
  const Aabb& box = proxy.fat_box;
  if (!is_finite(box.low) || !is_finite(box.high)) return "a fat box that is not finite";
  for (int axis = 0; axis < 3; ++axis) {
    if (box.low[axis] > box.high[axis]) return "a fat box without an inside";
  }
  return nullptr;
}

const char* fault_in_joint(const RigidWorld& w, const JointRecord& joint) {
  if (int(joint.kind) >= kJointKindCount) return "a joint of unknown kind";
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body != kNoBody && (body < 0 || !w.bodies.ids.live(std::uint32_t(body))))
      return "a joint without a body";
  }
  if (joint.body_a == joint.body_b) return "a joint between one thing and itself";
  return nullptr;
}

// True if joints of this kind cannot be solved without details.
bool needs_detail(JointKind kind) { return kind > JointKind::distance; }

const char* fault_in_detail(const JointStore& joints, std::uint32_t slot) {
  const JointDetail* const detail = detail_of(joints, slot);
  if (!joints.ids.live(slot)) return detail != nullptr ? "details of a joint that is not there" : nullptr;
  const JointKind kind = joints.records[slot].kind;
  if (detail == nullptr) return needs_detail(kind) ? "a joint without its details" : nullptr;
  if (std::uint64_t(detail->path_first) + detail->path_count > joints.path_points.size())
    return "a curve without its points";
  if ((kind == JointKind::path) != (detail->path_count > 0)) return "a joint with a curve that is not bound to one";
  if (kind == JointKind::path && detail->path_count < (detail->path_closed ? 3u : 2u)) return "a curve of too few points";
  const PoseDrive& drive = detail->drive;
  for (const float value :
       {detail->ratio, detail->start, detail->path_parameter, detail->swing_y, detail->swing_z,
        detail->friction, drive.frequency, drive.damping_ratio, drive.max_force, drive.max_torque}) {
    if (!is_finite(value)) return "a joint's detail that is not finite";
  }
  if (!is_finite(drive.position) || !is_finite(drive.orientation) || !is_finite(drive.linear_velocity) ||
      !is_finite(drive.angular_velocity))
    return "a joint's drive that is not finite";
  return nullptr;
}

const char* fault_in_paths(const JointStore& joints) {
  std::uint64_t points = 0;
  joints.ids.for_each_live([&](std::uint32_t slot) {
    if (const JointDetail* const detail = detail_of(joints, slot)) points += detail->path_count;
  });
  if (points != joints.path_points.size()) return "points of no curve";
  for (const PathPoint& point : joints.path_points) {
    if (!is_finite(point.position) || !is_finite(point.up) || !is_finite(point.along)) return "a point of a curve that is not finite";
  }
  return nullptr;
}

const char* fault_in_contact(const RigidWorld& w, const Contact& contact) {
  if (contact.manifold_room == 0) return nullptr;
  if (contact.manifold_room != 1 && contact.manifold_room != kMaxMeshManifolds)
    return "a contact's manifold room";
  if (contact.shape_a >= contact.shape_b) return "a contact whose first shape is not the lower one";
  if (!w.shapes.ids.live(contact.shape_a) || !w.shapes.ids.live(contact.shape_b) ||
      w.shapes.bodies[contact.shape_a] != contact.body_a ||
      w.shapes.bodies[contact.shape_b] != contact.body_b || contact.body_a == contact.body_b) {
    return "a contact without its shapes";
  }
  if (contact.manifold_count > contact.manifold_room || contact.first_manifold % contact.manifold_room != 0 ||
      std::size_t(contact.first_manifold) + contact.manifold_room > w.contacts.manifolds.size()) {
    return "a contact without its manifolds";
  }
  return nullptr;
}

const char* fault_in_rules(std::span<const SurfaceRule> rules) {
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i].id == 0 || (i > 0 && rules[i].id <= rules[i - 1].id)) return "surface rules out of order";
    if (!is_finite(rules[i].velocity) || !is_finite(rules[i].one_way)) return "a surface rule that is not finite";
    const Material& m = rules[i].material;
    for (const float value : {m.static_friction, m.dynamic_friction, m.restitution, m.rolling_friction, m.spinning_friction}) {
      if (!is_finite(value) || value < 0.0f) return "a surface rule with a bad material";
    }
  }
  return nullptr;
}

const char* fault_in_solver(std::span<const SolverSettings> solver) {
  if (solver.empty()) return nullptr;
  if (solver.size() > 1) return "more than one solver";
  if (solver[0].kind == SolverKind::soft_step) return "settings of a solver that is not there";
  return fault_in(solver[0]);
}

const char* fault_in(const RigidWorld& w) {
  const char* fault = fault_in_settings(w.settings);
  if (fault == nullptr) fault = fault_in_solver(w.solver.view());
  if (fault == nullptr) fault = fault_in_rules(w.surface_rules.view());
  if (fault == nullptr) fault = fault_in_fields(w);
  if (fault == nullptr) fault = fault_in_sizes(w);
  if (fault == nullptr) fault = fault_in_motion(w);
  if (fault == nullptr) fault = fault_in_sleep_speeds(w);
  if (fault == nullptr) fault = fault_in_ignored_pairs(w);
  if (fault == nullptr) fault = fault_in_couplings(w);
  if (fault != nullptr) return fault;
  for (std::uint32_t i = 0; fault == nullptr && i < w.bodies.ids.capacity(); ++i)
    fault = fault_in_body(w.bodies, i);
  if (fault == nullptr) fault = fault_in_groups(w.bodies);
  for (std::uint32_t i = 0; fault == nullptr && i < w.shapes.ids.capacity(); ++i)
    fault = fault_in_shape(w, i);
  for (std::uint32_t i = 0; fault == nullptr && i < w.joints.ids.capacity(); ++i) {
    if (w.joints.ids.live(i)) fault = fault_in_joint(w, w.joints.records[i]);
    if (fault == nullptr) fault = fault_in_detail(w.joints, i);
  }
  if (fault == nullptr) fault = fault_in_paths(w.joints);
  for (std::size_t i = 0; fault == nullptr && i < w.contacts.contacts.size(); ++i) {
    fault = fault_in_contact(w, w.contacts.contacts[i]);
  }
  for (std::size_t i = 0; fault == nullptr && i < w.contacts.manifolds.size(); ++i) {
    const std::int32_t count = w.contacts.manifolds[i].count;
    if (count < 0 || count > kMaxManifoldPoints) fault = "a manifold with too many points";
  }
  return fault;
}

}  // namespace

Error check_columns(const RigidWorld& w) {
  const char* const fault = fault_in(w);
  return fault != nullptr ? inconsistent(fault) : Error{};
}

Error rebuild_derived(RigidWorld& w) {
  const Error e = check_columns(w);
  if (e) return e;
  derive_state(w);
  const char* const fault = find_fault(w.contacts);
  return fault != nullptr ? inconsistent(fault) : Error{};
}

}  // namespace gyre
