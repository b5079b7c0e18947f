#include "soft/solver/explicit_step.h"

#include "soft/body/enclosed_gas.h"
#include "soft/solver/soft_pass.h"

namespace gyre {

namespace {

class ExplicitStepper {
 public:
  ExplicitStepper(SoftBody& body, const ExplicitSettings& settings, const SoftKernels& kernels, Arena& arena,
                  TaskSystem& tasks)
      : body_(body),
        settings_(settings),
        kernels_(kernels),
        arena_(arena),
        tasks_(tasks),
        pass_(begin_pass(body, arena)) {
    pass_.damping = body.damping;
    if (!body.gas.triangles.empty()) gradient_ = arena.make<Vec3>(body.particles.x.size());
  }

  void run() {
    switch (settings_.scheme) {
      case ExplicitScheme::explicit_euler:
        return euler(true);
      case ExplicitScheme::semi_implicit_euler:
        return euler(false);
      case ExplicitScheme::rk4:
        return rk4();
      case ExplicitScheme::verlet:
        return verlet();
    }
  }

 private:
  // Of the present places and velocities; zero for held particles.
  void find_accelerations() {
    find_forces(pass_, body_, kernels_, tasks_);
    if (body_.gas.triangles.empty()) return;
    find_volume_gradient(body_.particles, body_.gas, gradient_);
    const float push =
        float(gauge_pressure(body_.gas, enclosed_volume(body_.particles, body_.gas.triangles)));
    for (std::size_t i = 0; i < gradient_.size(); ++i) {
      const Vec3 force = push * gradient_[i];
      pass_.force.x[i] += force.x, pass_.force.y[i] += force.y, pass_.force.z[i] += force.z;
    }
  }
  Vec3 acceleration(int i) const {
    const Particles& p = body_.particles;
    if (p.loose[i] == 0.0f) return {};
    const Vec3 force{pass_.force.x[i] + p.fx[i], pass_.force.y[i] + p.fy[i], pass_.force.z[i] + p.fz[i]};
    return settings_.gravity + force / p.mass[i];
  }

  void euler(bool places_first) {
    find_accelerations();
    Particles& p = body_.particles;
    const float h = settings_.step;
    for (int i = 0; i < p.count; ++i) {
      const Vec3 before = p.velocity(i), after = before + h * acceleration(i);
      p.set_place(i, p.place(i) + double(h) * DVec3(places_first ? before : after));
      p.set_velocity(i, after);
    }
  }

  void rk4() {
    constexpr double kStage[4] = {0.5, 0.5, 1.0, 0.0},
                     kShare[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    struct Start {
      DVec3 place, velocity, move, change;
    };
    Particles& p = body_.particles;
    const double h = double(settings_.step);
    const std::span<Start> starts = arena_.make<Start>(std::size_t(p.count));
    for (int i = 0; i < p.count; ++i) starts[std::size_t(i)] = {p.place(i), DVec3(p.velocity(i)), {}, {}};
    for (int stage = 0; stage < 4; ++stage) {
      find_accelerations();
      for (int i = 0; i < p.count; ++i) {
        Start& start = starts[std::size_t(i)];
        const DVec3 velocity(p.velocity(i)), pull(acceleration(i));
        start.move += kShare[stage] * h * velocity;
        start.change += kShare[stage] * h * pull;
        const bool last = stage == 3;
        p.set_place(i, start.place + (last ? start.move : kStage[stage] * h * velocity));
        p.set_velocity(i, to_float(start.velocity + (last ? start.change : kStage[stage] * h * pull)));
      }
    }
  }

  // The velocity told is that of half a step before, brought on by the acceleration.
  void verlet() {
    find_accelerations();
    Particles& p = body_.particles;
    const double h = double(settings_.step);
    Array<double>(&moved)[3] = body_.moved;
    const bool first = moved[0].size() != p.x.size();
    for (Array<double>& column : moved) column.resize(p.x.size());
    for (int i = 0; i < p.count; ++i) {
      const DVec3 pull(acceleration(i));
      const DVec3 before = first ? h * DVec3(p.velocity(i)) - 0.5 * h * h * pull
                                 : DVec3{moved[0][i], moved[1][i], moved[2][i]};
      const DVec3 after = before + h * h * pull;
      moved[0][i] = after.x, moved[1][i] = after.y, moved[2][i] = after.z;
      p.set_place(i, p.place(i) + after);
      p.set_velocity(i, to_float(after / h + 0.5 * h * pull));
    }
  }

  SoftBody& body_;
  const ExplicitSettings& settings_;
  const SoftKernels& kernels_;
  Arena& arena_;
  TaskSystem& tasks_;
  SoftPass pass_;
  std::span<Vec3> gradient_{};  // of the volume of a gas
};

}  // namespace

void step_explicit(SoftBody& body, const ExplicitSettings& settings, const SoftKernels& kernels, Arena& arena,
                   TaskSystem& tasks) {
  const ArenaScope scope(arena);
  for (const HeldParticle& one : body.held) {
    const DVec3 way = one.place - body.particles.place(one.particle);
    body.particles.set_velocity(one.particle, to_float(way / double(settings.step)));
  }
  ExplicitStepper(body, settings, kernels, arena, tasks).run();
  place_held(body);
}

}  // namespace gyre
