// read_contacts: every contact point as columns. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/flat.h"
#include "debug/step_length.h"
#include "rigid/batch/solve_batch.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

// The solver colours of all manifolds, computed again: they follow from the contacts alone.
class SolverColors {
 public:
  explicit SolverColors(const RigidWorld& w) {
    Array<ColoringPair> pairs;
    Array<std::uint32_t> slots;
    for (std::uint32_t slot = 0; slot < w.contacts.contacts.size(); ++slot) {
      const Contact& contact = w.contacts.contacts[slot];
      if (!is_solved(w, contact)) continue;
      const ColoringPair pair{is_active(w, contact.body_a) ? contact.body_a : ColoringPair::kNone,
                              is_active(w, contact.body_b) ? contact.body_b : ColoringPair::kNone};
      for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
        if (manifold.count > 0) pairs.push_back(pair), slots.push_back(slot);
      }
    }
    color_constraints(pairs, slots, std::uint32_t(w.bodies.motion.size()), {}, kColoringOptions, coloring_);
  }

  // Must be called in the order of contacts, for each manifold with points.
  std::uint8_t next(const RigidWorld& w, const Contact& contact) {
    return is_solved(w, contact) ? coloring_.color[next_++] : kNoColor;
  }

 private:
  Coloring coloring_;
  std::size_t next_ = 0;
};

ContactState state_of(const Contact& contact, const Manifold& manifold, const ContactPointState& point) {
  if (contact.sensor != 0) return ContactState::sensor;
  if (!(point.total_impulse > 0.0f)) return ContactState::idle;
  return manifold.sliding != 0 ? ContactState::sliding : ContactState::pressing;
}

void add_point(const RigidWorld& w, const Contact& contact, const Manifold& manifold, int k, DVec3 origin,
               ContactTable& out) {
  const ContactPointState& point = manifold.points[k];
  const float per_second = inverse_step_length(w);
  out.bodies.push_back(contact.body_a);
  out.bodies.push_back(contact.body_b);
  out.shapes.push_back(contact.shape_a);
  out.shapes.push_back(contact.shape_b);
  append(out.positions, difference(w.bodies.poses[contact.body_a].center, origin) + point.from_a);
  append(out.normals, manifold.normal);
  const Vec3 tangent = any_perpendicular(manifold.normal);
  append(out.tangents, tangent);
  append(out.tangents, cross(manifold.normal, tangent));
  out.separations.push_back(point.separation);
  out.forces.push_back(per_second * point.total_impulse);
  append(out.friction_forces, k == 0 ? per_second * manifold.total_friction : Vec3{});
  out.scales.push_back(contact.size);
  out.states.push_back(state_of(contact, manifold, point));
}

}  // namespace

const char* to_string(ContactState state) {
  switch (state) {
    case ContactState::idle:
      return "idle";
    case ContactState::pressing:
      return "pressing";
    case ContactState::sliding:
      return "sliding";
    case ContactState::sensor:
      return "sensor";
  }
  return "unknown";
}

void read_contacts(const World& world, DVec3 origin, ContactTable& out) {
  const FloatMode mode;
  const RigidWorld& w = state_of(world).rigid;
  clear_all(out.bodies, out.shapes, out.positions, out.normals, out.tangents, out.separations, out.forces,
            out.friction_forces, out.scales, out.states, out.colors);
  SolverColors colors(w);
  for (const Contact& contact : w.contacts.contacts) {
    if (contact.manifold_room == 0) continue;
    for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
      if (manifold.count == 0) continue;
      const std::uint8_t color = colors.next(w, contact);
      for (int k = 0; k < manifold.count; ++k) {
        add_point(w, contact, manifold, k, origin, out);
        out.colors.push_back(color);
      }
    }
  }
}

}  // namespace gyre
