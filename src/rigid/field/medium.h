// What a medium does to one body at one moment: the velocity with which it streams there, the drag by the body's surface, and the
// lift of what the body displaces. Six-vectors are (linear, angular) about the centre of mass, in world axes.
//
// In: a field's record, a body's shapes and place. Out: matrices and forces in double; nothing is moved here.
#pragma once

#include "math/rotation.h"
#include "rigid/store/field_record.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

struct Vec6 {
  double v[6] = {};

  DVec3 linear() const { return {v[0], v[1], v[2]}; }
  DVec3 angular() const { return {v[3], v[4], v[5]}; }
};
inline Vec6 make_vec6(DVec3 linear, DVec3 angular) {
  return {{linear.x, linear.y, linear.z, angular.x, angular.y, angular.z}};
}

// A symmetric matrix of six rows.
struct Mat6 {
  double m[6][6] = {};
};
Vec6 operator*(const Mat6& a, const Vec6& b);
void add(Vec6& to, const Vec6& more);
void add_scaled(Mat6& to, double scale, const Mat6& more);
// weight J J', for a row of six.
void add_row(Mat6& to, double weight, const Vec6& row);

// Where a body is within a sub-step.
struct BodyState {
  DVec3 center;  // of mass
  DQuat orientation;    // world_from_body
  DVec3 velocity, spin;
};

// Which of a body's shapes a field sees: no sensors, and those in its layers.
bool acts_on_shape(const RigidWorld& w, const FieldRecord& field, std::uint32_t shape);
// Whether the field acts on the body at all; `center`: its centre of mass.
bool acts_on(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, DVec3 center);

// The velocity of the medium at a place, and half its curl, the rate at which it turns there. `time`: s.
Vec6 stream_at(const FieldRecord& field, DVec3 position, double time);

// Drag as matrix * (stream - velocity): linear in the difference of the two, with the size of the difference taken from now.
void add_drag(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
              const Vec6& stream, Mat6& matrix);

// The acceleration of a radial field at a place, and its stiffness (1/s^2), not below that of the steepest direction.
struct RadialForce {
  DVec3 acceleration;
  double stiffness = 0.0;
};
RadialForce radial_force_at(const FieldRecord& field, DVec3 position);

// The lift of what is submerged, and how it gives way to motion: d(force)/d(motion) = -stiffness, with what would lower the
// stiffness left out.
void add_lift(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
              double gravity, Vec6& force, Mat6& stiffness);

}  // namespace gyre
