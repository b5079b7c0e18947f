#include "world/soft_commands.h"

#include "base/float_mode.h"
#include "dynamics/soft/soft_inside.h"
#include "math/rotation.h"
#include "rigid/sleep/island.h"
#include "soft/body/element_stress.h"
#include "soft/body/enclosed_gas.h"
#include "soft/body/soft_energy.h"
#include "soft/store/soft_builder.h"
#include "soft/store/soft_point.h"
#include "soft/store/soft_strain.h"
#include "world/refusal.h"
#include "world/soft_events.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr std::size_t kMaxSofts = 1u << 16;
// Weights of a point may be wrong by the rounding of a hit.
constexpr float kWeightError = 1.0e-4f;

Error check_id(const WorldState& s, SoftId id, const char* what) {
  if (is_soft(s, id)) return {};
  return make_error(ErrorCode::stale_id, "%s: rope, cloth or solid %u (generation %u) does not exist in this world", what,
                    id.index, unsigned(id.generation));
}
Error check_vertex(const WorldState& s, SoftId id, int vertex, const char* what) {
  const Error e = check_id(s, id, what);
  if (e) return e;
  const int count = s.soft.entries[id.index].body.particles.count;
  if (vertex >= 0 && vertex < count) return {};
  return refuse("%s: vertex is %d; it must lie within 0 and %d", what, vertex, count - 1);
}

Error check_holder(const WorldState& s, BodyId body, const char* what) {
  const IdPool& ids = s.rigid.bodies.ids;
  if (!body || (body.world == s.number && ids.live(body.index) && std::uint16_t(ids.generation(body.index)) == body.generation))
    return {};
  return make_error(ErrorCode::stale_id, "%s: body %u (generation %u) does not exist in this world", what, body.index,
                    unsigned(body.generation));
}

std::size_t find_attachment(const SoftEntry& entry, std::uint32_t particle) {
  std::size_t at = 0;
  while (at < entry.attachments.size() && entry.attachments[at].particle < particle) ++at;
  return at;
}
bool has_attachment(const SoftEntry& entry, std::size_t at, std::uint32_t particle) {
  return at < entry.attachments.size() && entry.attachments[at].particle == particle;
}

DVec3 place_of(const SoftEntry& entry, const SoftAttachment& attachment) {
  return entry.body.particles.place(int(attachment.particle));
}

// Lets an attachment of a vertex or a point stand where that is now.
template <class Held>
void anchor_here(const RigidWorld& w, const SoftEntry& entry, Held& held) {
  held.place = place_of(entry, held);
  held.impulse = {};
  if (held.body == kWorldAnchor) return;
  const BodyPose& pose = w.bodies.poses[std::size_t(held.body)];
  held.local = rotate(conjugate(pose.orientation), difference(held.place, pose.center));
}

// Vertices that begin inside bodies that hold them do not touch these.
void add_inside(const RigidWorld& w, SoftEntry& entry, const SoftPointAttachment& point) {
  const ElementCorners corners = corners_of(entry, point.element);
  for (int k = 0; k < corners.count && point.body != kWorldAnchor; ++k)
    add_inside(w, entry, std::uint32_t(point.body), corners.corner[k]);
}
void find_inside_again(const RigidWorld& w, SoftEntry& entry) {
  entry.inside.clear();
  for (const SoftAttachment& one : entry.attachments)
    if (one.body != kWorldAnchor) add_inside(w, entry, std::uint32_t(one.body), one.particle);
  for (const SoftPointAttachment& one : entry.points) add_inside(w, entry, one);
}

// A body that holds nothing any more pushes out what is inside it.
void let_out(SoftEntry& entry, std::int32_t body) {
  bool holds = false;
  for_each_attachment(entry, [&](const auto& one) { holds = holds || one.body == body; });
  if (holds) return;
  for (std::size_t k = entry.inside.size(); k-- > 0;)
    if (entry.inside[k].body == body) entry.inside.erase_at(k);
}

// Lets points go that a body or the world holds; true if there are any.
bool let_points_go(SoftEntry& entry, std::int32_t body) {
  const std::size_t before = entry.points.size();
  for (std::size_t k = before; k-- > 0;)
    if (entry.points[k].body == body) entry.points.erase_at(k);
  return entry.points.size() != before;
}

}  // namespace

bool is_soft(const WorldState& s, SoftId id) {
  return id && id.world == s.number && s.soft.ids.live(id.index) &&
         std::uint16_t(s.soft.ids.generation(id.index)) == id.generation;
}

SoftId soft_id(const WorldState& s, std::uint32_t slot) {
  return {slot, std::uint16_t(s.soft.ids.generation(slot)), s.number};
}

Error check(const WorldState& s, const AddSoft& c) {
  if (s.soft.ids.size() >= kMaxSofts) return refuse("a world has at most %d ropes, cloths and solids", int(kMaxSofts));
  return std::visit([](const auto& def) { return check_soft(def); }, *c.def);
}
Error check(const WorldState& s, const RemoveSoft& c) { return check_id(s, c.soft, "remove_soft"); }
Error check(const WorldState& s, const AttachSoft& c) {
  const Error e = check_vertex(s, c.soft, c.vertex, c.body ? "attach" : "pin");
  return e ? e : check_holder(s, c.body, "attach");
}
Error check(const WorldState& s, const AttachPoint& c) {
  const char* const what = c.body ? "attach_point" : "pin_point";
  if (const Error e = check_id(s, c.soft, what)) return e;
  if (const Error e = check_holder(s, c.body, what)) return e;
  const SoftEntry& entry = s.soft.entries[c.soft.index];
  if (entry.kind == SoftKind::rope) return refuse("%s: a rope is held at its vertices", what);
  if (entry.settings().integrator == SoftIntegrator::visual)
    return refuse("%s: what has the integrator visual is held at its vertices", what);
  float sum = 0.0f;
  for (std::size_t k = 0; k < 4; ++k) {
    const float weight = c.point.weights[k];
    if (!(weight >= -kWeightError && weight <= 1.0f + kWeightError))
      return refuse("%s: weights[%d] is %g; it must lie within 0 and 1", what, int(k), double(weight));
    sum += weight;
    if (weight == 0.0f) continue;
    if (const Error e = check_vertex(s, c.soft, c.point.vertices[k], what)) return e;
    for (std::size_t n = 0; n < k; ++n)
      if (c.point.weights[n] != 0.0f && c.point.vertices[n] == c.point.vertices[k])
        return refuse("%s: vertex %d is named twice", what, c.point.vertices[k]);
  }
  if (!(absolute(sum - 1.0f) <= 4.0f * kWeightError)) return refuse("%s: the weights add up to %g; it must be 1", what, double(sum));
  SoftPointAttachment found;
  if (!find_element(entry, c.point, found))
    return refuse("%s: no %s has all of these vertices as its corners", what, entry.kind == SoftKind::cloth ? "triangle" : "tetrahedron");
  return {};
}
Error check(const WorldState& s, const ReleasePoints& c) {
  const Error e = check_id(s, c.soft, "release_points");
  return e ? e : check_holder(s, c.body, "release_points");
}
Error check(const WorldState& s, const ReleaseSoft& c) { return check_vertex(s, c.soft, c.vertex, "release"); }
Error check(const WorldState& s, const SetVertices& c) {
  const Error e = check_id(s, c.soft, "set_vertices");
  if (e) return e;
  const std::size_t count = std::size_t(s.soft.entries[c.soft.index].body.particles.count);
  if (!c.positions.empty() && c.positions.size() != count)
    return refuse("set_vertices: there are %d positions and %d vertices", int(c.positions.size()), int(count));
  if (!c.velocities.empty() && c.velocities.size() != count)
    return refuse("set_vertices: there are %d velocities and %d vertices", int(c.velocities.size()), int(count));
  for (std::size_t i = 0; i < c.positions.size(); ++i) {
    const DVec3 p = c.positions[i];
    if (!is_finite(p) || absolute(p.x) > kMaxPosition || absolute(p.y) > kMaxPosition || absolute(p.z) > kMaxPosition)
      return refuse("set_vertices: positions[%d] is (%g, %g, %g); every component must be finite and within 1e12 m", int(i), p.x,
                    p.y, p.z);
  }
  for (std::size_t i = 0; i < c.velocities.size(); ++i) {
    if (!is_finite(c.velocities[i])) return refuse("set_vertices: velocities[%d] is not finite", int(i));
  }
  return {};
}

Error check(const WorldState& s, const SetVertexLimits& c) {
  const Error e = check_id(s, c.soft, "set_vertex_limits");
  if (e || c.targets.empty()) return e;
  const std::size_t count = std::size_t(s.soft.entries[c.soft.index].body.particles.count);
  const auto fits = [&](std::size_t size) { return size == count; };
  if (!fits(c.targets.size()) || !fits(c.distances.size()))
    return refuse("set_vertex_limits: there are %d targets and %d distances for %d vertices", int(c.targets.size()),
                  int(c.distances.size()), int(count));
  if (c.normals.size() != c.backstops.size() || (!c.normals.empty() && !fits(c.normals.size())))
    return refuse("set_vertex_limits: there are %d normals and %d backstops; there must be %d of both, or none", int(c.normals.size()),
                  int(c.backstops.size()), int(count));
  for (std::size_t i = 0; i < count; ++i) {
    const DVec3 p = c.targets[i];
    if (!is_finite(p) || absolute(p.x) > kMaxPosition || absolute(p.y) > kMaxPosition || absolute(p.z) > kMaxPosition)
      return refuse("set_vertex_limits: targets[%d] is (%g, %g, %g); every component must be finite and within 1e12 m", int(i), p.x, p.y,
                    p.z);
    if (!is_finite(c.distances[i])) return refuse("set_vertex_limits: distances[%d] is not finite", int(i));
    if (c.normals.empty()) continue;
    const float size = length(c.normals[i]);
    if (!is_finite(c.normals[i]) || !(absolute(size - 1.0f) < 1.0e-3f))
      return refuse("set_vertex_limits: normals[%d] has the length %g; it must be 1", int(i), double(size));
    if (!is_finite(c.backstops[i]) || c.backstops[i] < 0.0f)
      return refuse("set_vertex_limits: backstops[%d] is %g; it must be finite and at least 0", int(i), double(c.backstops[i]));
  }
  return {};
}

CommandResult execute(WorldState& s, const AddSoft& c) {
  const IdPool::Slot slot = s.soft.ids.acquire();
  if (s.soft.entries.size() < s.soft.ids.capacity()) s.soft.entries.resize(s.soft.ids.capacity());
  s.soft.entries[slot.index] = build_soft(c.def);
  CommandResult out;
  out.done = true;
  out.soft = soft_id(s, slot.index);
  return out;
}
CommandResult execute(WorldState& s, const RemoveSoft& c) {
  end_soft_touches(s, c.soft.index);
  for_each_contact(s.soft.entries[c.soft.index], [&](const SoftContact& contact) {
    if (contact.body != kWorldAnchor) wake(s.rigid, std::uint32_t(contact.body));
  });
  for_each_attachment(s.soft.entries[c.soft.index], [&](const auto& one) {
    if (one.body != kWorldAnchor) wake(s.rigid, std::uint32_t(one.body));
  });
  s.soft.entries[c.soft.index] = {};
  s.soft.ids.release(c.soft.index);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const AttachSoft& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  const std::uint32_t particle = std::uint32_t(c.vertex);
  const std::size_t at = find_attachment(entry, particle);
  if (!has_attachment(entry, at, particle)) entry.attachments.insert_at(at, SoftAttachment{.particle = particle});
  SoftAttachment& attachment = entry.attachments[at];
  const std::int32_t before = attachment.body;
  attachment.body = c.body ? std::int32_t(c.body.index) : kWorldAnchor;
  anchor_here(s.rigid, entry, attachment);
  if (before != kWorldAnchor && before != attachment.body) let_out(entry, before);
  if (attachment.body != kWorldAnchor) add_inside(s.rigid, entry, std::uint32_t(attachment.body), particle);
  wake(entry);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const ReleaseSoft& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  const std::size_t at = find_attachment(entry, std::uint32_t(c.vertex));
  if (!has_attachment(entry, at, std::uint32_t(c.vertex))) return {true, {}, {}, {}};
  const std::int32_t body = entry.attachments[at].body;
  if (body != kWorldAnchor) wake(s.rigid, std::uint32_t(body));
  entry.attachments.erase_at(at);
  let_out(entry, body);
  let_go(entry.body, c.vertex);
  wake(entry);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const AttachPoint& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  SoftPointAttachment point;
  find_element(entry, c.point, point);
  point.body = c.body ? std::int32_t(c.body.index) : kWorldAnchor;
  anchor_here(s.rigid, entry, point);
  entry.points.push_back(point);
  add_inside(s.rigid, entry, point);
  wake(entry);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const ReleasePoints& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  const std::int32_t body = c.body ? std::int32_t(c.body.index) : kWorldAnchor;
  if (!let_points_go(entry, body)) return {true, {}, {}, {}};
  if (body != kWorldAnchor) wake(s.rigid, std::uint32_t(body));
  let_out(entry, body);
  wake(entry);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetVertices& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  for (std::size_t i = 0; i < c.positions.size(); ++i) entry.body.particles.set_place(int(i), c.positions[i]);
  for (std::size_t i = 0; i < c.velocities.size(); ++i) entry.body.particles.set_velocity(int(i), c.velocities[i]);
  end_soft_touches(s, c.soft.index);
  forget_motion(entry);
  entry.rest[0] = {};
  if (!c.positions.empty()) {
    for_each_attachment(entry, [&](auto& one) { anchor_here(s.rigid, entry, one); });
    find_inside_again(s.rigid, entry);
  }
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetVertexLimits& c) {
  SoftEntry& entry = s.soft.entries[c.soft.index];
  entry.limits.clear();
  for (std::size_t i = 0; i < c.targets.size(); ++i) {
    SoftLimit limit{.target = c.targets[i], .distance = c.distances[i]};
    if (!c.normals.empty()) limit.normal = c.normals[i], limit.backstop = c.backstops[i];
    entry.limits.push_back(limit);
  }
  wake(entry);
  return {true, {}, {}, {}};
}

void wake_touching(SoftStore& soft, std::uint32_t body) {
  soft.for_each([&](SoftEntry& entry) {
    bool touches = false;
    for_each_contact(entry, [&](const SoftContact& one) { touches = touches || one.body == std::int32_t(body); });
    for_each_attachment(entry, [&](const auto& one) { touches = touches || one.body == std::int32_t(body); });
    if (touches) wake(entry);
  });
}

void forget_body(SoftStore& soft, std::uint32_t body) {
  soft.for_each([&](SoftEntry& entry) {
    for (std::size_t k = entry.attachments.size(); k-- > 0;) {
      if (entry.attachments[k].body != std::int32_t(body)) continue;
      let_go(entry.body, int(entry.attachments[k].particle));
      entry.attachments.erase_at(k);
      let_out(entry, std::int32_t(body));
      wake(entry);
    }
    if (!let_points_go(entry, std::int32_t(body))) return;
    let_out(entry, std::int32_t(body));
    wake(entry);
  });
}

// ------------------------------------------------------------------------------------------------------------- reading

void add_soft_energy(const SoftStore& soft, DVec3 gravity, Energy& energy) {
  soft.for_each([&](const SoftEntry& entry) {
    const Particles& p = entry.body.particles;
    for (int i = 0; i < p.count; ++i) {
      energy.kinetic += 0.5 * double(p.mass[i]) * length_squared(DVec3(p.velocity(i)));
      energy.potential -= double(p.mass[i]) * dot(gravity, p.place(i));
    }
    energy.soft_elastic += elastic_energy(entry.body);
  });
}
void add_soft_momentum(const SoftStore& soft, Momentum& momentum) {
  soft.for_each([&](const SoftEntry& entry) {
    const Particles& p = entry.body.particles;
    for (int i = 0; i < p.count; ++i) {
      const DVec3 one = double(p.mass[i]) * DVec3(p.velocity(i));
      momentum.linear += one;
      momentum.angular += cross(p.place(i), one);
    }
  });
}

bool World::exists(SoftId soft) const { return is_soft(*state_, soft); }
std::size_t World::softs(std::span<SoftId> out) const {
  const IdPool& ids = state_->soft.ids;
  std::size_t count = 0;
  ids.for_each_live([&](std::uint32_t slot) {
    if (count < out.size()) out[count] = {slot, std::uint16_t(ids.generation(slot)), state_->number};
    ++count;
  });
  return count;
}
SoftInfo World::soft_info(SoftId soft) const {
  if (!exists(soft)) return {};
  const FloatMode mode;
  const SoftEntry& entry = state_->soft.entries[soft.index];
  const Particles& p = entry.body.particles;
  SoftInfo info;
  info.kind = entry.kind;
  info.vertices = p.count;
  info.radius = entry.radius;
  info.contacts = int(entry.contacts.size() + entry.faces.size());
  info.user_data = entry.settings().user_data;
  info.awake = entry.is_awake();
  info.visual = entry.settings().integrator == SoftIntegrator::visual;
  info.elastic_energy = elastic_energy(entry.body);
  if (const EnclosedGas& gas = entry.body.gas; !gas.triangles.empty()) {
    info.volume = enclosed_volume(p, gas.triangles);
    info.pressure = gauge_pressure(gas, info.volume);
  }
  for (int i = 0; i < p.count; ++i) {
    info.mass += double(p.mass[i]);
    info.kinetic_energy += 0.5 * double(p.mass[i]) * length_squared(DVec3(p.velocity(i)));
  }
  return info;
}
SoftPoint World::nearest_soft_point(SoftId soft, DVec3 place) const {
  if (!exists(soft)) return {};
  const FloatMode mode;
  return find_nearest_point(state_->soft.entries[soft.index], place);
}
SoftVertices World::vertices(SoftId soft) const {
  if (!exists(soft)) return {};
  const Particles& p = state_->soft.entries[soft.index].body.particles;
  const std::size_t count = std::size_t(p.count);
  return {p.x.view().first(count),  p.y.view().first(count),  p.z.view().first(count),
          p.vx.view().first(count), p.vy.view().first(count), p.vz.view().first(count)};
}
std::span<const std::uint32_t> World::soft_triangles(SoftId soft) const {
  if (!exists(soft)) return {};
  return state_->soft.entries[soft.index].triangles.view();
}
std::size_t World::solid_tetrahedra(SoftId solid, std::span<std::uint32_t> out) const {
  if (!exists(solid)) return 0;
  std::size_t count = 0;
  for (const TetBlock& block : state_->soft.entries[solid.index].body.continuum.tetrahedra) {
    for (int lane = 0; lane < kTetLanes; ++lane) {
      if (!(block.volume[lane] > 0.0f)) continue;
      // Corners ascend in a block; the last two change places where that turns the tetrahedron inside out.
      const auto& m = block.gradient;
      const Vec3 x{m[0][lane], m[1][lane], m[2][lane]}, y{m[3][lane], m[4][lane], m[5][lane]},
          z{m[6][lane], m[7][lane], m[8][lane]};
      const bool inverted = dot(cross(x, y), z) < 0.0f;
      for (int k = 0; k < 4; ++k, ++count) {
        const int corner = inverted && k > 1 ? 5 - k : k;
        if (count < out.size()) out[count] = std::uint32_t(block.corner[corner][lane]);
      }
    }
  }
  return count;
}
std::size_t World::solid_stress(SoftId solid, std::span<float> out) const {
  if (!exists(solid)) return 0;
  const FloatMode mode;
  const SoftBody& body = state_->soft.entries[solid.index].body;
  std::size_t count = 0;
  for (std::size_t t = 0; t < body.continuum.tetrahedra.size() * kTetLanes; ++t) {
    if (!(body.continuum.tetrahedra[t / kTetLanes].volume[t % kTetLanes] > 0.0f)) continue;
    if (count < out.size()) out[count] = float(von_mises(stress_of(body, t)));
    ++count;
  }
  return count;
}
std::size_t World::soft_strain(SoftId soft, std::span<float> out) const {
  if (!exists(soft)) return 0;
  const FloatMode mode;
  const Array<float> strains = find_strains(state_->soft.entries[soft.index]);
  for (std::size_t i = 0; i < min(strains.size(), out.size()); ++i) out[i] = strains[i];
  return strains.size();
}
std::size_t World::soft_surface(SoftId soft, std::span<DVec3> out) const {
  if (!exists(soft)) return 0;
  const FloatMode mode;
  const SoftEntry& entry = state_->soft.entries[soft.index];
  const std::size_t count = entry.surface.points.size();
  for (std::size_t i = 0; i < min(count, out.size()); ++i) out[i] = surface_position(entry, i);
  return count;
}
std::span<const std::uint32_t> World::soft_surface_triangles(SoftId soft) const {
  if (!exists(soft)) return {};
  return state_->soft.entries[soft.index].surface.triangles.view();
}

const char* to_string(SoftKind kind) {
  switch (kind) {
    case SoftKind::rope:
      return "rope";
    case SoftKind::cloth:
      return "cloth";
    case SoftKind::solid:
      return "solid";
  }
  return "unknown";
}
const char* to_string(SoftIntegrator integrator) {
  switch (integrator) {
    case SoftIntegrator::implicit:
      return "implicit";
    case SoftIntegrator::explicit_euler:
      return "explicit_euler";
    case SoftIntegrator::semi_implicit_euler:
      return "semi_implicit_euler";
    case SoftIntegrator::rk4:
      return "rk4";
    case SoftIntegrator::verlet:
      return "verlet";
    case SoftIntegrator::sdirk2:
      return "sdirk2";
    case SoftIntegrator::visual:
      return "visual";
  }
  return "unknown";
}
const char* to_string(RopeLinks links) { return links == RopeLinks::springs ? "springs" : "rods"; }
const char* to_string(ClothLinks links) {
  return links == ClothLinks::springs ? "springs" : links == ClothLinks::rods ? "rods" : "membrane";
}
const char* to_string(PressureLaw law) { return law == PressureLaw::ideal_gas ? "ideal_gas" : "constant"; }
const char* to_string(SolidModel model) {
  return model == SolidModel::linear ? "linear" : model == SolidModel::corotated ? "corotated" : "neo_hookean";
}

// ------------------------------------------------------------------------------------------------------ loaded columns

Error check_soft_columns(const RigidWorld& w, const SoftStore& soft) {
  const auto bad = [](const char* what) {
    return make_error(ErrorCode::invalid_data, "the state does not hang together: %s", what);
  };
  if (soft.ids.capacity() != soft.entries.size()) return bad("ids and entries of soft matter differ in length");
  for (std::uint32_t slot = 0; slot < soft.entries.size(); ++slot) {
    const SoftEntry& entry = soft.entries[slot];
    if (soft.ids.live(slot) != (entry.def != nullptr)) return bad("soft matter without an id");
    const std::uint32_t count = std::uint32_t(entry.body.particles.count);
    const auto good_body = [&](std::int32_t body) {
      return body == kWorldAnchor || (body >= 0 && w.bodies.ids.live(std::uint32_t(body)));
    };
    for (std::size_t k = 0; k < entry.attachments.size(); ++k) {
      const SoftAttachment& one = entry.attachments[k];
      if (one.particle >= count || !good_body(one.body)) return bad("an attachment without its vertex or body");
      if (k > 0 && entry.attachments[k - 1].particle >= one.particle) return bad("attachments out of order");
      if (!is_finite(one.place) || !is_finite(one.local) || !is_finite(one.impulse)) return bad("an attachment that is not finite");
    }
    for (const SoftPointAttachment& one : entry.points) {
      if (corners_of(entry, one.element).count == 0 || !good_body(one.body)) return bad("an attached point without its element or body");
      bool finite = is_finite(one.place) && is_finite(one.local) && is_finite(one.impulse);
      for (const float weight : one.weight) finite = finite && is_finite(weight);
      if (!finite) return bad("an attached point that is not finite");
    }
    for (std::size_t k = 0; k < entry.inside.size(); ++k) {
      const SoftInside& one = entry.inside[k];
      if (one.particle >= count || one.body < 0 || !good_body(one.body)) return bad("a vertex inside a body that is not there");
      if (k > 0 && (entry.inside[k - 1].particle > one.particle ||
                    (entry.inside[k - 1].particle == one.particle && entry.inside[k - 1].body >= one.body)))
        return bad("vertices inside bodies out of order");
    }
    if (entry.limits.size() > count) return bad("more limits than vertices");
    for (const SoftLimit& one : entry.limits)
      if (!is_finite(one.target) || !is_finite(one.distance) || !is_finite(one.normal) || !is_finite(one.backstop))
        return bad("a limit of a vertex that is not finite");
    for (const SoftContact& one : entry.contacts) {
      if (one.particle >= count || one.shape >= w.shapes.ids.capacity() || !good_body(one.body))
        return bad("a contact of a vertex that is not there");
      if (!is_finite(one.impulse) || !is_finite(one.normal) || !is_finite(one.from_body)) return bad("a contact that is not finite");
    }
    for (const SoftFaceContact& one : entry.faces) {
      if (one.at.particle >= count || one.others[0] >= count || one.others[1] >= count ||
          one.at.shape >= w.shapes.ids.capacity() || !good_body(one.at.body))
        return bad("a contact of a face that is not there");
      if (!is_finite(one.at.impulse) || !is_finite(one.at.normal) || !is_finite(one.at.from_body) ||
          !is_finite(Vec3{one.weight[0], one.weight[1], one.weight[2]}))
        return bad("a contact of a face that is not finite");
    }
  }
  return {};
}

}  // namespace gyre
