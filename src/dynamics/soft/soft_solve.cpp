#include "dynamics/soft/soft_solve.h"

#include "dynamics/soft/soft_forces.h"
#include "dynamics/soft/soft_loads.h"
#include "dynamics/soft/soft_rounds.h"
#include "math/rotation.h"
#include "rigid/batch/solve_batch.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/vertex_limits.h"
#include "soft/store/soft_point.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

// The inertia of a fixed body that a vertex carries, in its own masses: beyond what hangs on it, below what rounding would show.
constexpr float kGripShare = 1.0e3f;
// How often a sub-step is solved because contacts open or begin to slide.
constexpr int kGripPasses = 3;
// The rate (1/s) at which errors of position are removed, and the largest share of them in a sub-step. A rate, since sub-steps up to an impact
// may be as short as one likes.
constexpr float kErrorRate = 48.0f, kErrorShare = 0.2f;
// But no larger share of them than this one of the mass of the body over that of its load: all that hangs together with it. Contacts and joints of bodies are solved
// apart: they answer a correction a sub-step later, and are answered, so that errors grow if the share is more than the ratio of masses (docs/decisions/soft-coupling.md).
constexpr float kLoopShare = 0.5f;
// Faces come out of shapes at this share of the rate: a sheet of coarse cells that falls on a ball is deep in it between its vertices, and must not be thrown
// back.
constexpr float kFaceRate = 0.2f;
// Largest speed of removal of penetration, as a share of the speed of a fall from the length of an edge: as for contacts of bodies.
constexpr float kSoftPushShare = 0.4f;

// A point is held in all directions; its row takes them as one along this and two across.
constexpr Vec3 kAnyNormal{0.0f, 1.0f, 0.0f};

const SoftContact& contact_of(const SoftEntry& entry, const SoftRow& row) {
  return row.kind == SoftRowKind::face ? entry.faces[row.source].at : entry.contacts[row.source];
}

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

// Where a body or the world holds what is attached to it; `held` is an attachment of a vertex or a point.
template <class Held>
Vec3 arm_now(const RigidWorld& w, const Held& held) {
  return held.body == kWorldAnchor ? Vec3{} : rotate(orientation_now(w, held.body), held.local);
}
template <class Held>
DVec3 anchor_now(const RigidWorld& w, const Held& held) {
  return held.body == kWorldAnchor ? held.place : center_now(w, held.body) + DVec3(arm_now(w, held));
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
  if (row.body < 0 || !row.pushes) return;
  BodyMotion& motion = w.bodies.motion[std::size_t(row.body)];
  const BodyInertia& inertia = w.bodies.inertia[std::size_t(row.body)];
  motion.linear_velocity += inertia.inverse_mass * impulse;
  motion.angular_velocity += inertia.inverse * cross(row.arm, impulse);
}

// The compliance of a point of a body: 1/m 1 + [r] I^-1 [r]^T.
template <class Row>
Sym3 body_compliance(const RigidWorld& w, const Row& row) {
  if (row.body < 0 || !row.pushes) return {};
  const BodyInertia& inertia = w.bodies.inertia[std::size_t(row.body)];
  const auto column = [&](Vec3 axis) {
    return inertia.inverse_mass * axis + cross(inertia.inverse * cross(row.arm, axis), row.arm);
  };
  const Vec3 x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
  return {x.x, y.y, z.z, x.y, x.z, y.z};
}

// ------------------------------------------------------------------------------------------------------- a half-step

// Visual matter follows bodies and does not push them: its velocities come from places that were moved to fit, which would throw bodies about.
bool is_visual(const SoftEntry& entry) { return entry.settings().integrator == SoftIntegrator::visual; }

// Vertices attached to what does not yield are where it takes them when the half-step ends.
void move_held(const SoftSolve& s, SoftEntry& entry) {
  const RigidWorld& w = *s.w;
  for (const SoftAttachment& one : entry.attachments) {
    if (yields(w, one.body) && !is_visual(entry)) continue;
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

float error_rate(const SoftSolve& s) { return min(kErrorRate, kErrorShare / s.h); }

// The rate at which errors of place at a body are removed, 1/s.
float correction_of(const SoftSolve& s, std::int32_t body) {
  if (!yields(*s.w, body)) return error_rate(s);
  const double load = s.scratch->loads[std::size_t(find_touched(*s.scratch, body))];
  const double ratio = double(s.w->bodies.inertia[std::size_t(body)].inverse_mass) * load;
  if (!(ratio > 0.0)) return error_rate(s);
  return float(min(double(error_rate(s)), double(kLoopShare) / (ratio * double(s.h))));
}

// Where the row acts now, and what it wants. Particles have not moved yet.
void place_row(const SoftSolve& s, const SoftEntry& entry, SoftRow& row) {
  const RigidWorld& w = *s.w;
  const DVec3 place = mean_of(row, [&](std::uint32_t v) { return entry.body.particles.place(int(v)); });
  if (row.kind == SoftRowKind::attachment) {
    row.arm = arm_now(w, entry.attachments[row.source]);
    const DVec3 point = anchor_now(w, entry.attachments[row.source]);
    // Each of several vertices moves a part of the body; together they would remove more than there is.
    const float rate = row.correction / float(s.scratch->grips[row.touched]);
    row.bias = rate * difference(place, point);
  } else if (row.kind == SoftRowKind::point) {
    row.arm = arm_now(w, entry.points[row.source]);
    row.bias = row.correction * difference(place, anchor_now(w, entry.points[row.source]));
  } else {
    const SoftContact& contact = contact_of(entry, row);
    row.normal = turned_now(w, contact.body, contact.normal);
    row.arm = turned_now(w, contact.body, contact.from_body);
    const DVec3 point = center_now(w, contact.body) + DVec3(row.arm);
    const float gap = dot(row.normal, difference(place, point)) - entry.radius;
    const float most = kSoftPushShare * std::sqrt(reference_gravity(w.settings) * entry.size);
    // A vertex that is free may come as near as it likes; one that is held goes to the surface from either side.
    const bool is_free = (row.coupled || row.grip == SoftGrip::open) && gap > 0.0f;
    const float wanted =
        is_free
            ? gap / s.h
            : clamp((row.kind == SoftRowKind::face ? kFaceRate : 1.0f) * row.correction * gap, -most, most);
    row.bias = wanted * row.normal - contact.surface_velocity;
  }
  row.body_compliance = body_compliance(w, row);
}

Sym3 along(Vec3 n, float scale) {
  return {scale * n.x * n.x, scale * n.y * n.y, scale * n.z * n.z,
          scale * n.x * n.y, scale * n.x * n.z, scale * n.y * n.z};
}

// The inertia that the vertex of a row which grips carries.
Sym3 gripped_inertia(const SoftSolve& s, const SoftRow& row, float mass) {
  const float shares = row.touched >= 0 && row.pushes ? float(s.scratch->grips[row.touched]) : 0.0f;
  const float give = row.is_contact() ? 1.0f / (kGripShare * mass) : 0.0f;
  if (row.grip == SoftGrip::slides)
    return along(row.normal, 1.0f / (shares * dot(row.normal, row.body_compliance * row.normal) + give));
  return inverse(shares * row.body_compliance + Sym3{give, give, give, 0.0f, 0.0f, 0.0f});
}

// Rows act as forces with their last impulses, and those that grip let their vertices carry inertia.
void add_rows(SoftSolve& s, std::uint32_t member) {
  SoftEntry& entry = entry_of(s, member);
  SoftWork& work = work_of(s, member);
  Particles& p = entry.body.particles;
  const float rate = 1.0f / s.h;
  work.carried = 0;
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
    SoftRow& row = s.scratch->rows[k];
    place_row(s, entry, row);
    for_each_vertex(row, [&](std::uint32_t v, float weight) {
      const Vec3 impulse = weight * row.impulse;
      p.fx[v] += rate * impulse.x;
      p.fy[v] += rate * impulse.y;
      p.fz[v] += rate * impulse.z;
    });
    row.carried = -1;
    if (!holds(row) || p.loose[row.particle] == 0.0f) continue;
    row.carried = std::int32_t(work.first_row + work.carried++);
    s.scratch->carried[row.carried] = {
        std::int32_t(row.particle), gripped_inertia(s, row, p.mass[row.particle]),
        velocity_of_body(s, row) - row.bias, row.grip == SoftGrip::slides ? row.normal : Vec3{}};
  }
}
// Contacts that pull open, those that stick beyond their cones slide. True if there are any.
bool loosen_grips(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  bool any = false;
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
    SoftRow& row = s.scratch->rows[k];
    if (!row.is_contact() || row.carried < 0) continue;
    const Vec3 impulse = row.impulse + row.carried_step;
    const float normal = dot(row.normal, impulse);
    SoftGrip grip = row.grip;
    if (!(normal >= 0.0f)) {
      grip = SoftGrip::open;
    } else if (grip == SoftGrip::sticks &&
               length(impulse - normal * row.normal) > row.static_friction * normal) {
      grip = SoftGrip::slides;
    }
    any = any || grip != row.grip;
    row.grip = grip;
  }
  return any;
}

// Places and velocities, and what else the solution of an implicit sub-step changes. (Places: of a scheme of two stages.)
void copy_motion(const SoftBody& from, SoftBody& to) {
  to.particles.x = from.particles.x, to.particles.y = from.particles.y, to.particles.z = from.particles.z;
  to.particles.vx = from.particles.vx, to.particles.vy = from.particles.vy,
  to.particles.vz = from.particles.vz;
  for (int axis = 0; axis < 3; ++axis) to.pull[axis] = from.pull[axis];
  to.chain.tension = from.chain.tension;
}

std::span<const CarriedInertia> carried_by(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  return s.scratch->carried.view().subspan(work.first_row, work.carried);
}

void prepare_row(SoftSolve& s, SoftRow& row) {
  row.particle_inverse = inverse_mass(entry_of(s, row.member), work_of(s, row.member).step, row.particle);
  row.compliance = row.particle_inverse + row.body_compliance;
}

}  // namespace

// The momentum that vertices got by what they carry.
void find_carried_steps(SoftSolve& s, std::uint32_t member) {
  const SoftWork& work = work_of(s, member);
  const Particles& p = entry_of(s, member).body.particles;
  for (std::uint32_t k = work.first_row; k < work.last_row; ++k) {
    SoftRow& row = s.scratch->rows[k];
    row.carried_step = {};
    if (row.carried < 0) continue;
    const CarriedInertia& carried = s.scratch->carried[row.carried];
    row.carried_step = momentum_to_target(carried, p.velocity(carried.particle));
  }
}

void hold_attached(const RigidWorld& w, SoftEntry& entry) {
  for (const SoftAttachment& one : entry.attachments) {
    const int particle = int(one.particle);
    const bool is_held = entry.body.particles.loose[one.particle] == 0.0f;
    const bool is_free = yields(w, one.body) && !is_visual(entry);
    if (is_held && is_free) let_go(entry.body, particle);
    if (!is_held && !is_free) hold(entry.body, particle, entry.body.particles.place(particle));
  }
}

void gather_soft(RigidWorld& w, SoftStore& store, SoftScratch& scratch, Arena& arena) {
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
    for_each_contact(entry, [&](const SoftContact& contact) { touch(contact.body); });
    for_each_attachment(entry, [&](const auto& one) { touch(one.body); });
  });
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use == kPoseRead) scratch.touched.push_back(body);
  }
  scratch.loads.resize(scratch.touched.size());
  find_loads(w, store, scratch.touched, arena, {scratch.loads.data(), scratch.loads.size()});
}

void make_soft_rows(SoftSolve& s) {
  SoftScratch& scratch = *s.scratch;
  const RigidWorld& w = *s.w;
  scratch.rows.clear();
  scratch.grips.assign(scratch.touched.size(), 0u);
  scratch.changes.resize(scratch.touched.size()),
      scratch.pending.assign(scratch.touched.size(), VelocityChange{});
  for (std::uint32_t m = 0; m < s.members.size(); ++m) {
    SoftEntry& entry = entry_of(s, m);
    SoftWork& work = work_of(s, m);
    const std::size_t padded = entry.body.particles.x.size();
    work.arena.reset();
    work.impulses.resize(padded), work.change.resize(padded);
    work.field_forces.clear();
    work.first_row = std::uint32_t(scratch.rows.size());
    const auto add = [&](std::uint32_t particle, std::int32_t body, std::uint32_t source) -> SoftRow& {
      SoftRow row;
      row.member = m, row.particle = particle, row.source = source;
      row.body = moves(w, body) ? body : -1;
      row.touched = find_touched(scratch, row.body);
      row.pushes = !is_visual(entry);
      scratch.rows.push_back(row);
      return scratch.rows.back();
    };
    for (std::uint32_t k = 0; k < entry.attachments.size(); ++k) {
      const SoftAttachment& one = entry.attachments[k];
      if (!yields(w, one.body) || is_visual(entry)) continue;
      if (entry.body.particles.loose[one.particle] == 0.0f) let_go(entry.body, int(one.particle));
      SoftRow& row = add(one.particle, one.body, k);
      row.correction = correction_of(s, one.body);
      row.grip = SoftGrip::sticks;
      row.arm = rotate(orientation_now(w, row.body), one.local);
      row.impulse = s.warm_scale * one.impulse;
    }
    for (std::uint32_t k = 0; k < entry.points.size(); ++k) {
      const SoftPointAttachment& one = entry.points[k];
      const ElementCorners corners = corners_of(entry, one.element);
      SoftRow& row = add(corners.corner[0], one.body, k);
      row.kind = SoftRowKind::point;
      row.correction = correction_of(s, one.body);
      row.coupled = true;
      row.corners = corners.count;
      for (int n = 1; n < corners.count; ++n) row.others[n - 1] = corners.corner[n];
      for (int n = 0; n < corners.count; ++n) row.weight[n] = one.weight[n];
      row.normal = kAnyNormal;
      row.arm = arm_now(w, one);
      row.impulse = s.warm_scale * one.impulse;
    }
    const auto add_contact = [&](const SoftContact& one, std::uint32_t source) -> SoftRow& {
      SoftRow& row = add(one.particle, one.body, source);
      row.kind = SoftRowKind::contact;
      row.correction = correction_of(s, row.body);
      row.coupled = !is_exact_rope(entry);
      row.static_friction = one.static_friction, row.dynamic_friction = one.dynamic_friction;
      row.normal = one.normal, row.arm = one.from_body;
      row.grip = one.grip;
      row.impulse = s.warm_scale * project(row, one.impulse);
      return row;
    };
    for (std::uint32_t k = 0; k < entry.contacts.size(); ++k) add_contact(entry.contacts[k], k);
    for (std::uint32_t k = 0; k < entry.faces.size(); ++k) {
      const SoftFaceContact& face = entry.faces[k];
      SoftRow& row = add_contact(face.at, k);
      row.kind = SoftRowKind::face;
      row.corners = 3;
      for (int n = 0; n < 2; ++n) row.others[n] = face.others[n];
      for (int n = 0; n < 3; ++n) row.weight[n] = face.weight[n];
    }
    work.last_row = std::uint32_t(scratch.rows.size());
  }
  scratch.carried.resize(scratch.rows.size());
  for (const SoftRow& row : scratch.rows)
    if (row.touched >= 0 && row.pushes && holds(row)) ++scratch.grips[row.touched];
  begin_soft_surfaces(s);
}

void turn_soft_rows(SoftSolve& s, int, int) {
  const RigidWorld& w = *s.w;
  for (SoftRow& row : s.scratch->rows) {
    if (row.touched < 0) continue;
    const SoftEntry& entry = entry_of(s, row.member);
    const Vec3 arm = row.is_contact() ? turned_now(w, row.body, contact_of(entry, row).from_body)
                     : row.kind == SoftRowKind::point ? arm_now(w, entry.points[row.source])
                                                      : arm_now(w, entry.attachments[row.source]);
    const Vec3 moment = cross(arm - row.arm, (-1.0f / float(s.parts)) * row.impulse);
    if (row.pushes)
      s.w->bodies.motion[std::size_t(row.body)].angular_velocity +=
          w.bodies.inertia[std::size_t(row.body)].inverse * moment;
    row.arm = arm;
  }
}

namespace {

// The forces of fields; of visual entries they are found once a step.
void set_forces(SoftSolve& s, SoftEntry& entry, SoftWork& work, bool again) {
  Particles& p = entry.body.particles;
  Array<Vec3>& kept = work.field_forces;
  for (int i = 0; i < int(kept.size()); ++i) p.fx[i] = kept[i].x, p.fy[i] = kept[i].y, p.fz[i] = kept[i].z;
  if (!kept.empty()) return;
  set_field_forces(*s.w, *s.fluids, entry, s.time, s.h, again);
  if (!is_visual(entry)) return;
  for (int i = 0; i < p.count; ++i) kept.push_back({p.fx[i], p.fy[i], p.fz[i]});
}

// True if the loops over the vertices of a member are worth sharing: it has several blocks of vertices, and more than a worker's share of all
// vertices. Ropes and visual members have no such loops.
bool has_shared_loops(SoftSolve& s, std::uint32_t member, long all_vertices) {
  const SoftEntry& entry = entry_of(s, member);
  const long vertices = entry.body.particles.count;
  return entry.kind != SoftKind::rope && !is_visual(entry) && vertices > kBlockSlices * kSliceRows &&
         vertices * s.tasks->worker_count() > all_vertices;
}

// Calls step(member, tasks) for each member: first for the small ones, each of which one worker steps, and then for the large ones, each of which
// all workers step.
template <class Step>
void step_members(SoftSolve& s, Step&& step) {
  long vertices = 0;
  for (std::uint32_t m = 0; m < s.members.size(); ++m) vertices += entry_of(s, m).body.particles.count;
  for_blocks(*s.tasks, int(s.members.size()), 1, [&](int m, int, int) {
    const std::uint32_t member = std::uint32_t(m);
    if (!has_shared_loops(s, member, vertices)) step(member, work_of(s, member).serial);
  });
  for (std::uint32_t m = 0; m < s.members.size(); ++m)
    if (has_shared_loops(s, m, vertices)) step(m, *s.tasks);
}

// True if contacts may act on a member within the step: with shapes, or of a solid with soft matter.
bool touches(SoftSolve& s, std::uint32_t m) {
  const SoftEntry& entry = entry_of(s, m);
  return !entry.contacts.empty() || !entry.faces.empty() || !entry.points.empty() ||
         (entry.kind == SoftKind::solid && s.scratch->surfaces.near[m] != 0);
}

void begin_member(SoftSolve& s, std::uint32_t m, TaskSystem& tasks) {
  SoftEntry& entry = entry_of(s, m);
  SoftWork& work = work_of(s, m);
  work.mark = work.arena.mark();
  move_held(s, entry);
  const bool implicit = is_implicit(entry.settings().integrator);
  if (implicit && work.first_row != work.last_row) copy_motion(entry.body, work.before);
  for (int pass = 0; pass < kGripPasses; ++pass) {
    set_forces(s, entry, work, pass > 0);
    add_rows(s, m);
    add_forces_of_surfaces(s, m);
    work.step = begin_soft_step(entry,
                                {.step = s.h,
                                 .gravity = s.w->settings.gravity,
                                 .carried = carried_by(s, m),
                                 .touches = touches(s, m),
                                 .asks_for_inverse_masses = work.first_row != work.last_row},
                                *s.kernels, work.arena, tasks);
    find_carried_steps(s, m);
    if (!implicit || pass + 1 == kGripPasses || !loosen_grips(s, m)) break;
    work.arena.release(work.mark);
    copy_motion(work.before, entry.body);
  }
}

void finish_member(SoftSolve& s, std::uint32_t m, TaskSystem& tasks) {
  SoftEntry& entry = entry_of(s, m);
  SoftWork& work = work_of(s, m);
  finish_soft_step(entry, work.step, *s.kernels, tasks);
  if (!entry.limits.empty()) keep_limits(entry);
  work.arena.release(work.mark);
}

}  // namespace

void begin_soft_members(SoftSolve& s, int, int) {
  step_members(s, [&](std::uint32_t m, TaskSystem& tasks) { begin_member(s, m, tasks); });
}

void warm_start_soft_rows(SoftSolve& s, int, int) {
  for (const SoftRow& row : s.scratch->rows) push_body(*s.w, row, (-1.0f / float(s.parts)) * row.impulse);
}

void solve_soft_rows(SoftSolve& s, int, int) {
  bool any_contact = false;
  for (SoftRow& row : s.scratch->rows) {
    if (row.coupled || !row.is_contact()) continue;
    prepare_row(s, row);
    any_contact = true;
  }
  if (any_contact) solve_contacts_in_rounds(s);
  set_grips(s);
  for (VelocityChange& pending : s.scratch->pending) pending = {};
}

void finish_soft_members(SoftSolve& s, int, int) {
  step_members(s, [&](std::uint32_t m, TaskSystem& tasks) { finish_member(s, m, tasks); });
}

void keep_soft_rows(SoftSolve& s) {
  end_soft_surfaces(s);
  for (const SoftRow& row : s.scratch->rows) {
    SoftEntry& entry = entry_of(s, row.member);
    switch (row.kind) {
      case SoftRowKind::attachment:
        entry.attachments[row.source].impulse = row.impulse;
        break;
      case SoftRowKind::point:
        entry.points[row.source].impulse = row.impulse;
        break;
      case SoftRowKind::contact:
        entry.contacts[row.source].impulse = row.impulse, entry.contacts[row.source].grip = row.grip;
        break;
      case SoftRowKind::face:
        entry.faces[row.source].at.impulse = row.impulse;
        break;
    }
  }
}

}  // namespace gyre
