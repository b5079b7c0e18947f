#include "soft/solver/coupled_solve.h"

#include "soft/solver/body_system.h"
#include "soft/solver/coupled_groups.h"
#include "soft/solver/coupled_row.h"
#include "soft/solver/rigid_correction.h"
#include "soft/solver/rigid_modes.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace gyre {

namespace {

// Rows resist by so many times what their points do.
constexpr float kResistance = 2.0f;
// If so large a share of what the rows of a group miss is left at the end of the next stage, it will not fall further.
constexpr double kHopeless = 0.7;
// A row that misses its target resists by so many times more in the next stage, where no rigid body yields. One that does may bear what the solve does not know, and would be thrown.
constexpr float kStiffening = 4.0f;
constexpr float kUnbounded = std::numeric_limits<float>::infinity();

VectorRows from(const VectorRows& rows, std::size_t first) {
  return {rows.x + first, rows.y + first, rows.z + first};
}
Vec3 at(const VectorRows& rows, std::size_t i) { return {rows.x[i], rows.y[i], rows.z[i]}; }
void set(const VectorRows& rows, std::size_t i, Vec3 value) {
  rows.x[i] = value.x, rows.y[i] = value.y, rows.z[i] = value.z;
}

class CoupledSolve {
 public:
  CoupledSolve(std::span<const CoupledBody> bodies, std::span<const RigidInertia> rigid,
               std::span<CouplingRow> rows, const CoupledVertices& vertices, const SoftKernels& kernels,
               const CoupledSettings& settings, Arena& arena, TaskSystem& tasks)
      : bodies_(bodies),
        rows_(rows),
        vertices_(vertices),
        kernels_(kernels),
        tasks_(tasks),
        rest_speed_(settings.rest_speed) {
    rigid_ = arena.make<CoupledRigid>(rigid.size());
    for (std::size_t i = 0; i < rigid.size(); ++i) {
      rigid_[i] = {};
      rigid_[i].set(rigid[i]);
    }
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
    for (RigidCorrection& one : corrections_) one.factor_own();
    read_rows(row_of, arena);
    groups_ = arena.make<CoupledGroup>(bodies_.size() + rigid_.size());
    group_of_ = arena.make<std::uint32_t>(states_.size());
    find_groups(
        states_, bodies_.size(), [&](std::uint32_t at) { return body_of(touched_[at]); }, arena, groups_,
        group_of_);
  }

  // Minimises with the rows' present impulses. Returns the number of iterations.
  int minimize(int iterations, double tolerance) {
    double before = 0.0;
    const double wanted = tolerance * stake_;
    for (int n = 0; n < iterations; ++n) {
      update_impulses();
      if (n == 0) set_inverses();
      const double error = precondition();
      if (!(error > 0.0) || (error <= wanted && unbalanced_ <= wanted && is_still())) return n;
      // Polak's and Ribiere's share of the last direction, never negative.
      const double turn = n == 0 ? 0.0 : max(0.0, (error - match_last()) / before);
      before = error;
      if (n == 0) clear_direction();
      for_each_body([&](BodySystem& system) { system.turn(float(turn)); });
      for (CoupledRigid& one : rigid_) one.direction = one.answer + turn * one.direction;
      copy(residual_, last_);
      double slope = match(direction_, residual_), curvature = 0.0;
      for_each_body([&](BodySystem& system) { curvature += system.apply(); });
      for (CoupledRigid& one : rigid_) {
        one.last = one.residual;
        slope += dot(one.direction, one.residual);
        curvature += one.apply();
      }
      const float share = float(best_share(slope, curvature));
      if (!(share > 0.0f)) return n;
      for_each_body([&](BodySystem& system) { system.advance(share); });
      for (CoupledRigid& one : rigid_) one.residual = one.residual + double(-share) * one.product;
      for (CoupledRow& state : states_) state.velocity += share * way_of(state);
    }
    update_impulses();
    return iterations;
  }

  // The rows' impulses become those of the next stage. True if no row misses its target by too much.
  bool end_stage() {
    bool met = true;
    for (CoupledGroup& group : groups_) group.missed = 0.0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const CoupledRow& state = states_[r];
      CouplingRow& row = rows_[r];
      const float speed = dot(state.normal, state.velocity);
      const Vec3 across = state.velocity - speed * state.normal;
      row.slides = state.acts() && !state.sticks && dot(across, across) > row.slow * row.slow;
      row.impulse = state.push * row.normal + state.friction;
      // m/s: by how much it misses its target, and by how much it closes beyond that.
      const float missed = row.holds ? length(state.velocity) : row.target - speed;
      const float closing = row.holds ? missed : min(row.target, 0.0f) - speed;
      row.is_missed = row.damper == 0.0f && missed > row.allowed;
      row.is_closing = row.is_missed && closing > row.allowed;
      CoupledGroup& group = groups_[group_of_[r]];
      met = met && (!row.is_closing || group.is_settled);
      begin_stage(r);
      if (!row.is_closing || group.is_settled) continue;
      if (!group.yields) states_[r].along *= kStiffening;
      if (!group.yields && row.holds) states_[r].across *= kStiffening;
      group.missed += double(closing);
    }
    for (std::uint32_t g = 0; g < std::uint32_t(groups_.size()); ++g) {
      CoupledGroup& group = groups_[g];
      if (group.missed > kHopeless * group.missed_before && group.missed_before > 0.0) {
        group.is_settled = true;
        if (!group.yields) give_in(g);
      }
      group.missed_before = group.missed;
    }
    return met;
  }
  bool has_given_in() const {
    for (const CoupledGroup& group : groups_)
      if (group.gave_in) return true;
    return false;
  }
  // Groups that miss their targets so far give in.
  void give_in() {
    for (std::uint32_t g = 0; g < std::uint32_t(groups_.size()); ++g)
      if (groups_[g].missed > 0.0 && !groups_[g].yields) give_in(g);
  }
  void finish(Arena& arena) {
    for (const CouplingRow& row : rows_) add_to_vertices(row, row.impulse);
    const VectorRows given = make_vectors(arena, count_);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const CoupledBody& one = bodies_[b];
      const std::size_t count = std::size_t(one.body->particles.count);
      if (one.step != nullptr && one.body->held.empty()) {
        for (std::size_t i = 0; i < count; ++i) set(given, i, vertices_.impulses[one.first + i]);
        if (one.carried.empty() && knows_rotations(*one.body))
          keep_momentum(*one.body, given, passes_[b].change);
        else
          keep_linear_momentum(one.body->particles, one.carried, given, passes_[b].change);
      }
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t v = one.first + i;
        // Masses alone answer exactly.
        vertices_.change[v] =
            one.step != nullptr ? at(passes_[b].change, i) : vertices_.blocks[v] * vertices_.impulses[v];
      }
    }
  }

 private:
  template <class Fn>
  void for_each_body(Fn&& fn) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      BodySystem system(passes_[b], bodies_[b].carried, kernels_, tasks_);
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
    for (CoupledRigid& one : rigid_) one.direction = {};
  }
  void set_inverse(std::size_t v, const Sym3& block) {
    const float parts[6] = {block.xx, block.yy, block.zz, block.xy, block.xz, block.yz};
    for (int k = 0; k < 6; ++k) inverse_[k][v] = parts[k];
  }

  // Rows of a group are dampers from now on, whose impulses do not add up: a compromise of what cannot be met, since it asks for opposite motions.
  void give_in(std::uint32_t group) {
    groups_[group].gave_in = true;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (group_of_[r] != group) continue;
      CoupledRow& state = states_[r];
      state.along = state.start_along, state.across = state.start_across;
      state.last_normal = 0.0f, state.last_friction = {};
      state.bound = bound_of(rows_[r], 0.0f);
    }
  }

  void add_to_vertices(const CouplingRow& row, Vec3 impulse) const {
    for (int k = 0; k < 5; ++k) vertices_.impulses[row.vertex[k]] += row.weight[k] * impulse;
  }

  static float bound_of(const CouplingRow& row, float normal) {
    return row.holds ? kUnbounded : row.friction[row.slides ? 1 : 0] * max(normal, 0.0f);
  }

  void begin_stage(std::size_t r) {
    if (!groups_.empty() && groups_[group_of_[r]].gave_in) return;
    const CouplingRow& row = rows_[r];
    CoupledRow& state = states_[r];
    state.last_normal = row.damper == 0.0f ? dot(row.normal, row.impulse) : 0.0f;
    state.last_friction = row.damper == 0.0f ? row.impulse - state.last_normal * row.normal : Vec3{};
    state.bound = bound_of(row, state.last_normal);
  }

  // The states of rows, and the vertices that they touch, each once, with its own block of A.
  void read_rows(std::span<const std::uint32_t> row_of, Arena& arena) {
    states_ = arena.make<CoupledRow>(rows_.size()), slopes_ = arena.make<CoupledRowSlope>(rows_.size());
    touched_ = arena.make<std::uint32_t>(5 * rows_.size());
    constexpr std::uint32_t kNone = 0xffffffffu;
    const std::span<std::uint32_t> listed = arena.make<std::uint32_t>(count_);
    for (std::uint32_t& one : listed) one = kNone;
    std::uint32_t used = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const CouplingRow& row = rows_[r];
      CoupledRow& state = states_[r];
      state = {};
      float mobility = 0.0f;
      for (int k = 0; k < 5; ++k) {
        const std::uint32_t v = row.vertex[k], i = row_of[v];
        if (row.weight[k] == 0.0f) continue;
        state.velocity += row.weight[k] * vertices_.velocities[v];
        if (!(vertices_.blocks[v].xx > 0.0f)) continue;  // it is held
        if (listed[i] == kNone) touched_[used] = i, listed[i] = used++;
        state.at[state.vertices] = listed[i], state.weight[state.vertices++] = row.weight[k];
        mobility += row.weight[k] * row.weight[k] / mass_of(i);
      }
      state.velocity -= row.passing;
      state.body = row.body, state.arm = row.arm;
      state.normal = row.normal, state.target = row.target;
      state.least = row.holds ? -kUnbounded : 0.0f;
      const float missed = row.holds ? length(state.velocity) : row.target - dot(row.normal, state.velocity);
      const float misses = max(missed, rest_speed_);
      if (mobility > 0.0f) stake_ += double(misses * misses / mobility);
      if (row.damper == 0.0f) allowed_ = min(allowed_, row.allowed);
      set_resistance(row, state);
      state.start_along = state.along, state.start_across = state.across;
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

  // The body of a row of the vectors, and the mass of its particle, kg.
  std::size_t body_of(std::size_t row) const {
    std::size_t b = 0;
    while (b + 1 < bodies_.size() && begins_[b + 1] <= row) ++b;
    return b;
  }
  float mass_of(std::size_t row) const {
    const std::size_t b = body_of(row);
    return passes_[b].mass[row - begins_[b]];
  }
  // Sets what a row resists by: what its points do, each vertex by its own block and all of them by the rigid motion of their piece. Held vertices count as if they
  // answered as the others do: where they close, the little weight of one that is free is not to stop them all.
  void set_resistance(const CouplingRow& row, CoupledRow& state) {
    state.along = row.damper;
    if (row.damper > 0.0f) return;
    float loose = 0.0f, all = 0.0f;
    Sym3 answer{};
    for (int k = 0; k < 5; ++k) {
      const Sym3& block = vertices_.blocks[row.vertex[k]];
      const float share = row.weight[k] * row.weight[k];
      answer = answer + share * block;
      all += share;
      if (block.xx > 0.0f) loose += share;
    }
    for_each_piece(state, [&](const RigidCorrection& piece, double share, DVec3 arm) {
      answer = answer + piece.compliance(share, arm);
    });
    if (row.body >= 0) answer = answer + rigid_[std::size_t(row.body)].compliance(row.arm), loose = all;
    const float along = dot(row.normal, answer * row.normal);
    const float across = answer.xx + answer.yy + answer.zz - along;
    if (!(along > 0.0f) || !(across > 0.0f)) return;
    const float resistance = kResistance * loose / all;
    state.along = resistance / along, state.across = 2.0f * resistance / across;
  }
  // The impulses of the rows at the present velocities, in the residual.
  void update_impulses() {
    for (Vec3& value : values_) value = {};
    for (CoupledRow& state : states_) {
      const float speed = dot(state.normal, state.velocity), push = max(state.push_at(speed), state.least);
      if (push == state.least && state.push == state.least) continue;
      Vec3 friction{};
      if (push > state.least) {
        friction = state.last_friction - state.across * (state.velocity - speed * state.normal);
        const float square = dot(friction, friction);
        state.sticks = square <= state.bound * state.bound;
        if (!state.sticks) friction = (state.bound / std::sqrt(square)) * friction;
      }
      const Vec3 change = (push - state.push) * state.normal + (friction - state.friction);
      for (int k = 0; k < state.vertices; ++k) values_[state.at[k]] += state.weight[k] * change;
      if (state.body >= 0) rigid_[std::size_t(state.body)].push(state.arm, change);
      state.push = push, state.friction = friction;
    }
    for (std::size_t t = 0; t < touched_.size(); ++t)
      set(residual_, touched_[t], at(residual_, touched_[t]) + values_[t]);
  }
  // The preconditioner, with what resists now.
  void set_inverses() {
    for (std::size_t t = 0; t < touched_.size(); ++t) with_rows_[t] = own_[t];
    for (CoupledRigid& one : rigid_) one.clear_rows();
    for (const CoupledRow& state : states_) {
      if (!state.acts()) continue;
      const Sym3 block = state.inertia();
      if (state.body >= 0) rigid_[std::size_t(state.body)].add_row(block, state.arm);
      for (int k = 0; k < state.vertices; ++k) {
        Sym3& sum = with_rows_[state.at[k]];
        sum = sum + (state.weight[k] * state.weight[k]) * block;
      }
    }
    for (std::size_t t = 0; t < touched_.size(); ++t) set_inverse(touched_[t], inverse(with_rows_[t]));
    for (CoupledRigid& one : rigid_) one.factor();
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
      if (!knows_rotations(*bodies_[b].body)) add_rotations(b);
      for (const CarriedInertia& one : bodies_[b].carried)
        correction_of(b, one.particle).add_carried(one.inertia, p.place(one.particle));
    }
  }
  void add_rotations(std::size_t b) {
    const Particles& p = bodies_[b].body->particles;
    const VectorRows &turn = passes_[b].direction, &product = passes_[b].product;
    for (int piece = 0; piece < bodies_[b].body->pieces(); ++piece)
      corrections_[first_piece_[b] + std::size_t(piece)].clear_rotations();
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < p.x.size(); ++i) set(turn, i, {});
      for (int i = 0; i < p.count; ++i)
        set(turn, std::size_t(i),
            to_float(RigidCorrection::rotation(axis, correction_of(b, i).arm_of(p.place(i)))));
      BodySystem(passes_[b], {}, kernels_, tasks_).apply();
      for (int i = 0; i < p.count; ++i)
        correction_of(b, i).add_rotation(axis, DVec3(at(product, std::size_t(i))), p.place(i));
    }
  }
  RigidCorrection& correction_of(std::size_t body, int particle) {
    return corrections_[first_piece_[body] + bodies_[body].body->piece_of(particle)];
  }
  // With the rows that push now.
  void set_corrections() {
    for (RigidCorrection& one : corrections_) one.clear_rows();
    for (const CoupledRow& state : states_) {
      if (state.acts()) add_to_corrections(state);
    }
    for (RigidCorrection& one : corrections_) one.factor();
  }
  void add_to_corrections(const CoupledRow& state) {
    for_each_piece(state, [&](RigidCorrection& piece, double share, DVec3 arm) {
      piece.add_row(state.inertia(), share, arm);
    });
  }
  // Calls visit(correction, share, arm) for each piece that a row moves: the row's velocity is `share` times the translation and the rotation times `arm`.
  template <class Visit>
  void for_each_piece(const CoupledRow& state, Visit&& visit) {
    RigidCorrection* of[5] = {};
    DVec3 arm[5];
    for (int k = 0; k < state.vertices; ++k) {
      const std::size_t i = touched_[state.at[k]];
      const std::size_t b = body_of(i);
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
      visit(*of[first], share, sum);
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
    for (RigidCorrection& one : corrections_.subspan(begin, pieces)) {
      work += one.solve();
      unbalanced_ += one.energy_of_residual();
    }
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
    unbalanced_ = 0.0;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      SoftPass pass = passes_[b];
      pass.direction = pass.product;
      error += BodySystem(pass, {}, kernels_, tasks_).sum(kernels_.precondition);
      error += correct(b);
    }
    for (CoupledRigid& one : rigid_) error += one.precondition();
    return error;
  }
  // The preconditioned residual times the residual of the iteration before.
  double match_last() {
    double sum = match(product_, last_);
    for (const CoupledRigid& one : rigid_) sum += dot(one.answer, one.last);
    return sum;
  }
  // True if no vertex would change its velocity by more than rows allow, by the preconditioned residual.
  bool is_still() const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 z = at(product_, i);
      if (dot(z, z) > allowed_ * allowed_) return false;
    }
    for (const CoupledRow& state : states_) {
      if (state.body < 0) continue;
      const RigidVector& answer = rigid_[std::size_t(state.body)].answer;
      const DVec3 z = answer.linear + cross(answer.angular, DVec3(state.arm));
      if (dot(z, z) > double(allowed_) * double(allowed_)) return false;
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
  Vec3 way_of(const CoupledRow& state) const {
    Vec3 sum{};
    for (int k = 0; k < state.vertices; ++k) sum += state.weight[k] * values_[state.at[k]];
    return state.body < 0 ? sum : sum - rigid_[std::size_t(state.body)].way_of(state.arm);
  }
  // Sets the slopes of the rows. Returns what those that push now resist of the direction.
  double find_slopes() {
    for (std::size_t t = 0; t < touched_.size(); ++t) values_[t] = at(direction_, touched_[t]);
    double resistance = 0.0;
    for (std::size_t r = 0; r < states_.size(); ++r) {
      const CoupledRow& state = states_[r];
      const Vec3 way = way_of(state);
      const float speed = dot(state.normal, way), now = dot(state.normal, state.velocity);
      const Vec3 across = way - speed * state.normal;
      const Vec3 f = state.last_friction - state.across * (state.velocity - now * state.normal),
                 g = -state.across * across;
      CoupledRowSlope& slope = slopes_[r];
      slope.push = double(state.push_at(now)), slope.push_rate = -double(state.along) * double(speed);
      slope.speed = double(speed);
      slope.size = double(dot(f, f)), slope.mixed = double(dot(f, g)), slope.rate = double(dot(g, g));
      slope.work = double(dot(f, across)), slope.work_rate = double(dot(g, across));
      slope.bound = double(state.bound), slope.least = double(state.least);
      if (state.acts()) resistance -= slope.push_rate * slope.speed + (state.sticks ? slope.work_rate : 0.0);
    }
    return resistance;
  }

  // Where along the direction the slope is zero.
  double best_share(double slope, double curvature) {
    return find_zero_slope(slopes_, slope, curvature, find_slopes());
  }

  std::span<const CoupledBody> bodies_;
  std::span<CoupledRigid> rigid_;
  std::span<CouplingRow> rows_;
  const CoupledVertices& vertices_;
  const SoftKernels& kernels_;
  TaskSystem& tasks_;
  std::span<SoftPass> passes_;
  std::span<std::size_t> first_piece_;  // by body, in the corrections
  std::span<RigidCorrection> corrections_;
  std::span<std::size_t> begins_;  // by body: its first row in the vectors below
  std::size_t count_ = 0;
  // J, twice: what the vertices of the rows have by the speeds that their rows take, without the rest of their bodies. Errors are
  // measured against it. Against the first residual they would be those of a row's own resistance, which is a thousand times that in a stiff body.
  double stake_ = 0.0;
  std::span<CoupledGroup> groups_;     // by the least of their bodies, rigid ones behind
  std::span<std::uint32_t> group_of_;  // by row
  double unbalanced_ = 0.0;  // J, twice: of the rigid motions that the bodies' momentum still misses
  float rest_speed_;
  float allowed_ = 1.0e30f;  // m/s: the least that rows allow
  VectorRows change_, residual_, direction_, product_, last_;
  float* inverse_[6] = {};
  std::span<std::uint32_t> touched_;  // vertices that rows touch, as rows of the vectors above
  std::span<Sym3> own_, with_rows_;   // kg, by touched vertex
  std::span<Vec3> values_;            // by touched vertex: impulses, or the direction
  std::span<CoupledRow> states_;
  std::span<CoupledRowSlope> slopes_;
};

}  // namespace

CoupledReport solve_coupled(std::span<const CoupledBody> bodies, std::span<const RigidInertia> rigid,
                            std::span<CouplingRow> rows, const CoupledVertices& vertices,
                            const CoupledSettings& settings, const SoftKernels& kernels, Arena& arena,
                            TaskSystem& tasks) {
  const ArenaScope scope(arena);
  CoupledSolve solve(bodies, rigid, rows, vertices, kernels, settings, arena, tasks);
  CoupledReport report;
  report.met = false;
  while (report.stages < settings.most_stages && !report.met) {
    report.iterations += solve.minimize(settings.most_iterations, settings.tolerance);
    ++report.stages;
    report.met = solve.end_stage() && report.stages >= settings.least_stages;
  }
  if (!report.met) {
    solve.give_in();
    report.iterations += solve.minimize(settings.most_iterations, settings.tolerance);
    solve.end_stage();
  }
  report.met = report.met && !solve.has_given_in();
  solve.finish(arena);
  return report;
}

}  // namespace gyre
