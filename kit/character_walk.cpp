#include "kit/character_walk.h"

namespace gyre::kit {

namespace {

// Returns the rotation that takes y to `up`, a unit vector.
Quat turn_to(Vec3 up) {
  if (up.y < -0.999999f) return {1, 0, 0, 0};
  return normalized(Quat{up.z, 0.0f, -up.x, 1.0f + up.y});
}

float cosine(float angle) { return rotate(from_axis_angle({0, 0, 1}, angle), {1, 0, 0}).x; }

}  // namespace

ShapePose capsule_place(const CharacterDef& def, DVec3 feet, float height) {
  const float half = 0.5f * height - def.radius;
  return {Capsule{def.radius, half > 0.0f ? half : 0.0f},
          {feet + 0.5 * double(height) * DVec3(def.up), turn_to(def.up)}};
}

ShapePose Walker::shape_at(DVec3 feet, float height) const { return capsule_place(def_, feet, height); }

QueryFilter Walker::filter(std::uint32_t layers, BodyId ignored) const {
  QueryFilter out;
  out.layers = layers;
  out.soft = false;  // it walks on bodies
  out.ignored = ignored ? ignored : state_.body;
  return out;
}

WalkHit Walker::to_hit(const CastHit& hit, float length) const {
  WalkHit out;
  out.any = true;
  out.distance = hit.fraction * double(length);
  out.normal = hit.normal;
  out.point = hit.point;
  out.body = hit.body;
  out.dynamic = world_.type(hit.body) == BodyType::dynamic;
  return out;
}

WalkHit Walker::cast_down(DVec3 feet, float reach) const {
  ShapePose place = shape_at(feet, state_.height);
  Capsule& capsule = std::get<Capsule>(place.shape);
  capsule.radius -= 2.0f * kGap;
  capsule.half_height += 2.0f * kGap;
  return cast(place, -reach * def_.up, {});
}

WalkHit Walker::cast(const ShapePose& place, Vec3 way, BodyId ignored) const {
  const float size = length(way);
  if (!(size > 0.0f)) return {};
  // A little overlap does not stop a motion that leads out of it or along it.
  const ShapeCast question{place.shape, place.pose, way, 4.0f * kGap};
  WalkHit out;
  const std::uint32_t solid = def_.layers & ~def_.one_way_layers;
  if (const auto hit = world_.cast_shape(question, filter(solid, ignored))) out = to_hit(*hit, size);
  const std::uint32_t one_way = def_.layers & def_.one_way_layers;
  if (one_way == 0 || along_up(way) >= 0.0f) return out;
  // One-way shapes stop motion from above, but not from inside or at their sides.
  const auto hit = world_.cast_shape(question, filter(one_way, ignored));
  if (!hit || (hit->inside && hit->depth > 2.0f * kGap) || along_up(hit->normal) < 0.7f) return out;
  const WalkHit held = to_hit(*hit, size);
  return !out.any || held.distance < out.distance ? held : out;
}

Vec3 Walker::go(DVec3& feet, Vec3 way, WalkHit& hit, BodyId ignored) const {
  const float size = length(way);
  hit = {};
  if (!(size > 0.0f)) return {};
  const Vec3 direction = way / size;
  // The cast is a little longer, so that the gap to an obstacle just beyond stays, too.
  const float reach = size + 2.0f * kGap;
  hit = cast(feet, reach * direction, ignored);
  double distance = double(size);
  if (hit.any) {
    const double facing = -double(dot(direction, hit.normal));
    const double room = hit.distance - double(kGap) / (facing > 0.3 ? facing : 0.3);
    if (room >= double(size)) {
      hit = {};
    } else {
      distance = room > 0.0 ? room : 0.0;
    }
  }
  const Vec3 gone = float(distance) * direction;
  feet = feet + gone;
  return gone;
}

bool Walker::is_firm(Vec3 normal) const { return along_up(normal) >= cosine(def_.max_slope) - 1.0e-5f; }

Vec3 Walker::face_normal(const WalkHit& hit) const {
  if (along_up(hit.normal) > 0.99999f || along_up(hit.normal) < 0.02f) return hit.normal;
  // A capsule meets an edge like a round surface. The face behind the edge decides, a little farther in and seen from above.
  const Vec3 inward = normalized(flat(-hit.normal), {});
  const Vec3 lift = (0.5f * def_.radius) * def_.up;
  const auto face = world_.cast_ray(hit.point + 0.02f * inward + lift, -2.0f * lift, filter(def_.layers, {}));
  // The face must lie as high as the edge, and the ray must not start inside a higher shape.
  if (!face || face->inside || height_of(face->point) - height_of(hit.point) > 0.03) return hit.normal;
  return face->normal;
}

bool Walker::is_firm(const WalkHit& hit) const {
  return hit.any && (is_firm(hit.normal) || is_firm(face_normal(hit)));
}

bool Walker::escape(DVec3& feet) const {
  constexpr int kRounds = 16;
  Penetration deep[8];
  const std::uint32_t solid = def_.layers & ~def_.one_way_layers;
  const DVec3 start = feet;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t count =
        world_.penetration_all(shape_at(feet, state_.height), deep, filter(solid, {}));
    if (count == 0 || deep[0].depth <= 2.0f * kGap) return true;
    // Each contact gets its displacement less that of the contacts before, so that adjacent faces do not push twice.
    Vec3 moved{};
    const std::size_t kept = count < 8 ? count : 8;
    for (std::size_t i = 0; i < kept; ++i) {
      const float left = deep[i].depth + kGap - dot(moved, deep[i].normal);
      if (deep[i].depth > kGap && left > 0.0f) moved += left * deep[i].normal;
    }
    feet = feet + moved;
  }
  if (is_free(feet, state_.height)) return true;
  // Faces on two sides push it to and fro. It is moved straight up to the first free place, by twice its height at most.
  constexpr int kTries = 16;
  for (int i = 1; i <= kTries; ++i) {
    const DVec3 higher = start + (2.0 * double(state_.height) * i / kTries) * DVec3(def_.up);
    if (!is_free(higher, state_.height)) continue;
    feet = higher;
    return true;
  }
  feet = start;
  return false;
}

bool Walker::is_free(DVec3 feet, float height) const {
  Penetration deep[1];
  const std::uint32_t solid = def_.layers & ~def_.one_way_layers;
  const std::size_t count = world_.penetration_all(shape_at(feet, height), deep, filter(solid, {}));
  return count == 0 || deep[0].depth <= 2.0f * kGap;
}

}  // namespace gyre::kit
