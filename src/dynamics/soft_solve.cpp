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
template <class Row>
Vec3 velocity_of_body(const SoftSolve& s, const Row& row) {
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

template <class Row>
void push_body(RigidWorld& w, const Row& row, Vec3 impulse) {
  if (row.body < 0) return;
  BodyMotion& motion = w.bodies.motion[std::size_t(row.body)];
  const BodyInertia& inertia = w.bodies.inertia[std::size_t(row.body)];
  motion.linear_velocity += inertia.inverse_mass * impulse;
  motion.angular_velocity += inertia.inverse * cross(row.arm, impulse);
}

// The compliance of a point of a body: 1/m 1 + [r] I^-1 [r]^T.
template <class Row>
Sym3 body_compliance(const RigidWorld& w, const Row& row) {
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

void add_force(Particles& p, std::uint32_t i, Vec3 force) {
  p.fx[i] += force.x, p.fy[i] += force.y, p.fz[i] += force.z;
}

void add_forces_of_rows(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  Particles& p = entry_of(s, member).body.particles;
  const float rate = 1.0f / s.h;
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k)
    add_force(p, s.scratch->rows[k].particle, rate * s.scratch->rows[k].impulse);
}

// Gives attached vertices their part of the inertia of their bodies. Its velocity is that of the point of the body, and what removes a part of
// the distance.
void carry(SoftSolve& s, std::uint32_t member) {
  const RigidWorld& w = *s.w;
  const SoftWork& work = work_of(s, member);
  Particles& p = entry_of(s, member).body.particles;
  const float rate = 1.0f / s.h;
  for (std::uint32_t k = work.first_joint; k < work.last_joint; ++k) {
    SoftJoint& joint = s.scratch->joints[k];
    const SoftAttachment& attachment = entry_of(s, member).attachments[joint.source];
    joint.arm = rotate(orientation_now(w, joint.body), attachment.local);
    const DVec3 point = center_now(w, joint.body) + DVec3(joint.arm);
    const Vec3 apart = difference(point, p.place(int(joint.particle)));
    const float part = 1.0f / float(s.scratch->held[joint.touched]);
    s.scratch->carried[k] = {std::int32_t(joint.particle), part * inverse(body_compliance(w, joint)),
                             velocity_of_body(s, joint) + (kErrorShare * rate) * apart};
    add_force(p, joint.particle, rate * joint.impulse);
  }
}
// The momentum that the carried parts have gained.
void find_joint_steps(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  const Particles& p = entry_of(s, member).body.particles;
  for (std::uint32_t k = work.first_joint; k < work.last_joint; ++k) {
    const CarriedInertia& carried = s.scratch->carried[k];
    s.scratch->joints[k].step = carried.inertia * (carried.target - p.velocity(carried.particle));
  }
}
std::span<const CarriedInertia> carried_by(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  return s.scratch->carried.view().subspan(work.first_joint, work.last_joint - work.first_joint);
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
  const SoftContact& contact = entry.contacts[row.source];
  row.normal = turned_now(w, contact.body, contact.normal);
  row.arm = turned_now(w, contact.body, contact.from_body);
  const DVec3 point = center_now(w, contact.body) + DVec3(row.arm);
  const float gap =
      dot(row.normal, difference(place_at_start(s, entry, work, row.particle), point)) - entry.radius;
  const float gravity = length(w.settings.gravity);
  const float most = kSoftPushShare * std::sqrt((gravity > 0.0f ? gravity : kEarthGravity) * entry.size);
  const float wanted = gap > 0.0f ? gap / s.h : max(kErrorShare * gap / s.h, -most);
  row.bias = wanted * row.normal - contact.surface_velocity;
  row.particle_inverse = inverse_mass(entry, work.step, row.particle);
  row.compliance = row.particle_inverse + body_compliance(w, row);
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
template <class Row>
void try_on_body(SoftSolve& s, const Row& row, Vec3 impulse) {
  if (row.touched < 0) return;
  const BodyInertia& inertia = s.w->bodies.inertia[std::size_t(row.body)];
  VelocityChange& body = s.scratch->changes[row.touched];
  body.linear -= inertia.inverse_mass * impulse;
  body.angular -= inertia.inverse * cross(row.arm, impulse);
}

void clear_tried(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (const SoftRow& row : s.scratch->rows) work_of(s, row.member).change[row.particle] = {};
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
      work.impulses[row.particle] += row.step;
      try_on_body(s, row, row.step);
    }
    respond(entry_of(s, m), work.step, work.impulses.view(), work.change.view(), *s.kernels, work.arena,
            work.tasks);
    for (std::uint32_t k = work.first_joint; k < work.last_joint; ++k) {
      SoftJoint& joint = s.scratch->joints[k];
      joint.step = -(s.scratch->carried[k].inertia * work.change[joint.particle]);
      try_on_body(s, joint, joint.step);
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
  for (SoftRow& row : s.scratch->rows) row.impulse += share * row.step;
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftWork& work = work_of(s, m);
    if (work.first_row == work.last_row) continue;
    add_change(entry_of(s, m), work.step, work.change.view(), share);
    for (std::uint32_t k = work.first_joint; k < work.last_joint; ++k)
      s.scratch->joints[k].impulse += share * s.scratch->joints[k].step;
  }
  change_bodies(s, share);
}

// Gives bodies the momentum that the parts carried by attached vertices have gained.
void give_to_bodies(SoftSolve& s) {
  for (VelocityChange& change : s.scratch->changes) change = {};
  for (SoftJoint& joint : s.scratch->joints) {
    try_on_body(s, joint, joint.step);
    joint.impulse += joint.step;
  }
  change_bodies(s, 1.0f);
}

void sweep_contacts(SoftSolve& s) {
  for (SoftRow& row : s.scratch->rows) {
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
    mass += double(entry_of(s, row.member).body.particles.mass[row.particle]);
  }
  return mass * fall * fall;
}

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
  scratch.rows.clear(), scratch.joints.clear();
  scratch.held.assign(scratch.touched.size(), 0u);
  scratch.changes.resize(scratch.touched.size()), scratch.pending.assign(scratch.touched.size(), VelocityChange{});
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftEntry& entry = entry_of(s, m);
    SoftWork& work = work_of(s, m);
    const std::size_t padded = entry.body.particles.x.size();
    work.arena.reset();
    work.impulses.resize(padded), work.change.resize(padded);
    work.first_row = std::uint32_t(scratch.rows.size());
    for (std::uint32_t k = 0; k < entry.contacts.size(); ++k) {
      const SoftContact& one = entry.contacts[k];
      SoftRow row;
      row.member = m, row.particle = one.particle, row.source = k;
      row.body = moves(w, one.body) ? one.body : -1;
      row.touched = find_touched(scratch, row.body);
      row.static_friction = one.static_friction, row.dynamic_friction = one.dynamic_friction;
      row.normal = one.normal, row.arm = one.from_body;
      row.impulse = s.warm_scale * project(row, one.impulse);
      scratch.rows.push_back(row);
    }
    work.last_row = std::uint32_t(scratch.rows.size());
    work.first_joint = std::uint32_t(scratch.joints.size());
    for (std::uint32_t k = 0; k < entry.attachments.size(); ++k) {
      const SoftAttachment& one = entry.attachments[k];
      if (!yields(w, one.body)) continue;
      if (entry.body.particles.loose[one.particle] == 0.0f) let_go(entry.body, int(one.particle));
      SoftJoint joint;
      joint.member = m, joint.particle = one.particle, joint.body = one.body, joint.source = k;
      joint.touched = find_touched(scratch, joint.body);
      joint.arm = rotate(orientation_now(w, joint.body), one.local);
      joint.impulse = s.warm_scale * one.impulse;
      ++scratch.held[joint.touched];
      scratch.joints.push_back(joint);
    }
    work.last_joint = std::uint32_t(scratch.joints.size());
    scratch.carried.resize(scratch.joints.size());
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
    carry(s, m);
    work.step = begin_soft_step(entry, {s.h, s.w->settings.gravity, carried_by(s, m)}, *s.kernels, work.arena, work.tasks);
    find_joint_steps(s, m);
  }
}

void warm_start_soft_rows(SoftSolve& s, int, int) {
  const float part = -1.0f / float(s.parts);
  for (const SoftRow& row : s.scratch->rows) push_body(*s.w, row, part * row.impulse);
  for (const SoftJoint& joint : s.scratch->joints) push_body(*s.w, joint, part * joint.impulse);
}

void solve_soft_rows(SoftSolve& s, int, int) {
  give_to_bodies(s);
  for (SoftRow& row : s.scratch->rows) prepare_row(s, row);
  if (!s.scratch->rows.empty()) solve_contacts_in_rounds(s);
  for (VelocityChange& pending : s.scratch->pending) pending = {};
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
  for (const SoftRow& row : s.scratch->rows)
    entry_of(s, row.member).contacts[row.source].impulse = row.impulse;
  for (const SoftJoint& joint : s.scratch->joints)
    entry_of(s, joint.member).attachments[joint.source].impulse = joint.impulse;
}

}  // namespace gyre
