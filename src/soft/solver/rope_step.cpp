#include "soft/solver/rope_step.h"

#include "math/wide_double.h"
#include "soft/solver/soft_pass.h"

#include <cmath>

namespace gyre {

namespace {

using Pair = WideDouble<2>;

constexpr int kUnknowns = 4;  // of a particle: its velocity, and t of the segment before it

// Half widths of the matrix. Bending couples a velocity with the same component two particles away, and elimination adds nothing beyond that.
constexpr int kBentWidth = 2 * kUnknowns, kPlainWidth = 2 * kUnknowns - 1;

// A symmetric band matrix by columns, the diagonal first. After the last column there is room for `Width` more, which are zero, so that all
// loops over a column have the same length.
template <int Width>
struct Band {
  std::span<double> entries;
  int size;

  static std::size_t room(int size) { return std::size_t(size + Width) * (Width + 1); }

  double* column(int k) { return entries.data() + std::size_t(k) * (Width + 1); }
  void add(int row, int col, double value) {
    row < col ? add(col, row, value) : void(column(col)[row - col] += value);
  }
  // Adds a symmetric 3 x 3 block at the rows and columns of two particles.
  void add_block(int a, int b, const double (&block)[3][3]) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < (a == b ? r + 1 : 3); ++c) add(kUnknowns * a + r, kUnknowns * b + c, block[r][c]);
    }
  }

  // L D L^T in place; the diagonal becomes 1 / D, zero where the pivot is.
  void factor() {
    for (int k = 0; k < size; ++k) {
      double* const own = column(k);
      const double inverse = own[0] != 0.0 ? 1.0 / own[0] : 0.0;
      double entry[Width + 2];
      GYRE_UNROLL
      for (int r = 1; r <= Width; ++r) entry[r] = own[r];
      entry[Width + 1] = 0.0;
      Pair pair[Width + 1];
      GYRE_UNROLL
      for (int r = 1; r <= Width; ++r) pair[r] = Pair::of(Pair::Double{entry[r], entry[r + 1]});
      own[0] = inverse;
      GYRE_UNROLL
      for (int r = 1; r <= Width; ++r) {
        const double share = entry[r] * inverse;
        own[r] = share;
        double* const other = own + r * (Width + 1);
        const Pair both(share);
        // Two at a time; the last one may be the entry that is zero.
        GYRE_UNROLL
        for (int t = r; t <= Width; t += 2)
          (Pair::load_loose(other + t - r) - both * pair[t]).store_loose(other + t - r);
      }
    }
  }
  // `x` has room for `Width` more numbers.
  void solve(double* x) {
    for (int k = 0; k < size; ++k) {
      const double* const own = column(k);
      const double pivot = x[k];
      GYRE_UNROLL
      for (int r = 1; r <= Width; ++r) x[k + r] -= own[r] * pivot;
      x[k] = pivot * own[0];
    }
    for (int r = 0; r < Width; ++r) x[size + r] = 0.0;
    // From the far end, so that only the last term waits for the unknown before.
    for (int k = size - 1; k >= 0; --k) {
      const double* const own = column(k);
      double sum = x[k];
      GYRE_UNROLL
      for (int r = Width; r >= 1; --r) sum -= own[r] * x[k + r];
      x[k] = sum;
    }
  }
};

template <int Width>
class RopeSolver {
 public:
  RopeSolver(SoftBody& body, const RopeSettings& settings, RopeStep& step)
      : body_(body),
        particles_(body.particles),
        chain_(body.chain),
        settings_(settings),
        h_(double(settings.step)),
        band_{step.band, kUnknowns * body.particles.count},
        right_(step.right),
        place_(step.place),
        speed_(step.velocity) {
    if (const double stiffness = body.rope_stiffness(); stiffness > 0.0) compliance_ = 1.0 / stiffness;
    if (chain_.stretch_stiffness > 0.0) damping_ = double(body.damping);
  }

  RopeReport run() {
    for (int i = 0; i < particles_.count; ++i) at(speed_, i) = DVec3(particles_.velocity(i));
    for (const HeldParticle& one : body_.held) {
      at(speed_, one.particle) = (one.place - particles_.place(one.particle)) / h_;
    }
    move_places();
    RopeReport report;
    while (report.iterations < settings_.most_iterations) {
      assemble();
      band_.factor();
      band_.solve(right_.data());
      take_solution();
      ++report.iterations;
      report.longest = largest_error();
      if (report.longest < kSmallError && report.iterations >= settings_.least_iterations) break;
    }
    for (int i = 0; i < particles_.count; ++i) particles_.set_velocity(i, to_float(at(speed_, i)));
    return report;
  }

  // Changes the velocities at the end, and no place.
  void keep_lengths() {
    for (double& entry : band_.entries) entry = 0.0;
    for (double& one : right_) one = 0.0;
    for (int i = 0; i < particles_.count; ++i) {
      for (int c = 0; c < 3; ++c) band_.add(kUnknowns * i + c, kUnknowns * i + c, double(particles_.mass[i]));
    }
    band_.add(3, 3, 1.0);
    for (int s = 0; s < segments(); ++s) {
      const DVec3 n = add_axis(s);
      const int t = kUnknowns * (s + 1) + 3;
      band_.add(t, t, -compliance_ * chain_.rest_length[s] / (h_ * h_));
      right_[std::size_t(t)] = -dot(n, at(speed_, s + 1) - at(speed_, s));
      if (held(s) && held(s + 1)) band_.column(t)[0] = 1.0, right_[std::size_t(t)] = 0.0;
    }
    for (const CarriedInertia& one : settings_.carried) add_inertia(one);
    for (const HeldParticle& one : body_.held) fix(one.particle);
    band_.factor();
    band_.solve(right_.data());
    for (int i = 0; i < particles_.count; ++i) {
      const double* const d = &right_[std::size_t(kUnknowns * i)];
      at(speed_, i) += DVec3{d[0], d[1], d[2]};
      particles_.set_velocity(i, to_float(at(speed_, i)));
    }
  }

 private:
  // Errors of length, as shares of a segment, that are left as they are: those of the next sub-step's linearisation.
  static constexpr double kSmallError = 1.0e-4;

  template <class T>
  static T& at(std::span<T> items, int i) {
    return items[std::size_t(i)];
  }
  bool held(int i) const { return particles_.loose[i] == 0.0f; }
  int segments() const { return particles_.count - 1; }

  void move_places() {
    for (int i = 0; i < particles_.count; ++i) at(place_, i) = particles_.place(i) + h_ * at(speed_, i);
  }

  void assemble() {
    for (double& entry : band_.entries) entry = 0.0;
    for (int i = 0; i < particles_.count; ++i) {
      const double mass = double(particles_.mass[i]);
      const DVec3 outside(Vec3{particles_.fx[i], particles_.fy[i], particles_.fz[i]});
      const DVec3 push = h_ * (outside + mass * DVec3(settings_.gravity)) +
                         mass * (DVec3(particles_.velocity(i)) - at(speed_, i));
      double* const right = &right_[std::size_t(kUnknowns * i)];
      right[0] = push.x, right[1] = push.y, right[2] = push.z, right[3] = 0.0;
      for (int c = 0; c < 3; ++c) band_.add(kUnknowns * i + c, kUnknowns * i + c, mass);
    }
    band_.add(3, 3, 1.0);  // there is no segment before the first particle
    for (int s = 0; s < segments(); ++s) add_segment(s);
    if (chain_.bend_stiffness > 0.0) {
      for (int i = 1; i < segments(); ++i) add_bend(i);
    }
    for (const CarriedInertia& one : settings_.carried) add_carried(one);
    for (const HeldParticle& one : body_.held) fix(one.particle);
  }

  void add_inertia(const CarriedInertia& one) {
    const Sym3& m = one.inertia;
    const double block[3][3] = {{double(m.xx), double(m.xy), double(m.xz)},
                                {double(m.xy), double(m.yy), double(m.yz)},
                                {double(m.xz), double(m.yz), double(m.zz)}};
    band_.add_block(one.particle, one.particle, block);
  }
  void add_carried(const CarriedInertia& one) {
    add_inertia(one);
    const DVec3 push(momentum_to_target(one, to_float(at(speed_, one.particle))));
    double* const right = &right_[std::size_t(kUnknowns * one.particle)];
    right[0] += push.x, right[1] += push.y, right[2] += push.z;
  }

  // The direction of a segment, which its tension acts along.
  DVec3 add_axis(int s) {
    const DVec3 edge = at(place_, s + 1) - at(place_, s);
    const double span = length(edge);
    const DVec3 n = span > 0.0 ? edge / span : DVec3{1, 0, 0};
    const double axis[3] = {n.x, n.y, n.z};
    const int t = kUnknowns * (s + 1) + 3;
    for (int c = 0; c < 3; ++c) {
      if (!held(s)) band_.add(t, kUnknowns * s + c, -axis[c]);
      if (!held(s + 1)) band_.add(t, kUnknowns * (s + 1) + c, axis[c]);
    }
    return n;
  }

  void add_segment(int s) {
    const DVec3 edge = at(place_, s + 1) - at(place_, s);
    const double span = length(edge), rest = chain_.rest_length[s];
    const DVec3 n = add_axis(s);
    const double axis[3] = {n.x, n.y, n.z};
    const int t = kUnknowns * (s + 1) + 3;
    const double error = span - rest;
    // With the part of damping: it alone can hold a load, and turns with the segment as the rest does.
    const double tension = chain_.tension[s];
    const double beta = damping_;
    band_.add(t, t, -compliance_ * rest / (h_ * (h_ + beta)));
    right_[std::size_t(t)] = -(error + beta * dot(n, at(speed_, s + 1) - at(speed_, s))) / (h_ + beta);
    if (held(s) && held(s + 1)) {
      band_.column(t)[0] = 1.0;
      right_[std::size_t(t)] = 0.0;
    }
    if (!(tension > 0.0) || !(span > 0.0)) return;
    double across[3][3], minus[3][3];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        across[r][c] = h_ * h_ * tension / span * ((r == c ? 1.0 : 0.0) - axis[r] * axis[c]);
        minus[r][c] = -across[r][c];
      }
    }
    if (!held(s)) band_.add_block(s, s, across);
    if (!held(s + 1)) band_.add_block(s + 1, s + 1, across);
    if (!held(s) && !held(s + 1)) band_.add_block(s + 1, s, minus);
  }

  // The curvature at particle i is that of the two segments' directions over half their lengths. Where both ends of one are held, the rope is
  // clamped there and bends over half the other alone.
  void add_bend(int i) {
    const double before = chain_.rest_length[i - 1], after = chain_.rest_length[i];
    const bool clamped_before = held(i - 1) && held(i), clamped_after = held(i) && held(i + 1);
    const double share = 0.5 * ((clamped_before ? 0.0 : before) + (clamped_after ? 0.0 : after));
    if (!(share > 0.0)) return;
    const double weight = chain_.bend_stiffness / share;
    const double sign[3] = {1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after};
    DVec3 bent{}, rate{};
    for (int a = 0; a < 3; ++a) {
      bent += sign[a] * at(place_, i - 1 + a);
      rate += sign[a] * at(speed_, i - 1 + a);
    }
    const double scale = h_ * h_ + h_ * double(body_.damping);
    const DVec3 pull = h_ * weight * (bent + double(body_.damping) * rate);
    for (int a = 0; a < 3; ++a) {
      const int p = i - 1 + a;
      if (held(p)) continue;
      double* const right = &right_[std::size_t(kUnknowns * p)];
      right[0] -= sign[a] * pull.x, right[1] -= sign[a] * pull.y, right[2] -= sign[a] * pull.z;
      for (int b = 0; b <= a; ++b) {
        if (held(i - 1 + b)) continue;
        for (int c = 0; c < 3; ++c) {
          band_.add(kUnknowns * p + c, kUnknowns * (i - 1 + b) + c, scale * weight * sign[a] * sign[b]);
        }
      }
    }
  }

  void fix(int i) {
    for (int c = 0; c < 3; ++c) {
      band_.column(kUnknowns * i + c)[0] = 1.0;
      right_[std::size_t(kUnknowns * i + c)] = 0.0;
    }
  }

  void take_solution() {
    for (int i = 0; i < particles_.count; ++i) {
      const double* const d = &right_[std::size_t(kUnknowns * i)];
      at(speed_, i) += DVec3{d[0], d[1], d[2]};
      if (i > 0) chain_.tension[i - 1] = d[3] / h_;
    }
    move_places();
  }

  double largest_error() const {
    double worst = 0.0;
    for (int s = 0; s < segments(); ++s) {
      const double rest = chain_.rest_length[s];
      // Beside the length that the tension asks for.
      const DVec3 edge = place_[std::size_t(s + 1)] - place_[std::size_t(s)];
      const double rate = dot(edge, speed_[std::size_t(s + 1)] - speed_[std::size_t(s)]) / length(edge);
      const double error = length(edge) - rest + damping_ * rate - chain_.tension[s] * rest * compliance_;
      worst = max(worst, absolute(error) / rest);
    }
    return worst;
  }

  SoftBody& body_;
  Particles& particles_;
  Chain& chain_;
  const RopeSettings& settings_;
  double h_;
  double compliance_ = 0.0;  // 1/N: 1 / EA
  double damping_ = 0.0;     // s
  Band<Width> band_;
  std::span<double> right_;
  std::span<DVec3> place_, speed_;
};

// Calls fn with the band of a step.
template <class Fn>
void with_band(const RopeStep& step, Fn&& fn) {
  const int size = kUnknowns * int(step.place.size());
  if (step.has_bending) fn(Band<kBentWidth>{step.band, size});
  if (!step.has_bending) fn(Band<kPlainWidth>{step.band, size});
}

// The entries of the inverse that lie in the band, in its form: column by column from the last, each from those behind it.
template <int Width>
void invert_in_band(Band<Width> factor, Band<Width> inverse) {
  for (double& entry : inverse.entries) entry = 0.0;
  for (int k = factor.size - 1; k >= 0; --k) {
    const double* const own = factor.column(k);
    double* const to = inverse.column(k);
    GYRE_UNROLL
    for (int r = Width; r >= 0; --r) {
      double sum = r == 0 ? own[0] : 0.0;
      GYRE_UNROLL
      for (int t = Width; t >= 1; --t) {
        const int low = t < r ? t : r, high = t < r ? r : t;
        sum -= own[t] * to[low * (Width + 1) + high - low];
      }
      to[r] = sum;
    }
  }
}

}  // namespace

RopeStep begin_rope(SoftBody& body, const RopeSettings& settings, Arena& arena) {
  RopeStep step;
  const std::size_t count = std::size_t(body.particles.count);
  step.h = step.move = double(settings.step);
  step.has_bending = body.chain.bend_stiffness > 0.0;
  const int size = kUnknowns * body.particles.count;
  step.band =
      arena.make<double>(step.has_bending ? Band<kBentWidth>::room(size) : Band<kPlainWidth>::room(size));
  step.right = arena.make<double>(std::size_t(size + kBentWidth));
  step.place = arena.make<DVec3>(count);
  step.velocity = arena.make<DVec3>(count);
  step.report = step.has_bending ? RopeSolver<kBentWidth>(body, settings, step).run()
                                 : RopeSolver<kPlainWidth>(body, settings, step).run();
  return step;
}

void find_rope_inverse_masses(RopeStep& step, Arena& arena) {
  step.inverse = arena.make<Sym3>(step.place.size());
  const ArenaScope scope(arena);
  const std::span<double> room = arena.make<double>(step.band.size());
  with_band(step, [&](auto factor) {
    auto inverse = factor;
    inverse.entries = room;
    invert_in_band(factor, inverse);
    for (std::size_t i = 0; i < step.inverse.size(); ++i) {
      const double* const x = inverse.column(kUnknowns * int(i));
      const double* const y = inverse.column(kUnknowns * int(i) + 1);
      const double* const z = inverse.column(kUnknowns * int(i) + 2);
      step.inverse[i] = {float(x[0]), float(y[0]), float(z[0]), float(x[1]), float(x[2]), float(y[1])};
    }
  });
}

void respond_rope(SoftBody& body, RopeStep& step, std::span<const Vec3> impulses, std::span<Vec3> change) {
  for (double& one : step.right) one = 0.0;
  for (std::size_t i = 0; i < impulses.size(); ++i) {
    if (body.particles.loose[i] == 0.0f) continue;
    double* const right = &step.right[kUnknowns * i];
    right[0] = double(impulses[i].x), right[1] = double(impulses[i].y), right[2] = double(impulses[i].z);
  }
  with_band(step, [&](auto band) { band.solve(step.right.data()); });
  for (std::size_t i = 0; i < change.size(); ++i) {
    const double* const d = &step.right[kUnknowns * i];
    change[i] = body.particles.loose[i] == 0.0f ? Vec3{} : to_float(DVec3{d[0], d[1], d[2]});
  }
}

void add_rope_change(SoftBody& body, RopeStep& step, std::span<const Vec3> change, double scale) {
  Particles& p = body.particles;
  for (int i = 0; i < p.count; ++i) {
    const DVec3 own = scale * DVec3(change[std::size_t(i)]);
    step.velocity[std::size_t(i)] += own;
    step.place[std::size_t(i)] += step.move * own;
    p.set_velocity(i, to_float(step.velocity[std::size_t(i)]));
    if (i > 0) body.chain.tension[i - 1] += scale * step.right[kUnknowns * std::size_t(i) + 3] / step.move;
  }
}

void keep_lengths(SoftBody& body, const RopeSettings& settings, RopeStep& step, Arena& arena) {
  if (body.chain.stretch_stiffness > 0.0) return;
  const ArenaScope scope(arena);
  RopeStep own = step;
  own.band = arena.make<double>(Band<kPlainWidth>::room(kUnknowns * body.particles.count));
  own.right = arena.make<double>(step.right.size());
  RopeSolver<kPlainWidth>(body, settings, own).keep_lengths();
}

void finish_rope(SoftBody& body, const RopeStep& step) {
  for (int i = 0; i < body.particles.count; ++i) body.particles.set_place(i, step.place[std::size_t(i)]);
  place_held(body);
}

RopeReport step_rope(SoftBody& body, const RopeSettings& settings, Arena& arena) {
  const ArenaScope scope(arena);
  const RopeStep step = begin_rope(body, settings, arena);
  finish_rope(body, step);
  return step.report;
}

}  // namespace gyre
