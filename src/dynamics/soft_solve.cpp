#include "dynamics/soft_solve.h"

#include "dynamics/soft_forces.h"
#include "math/rotation.h"
#include "rigid/batch/solve_batch.h"

#include <cmath>

namespace gyre {

namespace {

// Rounds of a half-step, and sweeps over all contacts in each.
constexpr int kRounds = 2, kSweeps = 2;
// Rounds end when they would take less than this share of the energy that a fall in the half-step gives to the vertices in contact.
constexpr double kContactTolerance = 1.0e-3;
// Conjugate gradients on attachments: iterations at most, and the share of the energy of the error that is left.
constexpr int kAttachmentIterations = 8;
constexpr double kAttachmentTolerance = 1.0e-8;
// The share of an error of position that is removed in a half-step.
constexpr float kErrorShare = 0.2f;
// Largest speed of removal of penetration, as a share of the speed of a fall from the length of an edge: as for contacts of bodies.
constexpr float kSoftPushShare = 0.4f;
constexpr float kEarthGravity = 9.81f;  // m/s^2, where the world has none

SoftWork& work_of(SoftSolve& s, std::uint32_t member) { return *s.scratch->works[s.members[member]]; }
SoftEntry& entry_of(SoftSolve& s, std::uint32_t member) { return s.store->entries[s.members[member]]; }

// True if the motion of the body changes within the step.
bool moves(const RigidWorld& w, std::int32_t body) {
  return body >= 0 && is_simulated(w.bodies.flags[std::size_t(body)]);
}
bool yields(const RigidWorld& w, std::int32_t body) {
  return moves(w, body) && is_active(w, std::uint32_t(body));
}

// Where a point of a body is now; its place in world axes from the centre of mass when the step began is `from_body`.
Vec3 turned_now(const RigidWorld& w, std::int32_t body, Vec3 direction) {
  const std::size_t b = std::size_t(body);
  if (!moves(w, body)) return direction;
  const Quat start = w.bodies.poses[b].orientation;
  return rotate(w.bodies.orientations[b], rotate(conjugate(start), direction));
}
DVec3 center_now(const RigidWorld& w, std::int32_t body) {
  const std::size_t b = std::size_t(body);
  const DVec3 center = w.bodies.poses[b].center;
  return moves(w, body) ? center + DVec3(w.bodies.motion[b].delta_position) : center;
}
Quat orientation_now(const RigidWorld& w, std::int32_t body) {
  const std::size_t b = std::size_t(body);
  return moves(w, body) ? w.bodies.orientations[b] : w.bodies.poses[b].orientation;
}

// With what the body is still to get in this sub-step.
Vec3 velocity_of_body(const SoftSolve& s, const SoftRow& row) {
  if (row.touched < 0) return {};
  const VelocityChange& pending = s.scratch->pending[row.touched];
  return point_velocity(s.w->bodies.motion[std::size_t(row.body)], row.arm) + pending.linear +
         cross(pending.angular, row.arm);
}
// The index of a body that is touched and moves; -1 if it is none.
std::int32_t find_touched(const SoftScratch& scratch, std::int32_t body) {
  if (body < 0) return -1;
  const std::span<const std::uint32_t> touched = scratch.touched;
  std::size_t low = 0, high = touched.size();
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (touched[middle] <= std::uint32_t(body) ? low : high) = middle;
  }
  return std::int32_t(low);
}

void push_body(RigidWorld& w, const SoftRow& row, Vec3 impulse) {
  if (row.body < 0) return;
  BodyMotion& motion = w.bodies.motion[std::size_t(row.body)];
  const BodyInertia& inertia = w.bodies.inertia[std::size_t(row.body)];
  motion.linear_velocity += inertia.inverse_mass * impulse;
  motion.angular_velocity += inertia.inverse * cross(row.arm, impulse);
}

// The compliance of a point of a body: 1/m 1 + [r] I^-1 [r]^T.
Sym3 body_compliance(const RigidWorld& w, const SoftRow& row) {
  if (row.body < 0) return {};
  const BodyInertia& inertia = w.bodies.inertia[std::size_t(row.body)];
  const auto column = [&](Vec3 axis) {
    return inertia.inverse_mass * axis + cross(inertia.inverse * cross(row.arm, axis), row.arm);
  };
  const Vec3 x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
  return {x.x, y.y, z.z, x.y, x.z, y.z};
}

// ------------------------------------------------------------------------------------------------------- a half-step

// Vertices attached to what does not yield are where it takes them when the half-step ends.
void move_held(const SoftSolve& s, SoftEntry& entry) {
  const RigidWorld& w = *s.w;
  for (const SoftAttachment& one : entry.attachments) {
    if (yields(w, one.body)) continue;
    if (one.body == kWorldAnchor) {
      hold(entry.body, int(one.particle), one.place);
      continue;
    }
    const Vec3 arm = rotate(orientation_now(w, one.body), one.local);
    DVec3 place = center_now(w, one.body) + DVec3(arm);
    if (moves(w, one.body)) {
      const BodyMotion& motion = w.bodies.motion[std::size_t(one.body)];
      // The second term is the bend of the arc.
      const Vec3 spin = motion.angular_velocity, turn = cross(spin, arm);
      place += double(s.h) * DVec3(motion.linear_velocity + turn) +
               double(0.5f * s.h * s.h) * DVec3(cross(spin, turn));
    }
    hold(entry.body, int(one.particle), place);
  }
}

void add_forces_of_rows(SoftSolve& s, std::uint32_t member) {
  SoftWork& work = work_of(s, member);
  Particles& p = entry_of(s, member).body.particles;
  const float rate = 1.0f / s.h;
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
    const SoftRow& row = s.scratch->rows[k];
    const Vec3 force = rate * row.impulse;
    p.fx[row.particle] += force.x, p.fy[row.particle] += force.y, p.fz[row.particle] += force.z;
  }
}

// Where a particle is when the half-step begins. Explicit schemes have moved it.
DVec3 place_at_start(const SoftSolve& s, const SoftEntry& entry, const SoftWork& work,
                     std::uint32_t particle) {
  const Particles& p = entry.body.particles;
  const DVec3 now = p.place(int(particle));
  return work.step.method == SoftMethod::explicit_scheme
             ? now - double(s.h) * DVec3(p.velocity(int(particle)))
             : now;
}

void prepare_row(SoftSolve& s, SoftRow& row) {
  const RigidWorld& w = *s.w;
  const SoftEntry& entry = entry_of(s, row.member);
  const SoftWork& work = work_of(s, row.member);
  const DVec3 place = place_at_start(s, entry, work, row.particle);
  if (row.is_contact) {
    const SoftContact& contact = entry.contacts[row.source];
    row.normal = turned_now(w, contact.body, contact.normal);
    row.arm = turned_now(w, contact.body, contact.from_body);
    const DVec3 point = center_now(w, contact.body) + DVec3(row.arm);
    const float gap = dot(row.normal, difference(place, point)) - entry.radius;
    const float gravity = length(w.settings.gravity);
    const float most = kSoftPushShare * std::sqrt((gravity > 0.0f ? gravity : kEarthGravity) * entry.size);
    const float wanted = gap > 0.0f ? gap / s.h : max(kErrorShare * gap / s.h, -most);
    row.bias = wanted * row.normal - contact.surface_velocity;
  } else {
    const SoftAttachment& attachment = entry.attachments[row.source];
    row.arm = rotate(orientation_now(w, row.body), attachment.local);
    const DVec3 point = center_now(w, row.body) + DVec3(row.arm);
    row.bias = (kErrorShare / s.h) * difference(place, point);
  }
  row.particle_inverse = inverse_mass(entry, work.step, row.particle);
  row.compliance = row.particle_inverse + body_compliance(w, row);
  row.inverse = inverse(row.compliance);
}

// ------------------------------------------------------------------------------------------------------------- rows

// The impulse that a contact ends with: no pull, and friction within Coulomb's cone.
Vec3 project(const SoftRow& row, Vec3 impulse) {
  const float normal = dot(row.normal, impulse);
  if (!(normal > 0.0f)) return {};
  const Vec3 tangent = impulse - normal * row.normal;
  const float size = length(tangent);
  if (size <= row.static_friction * normal) return impulse;
  return normal * row.normal + (row.dynamic_friction * normal / size) * tangent;
}

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
  const Vec3 own = entry_of(s, row.member).body.particles.velocity(int(row.particle));
  return own - velocity_of_body(s, row) + row.bias;
}

// The change of the relative velocity by impulses that are tried.
Vec3 tried_change(SoftSolve& s, const SoftRow& row) {
  const Vec3 own = work_of(s, row.member).change[row.particle];
  if (row.touched < 0) return own;
  const VelocityChange& body = s.scratch->changes[row.touched];
  return own - (body.linear + cross(body.angular, row.arm));
}
void try_on_body(SoftSolve& s, const SoftRow& row, Vec3 impulse) {
  if (row.touched < 0) return;
  const BodyInertia& inertia = s.w->bodies.inertia[std::size_t(row.body)];
  VelocityChange& body = s.scratch->changes[row.touched];
  body.linear -= inertia.inverse_mass * impulse;
  body.angular -= inertia.inverse * cross(row.arm, impulse);
}

// Calls fn for each row of this kind, member by member.
template <class Fn>
void for_each_row(SoftSolve& s, bool contacts, Fn&& fn) {
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    const SoftWork& work = work_of(s, m);
    const std::uint32_t begin = contacts ? work.first_contact : work.first_row,
                        end = contacts ? work.last_row : work.first_contact;
    for (std::uint32_t k = begin; k < end; ++k) fn(s.scratch->rows[k]);
  }
}

void clear_tried(SoftSolve& s, bool contacts) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for_each_row(s, contacts, [&](const SoftRow& row) { work_of(s, row.member).change[row.particle] = {}; });
}

// Finds the changes of all vertices and touched bodies by the rows' steps.
void respond_to_steps(SoftSolve& s, bool contacts) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    const std::uint32_t begin = contacts ? work.first_contact : work.first_row,
                        end = contacts ? work.last_row : work.first_contact;
    if (begin == end) continue;
    for (Vec3& impulse : work.impulses) impulse = {};
    for (std::uint32_t k = begin; k < end; ++k) {
      const SoftRow& row = s.scratch->rows[k];
      work.impulses[row.particle] += row.step;
      try_on_body(s, row, row.step);
    }
    respond(entry_of(s, m), work.step, work.impulses.view(), work.change.view(), *s.kernels, work.arena,
            work.tasks);
  }
}

// Takes a share of the steps and of the changes that they make.
void take_steps(SoftSolve& s, bool contacts, float share) {
  for_each_row(s, contacts, [&](SoftRow& row) { row.impulse += share * row.step; });
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    const bool any = contacts ? work.first_contact != work.last_row : work.first_row != work.first_contact;
    if (any) add_change(entry_of(s, m), work.step, work.change.view(), share);
  }
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

// Conjugate gradients on the impulses of all attachments.
void solve_attachments(SoftSolve& s) {
  double norm = 0.0;
  for_each_row(s, false, [&](SoftRow& row) {
    row.error = error_of(s, row);
    row.direction = -(row.inverse * row.error);
    norm -= double(dot(row.direction, row.error));
  });
  const double wanted = kAttachmentTolerance * norm;
  for (int n = 0; n < kAttachmentIterations && norm > wanted; ++n) {
    for_each_row(s, false, [&](SoftRow& row) { row.step = row.direction; });
    respond_to_steps(s, false);
    double curvature = 0.0;
    for_each_row(s, false,
                 [&](const SoftRow& row) { curvature += double(dot(row.step, tried_change(s, row))); });
    if (!(curvature > 0.0)) return;
    const float share = float(norm / curvature);
    // Errors follow the change; the rounding of velocities does not get into them.
    for_each_row(s, false, [&](SoftRow& row) { row.error += share * tried_change(s, row); });
    take_steps(s, false, share);
    double next = 0.0;
    for_each_row(s, false,
                 [&](const SoftRow& row) { next += double(dot(row.error, row.inverse * row.error)); });
    const float turn = float(next / norm);
    for_each_row(s, false,
                 [&](SoftRow& row) { row.direction = turn * row.direction - row.inverse * row.error; });
    norm = next;
  }
}

void sweep_contacts(SoftSolve& s) {
  for_each_row(s, true, [&](SoftRow& row) {
    const Vec3 before = row.impulse + row.step;
    const Vec3 change = next_impulse(row, before, row.error + tried_change(s, row)) - before;
    if (change == Vec3{}) return;
    row.step += change;
    work_of(s, row.member).change[row.particle] += row.particle_inverse * change;
    try_on_body(s, row, change);
  });
}

// The energy that the steps take from the coupled system, to the first order.
double slope_of(SoftSolve& s) {
  double slope = 0.0;
  for_each_row(s, true, [&](const SoftRow& row) { slope -= double(dot(row.step, row.error)); });
  return slope;
}
// The share of the steps that is best, at most all of them: contacts would leave their cones.
float best_share(SoftSolve& s, double slope) {
  double curvature = 0.0;
  for_each_row(s, true,
               [&](const SoftRow& row) { curvature += double(dot(row.step, tried_change(s, row))); });
  if (!(slope > 0.0)) return 0.0f;
  return curvature > slope ? float(slope / curvature) : 1.0f;
}

// The kinetic energy of what a fall in the half-step gives to all soft matter that touches something.
double energy_of_fall(SoftSolve& s) {
  const double fall = double(s.h) * double(length(s.w->settings.gravity));
  double mass = 0.0;
  for_each_row(s, true, [&](const SoftRow& row) {
    mass += double(entry_of(s, row.member).body.particles.mass[row.particle]);
  });
  return mass * fall * fall;
}

void solve_contacts_in_rounds(SoftSolve& s) {
  const double wanted = kContactTolerance * energy_of_fall(s);
  for (int round = 0; round < kRounds; ++round) {
    for_each_row(s, true, [&](SoftRow& row) {
      row.step = {};
      row.error = error_of(s, row);
    });
    clear_tried(s, true);
    for (int n = 0; n < kSweeps; ++n) sweep_contacts(s);
    const double slope = slope_of(s);
    if (!(slope > wanted)) return;
    respond_to_steps(s, true);
    take_steps(s, true, best_share(s, slope));
  }
}

}  // namespace

void gather_soft(RigidWorld& w, SoftStore& store, SoftScratch& scratch) {
  scratch.slots.clear(), scratch.touched.clear();
  store.ids.for_each_live([&](std::uint32_t slot) {
    if (store.entries[slot].is_awake()) scratch.slots.push_back(slot);
  });
  while (scratch.works.size() < store.entries.size()) scratch.works.push_back(std::make_unique<SoftWork>());
  // Bodies are marked, and then listed in order.
  const auto touch = [&](std::int32_t body) {
    if (moves(w, body)) w.bodies.flags[std::size_t(body)].constraint_use = kPoseRead;
  };
  store.for_each([&](const SoftEntry& entry) {
    if (!entry.is_awake()) return;
    for (const SoftContact& contact : entry.contacts) touch(contact.body);
    for (const SoftAttachment& attachment : entry.attachments) touch(attachment.body);
  });
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use == kPoseRead) scratch.touched.push_back(body);
  }
}

void make_soft_rows(SoftSolve& s) {
  SoftScratch& scratch = *s.scratch;
  const RigidWorld& w = *s.w;
  scratch.rows.clear();
  scratch.changes.resize(scratch.touched.size()), scratch.pending.resize(scratch.touched.size());
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftEntry& entry = entry_of(s, m);
    SoftWork& work = work_of(s, m);
    const std::size_t padded = entry.body.particles.x.size();
    work.arena.reset();
    work.impulses.resize(padded), work.change.resize(padded);
    work.first_row = std::uint32_t(scratch.rows.size());
    for (std::uint32_t k = 0; k < entry.attachments.size(); ++k) {
      const SoftAttachment& one = entry.attachments[k];
      if (!yields(w, one.body)) continue;
      if (entry.body.particles.loose[one.particle] == 0.0f) let_go(entry.body, int(one.particle));
      SoftRow row;
      row.member = m, row.particle = one.particle, row.body = one.body, row.source = k;
      row.touched = find_touched(scratch, row.body);
      row.impulse = s.warm_scale * one.impulse;
      scratch.rows.push_back(row);
    }
    work.first_contact = std::uint32_t(scratch.rows.size());
    for (std::uint32_t k = 0; k < entry.contacts.size(); ++k) {
      const SoftContact& one = entry.contacts[k];
      SoftRow row;
      row.member = m, row.particle = one.particle, row.source = k, row.is_contact = true;
      row.body = moves(w, one.body) ? one.body : -1;
      row.touched = find_touched(scratch, row.body);
      row.static_friction = one.static_friction, row.dynamic_friction = one.dynamic_friction;
      row.normal = one.normal, row.arm = one.from_body;
      row.impulse = s.warm_scale * project(row, one.impulse);
      scratch.rows.push_back(row);
    }
    work.last_row = std::uint32_t(scratch.rows.size());
  }
}

void begin_soft_members(SoftSolve& s, int begin, int end) {
  for (std::uint32_t m = std::uint32_t(begin); m < std::uint32_t(end); ++m) {
    SoftEntry& entry = entry_of(s, m);
    SoftWork& work = work_of(s, m);
    work.mark = work.arena.mark();
    move_held(s, entry);
    set_field_forces(*s.w, entry, s.time, s.h);
    add_forces_of_rows(s, m);
    work.step = begin_soft_step(entry, {s.h, s.w->settings.gravity}, *s.kernels, work.arena, work.tasks);
  }
}

void warm_start_soft_rows(SoftSolve& s, int, int) {
  for (SoftRow& row : s.scratch->rows) {
    if (row.body < 0) continue;
    if (!row.is_contact) {
      const SoftAttachment& attachment = entry_of(s, row.member).attachments[row.source];
      row.arm = rotate(orientation_now(*s.w, row.body), attachment.local);
    }
    push_body(*s.w, row, (-1.0f / float(s.parts)) * row.impulse);
  }
}

void solve_soft_rows(SoftSolve& s, int, int) {
  if (s.scratch->rows.empty()) return;
  for (VelocityChange& pending : s.scratch->pending) pending = {};
  for (SoftRow& row : s.scratch->rows) prepare_row(s, row);
  bool any_attached = false, any_contact = false;
  for (const SoftRow& row : s.scratch->rows) (row.is_contact ? any_contact : any_attached) = true;
  if (any_attached) solve_attachments(s);
  if (any_contact) solve_contacts_in_rounds(s);
}

void finish_soft_members(SoftSolve& s, int begin, int end) {
  for (std::uint32_t m = std::uint32_t(begin); m < std::uint32_t(end); ++m) {
    SoftEntry& entry = entry_of(s, m);
    SoftWork& work = work_of(s, m);
    finish_soft_step(entry, work.step, *s.kernels, work.tasks);
    work.arena.release(work.mark);
  }
}

void keep_soft_rows(SoftSolve& s) {
  for (const SoftRow& row : s.scratch->rows) {
    SoftEntry& entry = entry_of(s, row.member);
    (row.is_contact ? entry.contacts[row.source].impulse : entry.attachments[row.source].impulse) =
        row.impulse;
  }
}

}  // namespace gyre
