// Articulations in generalised coordinates: the mass matrix, Jacobians, inverse and forward dynamics and kinematics of bodies that joints
// connect, for controllers and planners. The world simulates bodies and joints; these functions describe its present state and change nothing.
//
// An articulation is the tree of dynamic bodies that ball, cone, hinge, slider, fixed, universal, six_dof and wheel joints connect to a body. A
// joint to the world, or to a static or kinematic body, holds its base: of several the one added first. Without such a joint its base is free.
// Joints that close a loop, and joints of other kinds, are left out; `loops` counts the first. At most 256 coordinates; larger articulations,
// stale ids and bodies that are not dynamic give empty arrays.
//
// Coordinates: those of a free base first (6: position of the centre of mass, rotation; world axes), then the free axes of the joints, link by
// link, in the order of JointAxis. Positions and velocities of an axis are those of World::joint_axis_state(). Exceptions are ball and cone
// joints: their 3 velocities are the angular velocity of b against a along the axes of the joint's frame on a, their positions the rotation vector
// of b against a. A velocity there is not the rate of the position. Forces are N or N m along the same axes. Matrices are row after row.
#pragma once

#include <gyre/ids.h>
#include <gyre/joints.h>
#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

class World;

// With n coordinates and m bodies.
struct ArticulationTable {
  std::vector<BodyId> bodies;         // m: parents before children
  std::vector<std::int32_t> parents;  // m: index in `bodies`; -1 for the base
  std::vector<JointId> joints;        // m: to the parent; null for a free base
  std::vector<std::int32_t> coordinate_bodies;  // n: index in `bodies`
  std::vector<JointId> coordinate_joints;       // n: null for those of a free base
  std::vector<JointAxis> coordinate_axes;       // n
  std::vector<double> positions;      // n: m or rad
  std::vector<double> velocities;     // n: m/s or rad/s
  std::vector<double> mass_matrix;    // n times n: kg, kg m, kg m^2; kinetic energy = velocities' M velocities / 2
  // n: N or N m, that hold all velocities constant: against weight, and for centrifugal and Coriolis forces. Springs, motors, damping, fields
  // and contacts are not in it.
  std::vector<double> bias_forces;
  // m times 6 times n: a body's velocity of the centre of mass (3 rows, m/s) and angular velocity (3 rows, rad/s), world axes, for a velocity
  // of one of each coordinate.
  std::vector<double> jacobians;
  std::int32_t loops = 0;
};

void read_articulation(const World& world, BodyId body, ArticulationTable& out);
// n: the forces along the coordinates that give these accelerations (n): M accelerations + bias_forces. A wrong number of them gives none.
void inverse_dynamics(const World& world, BodyId body, std::span<const double> accelerations, std::vector<double>& forces);
// n: the accelerations under these forces (n) along the coordinates. Zero along coordinates that move no mass.
void forward_dynamics(const World& world, BodyId body, std::span<const double> forces, std::vector<double>& accelerations);
// 6 times n: as ArticulationTable::jacobians, for the point of `body` that lies at `point` (world) now.
void point_jacobian(const World& world, BodyId body, DVec3 point, std::vector<double>& out);
// 7 times m: the poses that the bodies would have with these positions (n): x y z of the origin, then x y z w of the orientation.
void forward_kinematics(const World& world, BodyId body, std::span<const double> positions, std::vector<double>& poses);

}  // namespace gyre
