#include "solver/articulation/articulation.h"

#include "math/dense.h"
#include "math/wide_vec.h"
#include "solver/articulation/articulation_drives.h"
#include "solver/articulation/articulation_limits.h"
#include "solver/joint/joint_equations.h"

namespace gyre {

namespace {

void make_rows(ArticulationNode& node, const JointRecord& joint, const JointConstraint& work) {
  node.count = 0;
  list_equations(joint, work, [&](Vec3 direction, Vec3 angular_a, Vec3 angular_b) {
    const int row = node.count++;
    node.rows.direction.set(row, direction);
    node.rows.angular_a.set(row, angular_a);
    node.rows.angular_b.set(row, angular_b);
  });
}

JointEquation equation_at(const ArticulationRows& rows, int i) {
  return {rows.direction.at(i), rows.angular_a.at(i), rows.angular_b.at(i)};
}

// A force f at arm r rotates with the body like a spring of stiffness (r . f) 1 - sym(r f^T). Unresolved
// springs, h^2 k > I, would make the links of a heavily loaded chain flutter ever more. So h^2 k is added to
// the inertia against joint impulses, as if the rotation of forces were implicit (M. Tournier, M. Nesme, B.
// Gilles, F. Faure, "Stable Constrained Dynamics", 2015). Bodies without such tension keep their inertia to
// the bit.
void add_geometric_stiffness_term(ArticulationBody& body, Vec3 r, Vec3 f) {
  const float k = dot(r, f);
  body.geometric_stiffness = body.geometric_stiffness + Sym3{k - r.x * f.x,
                                                             k - r.y * f.y,
                                                             k - r.z * f.z,
                                                             -0.5f * (r.x * f.y + r.y * f.x),
                                                             -0.5f * (r.x * f.z + r.z * f.x),
                                                             -0.5f * (r.y * f.z + r.z * f.y)};
}

// The positive semi-definite part of the symmetric matrix.
Sym3 positive_part(const Sym3& m) {
  const double matrix[6] = {double(m.xx), double(m.yy), double(m.zz),
                            double(m.xy), double(m.xz), double(m.yz)};
  double values[3], axes[9];
  symmetric_eigen(matrix, values, axes);
  Sym3 sum;
  for (int i = 0; i < 3; ++i) {
    if (!(values[i] > 0.0)) continue;
    const Vec3 a{float(axes[3 * i]), float(axes[3 * i + 1]), float(axes[3 * i + 2])};
    sum = sum + float(values[i]) * Sym3{a.x * a.x, a.y * a.y, a.z * a.z, a.x * a.y, a.x * a.z, a.y * a.z};
  }
  return sum;
}

void stiffen_bodies(const Articulation& articulation, const ArticulationSolve& s) {
  for (ArticulationBody& body : articulation.bodies) body.geometric_stiffness = {};
  const float h = s.settings.substep;
  for (const ArticulationNode& node : articulation.nodes) {
    const JointRecord& joint = s.records[node.record];
    const JointConstraint& work = s.work[node.work];
    Vec3 force = joint.linear_impulse / h;
    if (joint.kind == JointKind::distance) force = (work.axes[0].axis.low_impulse / h) * work.axis;
    if (node.side_a >= 0)
      add_geometric_stiffness_term(articulation.bodies[std::size_t(node.side_a)], work.from_a, -force);
    if (node.side_b >= 0)
      add_geometric_stiffness_term(articulation.bodies[std::size_t(node.side_b)], work.from_b, force);
  }
  for (ArticulationBody& body : articulation.bodies) {
    body.inverse = s.bodies.inertia[body.body].inverse;
    body.inertia = inverse(body.inverse);
    const Mat3 spin = to_matrix(body.inverse) * to_matrix(body.geometric_stiffness);
    const float unresolved = h * h * 0.5f * (spin.x.x + spin.y.y + spin.z.z);
    if (!(unresolved > kGeometricStiffnessThreshold) || body.is_pressed) continue;
    const float share = h * h * (1.0f - kGeometricStiffnessThreshold / unresolved);
    body.inverse = inverse(body.inertia + share * positive_part(body.geometric_stiffness));
  }
}

// Four rows side by side, from `first` on: every x86-64, 64-bit ARM and WebAssembly has registers of four.
constexpr int kHalf = 4;
static_assert(kRowLanes == 2 * kHalf);
using Rows4 = Vec3W<kHalf>;
Rows4 load_rows(const RowVectors& v, int first) {
  return {Wide<kHalf>::load_unaligned(v.x + first), Wide<kHalf>::load_unaligned(v.y + first),
          Wide<kHalf>::load_unaligned(v.z + first)};
}
void store_rows(RowVectors& to, int first, const Rows4& v) {
  v.x.store_unaligned(to.x + first), v.y.store_unaligned(to.y + first), v.z.store_unaligned(to.z + first);
}
Rows4 splat_rows(Vec3 v) { return splat<kHalf>(v); }
Rows4 times_rows(const Sym3& m, const RowVectors& arms, int first) {
  return Sym3W<kHalf>{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz} * load_rows(arms, first);
}

// Computes the spins of the rows, and the node's diagonal block K + compliance.
void make_diagonal_block(ArticulationNode& node, const Articulation& articulation, const ArticulationSolve& s,
                         double* block) {
  constexpr ArticulationBody kImmovable{};
  const ArticulationBody& a = node.side_a < 0 ? kImmovable : articulation.bodies[std::size_t(node.side_a)];
  const ArticulationBody& b = node.side_b < 0 ? kImmovable : articulation.bodies[std::size_t(node.side_b)];
  const float inverse_mass = (a.body == kNoBody ? 0.0f : s.bodies.inertia[a.body].inverse_mass) +
                             (b.body == kNoBody ? 0.0f : s.bodies.inertia[b.body].inverse_mass);
  ArticulationRows& rows = node.rows;
  const int count = node.count;
  for (int first = 0; first < count; first += kHalf) {
    const Rows4 directions = load_rows(rows.direction, first);
    const Rows4 spins_a = times_rows(a.inverse, rows.angular_a, first),
                spins_b = times_rows(b.inverse, rows.angular_b, first);
    store_rows(rows.spin_a, first, spins_a);
    store_rows(rows.spin_b, first, spins_b);
    for (int i = first; i < count; ++i) {
      float k[kHalf];
      (Wide<kHalf>(inverse_mass) * dot(splat_rows(rows.direction.at(i)), directions) +
       dot(splat_rows(rows.angular_a.at(i)), spins_a) + dot(splat_rows(rows.angular_b.at(i)), spins_b))
          .store_unaligned(k);
      if (i < first + kHalf) {
        rows.compliance[i] = s.compliance * k[i - first];
        k[i - first] += rows.compliance[i];
      }
      for (int j = first; j <= i && j < first + kHalf; ++j)
        block[i * count + j] = block[j * count + i] = double(k[j - first]);
    }
  }
}

// Adds the coupling by the shared body. Signs differ because a gets the opposite of b.
void add_coupling(const ArticulationCoupling& coupling, const ArticulationNode& row,
                  const ArticulationNode& column, const BodyInertia& body, double* block) {
  const float sign = coupling.row_has_b == coupling.column_has_b ? 1.0f : -1.0f;
  const float scale = sign * body.inverse_mass;
  const RowVectors& spins = coupling.row_has_b ? row.rows.spin_b : row.rows.spin_a;
  const RowVectors& arms_of = coupling.column_has_b ? column.rows.angular_b : column.rows.angular_a;
  const int columns = column.count;
  for (int first = 0; first < columns; first += kHalf) {
    const Rows4 directions = load_rows(column.rows.direction, first), arms = load_rows(arms_of, first);
    for (int i = 0; i < row.count; ++i) {
      float k[kHalf];
      (dot(splat_rows(scale * row.rows.direction.at(i)), directions) +
       dot(splat_rows(sign * spins.at(i)), arms))
          .store_unaligned(k);
      for (int j = first; j < columns && j < first + kHalf; ++j)
        block[i * columns + j] += double(k[j - first]);
    }
  }
}

// The bodies of a node while its rows are measured or solved.
class NodeBodies {
 public:
  NodeBodies(const ArticulationNode& node, const JointBodies& bodies)
      : a_(node.body_a, bodies), b_(node.body_b, bodies) {}
  void speeds(const ArticulationRows& rows, int count, float (&out)[kRowLanes]) const {
    const Rows4 u = splat_rows(b_.linear - a_.linear), w_a = splat_rows(a_.angular),
                w_b = splat_rows(b_.angular);
    for (int first = 0; first < count; first += kHalf) {
      (dot(load_rows(rows.direction, first), u) + dot(load_rows(rows.angular_b, first), w_b) -
       dot(load_rows(rows.angular_a, first), w_a))
          .store_unaligned(out + first);
    }
  }
  void apply_impulse(const ArticulationRows& rows, int row, float impulse) {
    const Vec3 direction = rows.direction.at(row);
    a_.linear -= (impulse * a_.inverse_mass) * direction;
    b_.linear += (impulse * b_.inverse_mass) * direction;
    a_.angular -= impulse * rows.spin_a.at(row);
    b_.angular += impulse * rows.spin_b.at(row);
  }
  void store() const {
    a_.store();
    b_.store();
  }

 private:
  struct Side {
    Side(std::int32_t body, const JointBodies& bodies) {
      if (body == kNoBody) return;
      const BodyInertia& inertia = bodies.inertia[body];
      motion = &bodies.motion[body];
      inverse_mass = inertia.inverse_mass;
      is_movable = inverse_mass > 0.0f || inertia.inverse != Sym3{};
      linear = motion->linear_velocity;
      angular = motion->angular_velocity;
    }
    // Adding zero keeps -0 out of the state.
    void store() const {
      if (!is_movable) return;
      motion->linear_velocity = linear + Vec3{};
      motion->angular_velocity = angular + Vec3{};
    }
    BodyMotion* motion = nullptr;
    float inverse_mass = 0.0f;
    bool is_movable = false;
    Vec3 linear, angular;
  };
  Side a_, b_;
};

// As from_rotation_vector, by series: rotations in a sub-step are small, and for larger ones the bias fades
// (kMaxBiasAngle).
Quat small_rotation(Vec3 v) {
  const float a = min(length_squared(v), 1.0f);
  const Vec3 u = (0.5f - a * (1.0f / 48.0f - a / 3840.0f)) * v;
  return {u.x, u.y, u.z, 1.0f - a * (1.0f / 8.0f - a * (1.0f / 384.0f))};
}

// The motion of a body in the coming sub-step.
struct PredictedMotion {
  Vec3 linear, angular;
  Quat rotation;

  // Displacement of the end of an arm by the rotation.
  Vec3 displacement_of(Vec3 arm) const {
    const Vec3 u{rotation.x, rotation.y, rotation.z};
    const Vec3 t = 2.0f * cross(u, arm);
    return rotation.w * t + cross(u, t);
  }
};

PredictedMotion predicted_motion(const Articulation& articulation, const ArticulationSolve& s,
                                 std::int32_t body, std::int32_t side) {
  if (body == kNoBody) return {};
  const BodyMotion& motion = s.bodies.motion[body];
  if (side >= 0)
    return {motion.linear_velocity, motion.angular_velocity, articulation.bodies[std::size_t(side)].rotation};
  const Vec3 w = motion.angular_velocity;
  return {motion.linear_velocity, w, small_rotation(s.settings.substep * w)};
}

// Change of the joint's errors in the sub-step, over its length, beyond the linear rows.
struct SecondOrderBias {
  Vec3 linear, angular;
};

Vec3 angular_second_order_bias(const JointRecord& joint, const JointConstraint& work,
                               const PredictedMotion& a, const PredictedMotion& b, float h) {
  const Vec3 seen = b.angular - a.angular;
  if (joint.kind == JointKind::hinge) {
    const Vec3 error = work.angular_error;  // axis a x axis b
    const Vec3 axis_b =
        cross(error, work.axis) + std::sqrt(max(0.0f, 1.0f - length_squared(error))) * work.axis;
    const Vec3 change_a = a.displacement_of(work.axis), change_b = b.displacement_of(axis_b);
    return (cross(change_a, axis_b) + cross(work.axis, change_b) + cross(change_a, change_b)) / h - seen;
  }
  const Quat later = b.rotation * from_rotation_vector(work.angular_error) * conjugate(a.rotation);
  return (to_rotation_vector(later) - work.angular_error) / h - seen;
}

SecondOrderBias second_order_bias_of(const JointRecord& joint, const JointConstraint& work,
                                     const PredictedMotion& a, const PredictedMotion& b, float h) {
  SecondOrderBias second_order_bias;
  const Vec3 along = work.free_offset;
  const Vec3 anchor_arm = work.from_a - work.error - along;  // to a's own anchor
  const Vec3 seen = b.linear + cross(b.angular, work.from_b) - a.linear - cross(a.angular, work.from_a);
  const Vec3 apart =
      h * (b.linear - a.linear) + b.displacement_of(work.from_b) - a.displacement_of(work.from_a);
  switch (joint.kind) {
    case JointKind::slider: {
      // As seen from a's frame at the end.
      const Vec3 now = work.error + along;
      const Vec3 later =
          now + h * (b.linear - a.linear) + b.displacement_of(work.from_b) - a.displacement_of(anchor_arm);
      second_order_bias.linear =
          (later + PredictedMotion{{}, {}, conjugate(a.rotation)}.displacement_of(later) - now) / h - seen;
      break;
    }
    case JointKind::distance: {
      const Vec3 now = work.position * work.axis;
      second_order_bias.linear =
          ((length(now + apart) - work.position) / h - dot(seen, work.axis)) * work.axis;
      break;
    }
    default:
      second_order_bias.linear = apart / h - seen;
  }
  if (joint.kind == JointKind::hinge || joint.kind == JointKind::slider || joint.kind == JointKind::fixed)
    second_order_bias.angular = angular_second_order_bias(joint, work, a, b, h);
  return second_order_bias;
}

// The same for kinds that are a list of rows, from their errors at the end of the sub-step.
void rows_second_order_bias(const JointRecord& joint, const JointConstraint& work,
                            const ArticulationNode& node, const PredictedMotion& a, const PredictedMotion& b,
                            float h, float (&biases)[kJointAxisCount]) {
  const Vec3 anchor_arm = work.from_a - work.error - work.free_offset;  // to a's own anchor
  const Vec3 now = work.error + work.free_offset;
  const Vec3 moved = h * (b.linear - a.linear);
  const RowPose later{now + moved + b.displacement_of(work.from_b) - a.displacement_of(anchor_arm),
                      now - work.from_b + anchor_arm + moved, a.rotation * work.frame_a,
                      b.rotation * work.frame_b};
  float errors[kJointAxisCount];
  measure_rows(joint, work, later, errors);
  for (int i = 0; i < node.count; ++i) {
    const float seen = dot(node.rows.direction.at(i), b.linear - a.linear) +
                       dot(node.rows.angular_b.at(i), b.angular) - dot(node.rows.angular_a.at(i), a.angular);
    biases[i] = (errors[i] - work.rows->rows[i].error) / h - seen;
  }
}

// The square of the angular rate of a rod, also between bodies that do not rotate (rad/s).
float rod_rate(const JointRecord& joint, const JointConstraint& work, const PredictedMotion& a,
               const PredictedMotion& b) {
  if (joint.kind != JointKind::distance || !(work.position > 0.0f)) return 0.0f;
  const Vec3 speed = b.linear + cross(b.angular, work.from_b) - a.linear - cross(a.angular, work.from_a);
  return length_squared(cross(speed, work.axis)) / square(work.position);
}

// Computes the bias of the rows, so that the end of the sub-step, not its beginning, meets the joints
// (docs/derive/joints.md).
void compute_bias(const Articulation& articulation, const ArticulationSolve& s, ErrorBounds bounds) {
  const float h = s.settings.substep;
  for (ArticulationBody& body : articulation.bodies) {
    const Vec3 w = s.bodies.motion[body.body].angular_velocity;
    // free rotation
    const Vec3 gyroscopic = s.bodies.inertia[body.body].inverse * cross(body.inertia * w, w);
    body.rotation = small_rotation(h * (w + (0.5f * h) * gyroscopic));
  }
  for (ArticulationNode& node : articulation.nodes) {
    const JointRecord& joint = s.records[node.record];
    const JointConstraint& work = s.work[node.work];
    const PredictedMotion a = predicted_motion(articulation, s, node.body_a, node.side_a);
    const PredictedMotion b = predicted_motion(articulation, s, node.body_b, node.side_b);
    const float fastest = square(h) * max(max(length_squared(a.angular), length_squared(b.angular)),
                                          rod_rate(joint, work, a, b));
    const float share = fastest > square(kMaxBiasAngle) ? square(kMaxBiasAngle) / fastest : 1.0f;
    const float fast_share =
        fastest > square(kFastErrorAngle) ? 1.0f - square(kFastErrorAngle) / fastest : 0.0f;
    const float rate = s.settings.softness.bias_rate;
    const float error_rate = -rate - (1.0f / h - rate) * fast_share;
    SecondOrderBias second_order_bias;
    float biases[kJointAxisCount] = {};
    if (fastest > square(kMinBiasAngle) || joint.kind == JointKind::path) {
      if (work.rows != nullptr) {
        rows_second_order_bias(joint, work, node, a, b, h, biases);
      } else {
        second_order_bias = second_order_bias_of(joint, work, a, b, h);
      }
    }
    if (share < 1.0f) {
      second_order_bias.linear *= share;
      second_order_bias.angular *= share;
    }
    for (int i = 0; i < node.count; ++i) {
      ArticulationRows& rows = node.rows;
      rows.target_speed[i] = error_rate * error_of(joint, work, equation_at(rows, i), i, bounds);
      rows.target_speed[i] -= work.rows != nullptr ? share * biases[i]
                              : is_angular(equation_at(rows, i))
                                  ? dot(second_order_bias.angular, rows.angular_a.at(i))
                                  : dot(second_order_bias.linear, rows.direction.at(i));
    }
  }
}

// Solves for the change of all impulses and applies it. soft: with bias and compliance, otherwise for zero
// speed.
void solve_rows(const Articulation& articulation, const ArticulationSolve& s, bool soft) {
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    const ArticulationNode& node = articulation.nodes[n];
    const JointRecord& joint = s.records[node.record];
    const JointConstraint& work = s.work[node.work];
    const NodeBodies bodies(node, s.bodies);
    double* x = &articulation.vector[articulation.plan.columns[articulation.plan.index_of[n]].row];
    float speeds[kRowLanes];
    bodies.speeds(node.rows, node.count, speeds);
    for (int i = 0; i < node.count; ++i) {
      float missing = -speeds[i];
      if (soft)
        missing += node.rows.target_speed[i] -
                   node.rows.compliance[i] * accumulated_impulse(joint, work, equation_at(node.rows, i), i);
      x[i] = double(missing);
    }
  }
  solve_blocks(articulation.plan, articulation.values, articulation.vector);
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    const ArticulationNode& node = articulation.nodes[n];
    JointRecord& joint = s.records[node.record];
    NodeBodies bodies(node, s.bodies);
    const double* x = &articulation.vector[articulation.plan.columns[articulation.plan.index_of[n]].row];
    for (int i = 0; i < node.count; ++i) {
      const float impulse = float(x[i]);
      bodies.apply_impulse(node.rows, i, impulse);
      add_impulse(joint, s.work[node.work], equation_at(node.rows, i), i, impulse);
    }
    bodies.store();
  }
}

void iterate_drives(const Articulation& articulation, const ArticulationSolve& s, bool soft) {
  for (const ArticulationNode& node : articulation.nodes) {
    solve_joint_axes(s.records[node.record], s.work[node.work], s.bodies, s.settings, soft);
  }
}

}  // namespace

void add_geometric_stiffness(const float* geometric_stiffness, const float* inertia, float share,
                             float* inverse_inertia) {
  const auto matrix = [](const float* m) { return Sym3{m[0], m[1], m[2], m[3], m[4], m[5]}; };
  const Sym3 stiffened = inverse(matrix(inertia) + share * positive_part(matrix(geometric_stiffness)));
  const float out[6] = {stiffened.xx, stiffened.yy, stiffened.zz, stiffened.xy, stiffened.xz, stiffened.yz};
  for (int i = 0; i < 6; ++i) inverse_inertia[i] = out[i];
}

void prepare_articulation(const Articulation& articulation, const ArticulationSolve& s) {
  for (double& value : articulation.values) value = 0.0;
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    ArticulationNode& node = articulation.nodes[n];
    JointRecord& joint = s.records[node.record];
    JointConstraint& work = s.work[node.work];
    prepare_joint(joint, work, s.offsets[node.work], s.bodies, s.settings);
    make_rows(node, joint, work);
  }
  stiffen_bodies(articulation, s);
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    make_diagonal_block(
        articulation.nodes[n], articulation, s,
        &articulation.values[articulation.plan.columns[articulation.plan.index_of[n]].diagonal]);
  }
  for (const ArticulationCoupling& coupling : articulation.couplings) {
    add_coupling(coupling, articulation.nodes[coupling.row], articulation.nodes[coupling.column],
                 s.bodies.inertia[coupling.body], &articulation.values[coupling.offset]);
  }
  factor_blocks(articulation.plan, articulation.values, articulation.room);
  prepare_drives(articulation, s);
}

void warm_start_articulation(const Articulation& articulation, const ArticulationSolve& s) {
  // Before the impulses of the last sub-step: after an impact these do not belong to this sub-step, and
  // neither would their bias.
  compute_bias(articulation, s, kErrorsBeforeContacts);
  add_warm_start_work(articulation, s);
  for (const ArticulationNode& node : articulation.nodes) {
    JointRecord& joint = s.records[node.record];
    const JointConstraint& work = s.work[node.work];
    warm_start_joint_axes(joint, work, s.bodies);
    // The accumulated impulses, along the present rows.
    float accumulated[kMaxBlockRows];
    for (int i = 0; i < node.count; ++i)
      accumulated[i] = accumulated_impulse(joint, work, equation_at(node.rows, i), i);
    clear_equation_impulses(joint, work);
    NodeBodies bodies(node, s.bodies);
    for (int i = 0; i < node.count; ++i) {
      bodies.apply_impulse(node.rows, i, accumulated[i]);
      add_impulse(joint, work, equation_at(node.rows, i), i, accumulated[i]);
    }
    bodies.store();
  }
}

void solve_articulation(const Articulation& articulation, const ArticulationSolve& s) {
  iterate_drives(articulation, s, true);
  solve_rows(articulation, s, true);
  solve_drives(articulation, s, true);
  solve_limits(articulation, s, kErrorsBeforeContacts);
  compute_bias(articulation, s, kMaxErrors);  // with velocities that agree with the joints
}

void solve_articulation_after_contacts(const Articulation& articulation, const ArticulationSolve& solve) {
  ArticulationSolve s = solve;
  s.settings.keeps_motors = articulation.presses_held;
  iterate_drives(articulation, s, true);
  solve_rows(articulation, s, true);
  solve_drives(articulation, s, true);
  solve_limits(articulation, s, kMaxErrors);
}

void relax_articulation(const Articulation& articulation, const ArticulationSolve& s) {
  iterate_drives(articulation, s, false);
  solve_rows(articulation, s, false);
  solve_drives(articulation, s, false);
  solve_limits(articulation, s, kNoErrors);
  for (const ArticulationNode& node : articulation.nodes)
    accumulate_joint_impulses(s.records[node.record], s.work[node.work], s.bodies);
}

}  // namespace gyre
