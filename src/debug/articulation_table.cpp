// Articulations in generalised coordinates, read by id. In: bodies and joints of a world. Out: arrays. See gyre/articulation.h.
#include <gyre/articulation.h>

#include "base/float_mode.h"
#include "math/dense.h"
#include "rigid/articulation/joint_space.h"
#include "world/joint_reading.h"
#include "world/world_access.h"

namespace gyre {

namespace {

// The space of a body's articulation; false if there is none.
bool find_space(const World& world, BodyId body, JointSpace& space) {
  if (!world.exists(body)) return false;
  const RigidWorld& w = state_of(world).rigid;
  if (!is_movable(w.bodies.flags[body.index])) return false;
  return find_joint_space(w, body.index, space);
}
bool measure_space(const World& world, BodyId body, JointSpace& space) {
  if (!find_space(world, body, space)) return false;
  measure_joint_space(state_of(world).rigid, space, false);
  return true;
}

DQuat orientation_of(const RigidWorld& w, std::int32_t body) {
  return body == kNoBody ? DQuat{} : normalized(to_double(w.bodies.poses[std::size_t(body)].orientation));
}

bool is_ball(JointKind kind) { return kind == JointKind::ball || kind == JointKind::cone; }

void read_positions(const RigidWorld& w, const JointSpace& space, std::vector<double>& out) {
  out.clear();
  for (const JointLink& link : space.links) {
    if (link.joint == kNoIndex) {
      const DVec3 p = w.bodies.poses[link.body].center;
      out = {p.x, p.y, p.z, 0.0, 0.0, 0.0};
      continue;
    }
    const JointRecord& joint = w.joints.records[link.joint];
    if (is_ball(joint.kind)) {
      const DQuat a = orientation_of(w, joint.body_a) * to_double(joint.local_frame_a);
      const DQuat b = orientation_of(w, joint.body_b) * to_double(joint.local_frame_b);
      const DVec3 turned = logarithm_map(conjugate(a) * b);
      out.insert(out.end(), {turned.x, turned.y, turned.z});
      continue;
    }
    for (std::uint32_t i = link.first; i < link.end; ++i)
      out.push_back(double(read_joint_axis(w, link.joint, space.coordinates[i].axis).position));
  }
}

// The place of a link: centre of mass and orientation.
struct Place {
  DVec3 center;
  DQuat orientation;
};

// Position and rotation of b's joint frame in a's for positions of the link's coordinates. Locked axes are where they are held.
Place relative_place(const RigidWorld& w, const JointSpace& space, const JointLink& link,
                     std::span<const double> q) {
  const JointRecord& joint = w.joints.records[link.joint];
  const JointDetail* const detail = detail_of(w.joints, link.joint);
  if (is_ball(joint.kind))
    return {{}, exponential_map({q[link.first], q[link.first + 1], q[link.first + 2]})};
  double at[kJointAxisCount] = {};
  for (int i = 0; i < kJointAxisCount && detail != nullptr; ++i)
    at[i] = double(detail->axes[i].locked_position);
  for (std::uint32_t i = link.first; i < link.end; ++i) at[int(space.coordinates[i].axis)] = q[i];
  const DQuat x = exponential_map({at[3], 0.0, 0.0}), y = exponential_map({0.0, at[4], 0.0}),
              z = exponential_map({0.0, 0.0, at[5]});
  return {{at[0], at[1], at[2]}, x * y * z};
}

// The place of a link, from that of its parent.
Place place_link(const RigidWorld& w, const JointSpace& space, const JointLink& link,
                 std::span<const double> q, const Place& parent) {
  const JointRecord& joint = w.joints.records[link.joint];
  const Place relative = relative_place(w, space, link, q);
  const auto anchor = [&](const Place& of, std::int32_t body, Vec3 local, DVec3 world) {
    return body == kNoBody ? world : of.center + rotate(of.orientation, DVec3(local));
  };
  Place out;
  if (link.is_b) {
    const DQuat frame = parent.orientation * to_double(joint.local_frame_a);
    out.orientation = normalized(frame * relative.orientation * conjugate(to_double(joint.local_frame_b)));
    const DVec3 at = anchor(parent, joint.body_a, joint.local_anchor_a, joint.world_anchor_a) +
                     rotate(frame, relative.center);
    out.center = at - rotate(out.orientation, DVec3(joint.local_anchor_b));
    return out;
  }
  const DQuat frame = parent.orientation * to_double(joint.local_frame_b) * conjugate(relative.orientation);
  out.orientation = normalized(frame * conjugate(to_double(joint.local_frame_a)));
  const DVec3 at = anchor(parent, joint.body_b, joint.local_anchor_b, joint.world_anchor_b) -
                   rotate(frame, relative.center);
  out.center = at - rotate(out.orientation, DVec3(joint.local_anchor_a));
  return out;
}

}  // namespace

void read_articulation(const World& world, BodyId body, ArticulationTable& out) {
  const FloatMode mode;
  out = {};
  JointSpace space;
  if (!measure_space(world, body, space)) return;
  const RigidWorld& w = state_of(world).rigid;
  for (const JointLink& link : space.links) {
    out.bodies.push_back(body_id(w, link.body));
    out.parents.push_back(link.parent);
    out.joints.push_back(link.joint == kNoIndex ? JointId{} : joint_id(w, link.joint));
  }
  for (const JointCoordinate& coordinate : space.coordinates) {
    out.coordinate_bodies.push_back(std::int32_t(coordinate.link));
    out.coordinate_joints.push_back(coordinate.joint == kNoIndex ? JointId{} : joint_id(w, coordinate.joint));
    out.coordinate_axes.push_back(coordinate.axis);
  }
  read_positions(w, space, out.positions);
  out.bias_forces.resize(space.size());
  find_bias_forces(w, space, out.bias_forces);
  out.velocities = std::move(space.speeds);
  out.mass_matrix = std::move(space.mass);
  out.jacobians = std::move(space.jacobians);
  out.loops = space.loops;
}

void inverse_dynamics(const World& world, BodyId body, std::span<const double> accelerations,
                      std::vector<double>& forces) {
  const FloatMode mode;
  forces.clear();
  JointSpace space;
  if (!measure_space(world, body, space) || accelerations.size() != space.size()) return;
  const std::size_t size = space.size();
  forces.resize(size);
  find_bias_forces(state_of(world).rigid, space, forces);
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) forces[i] += space.mass[i * size + j] * accelerations[j];
}

void forward_dynamics(const World& world, BodyId body, std::span<const double> forces,
                      std::vector<double>& accelerations) {
  const FloatMode mode;
  accelerations.clear();
  JointSpace space;
  if (!measure_space(world, body, space) || forces.size() != space.size()) return;
  accelerations.resize(space.size());
  find_bias_forces(state_of(world).rigid, space, accelerations);
  for (std::size_t i = 0; i < space.size(); ++i) accelerations[i] = forces[i] - accelerations[i];
  factor_ldlt(space.mass, int(space.size()));
  solve_ldlt(space.mass, int(space.size()), accelerations);
}

void point_jacobian(const World& world, BodyId body, DVec3 point, std::vector<double>& out) {
  const FloatMode mode;
  out.clear();
  JointSpace space;
  if (!measure_space(world, body, space)) return;
  const std::int32_t link = find_link(space, body.index);
  const std::size_t size = space.size();
  out.resize(6 * size);
  const DVec3 arm = point - space.centers[std::size_t(link)];
  for (std::size_t i = 0; i < size; ++i) {
    const auto at = [&](std::size_t row) { return space.row(std::size_t(link), row)[i]; };
    const DVec3 angular{at(3), at(4), at(5)};
    const DVec3 linear = DVec3{at(0), at(1), at(2)} + cross(angular, arm);
    const double column[6] = {linear.x, linear.y, linear.z, angular.x, angular.y, angular.z};
    for (std::size_t row = 0; row < 6; ++row) out[row * size + i] = column[row];
  }
}

void forward_kinematics(const World& world, BodyId body, std::span<const double> positions,
                        std::vector<double>& poses) {
  const FloatMode mode;
  poses.clear();
  JointSpace space;
  if (!find_space(world, body, space) || positions.size() != space.size()) return;
  const RigidWorld& w = state_of(world).rigid;
  std::vector<Place> places(space.links.size());
  for (std::size_t i = 0; i < space.links.size(); ++i) {
    const JointLink& link = space.links[i];
    if (link.joint == kNoIndex) {
      const DQuat turned = exponential_map({positions[3], positions[4], positions[5]});
      places[i] = {{positions[0], positions[1], positions[2]},
                   normalized(turned * orientation_of(w, std::int32_t(link.body)))};
    } else {
      const JointRecord& joint = w.joints.records[link.joint];
      const std::int32_t base = link.is_b ? joint.body_a : joint.body_b;
      const Place parent = link.parent >= 0 ? places[std::size_t(link.parent)]
                           : base == kNoBody
                               ? Place{}
                               : Place{w.bodies.poses[std::size_t(base)].center, orientation_of(w, base)};
      places[i] = place_link(w, space, link, positions, parent);
    }
    const DVec3 origin =
        places[i].center - rotate(places[i].orientation, DVec3(w.bodies.masses[link.body].center));
    const DQuat& q = places[i].orientation;
    poses.insert(poses.end(), {origin.x, origin.y, origin.z, q.x, q.y, q.z, q.w});
  }
}

}  // namespace gyre
