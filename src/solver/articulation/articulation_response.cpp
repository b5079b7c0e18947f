#include "solver/articulation/articulation_response.h"

#include "solver/joint/joint_equations.h"

namespace gyre {

namespace {

struct Speeds {
  DVec3 linear, angular;
};

// Velocity changes of a row's two bodies for an impulse of one, before the answer of the equations.
struct RowResponse {
  std::int32_t side_a = -1, side_b = -1;
  Speeds a, b;

  Speeds of(std::int32_t side) const {
    if (side < 0) return {};
    return side == side_a ? a : side == side_b ? b : Speeds{};
  }
};
RowResponse response_of_row(const Articulation& articulation, const ArticulationSolve& solve,
                            const ResponseRow& row) {
  const ArticulationNode& node = articulation.nodes[row.node];
  RowResponse response{node.side_a, node.side_b, {}, {}};
  if (node.side_a >= 0)
    response.a = {
        DVec3((-row.sign * solve.bodies.inertia[node.body_a].inverse_mass) * row.row->linear_a),
        DVec3(articulation.bodies[std::size_t(node.side_a)].inverse * (-row.sign * row.row->angular_a))};
  if (node.side_b >= 0)
    response.b = {
        DVec3((row.sign * solve.bodies.inertia[node.body_b].inverse_mass) * row.row->linear_b),
        DVec3(articulation.bodies[std::size_t(node.side_b)].inverse * (row.sign * row.row->angular_b))};
  return response;
}

bool share_body(const ArticulationNode& node, const ArticulationNode& other) {
  const auto is_one = [&](std::int32_t side) {
    return side >= 0 && (side == other.side_a || side == other.side_b);
  };
  return is_one(node.side_a) || is_one(node.side_b);
}

// Sets a node's part of a right side: the violation of its rows by these velocities.
void set_missing(const ArticulationNode& node, const Speeds& a, const Speeds& b, double* x) {
  const RowVectors &direction = node.rows.direction, &angular_a = node.rows.angular_a,
                   &angular_b = node.rows.angular_b;
  const DVec3 u = a.linear - b.linear;
  for (int i = 0; i < node.count; ++i)
    x[i] = double(direction.x[i]) * u.x + double(direction.y[i]) * u.y + double(direction.z[i]) * u.z +
           double(angular_a.x[i]) * a.angular.x + double(angular_a.y[i]) * a.angular.y +
           double(angular_a.z[i]) * a.angular.z - double(angular_b.x[i]) * b.angular.x -
           double(angular_b.y[i]) * b.angular.y - double(angular_b.z[i]) * b.angular.z;
}

// Adds the effect of the impulses of a node's rows.
void add_answers(const ArticulationNode& node, const double* x, float inverse_mass_a, float inverse_mass_b,
                 Speeds& a, Speeds& b) {
  const ArticulationRows& rows = node.rows;
  DVec3 force, spin_a, spin_b;
  for (int i = 0; i < node.count; ++i) {
    force += x[i] * DVec3(rows.direction.at(i));
    spin_a += x[i] * DVec3(rows.spin_a.at(i));
    spin_b += x[i] * DVec3(rows.spin_b.at(i));
  }
  a.linear += -double(inverse_mass_a) * force, a.angular += -1.0 * spin_a;
  b.linear += double(inverse_mass_b) * force, b.angular += spin_b;
}

double speed_of(const ResponseRow& row, const Speeds& a, const Speeds& b) {
  return double(row.sign) *
         (dot(DVec3(row.row->linear_b), b.linear) + dot(DVec3(row.row->angular_b), b.angular) -
          dot(DVec3(row.row->linear_a), a.linear) - dot(DVec3(row.row->angular_a), a.angular));
}

double dot_rows(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::size_t first_row(const Articulation& articulation, std::size_t node) {
  return articulation.plan.columns[articulation.plan.index_of[node]].row;
}

// Velocities of all bodies, six numbers each.
class BodySpeeds {
 public:
  explicit BodySpeeds(std::span<double> numbers) : numbers_(numbers) {}
  Speeds at(std::int32_t side) const {
    if (side < 0) return {};
    const double* const v = &numbers_[6 * std::size_t(side)];
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  }
  void set(std::int32_t side, const Speeds& speeds) {
    if (side < 0) return;
    double* const v = &numbers_[6 * std::size_t(side)];
    v[0] = speeds.linear.x, v[1] = speeds.linear.y, v[2] = speeds.linear.z;
    v[3] = speeds.angular.x, v[4] = speeds.angular.y, v[5] = speeds.angular.z;
  }
  void add(std::int32_t side, double times, const Speeds& speeds) {
    const Speeds now = at(side);
    set(side, {now.linear + times * speeds.linear, now.angular + times * speeds.angular});
  }

 private:
  std::span<double> numbers_;
};

}  // namespace

float axis_speed(const ArticulationNode& node, const AxisRow& row, const JointBodies& bodies) {
  float speed = 0.0f;
  if (node.body_a != kNoBody) {
    const BodyMotion& a = bodies.motion[node.body_a];
    speed -= dot(row.linear_a, a.linear_velocity) + dot(row.angular_a, a.angular_velocity);
  }
  if (node.body_b != kNoBody) {
    const BodyMotion& b = bodies.motion[node.body_b];
    speed += dot(row.linear_b, b.linear_velocity) + dot(row.angular_b, b.angular_velocity);
  }
  return speed;
}

void find_response(const Articulation& articulation, const ArticulationSolve& solve, const ResponseRow& row,
                   ResponseColumn column) {
  const RowResponse response = response_of_row(articulation, solve, row);
  const ArticulationNode& own = articulation.nodes[row.node];
  for (double& one : column.down) one = 0.0;
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    const ArticulationNode& node = articulation.nodes[n];
    if (share_body(own, node))
      set_missing(node, response.of(node.side_a), response.of(node.side_b),
                  &column.down[first_row(articulation, n)]);
  }
  solve_blocks_down(articulation.plan, articulation.values, column.down, column.scaled);
}

void compute_delassus(const Articulation& articulation, const ArticulationSolve& solve,
                      std::span<const ResponseRow> rows, const ResponseColumns& columns, std::size_t known,
                      double* matrix, std::size_t stride) {
  const std::size_t size = articulation.plan.rows;
  for (std::size_t j = known; j < rows.size(); ++j) {
    const RowResponse response = response_of_row(articulation, solve, rows[j]);
    for (std::size_t i = 0; i <= j; ++i) {
      const ArticulationNode& node = articulation.nodes[rows[i].node];
      const double alone = speed_of(rows[i], response.of(node.side_a), response.of(node.side_b));
      matrix[i * stride + j] = matrix[j * stride + i] =
          alone - dot_rows(columns.at(j, size).scaled, columns.at(i, size).down);
    }
  }
}

void apply_row_impulses(const Articulation& articulation, const ArticulationSolve& solve,
                        std::span<const ResponseRow> rows, std::span<const double> impulses,
                        std::span<double> speeds) {
  BodySpeeds changes(speeds);
  for (double& one : speeds) one = 0.0;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (impulses[c] == 0.0) continue;
    const RowResponse response = response_of_row(articulation, solve, rows[c]);
    changes.add(response.side_a, impulses[c], response.a);
    changes.add(response.side_b, impulses[c], response.b);
  }
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    const ArticulationNode& node = articulation.nodes[n];
    set_missing(node, changes.at(node.side_a), changes.at(node.side_b),
                &articulation.vector[first_row(articulation, n)]);
  }
  solve_blocks(articulation.plan, articulation.values, articulation.vector);
  const auto inverse_mass = [&](std::int32_t side, std::int32_t body) {
    return side < 0 ? 0.0f : solve.bodies.inertia[body].inverse_mass;
  };
  for (std::size_t n = 0; n < articulation.nodes.size(); ++n) {
    const ArticulationNode& node = articulation.nodes[n];
    const double* const x = &articulation.vector[first_row(articulation, n)];
    Speeds a = changes.at(node.side_a), b = changes.at(node.side_b);
    add_answers(node, x, inverse_mass(node.side_a, node.body_a), inverse_mass(node.side_b, node.body_b), a,
                b);
    changes.set(node.side_a, a);
    changes.set(node.side_b, b);
    for (int i = 0; i < node.count; ++i)
      add_impulse(solve.records[node.record], solve.work[node.work],
                  {node.rows.direction.at(i), node.rows.angular_a.at(i), node.rows.angular_b.at(i)}, i,
                  float(x[i]) + 0.0f);
  }
  // Adding zero keeps -0 out of the state.
  for (std::size_t side = 0; side < articulation.bodies.size(); ++side) {
    BodyMotion& motion = solve.bodies.motion[articulation.bodies[side].body];
    const Speeds change = changes.at(std::int32_t(side));
    motion.linear_velocity += to_float(change.linear) + Vec3{};
    motion.angular_velocity += to_float(change.angular) + Vec3{};
  }
}

}  // namespace gyre
