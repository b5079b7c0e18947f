#include "rigid/solve/row_stages.h"

#include "solver/rows/body_newton.h"
#include "solver/rows/constraint_rows.h"
#include "solver/rows/delassus.h"
#include "solver/rows/gauss_seidel.h"

namespace gyre {

namespace {

// Sides of the polygon from which pivoting approaches Coulomb's disc.
constexpr int kLeadingSides = 8;
// Accuracy of impulses: this share of the largest that stops a row alone, or this many N s if that is less.
constexpr double kDirectShare = 1.0e-7, kDirectImpulse = 1.0e-7, kRoundedImpulse = 1.0e-11;
constexpr double kAccepted = 5.0;  // errors, in these units, that Newton's method may leave at last
constexpr double kNncgShare = 1.0e-5;
// Steps of Newton's method, and the numbers of iterations after which it is tried again if it does not end. The last two are the largest
// numbers of rows for the longer tries and for pivoting after them.
constexpr int kNewtonSteps = 30, kLeadingSweeps[] = {0, 64, 256, 1024}, kMaxLedFar = 1500,
              kMaxPivotRows = 100;
// Multiplications of a factorisation above which NNCG solves the island: about a tenth of a second.
constexpr std::uint64_t kMaxFactorWork = 100'000'000;

// The rows of one island in a sub-step, and their sources.
struct IslandRows {
  const RowIsland& island;
  RowWorkerRoom& room;
  RowFrame frame;
  RowList list;

  std::span<Row> rows() const { return room.rows.first(std::size_t(list.count)); }
  std::span<RowBody> bodies() const { return frame.bodies; }
};

int sweeps_of(const SolverSettings& settings) {
  if (settings.options.iterations > 0) return settings.options.iterations;
  return settings.kind == SolverKind::lcp ? kNncgIterations : kSequentialIterations;
}
bool pivots(LcpMethod method) { return method == LcpMethod::dantzig || method == LcpMethod::lemke; }

IslandRows begin_island(const RowSolve& s, const RowIsland& island, RowWorkerRoom& room, bool at_rest) {
  const BodyStore& store = s.joints.w.bodies;
  for (std::size_t i = 0; i < island.bodies.size(); ++i) {
    const std::uint32_t slot = island.bodies[i];
    const BodyMotion& motion = store.motion[slot];
    RowBody& body = room.bodies[i];
    body = make_row_body(store.inertia[slot], store.flags[slot].locked_linear);
    if (!at_rest) body.linear = DVec3(motion.linear_velocity), body.angular = DVec3(motion.angular_velocity);
  }
  const RowFrame frame{room.bodies.first(island.bodies.size()), s.islands.place.data(), store.motion.data(),
                       double(s.joints.settings.substep)};
  return {island, room, frame, {room.rows.data(), room.kept.data(), 0}};
}

// ---------------------------------------------------------------------------------------------------------- solving

double largest_alone(std::span<const Row> rows, std::span<const RowBody> bodies) {
  double most = 0.0;
  for (const Row& row : rows) {
    if (!(row.diagonal > 0.0)) continue;
    const double w = row_speed(row, bodies) - row.target_speed;
    most = max(most, (w < 0.0 ? -w : w) / row.diagonal);
  }
  return most;
}

// The largest speed at which an equation of a joint opens, m/s.
double opening_speed(std::span<const Row> rows, std::span<const RowBody> bodies) {
  double fastest = 0.0;
  for (const Row& row : rows) {
    if (!is_equation(row.limits) || (row.linear_a == DVec3{} && row.linear_b == DVec3{})) continue;
    const double w = row_speed(row, bodies) - row.target_speed + row.compliance * row.impulse;
    fastest = max(fastest, absolute(w));
  }
  return fastest;
}

void iterate_island(const RowSolve& s, const IslandRows& island, NumberRoom room, double scale,
                    RowStats& report) {
  const std::span<Row> rows = island.rows();
  const std::span<RowBody> bodies = island.bodies();
  warm_start_rows(rows, bodies);
  if (s.settings.kind == SolverKind::lcp) {
    const GaussSeidelResult result =
        solve_nncg(rows, bodies, s.friction, kNncgShare * scale, sweeps_of(s.settings), room);
    report.sweeps = max(report.sweeps, result.iterations);
    report.residual = max(report.residual, result.residual);
    return;
  }
  for (int i = 0; i < sweeps_of(s.settings); ++i) iterate_rows_once(rows, bodies, s.friction);
  report.sweeps = sweeps_of(s.settings);
  const double residual = find_row_residual(rows, bodies, s.friction);
  report.residual = max(report.residual, residual);
  // Small errors are those of every iteration. Here it missed most of what the worst row needs.
  if (residual > 0.5 * scale) {
    const double fall = double(reference_gravity(s.joints.w.settings) * s.joints.settings.substep);
    report.missed_share = max(report.missed_share, opening_speed(rows, bodies) / fall);
  }
}

double direct_tolerance(double scale) {
  return max(kRoundedImpulse * scale, min(kDirectImpulse, kDirectShare * scale));
}

// False if the error is too large. Then the rows hold the best impulses found.
bool solve_island_directly(const RowSolve& s, const IslandRows& island, NumberRoom room, DirectMethod method,
                           double scale, RowStats& report) {
  const std::span<Row> rows = island.rows();
  const std::size_t n = rows.size();
  const std::span<double> a = room.take(n * n), q = room.take(n), x = room.take(n);
  RowWorkerRoom& own = island.room;
  fill_delassus(rows, island.bodies().size(), a, own.first, own.next);
  for (std::size_t i = 0; i < n; ++i) {
    q[i] = row_speed(rows[i], island.bodies()) - rows[i].target_speed;
    x[i] = rows[i].impulse;
    own.limits[i] = rows[i].limits;
  }
  const DenseProblem problem{int(n), a, q, own.limits.first(n), &s.friction};
  const double tolerance = direct_tolerance(scale);
  const DirectResult result = solve_direct(problem, s.polygon, method, tolerance, x, room);
  for (std::size_t i = 0; i < n; ++i) rows[i].impulse = x[i];
  if (!result.is_solved) return false;
  warm_start_rows(rows, island.bodies());
  report.residual = max(report.residual, result.residual);
  report.direct = 1;
  return true;
}

// Runs Newton's method; false if it does not end. Then the rows hold the best impulses found.
bool solve_island_by_newton(const RowSolve& s, const IslandRows& island, NumberRoom room, double scale,
                            RowStats& report) {
  const std::span<Row> rows = island.rows();
  const std::span<double> x = room.take(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) x[i] = rows[i].impulse;
  const double tolerance = direct_tolerance(scale);
  const NewtonResult result = solve_body_newton({rows, island.bodies(), &s.friction, &island.island.plan},
                                                tolerance, kNewtonSteps, x, room);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = x[i];
  if (!(result.residual <= kAccepted * tolerance)) return false;
  warm_start_rows(rows, island.bodies());
  report.residual = max(report.residual, result.residual);
  report.direct = 1;
  return true;
}

// Runs Newton's method from the present impulses; if it does not end, again after some iterations.
bool solve_island_by_all_means(const RowSolve& s, const IslandRows& island, NumberRoom room, double scale,
                               RowStats& report) {
  const std::span<Row> rows = island.rows();
  for (const int sweeps : kLeadingSweeps) {
    if (sweeps > kLeadingSweeps[1] && int(rows.size()) > kMaxLedFar) break;
    if (sweeps > 0) {
      warm_start_rows(rows, island.bodies());
      solve_nncg(rows, island.bodies(), s.friction, kNncgShare * scale, sweeps, room);
      for (const Row& row : rows) apply_row_impulse(row, -row.impulse, island.bodies());
    }
    if (solve_island_by_newton(s, island, room, scale, report)) return true;
  }
  return false;
}

void solve_island(const RowSolve& s, const IslandRows& island, RowStats& report) {
  const std::span<Row> rows = island.rows();
  if (rows.empty()) return;
  report.islands = 1;
  report.largest = max(report.largest, int(rows.size()));
  const double scale = largest_alone(rows, island.bodies());
  const NumberRoom room(island.room.numbers);
  const LcpMethod method = s.settings.options.lcp_method;
  if (s.settings.kind == SolverKind::lcp && method != LcpMethod::nncg) {
    const int most = s.settings.options.direct_rows;
    const bool fits = int(rows.size()) <= most;
    if (pivots(method) && fits && solve_island_directly(s, island, room, s.method, scale, report)) return;
    if (pivots(method) && !fits) report.too_large = 1;
    if (!(pivots(method) && fits) && !island.island.plan.columns.empty() &&
        solve_island_by_all_means(s, island, room, scale, report))
      return;
    if (method == LcpMethod::automatic && int(rows.size()) <= min(most, kMaxPivotRows) &&
        solve_island_directly(s, island, room, DirectMethod::dantzig, scale, report))
      return;
  }
  iterate_island(s, island, room, scale, report);
}

// ----------------------------------------------------------------------------------------------------------- stages

void make_rows(const RowSolve& s, IslandRows& island, bool first) {
  const JointSolve& joints = s.joints;
  int next = 0;
  for (const std::uint32_t i : island.island.joints) {
    JointRecord& joint = joints.w.joints.records[joints.batch.joints[i]];
    update_joint_bias(joint, joints.works.work[i], joints.bodies, joints.settings);
    island.room.starts[std::size_t(next++)] = island.list.count;
    add_joint_rows(joint, joints.works.work[i], joints.settings, island.frame, island.list);
  }
  const float warm = first ? s.contacts.settings.warm_scale : 1.0f;
  for (const std::uint32_t i : island.island.constraints) {
    island.room.starts[std::size_t(next++)] = island.list.count;
    add_contact_rows(s.contacts.lists.constraints[i], island.frame, warm, island.list);
  }
  island.room.starts[std::size_t(next)] = island.list.count;
}

void keep_impulses(const RowSolve& s, const IslandRows& island) {
  const JointSolve& joints = s.joints;
  std::size_t next = 0;
  const auto range = [&] {
    const std::size_t begin = std::size_t(island.room.starts[next]),
                      end = std::size_t(island.room.starts[next + 1]);
    ++next;
    return std::pair(begin, end - begin);
  };
  for (const std::uint32_t i : island.island.joints) {
    const auto [begin, count] = range();
    store_joint_impulses(joints.w.joints.records[joints.batch.joints[i]], joints.works.work[i],
                        island.room.rows.subspan(begin, count), island.room.kept.subspan(begin, count));
  }
  for (const std::uint32_t i : island.island.constraints) {
    const auto [begin, count] = range();
    store_contact_impulses(s.contacts.lists.constraints[i], s.friction,
                          island.room.rows.subspan(begin, count));
  }
}

// Adding zero keeps -0 out of the state.
void store_velocities(const RowSolve& s, const IslandRows& island) {
  for (std::size_t i = 0; i < island.island.bodies.size(); ++i) {
    BodyMotion& motion = s.joints.w.bodies.motion[island.island.bodies[i]];
    motion.linear_velocity = to_float(island.frame.bodies[i].linear) + Vec3{};
    motion.angular_velocity = to_float(island.frame.bodies[i].angular) + Vec3{};
  }
}

void solve_islands(const RowSolve& s, bool first, int begin, int end, int worker) {
  for (int i = begin; i < end; ++i) {
    IslandRows island =
        begin_island(s, s.islands.islands[std::size_t(i)], s.rooms[std::size_t(worker)], false);
    make_rows(s, island, first);
    solve_island(s, island, s.reports[std::size_t(i)]);
    store_velocities(s, island);
    keep_impulses(s, island);
  }
}

// Each worker gets memory for the largest island, because any worker may solve it.
void make_rooms(RowSolve& s, Arena& arena, std::size_t workers) {
  std::size_t rows = 0, bodies = 0, owners = 0, numbers = 0;
  for (const RowIsland& island : s.islands.islands) {
    const std::size_t n = island.size.rows;
    rows = max(rows, n);
    bodies = max(bodies, island.bodies.size());
    owners = max(owners, island.joints.size() + island.constraints.size());
    std::size_t own = nncg_room(n);
    if (s.settings.kind == SolverKind::lcp && s.settings.options.lcp_method != LcpMethod::nncg) {
      if (!island.plan.columns.empty()) own = max(own, n + body_newton_room(n, island.plan));
      // The final number of rows may be below the count, and then small enough for pivoting.
      const LcpMethod method = s.settings.options.lcp_method;
      int most = s.settings.options.direct_rows;
      if (!pivots(method)) most = method == LcpMethod::automatic ? min(most, kMaxPivotRows) : 0;
      DirectSize size = island.size;
      size.rows = min(n, std::size_t(most));
      size.equations = min(size.equations, size.rows), size.cones = min(size.cones, (size.rows + 1) / 2);
      own = max(own, size.rows * size.rows + 2 * size.rows + direct_room(size, s.polygon, s.method));
    }
    numbers = max(numbers, own);
  }
  s.rooms = arena.make<RowWorkerRoom>(workers);
  for (RowWorkerRoom& room : s.rooms) {
    room = {arena.make<Row>(rows),
            arena.make<float*>(rows),
            arena.make<RowBody>(bodies),
            arena.make<RowLimits>(rows),
            arena.make<std::int32_t>(owners + 1),
            arena.make<std::int32_t>(bodies),
            arena.make<std::int32_t>(2 * rows),
            arena.make<double>(numbers)};
  }
}

void add_reports(RowStats& sum, std::span<const RowStats> reports) {
  for (const RowStats& report : reports) {
    sum.residual = max(sum.residual, report.residual);
    sum.missed_share = max(sum.missed_share, report.missed_share);
    sum.islands += report.islands;
    sum.largest = max(sum.largest, report.largest);
    sum.direct += report.direct;
    sum.too_large += report.too_large;
    sum.sweeps = max(sum.sweeps, report.sweeps);
  }
}

}  // namespace

void solve_row_islands_first(const RowSolve& s, int begin, int end, int worker) {
  solve_islands(s, true, begin, end, worker);
}
void solve_row_islands(const RowSolve& s, int begin, int end, int worker) {
  solve_islands(s, false, begin, end, worker);
}
void push_row_islands_apart(const RowSolve& s, int begin, int end, int worker) {
  const JointSolve& joints = s.joints;
  for (int i = begin; i < end; ++i) {
    IslandRows island =
        begin_island(s, s.islands.islands[std::size_t(i)], s.rooms[std::size_t(worker)], true);
    bool overlaps = false;
    for (const std::uint32_t c : island.island.constraints) {
      if (add_overlap_rows(s.contacts.lists.constraints[c], island.frame, s.contacts.settings.step,
                           island.list))
        overlaps = true;
    }
    if (!overlaps) continue;
    for (const std::uint32_t j : island.island.joints)
      add_joint_equations(joints.w.joints.records[joints.batch.joints[j]], joints.works.work[j], island.frame,
                          island.list);
    RowStats unheard;  // statistics of displacements are dropped
    solve_island(s, island, unheard);
    store_velocities(s, island);
  }
}

void prepare_row_joints(const RowSolve& s, int begin, int end) {
  const JointSolve& joints = s.joints;
  for (int i = begin; i < end; ++i) {
    for (const std::uint32_t j : s.islands.islands[std::size_t(i)].joints)
      prepare_joint(joints.w.joints.records[joints.batch.joints[j]], joints.works.work[j],
                    joints.works.places[j], joints.bodies, joints.settings);
  }
}
void sum_row_joints(const RowSolve& s, int begin, int end) {
  const JointSolve& joints = s.joints;
  for (int i = begin; i < end; ++i) {
    for (const std::uint32_t j : s.islands.islands[std::size_t(i)].joints)
      accumulate_joint_impulses(joints.w.joints.records[joints.batch.joints[j]], joints.works.work[j],
                                joints.bodies);
  }
}

RowSolve begin_row_solve(const ContactSolve& contacts, const JointSolve& joints,
                         const SolverSettings& settings, std::size_t workers, Arena& arena) {
  RowSolve rows{contacts, joints, settings, make_friction_set(settings.options.friction_sides), {}};
  rows.polygon = settings.options.friction_sides == 0 ? make_friction_set(kLeadingSides) : rows.friction;
  if (settings.options.lcp_method == LcpMethod::lemke) rows.method = DirectMethod::lemke;
  const std::span<const ContactConstraint> constraints = contacts.lists.constraints;
  rows.islands = find_row_islands(joints.w, constraints, joints.batch, joints.works.work, arena);
  if (settings.kind == SolverKind::lcp && settings.options.lcp_method != LcpMethod::nncg)
    plan_row_islands(joints.w, constraints, joints.batch, kMaxFactorWork, arena, rows.islands);
  rows.reports = arena.make<RowStats>(rows.islands.islands.size());
  for (RowStats& report : rows.reports) report = {};
  make_rooms(rows, arena, workers);
  return rows;
}

void finish_row_solve(const RowSolve& s, RowStats& report) {
  add_reports(report, s.reports);
  for (const ContactConstraint& constraint : s.contacts.lists.constraints) {
    float load = 0.0f;
    for (int k = 0; k < constraint.manifold->count; ++k) load += constraint.manifold->points[k].total_impulse;
    constraint.manifold->load_age = load > 0.0f ? constraint.manifold->load_age + s.contacts.settings.step : 0.0f;
  }
}

}  // namespace gyre
