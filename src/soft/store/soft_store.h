// SoftStore: all ropes, cloths and solids of a world, by the index of their ids. An entry is rebuilt from its definition when a state is
// loaded; only what moves is saved.
#pragma once

#include "base/container/array.h"
#include "base/container/slot_map.h"
#include "soft/body/soft_body.h"
#include "soft/contact/soft_surface.h"
#include "soft/mesh/embedded_surface.h"

#include <gyre/events.h>
#include <gyre/soft.h>

#include <memory>
#include <variant>
#include <vector>

namespace gyre {

using SoftDef = std::variant<RopeDef, ClothDef, SolidDef>;

constexpr std::int32_t kWorldAnchor = -1;  // of an attachment: the world

// A vertex that keeps its place in the frame of a body, or in the world.
struct SoftAttachment {
  std::uint32_t particle = 0;
  std::int32_t body = kWorldAnchor;
  DVec3 place{};   // of the world: where it stays
  Vec3 local{};    // of a body: from its centre of mass, in its axes, m
  Vec3 impulse{};  // N s on the vertex in the last half-step, where the body yields: the warm start
};

// A point of an element that keeps its place in the frame of a body, or in the world: the mean of the element's corners by weight. Elements are triangles of a
// cloth or tetrahedra of a solid; a crack leaves the point with its element.
struct SoftPointAttachment {
  std::uint32_t element = 0;
  std::int32_t body = kWorldAnchor;
  float weight[4] = {};  // of the corners in their order; that of a triangle's fourth is zero
  DVec3 place{};         // as in SoftAttachment
  Vec3 local{};
  Vec3 impulse{};  // N s on the point
};

// A vertex that does not touch the body that holds it or its neighbours, since it began inside it.
struct SoftInside {
  std::uint32_t particle = 0;
  std::int32_t body = 0;
};

// A vertex stays within `distance` of its target (m; below 0: it is free), and in front of the plane that lies `backstop` behind it.
struct SoftLimit {
  DVec3 target{};          // m
  float distance = -1.0f;  // m
  Vec3 normal{};           // unit; zero: there is no plane
  float backstop = 0.0f;   // m
};

// How a contact held its vertex in the last sub-step. A vertex emerges that began inside the shape: it is pushed out.
enum class SoftGrip : std::uint8_t { open, slides, sticks, emerges };

// A vertex near a shape, found once a step. The shape's surface is a plane here, which moves with the body.
struct SoftContact {
  std::uint32_t particle = 0;
  std::uint32_t shape = 0;
  std::int32_t body = 0;       // of the shape; it may be a fixed one
  std::uint32_t triangle = 0;  // of a mesh or height field
  Vec3 normal{};               // unit, out of the shape, world axes, when the step began
  Vec3 from_body{};            // from the body's centre of mass to the point on the surface, likewise
  float gap = 0.0f;            // m, of vertex and surface less the thickness, when the step began
  float static_friction = 0.0f;
  float dynamic_friction = 0.0f;
  Vec3 surface_velocity{};  // m/s, of a conveyor belt, world axes
  Vec3 impulse{};           // N s on the vertex in the last half-step: the warm start
  SoftGrip grip = SoftGrip::open;
};

// A face near a shape that comes nearer to it between its corners than at them: a corner, an edge or a tip of the shape. Found once a step.
struct SoftFaceContact {
  SoftContact at;                // of the first corner; its gap is that of the point
  std::uint32_t others[2] = {};  // the other corners
  float weight[3] = {};          // of the corners: where the point is
  std::uint32_t face = 0;        // of the surface
};

// True for the integrators that solve a system of equations, whose stability does not depend on the step.
inline bool is_implicit(SoftIntegrator integrator) {
  return integrator == SoftIntegrator::implicit || integrator == SoftIntegrator::sdirk2;
}

// SoftRest::asleep of soft matter that rests, and of soft matter that was no longer finite: nothing wakes the latter but a command that sets its vertices.
constexpr std::uint8_t kResting = 1, kQuarantined = 2;

// Rest, as of bodies.
struct SoftRest {
  float still_time = 0.0f;  // s
  std::uint8_t asleep = 0;
};

// How cloths and solids that tear, break or flow differ from their definition. Empty: not at all, nor will they.
struct SoftDamage {
  Array<std::uint32_t> corners;  // of the elements, in the order of the definition: three each of a cloth, four of a solid
  Array<std::uint32_t> roots;    // by particle: the vertex of the definition that it was
  Array<float> mass;             // kg, by particle
  Array<float> flow;             // nine of each tetrahedron, by columns: P; or none
  Array<float> rest_inverse;     // Dm^-1 likewise, known from the definition and the corners

  bool empty() const { return roots.empty(); }
};

// A shape that vertices touch, and the first of them.
struct SoftTouch {
  std::uint32_t shape = 0;
  std::uint32_t particle = 0;
};

// The events that were told: they follow from contacts and places, so this is no state of its own.
struct SoftReported {
  bool known = false;
  bool was_awake = false;        // when the step began
  Array<SoftTouch> touching;     // ascending by shape
  Array<std::uint8_t> inverted;  // by tetrahedron
};

// Events of soft matter, collected for the end of the step.
struct SoftEvents {
  Array<SoftContactBegin> begins;
  Array<SoftContactEnd> ends;
  Array<SoftInverted> inverted;
  Array<SoftTorn> torn;

  void clear() { begins.clear(), ends.clear(), inverted.clear(), torn.clear(); }
};

// Where the surface crosses itself or others, in the last sub-step; it follows from places, so this is no state of its own.
struct SoftCrossings {
  int count = 0;       // pairs of an edge and a triangle
  bool moves = false;  // true if it is being untangled: it must not fall asleep
};

struct SoftEntry {
  std::shared_ptr<const SoftDef> def;  // null: the slot is free
  SoftKind kind = SoftKind::rope;
  SoftBody body;
  Array<SoftAttachment> attachments;  // ascending by particle
  Array<SoftPointAttachment> points;  // in the order in which they were attached
  Array<SoftContact> contacts;        // ascending by particle, then shape
  Array<SoftFaceContact> faces;       // ascending by face
  Array<SoftInside> inside;           // ascending by particle, then body
  Array<SoftLimit> limits;            // by vertex; none: there are no limits
  Array<std::uint32_t>
      triangles;  // of the surface, three vertices each, seen from outside counter-clockwise; none of a rope
  std::shared_ptr<const SoftSurface> contact_surface;  // of the triangles; null: there are none
  // Of a solid that was made of a surface: what was given, carried along by its tetrahedra, for pictures.
  EmbeddedSurface surface;
  Array<SoftRest> rest{SoftRest{}};  // one
  // N s: what fluids gave to each particle in the last sub-step and in those before it of this step; no state.
  Array<DVec3> fluid_last, fluid_sum;
  float radius = 0.0f;  // m: half the thickness, which the surface keeps from shapes
  float size = 0.0f;    // m: the mean length of its edges, by which speculative distances go
  SoftDamage damage;
  SoftReported reported;
  SoftCrossings crossings;
  float crossed_for = 0.0f;  // s: how long it has crossed, for a report; no state
  Array<double> good[3];     // x, y, z: where particles were when the step began; no state

  bool is_awake() const { return rest[0].asleep == 0; }
  bool is_quarantined() const { return rest[0].asleep == kQuarantined; }
  const SoftSettings& settings() const {
    return std::visit([](const auto& one) -> const SoftSettings& { return one.settings; }, *def);
  }
};

// Where a point of the embedded surface is. The corners are taken from the first, so that the rounding of the weights does not grow with
// the distance from the origin.
inline DVec3 surface_position(const SoftEntry& entry, std::size_t point) {
  const EmbeddedPoint& embedded = entry.surface.points[point];
  const DVec3 first = entry.body.particles.place(int(embedded.corner[0]));
  DVec3 sum = first;
  for (int k = 1; k < 4; ++k)
    sum += double(embedded.weight[k]) * (entry.body.particles.place(int(embedded.corner[k])) - first);
  return sum;
}

struct SoftStore {
  IdPool ids;
  std::vector<SoftEntry> entries;
  SoftEvents events;  // of the next step

  bool empty() const { return ids.size() == 0; }
  void clear() {
    ids = {};
    entries.clear();
    events.clear();
  }
  template <class Fn>
  void for_each(Fn&& fn) {
    for (SoftEntry& entry : entries)
      if (entry.def != nullptr) fn(entry);
  }
  template <class Fn>
  void for_each(Fn&& fn) const {
    for (const SoftEntry& entry : entries)
      if (entry.def != nullptr) fn(entry);
  }
};

// Calls visit(array) for every array of an entry that a step changes: with the definition they are its state.
template <class Entry, class Visitor>
void for_each_soft_array(Entry& entry, Visitor&& visit) {
  auto& p = entry.body.particles;
  visit(p.x), visit(p.y), visit(p.z);
  visit(p.vx), visit(p.vy), visit(p.vz);
  for (auto& pull : entry.body.pull) visit(pull);
  for (auto& moved : entry.body.moved) visit(moved);
  visit(entry.body.chain.tension);
  visit(entry.attachments);
  visit(entry.contacts);
  visit(entry.rest);
}

// The arrays of damage that are state; of an entry that is damaged by nothing: none. A reader needs them before the others.
template <class Entry, class Visitor>
void for_each_damage_array(Entry& entry, Visitor&& visit) {
  if (entry.damage.empty()) return;
  visit(entry.damage.corners);
  visit(entry.damage.roots);
  visit(entry.damage.mass);
  visit(entry.damage.flow);
}

// State that most entries do not have. Files of before have none for any, so it stands behind all entries.
template <class Entry, class Visitor>
void for_each_rare_array(Entry& entry, Visitor&& visit) {
  visit(entry.inside);
  visit(entry.limits);
}
// Calls visit(attachment) for those of vertices and of points.
template <class Entry, class Visit>
void for_each_attachment(Entry& entry, Visit&& visit) {
  for (auto& one : entry.attachments) visit(one);
  for (auto& one : entry.points) visit(one);
}
// Calls visit(contact) for the contacts of vertices and of faces.
template <class Entry, class Visit>
void for_each_contact(Entry& entry, Visit&& visit) {
  for (auto& contact : entry.contacts) visit(contact);
  for (auto& face : entry.faces) visit(face.at);
}

inline bool has_rare_state(const SoftEntry& entry) { return !entry.inside.empty() || !entry.limits.empty(); }

// Begins to move again, and does not fall asleep for a while.
inline void wake(SoftEntry& entry) {
  if (!entry.is_quarantined()) entry.rest[0] = {};
}

// Contacts of the last step, between steps of a scheme, and the changes that the next step begins with, belong to the old places.
inline void forget_motion(SoftEntry& entry) {
  entry.contacts.clear();
  entry.faces.clear();
  for (Array<float>& pull : entry.body.pull) pull.clear();
  for (Array<double>& moved : entry.body.moved) moved.clear();
}

}  // namespace gyre
