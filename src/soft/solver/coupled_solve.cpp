#include "soft/solver/coupled_solve.h"

#include "soft/solver/body_system.h"
#include "soft/solver/rigid_correction.h"
#include "soft/solver/rigid_modes.h"

#include <cmath>
#include <cstring>

namespace gyre {

namespace {

// A line search ends where the slope is this share of the first one, or after so many steps.
constexpr double kSlopeLeft = 0.05;
constexpr int kSearchSteps = 16;

VectorRows from(const VectorRows& rows, std::size_t first) {
  return {rows.x + first, rows.y + first, rows.z + first};
}
Vec3 at(const VectorRows& rows, std::size_t i) { return {rows.x[i], rows.y[i], rows.z[i]}; }
void set(const VectorRows& rows, std::size_t i, Vec3 value) {
  rows.x[i] = value.x, rows.y[i] = value.y, rows.z[i] = value.z;
}

// A row in a solve.
struct RowState {
  std::uint32_t at[5] = {};  // its vertices, in the list of those that rows touch
  float weight[5] = {};
  int vertices = 0;
  Vec3 normal{};
  float target = 0.0f, along = 0.0f, across = 0.0f;
  // Of the stage: its impulse when it began, and the bound of friction.
  float last_normal = 0.0f, bound = 0.0f;
  Vec3 last_friction{};
  // Now.
  Vec3 velocity{};    // m/s, relative
  float push = 0.0f;  // N s: along the normal
  Vec3 friction{};
  bool sticks = false;

  // The push at a speed along the normal, before it is kept from pulling.
  float push_at(float speed) const { return last_normal + along * (target - speed); }
  // K of a row that pushes.
  Sym3 inertia() const {
    const float c = sticks ? across : 0.0f, a = along - c;
    return {c + a * normal.x * normal.x, c + a * normal.y * normal.y, c + a * normal.z * normal.z,
            a * normal.x * normal.y,     a * normal.x * normal.z,     a * normal.y * normal.z};
  }
};

// How the work of a row's impulse on a direction depends on the share that is gone along it.
struct RowSlope {
  double push = 0.0, push_rate = 0.0;          // N s, before it is kept from pulling
  double speed = 0.0;                          // m/s: of the direction along the normal
  double size = 0.0, mixed = 0.0, rate = 0.0;  // of friction f + share g, before its bound: f.f, f.g, g.g
  double work = 0.0, work_rate = 0.0;          // f.w, g.w, with w the direction across the normal
  double bound = 0.0;

  double at(double share) const {
    const double normal = push + share * push_rate;
    if (!(normal > 0.0)) return 0.0;
    const double square = size + share * (2.0 * mixed + share * rate);
    const double kept = square > bound * bound ? bound / std::sqrt(square) : 1.0;
    return normal * speed + kept * (work + share * work_rate);
  }
};

class CoupledSolve {
 public:
  CoupledSolve(std::span<const CoupledBody> bodies, std::span<CouplingRow> rows,
               const CoupledVertices& vertices, const SoftKernels& kernels, Arena& arena, TaskSystem& tasks)
      : bodies_(bodies), rows_(rows), vertices_(vertices), kernels_(kernels), tasks_(tasks) {
    // Each body begins a slice of rows.
    begins_ = arena.make<std::size_t>(bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      begins_[b] = count_;
      count_ += std::size_t(padded_rows(bodies[b].body->particles.count));
    }
    direction_ = make_vectors(arena, count_), product_ = make_vectors(arena, count_);
    residual_ = make_vectors(arena, count_), last_ = make_vectors(arena, count_);
    change_ = make_vectors(arena, count_);
    for (float*& part : inverse_) part = arena.make<float>(count_).data();
    for (std::size_t i = 0; i < count_; ++i) {
      set(residual_, i, {}), set(change_, i, {});
      set_inverse(i, {});
    }
    passes_ = arena.make<SoftPass>(bodies.size());
    const std::span<std::uint32_t> row_of = arena.make<std::uint32_t>(vertices.blocks.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const CoupledBody& one = bodies[b];
      const std::size_t begin = begins_[b];
      SoftPass& pass = passes_[b];
      pass = one.step != nullptr ? one.step->pass : SoftPass{};
      pass.slices = padded_rows(one.body->particles.count) / kSliceRows;
      pass.mass = one.body->particles.mass.data();
      for (int k = 0; k < 6; ++k) pass.inverse[k] = inverse_[k] + begin;
      pass.change = from(change_, begin), pass.residual = from(residual_, begin);
      pass.direction = from(direction_, begin), pass.product = from(product_, begin);
      for (std::size_t i = 0; i < std::size_t(one.body->particles.count); ++i) {
        const std::size_t v = one.first + i;
        row_of[v] = std::uint32_t(begin + i);
        set_inverse(begin + i, vertices.blocks[v]);
        set(residual_, begin + i, vertices.impulses[v]);
      }
    }
    make_corrections(arena);
    read_rows(row_of, arena);
  }

  // Minimises with the rows' present impulses. Returns the number of iterations.
  int minimize(int iterations, double tolerance) {
    double first = 0.0, before = 0.0;
    for (int n = 0; n < iterations; ++n) {
      update_impulses();
      if (n == 0) set_inverses();
      const double error = precondition();
      if (n == 0) first = error;
      if (!(error > 0.0) || (n > 0 && error <= tolerance * first && is_still())) return n;
      // Polak's and Ribiere's share of the last direction, never negative.
      const double turn = n == 0 ? 0.0 : max(0.0, (error - match(product_, last_)) / before);
      before = error;
      if (n == 0) clear_direction();
      for_each_body([&](BodySystem& system) { system.turn(float(turn)); });
      copy(residual_, last_);
      const double slope = match(direction_, residual_);
      double curvature = 0.0;
      for_each_body([&](BodySystem& system) { curvature += system.apply(); });
      const float share = float(best_share(slope, curvature));
      if (!(share > 0.0f)) return n;
      for_each_body([&](BodySystem& system) { system.advance(share); });
      for (RowState& state : states_) state.velocity += share * way_of(state);
    }
    update_impulses();
    return iterations;
  }

  // The rows' impulses become those of the next stage. True if no row misses its target by too much.
  bool end_stage() {
    bool met = true;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const RowState& state = states_[r];
      CouplingRow& row = rows_[r];
      row.slides = state.push > 0.0f && !state.sticks;
      row.impulse = state.push * row.normal + state.friction;
      met = met && (!row.adds_up || row.target - dot(row.normal, state.velocity) <= row.allowed);
      begin_stage(r);
    }
    return met;
  }

  void finish(Arena& arena) {
    for (const CouplingRow& row : rows_) add_to_vertices(row, row.impulse);
    const VectorRows given = make_vectors(arena, count_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const CoupledBody& one = bodies_[b];
      const std::size_t count = std::size_t(one.body->particles.count);
      if (one.step != nullptr && one.body->held.empty()) {
        for (std::size_t i = 0; i < count; ++i) set(given, i, vertices_.impulses[one.first + i]);
        if (one.step->carried.empty())
          keep_momentum(*one.body, given, passes_[b].change);
        else
          keep_linear_momentum(one.body->particles, one.step->carried, given, passes_[b].change);
      }
      for (std::size_t i = 0; i < count; ++i) vertices_.change[one.first + i] = at(passes_[b].change, i);
    }
  }

 private:
  template <class Fn>
  void for_each_body(Fn&& fn) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      BodySystem system(
          passes_[b],
          bodies_[b].step != nullptr ? bodies_[b].step->carried : std::span<const CarriedInertia>(), kernels_,
          tasks_);
      fn(system);
    }
  }
  void copy(const VectorRows& source, const VectorRows& to) const {
    const std::size_t bytes = count_ * sizeof(float);
    std::memcpy(to.x, source.x, bytes), std::memcpy(to.y, source.y, bytes),
        std::memcpy(to.z, source.z, bytes);
  }
  void clear_direction() {
    for (std::size_t i = 0; i < count_; ++i) set(direction_, i, {});
  }
  void set_inverse(std::size_t v, const Sym3& block) {
    const float parts[6] = {block.xx, block.yy, block.zz, block.xy, block.xz, block.yz};
    for (int k = 0; k < 6; ++k) inverse_[k][v] = parts[k];
  }

  void add_to_vertices(const CouplingRow& row, Vec3 impulse) const {
    for (int k = 0; k < 5; ++k) vertices_.impulses[row.vertex[k]] += row.weight[k] * impulse;
  }

  void begin_stage(std::size_t r) {
    const CouplingRow& row = rows_[r];
    RowState& state = states_[r];
    state.last_normal = row.adds_up ? dot(row.normal, row.impulse) : 0.0f;
    state.last_friction = row.adds_up ? row.impulse - state.last_normal * row.normal : Vec3{};
    state.bound = row.friction[row.slides ? 1 : 0] * max(state.last_normal, 0.0f);
  }

  // The states of rows, and the vertices that they touch, each once, with its own block of A.
  void read_rows(std::span<const std::uint32_t> row_of, Arena& arena) {
    states_ = arena.make<RowState>(rows_.size()), slopes_ = arena.make<RowSlope>(rows_.size());
    touched_ = arena.make<std::uint32_t>(5 * rows_.size());
    constexpr std::uint32_t kNone = 0xffffffffu;
    const std::span<std::uint32_t> listed = arena.make<std::uint32_t>(count_);
    for (std::uint32_t& one : listed) one = kNone;
    std::uint32_t used = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const CouplingRow& row = rows_[r];
      RowState& state = states_[r];
      state = {};
      for (int k = 0; k < 5; ++k) {
        const std::uint32_t v = row.vertex[k], i = row_of[v];
        if (row.weight[k] == 0.0f) continue;
        state.velocity += row.weight[k] * vertices_.velocities[v];
        if (!(vertices_.blocks[v].xx > 0.0f)) continue;  // it is held
        if (listed[i] == kNone) touched_[used] = i, listed[i] = used++;
        state.at[state.vertices] = listed[i], state.weight[state.vertices++] = row.weight[k];
      }
      state.normal = row.normal, state.target = row.target;
      if (row.adds_up) allowed_ = min(allowed_, row.allowed);
      state.along = row.along, state.across = row.across;
      begin_stage(r);
      state.push = state.last_normal, state.friction = state.last_friction;
      add_to_vertices(row, -row.impulse);
    }
    touched_ = touched_.first(used);
    own_ = arena.make<Sym3>(used), with_rows_ = arena.make<Sym3>(used), values_ = arena.make<Vec3>(used);
    for (std::size_t t = 0; t < used; ++t) {
      const std::uint32_t i = touched_[t];
      own_[t] = inverse(Sym3{inverse_[0][i], inverse_[1][i], inverse_[2][i], inverse_[3][i], inverse_[4][i],
                             inverse_[5][i]});
    }
  }

  // The impulses of the rows at the present velocities, in the residual.
  void update_impulses() {
    for (Vec3& value : values_) value = {};
    for (RowState& state : states_) {
      const float speed = dot(state.normal, state.velocity), push = max(state.push_at(speed), 0.0f);
      if (push == 0.0f && state.push == 0.0f) continue;
      Vec3 friction{};
      if (push > 0.0f) {
        friction = state.last_friction - state.across * (state.velocity - speed * state.normal);
        const float square = dot(friction, friction);
        state.sticks = square <= state.bound * state.bound;
        if (!state.sticks) friction = (state.bound / std::sqrt(square)) * friction;
      }
      const Vec3 change = (push - state.push) * state.normal + (friction - state.friction);
      for (int k = 0; k < state.vertices; ++k) values_[state.at[k]] += state.weight[k] * change;
      state.push = push, state.friction = friction;
    }
    for (std::size_t t = 0; t < touched_.size(); ++t)
      set(residual_, touched_[t], at(residual_, touched_[t]) + values_[t]);
  }
  // The preconditioner, with what resists now.
  void set_inverses() {
    for (std::size_t t = 0; t < touched_.size(); ++t) with_rows_[t] = own_[t];
    for (const RowState& state : states_) {
      if (!(state.push > 0.0f)) continue;
      const Sym3 block = state.inertia();
      for (int k = 0; k < state.vertices; ++k) {
        Sym3& sum = with_rows_[state.at[k]];
        sum = sum + (state.weight[k] * state.weight[k]) * block;
      }
    }
    for (std::size_t t = 0; t < touched_.size(); ++t) set_inverse(touched_[t], inverse(with_rows_[t]));
    set_corrections();
  }

  // A rigid correction for each piece of the bodies that nothing holds.
  void make_corrections(Arena& arena) {
    first_piece_ = arena.make<std::size_t>(bodies_.size());
    std::size_t pieces = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      first_piece_[b] = pieces;
      pieces += std::size_t(bodies_[b].body->pieces());
    }
    corrections_ = arena.make<RigidCorrection>(pieces);
    for (RigidCorrection& one : corrections_) one = {};
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const ImplicitStep* const step = bodies_[b].step;
      if (step == nullptr || !bodies_[b].body->held.empty()) continue;
      const Particles& p = bodies_[b].body->particles;
      for (int i = 0; i < p.count; ++i) correction_of(b, i).add_mass(double(p.mass[i]), p.place(i));
      for (int piece = 0; piece < bodies_[b].body->pieces(); ++piece)
        corrections_[first_piece_[b] + std::size_t(piece)].set_center();
      for (int i = 0; i < p.count; ++i) correction_of(b, i).add_inertia(double(p.mass[i]), p.place(i));
      for (const CarriedInertia& one : step->carried)
        correction_of(b, one.particle).add_carried(one.inertia, p.place(one.particle));
    }
  }
  RigidCorrection& correction_of(std::size_t body, int particle) {
    return corrections_[first_piece_[body] + bodies_[body].body->piece_of(particle)];
  }
  // With the rows that push now.
  void set_corrections() {
    for (RigidCorrection& one : corrections_) one.clear_rows();
    for (const RowState& state : states_) {
      if (state.push > 0.0f) add_to_corrections(state);
    }
    for (RigidCorrection& one : corrections_) one.factor();
  }
  void add_to_corrections(const RowState& state) {
    RigidCorrection* of[5] = {};
    DVec3 arm[5];
    for (int k = 0; k < state.vertices; ++k) {
      const std::size_t i = touched_[state.at[k]];
      std::size_t b = 0;
      while (b + 1 < bodies_.size() && begins_[b + 1] <= i) ++b;
      const int particle = int(i - begins_[b]);
      of[k] = &correction_of(b, particle);
      arm[k] = of[k]->arm_of(bodies_[b].body->particles.place(particle));
    }
    for (int first = 0; first < state.vertices; ++first) {
      bool is_first = of[first]->is_on();
      for (int k = 0; k < first; ++k) is_first = is_first && of[k] != of[first];
      if (!is_first) continue;
      double share = 0.0;
      DVec3 sum{};
      for (int k = first; k < state.vertices; ++k) {
        if (of[k] != of[first]) continue;
        share += double(state.weight[k]);
        sum += double(state.weight[k]) * arm[k];
      }
      of[first]->add_row(state.inertia(), share, sum);
    }
  }
  // Adds the answers of rigid motions to the preconditioned residual; the residual times them.
  double correct(std::size_t b) {
    const Particles& p = bodies_[b].body->particles;
    if (!correction_of(b, 0).is_on()) return 0.0;
    const std::size_t begin = first_piece_[b], pieces = std::size_t(bodies_[b].body->pieces());
    for (RigidCorrection& one : corrections_.subspan(begin, pieces)) one.clear_residual();
    for (int i = 0; i < p.count; ++i)
      correction_of(b, i).add_residual(DVec3(at(passes_[b].residual, std::size_t(i))), p.place(i));
    double work = 0.0;
    for (RigidCorrection& one : corrections_.subspan(begin, pieces)) work += one.solve();
    const VectorRows& out = passes_[b].product;
    for (int i = 0; i < p.count; ++i) {
      const std::size_t k = std::size_t(i);
      set(out, k, to_float(DVec3(at(out, k)) + correction_of(b, i).motion_at(p.place(i))));
    }
    return work;
  }

  // The preconditioned residual, in `product`; the residual times it.
  double precondition() {
    double error = 0.0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      SoftPass pass = passes_[b];
      pass.direction = pass.product;
      error += BodySystem(pass, {}, kernels_, tasks_).sum(kernels_.precondition);
      error += correct(b);
    }
    return error;
  }
  // True if no vertex would change its velocity by more than rows allow, by the preconditioned residual.
  bool is_still() const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 z = at(product_, i);
      if (dot(z, z) > allowed_ * allowed_) return false;
    }
    return true;
  }
  double match(const VectorRows& a, const VectorRows& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      SoftPass pass = passes_[i];
      pass.direction = from(a, begins_[i]), pass.residual = from(b, begins_[i]);
      sum += BodySystem(pass, {}, kernels_, tasks_).sum(kernels_.match);
    }
    return sum;
  }

  // How the rows' velocities change along the direction.
  Vec3 way_of(const RowState& state) const {
    Vec3 sum{};
    for (int k = 0; k < state.vertices; ++k) sum += state.weight[k] * values_[state.at[k]];
    return sum;
  }
  // Sets the slopes of the rows. Returns what those that push now resist of the direction.
  double find_slopes() {
    for (std::size_t t = 0; t < touched_.size(); ++t) values_[t] = at(direction_, touched_[t]);
    double resistance = 0.0;
    for (std::size_t r = 0; r < states_.size(); ++r) {
      const RowState& state = states_[r];
      const Vec3 way = way_of(state);
      const float speed = dot(state.normal, way), now = dot(state.normal, state.velocity);
      const Vec3 across = way - speed * state.normal;
      const Vec3 f = state.last_friction - state.across * (state.velocity - now * state.normal),
                 g = -state.across * across;
      RowSlope& slope = slopes_[r];
      slope.push = double(state.push_at(now)), slope.push_rate = -double(state.along) * double(speed);
      slope.speed = double(speed);
      slope.size = double(dot(f, f)), slope.mixed = double(dot(f, g)), slope.rate = double(dot(g, g));
      slope.work = double(dot(f, across)), slope.work_rate = double(dot(g, across));
      slope.bound = double(state.bound);
      if (state.push > 0.0f)
        resistance -= slope.push_rate * slope.speed + (state.sticks ? slope.work_rate : 0.0);
    }
    return resistance;
  }

  // Where along the direction the slope is zero.
  double best_share(double slope, double curvature) {
    const double resistance = find_slopes();
    if (!(slope > 0.0) || !(curvature + resistance > 0.0)) return 0.0;
    double start = 0.0;
    for (const RowSlope& one : slopes_) start += one.at(0.0);
    // The work of the residual along the way that is left at a share.
    const auto left_at = [&](double share) {
      double sum = 0.0;
      for (const RowSlope& one : slopes_) sum += one.at(share);
      return slope - share * curvature + (sum - start);
    };
    const double enough = kSlopeLeft * slope;
    double low = 0.0, at_low = slope, high = slope / (curvature + resistance), at_high = left_at(high);
    int steps = 0;
    for (; at_high > enough && steps < kSearchSteps; ++steps) {
      low = high, at_low = at_high;
      high *= 2.0, at_high = left_at(high);
    }
    // The secant, and the middle at every third step.
    for (; at_high < -enough && steps < kSearchSteps; ++steps) {
      const double share =
          steps % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * (at_low / (at_low - at_high));
      const double left = left_at(share);
      if (absolute(left) <= enough) return share;
      (left > 0.0 ? low : high) = share;
      (left > 0.0 ? at_low : at_high) = left;
    }
    return absolute(at_high) <= enough ? high : low;
  }

  std::span<const CoupledBody> bodies_;
  std::span<CouplingRow> rows_;
  const CoupledVertices& vertices_;
  const SoftKernels& kernels_;
  TaskSystem& tasks_;
  std::span<SoftPass> passes_;
  std::span<std::size_t> first_piece_;  // by body, in the corrections
  std::span<RigidCorrection> corrections_;
  std::span<std::size_t> begins_;  // by body: its first row in the vectors below
  std::size_t count_ = 0;
  float allowed_ = 1.0e30f;  // m/s: the least that rows allow
  VectorRows change_, residual_, direction_, product_, last_;
  float* inverse_[6] = {};
  std::span<std::uint32_t> touched_;  // vertices that rows touch, as rows of the vectors above
  std::span<Sym3> own_, with_rows_;   // kg, by touched vertex
  std::span<Vec3> values_;            // by touched vertex: impulses, or the direction
  std::span<RowState> states_;
  std::span<RowSlope> slopes_;
};

}  // namespace

CoupledReport solve_coupled(std::span<const CoupledBody> bodies, std::span<CouplingRow> rows,
                            const CoupledVertices& vertices, const CoupledSettings& settings,
                            const SoftKernels& kernels, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  CoupledSolve solve(bodies, rows, vertices, kernels, arena, tasks);
  CoupledReport report;
  report.met = false;
  while (report.stages < settings.most_stages && !report.met) {
    report.iterations += solve.minimize(settings.most_iterations, settings.tolerance);
    ++report.stages;
    report.met = solve.end_stage() && report.stages >= settings.least_stages;
  }
  solve.finish(arena);
  return report;
}

}  // namespace gyre
