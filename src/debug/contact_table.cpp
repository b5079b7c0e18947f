// read_contacts: every contact point as columns. See <gyre/debug.h>.
#include "debug/flat.h"
#include "debug/step_length.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

// Finds the solver's group of manifolds that are asked for in the order of their contacts, as the solver gathered them.
class SolverColors {
 public:
  explicit SolverColors(const SolveScratch& solve) : solve_(solve) {}

  std::uint8_t find(std::uint32_t slot, const Manifold& manifold) {
    const Array<std::uint32_t>& contacts = solve_.constraint_contact;
    while (next_ < contacts.size() && contacts[next_] < slot) ++next_;
    if (next_ >= contacts.size() || contacts[next_] != slot) return kNoColor;
    if (solve_.constraints[next_].manifold != &manifold) return kNoColor;
    const std::size_t found = next_++;
    return found < solve_.contact_colors.color.size() ? solve_.contact_colors.color[found] : kNoColor;
  }

 private:
  const SolveScratch& solve_;
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
  append(out.positions, difference(w.bodies.places[contact.body_a].center, origin) + point.from_a);
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
  const RigidWorld& w = world.state().rigid;
  clear_all(out.bodies, out.shapes, out.positions, out.normals, out.tangents, out.separations, out.forces,
            out.friction_forces, out.scales, out.states, out.colors);
  SolverColors colors(world.state().solve);
  for (std::uint32_t slot = 0; slot < w.contacts.contacts.size(); ++slot) {
    const Contact& contact = w.contacts.contacts[slot];
    if (contact.manifold_room == 0) continue;
    for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
      if (manifold.count == 0) continue;
      const std::uint8_t color = colors.find(slot, manifold);
      for (int k = 0; k < manifold.count; ++k) {
        add_point(w, contact, manifold, k, origin, out);
        out.colors.push_back(color);
      }
    }
  }
}

}  // namespace gyre
