#include "soft/solver/implicit_step.h"

#include "soft/body/enclosed_gas.h"
#include "soft/solver/body_system.h"
#include "soft/solver/rigid_modes.h"
#include "soft/solver/soft_pass.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

SoftPass make_pass(SoftBody& body, const ImplicitSettings& settings, Arena& arena) {
  SoftPass pass = begin_pass(body, arena);
  const std::size_t rows = std::size_t(padded_rows(body.particles.count));
  pass.spring_blocks = arena.make<float>(4 * body.springs.rows.places()).data();
  if (!body.continuum.empty()) {
    pass.full_blocks = arena.make<float>(9 * body.continuum.rows.places()).data();
    pass.edge_blocks = arena.make<float>(kEdgeFloats * (std::size_t(body.continuum.edges) + 1)).data();
  }
  pass.change = make_vectors(arena, rows);
  pass.residual = make_vectors(arena, rows);
  pass.direction = make_vectors(arena, rows);
  pass.product = make_vectors(arena, rows);
  for (float*& part : pass.diagonal) part = arena.make<float>(rows).data();
  for (float*& part : pass.inverse) part = arena.make<float>(rows).data();
  const float h = settings.step;
  pass.step = h;
  pass.gravity = settings.gravity;
  const bool middle = settings.scheme == ImplicitScheme::midpoint;
  pass.geometric_scale = middle ? 0.25f * h * h : h * h;
  pass.material_scale = pass.geometric_scale + (middle ? 0.5f : 1.0f) * h * body.damping;
  pass.velocity_scale = middle ? 2.0f : 1.0f;
  pass.move_scale = middle ? 0.5f : 1.0f;
  return pass;
}

// The change of velocity that is told beforehand: that of held particles.
void set_known_change(const SoftBody& body, const ImplicitSettings& settings, const SoftPass& pass) {
  const Particles& particles = body.particles;
  for (std::size_t i = 0; i < particles.x.size(); ++i)
    pass.change.x[i] = pass.change.y[i] = pass.change.z[i] = 0.0f;
  const double rate = 1.0 / double(settings.step);
  for (const HeldParticle& one : body.held) {
    const int i = one.particle;
    const Vec3 velocity = to_float(rate * (one.place - particles.place(i)));
    // The midpoint rule moves by the mean of both velocities.
    const Vec3 told = (1.0f / pass.move_scale) * (velocity - particles.velocity(i));
    pass.change.x[i] = told.x, pass.change.y[i] = told.y, pass.change.z[i] = told.z;
  }
}

// The first direction: the accelerations of the last sub-step, those of free fall in the first one.
void guess_direction(SoftBody& body, const ImplicitSettings& settings, const SoftPass& pass) {
  const Particles& particles = body.particles;
  const std::size_t rows = particles.x.size();
  const float fall[3] = {settings.gravity.x, settings.gravity.y, settings.gravity.z};
  float* const direction[3] = {pass.direction.x, pass.direction.y, pass.direction.z};
  const bool first = body.pull[0].size() != rows;
  for (int axis = 0; axis < 3; ++axis) {
    if (first) body.pull[axis].assign(rows, fall[axis]);
    for (std::size_t i = 0; i < rows; ++i) {
      direction[axis][i] = particles.loose[i] * settings.step * body.pull[axis][i];
    }
  }
}

void keep_pull(SoftBody& body, const ImplicitSettings& settings, const SoftPass& pass) {
  const float* const change[3] = {pass.change.x, pass.change.y, pass.change.z};
  const float rate = 1.0f / settings.step;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < body.pull[axis].size(); ++i) body.pull[axis][i] = rate * change[axis][i];
  }
}

// Goes along the direction that is there as far as pays, and begins anew from there. So a bad guess is no worse than none, and the energy
// that an early end leaves is at most that of not having solved at all.
double go_along_direction(BodySystem& system, const SoftKernels& kernels, double error) {
  const double curvature = system.apply(), slope = system.sum(kernels.match);
  if (curvature > 0.0 && absolute(slope) > 0.0)
    error = system.advance(float(slope / curvature));
  else
    error = system.advance(0.0f);
  system.turn(0.0f);
  return error;
}

ImplicitReport solve(SoftBody& body, const SoftPass& pass, const ImplicitSettings& settings, double mass,
                     const SoftKernels& kernels, TaskSystem& tasks) {
  BodySystem solver(pass, settings.carried, kernels, tasks);
  solver.each(kernels.start);
  double error = solver.sum(kernels.begin);
  const double start = error;
  guess_direction(body, settings, pass);
  error = go_along_direction(solver, kernels, error);
  const double fall = double(settings.rest_share) * double(settings.step) * double(length(settings.gravity));
  const double reference = start + mass * fall * fall;
  const double wanted = double(settings.tolerance) * double(settings.tolerance) * reference;
  ImplicitReport report;
  report.iterations = iterate(solver, error, wanted, settings.least_iterations, settings.most_iterations);
  report.residual = reference > 0.0 ? float(std::sqrt(error / reference)) : 0.0f;
  return report;
}

// Inertia that particles carry: in their blocks of the matrix, and as the impulse that brings them to its velocity.
void add_carried(SoftBody& body, const ImplicitSettings& settings, const SoftPass& pass) {
  Particles& p = body.particles;
  for (const CarriedInertia& one : settings.carried) {
    const int i = one.particle;
    const Sym3& m = one.inertia;
    const float parts[6] = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
    for (int k = 0; k < 6; ++k) pass.diagonal[k][i] += parts[k];
    const Vec3 force = (1.0f / settings.step) * momentum_to_target(one, p.velocity(i));
    p.fx[i] += force.x, p.fy[i] += force.y, p.fz[i] += force.z;
  }
}

// The push of an enclosed gas, what its pressure changes by as the volume does, and its part of the matrix.
void add_gas(const SoftBody& body, SoftPass& pass, Arena& arena) {
  if (body.gas.triangles.empty()) return;
  const std::size_t rows = body.particles.x.size();
  const std::span<Vec3> gradient = arena.make<Vec3>(rows);
  find_volume_gradient(body.particles, body.gas, gradient);
  const double volume = enclosed_volume(body.particles, body.gas.triangles);
  const double scale = double(pass.geometric_scale) * volume_stiffness(body.gas, volume);
  double growth =
      0.0;  // m^3/s, at the velocities that the sub-step begins with and what is told of their change
  const Particles& p = body.particles;
  for (std::size_t i = 0; i < rows; ++i) {
    const Vec3 known{pass.change.x[i], pass.change.y[i], pass.change.z[i]};
    growth += double(dot(gradient[i], known + pass.velocity_scale * Vec3{p.vx[i], p.vy[i], p.vz[i]}));
  }
  const float push = float(gauge_pressure(body.gas, volume) - scale / double(pass.step) * growth);
  for (std::size_t i = 0; i < rows; ++i) {
    const Vec3 force = push * gradient[i];
    pass.force.x[i] += force.x, pass.force.y[i] += force.y, pass.force.z[i] += force.z;
  }
  pass.volume_gradient = gradient.data();
  pass.volume_scale = float(scale);
}

// The impulses of gravity and of forces from outside in the sub-step.
void find_impulses(const Particles& particles, const ImplicitSettings& settings, const VectorRows& impulses) {
  const float h = settings.step;
  for (int i = 0; i < particles.count; ++i) {
    impulses.x[i] = h * (particles.mass[i] * settings.gravity.x + particles.fx[i]);
    impulses.y[i] = h * (particles.mass[i] * settings.gravity.y + particles.fy[i]);
    impulses.z[i] = h * (particles.mass[i] * settings.gravity.z + particles.fz[i]);
  }
}

void keep_momentum(const SoftBody& body, const ImplicitStep& step, const VectorRows& impulses,
                   const VectorRows& change, double ahead = 0.0) {
  if (step.carried.empty() && knows_rotations(body))
    return gyre::keep_momentum(body, impulses, change, ahead);
  keep_linear_momentum(body.particles, step.carried, impulses, change);
}

void change_velocities(Particles& particles, const VectorRows& change) {
  for (int i = 0; i < particles.count; ++i) {
    particles.vx[i] += change.x[i];
    particles.vy[i] += change.y[i];
    particles.vz[i] += change.z[i];
  }
}

}  // namespace

bool knows_rotations(const SoftBody& body) {
  return body.continuum.empty() || body.continuum.material.model != ElementModel::linear;
}

ImplicitStep begin_implicit(SoftBody& body, const ImplicitSettings& settings, const SoftKernels& kernels,
                            Arena& arena, TaskSystem& tasks) {
  ImplicitStep step;
  step.carried = settings.carried;
  step.pass = make_pass(body, settings, arena);
  set_known_change(body, settings, step.pass);
  linearize(step.pass, body, kernels, tasks);
  add_carried(body, settings, step.pass);
  add_gas(body, step.pass, arena);
  double mass = 0.0;
  for (int i = 0; i < body.particles.count; ++i) mass += double(body.particles.mass[i]);
  step.report = solve(body, step.pass, settings, mass, kernels, tasks);
  if (body.held.empty()) {
    find_impulses(body.particles, settings, step.pass.product);
    keep_momentum(body, step, step.pass.product, step.pass.change,
                  settings.is_stage ? double(settings.step) : 0.0);
  }
  keep_pull(body, settings, step.pass);
  change_velocities(body.particles, step.pass.change);
  return step;
}

Sym3 inverse_mass(const ImplicitStep& step, int particle) {
  const auto part = [&](int k) { return step.pass.inverse[k][particle]; };
  return {part(0), part(1), part(2), part(3), part(4), part(5)};
}

void finish_implicit(SoftBody& body, const ImplicitStep& step, const SoftKernels& kernels,
                     TaskSystem& tasks) {
  BodySystem(step.pass, {}, kernels, tasks).each(kernels.finish);
  place_held(body);
}

ImplicitReport step_implicit(SoftBody& body, const ImplicitSettings& settings, const SoftKernels& kernels,
                             Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  const ImplicitStep step = begin_implicit(body, settings, kernels, arena, tasks);
  finish_implicit(body, step, kernels, tasks);
  return step.report;
}

}  // namespace gyre
