#include "dynamics/soft/soft_contacts.h"

#include "collision/broadphase/fat_box.h"
#include "dynamics/soft/soft_groups.h"
#include "dynamics/soft/soft_inside.h"
#include "geometry/query/face_query.h"
#include "geometry/query/point_query.h"
#include "geometry/shape/mesh.h"
#include "math/rotation.h"
#include "rigid/sleep/island.h"
#include "soft/store/soft_point.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

// A vertex is deep in a shape beyond this share of the length of an edge: what is made to lie on a shape is in it by rounding.
constexpr float kDeepShare = 0.01f;
constexpr int kParticlesPerBlock = 128;
// A surface is in reach if it is within the way of the vertex in the step, with this share more for what changes its speed, and within this
// share of the length of an edge.
constexpr float kReachShare = 1.5f;
constexpr float kSpeculativeEdge = 0.25f;
// A vertex so near to an attachment, in lengths of an edge, does not collide with the body that it is attached to.
constexpr float kAttachedShare = 1.1f;

// A face touches where it comes nearer to a shape than its corners, by more than this share of the radius: where these keep the radius, the face keeps the
// rest of it.
constexpr double kFaceShare = 0.9;
// A face that is nearer than this share of the length of an edge is pushed along its own normal: the shape's is not to be trusted there.
constexpr double kTooNear = 1.0e-3;

// A plane is touched by corners alone. A double-sided mesh has no outside.
bool may_touch_faces(const Shape& shape) {
  return shape.kind != ShapeKind::plane && !(shape.kind == ShapeKind::mesh && shape.mesh->double_sided);
}

struct Candidate {
  std::uint32_t shape = 0;
  std::uint32_t body = 0;
  Pose pose;  // world_from_shape
  float static_friction = 0.0f, dynamic_friction = 0.0f;
};

class ContactFinder {
 public:
  ContactFinder(RigidWorld& w, SoftEntry& entry, Array<std::uint32_t>& shapes_near, Arena& arena,
                float seconds)
      : w_(w),
        entry_(entry),
        p_(entry.body.particles),
        seconds_(seconds),
        fall_(seconds * length(w.settings.gravity)),
        arena_(arena) {
    list_candidates(shapes_near);
  }

  void run(TaskSystem& tasks) {
    if (candidates_.empty()) {
      entry_.contacts.clear(), entry_.faces.clear();
      return;
    }
    const std::size_t count = std::size_t(p_.count);
    const std::span<SoftContact> room = arena_.make<SoftContact>(count * kMaxVertexContacts);
    const std::span<std::uint8_t> found = arena_.make<std::uint8_t>(count);
    for_blocks(tasks, p_.count, kParticlesPerBlock, [&](int begin, int end, int) {
      for (int i = begin; i < end; ++i)
        found[std::size_t(i)] =
            std::uint8_t(find(i, room.subspan(std::size_t(i) * kMaxVertexContacts, kMaxVertexContacts)));
    });
    Array<SoftContact>& contacts = entry_.contacts;
    const std::span<SoftContact> before = arena_.make<SoftContact>(contacts.size());
    for (std::size_t k = 0; k < before.size(); ++k) before[k] = contacts[k];
    contacts.clear();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < found[i]; ++k) contacts.push_back(room[i * kMaxVertexContacts + k]);
    }
    keep_impulses(before);
    touch_faces(tasks, room, found);
  }

  // True if a body moves that is near or that a vertex is attached to.
  bool is_anything_moving() const {
    for (const Candidate& candidate : candidates_)
      if (can_wake_others(w_, candidate.body)) return true;
    bool any = false;
    for_each_attachment(entry_, [&](const auto& one) {
      any = any || (one.body != kWorldAnchor && can_wake_others(w_, std::uint32_t(one.body)));
    });
    return any;
  }

 private:
  float reach_of(int i) const {
    const float way = seconds_ * length(p_.velocity(i)) + seconds_ * fall_;
    return entry_.radius + kReachShare * way + kSpeculativeEdge * entry_.size;
  }

  void list_candidates(Array<std::uint32_t>& shapes_near) {
    DVec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (int i = 0; i < p_.count; ++i) {
      const DVec3 at = p_.place(i);
      const double reach = double(reach_of(i));
      low = {min(low.x, at.x - reach), min(low.y, at.y - reach), min(low.z, at.z - reach)};
      high = {max(high.x, at.x + reach), max(high.y, at.y + reach), max(high.z, at.z + reach)};
    }
    shapes_near.clear();
    // An explicit integrator that gains energy comes to places beyond the range of floats before the step finds out.
    const bool is_in_range = length(low) < double(kUnboundedSide) && length(high) < double(kUnboundedSide);
    if (is_in_range) {
      const Aabb box = grow({to_float(low), to_float(high)}, 1.0e-6f * float(max(length(low), length(high))));
      w_.broadphase->query(w_.shapes.proxies, box, shapes_near);
    }
    candidates_ = arena_.make<Candidate>(shapes_near.size());
    std::size_t count = 0;
    const SoftSettings& settings = entry_.settings();
    Proxy own;
    own.filter = settings.filter, own.body = kNoIndex, own.motion = ProxyMotion::moving;
    const Material material{.static_friction = settings.static_friction,
                            .dynamic_friction = settings.dynamic_friction,
                            .restitution = 0.0f};
    for (const std::uint32_t shape : shapes_near) {
      const Proxy& proxy = w_.shapes.proxies[shape];
      if (proxy.sensor || !may_pair(own, proxy)) continue;
      const std::uint32_t body = w_.shapes.bodies[shape];
      const ContactSurface surface = combine_materials(w_, material, w_.shapes.materials[shape]);
      candidates_[count++] = {shape, body, origin_pose(w_.bodies, body) * w_.shapes.body_from_shape[shape],
                              surface.static_friction, surface.dynamic_friction};
    }
    candidates_ = candidates_.first(count);
  }

  bool is_attached_near(int i, std::uint32_t body) const {
    const DVec3 place = p_.place(i);
    const auto is_near = [&](DVec3 held) {
      return length(place - held) <= double(kAttachedShare * entry_.size);
    };
    for (const SoftAttachment& one : entry_.attachments) {
      if (one.body != std::int32_t(body)) continue;
      if (one.particle == std::uint32_t(i) || is_near(p_.place(int(one.particle)))) return true;
    }
    for (const SoftPointAttachment& one : entry_.points) {
      if (one.body != std::int32_t(body)) continue;
      if (corners_of(entry_, one.element).has(std::uint32_t(i)) || is_near(place_of(entry_, one)))
        return true;
    }
    return false;
  }

  // Writes the nearest contacts of a particle, ascending by shape; returns how many.
  int find(int i, std::span<SoftContact> out) const {
    const DVec3 at = p_.place(i);
    int count = 0;
    for (const Candidate& candidate : candidates_) {
      const BodyMotion& motion = w_.bodies.motion[candidate.body];
      const Vec3 arm = difference(at, w_.bodies.poses[candidate.body].center);
      const float own = length(point_velocity(motion, arm));
      const double reach = double(reach_of(i) + kReachShare * seconds_ * own);
      if (is_beyond(w_.shapes.proxies[candidate.shape].fat_box, at, reach)) continue;
      PointDistance found;
      const DQuat turn = to_double(candidate.pose.orientation);
      const DVec3 local = rotate_inverse(turn, at - candidate.pose.position);
      if (!find_point_distance(w_.shapes.colliders[candidate.shape].shape, local, reach, found)) continue;
      if (is_inside(entry_, std::uint32_t(i), candidate.body) || is_attached_near(i, candidate.body))
        continue;
      SoftContact contact;
      contact.particle = std::uint32_t(i), contact.shape = candidate.shape;
      contact.body = std::int32_t(candidate.body);
      contact.triangle = found.triangle;
      contact.normal = to_float(rotate(turn, found.normal));
      const DVec3 on_surface = candidate.pose.position + rotate(turn, found.on_surface);
      contact.from_body = difference(on_surface, w_.bodies.poses[candidate.body].center);
      contact.gap = float(found.distance) - entry_.radius;
      contact.static_friction = candidate.static_friction;
      contact.dynamic_friction = candidate.dynamic_friction;
      count = insert(out, count, contact);
    }
    return count;
  }

  // ------------------------------------------------------------------------------------------------------- faces

  void touch_faces(TaskSystem& tasks, std::span<const SoftContact> touching,
                   std::span<const std::uint8_t> counts) {
    const std::span<SoftFaceContact> before = arena_.make<SoftFaceContact>(entry_.faces.size());
    for (std::size_t k = 0; k < before.size(); ++k) before[k] = entry_.faces[k];
    entry_.faces.clear();
    bool any = false;
    for (const Candidate& one : candidates_)
      any = any || may_touch_faces(w_.shapes.colliders[one.shape].shape);
    if (!any || entry_.contact_surface == nullptr) return;
    const std::size_t faces = entry_.contact_surface->triangles.size();
    const std::span<SoftFaceContact> room = arena_.make<SoftFaceContact>(faces);
    const std::span<std::uint8_t> found = arena_.make<std::uint8_t>(faces);
    const std::span<float> reach = arena_.make<float>(std::size_t(p_.count));
    for (int i = 0; i < p_.count; ++i) reach[std::size_t(i)] = reach_of(i);
    emerging_ = arena_.make<std::uint8_t>(std::size_t(p_.count));
    for (std::uint8_t& one : emerging_) one = 0;
    emerges_from_ = arena_.make<std::int32_t>(candidates_.size()).first(0);
    for (const SoftContact& one : entry_.contacts) {
      if (one.grip != SoftGrip::emerges) continue;
      emerging_[one.particle] = 1;
      if (!emerges_from(one.body)) add_emerging(one.body);
    }
    for_blocks(tasks, int(faces), kParticlesPerBlock, [&](int begin, int end, int) {
      for (std::size_t t = std::size_t(begin); t < std::size_t(end); ++t)
        found[t] = find_face(std::uint32_t(t), reach, touching, counts, before, room[t]);
    });
    for (std::size_t t = 0; t < faces; ++t)
      if (found[t] != 0) entry_.faces.push_back(room[t]);
  }

  // True if the corners touch the shape along normals so alike that the face between them cannot come nearer by more than its share of the radius: for an
  // angle of a between normals, by no more than 0.29 a of the length of an edge.
  bool is_level(const std::uint32_t* corner, std::uint32_t shape, std::span<const SoftContact> touching,
                std::span<const std::uint8_t> counts) const {
    const float share = float(kFaceShare) * entry_.radius / entry_.size, alike = 1.0f - 6.0f * share * share;
    Vec3 normal[3];
    for (int k = 0; k < 3; ++k) {
      bool there = false;
      for (std::size_t n = 0; n < counts[corner[k]] && !there; ++n) {
        const SoftContact& one = touching[std::size_t(corner[k]) * kMaxVertexContacts + n];
        there = one.shape == shape;
        normal[k] = one.normal;
      }
      if (!there) return false;
    }
    return dot(normal[0], normal[1]) > alike && dot(normal[1], normal[2]) > alike &&
           dot(normal[2], normal[0]) > alike;
  }

  // The contact of a face with the shape that it is nearest to, if it has one.
  bool find_face(std::uint32_t number, std::span<const float> reach, std::span<const SoftContact> touching,
                 std::span<const std::uint8_t> counts, std::span<const SoftFaceContact> before,
                 SoftFaceContact& out) const {
    const SoftTriangle& face = entry_.contact_surface->triangles[number];
    const std::uint32_t* const v = face.corner;
    const DVec3 at[3] = {p_.place(int(v[0])), p_.place(int(v[1])), p_.place(int(v[2]))};
    const DVec3 middle = (1.0 / 3.0) * (at[0] + at[1] + at[2]);
    double size = 0.0;
    for (const DVec3 corner : at) size = max(size, length(corner - middle));
    double own_reach = double(max(reach[v[0]], max(reach[v[1]], reach[v[2]])));
    bool any = false;
    for (const Candidate& candidate : candidates_) {
      const Shape& shape = w_.shapes.colliders[candidate.shape].shape;
      if (!may_touch_faces(shape)) continue;
      const bool is_convex = has_face_distance(shape);
      if (is_beyond(w_.shapes.proxies[candidate.shape].fat_box, middle, size + own_reach)) continue;
      if (is_convex && is_level(v, candidate.shape, touching, counts)) continue;
      const Vec3 arm = difference(middle, w_.bodies.poses[candidate.body].center);
      const float speed = length(point_velocity(w_.bodies.motion[candidate.body], arm));
      const DQuat turn = to_double(candidate.pose.orientation);
      DVec3 local[3];
      for (int k = 0; k < 3; ++k) local[k] = rotate_inverse(turn, at[k] - candidate.pose.position);
      FaceDistance found;
      const double reach_now = own_reach + double(kReachShare * seconds_ * speed),
                   least_depth = kFaceShare * double(entry_.radius);
      if (is_convex ? !find_face_distance(shape, local, reach_now, least_depth, found)
                    : !find_surface_features(
                          shape, local, reach_now,
                          min(reach_now, nearest_corner(v, candidate.shape, touching, counts) - least_depth),
                          found))
        continue;
      if (any && found.distance - double(entry_.radius) >= double(out.at.gap)) continue;
      if (is_shared_edge(number, found) || is_kept_off(v, candidate.body)) continue;
      any = true;
      out = {};
      out.face = number;
      for (int k = 0; k < 3; ++k) out.weight[k] = float(found.weight[k]);
      out.at.particle = v[0], out.others[0] = v[1], out.others[1] = v[2];
      set_face(candidate, at, found, before, out);
    }
    return any;
  }

  // The least distance of the corners from the shape, m, of those that are in reach.
  double nearest_corner(const std::uint32_t* corner, std::uint32_t shape,
                        std::span<const SoftContact> touching, std::span<const std::uint8_t> counts) const {
    double nearest = kAnyDepth;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t n = 0; n < counts[corner[k]]; ++n) {
        const SoftContact& one = touching[std::size_t(corner[k]) * kMaxVertexContacts + n];
        if (one.shape == shape) nearest = min(nearest, double(one.gap + entry_.radius));
      }
    }
    return nearest;
  }

  // An edge between two faces is one contact: that of the face that owns it.
  bool is_shared_edge(std::uint32_t number, const FaceDistance& found) const {
    const SoftTriangle& face = entry_.contact_surface->triangles[number];
    for (int side = 0; side < 3; ++side) {
      if (!(found.weight[(side + 2) % 3] > 0.0))
        return face.owned_edge[side] < 0 && face.neighbour[side] >= 0;
    }
    return false;
  }
  bool is_kept_off(const std::uint32_t* corner, std::uint32_t body) const {
    for (int k = 0; k < 3; ++k) {
      if (is_inside(entry_, corner[k], body) || is_attached_near(int(corner[k]), body)) return true;
      if (emerging_[corner[k]] != 0) return true;
    }
    return false;
  }
  // True if a vertex emerges from a body. That may be within the solid, whose faces would press it apart from all sides: they emerge, too.
  bool emerges_from(std::int32_t body) const {
    for (const std::int32_t one : emerges_from_)
      if (one == body) return true;
    return false;
  }
  void add_emerging(std::int32_t body) {
    emerges_from_ = {emerges_from_.data(), emerges_from_.size() + 1};
    emerges_from_.back() = body;
  }

  void set_face(const Candidate& candidate, const DVec3 (&at)[3], const FaceDistance& found,
                std::span<const SoftFaceContact> before, SoftFaceContact& out) const {
    const SoftFaceContact* last = nullptr;
    for (const SoftFaceContact& one : before) {
      if (one.face == out.face && one.at.shape == candidate.shape) last = &one;
    }
    const DQuat turn = to_double(candidate.pose.orientation);
    const DVec3 center = w_.bodies.poses[candidate.body].center;
    DVec3 place{};
    for (int k = 0; k < 3; ++k) place += found.weight[k] * at[k];
    DVec3 normal = rotate(turn, found.normal);
    if (found.distance < kTooNear * double(entry_.size) &&
        has_face_distance(w_.shapes.colliders[candidate.shape].shape)) {
      // The side on which it was, or else that away from the body.
      const DVec3 area = cross(at[1] - at[0], at[2] - at[0]);
      const DVec3 toward = last != nullptr ? DVec3(last->at.normal) : place - center;
      const double size = length(area), along = dot(area, toward);
      if (size > 0.0 && along != 0.0) normal = (along > 0.0 ? 1.0 / size : -1.0 / size) * area;
    }
    SoftContact& contact = out.at;
    contact.shape = candidate.shape, contact.body = std::int32_t(candidate.body);
    contact.normal = to_float(normal);
    contact.from_body = difference(place - found.distance * normal, center);
    contact.gap = float(found.distance) - entry_.radius;
    contact.static_friction = candidate.static_friction;
    contact.dynamic_friction = candidate.dynamic_friction;
    keep_grip(last != nullptr ? &last->at : nullptr, contact);
  }

  static bool is_beyond(const Aabb& box, DVec3 at, double reach) {
    return at.x < double(box.low.x) - reach || at.x > double(box.high.x) + reach ||
           at.y < double(box.low.y) - reach || at.y > double(box.high.y) + reach ||
           at.z < double(box.low.z) - reach || at.z > double(box.high.z) + reach;
  }

  // Keeps the nearest ones if there is no room for all; shapes come ascending.
  static int insert(std::span<SoftContact> out, int count, const SoftContact& contact) {
    if (count < kMaxVertexContacts) {
      out[std::size_t(count)] = contact;
      return count + 1;
    }
    std::size_t farthest = 0;
    for (std::size_t k = 1; k < out.size(); ++k)
      if (out[k].gap > out[farthest].gap) farthest = k;
    if (contact.gap >= out[farthest].gap) return count;
    for (std::size_t k = farthest; k + 1 < out.size(); ++k) out[k] = out[k + 1];
    out[out.size() - 1] = contact;
    return count;
  }

  // Both lists ascend by particle, then shape.
  void keep_impulses(std::span<const SoftContact> before) {
    std::size_t k = 0;
    for (SoftContact& contact : entry_.contacts) {
      const auto key = [](const SoftContact& c) { return std::uint64_t(c.particle) << 32 | c.shape; };
      while (k < before.size() && key(before[k]) < key(contact)) ++k;
      keep_grip(k < before.size() && key(before[k]) == key(contact) ? &before[k] : nullptr, contact);
    }
  }
  // A contact goes on with the impulse and the grip of the last step. A vertex or face that begins inside a shape, before any sub-step has moved it, emerges.
  void keep_grip(const SoftContact* last, SoftContact& contact) const {
    const bool is_new = is_implicit(entry_.settings().integrator) && entry_.body.pull[0].empty();
    if (last != nullptr) contact.impulse = last->impulse, contact.grip = last->grip;
    if ((last == nullptr && is_new) || emerges_from(contact.body)) contact.grip = SoftGrip::emerges;
    if (contact.grip == SoftGrip::emerges && !is_deep(contact)) contact.grip = SoftGrip::open;
  }
  // A vertex or face of a solid that is inside a shape, deeper than one that lies on it.
  bool is_deep(const SoftContact& contact) const {
    return entry_.kind == SoftKind::solid && contact.gap + entry_.radius < -kDeepShare * entry_.size;
  }

  RigidWorld& w_;
  SoftEntry& entry_;
  const Particles& p_;
  float seconds_;
  float fall_;  // m/s, what gravity adds in the step
  Arena& arena_;
  std::span<Candidate> candidates_{};
  std::span<std::uint8_t> emerging_{};      // by vertex
  std::span<std::int32_t> emerges_from_{};  // bodies
};

// Wakes bodies that are touched or held by what moves. An awake one does not fall asleep meanwhile.
void wake_bodies(RigidWorld& w, const SoftEntry& entry) {
  if (entry.rest[0].still_time >= kTimeToSleep) return;
  for_each_contact(entry, [&](const SoftContact& contact) {
    if (contact.gap <= 0.0f || contact.impulse != Vec3{}) wake(w, std::uint32_t(contact.body));
  });
  for_each_attachment(entry, [&](const auto& one) {
    if (one.body != kWorldAnchor) wake(w, std::uint32_t(one.body));
  });
}

// The speed below which a vertex is still: that of bodies of the size of what it belongs to.
float rest_speed(const RigidWorld& w, const SoftEntry& entry) {
  const Particles& p = entry.body.particles;
  DVec3 low = p.place(0), high = low;
  for (int i = 1; i < p.count; ++i) {
    const DVec3 at = p.place(i);
    low = {min(low.x, at.x), min(low.y, at.y), min(low.z, at.z)};
    high = {max(high.x, at.x), max(high.y, at.y), max(high.z, at.z)};
  }
  return sleep_share(w) * std::sqrt(reference_gravity(w.settings) * 0.5f * float(length(high - low)));
}

bool is_still(const RigidWorld& w, const SoftEntry& entry) {
  const Particles& p = entry.body.particles;
  const float most = rest_speed(w, entry);
  for (int i = 0; i < p.count; ++i)
    if (length_squared(p.velocity(i)) > most * most) return false;
  return true;
}

bool do_all_rest(const RigidWorld& w, const SoftEntry& entry) {
  bool all = true;
  for_each_contact(entry, [&](const SoftContact& contact) {
    all = all && (contact.impulse == Vec3{} || !can_wake_others(w, std::uint32_t(contact.body)));
  });
  for_each_attachment(entry, [&](const auto& one) {
    all = all && (one.body == kWorldAnchor || !can_wake_others(w, std::uint32_t(one.body)));
  });
  return all;
}

void fall_asleep(SoftEntry& entry) {
  entry.rest[0].asleep = kResting;
  Particles& p = entry.body.particles;
  for (int i = 0; i < p.count; ++i) p.set_velocity(i, {});
  for (Array<double>& moved : entry.body.moved) moved.clear();
}

// A group wakes as a whole: a surface that may touch one that is awake wakes too.
void wake_groups(SoftStore& soft, float gravity, Arena& arena, float seconds) {
  const ArenaScope scope(arena);
  const std::span<const std::uint32_t> group = group_soft(soft, gravity, seconds, arena);
  const std::span<std::uint8_t> awake = arena.make<std::uint8_t>(soft.entries.size());  // by group
  for (std::uint8_t& one : awake) one = 0;
  for (std::size_t slot = 0; slot < soft.entries.size(); ++slot) {
    const SoftEntry& entry = soft.entries[slot];
    if (entry.def != nullptr && entry.is_awake()) awake[group[slot]] = 1;
  }
  for (std::size_t slot = 0; slot < soft.entries.size(); ++slot) {
    SoftEntry& entry = soft.entries[slot];
    if (entry.def != nullptr && !entry.is_awake() && awake[group[slot]] != 0) wake(entry);
  }
}

}  // namespace

void rest_soft(RigidWorld& w, SoftStore& soft, Arena& arena, float seconds) {
  if (w.settings.sleeping == 0) return;
  const ArenaScope scope(arena);
  bool any_field = false;
  for (const FieldRecord& field : w.fields) any_field = any_field || field.is_live();
  const std::span<const std::uint32_t> group = group_soft(soft, length(w.settings.gravity), seconds, arena);
  const std::span<std::uint8_t> moves = arena.make<std::uint8_t>(soft.entries.size());  // by group
  for (std::uint8_t& one : moves) one = 0;
  const auto slot_of = [&](const SoftEntry& entry) { return std::size_t(&entry - soft.entries.data()); };
  soft.for_each([&](SoftEntry& entry) {
    if (!entry.is_awake()) return;
    SoftRest& rest = entry.rest[0];
    const bool is_at_rest = !any_field && !entry.crossings.moves && is_still(w, entry);
    rest.still_time = is_at_rest ? min(rest.still_time + seconds, kMaxStillTime) : 0.0f;
    if (rest.still_time < kMaxStillTime || !do_all_rest(w, entry)) moves[group[slot_of(entry)]] = 1;
  });
  soft.for_each([&](SoftEntry& entry) {
    if (entry.is_awake() && moves[group[slot_of(entry)]] == 0) fall_asleep(entry);
  });
}

void wake_all(SoftStore& soft) {
  soft.for_each([](SoftEntry& entry) { wake(entry); });
}

void find_soft_contacts(RigidWorld& w, SoftStore& soft, Array<std::uint32_t>& shapes_near, Arena& arena,
                        TaskSystem& tasks, float seconds) {
  soft.for_each([&](SoftEntry& entry) {
    if (entry.is_awake()) return;
    const ArenaScope scope(arena);
    if (ContactFinder(w, entry, shapes_near, arena, seconds).is_anything_moving()) wake(entry);
  });
  wake_groups(soft, length(w.settings.gravity), arena, seconds);
  soft.for_each([&](SoftEntry& entry) {
    if (!entry.is_awake()) return;
    const ArenaScope scope(arena);
    ContactFinder(w, entry, shapes_near, arena, seconds).run(tasks);
    wake_bodies(w, entry);
  });
  refresh_awake(w.bodies);
}

}  // namespace gyre
