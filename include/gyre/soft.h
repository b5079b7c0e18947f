// Soft matter: ropes, cloths and solids. Each is a set of particles ("vertices") that elements hold together: springs, rods, triangles,
// tetrahedra. They push rigid bodies and are pushed by them, rest on them, and hang on them. SI units, world frame.
//
//   SoftId flag = world.add_cloth({.grid = ClothGrid{.size = {2, 1}, .cells = {40, 20}}, .pose = {{0, 3, 0}}});
//   world.attach(flag, 0, pole);       // vertex 0 keeps its place in the frame of the pole
//   world.pin(flag, 40);               // vertex 40 stays where it is
//   world.attach_point(flag, world.nearest_soft_point(flag, {0, 3, 0}), ball);  // a point between vertices
//   SoftVertices v = world.vertices(flag);  // in place: v.x[i], v.y[i], v.z[i]
//
// Stiffness is that of the material (N, N/m, Pa): it does not change with cells, segments, sub-steps or damping. Vertices keep the numbers
// given here. A vertex that is pinned, or attached to a body that does not yield, has no freedom of its own.
// docs/soft.md tells which number to change when something is too soft, too slow or jitters; docs/derive/soft.md has the equations.
#pragma once

#include <gyre/defs.h>
#include <gyre/ids.h>
#include <gyre/math.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gyre {

enum class SoftKind : std::uint8_t { rope, cloth, solid };
const char* to_string(SoftKind kind);

// How the particles move in a sub-step. Implicit (backward Euler) is stable at any stiffness and damps oscillations. sdirk2 (two implicit
// stages, of second order) is as stable and damps fast ones alone, so that motion stays lively, for twice the time (ropes: four times). visual (positions moved to fit
// the springs, once a sub-step) is for many ropes and cloths that only decorate: it is stable and quick, and its stiffness is not that of the material.
// The others are explicit, to be compared: on a spring of angular frequency w, explicit Euler gains energy at any step, semi-implicit Euler and Verlet
// beyond h = 2 / w, RK4 beyond 2.83 / w (E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2006).
enum class SoftIntegrator : std::uint8_t { implicit, explicit_euler, semi_implicit_euler, rk4, verlet, sdirk2, visual };
const char* to_string(SoftIntegrator integrator);

// Links hold neighbours together. springs: Hooke's; rods: edges that keep their length; membrane: triangles of a continuum.
enum class RopeLinks : std::uint8_t { springs, rods };
enum class ClothLinks : std::uint8_t { springs, rods, membrane };
const char* to_string(RopeLinks links);
const char* to_string(ClothLinks links);

// How the pressure of a gas within a cloth follows its volume. ideal_gas: (pressure + ambient) V stays, at constant temperature; constant: it is kept,
// as by a fan.
enum class PressureLaw : std::uint8_t { ideal_gas, constant };
const char* to_string(PressureLaw law);

// The law of stress and strain of tetrahedra. linear: for small displacements, does not know rotations; corotated: the same in a frame that
// turns with the element; neo_hookean: rubber (B. Smith, F. de Goes, T. Kim, "Stable Neo-Hookean Flesh Simulation", 2018).
enum class SolidModel : std::uint8_t { linear, corotated, neo_hookean };
const char* to_string(SolidModel model);

// Settings that ropes, cloths and solids have in common.
struct SoftSettings {
  SoftIntegrator integrator = SoftIntegrator::implicit;
  float damping = 0.0f;                 // s: stress grows by damping times its rate of change; rigid motion is never damped
  float static_friction = 0.4f;         // combined with a shape's as two shapes' are
  float dynamic_friction = 0.4f;
  Filter filter{};                      // against the shapes of bodies
  std::uint64_t user_data = 0;
  // Where the vertices are at the start and how they move, all of them; the shape at rest stays that of the rest of the definition. Empty:
  // at rest, still.
  std::vector<DVec3> positions{};
  std::vector<Vec3> velocities{};
};

struct RopeDef {
  std::vector<DVec3> points{};      // m, at least two
  // With `segments` 0 or one less than the points, the points are the vertices; else vertices lie evenly along the line.
  int segments = 0;
  RopeLinks links = RopeLinks::rods;
  float radius = 0.02f;             // m
  float linear_density = 0.1f;      // kg/m
  float stretch_stiffness = 1.0e4f; // N: EA; rods do not ask for it
  float bend_stiffness = 0.0f;      // N m^2: EI
  SoftSettings settings{};
};

// A rectangle in the x-z plane of its pose, its middle there. Vertex i + j (cells[0] + 1) is at
// (i size[0] / cells[0] - size[0] / 2, 0, j size[1] / cells[1] - size[1] / 2).
struct ClothGrid {
  std::array<float, 2> size{1, 1};  // m
  std::array<int, 2> cells{10, 10};
};
struct ClothDef {
  std::optional<ClothGrid> grid{};          // or a mesh:
  std::vector<Vec3> vertices{};             // m, in the frame of the pose
  std::vector<std::uint32_t> triangles{};   // three indices each
  Pose pose{};
  ClothLinks links = ClothLinks::springs;
  float area_density = 0.2f;                // kg/m^2
  float stretch_stiffness = 1000.0f;        // N/m: force per width and strain; rods do not ask for it
  float shear_stiffness = 200.0f;           // N/m: force per width and angle
  float bend_stiffness = 1.0e-4f;           // N m: moment per width and curvature
  float thickness = 0.005f;                 // m: surfaces keep half of it from its middle
  bool self_collision = true;
  // Gas within a cloth of triangles that is closed, with all of them alike all round: a balloon. Pa, above that outside, at the volume at
  // rest; below 0: it sucks. None: no gas.
  std::optional<float> pressure{};
  float ambient_pressure = 1.0e5f;          // Pa, outside; 0 in a vacuum
  PressureLaw pressure_law = PressureLaw::ideal_gas;
  // The strain (length over rest length, less 1) at which an edge tears the cloth; 0: never. Such a cloth is one of triangles, also if it is given by a
  // grid: springs lie along their edges. Torn cloth lets its gas out.
  float tear_strain = 0.0f;                 // docs/soft.md: Tearing
  SoftSettings settings{};
};

// A box, its middle at the pose. Vertex i + (cells[0] + 1) (j + (cells[1] + 1) k) is corner i, j, k of the cells.
struct SolidBox {
  Vec3 half_extents{0.5f, 0.5f, 0.5f};  // m
  std::array<int, 3> cells{4, 4, 4};
};
// A closed surface of triangles, which World::add_solid fills with tetrahedra of about equal size. Its own vertices are carried along:
// World::soft_surface. The tetrahedra do not follow it exactly, so their density is scaled until the mass is that of the surface's volume.
// Refused are surfaces that are open, cross themselves or have triangles without area. Refused too are features that are too thin for
// the cells; the message then names a resolution that keeps them. The same surface and resolution give the same vertices everywhere.
// docs/decisions/tetrahedral-fill.md has sizes and times.
struct SolidSurface {
  std::vector<Vec3> vertices{};            // m, in the frame of the pose
  std::vector<std::uint32_t> triangles{};  // three indices each; all counter-clockwise seen from outside, or all clockwise
  int resolution = 16;                     // cells along the longest side of its box: 2 to 128
};
struct SolidDef {
  std::optional<SolidBox> box{};            // or tetrahedra, used as they are:
  std::vector<Vec3> vertices{};             // m, in the frame of the pose
  // Four indices each: seen from the last vertex the others go counter-clockwise, so that the volume is positive. Tetrahedra that are inverted are refused, and those that lie on the same
  // side of a common face.
  std::vector<std::uint32_t> tetrahedra{};
  std::optional<SolidSurface> surface{};    // or a surface to be filled
  Pose pose{};
  SolidModel model = SolidModel::neo_hookean;
  float density = 1000.0f;                  // kg/m^3
  float young_modulus = 1.0e5f;             // Pa
  float poisson_ratio = 0.45f;              // within -1 and 1/2
  float fracture_stress = 0.0f;             // Pa: tension at which it breaks along faces; 0: never. Not of a filled surface
  float yield_stress = 0.0f;                // Pa, of von Mises: beyond it the rest shape yields; 0: never. Not of the linear model
  float creep_time = 0.0f;                  // s, in which stress beyond the yield stress falls to 1/e; 0: at once
  SoftSettings settings{};
};

// A point of a triangle of a cloth, or of a tetrahedron or a triangle of the surface of a solid: the mean of its corners by weight. The weights add up to 1; the fourth
// of a triangle is 0, and what has no weight may be any vertex. A ray's hit has them: CastHit::weights of the vertices of its triangle.
struct SoftPoint {
  std::array<int, 4> vertices{};
  std::array<float, 4> weights{};
};

// The vertices of one of them, in place: valid until the next change or step of the world.
struct SoftVertices {
  std::span<const double> x{}, y{}, z{};    // m
  std::span<const float> vx{}, vy{}, vz{};  // m/s

  std::size_t size() const { return x.size(); }
  DVec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 velocity(std::size_t i) const { return {vx[i], vy[i], vz[i]}; }
};

// The size and state of one of them.
struct SoftInfo {
  SoftKind kind = SoftKind::rope;
  int vertices = 0;
  double mass = 0.0;            // kg
  double kinetic_energy = 0.0;  // J
  double elastic_energy = 0.0;  // J
  float radius = 0.0f;          // m: that of a rope, half the thickness of a cloth, 0 of a solid
  int contacts = 0;             // of its vertices with shapes, in the last step
  std::uint64_t user_data = 0;
  bool awake = true;
  double volume = 0.0;    // m^3, within a cloth that holds gas
  double pressure = 0.0;  // Pa, of that gas now, above that outside
  bool visual = false;    // its integrator is visual: figures of it are those of a picture
};

}  // namespace gyre
