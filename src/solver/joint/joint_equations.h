// The equations of a joint one by one, and access to their accumulated impulses. Articulations
// (solver/articulation/articulation.cpp) and the solvers of whole islands (solver/rows/joint_rows.cpp) use
// them.
#pragma once

#include "solver/joint/joint_blocks.h"
#include "solver/joint/joint_kinds.h"

namespace gyre {

// Its speed is direction . (v_b - v_a) + angular_b . w_b - angular_a . w_a.
struct JointEquation {
  Vec3 direction;  // of a force; zero for an angular row
  Vec3 angular_a, angular_b;
};
struct JointEquations {
  int count = 0;
  JointEquation rows[kJointAxisCount];
};

// Calls add(direction, angular_a, angular_b) for each equation.
template <class Add>
inline void list_equations(const JointRecord& joint, const JointConstraint& work, Add&& add) {
  constexpr Vec3 kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto add_point = [&](Vec3 axis) { add(axis, cross(work.from_a, axis), cross(work.from_b, axis)); };
  const auto add_angular = [&](Vec3 axis) { add(Vec3{}, axis, axis); };
  if (work.rows != nullptr) {
    for (int i = 0; i < work.rows->count; ++i) {
      const JointRow& from = work.rows->rows[i];
      add(from.direction, from.angular_a, from.angular_b);
    }
    return;
  }
  switch (joint.kind) {
    case JointKind::distance:
      add_point(work.axis);
      break;
    case JointKind::slider:
      add_point(work.perpendicular_1);
      add_point(work.perpendicular_2);
      break;
    default:
      for (const Vec3 axis : kAxes) add_point(axis);
  }
  if (joint.kind == JointKind::hinge) {
    add_angular(work.perpendicular_1);
    add_angular(work.perpendicular_2);
  } else if (joint.kind == JointKind::slider || joint.kind == JointKind::fixed) {
    for (const Vec3 axis : kAxes) add_angular(axis);
  }
}

inline void make_equations(JointEquations& node, const JointRecord& joint, const JointConstraint& work) {
  node.count = 0;
  list_equations(joint, work, [&](Vec3 direction, Vec3 angular_a, Vec3 angular_b) {
    node.rows[node.count++] = {direction, angular_a, angular_b};
  });
}

inline bool is_angular(const JointEquation& row) { return row.direction == Vec3{}; }

// Conversion between the accumulated impulses of the joint and those of its equations.
inline float accumulated_impulse(const JointRecord& joint, const JointConstraint& work,
                                 const JointEquation& row, int i) {
  if (work.rows != nullptr) return work.detail->row_impulses[i];
  if (joint.kind == JointKind::distance) return work.axes[0].axis.low_impulse;
  return is_angular(row) ? dot(joint.angular_impulse, row.angular_a)
                         : dot(joint.linear_impulse, row.direction);
}
inline void add_impulse(JointRecord& joint, const JointConstraint& work, const JointEquation& row, int i,
                        float impulse) {
  if (work.rows != nullptr) {
    work.detail->row_impulses[i] += impulse;
  } else if (joint.kind == JointKind::distance) {
    work.axes[0].axis.low_impulse += impulse;
  } else if (is_angular(row)) {
    joint.angular_impulse += impulse * row.angular_a;
  } else {
    joint.linear_impulse += impulse * row.direction;
  }
}
inline void clear_equation_impulses(JointRecord& joint, const JointConstraint& work) {
  joint.linear_impulse = joint.angular_impulse = {};
  if (work.rows == nullptr && joint.kind == JointKind::distance) work.axes[0].axis.low_impulse = 0.0f;
  if (work.rows == nullptr) return;
  for (float& impulse : work.detail->row_impulses) impulse = 0.0f;
}

inline float error_of(const JointRecord& joint, const JointConstraint& work, const JointEquation& row, int i,
                      ErrorBounds bounds = kMaxErrors) {
  if (work.rows != nullptr) return clamped_error(work.rows->rows[i], bounds);
  if (is_angular(row)) return dot(clamp_length(work.angular_error, bounds.rotation), row.angular_a);
  if (joint.kind == JointKind::distance)
    return clamp(work.position - joint.min_length, -bounds.point, bounds.point);
  return dot(clamp_length(work.error, bounds.point), row.direction);
}

}  // namespace gyre
