#include "solver/rest/static_equilibrium.h"

#include "math/block_six.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gyre {

namespace {

// Bounds on the search: rounds, or multiplications if these are fewer rounds. Pyramids and walls take one
// round, card houses and towers of planks up to six, arches near their limit up to twenty.
constexpr int kMaxRounds = 30;
constexpr int kMinRounds = 12;
constexpr int kMaxStuck = 5;  // successive rounds without a smaller residual
constexpr std::uint64_t kMaxWork = 6'000'000;
// Above this number of multiplications a round must achieve more: a stable structure converges at once.
constexpr std::uint64_t kExpensiveWork = 250'000;
constexpr int kMaxStuckIfExpensive = 2;  // successive rounds that left more than this share of the residual
constexpr double kProgressIfExpensive = 0.7;  // share of the residual that a round may leave
constexpr int kMaxRoundsIfNew =
    2;  // new and expensive: a structure put in place converges at once, one that has yet to settle does not
// Share of its stiffness that an inactive point keeps in the second derivative, but not in its impulse.
constexpr double kInactiveStiffness = 1.0e-6;
// The longest step, in Newton steps, and the number of tries before it is taken as it is.
constexpr double kLongestStep = 1.0e3;
constexpr int kMaxBisections = 40;
// A slope counts as zero below the first share of its initial value for Newton's own step, below the second
// otherwise.
constexpr double kFlatSlope = 1.0e-9, kRoundingSlope = 1.0e-13;
// Initial tangential stiffness of contacts, as of elastic bodies (R. Mindlin, 1949: 2 (1 - nu) / (2 - nu) =
// 0.82 for nu = 0.3). Softer contacts than the second carry no friction.
constexpr float kShear = 0.8f;
constexpr float kMinShear = 1.0e-7f;
// Share of its friction limit to which a contact with too much friction is softened.
constexpr double kFrictionAim = 0.7;
constexpr double kMaxSoftening = 0.05;  // largest softening at once
// s: age of contacts that cease to be rigid.
constexpr float kReleasedAge = 2.0f;
// Points with a larger separation, as a share of the size, do not touch.
constexpr float kTouchingGap = 1.0e-3f;
constexpr double kInfinite = 1.0e30;
// Residual speed of a body that counts as rounding, as a multiple of its rest speed. A residual above the
// second share of that costs one more round.
constexpr double kResidual = 100.0;
constexpr double kExactShare = 0.01;
// The largest impulse of a point over the weight of the structure. A body wedged between two walls would hold
// by a large enough thrust though nothing presses it: a thousand times its weight, even by the little
// friction that a point has about its normal. Arches carry less than once their weight, a wedge of two
// degrees between smooth walls 29 times.
constexpr double kMaxThrust = 30.0;
// Motion of a rigid structure that counts as rest, as a multiple of the rest speed: the weight of thirty rows
// of boxes rounds to more than that, and a solve would only round anew. The motion may grow as the structure
// buckles; then one round follows.
constexpr float kRigidRestFactor = 30.0f;

// A row of a contact on both bodies: direction, stiffness, and impulse before any displacement. Rows of
// bodies are linear, then angular.
struct ContactRow {
  double a[6], b[6];
  double stiffness = 0.0, before = 0.0;
};

ContactRow make_row(Vec3 direction, Vec3 from_a, Vec3 from_b, double stiffness, float before) {
  const Vec3 angular_a = cross(from_a, direction), angular_b = cross(from_b, direction);
  return {{-double(direction.x), -double(direction.y), -double(direction.z), -double(angular_a.x),
           -double(angular_a.y), -double(angular_a.z)},
          {double(direction.x), double(direction.y), double(direction.z), double(angular_b.x),
           double(angular_b.y), double(angular_b.z)},
          stiffness,
          double(before)};
}

// The rows of a contact: one for each point, two of friction and one of twist if it has a load.
struct ContactRows {
  ContactRow normal[kMaxManifoldPoints];
  ContactRow tangent[2], twist;
  Vec3 u, v;
  bool rubs = false;
};

// Friction and twist rows with the present tangential stiffness.
void prepare_friction_rows(const ContactConstraint& constraint, const StructureScratch& work,
                           ContactRows& rows) {
  const Manifold& manifold = *constraint.manifold;
  const Vec3 n = manifold.normal, from_b = work.impulse.friction_from_b;
  const Vec3 from_a = from_b + (manifold.points[0].from_a - manifold.points[0].from_b);
  const double shear = double(work.shear) * double(std::popcount(work.touching));
  rows.tangent[0] = make_row(rows.u, from_a, from_b, shear, dot(work.before.friction, rows.u));
  rows.tangent[1] = make_row(rows.v, from_a, from_b, shear, dot(work.before.friction, rows.v));
  const double arm = double(work.impulse.twist_per_normal) / double(constraint.static_friction);
  rows.twist = {{0, 0, 0, -double(n.x), -double(n.y), -double(n.z)},
                {0, 0, 0, double(n.x), double(n.y), double(n.z)},
                shear * arm * arm,
                double(work.before.twist)};
}

void prepare_rows(const ContactConstraint& constraint, const StructureScratch& work, ContactRows& rows) {
  const Manifold& manifold = *constraint.manifold;
  const Vec3 n = manifold.normal;
  for (int k = 0; k < manifold.count; ++k) {
    rows.normal[k] =
        make_row(n, manifold.points[k].from_a, manifold.points[k].from_b, 1.0, work.before.normal[k]);
  }
  rows.u = any_perpendicular(n);
  rows.v = cross(n, rows.u);
  rows.rubs = constraint.static_friction > 0.0f && work.touching != 0;
  if (rows.rubs) prepare_friction_rows(constraint, work, rows);
}

// True if the iterations left every body practically at rest.
bool is_at_rest(const RestingStructure& s, const StructureSolve& solve) {
  const float factor = s.was_rigid ? kRigidRestFactor : 1.0f;
  for (const StructureNode& node : s.nodes) {
    const BodyMotion& motion = solve.motion[node.body];
    if (largest(absolute(motion.linear_velocity)) > factor * node.rest_speed) return false;
    if (largest(absolute(motion.angular_velocity)) > factor * node.rest_spin) return false;
  }
  return true;
}

void halt(const RestingStructure& s, const StructureSolve& solve) {
  for (const StructureNode& node : s.nodes) {
    BodyMotion& motion = solve.motion[node.body];
    motion.linear_velocity = motion.angular_velocity = {};
  }
}

// Makes the contacts of the structure rigid.
void make_rigid(const RestingStructure& s, const StructureSolve& solve) {
  for (const StructureContact& contact : s.contacts) {
    solve.constraints[contact.constraint].manifold->load_age = kRigidContactAge;
    solve.kernels->make_rigid(solve.blocks, int(contact.block), int(contact.lane));
  }
}
// Makes its rigid contacts soft again.
void make_soft(const RestingStructure& s, const StructureSolve& solve) {
  for (const StructureContact& contact : s.contacts) {
    Manifold& manifold = *solve.constraints[contact.constraint].manifold;
    if (manifold.load_age >= kRigidContactAge) manifold.load_age = kReleasedAge;
  }
}

class Solver {
 public:
  Solver(RestingStructure& structure, const StructureSolve& solve) : s_(structure), solve_(solve) {}

  // Finds impulses that stop everything; false if it cannot. Newton's method on the energy of the springs,
  // which is convex: pieces of parabolas that meet where points become inactive.
  bool find() {
    if (!plan()) return false;
    if (!s_.has_scratch) begin();
    if (!touches_all()) return false;
    gather_loads();
    for (double& x : displacement_) x = 0.0;
    const bool is_expensive = plan_.work > kExpensiveWork;
    const double progress = is_expensive ? kProgressIfExpensive : 1.0;
    const int rounds = max_rounds(), max_stuck = is_expensive ? kMaxStuckIfExpensive : kMaxStuck;
    double smallest = kInfinite;
    int stuck = 0;
    bool is_balanced = false;
    for (int round = 0; round < rounds && stuck < max_stuck; ++round) {
      assemble();
      factor_blocks(plan_, values_, room_);
      find_residual();
      solve_blocks(plan_, values_, direction_);
      take_step(find_step());
      limit_friction();
      const double residual = max_residual();
      if (residual <= kExactShare || (is_balanced && residual <= 1.0)) return is_thrust_allowed();
      is_balanced = residual <= 1.0;
      stuck = residual < progress * smallest ? 0 : stuck + 1;
      smallest = min(smallest, residual);
    }
    return is_balanced && is_thrust_allowed();
  }

  void write() const {
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      solve_.kernels->write_impulse(solve_.blocks, int(contact.block), int(contact.lane), s_.work[i].impulse);
    }
  }

 private:
  int max_rounds() const {
    if (s_.is_new && plan_.work > kExpensiveWork) return kMaxRoundsIfNew;
    const std::uint64_t affordable = kMaxWork / (plan_.work + 1);
    return int(min(std::uint64_t(kMaxRounds), max(std::uint64_t(kMinRounds), affordable)));
  }
  bool plan() {
    Arena& arena = *solve_.arena;
    const std::span<std::uint8_t> sizes = arena.make<std::uint8_t>(s_.nodes.size());
    for (std::uint8_t& size : sizes) size = 6;
    const std::span<BlockEdge> edges = arena.make<BlockEdge>(s_.contacts.size());
    std::size_t count = 0;
    for (const StructureContact& contact : s_.contacts) {
      if (contact.is_between()) edges[count++] = {contact.node_a, contact.node_b};
    }
    if (!plan_blocks(sizes, edges.first(count), kMaxStructureWorkPerRow * 6 * sizes.size(), arena, plan_))
      return false;
    for (StructureContact& contact : s_.contacts) {
      if (contact.is_between()) contact.coupling = find_block(plan_, contact.node_a, contact.node_b);
    }
    values_ = arena.make<double>(plan_.values);
    room_ = arena.make<double>(factor_room(plan_));
    loads_ = arena.make<double>(plan_.rows);
    displacement_ = arena.make<double>(plan_.rows);
    direction_ = arena.make<double>(plan_.rows);
    rows_ = arena.make<ContactRows>(s_.contacts.size());
    return true;
  }

  // All points are active, except those that do not touch and never will.
  void begin() {
    s_.has_scratch = true;
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const ContactConstraint& c = constraint(i);
      StructureScratch& work = s_.work[i] = {};
      work.shear = kShear;
      for (int k = 0; k < c.manifold->count; ++k) {
        const bool touches = c.manifold->points[k].separation <= kTouchingGap * c.size;
        if (touches) work.touching = std::uint8_t(work.touching | 1u << k);
      }
    }
  }

  // A body without any touching point falls.
  bool touches_all() {
    for (double& x : direction_) x = 0.0;
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      if (s_.work[i].touching == 0) continue;
      for (const std::uint32_t node : {s_.contacts[i].node_a, s_.contacts[i].node_b}) {
        if (node != kNoNode) rows_at(direction_, node)[0] = 1.0;
      }
    }
    for (std::uint32_t i = 0; i < s_.nodes.size(); ++i) {
      if (rows_at(direction_, i)[0] == 0.0) return false;
    }
    return true;
  }

  const ContactConstraint& constraint(std::uint32_t i) const {
    return solve_.constraints[s_.contacts[i].constraint];
  }
  const BlockColumn& column(std::uint32_t node) const { return plan_.columns[plan_.index_of[node]]; }
  double* rows_at(std::span<double> x, std::uint32_t node) const { return x.data() + column(node).row; }

  // The load of the contacts: their present impulses minus the remaining momentum.
  void gather_loads() {
    for (std::uint32_t i = 0; i < s_.nodes.size(); ++i) {
      const StructureNode& node = s_.nodes[i];
      const BodyMotion& motion = solve_.motion[node.body];
      const Vec3 momentum = node.mass * motion.linear_velocity, spin = node.inertia * motion.angular_velocity;
      double* load = rows_at(loads_, i);
      load[0] = -double(momentum.x), load[1] = -double(momentum.y), load[2] = -double(momentum.z);
      load[3] = -double(spin.x), load[4] = -double(spin.y), load[5] = -double(spin.z);
    }
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      StructureScratch& work = s_.work[i];
      solve_.kernels->read_impulse(solve_.blocks, int(contact.block), int(contact.lane), work.before);
      add_wrench(contact, constraint(i), work.before, 1.0, loads_);
      // A contact without load begins with all its points.
      std::uint8_t was_loaded = 0;
      for (int k = 0; k < kMaxManifoldPoints; ++k) {
        if ((work.touching >> k & 1) == 0) work.before.normal[k] = 0.0f;
        if (work.before.normal[k] > 0.0f) was_loaded = std::uint8_t(was_loaded | 1u << k);
      }
      work.loaded = was_loaded != 0 ? was_loaded : work.touching;
      work.impulse = work.before;
      prepare_rows(constraint(i), work, rows_[i]);
    }
  }

  // Adds the effect of the impulses on both bodies.
  void add_wrench(const StructureContact& contact, const ContactConstraint& c, const ContactImpulse& impulse,
                  double factor, std::span<double> x) const {
    const Manifold& manifold = *c.manifold;
    const auto add = [&](Vec3 direction, Vec3 from_a, Vec3 from_b, float value) {
      const ContactRow row = make_row(direction, from_a, from_b, 1.0, 0.0f);
      const double amount = factor * double(value);
      if (contact.node_a != kNoNode) {
        for (int j = 0; j < 6; ++j) rows_at(x, contact.node_a)[j] += amount * row.a[j];
      }
      if (contact.node_b != kNoNode) {
        for (int j = 0; j < 6; ++j) rows_at(x, contact.node_b)[j] += amount * row.b[j];
      }
    };
    for (int k = 0; k < manifold.count; ++k) {
      add(manifold.normal, manifold.points[k].from_a, manifold.points[k].from_b, impulse.normal[k]);
    }
    const Vec3 from_b = impulse.friction_from_b;
    add(impulse.friction, from_b + (manifold.points[0].from_a - manifold.points[0].from_b), from_b, 1.0f);
    const Vec3 torsion = impulse.twist * manifold.normal + impulse.rolling;
    const double torsions[3] = {factor * double(torsion.x), factor * double(torsion.y),
                                factor * double(torsion.z)};
    for (int j = 0; j < 3; ++j) {
      if (contact.node_a != kNoNode) rows_at(x, contact.node_a)[3 + j] -= torsions[j];
      if (contact.node_b != kNoNode) rows_at(x, contact.node_b)[3 + j] += torsions[j];
    }
  }

  // The second derivative of the energy. Inactive points keep a trace of stiffness, so that free bodies have
  // one.
  void assemble() {
    for (double& value : values_) value = 0.0;
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      const StructureScratch& work = s_.work[i];
      const ContactRows& rows = rows_[i];
      for (int k = 0; k < constraint(i).manifold->count; ++k) {
        if ((work.touching >> k & 1) == 0) continue;
        add_row(contact, rows.normal[k], (work.loaded >> k & 1) != 0 ? 1.0 : kInactiveStiffness);
      }
      if (!rows.rubs) continue;
      for (const ContactRow* row : {&rows.tangent[0], &rows.tangent[1], &rows.twist})
        add_row(contact, *row, row->stiffness);
    }
  }
  void add_row(const StructureContact& contact, const ContactRow& row, double stiffness) {
    double* values = values_.data();
    if (contact.node_a != kNoNode)
      add_outer_six(values + column(contact.node_a).diagonal, row.a, row.a, stiffness);
    if (contact.node_b != kNoNode)
      add_outer_six(values + column(contact.node_b).diagonal, row.b, row.b, stiffness);
    if (!contact.is_between()) return;
    const bool a_first = contact.coupling.first_is_row;
    add_outer_six(values + contact.coupling.offset, a_first ? row.a : row.b, a_first ? row.b : row.a, stiffness);
  }

  // Compression of the row by the displacements `x` of the bodies.
  double row_displacement(const StructureContact& contact, const ContactRow& row, std::span<double> x) const {
    double sum = 0.0;
    if (contact.node_a != kNoNode) {
      const double* moves = rows_at(x, contact.node_a);
      for (int j = 0; j < 6; ++j) sum += row.a[j] * moves[j];
    }
    if (contact.node_b != kNoNode) {
      const double* moves = rows_at(x, contact.node_b);
      for (int j = 0; j < 6; ++j) sum += row.b[j] * moves[j];
    }
    return sum;
  }
  // The impulse of the row at the present displacement.
  double row_impulse(const StructureContact& contact, const ContactRow& row) const {
    return row.before + row.stiffness * row_displacement(contact, row, displacement_);
  }
  void add_to(std::span<double> x, const StructureContact& contact, const ContactRow& row,
              double amount) const {
    if (contact.node_a != kNoNode) {
      for (int j = 0; j < 6; ++j) rows_at(x, contact.node_a)[j] += amount * row.a[j];
    }
    if (contact.node_b != kNoNode) {
      for (int j = 0; j < 6; ++j) rows_at(x, contact.node_b)[j] += amount * row.b[j];
    }
  }

  // The residual load.
  void find_residual() {
    std::copy(loads_.begin(), loads_.end(), direction_.begin());
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      const StructureScratch& work = s_.work[i];
      const ContactRows& rows = rows_[i];
      for (int k = 0; k < constraint(i).manifold->count; ++k) {
        if ((work.touching >> k & 1) == 0) continue;
        add_to(direction_, contact, rows.normal[k], -max(row_impulse(contact, rows.normal[k]), 0.0));
      }
      if (!rows.rubs) continue;
      for (const ContactRow* row : {&rows.tangent[0], &rows.tangent[1], &rows.twist}) {
        add_to(direction_, contact, *row, -row_impulse(contact, *row));
      }
    }
  }

  // The step along `direction_` to the minimum of the energy, whose derivative grows in straight pieces.
  double find_step() {
    slope_ = curve_ = 0.0;
    for (std::size_t j = 0; j < direction_.size(); ++j) slope_ -= loads_[j] * direction_[j];
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      StructureScratch& work = s_.work[i];
      const ContactRows& rows = rows_[i];
      for (int k = 0; k < constraint(i).manifold->count; ++k) {
        work.at[k] = work.rate[k] = 0.0;
        if ((work.touching >> k & 1) == 0) continue;
        work.at[k] = row_impulse(contact, rows.normal[k]);
        work.rate[k] = row_displacement(contact, rows.normal[k], direction_);
      }
      if (!rows.rubs) continue;
      for (const ContactRow* row : {&rows.tangent[0], &rows.tangent[1], &rows.twist}) {
        const double rate = row_displacement(contact, *row, direction_);
        slope_ += row_impulse(contact, *row) * rate;
        curve_ += row->stiffness * rate * rate;
      }
    }
    const double start = absolute(slope_at(0.0).value);
    double low = 0.0, high = 1.0;
    Slope here = slope_at(high);
    if (absolute(here.value) <= kFlatSlope * start) return high;
    while (here.value < 0.0 && high < kLongestStep) {
      low = high, high *= 2.0;
      here = slope_at(high);
    }
    // Newton's method ends as soon as it meets the right piece; outside the bracket it bisects.
    double t = high;
    for (int cut = 0; cut < kMaxBisections && low < high && absolute(here.value) > kRoundingSlope * start;
         ++cut) {
      (here.value < 0.0 ? low : high) = t;
      const double next = t - here.value / here.growth;
      t = next > low && next < high ? next : 0.5 * (low + high);
      here = slope_at(t);
    }
    return t;
  }
  // The derivative of the energy along the direction, and its growth.
  struct Slope {
    double value, growth;
  };
  Slope slope_at(double t) const {
    Slope slope{slope_ + t * curve_, curve_};
    for (const StructureScratch& work : s_.work) {
      for (int k = 0; k < kMaxManifoldPoints; ++k) {
        const double press = work.at[k] + t * work.rate[k];
        slope.value += press > 0.0 ? press * work.rate[k] : 0.0;
        slope.growth += press > 0.0 ? square(work.rate[k]) : 0.0;
      }
    }
    return slope;
  }

  void take_step(double t) {
    for (std::size_t j = 0; j < displacement_.size(); ++j) displacement_[j] += t * direction_[j];
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      StructureScratch& work = s_.work[i];
      work.loaded = 0;
      for (int k = 0; k < kMaxManifoldPoints; ++k) {
        const double press = work.at[k] + t * work.rate[k];
        if (press > 0.0) work.loaded = std::uint8_t(work.loaded | 1u << k);
        work.impulse.normal[k] = float(max(press, 0.0));
      }
    }
  }

  // Clamps friction and twist of all contacts to their limits, and softens those beyond.
  void limit_friction() {
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      const StructureContact& contact = s_.contacts[i];
      const ContactConstraint& c = constraint(i);
      StructureScratch& work = s_.work[i];
      ContactRows& rows = rows_[i];
      ContactImpulse& impulse = work.impulse;
      impulse.friction = impulse.rolling = {};
      impulse.twist = 0.0f;
      double load = 0.0;
      for (const float normal : impulse.normal) load += double(normal);
      if (!rows.rubs || !(load > 0.0)) continue;
      const double u = row_impulse(contact, rows.tangent[0]), v = row_impulse(contact, rows.tangent[1]);
      const double twist = row_impulse(contact, rows.twist);
      const double limit = double(impulse.twist_per_normal) * load;
      const double slide = std::sqrt(u * u + v * v) / (double(c.static_friction) * load);
      const double twist_use = limit > 0.0 ? twist / limit : 0.0;
      const double use = std::sqrt(slide * slide + twist_use * twist_use);
      const double share = use > 1.0 ? 1.0 / use : 1.0;
      impulse.friction = float(share * u) * rows.u + float(share * v) * rows.v;
      impulse.twist = float(share * twist);
      if (use <= 1.0) continue;
      const float rest = float(max(kFrictionAim / use, kMaxSoftening));
      work.shear = max(work.shear * rest, kMinShear);
      work.before.friction *= rest;
      work.before.twist *= rest;
      prepare_friction_rows(c, work, rows);
    }
  }

  // The largest residual of a body over its tolerance: a body that could still move has no load for it.
  double max_residual() {
    std::copy(loads_.begin(), loads_.end(), direction_.begin());
    for (std::uint32_t i = 0; i < s_.contacts.size(); ++i) {
      add_wrench(s_.contacts[i], constraint(i), s_.work[i].impulse, -1.0, direction_);
    }
    double largest = 0.0;
    for (std::uint32_t i = 0; i < s_.nodes.size(); ++i) {
      const StructureNode& node = s_.nodes[i];
      const double* rest = rows_at(direction_, i);
      const double speed = length_of(rest) / double(node.mass);
      const double spin =
          length_of(rest + 3) / double(min(node.inertia.xx, min(node.inertia.yy, node.inertia.zz)));
      const double left = max(speed / double(node.rest_speed), spin / double(node.rest_spin)) / kResidual;
      if (!(speed + spin < kInfinite)) return kInfinite;  // not a number
      largest = max(largest, left);
    }
    return largest;
  }
  bool is_thrust_allowed() const {
    double weight = 0.0, largest = 0.0;
    for (std::uint32_t i = 0; i < s_.nodes.size(); ++i) weight += length_of(rows_at(loads_, i));
    for (const StructureScratch& work : s_.work)
      for (const float normal : work.impulse.normal) largest = max(largest, double(normal));
    return largest <= kMaxThrust * weight;
  }
  static double length_of(const double* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

  RestingStructure& s_;
  const StructureSolve& solve_;
  BlockPlan plan_;
  double slope_ = 0.0, curve_ = 0.0;  // of the energy along the direction, without points
  std::span<double> values_, room_, loads_, displacement_, direction_;
  std::span<ContactRows> rows_;  // by contact
};

// Stops the structure; false if its contacts cannot.
bool bring_to_rest(RestingStructure& structure, const StructureSolve& solve) {
  if (!is_at_rest(structure, solve)) {
    const ArenaScope scope(*solve.arena);
    Solver solver(structure, solve);
    if (!solver.find()) return false;
    solver.write();
  }
  halt(structure, solve);
  return true;
}

}  // namespace

void solve_structure_first(RestingStructure& structure, const StructureSolve& solve) {
  if (structure.is_settling) return;
  structure.is_solved = bring_to_rest(structure, solve);
  structure.is_solved ? make_rigid(structure, solve) : make_soft(structure, solve);
}

void solve_structure_last(RestingStructure& structure, const StructureSolve& solve) {
  if (structure.is_solved) {
    bring_to_rest(structure, solve);
  } else if (structure.is_settling) {
    bring_to_rest(structure, solve) ? make_rigid(structure, solve) : make_soft(structure, solve);
  }
}

}  // namespace gyre
