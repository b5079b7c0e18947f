#include "soft/solver/rope_step.h"

#include "soft/solver/soft_pass.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kUnknowns = 4;  // of a particle: its velocity, and t of the segment before it

// A symmetric band matrix by columns, the diagonal first.
template <int Width>
struct Band {
  std::span<double> entries;
  int size;

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
      const int reach = size - 1 - k < Width ? size - 1 - k : Width;
      for (int r = 1; r <= reach; ++r) {
        const double share = own[r] * inverse;
        if (share == 0.0) continue;
        double* const other = column(k + r);
        for (int t = r; t <= Width; ++t) other[t - r] -= share * own[t];
      }
      for (int r = 1; r <= Width; ++r) own[r] *= inverse;
      own[0] = inverse;
    }
  }
  void solve(double* x) {
    for (int k = 0; k < size; ++k) {
      const int reach = size - 1 - k < Width ? size - 1 - k : Width;
      for (int r = 1; r <= reach; ++r) x[k + r] -= column(k)[r] * x[k];
      x[k] *= column(k)[0];
    }
    for (int k = size - 2; k >= 0; --k) {
      const int reach = size - 1 - k < Width ? size - 1 - k : Width;
      for (int r = 1; r <= reach; ++r) x[k] -= column(k)[r] * x[k + r];
    }
  }
};

template <int Width>
class RopeSolver {
 public:
  RopeSolver(SoftBody& body, const RopeSettings& settings, Arena& arena)
      : body_(body),
        particles_(body.particles),
        chain_(body.chain),
        settings_(settings),
        h_(double(settings.step)),
        band_{arena.make<double>(std::size_t(kUnknowns * body.particles.count) * (Width + 1)),
              kUnknowns * body.particles.count},
        right_(arena.make<double>(std::size_t(kUnknowns * body.particles.count))),
        place_(arena.make<DVec3>(std::size_t(body.particles.count))),
        speed_(arena.make<DVec3>(std::size_t(body.particles.count))) {}

  RopeReport run() {
    for (int i = 0; i < particles_.count; ++i) at(speed_, i) = {};
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
      if (report.longest < kSmallError) break;
    }
    finish();
    return report;
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
    for (const HeldParticle& one : body_.held) fix(one.particle);
  }

  void add_segment(int s) {
    const DVec3 edge = at(place_, s + 1) - at(place_, s);
    const double span = length(edge), rest = chain_.rest_length[s];
    const DVec3 n = span > 0.0 ? edge / span : DVec3{1, 0, 0};
    const double axis[3] = {n.x, n.y, n.z};
    const int t = kUnknowns * (s + 1) + 3;
    for (int c = 0; c < 3; ++c) {
      if (!held(s)) band_.add(t, kUnknowns * s + c, -axis[c]);
      if (!held(s + 1)) band_.add(t, kUnknowns * (s + 1) + c, axis[c]);
    }
    const double error = span - rest;
    // With the part of damping: it alone can hold a load, and turns with the segment as the rest does.
    const double tension = chain_.tension[s];
    if (chain_.stretch_stiffness > 0.0) {
      const double k = chain_.stretch_stiffness / rest, beta = double(body_.damping);
      band_.add(t, t, -1.0 / (k * h_ * (h_ + beta)));
      right_[std::size_t(t)] = -(error + beta * dot(n, at(speed_, s + 1) - at(speed_, s))) / (h_ + beta);
    } else {
      right_[std::size_t(t)] = -error / h_;
    }
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
      double error = length(place_[std::size_t(s + 1)] - place_[std::size_t(s)]) - rest;
      if (chain_.stretch_stiffness > 0.0) {  // the length that the tension asks for
        const DVec3 edge = place_[std::size_t(s + 1)] - place_[std::size_t(s)];
        const double rate = dot(edge, speed_[std::size_t(s + 1)] - speed_[std::size_t(s)]) / length(edge);
        error += double(body_.damping) * rate - chain_.tension[s] * rest / chain_.stretch_stiffness;
      }
      worst = max(worst, absolute(error) / rest);
    }
    return worst;
  }

  void finish() {
    for (int i = 0; i < particles_.count; ++i) {
      particles_.set_place(i, at(place_, i));
      particles_.set_velocity(i, to_float(at(speed_, i)));
    }
    place_held(body_);
  }

  SoftBody& body_;
  Particles& particles_;
  Chain& chain_;
  const RopeSettings& settings_;
  double h_;
  Band<Width> band_;
  std::span<double> right_;
  std::span<DVec3> place_, speed_;
};

}  // namespace

RopeReport step_rope(SoftBody& body, const RopeSettings& settings, Arena& arena) {
  const ArenaScope scope(arena);
  if (body.chain.bend_stiffness > 0.0) return RopeSolver<10>(body, settings, arena).run();
  return RopeSolver<7>(body, settings, arena).run();
}

}  // namespace gyre
