#include "solver/linkage_response.h"

#include "solver/joint_equations.h"

namespace gyre {

namespace {

DVec3 at(std::span<const double> speeds, std::int32_t side, int part) {
  const double* const v = &speeds[std::size_t(6 * side + 3 * part)];
  return {v[0], v[1], v[2]};
}
void add(std::span<double> speeds, std::int32_t side, DVec3 linear, DVec3 angular) {
  double* const v = &speeds[std::size_t(6 * side)];
  v[0] += linear.x, v[1] += linear.y, v[2] += linear.z;
  v[3] += angular.x, v[4] += angular.y, v[5] += angular.z;
}
std::size_t first_row(const Linkage& linkage, std::size_t node) {
  return linkage.plan.columns[linkage.plan.place_of[node]].row;
}
double row_speed(const LinkageNode& node, int i, std::span<const double> speeds) {
  const DVec3 push = DVec3(node.rows.push.at(i));
  double speed = 0.0;
  if (node.side_a >= 0)
    speed -= dot(push, at(speeds, node.side_a, 0)) +
             dot(DVec3(node.rows.arm_a.at(i)), at(speeds, node.side_a, 1));
  if (node.side_b >= 0)
    speed += dot(push, at(speeds, node.side_b, 0)) +
             dot(DVec3(node.rows.arm_b.at(i)), at(speeds, node.side_b, 1));
  return speed;
}

}  // namespace

std::size_t response_speeds(const Linkage& linkage) { return 6 * linkage.bodies.size(); }

double axis_speed(const LinkageNode& node, const AxisRow& row, std::span<const double> speeds) {
  double speed = 0.0;
  if (node.side_a >= 0)
    speed -= dot(DVec3(row.push_a), at(speeds, node.side_a, 0)) +
             dot(DVec3(row.arm_a), at(speeds, node.side_a, 1));
  if (node.side_b >= 0)
    speed += dot(DVec3(row.push_b), at(speeds, node.side_b, 0)) +
             dot(DVec3(row.arm_b), at(speeds, node.side_b, 1));
  return speed;
}

float axis_speed(const LinkageNode& node, const AxisRow& row, const JointBodies& bodies) {
  float speed = 0.0f;
  if (node.body_a != kNoBody) {
    const BodyMotion& a = bodies.motion[node.body_a];
    speed -= dot(row.push_a, a.linear_velocity) + dot(row.arm_a, a.angular_velocity);
  }
  if (node.body_b != kNoBody) {
    const BodyMotion& b = bodies.motion[node.body_b];
    speed += dot(row.push_b, b.linear_velocity) + dot(row.arm_b, b.angular_velocity);
  }
  return speed;
}

void find_response(const Linkage& linkage, const LinkageSolve& solve, std::uint32_t node, const AxisRow& row, float sign,
                   ResponseColumn column) {
  const auto inverse_mass = [&](std::int32_t body) { return solve.bodies.inertia[body].inverse_mass; };
  const LinkageNode& own = linkage.nodes[node];
  for (double& speed : column.speeds) speed = 0.0;
  if (own.side_a >= 0)
    add(column.speeds, own.side_a, DVec3((-sign * inverse_mass(own.body_a)) * row.push_a),
        DVec3(linkage.bodies[std::size_t(own.side_a)].inverse * (-sign * row.arm_a)));
  if (own.side_b >= 0)
    add(column.speeds, own.side_b, DVec3((sign * inverse_mass(own.body_b)) * row.push_b),
        DVec3(linkage.bodies[std::size_t(own.side_b)].inverse * (sign * row.arm_b)));
  for (std::size_t n = 0; n < linkage.nodes.size(); ++n) {
    const LinkageNode& other = linkage.nodes[n];
    double* const x = &column.answers[first_row(linkage, n)];
    for (int i = 0; i < other.count; ++i) x[i] = -row_speed(other, i, column.speeds);
  }
  solve_blocks(linkage.plan, linkage.values, column.answers);
  for (std::size_t n = 0; n < linkage.nodes.size(); ++n) {
    const LinkageNode& other = linkage.nodes[n];
    const double* const x = &column.answers[first_row(linkage, n)];
    for (int i = 0; i < other.count; ++i) {
      const DVec3 push = DVec3(other.rows.push.at(i));
      if (other.side_a >= 0)
        add(column.speeds, other.side_a, (-x[i] * double(inverse_mass(other.body_a))) * push,
            -x[i] * DVec3(other.rows.spin_a.at(i)));
      if (other.side_b >= 0)
        add(column.speeds, other.side_b, (x[i] * double(inverse_mass(other.body_b))) * push,
            x[i] * DVec3(other.rows.spin_b.at(i)));
    }
  }
}

void push_columns(const Linkage& linkage, const LinkageSolve& solve, std::span<const double> impulses,
                  const ResponseColumns& columns, std::span<double> sum) {
  const std::size_t speeds = response_speeds(linkage), rows = linkage.plan.rows;
  for (double& one : sum) one = 0.0;
  for (std::size_t c = 0; c < impulses.size(); ++c) {
    if (impulses[c] == 0.0) continue;
    for (std::size_t i = 0; i < speeds; ++i) sum[i] += impulses[c] * columns.speeds[c * speeds + i];
  }
  // Adding zero keeps -0 out of the state.
  for (std::size_t b = 0; b < linkage.bodies.size(); ++b) {
    BodyMotion& motion = solve.bodies.motion[linkage.bodies[b].body];
    motion.linear_velocity += to_float(at(sum, std::int32_t(b), 0)) + Vec3{};
    motion.angular_velocity += to_float(at(sum, std::int32_t(b), 1)) + Vec3{};
  }
  for (std::size_t n = 0; n < linkage.nodes.size(); ++n) {
    const LinkageNode& node = linkage.nodes[n];
    for (int i = 0; i < node.count; ++i) {
      double impulse = 0.0;
      for (std::size_t c = 0; c < impulses.size(); ++c)
        impulse += impulses[c] * columns.answers[c * rows + first_row(linkage, n) + std::size_t(i)];
      keep_impulse(solve.records[node.record], solve.work[node.work],
                   {node.rows.push.at(i), node.rows.arm_a.at(i), node.rows.arm_b.at(i)}, i,
                   float(impulse) + 0.0f);
    }
  }
}

}  // namespace gyre
