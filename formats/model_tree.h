// A robot as a tree of links, and the bodies and joints of a scene made from it: links that are welded together become one body.
#pragma once

#include "formats/import_parts.h"

#include <optional>
#include <string>
#include <vector>

namespace gyre {

struct ModelLink {
  std::string name;
  int parent = -1;
  Pose pose{};                           // world_from_link
  bool welded = false;                   // part of the parent's body; without a parent: static
  std::vector<SceneShape> shapes{};      // in the frame of the link
  std::optional<MassProperties> mass{};  // in the frame of the link
  Filter filter{};
};

// One axis of a joint of a robot.
struct ModelAxis {
  std::string name;
  bool slide = false;
  Vec3 axis{1, 0, 0};  // world
  DVec3 anchor{};      // world
  std::optional<Limits> limits{};
  float stiffness = 0.0f, damping = 0.0f, friction = 0.0f, rest = 0.0f;
  Motor motor{};
};

// The mass properties of a solid shape at a density of 1 kg/m^3, in the frame of the shape. A mesh that is not closed counts as its hull.
Result<MassProperties> unit_mass(const Scene& scene, const SceneGeometry& geometry);

// Appends the bodies; parents stand before their children. Returns the body of each link.
std::vector<int> build_bodies(Import& import, const std::vector<ModelLink>& links);

// The joint that has all these axes at once, the first next to the parent; none where the engine has no such joint.
std::optional<JointDef> joint_of_axes(const std::vector<ModelAxis>& axes);

void add_joint(Import& import, const std::string& name, int a, int b, JointDef def);

// The pose of a z-up file's world in a scene, which is y-up.
Pose z_up_world();

}  // namespace gyre
