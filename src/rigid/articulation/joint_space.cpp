#include "rigid/articulation/joint_space.h"

#include "math/dense.h"

namespace gyre {

namespace {

bool moves(const RigidWorld& w, std::int32_t body) {
  return body != kNoBody && is_movable(w.bodies.flags[std::size_t(body)]);
}

// True if the joint leaves relative motion along axes that are coordinates, or none.
bool is_tree_joint(const RigidWorld& w, std::uint32_t slot) {
  switch (w.joints.records[slot].kind) {
    case JointKind::ball:
    case JointKind::cone:
    case JointKind::hinge:
    case JointKind::slider:
    case JointKind::fixed:
    case JointKind::universal:
    case JointKind::six_dof:
    case JointKind::wheel:
      return is_joint_enabled(w, slot);
    default:
      return false;
  }
}

// Finds all bodies of the component of `body`, and the joint that holds it.
class TreeFinder {
 public:
  TreeFinder(const RigidWorld& w, JointSpace& out) : w_(w), out_(out) {}

  bool find(std::uint32_t body) {
    std::uint32_t holder = kNoIndex, lowest = body;
    std::vector<std::uint32_t>& found = out_.found;
    found.assign(1, body);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found.size() > kMaxJointCoordinates) return false;
      lowest = min(lowest, found[i]);
      for (const std::uint32_t slot : joints_of(w_.bodies, found[i])) {
        if (!is_tree_joint(w_, slot)) continue;
        const std::int32_t other = other_end(slot, found[i]);
        if (!moves(w_, other)) {
          holder = min(holder, slot);
        } else if (!is_listed(std::uint32_t(other))) {
          found.push_back(std::uint32_t(other));
        }
      }
    }
    if (holder == kNoIndex) {
      add_link(lowest, -1, kNoIndex);
    } else {
      const JointRecord& joint = w_.joints.records[holder];
      add_link(std::uint32_t(moves(w_, joint.body_b) ? joint.body_b : joint.body_a), -1, holder);
    }
    return grow();
  }

 private:
  std::int32_t other_end(std::uint32_t slot, std::uint32_t body) const {
    const JointRecord& joint = w_.joints.records[slot];
    return joint.body_a == std::int32_t(body) ? joint.body_b : joint.body_a;
  }
  bool is_listed(std::uint32_t body) const {
    for (const std::uint32_t one : out_.found)
      if (one == body) return true;
    return false;
  }
  bool is_used(std::uint32_t slot) const {
    for (const JointLink& link : out_.links)
      if (link.joint == slot) return true;
    return false;
  }

  bool grow() {
    for (std::size_t i = 0; i < out_.links.size(); ++i) {
      const std::uint32_t body = out_.links[i].body;
      for (const std::uint32_t slot : joints_of(w_.bodies, body)) {
        if (!is_tree_joint(w_, slot) || is_used(slot)) continue;
        const std::int32_t other = other_end(slot, body);
        const bool is_new = moves(w_, other) && find_link(out_, std::uint32_t(other)) < 0;
        // A joint between two links is met from both.
        if (!is_new && (!moves(w_, other) || std::uint32_t(other) > body)) ++out_.loops;
        if (is_new) add_link(std::uint32_t(other), std::int32_t(i), slot);
        if (out_.coordinates.size() > kMaxJointCoordinates) return false;
      }
    }
    return true;
  }

  void add_link(std::uint32_t body, std::int32_t parent, std::uint32_t slot) {
    JointLink link{
        .body = body, .parent = parent, .joint = slot, .first = std::uint32_t(out_.coordinates.size())};
    const std::uint32_t number = std::uint32_t(out_.links.size());
    if (slot != kNoIndex) link.is_b = w_.joints.records[slot].body_b == std::int32_t(body);
    for (int i = 0; i < kJointAxisCount; ++i) {
      const JointAxis axis = JointAxis(i);
      if (slot != kNoIndex && !is_coordinate(w_.joints.records[slot], detail_of(w_.joints, slot), axis))
        continue;
      out_.coordinates.push_back({number, slot, axis});
    }
    link.end = std::uint32_t(out_.coordinates.size());
    out_.links.push_back(link);
  }

  const RigidWorld& w_;
  JointSpace& out_;
};

// The motion of an end of a joint.
struct EndState {
  DVec3 center, velocity, spin;
  DQuat orientation;
};

EndState read_body(const RigidWorld& w, std::uint32_t body, bool in_step) {
  const BodyMotion& motion = w.bodies.motion[body];
  const bool is_still =
      w.bodies.flags[body].type == BodyType::fixed || w.bodies.flags[body].frozen != kNotFrozen;
  EndState end{w.bodies.poses[body].center, {}, {}, normalized(to_double(w.bodies.orientations[body]))};
  if (is_still) return end;
  if (in_step) end.center = end.center + DVec3(motion.delta_position);
  end.velocity = DVec3(motion.linear_velocity), end.spin = DVec3(motion.angular_velocity);
  return end;
}

// The directions of the axes of a joint, from the motion of its ends.
struct JointGeometry {
  DVec3 linear[3], angular[3];
  DVec3 spin_of[3];  // the angular velocity with which angular[i] rotates
};

JointGeometry find_geometry(const JointRecord& joint, const EndState& a, const EndState& b) {
  const DQuat frame_a = a.orientation * to_double(joint.local_frame_a);
  const DQuat frame_b = b.orientation * to_double(joint.local_frame_b);
  JointGeometry out;
  const DVec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < 3; ++i) {
    out.linear[i] = out.angular[i] = rotate(frame_a, unit[i]);
    out.spin_of[i] = a.spin;
  }
  if (joint.kind == JointKind::ball || joint.kind == JointKind::cone) return out;
  // Cardan angles: about a's x, about y of the frame between, about b's z.
  out.angular[2] = rotate(frame_b, unit[2]);
  out.spin_of[2] = b.spin;
  const DVec3 y = cross(out.angular[2], out.angular[0]);
  const double sine = length(y);
  if (sine > 1.0e-9) out.angular[1] = y / sine;
  // y rotates with a, and about x with the angle x, whose rate is that of z about x.
  const DVec3 relative = b.spin - a.spin;
  const DVec3 across = cross(out.angular[1], out.angular[2]);
  const double along = dot(out.angular[0], across);
  const double rate = absolute(along) > 1.0e-9 ? dot(relative, across) / along : 0.0;
  out.spin_of[1] = a.spin + rate * out.angular[0];
  return out;
}

// Solves sum over k of axis[k] speed[k] = value in the least squares; at most three axes.
void solve_speeds(std::span<const JointDirection> directions, bool angular, DVec3 value,
                  std::span<double> speeds) {
  double gram[3][3] = {}, right[3] = {};
  int count = 0, place[3] = {};
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (directions[i].is_angular == angular) place[count++] = int(i);
  for (int i = 0; i < 3; ++i) gram[i][i] = 1.0;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j)
      gram[i][j] = dot(directions[std::size_t(place[i])].axis, directions[std::size_t(place[j])].axis);
    right[i] = dot(directions[std::size_t(place[i])].axis, value);
  }
  solve_ldlt(factor_ldlt(gram), right);
  for (int i = 0; i < count; ++i) speeds[std::size_t(place[i])] = right[i];
}

// The two ends of the joint of a link, and b's anchor.
struct JointEnds {
  EndState a, b;
  DVec3 anchor;

  JointEnds(const RigidWorld& w, const JointRecord& joint, bool in_step) {
    if (joint.body_a != kNoBody) a = read_body(w, std::uint32_t(joint.body_a), in_step);
    if (joint.body_b != kNoBody) b = read_body(w, std::uint32_t(joint.body_b), in_step);
    anchor = joint.body_b == kNoBody ? joint.world_anchor_b
                                     : b.center + rotate(b.orientation, DVec3(joint.local_anchor_b));
    if (joint.body_a == kNoBody) a.center = anchor;
    if (joint.body_b == kNoBody) b.center = anchor;
  }
  // The velocity of b's anchor as a sees it.
  DVec3 sliding() const {
    return b.velocity + cross(b.spin, anchor - b.center) - a.velocity - cross(a.spin, anchor - a.center);
  }
};

void measure_speeds(JointSpace& space, const JointLink& link, const JointEnds& ends) {
  if (link.first == link.end) return;
  const std::span<const JointDirection> own(&space.directions[0] + link.first, link.end - link.first);
  const std::span<double> speeds(&space.speeds[0] + link.first, link.end - link.first);
  solve_speeds(own, false, ends.sliding(), speeds);
  solve_speeds(own, true, ends.b.spin - ends.a.spin, speeds);
}

// Fills the directions and speeds of a link's coordinates.
void measure_joint(const RigidWorld& w, JointSpace& space, std::size_t number, bool in_step) {
  const JointLink& link = space.links[number];
  const JointRecord& joint = w.joints.records[link.joint];
  const JointEnds ends(w, joint, in_step);
  const JointGeometry geometry = find_geometry(joint, ends.a, ends.b);
  for (std::uint32_t i = link.first; i < link.end; ++i) {
    const int axis = int(space.coordinates[i].axis);
    const bool angular = axis >= 3;
    const DVec3 direction = angular ? geometry.angular[axis - 3] : geometry.linear[axis];
    const DVec3 spin = angular ? geometry.spin_of[axis - 3] : ends.a.spin;
    space.directions[i] = {direction, cross(spin, direction), angular};
  }
  measure_speeds(space, link, ends);
}

void read_base_speeds(JointSpace& space, const EndState& state) {
  const DVec3 v = state.velocity, s = state.spin;
  const double speeds[6] = {v.x, v.y, v.z, s.x, s.y, s.z};
  for (std::size_t k = 0; k < 6; ++k) space.speeds[k] = speeds[k];
}

// b's anchor of the joint to the parent.
DVec3 anchor_of(const RigidWorld& w, const JointSpace& space, std::size_t number, bool in_step) {
  const JointLink& link = space.links[number];
  const JointRecord& joint = w.joints.records[link.joint];
  if (joint.body_b == kNoBody) return joint.world_anchor_b;
  const EndState b = link.is_b ? EndState{space.centers[number], {}, {}, space.orientations[number]}
                               : read_body(w, std::uint32_t(joint.body_b), in_step);
  return b.center + rotate(b.orientation, DVec3(joint.local_anchor_b));
}

void set_column(JointSpace& space, std::size_t number, std::size_t column, DVec3 linear, DVec3 angular) {
  const double values[6] = {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
  for (std::size_t i = 0; i < 6; ++i) space.jacobians[(number * 6 + i) * space.size() + column] = values[i];
}
void get_column(const JointSpace& space, std::size_t number, std::size_t column, DVec3& linear,
                DVec3& angular) {
  const auto at = [&](std::size_t i) { return space.jacobians[(number * 6 + i) * space.size() + column]; };
  linear = {at(0), at(1), at(2)}, angular = {at(3), at(4), at(5)};
}

void fill_jacobian(const RigidWorld& w, JointSpace& space, std::size_t number, bool in_step) {
  const JointLink& link = space.links[number];
  if (link.parent >= 0) {
    const std::size_t parent = std::size_t(link.parent);
    const DVec3 arm = space.centers[number] - space.centers[parent];
    for (std::size_t column = 0; column < link.first; ++column) {
      DVec3 linear, angular;
      get_column(space, parent, column, linear, angular);
      set_column(space, number, column, linear + cross(angular, arm), angular);
    }
  }
  if (link.joint == kNoIndex) {
    for (std::uint32_t i = 0; i < 6; ++i)
      space.jacobians[(number * 6 + i) * space.size() + link.first + i] = 1.0;
    return;
  }
  const DVec3 arm = space.centers[number] - anchor_of(w, space, number, in_step);
  const double sign = link.is_b ? 1.0 : -1.0;
  for (std::uint32_t i = link.first; i < link.end; ++i) {
    const JointDirection& direction = space.directions[i];
    const DVec3 axis = sign * direction.axis;
    if (direction.is_angular) set_column(space, number, i, cross(axis, arm), axis);
    if (!direction.is_angular) set_column(space, number, i, axis, {});
  }
}

// Inertia about the centre of mass, world axes.
struct WorldInertia {
  double mass = 0.0;
  Sym3 body;
  DQuat orientation;

  WorldInertia(const RigidWorld& w, std::uint32_t of, DQuat at)
      : mass(double(w.bodies.masses[of].mass)), body(w.bodies.masses[of].inertia), orientation(at) {}
  DVec3 times(DVec3 v) const {
    const DVec3 l = rotate_inverse(orientation, v);
    const Sym3& m = body;
    return rotate(orientation, {double(m.xx) * l.x + double(m.xy) * l.y + double(m.xz) * l.z,
                                double(m.xy) * l.x + double(m.yy) * l.y + double(m.yz) * l.z,
                                double(m.xz) * l.x + double(m.yz) * l.y + double(m.zz) * l.z});
  }
};

void add_mass(const RigidWorld& w, JointSpace& space, std::size_t number) {
  const JointLink& link = space.links[number];
  const WorldInertia inertia(w, link.body, space.orientations[number]);
  for (std::size_t i = 0; i < link.end; ++i) {
    DVec3 linear, angular;
    get_column(space, number, i, linear, angular);
    if (linear == DVec3{} && angular == DVec3{}) continue;
    const DVec3 momentum = inertia.mass * linear, spin = inertia.times(angular);
    for (std::size_t j = 0; j <= i; ++j) {
      DVec3 other, turning;
      get_column(space, number, j, other, turning);
      space.mass[i * space.size() + j] += dot(momentum, other) + dot(spin, turning);
    }
  }
}

}  // namespace

bool is_coordinate(const JointRecord& joint, const JointDetail* detail, JointAxis axis) {
  const auto is_free = [&] {
    return detail == nullptr || detail->axes[int(axis)].motion != AxisMotion::locked;
  };
  switch (joint.kind) {
    case JointKind::ball:
    case JointKind::cone:
      return axis >= JointAxis::angular_x;
    case JointKind::hinge:
      return axis == JointAxis::angular_x;
    case JointKind::slider:
      return axis == JointAxis::linear_x;
    case JointKind::universal:
      return axis == JointAxis::angular_x || axis == JointAxis::angular_z;
    case JointKind::wheel:
      return axis == JointAxis::linear_x || axis == JointAxis::angular_z ||
             (axis == JointAxis::angular_x && is_free());
    case JointKind::six_dof:
      return is_free();
    default:
      return false;
  }
}

std::int32_t find_link(const JointSpace& space, std::uint32_t body) {
  for (std::size_t i = 0; i < space.links.size(); ++i)
    if (space.links[i].body == body) return std::int32_t(i);
  return -1;
}

std::int32_t find_coordinate(const JointSpace& space, std::uint32_t joint, JointAxis axis) {
  for (std::size_t i = 0; i < space.size(); ++i)
    if (space.coordinates[i].joint == joint && space.coordinates[i].axis == axis) return std::int32_t(i);
  return -1;
}

bool find_joint_space(const RigidWorld& w, std::uint32_t body, JointSpace& out) {
  out.links.clear(), out.coordinates.clear();
  out.loops = 0;
  return TreeFinder(w, out).find(body);
}

void measure_joint_space(const RigidWorld& w, JointSpace& space, bool in_step) {
  const std::size_t size = space.size(), links = space.links.size();
  space.directions.assign(size, {});
  space.speeds.assign(size, 0.0);
  space.jacobians.assign(links * 6 * size, 0.0);
  space.mass.assign(size * size, 0.0);
  space.centers.resize(links), space.velocities.resize(links), space.spins.resize(links);
  space.orientations.resize(links);
  for (std::size_t i = 0; i < links; ++i) {
    const EndState state = read_body(w, space.links[i].body, in_step);
    space.centers[i] = state.center, space.velocities[i] = state.velocity, space.spins[i] = state.spin;
    space.orientations[i] = state.orientation;
    if (space.links[i].joint != kNoIndex) {
      measure_joint(w, space, i, in_step);
    } else {
      read_base_speeds(space, state);
    }
    fill_jacobian(w, space, i, in_step);
    add_mass(w, space, i);
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j) space.mass[j * size + i] = space.mass[i * size + j];
}

void refresh_speeds(const RigidWorld& w, JointSpace& space) {
  for (const JointLink& link : space.links) {
    if (link.joint == kNoIndex) {
      read_base_speeds(space, read_body(w, link.body, true));
    } else {
      measure_speeds(space, link, JointEnds(w, w.joints.records[link.joint], true));
    }
  }
}

void find_bias_forces(const RigidWorld& w, const JointSpace& space, std::span<double> out) {
  for (double& force : out) force = 0.0;
  // Accelerations of the links with constant speeds of the coordinates.
  std::vector<DVec3> linear(space.links.size()), angular(space.links.size());
  for (std::size_t i = 0; i < space.links.size(); ++i) {
    const JointLink& link = space.links[i];
    if (link.joint != kNoIndex) {
      const JointRecord& joint = w.joints.records[link.joint];
      const bool on_link = link.parent >= 0;
      const std::int32_t base = link.is_b ? joint.body_a : joint.body_b;
      EndState parent;
      if (on_link) {
        const std::size_t p = std::size_t(link.parent);
        parent = {space.centers[p], space.velocities[p], space.spins[p], {}};
        linear[i] = linear[p], angular[i] = angular[p];
      } else if (base != kNoBody) {
        parent = read_body(w, std::uint32_t(base), false);
      } else {
        parent.center = space.centers[i];
      }
      const EndState own{space.centers[i], space.velocities[i], space.spins[i], {}};
      const EndState& b = link.is_b ? own : parent;
      const DVec3 anchor = anchor_of(w, space, i, false);
      const DVec3 anchor_velocity = b.velocity + cross(b.spin, anchor - b.center);
      linear[i] +=
          cross(angular[i], own.center - parent.center) + cross(parent.spin, own.velocity - parent.velocity);
      const double sign = link.is_b ? 1.0 : -1.0;
      for (std::uint32_t k = link.first; k < link.end; ++k) {
        const JointDirection& direction = space.directions[k];
        const DVec3 rate = sign * space.speeds[k] * direction.rate;
        if (!direction.is_angular) {
          linear[i] += rate;
          continue;
        }
        angular[i] += rate;
        linear[i] += cross(rate, own.center - anchor) +
                     cross(sign * space.speeds[k] * direction.axis, own.velocity - anchor_velocity);
      }
    }
    const WorldInertia inertia(w, link.body, space.orientations[i]);
    const double weight = double(w.bodies.forces[link.body].gravity_scale);
    const DVec3 force = inertia.mass * (linear[i] - weight * DVec3(w.settings.gravity));
    const DVec3 spin = space.spins[i];
    const DVec3 torque = inertia.times(angular[i]) + cross(spin, inertia.times(spin));
    for (std::size_t k = 0; k < link.end; ++k) {
      DVec3 along, about;
      get_column(space, i, k, along, about);
      out[k] += dot(along, force) + dot(about, torque);
    }
  }
}

}  // namespace gyre
