#include "dynamics/soft/soft_rounds.h"

#include <cmath>

namespace gyre {

namespace {

// Rounds of a half-step, and sweeps over all contacts in each.
constexpr int kRounds = 2, kSweeps = 2;
// Rounds end when they would take less than this share of the energy that a fall in the half-step gives to the vertices in contact.
constexpr double kContactTolerance = 1.0e-3;
// Bodies press from opposite sides if the cosine between their normals is lower.
constexpr float kOpposite = -0.5f;
constexpr std::uint32_t kNotPressed = 0xffffffffu;
// A contact that still closes faster than this share of what gravity gives in the sub-step is not met.
constexpr float kUnmetShare = 1.0f;
// The bound of an impulse that has none, N s.
constexpr float kAnyImpulse = 1.0e30f;
// A vertex that began inside a shape is pushed out by no more than so many times its weight. More would press a stiff solid out of shape where its vertices are nearest to different sides of the shape.
constexpr float kEmergeWeights = 5.0f;
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

// The largest impulse along the normal.
float most_impulse(SoftSolve& s, const SoftRow& row) {
  if (row.grip != SoftGrip::emerges) return kAnyImpulse;
  return kEmergeWeights * s.h * reference_gravity(s.w->settings) *
         entry_of(s, row.member).body.particles.mass[row.particle];
}

// The new impulse of a contact, from its error.
Vec3 next_impulse(const SoftRow& row, Vec3 impulse, Vec3 error, float most) {
  // Along the normal first, so that friction has its bound; then the rest.
  const float stiff = dot(row.normal, row.compliance * row.normal);
  if (!(stiff > 0.0f)) return impulse;
  const float before = dot(row.normal, impulse);
  const float after = min(max(before - dot(row.normal, error) / stiff, 0.0f), most);
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
  const Vec3 own = mean_of(row, [&](std::uint32_t v) { return p.velocity(int(v)); });
  return own - velocity_of_body(s, row) + row.bias;
}

// The change of the relative velocity by impulses that are tried.
Vec3 tried_change(SoftSolve& s, const SoftRow& row) {
  const Array<Vec3>& change = work_of(s, row.member).change;
  const Vec3 own = mean_of(row, [&](std::uint32_t v) { return change[v]; });
  if (row.touched < 0) return own;
  const VelocityChange& body = s.scratch->changes[row.touched];
  return own - (body.linear + cross(body.angular, row.arm));
}
template <class Row>
void try_on_body(SoftSolve& s, const Row& row, Vec3 impulse) {
  if (row.touched < 0 || !row.pushes) return;
  const BodyInertia& inertia = s.w->bodies.inertia[std::size_t(row.body)];
  VelocityChange& body = s.scratch->changes[row.touched];
  body.linear -= inertia.inverse_mass * impulse;
  body.angular -= inertia.inverse * cross(row.arm, impulse);
}

void clear_tried(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (const SoftRow& row : s.scratch->rows) {
    Array<Vec3>& change = work_of(s, row.member).change;
    for_each_vertex(row, [&](std::uint32_t v, float) { change[v] = {}; });
  }
}

// Finds the changes of all vertices and touched bodies by the rows' steps.
void respond_to_steps(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (work.first_row == work.last_row) continue;
    for (Vec3& impulse : work.impulses) impulse = {};
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
      const SoftRow& row = s.scratch->rows[k];
      for_each_vertex(row, [&](std::uint32_t v, float weight) { work.impulses[v] += weight * row.step; });
      try_on_body(s, row, row.step);
    }
    respond(entry_of(s, m), work.step, work.impulses.view(), work.change.view(), *s.kernels, work.arena,
            *s.tasks);
    for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
      SoftRow& row = s.scratch->rows[k];
      if (row.carried < 0) continue;
      row.carried_step = -(s.scratch->carried[row.carried].inertia * work.change[row.particle]);
      try_on_body(s, row, row.carried_step);
    }
  }
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

// Takes a share of the steps and of the changes that they make.
void take_steps(SoftSolve& s, float share) {
  for (SoftRow& row : s.scratch->rows) {
    row.impulse += share * row.step;
    if (row.carried >= 0) row.impulse += share * row.carried_step;
  }
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (work.first_row != work.last_row) add_change(entry_of(s, m), work.step, work.change.view(), share);
  }
  change_bodies(s, share);
}

}  // namespace

void give_to_bodies(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (SoftRow& row : s.scratch->rows) {
    if (row.carried < 0) continue;
    try_on_body(s, row, row.carried_step);
    row.impulse += row.carried_step;
  }
  change_bodies(s, 1.0f);
}

namespace {

// A contact with a body that does not yield.
bool is_unyielding(const SoftRow& row) { return row.is_contact && row.body_compliance == Sym3{}; }

// True if bodies that do not yield press a vertex from opposite sides and one of them is not met.
bool is_squeezed(SoftSolve& s, std::span<const SoftRow> rows, SoftWork& work) {
  const float most = kUnmetShare * s.h * reference_gravity(s.w->settings);
  work.pressed.assign(work.impulses.size(), kNotPressed);
  bool squeezed = false;
  for (std::uint32_t k = 0; k < std::uint32_t(rows.size()) && !squeezed; ++k) {
    const SoftRow& row = rows[k];
    if (!is_unyielding(row)) continue;
    for_each_vertex(row, [&](std::uint32_t v, float) {
      if (work.pressed[v] == kNotPressed) {
        work.pressed[v] = k;
        return;
      }
      const SoftRow& other = rows[work.pressed[v]];
      if (dot(row.normal, other.normal) > kOpposite) return;
      squeezed = squeezed || dot(row.normal, error_of(s, row)) < -most ||
                 dot(other.normal, error_of(s, other)) < -most;
    });
  }
  return squeezed;
}

}  // namespace

void forget_squeezes(SoftSolve& s) {
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (work.first_row == work.last_row) continue;
    const std::span<SoftRow> rows =
        std::span(s.scratch->rows).subspan(work.first_row, work.last_row - work.first_row);
    if (rows.front().pushes && !is_squeezed(s, rows, work)) continue;
    for (SoftRow& row : rows)
      if (is_unyielding(row)) row.impulse = {};
  }
}

void set_grips(SoftSolve& s) {
  const float slow = kStickSpeedShare * s.h * reference_gravity(s.w->settings);
  for (std::uint32_t& grips : s.scratch->grips) grips = 0;
  for (SoftRow& row : s.scratch->rows) {
    if (row.is_contact && !row.is_face && row.grip != SoftGrip::emerges) {
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

// The change of the row's own vertices by an impulse, with the block of each.
void add_own_change(SoftSolve& s, const SoftRow& row, Vec3 impulse) {
  SoftWork& work = work_of(s, row.member);
  if (!row.is_face) {
    work.change[row.particle] += row.particle_inverse * impulse;
    return;
  }
  for_each_vertex(row, [&](std::uint32_t v, float weight) {
    work.change[v] += inverse_mass(entry_of(s, row.member), work.step, v) * (weight * impulse);
  });
}

void sweep_contacts(SoftSolve& s) {
  for (SoftRow& row : s.scratch->rows) {
    if (!row.is_contact) continue;
    const Vec3 before = row.impulse + row.step;
    const Vec3 change =
        next_impulse(row, before, row.error + tried_change(s, row), most_impulse(s, row)) - before;
    if (change == Vec3{}) continue;
    row.step += change;
    add_own_change(s, row, change);
    try_on_body(s, row, change);
  }
}

// The energy that the steps take from the coupled system, to the first order.
double slope_of(SoftSolve& s) {
  double slope = 0.0;
  for (const SoftRow& row : s.scratch->rows) slope -= double(dot(row.step, row.error));
  return slope;
}
// The share of the steps that is best, at most all of them: contacts would leave their cones.
float best_share(SoftSolve& s, double slope) {
  double curvature = 0.0;
  for (const SoftRow& row : s.scratch->rows) curvature += double(dot(row.step, tried_change(s, row)));
  if (!(slope > 0.0)) return 0.0f;
  return curvature > slope ? float(slope / curvature) : 1.0f;
}

// The kinetic energy of what a fall in the half-step gives to all soft matter that touches something.
double energy_of_fall(SoftSolve& s) {
  const double fall = double(s.h) * double(length(s.w->settings.gravity));
  double mass = 0.0;
  for (const SoftRow& row : s.scratch->rows) {
    const Particles& p = entry_of(s, row.member).body.particles;
    for_each_vertex(row, [&](std::uint32_t v, float weight) { mass += double(weight) * double(p.mass[v]); });
  }
  return mass * fall * fall;
}

}  // namespace

void solve_contacts_in_rounds(SoftSolve& s) {
  const double wanted = kContactTolerance * energy_of_fall(s);
  for (int round = 0; round < kRounds; ++round) {
    for (SoftRow& row : s.scratch->rows) {
      row.step = {};
      row.error = error_of(s, row);
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
