// CouplingRow: an inelastic contact with friction between two points of soft matter, each the mean of vertices. Its relative velocity is
// u = sum of weight times velocity over up to five vertices, and an impulse p on it gives vertex i the impulse weight_i p.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct CouplingRow {
  std::uint32_t vertex[5] = {};
  float weight[5] = {};
  Vec3 normal{};
  float target = 0.0f, allowed = 0.0f;  // m/s: least velocity along the normal; by how much it may be missed
  float friction[2] = {};               // static, dynamic
  float along = 0.0f, across = 0.0f;    // kg: how much it resists in a round, along the normal and across it
  bool slides = false;
  // False: the impulse is that of a damper below the target, and does not add up over stages; the target may be missed.
  bool adds_up = true;
  Vec3 impulse{};  // N s
};

}  // namespace gyre
