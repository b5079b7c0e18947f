// The motion of a tree of jointed bodies in generalised coordinates: one coordinate for each free axis of its joints, after six of the first
// body if no joint holds the tree. Jacobians, the mass matrix, and the forces of velocity and gravity.
//
// In: poses, velocities and masses of bodies, and their joints. Out: dense matrices in double. Links are in breadth-first order, joints of a
// body by ascending slot, so the order never depends on threads. A joint that closes a loop, and one whose axes are no coordinates (distance,
// gear, rack, pulley, path, mouse, motor), is left out: what it does is a force from outside.
// Source: R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapters 4 to 6, with Jacobians about the centres of mass.
#pragma once

#include "math/rotation.h"
#include "rigid/store/rigid_world.h"

#include <span>
#include <vector>

namespace gyre {

constexpr std::size_t kMaxJointCoordinates = 256;

// A coordinate: an axis of a joint, or of the free base, whose joint is kNoIndex.
struct JointCoordinate {
  std::uint32_t link = 0;
  std::uint32_t joint = kNoIndex;
  JointAxis axis = JointAxis::linear_x;
};

struct JointLink {
  std::uint32_t body = 0;
  std::int32_t parent = -1;          // link; -1: the world, or a body that joints do not move
  std::uint32_t joint = kNoIndex;    // to the parent; none at a free base
  bool is_b = true;                  // the link is b of that joint
  std::uint32_t first = 0, end = 0;  // its coordinates
};

// The axis of a coordinate at the present poses, of b against a.
struct JointDirection {
  DVec3 axis;  // unit, world
  DVec3 rate;  // its rate of change at the present velocities
  bool is_angular = false;
};

struct JointSpace {
  std::vector<JointLink> links;
  std::vector<JointCoordinate> coordinates;
  std::vector<JointDirection> directions;         // by coordinate
  std::vector<DVec3> centers, velocities, spins;  // by link: centre of mass, m; m/s; rad/s
  std::vector<DQuat> orientations;
  std::vector<double>
      jacobians;  // by link: three linear rows of the centre of mass, then three angular ones, size() numbers each
  std::vector<double> mass;          // size() rows of size()
  std::vector<double> speeds;        // by coordinate
  std::vector<std::uint32_t> found;  // working memory
  int loops = 0;                     // joints that close a loop or hold the tree a second time

  std::size_t size() const { return coordinates.size(); }
  std::span<const double> row(std::size_t link, std::size_t i) const {
    return std::span<const double>(jacobians).subspan((link * 6 + i) * size(), size());
  }
};

// Finds links and coordinates of the tree that a movable body belongs to. False if they are more than kMaxJointCoordinates.
bool find_joint_space(const RigidWorld& w, std::uint32_t body, JointSpace& out);
// Fills directions, Jacobians, the mass matrix and the speeds. `in_step`: poses are those within a step.
void measure_joint_space(const RigidWorld& w, JointSpace& space, bool in_step);
// Reads the speeds again, with the directions as they are.
void refresh_speeds(const RigidWorld& w, JointSpace& space);
// The generalised forces that hold the coordinates at constant speed against gravity: those of velocity (centrifugal, Coriolis, gyroscopic)
// and of weight. For a measured space; `out` has its size.
void find_bias_forces(const RigidWorld& w, const JointSpace& space, std::span<double> out);
// The link of a body; -1 if it has none.
std::int32_t find_link(const JointSpace& space, std::uint32_t body);
// The coordinate of an axis of a joint; -1 if it is none.
std::int32_t find_coordinate(const JointSpace& space, std::uint32_t joint, JointAxis axis);
// True if the axis of a joint of this kind is a coordinate (of a six_dof or wheel unless it is locked).
bool is_coordinate(const JointRecord& joint, const JointDetail* detail, JointAxis axis);

}  // namespace gyre
