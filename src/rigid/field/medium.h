// The effect of a medium or a radial field on one body at one moment: the velocity of the stream, the drag on the
// surface of the body, and the buoyancy of its displaced volume. Six-vectors are (linear, angular) about the centre of
// mass, in world axes.
//
// In: the record of a field, shapes and pose of a body. Out: matrices and forces in double; the body is not changed.
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

// A symmetric 6 x 6 matrix.
struct Mat6 {
  double m[6][6] = {};
};
Vec6 operator*(const Mat6& a, const Vec6& b);
void add(Vec6& to, const Vec6& more);
void add_scaled(Mat6& to, double scale, const Mat6& more);
// Adds weight J J' for a row J of six numbers.
void add_row(Mat6& to, double weight, const Vec6& row);

// The state of a body within a sub-step.
struct BodyState {
  DVec3 center;  // of mass
  DQuat orientation;  // world_from_body
  DVec3 velocity, spin;
};

// True if the field acts on this shape: it is no sensor and in the layers of the field.
bool acts_on_shape(const RigidWorld& w, const FieldRecord& field, std::uint32_t shape);
// True if the field acts on the body; `center`: its centre of mass.
bool acts_on(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, DVec3 center);

// The velocity of the medium at a position, and half its curl, its rate of rotation there. `time`: s.
Vec6 stream_at(const FieldRecord& field, DVec3 position, double time);

// The drag is matrix * (stream - velocity): linear in this difference, with a factor from its present size.
void add_drag(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
              const Vec6& stream, Mat6& matrix);

// The acceleration of a radial field at a position, and its stiffness (1/s^2), which is at least that of the steepest
// direction.
struct RadialForce {
  DVec3 acceleration;
  double stiffness = 0.0;
};
RadialForce radial_force_at(const FieldRecord& field, DVec3 position);

// 1/s, along B: the rate at which a magnetic field turns velocities.
DVec3 magnetic_rate_at(const FieldRecord& field, DVec3 position);
// The acceleration of a grid (the field of `slot`) at a position; outside of its bounds that of the nearest point inside.
DVec3 grid_acceleration_at(const RigidWorld& w, std::uint32_t slot, DVec3 position);

// The buoyancy of the submerged part, and its stiffness: d(force)/d(motion) = -stiffness, without terms that would lower
// the stiffness.
void add_buoyancy(const RigidWorld& w, const FieldRecord& field, std::uint32_t body, const BodyState& state,
                  double gravity, Vec6& force, Mat6& stiffness);

}  // namespace gyre
