// Changes of existing bodies, shapes and pairs of bodies. In: checked arguments (command_check.cpp). Out: the changed state, with bodies woken
// and derived data anew.
#pragma once

#include "world/world_state.h"

namespace gyre {

// Parts of command.cpp that these changes share with others.
// Wakes a body to which the user applies a force or impulse.
void wake_if_movable(RigidWorld& w, std::uint32_t body);
// The fields of a proxy that follow from the body.
void refresh_proxy(RigidWorld& w, std::uint32_t shape);
// Removes all contacts of a shape and reports their ends.
void drop_contacts(RigidWorld& w, std::uint32_t shape);
// Mass, centre and inertia from shapes and overrides; the origin of the body stays.
void refresh_mass(RigidWorld& w, std::uint32_t body);
void refit_body(RigidWorld& w, std::uint32_t body);

void set_mass(WorldState& s, std::uint32_t body, const MassDef& mass);
void set_density(WorldState& s, std::uint32_t shape, float density);
void set_locked_axes(WorldState& s, std::uint32_t body, const LockedAxes& locked);
void set_can_sleep(WorldState& s, std::uint32_t body, bool can_sleep);
// A disabled body keeps its pose and velocity. It has no contacts, no query finds it, and its joints idle.
void set_enabled(WorldState& s, std::uint32_t body, bool enabled);
void set_sensor(WorldState& s, std::uint32_t shape, bool sensor);
// Members that are absent stay.
void set_shape(WorldState& s, std::uint32_t shape, const std::optional<AnyShape>& geometry,
               const std::optional<Transform>& local);
void set_pair_ignored(WorldState& s, std::uint32_t a, std::uint32_t b, bool ignored);
bool is_pair_ignored(const RigidWorld& w, std::uint32_t a, std::uint32_t b);
// Removes the pairs of a body that is removed.
void forget_ignored_pairs(RigidWorld& w, std::uint32_t body);

}  // namespace gyre
