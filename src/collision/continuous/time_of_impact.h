// When two shapes, both moving and turning, first come near each other.
//
// A body's motion over a step is taken as its centre of mass on a straight line at constant speed and a turn at constant
// rate about a fixed axis. Conservative advancement: from a distance d along n, no two points can meet before d over the
// fastest that the two can close along n, so time may go on by that much; the steps shrink towards the impact and never
// pass it. Times run from 0 (the step's start) to 1.
//
// Source: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, section 2.3 (the bound on closing
// speed); the distance by GJK.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// How a body moves over a step.
struct Sweep {
  Pose pose;    // of its origin, as the step begins
  Vec3 center;  // centre of mass, body frame
  Vec3 translation;  // m, of the centre of mass over the whole step
  Vec3 rotation;     // rad, rotation vector over the whole step, world frame
};

// Where the body is at a time. pose_at(sweep, 1) is where the step ends, pose_at(sweep, 0) is sweep.pose to rounding.
Pose pose_at(const Sweep& sweep, double time);

struct SweptShape {
  const Shape* shape = nullptr;  // convex, or a plane
  Transform body_from_shape;
  const Sweep* sweep = nullptr;
  float radius = 0.0f;  // m, farthest point from the centre of mass; no matter for what does not turn
};
SweptShape make_swept_shape(const Shape& shape, const Transform& body_from_shape, const Sweep& sweep);

struct Gap {
  double distance = 0.0;  // of the surfaces; 0 or less: they overlap, by some amount or other
  DVec3 normal;           // unit, from A to B, world axes
  bool beyond = false;    // farther apart than asked for; `distance` is then a lower bound along `normal`
};
// At most one of the two may be a plane.
Gap find_gap(const SweptShape& a, const SweptShape& b, double time, double max_distance);

struct Impact {
  bool hit = false;
  double time =
      1.0;  // if hit: the gap is then between `target` and 1.25 `target`, or less if it was so at the start
};
// The first time from `start` to `end` at which the two are as near as `target` (m, above zero).
Impact time_of_impact(const SweptShape& a, const SweptShape& b, double start, double end, double target);

// Whether the two stay farther apart than `distance` from `start` to `end`, as far as the axes of B's frame can tell: true is
// certain, false says nothing (always so of planes). A small part of the work of time_of_impact, which then finds no hit.
bool stays_clear(const SweptShape& a, const SweptShape& b, double start, double end, double distance);

}  // namespace gyre
