// The blocks of joints: a point (three linear rows), a rotation (up to three angular rows), and single rows
// along or about an axis. Each has K = J M^-1 J^T, its inverse, and an impulse on both bodies.
//
// Notation: v = linear, w = angular velocity; r = anchor from the centre of mass. J of a point: v_b + w_b x
// r_b - v_a - w_a x r_a. Source: E. Catto, "Iterative Dynamics with Temporal Coherence", 2005.
#pragma once

#include "solver/core/error_bounds.h"
#include "solver/joint/joint.h"

namespace gyre {

// The two bodies of a joint during its solve.
class JointPair {
 public:
  JointPair(const JointRecord& joint, const JointBodies& bodies) {
    if (joint.body_a != kNoBody) {
      a_ = &bodies.motion[joint.body_a];
      inertia_a_ = &bodies.inertia[joint.body_a];
      read(*a_, linear_a, angular_a);
    }
    if (joint.body_b != kNoBody) {
      b_ = &bodies.motion[joint.body_b];
      inertia_b_ = &bodies.inertia[joint.body_b];
      read(*b_, linear_b, angular_b);
    }
  }

  // Writes the velocities of movable bodies. Adding zero keeps -0 out of the state.
  void store() {
    if (a_ != nullptr && is_movable(*inertia_a_)) write(*a_, linear_a, angular_a);
    if (b_ != nullptr && is_movable(*inertia_b_)) write(*b_, linear_b, angular_b);
  }

  float inverse_mass_a() const { return inertia_a_->inverse_mass; }
  float inverse_mass_b() const { return inertia_b_->inverse_mass; }
  const Sym3& inverse_inertia_a() const { return inertia_a_->inverse; }
  const Sym3& inverse_inertia_b() const { return inertia_b_->inverse; }
  Vec3 relative_displacement() const {
    return (b_ != nullptr ? b_->delta_position : Vec3{}) - (a_ != nullptr ? a_->delta_position : Vec3{});
  }

  Vec3 displacement_a() const { return a_ != nullptr ? a_->delta_position : Vec3{}; }
  Vec3 displacement_b() const { return b_ != nullptr ? b_->delta_position : Vec3{}; }

  // Applies the impulse p to B at r_b, and -p to A at r_a.
  void apply_impulse(Vec3 p, Vec3 r_a, Vec3 r_b) {
    linear_a -= inverse_mass_a() * p;
    angular_a -= inverse_inertia_a() * cross(r_a, p);
    linear_b += inverse_mass_b() * p;
    angular_b += inverse_inertia_b() * cross(r_b, p);
  }
  void apply_angular_impulse(Vec3 t) {
    angular_a -= inverse_inertia_a() * t;
    angular_b += inverse_inertia_b() * t;
  }
  Vec3 point_velocity(Vec3 r_a, Vec3 r_b) const {
    return linear_b + cross(angular_b, r_b) - linear_a - cross(angular_a, r_a);
  }
  Vec3 relative_spin() const { return angular_b - angular_a; }

  Vec3 linear_a, angular_a, linear_b, angular_b;

 private:
  static constexpr BodyInertia kImmovable{};
  static bool is_movable(const BodyInertia& inertia) {
    return inertia.inverse_mass > 0.0f || inertia.inverse != Sym3{};
  }
  static void read(const BodyMotion& motion, Vec3& linear, Vec3& angular) {
    linear = motion.linear_velocity;
    angular = motion.angular_velocity;
  }
  static void write(BodyMotion& motion, Vec3 linear, Vec3 angular) {
    const Vec3 zero{0.0f, 0.0f, 0.0f};
    motion.linear_velocity = linear + zero;
    motion.angular_velocity = angular + zero;
  }

  BodyMotion* a_ = nullptr;
  BodyMotion* b_ = nullptr;
  const BodyInertia* inertia_a_ = &kImmovable;
  const BodyInertia* inertia_b_ = &kImmovable;
};

// [r] S [r]: products with zeros of [r] are left out, the others stand in the order of whole matrices.
inline Mat3 between_skews(Vec3 r, const Sym3& s) {
  const Mat3 m = to_matrix(s);
  return {cross(r, r.z * m.y - r.y * m.z), cross(r, r.x * m.z - r.z * m.x), cross(r, r.y * m.x - r.x * m.y)};
}

// K of a point: (1/m_a + 1/m_b) - [r_a] I_a^-1 [r_a] - [r_b] I_b^-1 [r_b].
inline Mat3 point_matrix(const JointPair& pair, Vec3 r_a, Vec3 r_b) {
  const float m = pair.inverse_mass_a() + pair.inverse_mass_b();
  return diagonal({m, m, m}) - between_skews(r_a, pair.inverse_inertia_a()) -
         between_skews(r_b, pair.inverse_inertia_b());
}

// K of a row along `axis` through the anchors.
inline float axis_matrix(const JointPair& pair, Vec3 axis, Vec3 r_a, Vec3 r_b) {
  const Vec3 ja = cross(r_a, axis), jb = cross(r_b, axis);
  return pair.inverse_mass_a() + pair.inverse_mass_b() + dot(ja, pair.inverse_inertia_a() * ja) +
         dot(jb, pair.inverse_inertia_b() * jb);
}

// K of a row about `axis`.
inline float angular_matrix(const JointPair& pair, Vec3 axis) {
  return dot(axis, pair.inverse_inertia_a() * axis) + dot(axis, pair.inverse_inertia_b() * axis);
}

// The angle, known up to whole turns, that is nearest to `near`.
inline float unwrapped(float angle, float near) {
  return angle + 2.0f * kPi * std::floor((near - angle) / (2.0f * kPi) + 0.5f);
}

inline float inverse_or_zero(float k) { return k > 0.0f ? 1.0f / k : 0.0f; }

inline Vec3 clamp_length(Vec3 v, float max_length) {
  const float size = length(v);
  return size > max_length ? (max_length / size) * v : v;
}
inline float clamped_error(const JointRow& row, ErrorBounds bounds = kMaxErrors) {
  const float bound = row.direction == Vec3{} ? bounds.rotation : bounds.point;
  return clamp(row.error, -bound, bound);
}

// K restricted to the plane of two unit vectors and inverted there: m = P (P^T K P)^-1 P^T.
inline Mat3 inverse_in_plane(const Mat3& k, Vec3 u, Vec3 v) {
  const float kuu = dot(u, k * u), kvv = dot(v, k * v), kuv = dot(u, k * v);
  const float det = kuu * kvv - kuv * kuv;
  if (!(det > 0.0f)) return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const float s = 1.0f / det;
  const Vec3 wu = s * (kvv * u - kuv * v);
  const Vec3 wv = s * (kuu * v - kuv * u);
  // The sum of two outer products, by columns.
  return {u.x * wu + v.x * wv, u.y * wu + v.y * wv, u.z * wu + v.z * wv};
}

// The change of an accumulated impulse that brings `speed` plus bias to zero, soft or rigid.
inline Vec3 row_change(const Mat3& mass, Vec3 speed, Vec3 error, Vec3 impulse, const Softness& soft,
                       bool is_soft) {
  if (!is_soft) return -(mass * speed);
  return -soft.mass_scale * (mass * (speed + soft.bias_rate * error)) - soft.impulse_scale * impulse;
}

// A one-sided row at distance `gap` from its limit. Returns the change of `impulse` (>= 0).
inline float limit_impulse_change(float mass, float speed, float gap, float impulse,
                                  const JointSettings& settings, bool is_soft) {
  float target = 0.0f;
  if (gap > 0.0f) {
    target = impulse - mass * (speed + gap / settings.substep);
  } else if (is_soft) {
    const Softness& soft = settings.softness;
    target = impulse - mass * soft.mass_scale * (speed + soft.bias_rate * gap) - soft.impulse_scale * impulse;
  } else {
    target = impulse - mass * speed;
  }
  return max(target, 0.0f) - impulse;
}

}  // namespace gyre
