#include "soft/solver/soft_step.h"

#include "soft/solver/explicit_step.h"
#include "soft/solver/rigid_modes.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/visual_step.h"

namespace gyre {

namespace {

// Iterations of Newton's for ropes, whose tension differs between the stages of a scheme.
constexpr int kStageIterations = 3;
// Of the change that gravity makes in a sub-step, against which errors of cloths are measured at least. With the whole of it a cloth that hangs still wanders, since
// errors of 1 % of its weight are alike from sub-step to sub-step: a strip of 10 cm by 5 % of its drop. With none of it iterations go on at rest until they are
// spent. Solids have the whole: plates that break gain up to 9 % of their energy from contacts with a tenth, and up to 2 % so.
constexpr float kClothRestShare = 0.1f;

ExplicitScheme scheme_of(SoftIntegrator integrator) {
  switch (integrator) {
    case SoftIntegrator::explicit_euler:
      return ExplicitScheme::explicit_euler;
    case SoftIntegrator::rk4:
      return ExplicitScheme::rk4;
    case SoftIntegrator::verlet:
      return ExplicitScheme::verlet;
    default:
      return ExplicitScheme::semi_implicit_euler;
  }
}

Sym3 explicit_inverse_mass(const Particles& p, const SoftStep& step, int particle) {
  const float mass = p.mass[particle];
  Sym3 inertia{mass, mass, mass, 0.0f, 0.0f, 0.0f};
  bool carries = false;
  for (const CarriedInertia& one : step.carried) {
    if (one.particle != particle) continue;
    inertia = inertia + one.inertia;
    carries = true;
  }
  if (carries) return inverse(inertia);
  return {1.0f / mass, 1.0f / mass, 1.0f / mass, 0.0f, 0.0f, 0.0f};
}

// An explicit scheme has moved its particles as if they carried nothing.
void carry_explicitly(SoftEntry& entry, const SoftStep& step, Arena& arena) {
  const ArenaScope scope(arena);
  Particles& p = entry.body.particles;
  // A particle may carry several, which act together.
  const std::span<Vec3> pushes = arena.make<Vec3>(step.carried.size());
  for (std::size_t k = 0; k < pushes.size(); ++k)
    pushes[k] = momentum_to_target(step.carried[k], p.velocity(step.carried[k].particle));
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const int i = step.carried[k].particle;
    const Vec3 change = explicit_inverse_mass(p, step, i) * pushes[k];
    p.set_velocity(i, p.velocity(i) + change);
    p.set_place(i, p.place(i) + double(step.h) * DVec3(change));
  }
}

// A step of backward Euler, of a rope or of anything else.
void begin_implicit_step(SoftEntry& entry, const SoftStepSettings& settings, bool is_stage, SoftStep& step,
                         const SoftKernels& kernels, Arena& arena, TaskSystem& tasks) {
  if (entry.kind == SoftKind::rope) {
    step.method = SoftMethod::rope;
    step.rope = begin_rope(entry.body,
                           {.step = settings.step,
                            .gravity = settings.gravity,
                            .least_iterations = is_stage ? kStageIterations : 1,
                            .carried = settings.carried},
                           arena);
    return;
  }
  step.method = SoftMethod::conjugate_gradients;
  ImplicitSettings implicit;
  implicit.step = settings.step;
  implicit.gravity = settings.gravity;
  implicit.carried = settings.carried;
  implicit.is_stage = is_stage;
  if (entry.kind == SoftKind::cloth) implicit.rest_share = kClothRestShare;
  step.implicit = begin_implicit(entry.body, implicit, kernels, arena, tasks);
}

void begin_two_stages(SoftEntry& entry, const SoftStepSettings& settings, SoftStep& step,
                      const SoftKernels& kernels, Arena& arena, TaskSystem& tasks) {
  SoftStepSettings stage = settings;
  stage.step = float(kSdirkShare * double(settings.step));
  step.stages = begin_sdirk(entry.body, settings.carried, arena);
  {
    const ArenaScope scope(arena);
    begin_implicit_step(entry, stage, true, step, kernels, arena, tasks);
    if (entry.kind == SoftKind::rope) finish_rope(entry.body, step.rope);
    if (entry.kind != SoftKind::rope) finish_implicit(entry.body, step.implicit, kernels, tasks);
  }
  turn_sdirk(entry.body, step.stages);
  stage.carried = step.stages.carried;
  begin_implicit_step(entry, stage, true, step, kernels, arena, tasks);
  step.rope.move = double(settings.step);
  if (entry.kind == SoftKind::rope)
    keep_lengths(entry.body,
                 {.step = settings.step, .gravity = settings.gravity, .carried = settings.carried}, step.rope,
                 arena);
  end_sdirk(entry.body, step.stages);
}

// True if the sub-step turns the body along arcs: a solid whose law knows rotations, of which nothing is held. Along tangents it would be stretched by its own turning.
bool turns_along_arcs(const SoftEntry& entry, const SoftStep& step) {
  return entry.kind == SoftKind::solid && entry.body.continuum.material.model != ElementModel::linear &&
         entry.body.held.empty() && step.stages.empty();
}

}  // namespace

SoftStep begin_soft_step(SoftEntry& entry, const SoftStepSettings& settings, const SoftKernels& kernels,
                         Arena& arena, TaskSystem& tasks) {
  SoftStep step;
  step.h = settings.step;
  step.carried = settings.carried;
  const SoftIntegrator integrator = entry.settings().integrator;
  if (!is_implicit(integrator)) {
    step.method = SoftMethod::explicit_scheme;
    if (integrator == SoftIntegrator::visual) step_visual(entry.body, settings.step, settings.gravity, arena);
    if (integrator != SoftIntegrator::visual)
      step_explicit(entry.body, {settings.step, settings.gravity, scheme_of(integrator)}, kernels, arena,
                    tasks);
    carry_explicitly(entry, step, arena);
    return step;
  }
  // Impulses of contacts come as jumps, which the second stage would carry beyond where they lead.
  const bool has_stages = integrator == SoftIntegrator::sdirk2 && !settings.touches;
  if (has_stages) begin_two_stages(entry, settings, step, kernels, arena, tasks);
  if (!has_stages) {
    if (turns_along_arcs(entry, step)) add_turning_forces(entry.body);
    begin_implicit_step(entry, settings, false, step, kernels, arena, tasks);
  }
  if (step.method == SoftMethod::rope && settings.asks_for_inverse_masses)
    find_rope_inverse_masses(step.rope, arena);
  return step;
}

Sym3 inverse_mass(const SoftEntry& entry, const SoftStep& step, std::uint32_t particle) {
  const Particles& p = entry.body.particles;
  if (p.loose[particle] == 0.0f) return {};
  if (step.method == SoftMethod::rope) return step.rope.inverse[particle];
  if (step.method == SoftMethod::conjugate_gradients) return inverse_mass(step.implicit, int(particle));
  return explicit_inverse_mass(p, step, int(particle));
}

void add_change(SoftEntry& entry, SoftStep& step, std::span<const Vec3> change, float scale) {
  Particles& p = entry.body.particles;
  const std::size_t count = std::size_t(p.count);
  if (step.method == SoftMethod::rope)
    return add_rope_change(entry.body, step.rope, change.first(count), double(scale));
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 own = scale * change[i];
    p.set_velocity(int(i), p.velocity(int(i)) + own);
    if (step.method != SoftMethod::explicit_scheme) continue;
    // An explicit step has moved its particles already.
    const DVec3 moved = double(step.h) * DVec3(own);
    p.set_place(int(i), p.place(int(i)) + moved);
    Array<double>(&kept)[3] = entry.body.moved;
    if (!kept[0].empty()) kept[0][i] += moved.x, kept[1][i] += moved.y, kept[2][i] += moved.z;
  }
}

void finish_soft_step(SoftEntry& entry, SoftStep& step, const SoftKernels& kernels, TaskSystem& tasks) {
  if (step.method == SoftMethod::rope) finish_rope(entry.body, step.rope);
  if (step.method == SoftMethod::conjugate_gradients) {
    const bool turns = turns_along_arcs(entry, step);
    ByPiece<RigidMotion> motions;
    if (turns) motions = rigid_motions(entry.body, double(step.h));
    finish_implicit(entry.body, step.implicit, kernels, tasks);
    if (turns) turn_along_arcs(entry.body, motions, double(step.h));
    if (!step.stages.empty()) move_by_impulses(entry.body, step.stages, double(step.h));
  }
}

}  // namespace gyre
