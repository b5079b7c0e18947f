// Bodies and joints whose anchors are remembered, so that tests can see them part.
#pragma once

#include "laws/any_joint.h"
#include "laws/kit.h"

namespace gyre::laws {

class Assembly {
 public:
  explicit Assembly(const WorldDef& def) : world(make_world(def)) {}

  World world;
  std::vector<BodyId> bodies;
  std::vector<JointId> joints;

  BodyId add(const BodyDef& body, const AnyShape& shape, float density = 1000.0f) {
    // Parts of an assembly do not touch each other.
    bodies.push_back(world.add_body(
        body, {.geometry = shape, .density = density, .filter = {.layer = 2, .collides_with = 1}}));
    return bodies.back();
  }
  JointId join(JointKind kind, BodyId a, BodyId b, DVec3 anchor, Vec3 axis = {0, 0, 1},
               float friction = 0.0f) {
    anchors_.push_back({a, b, from_world(a, anchor), from_world(b, anchor)});
    joints.push_back(world.add_joint(
        definition_of({.kind = kind, .a = a, .b = b, .anchor = anchor, .axis = axis, .friction = friction})));
    return joints.back();
  }
  double largest_gap() const {
    double most = 0.0;
    for (const Anchor& anchor : anchors_) most = std::max(most, gap(anchor));
    return most;
  }
  double sum_of_gaps() const {
    double sum = 0.0;
    for (const Anchor& anchor : anchors_) sum += gap(anchor);
    return sum;
  }
  double energy() const {
    const Energy e = world.energy();
    return e.kinetic + e.potential;
  }

 private:
  struct Anchor {
    BodyId a, b;
    DVec3 on_a, on_b;
  };
  DVec3 from_world(BodyId body, DVec3 p) const {
    if (!world.exists(body)) return p;
    const Pose pose = world.pose(body);
    return turned_back(pose.orientation, p - pose.position);
  }
  DVec3 to_world(BodyId body, DVec3 p) const {
    if (!world.exists(body)) return p;
    const Pose pose = world.pose(body);
    return pose.position + turned(pose.orientation, p);
  }
  double gap(const Anchor& anchor) const {
    return length(to_world(anchor.a, anchor.on_a) - to_world(anchor.b, anchor.on_b));
  }

  std::vector<Anchor> anchors_;
};

}  // namespace gyre::laws
