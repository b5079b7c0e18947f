// The benchmark scenes, as plain tables that the driver of any engine reads.
//
//   metres, kilograms, seconds; y is up; gravity (0, -9.81, 0); 60 Hz.
//   Every dynamic body carries exactly one shape centred on the body's origin, and the shape's centroid is that origin.
//   Capsules lie along local y. Kinematic and fixed bodies may carry several shapes, each with a local pose.
//   Friction is one number a scene (so that the engines' different combine rules cannot matter once a driver has mapped it),
//   restitution too. Damping is zero everywhere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/scenes/vectors.h"

namespace gyre::bench {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = -9.81;  // m/s^2
constexpr double kDt = 1.0 / 60.0;  // s

enum class Kind { sphere, box, capsule, hull, mesh };

struct Shape {
  Kind kind = Kind::box;
  V3 half;                 // Box
  double radius = 0;       // Sphere, Capsule
  double half_length = 0;  // Capsule: half the distance between the two end centres
  int data = -1;           // Hull, Mesh: index into the scene's tables
  Pose local;              // only on static and kinematic bodies
};

enum class Motion { fixed, kinematic, dynamic };

// Bodies of the same class no_self never collide with each other.
enum class Layer { fixed, normal, no_self };

struct Body {
  Motion motion = Motion::dynamic;
  Layer layer = Layer::normal;
  V3 pos;
  Quat q;
  V3 vel, ang;
  double density = 1000;
  std::vector<Shape> shapes;
};

// A convex template: vertices around the centroid, plus the polytope's own faces and edges
// (used by the quality measures only; engines build their own).
struct Hull {
  std::vector<V3> v;
  std::vector<V3> face_normals;
  std::vector<V3> edge_directions;
  double volume = 0;
};

struct Mesh {
  std::vector<V3> v;
  std::vector<int> tri;  // three per triangle, counter-clockwise seen from above
  int n = 0;             // quads per side, for height look-up
  double size = 0;       // side length; the grid starts at -size/2
};

enum class JointKind {
  ball,  // point to point
  cone,  // point to point, swing of b's axis from a's within `cone`, twist about it within [lo,hi]
  hinge  // rotation of b against a about `axis` within [lo,hi]
};

struct Joint {
  JointKind kind = JointKind::ball;
  int a = 0, b = 0;
  V3 anchor;  // world
  V3 axis{0, 1, 0};
  double cone = 0, lo = 0, hi = 0;
};

struct Scene {
  std::string name;
  int steps = 300;
  double gravity = kGravity;  // m/s^2, along y
  double friction = 0.6, restitution = 0;
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Hull> hulls;
  std::vector<Mesh> meshes;
  std::vector<int> tops;  // bodies whose displacement is the drift
  int chain_end = -1;     // chain: the body at the end
  V3 chain_root;
  double chain_length = 0;
  bool rays = false;  // ray-cast benchmark instead of stepping
};

struct Ray {
  V3 from, by;
};
std::vector<Ray> ray_list();  // of the scene "rays"

const std::vector<const char*>& scene_names();
// Scenes of any size: about that many bodies, a million at most; of a pyramid its rows.
std::string numbered_scene_names();
std::optional<Scene> find_scene(const std::string& name);

// Of one shape, so that a driver whose engine does not take densities can set the mass.
double volume(const Scene& sc, const Shape& s);
double mass(const Scene& sc, const Body& b);

}  // namespace gyre::bench
