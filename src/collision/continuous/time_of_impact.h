// The time of impact of two moving and rotating shapes.
//
// Over a step a body's centre of mass moves on a straight line at constant speed, and the body rotates at a constant
// rate about a fixed axis. Conservative advancement: at a distance d along n, no two points can meet before d over the
// largest closing speed along n, so time may advance by that much. The advances shrink towards the impact and never
// pass it. Times run from 0 (the start of the step) to 1.
//
// Source: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, section 2.3 (the bound on closing
// speed); the distance by GJK.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// The motion of a body over a step.
struct Sweep {
  Pose pose;         // of its origin, at the start of the step
  Vec3 center;       // centre of mass, body frame
  Vec3 translation;  // m, of the centre of mass over the whole step
  Vec3 rotation;     // rad, rotation vector over the whole step, world frame
};

// The pose of the body at a time. pose_at(sweep, 1) is the end of the step, pose_at(sweep, 0) is sweep.pose to
// rounding.
Pose pose_at(const Sweep& sweep, double time);

struct SweptShape {
  const Shape* shape = nullptr;  // convex, or a plane
  Transform body_from_shape;
  const Sweep* sweep = nullptr;
  float radius = 0.0f;  // m, from the centre of mass to the farthest point; unused without rotation
};
SweptShape make_swept_shape(const Shape& shape, const Transform& body_from_shape, const Sweep& sweep);

struct Gap {
  double distance = 0.0;  // of the surfaces; 0 or less: they overlap
  DVec3 normal;           // unit, from A to B, world axes
  // farther apart than `max_distance`; `distance` is then a lower bound along `normal`
  bool beyond = false;
};
// At most one of the two may be a plane.
Gap find_gap(const SweptShape& a, const SweptShape& b, double time, double max_distance);

struct Impact {
  bool hit = false;
  double time = 1.0;  // if hit: the gap is between `target` and 1.25 `target`, or less if it began so
};
// The first time from `start` to `end` at which the two come within `target` (m, above zero).
Impact time_of_impact(const SweptShape& a, const SweptShape& b, double start, double end, double target);

// True if the two certainly stay farther apart than `distance` from `start` to `end`, tested along the axes of B's
// frame only; false says nothing (always false for planes). Costs a small share of time_of_impact, which then finds no
// hit.
bool stays_clear(const SweptShape& a, const SweptShape& b, double start, double end, double distance);

}  // namespace gyre
