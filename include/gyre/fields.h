// Force fields: media that flow past bodies (wind, vortex, drag, water, syrup), attraction to a point, magnetic fields, accelerations on a
// grid, and explosions.
//
// A field acts on every dynamic body whose centre of mass lies within its bounds and that has a shape in its layers. Several fields add
// up. Fields are part of a world's state: they are recorded, saved and hashed. SI units, world frame.
//
// A medium acts on the surface that faces the flow. Let w be the velocity of the medium relative to the moving and rotating body at a
// surface element dA with outward normal n; the force on the element is 1/2 density drag_coefficient max(0, -w.n) w dA. A body that
// does not rotate has the textbook's drag 1/2 rho C A |w| w with its projected area A, at the centre of that area. A rotating body is
// slowed. Fields do not act on sensors. Sources: L. D. Landau, E. M. Lifshitz, "Fluid Mechanics"; J. N. Newman, "Marine Hydrodynamics",
// 1977 (floating bodies). docs/fields.md tells how the forces are integrated and what is left out.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace gyre {

enum class FieldKind : std::uint8_t {
  wind,      // a medium with one velocity, and turbulence
  radial,    // attraction to a point, with the same acceleration for every body
  vortex,    // a medium that rotates about an axis
  drag,      // a medium, at rest unless it has a velocity
  buoyancy,  // a medium below a plane, which also lifts: Archimedes
  magnetic,         // a uniform magnetic field, which turns the velocity of charges
  magnetic_dipole,  // the magnetic field of a small magnet
  stokes,           // a viscous medium: Stokes drag on the ball of equal volume
  grid,             // accelerations at the points of a grid
};
constexpr int kFieldKindCount = 9;
const char* to_string(FieldKind kind);

// All points between two corners.
struct FieldBounds {
  DVec3 low{};
  DVec3 high{};
};

struct FieldDef {
  FieldKind kind = FieldKind::wind;
  std::optional<FieldBounds> bounds{};  // none: everywhere
  std::uint32_t layers =
      0xffffffffu;  // bodies with a shape whose Filter::layer has a bit in it; bodies without shapes too

  // Wind, vortex, drag, buoyancy: the medium.
  Vec3 velocity{};                 // m/s
  std::optional<float> density{};  // kg/m^3; none: 1000 (water) for buoyancy, else 1.2 (air)
  float drag_coefficient = 1.0f;   // of the form drag, which grows with the square of the speed; 0: none
  // 1/s: the rate at which the velocity relative to the medium and the angular velocity decay besides. A partly submerged body has the
  // submerged share of its volume of it.
  float linear_drag = 0.0f;
  // Wind: root mean square of the gusts over the mean speed, and their length (m). The wind carries eddies of three sizes
  // (G. I. Taylor, "The Spectrum of Turbulence", 1938); they depend on position and time alone.
  float turbulence = 0.0f;
  float turbulence_length = 10.0f;

  // Radial: the acceleration towards `center` is `strength` (m/s^2; below 0: away) at distance `radius`. It falls with the power
  // `falloff` of the distance: 2 like gravity, 0 not at all; -1 grows like a spring's. It weakens within `core` (m), because
  // distance^2 + core^2 replaces distance^2 (H. C. Plummer, 1911).
  // Vortex: the medium moves with `strength` (m/s) at distance `radius` from the axis through `center`, counter-clockwise seen against
  // the axis. Inside it rotates like a solid; outside the speed falls with the distance (W. J. M. Rankine, 1858).
  // Magnetic: a body is accelerated by velocity x B, where B has the direction `axis` and the size `strength` (1/s): charge over mass times
  // the flux density, the rate at which a velocity across B turns.
  // Magnetic dipole: the same with B of a magnet at `center` whose moment points along `axis`. `strength` is the size of B at distance `radius`
  // at right angles to the axis; B falls with the cube of the distance, and weakens within `core`. Bodies feel no torque.
  // Stokes: `strength` is the viscosity (Pa s, 0 or more) of a medium that moves with `velocity`. The drag is 6 pi viscosity R times the
  // velocity against the medium, and 8 pi viscosity R^3 times the angular velocity; R is the radius of the ball with the volume of the body.
  DVec3 center{};
  float strength = 0.0f;
  float radius = 1.0f;
  float falloff = 2.0f;  // -4 to 4
  float core = 0.0f;
  Vec3 axis{0, 1, 0};  // vortex, magnetic, magnetic_dipole; any length but zero

  // Buoyancy: the medium fills {p : dot(normal, p) < offset} with the unit normal. It lifts along the normal by the weight of the
  // displaced medium in the world's gravity. Overlapping shapes of one body count twice, as they do for its mass.
  Vec3 normal{0, 1, 0};  // any length but zero
  double offset = 0.0;   // m

  // Grid: `bounds` must be given. `points` points along x, y and z (2 to 1,024 each, 4,194,304 in all) stand from `bounds->low` to
  // `bounds->high`; `vectors` are the accelerations there (m/s^2), x fastest, then y, then z. Between points they are interpolated.
  std::array<int, 3> points{};
  std::vector<Vec3> vectors{};
};

// A blast from a point, as one impulse: every surface element dA at distance r that faces the centre gets the impulse
// pressure (reference / r)^falloff cos(angle) dA away from it. So the shape of a body decides how it is thrown and rotated.
struct ExplosionDef {
  DVec3 center{};
  float pressure = 100.0f;             // Pa s (impulse on a square metre) at the reference distance
  float reference = 1.0f;              // m, the reference distance; nearer than this the pressure does not grow
  float falloff = 2.0f;                // 0 to 4
  float radius = 10.0f;                // m, the range
  bool occlusion = true;               // bodies behind another body, seen from the centre, get no impulse
  std::uint32_t layers = 0xffffffffu;  // of bodies that get an impulse, as in FieldDef; bodies of every layer occlude
};

}  // namespace gyre
