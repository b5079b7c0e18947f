// Rounds of sequential impulses on the contacts of ropes: they find impulses with the block of each vertex alone, and of these the share is taken that
// minimises the energy of the coupled system.
//
// In: rows that are placed, velocities. Out: impulses and velocities of both sides, and how contacts hold from now on.
#pragma once

#include "dynamics/soft/soft_solve.h"

namespace gyre {

inline SoftWork& work_of(SoftSolve& s, std::uint32_t member) { return *s.scratch->works[s.members[member]]; }
inline SoftEntry& entry_of(SoftSolve& s, std::uint32_t member) { return s.store->entries[s.members[member]]; }

// True of a rope that is solved exactly, whose contacts are solved in rounds; those of all else are in one system.
inline bool is_exact_rope(const SoftEntry& entry) {
  return entry.kind == SoftKind::rope && is_implicit(entry.settings().integrator);
}

// Calls visit(vertex, weight) for each vertex of the row.
template <class Visit>
void for_each_vertex(const SoftRow& row, Visit&& visit) {
  visit(row.particle, row.weight[0]);
  for (int k = 1; k < row.corners; ++k) visit(row.others[k - 1], row.weight[k]);
}
// The value at the point of the row, of values by vertex.
template <class At>
auto mean_of(const SoftRow& row, At&& at) {
  auto sum = at(row.particle);
  using Weight = decltype(sum.x);
  sum = Weight(row.weight[0]) * sum;
  for (int k = 1; k < row.corners; ++k) sum = sum + Weight(row.weight[k]) * at(row.others[k - 1]);
  return sum;
}
// With what the body is still to get in this sub-step.
template <class Row>
Vec3 velocity_of_body(const SoftSolve& s, const Row& row) {
  if (row.touched < 0) return {};
  const VelocityChange& pending = s.scratch->pending[row.touched];
  return point_velocity(s.w->bodies.motion[std::size_t(row.body)], row.arm) + pending.linear +
         cross(pending.angular, row.arm);
}

inline bool holds(const SoftRow& row) {
  return !row.coupled && (row.grip == SoftGrip::slides || row.grip == SoftGrip::sticks);
}

// The impulse that a contact ends with: no pull, and friction within Coulomb's cone.
Vec3 project(const SoftRow& row, Vec3 impulse);
// Gives bodies the momentum that the parts carried by vertices have gained.
void give_to_bodies(SoftSolve& s);
void solve_contacts_in_rounds(SoftSolve& s);
// Changes of bodies by impulses that are tried: none, then those of an impulse on a row's vertices, then so large a share of them is taken.
void clear_changes(SoftSolve& s);
void try_on_body(SoftSolve& s, const SoftRow& row, Vec3 impulse);
void change_bodies(SoftSolve& s, float share);
// How contacts hold from now on: they stick within the cone of friction, slide at its bound, and are open without load.
void set_grips(SoftSolve& s);

}  // namespace gyre
