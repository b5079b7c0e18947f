#include "dynamics/soft/soft_rounds.h"

#include <cmath>

namespace gyre {

namespace {

// Rounds of a half-step, and sweeps over all contacts in each.
constexpr int kRounds = 2, kSweeps = 2;
// Rounds end when they would take less than this share of the energy that a fall in the half-step gives to the vertices in contact.
constexpr double kContactTolerance = 1.0e-3;
// Friction below this share of what sliding gives sticks; so does more than the inverse, which only static friction gives.
constexpr float kStickShare = 0.999f;
// A contact that slides faster than this many times what gravity gives in the sub-step does not stick, however small its friction is: the load may just have
// grown. With 3 a block of 4 cm and 1 MPa slides down a slope too slowly.
constexpr float kStickSpeedShare = 1.0f;

}  // namespace

Vec3 project(const SoftRow& row, Vec3 impulse) {
  const float normal = dot(row.normal, impulse);
  if (!(normal > 0.0f)) return {};
  const Vec3 tangent = impulse - normal * row.normal;
  const float size = length(tangent);
  // A contact that slides is held by dynamic friction alone, else it would creep up to the static one and fall back.
  const float bound = row.grip == SoftGrip::slides ? row.dynamic_friction : row.static_friction;
  if (size <= bound * normal) return impulse;
  return normal * row.normal + (row.dynamic_friction * normal / size) * tangent;
}

namespace {

// The new impulse of a contact, from its error.
Vec3 next_impulse(const SoftRow& row, Vec3 impulse, Vec3 error) {
  // Along the normal first, so that friction has its bound; then the rest.
  const float stiff = dot(row.normal, row.compliance * row.normal);
  if (!(stiff > 0.0f)) return impulse;
  const float before = dot(row.normal, impulse);
  const float after = max(before - dot(row.normal, error) / stiff, 0.0f);
  if (!(after > 0.0f)) return {};
  const Vec3 with_normal = impulse + (after - before) * row.normal;
  const Vec3 slide = error + (after - before) * (row.compliance * row.normal);
  const Vec3 across = slide - dot(row.normal, slide) * row.normal;
  // The sum of both tangential compliances, which is safe for each of them.
  const float sideways = row.compliance.xx + row.compliance.yy + row.compliance.zz - stiff;
  if (!(sideways > 0.0f)) return project(row, with_normal);
  return project(row, with_normal - (1.0f / sideways) * across);
}

Vec3 error_of(SoftSolve& s, const SoftRow& row) {
  const Particles& p = entry_of(s, row.member).body.particles;
  return p.velocity(int(row.particle)) - velocity_of_body(s, row) + row.bias;
}

// The change of the relative velocity by impulses that are tried.
Vec3 tried_change(SoftSolve& s, const SoftRow& row) {
  const Vec3 own = work_of(s, row.member).change[row.particle];
  if (row.touched < 0) return own;
  const VelocityChange& body = s.scratch->changes[row.touched];
  return own - (body.linear + cross(body.angular, row.arm));
}

void clear_tried(SoftSolve& s) {
  clear_changes(s);
  for (const SoftRow& row : s.scratch->rows) {
    if (!row.coupled) work_of(s, row.member).change[row.particle] = {};
  }
}

// True if a member has rows here: a rope that touches something or is attached.
bool has_rows(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  return work.first_row != work.last_row && is_exact_rope(entry_of(s, member));
}

// Finds the changes of all vertices and touched bodies by the rows' steps.
void respond_to_steps(SoftSolve& s) {
  clear_changes(s);
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (!has_rows(s, m)) continue;
    for (Vec3& impulse : work.impulses) impulse = {};
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
      const SoftRow& row = s.scratch->rows[k];
      work.impulses[row.particle] += row.step;
      try_on_body(s, row, row.step);
    }
    SoftBody& body = entry_of(s, m).body;
    const std::size_t count = std::size_t(body.particles.count);
    respond_rope(body, work.step.rope, work.impulses.view().first(count), work.change.view().first(count));
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
      SoftRow& row = s.scratch->rows[k];
      if (row.carried < 0) continue;
      row.carried_step = -(s.scratch->carried[row.carried].inertia * work.change[row.particle]);
      try_on_body(s, row, row.carried_step);
    }
  }
}

}  // namespace

void clear_changes(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
}

void try_on_body(SoftSolve& s, const SoftRow& row, Vec3 impulse) {
  if (row.touched < 0 || !row.pushes) return;
  const BodyInertia& inertia = s.w->bodies.inertia[std::size_t(row.body)];
  VelocityChange& body = s.scratch->changes[row.touched];
  body.linear -= inertia.inverse_mass * along_free_axes(inertia, impulse);
  body.angular -= inertia.inverse * cross(row.arm, impulse);
}

void change_bodies(SoftSolve& s, float share) {
  for (std::size_t k = 0; k < s.scratch->touched.size(); ++k) {
    BodyMotion& motion = s.w->bodies.motion[s.scratch->touched[k]];
    const Vec3 linear = share * s.scratch->changes[k].linear, angular = share * s.scratch->changes[k].angular;
    const float now = 1.0f / float(s.parts);
    motion.linear_velocity += now * linear;
    motion.angular_velocity += now * angular;
    VelocityChange& pending = s.scratch->pending[k];
    pending.linear += (1.0f - now) * linear, pending.angular += (1.0f - now) * angular;
  }
}

namespace {

// Takes a share of the steps and of the changes that they make.
void take_steps(SoftSolve& s, float share) {
  for (SoftRow& row : s.scratch->rows) {
    if (row.coupled || !is_exact_rope(entry_of(s, row.member))) continue;
    row.impulse += share * row.step;
    if (row.carried >= 0) row.impulse += share * row.carried_step;
  }
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (has_rows(s, m)) add_change(entry_of(s, m), work.step, work.change.view(), share);
  }
  change_bodies(s, share);
}

}  // namespace

void give_to_bodies(SoftSolve& s) {
  clear_changes(s);
  for (SoftRow& row : s.scratch->rows) {
    if (row.carried < 0) continue;
    try_on_body(s, row, row.carried_step);
    row.impulse += row.carried_step;
  }
  change_bodies(s, 1.0f);
}

void set_grips(SoftSolve& s) {
  const float slow = kStickSpeedShare * s.h * reference_gravity(s.w->settings);
  for (std::uint32_t& grips : s.scratch->grips) grips = 0;
  for (SoftRow& row : s.scratch->rows) {
    if (row.is_contact() && !row.coupled) {
      const float normal = dot(row.normal, row.impulse);
      const float across = length(row.impulse - normal * row.normal);
      const float sliding = row.dynamic_friction * normal;
      const Vec3 speed = error_of(s, row);
      const bool is_slow = length(speed - dot(row.normal, speed) * row.normal) <= slow;
      // Friction between both bounds is static; beyond, a carried part has it, which the cone does not bind.
      const bool is_static = across * kStickShare > sliding && across <= row.static_friction * normal;
      const bool is_within = row.grip == SoftGrip::sticks
                                 ? across <= row.static_friction * normal
                                 : is_slow && (across <= kStickShare * sliding || is_static);
      row.grip = !(normal > 0.0f) ? SoftGrip::open : is_within ? SoftGrip::sticks : SoftGrip::slides;
    }
    if (row.touched >= 0 && row.pushes && holds(row)) ++s.scratch->grips[row.touched];
  }
}

namespace {

void sweep_contacts(SoftSolve& s) {
  for (SoftRow& row : s.scratch->rows) {
    if (!row.is_contact() || row.coupled) continue;
    const Vec3 before = row.impulse + row.step;
    const Vec3 change = next_impulse(row, before, row.error + tried_change(s, row)) - before;
    if (change == Vec3{}) continue;
    row.step += change;
    work_of(s, row.member).change[row.particle] += row.particle_inverse * change;
    try_on_body(s, row, change);
  }
}

// The energy that the steps take from the coupled system, to the first order.
double slope_of(SoftSolve& s) {
  double slope = 0.0;
  for (const SoftRow& row : s.scratch->rows)
    if (!row.coupled) slope -= double(dot(row.step, row.error));
  return slope;
}
// The share of the steps that is best, at most all of them: contacts would leave their cones.
float best_share(SoftSolve& s, double slope) {
  double curvature = 0.0;
  for (const SoftRow& row : s.scratch->rows)
    if (!row.coupled) curvature += double(dot(row.step, tried_change(s, row)));
  if (!(slope > 0.0)) return 0.0f;
  return curvature > slope ? float(slope / curvature) : 1.0f;
}

// The kinetic energy of what a fall in the half-step gives to all soft matter that touches something.
double energy_of_fall(SoftSolve& s) {
  const double fall = double(s.h) * double(length(s.w->settings.gravity));
  double mass = 0.0;
  for (const SoftRow& row : s.scratch->rows) {
    if (!row.coupled) mass += double(entry_of(s, row.member).body.particles.mass[row.particle]);
  }
  return mass * fall * fall;
}

}  // namespace

void solve_contacts_in_rounds(SoftSolve& s) {
  const double wanted = kContactTolerance * energy_of_fall(s);
  for (int round = 0; round < kRounds; ++round) {
    for (SoftRow& row : s.scratch->rows) {
      row.step = {};
      if (!row.coupled) row.error = error_of(s, row);
    }
    clear_tried(s);
    for (int n = 0; n < kSweeps; ++n) sweep_contacts(s);
    const double slope = slope_of(s);
    if (!(slope > wanted)) return;
    respond_to_steps(s);
    take_steps(s, best_share(s, slope));
  }
}

}  // namespace gyre
