// The questions that a character asks the world, with its capsule: casts that keep a gap, ground, ways out of overlap.
#pragma once

#include <gyre/kit/character.h>

namespace gyre::kit {

// What stops a character is kept this far away, so that rounding never makes them overlap.
constexpr float kGap = 1.0e-3f;  // m

// The upright capsule whose lowest point is `feet`.
ShapePose capsule_place(const CharacterDef& def, DVec3 feet, float height);

struct WalkHit {
  bool any = false;
  double distance = 0.0;  // m, along the way, to where it touches
  Vec3 normal{};          // out of what is touched
  DVec3 point{};
  BodyId body{};
  bool dynamic = false;
};

class Walker {
 public:
  Walker(const World& world, const CharacterDef& def, const CharacterState& state)
      : world_(world), def_(def), state_(state) {}

  const CharacterDef& def() const { return def_; }
  const World& world() const { return world_; }
  float along_up(Vec3 v) const { return dot(v, def_.up); }
  Vec3 flat(Vec3 v) const { return v - along_up(v) * def_.up; }
  double height_of(DVec3 p) const { return dot(p, DVec3(def_.up)); }

  ShapePose shape_at(DVec3 feet, float height) const;
  // What the capsule first touches on its way (m) from a place.
  WalkHit cast(DVec3 feet, Vec3 way, BodyId ignored = {}) const {
    return cast(shape_at(feet, state_.height), way, ignored);
  }
  // What is below; a little thinner, so that walls alongside are not.
  WalkHit cast_down(DVec3 feet, float reach) const;
  // Goes along the way until the gap to what is in it; returns the way that was gone.
  Vec3 go(DVec3& feet, Vec3 way, WalkHit& hit, BodyId ignored = {}) const;
  // Whether a hit can be stood on: by its own normal, or because it is the edge of a face that can.
  bool is_firm(const WalkHit& hit) const;
  // The normal of the face to which it belongs; its own if there is none.
  Vec3 face_normal(const WalkHit& hit) const;
  bool is_firm(Vec3 normal) const;
  // Pushes the capsule out of what it overlaps; false if it is still in something.
  bool escape(DVec3& feet) const;
  bool is_free(DVec3 feet, float height) const;

 private:
  WalkHit cast(const ShapePose& place, Vec3 way, BodyId ignored) const;
  QueryFilter filter(std::uint32_t layers, BodyId ignored) const;
  WalkHit to_hit(const CastHit& hit, float length) const;

  const World& world_;
  const CharacterDef& def_;
  const CharacterState& state_;
};

}  // namespace gyre::kit
