// CouplingRow: an inelastic contact with friction between two points of soft matter, each the mean of vertices, or between one and a point of a rigid body; or what
// holds two such points together. Its relative velocity is u = sum of weight times velocity over up to five vertices, less that of the body's point, and an impulse p on it gives vertex i the impulse
// weight_i p, and the body -p.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct CouplingRow {
  std::uint32_t vertex[5] = {};
  float weight[5] = {};
  std::int32_t body = -1;  // the number of a rigid body that yields; -1: none
  Vec3 arm{};              // m: from its centre of mass to the point
  Vec3
      passing{};  // m/s: velocity of the other side when the solve begins, of a body or of what does not yield
  Vec3 normal{};
  float target = 0.0f, allowed = 0.0f;  // m/s: least velocity along the normal; by how much it may be missed
  float friction[2] = {};               // static, dynamic
  float slow = 0.0f;  // m/s: what moves across the normal more slowly is held by static friction
  bool slides = false;
  bool holds =
      false;  // it pulls as well as it pushes, in all directions: the target is that of rest, and friction has no bound
  // Out: its velocity is below the target by more than it may be; it closes by more than that beyond the target.
  bool is_missed = false, is_closing = false;
  // kg. Above 0: the impulse is that of a damper below the target, and does not add up over stages; the target may be missed. 0: an impulse is found that meets it.
  float damper = 0.0f;
  Vec3 impulse{};  // N s
};

}  // namespace gyre
