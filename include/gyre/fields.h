// Force fields: media that stream past bodies (wind, vortex, drag, water) and pulls towards a point; explosions.
//
// A field acts on every dynamic body whose centre of mass lies within its bounds and of which a shape is in its layers; several
// fields add up. Fields are part of a world's state: they are recorded, saved and hashed. SI units, world frame.
//
// Media push on the surface that faces the stream: an element dA with outward normal n, past which the medium streams with w
// (against the moving and turning body), is pushed with 1/2 density drag_coefficient max(0, -w.n) w dA. So a body that does not
// turn is pushed as by the textbook's 1/2 rho C A |w| w with the area A of its shadow, off its centre where the shadow is, and
// one that turns is slowed. Sensors are not pushed. Sources: L. D. Landau, E. M. Lifshitz, "Fluid Mechanics"; J. N. Newman,
// "Marine Hydrodynamics", 1977 (floating bodies). docs/fields.md tells how the forces are integrated, and what is left out.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>

#include <cstdint>
#include <optional>

namespace gyre {

using FieldId = Id<struct FieldTag>;

enum class FieldKind : std::uint8_t {
  wind,      // a medium with one velocity, and turbulence
  radial,    // a pull towards a point, the same acceleration for every body
  vortex,    // a medium that turns about an axis
  drag,      // a medium, at rest unless it has a velocity
  buoyancy,  // a medium below a plane, which also lifts: Archimedes
};
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
  float drag_coefficient = 1.0f;   // of the drag by shape, which grows with the square of the speed; 0: none
  // 1/s: the rate at which the velocity against the medium, and the turning, die away besides; of a body that is partly
  // submerged, the share of its volume.
  float linear_drag = 0.0f;
  // Wind: root mean square of its gusts over its mean speed, and their length (m). Eddies of three sizes are carried along
  // with the wind (G. I. Taylor, "The Spectrum of Turbulence", 1938); they follow from place and time alone.
  float turbulence = 0.0f;
  float turbulence_length = 10.0f;

  // Radial: at `radius` from `center` bodies are accelerated towards it by `strength` (m/s^2; below 0: away), which falls with
  // that power of the distance: 2 as gravity does, 0 not at all, -1 grows like a spring's. Within `core` (m) it
  // weakens (H. C. Plummer, 1911): distance^2 + core^2 takes the place of distance^2.
  // Vortex: at `radius` from the axis through `center` the medium moves with `strength` (m/s), counter-clockwise seen against
  // the axis; within it turns like a solid, outside the speed falls with the distance (W. J. M. Rankine, 1858).
  DVec3 center{};
  float strength = 0.0f;
  float radius = 1.0f;
  float falloff = 2.0f;  // -4 to 4
  float core = 0.0f;
  Vec3 axis{0, 1, 0};  // vortex; any length but zero

  // Buoyancy: the medium fills {p : dot(normal, p) < offset} with the unit normal, and lifts along it by the weight of what a
  // body's shapes displace, in the world's gravity. Shapes of one body that overlap count twice, as they do for its mass.
  Vec3 normal{0, 1, 0};  // any length but zero
  double offset = 0.0;   // m
};

// A blow from a point, at once: every element dA of a body's surface that faces the center at distance r gets the impulse
// pressure (reference / r)^falloff cos(angle) dA away from it, so bodies are thrown and turned by their shape.
struct ExplosionDef {
  DVec3 center{};
  float pressure = 100.0f;             // Pa s (impulse on a square metre) at the reference distance
  float reference = 1.0f;              // m; nearer than this it grows no more
  float falloff = 2.0f;                // 0 to 4
  float radius = 10.0f;                // m: nothing farther away is hit
  bool occlusion = true;               // what lies behind another body, seen from the center, is spared
  std::uint32_t layers = 0xffffffffu;  // bodies that are hit, as in FieldDef; all bodies hide others
};

}  // namespace gyre
