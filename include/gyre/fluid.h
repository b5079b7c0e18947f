// Fluids: gases and liquids as fields of velocities in boxes of cells. Gases carry smoke and heat; liquids have a surface. Bodies of every
// shape push them and are pushed by them. SI units. The box of a fluid may be turned and may move: all of a definition is in the axes of the
// box, which `pose` places in the world; all readings are in the world.
//
//   FluidId room = world.add_gas({.lower = {-2, 0, -2}, .upper = {2, 4, 2}, .cells = {64, 64, 64},
//                                 .emitters = {{.position = {0, 0.2, 0}, .radius = 0.3f, .temperature = 400.0f}}});
//   FluidProbe p = world.probe(room, {0, 2, 0});   // velocity, pressure, smoke and temperature at a point
//   FluidId pool = world.add_liquid({.lower = {0, 0, 0}, .upper = {4, 2, 1}, .cell_size = 0.05f, .fill = {{{0, 0, 0}, {1, 2, 1}}}});
//
// Velocities stand on the faces of cells (F. Harlow, J. Welch, 1965). The pressure makes them free of divergence in every step. An axis with
// one cell is flat: nothing moves or rubs along it, so that one cell in z makes a plane flow.
// docs/fluids.md tells which number to change; docs/derive/gas.md and docs/derive/liquid.md have the equations.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gyre {

enum class FluidKind : std::uint8_t { gas, liquid };
const char* to_string(FluidKind kind);

// A side of the box. periodic: what leaves there enters on the opposite side, for both sides of an axis; open: a gas passes freely, with air
// at rest outside, and a liquid leaves for good; closed: a wall along which the fluid slips; no_slip: a wall that holds the fluid next to it
// by viscosity.
enum class FluidBoundary : std::uint8_t { periodic, open, closed, no_slip };
const char* to_string(FluidBoundary boundary);

// How the fields of a gas are carried along. maccormack: second order, limited to the values around; semi_lagrangian: first order, which
// blurs (J. Stam, "Stable Fluids", 1999), to be compared.
enum class Advection : std::uint8_t { maccormack, semi_lagrangian };
const char* to_string(Advection advection);

// A ball in which every step that begins in [start, end) holds the smoke and the temperature of a gas, and the velocity if one is given. In
// a liquid it is a source: it fills with liquid of that velocity.
struct FluidEmitter {
  DVec3 position{};                 // m
  float radius = 0.1f;              // m
  float density = 1.0f;             // kg/m^3, of smoke
  float temperature = 300.0f;       // K
  std::optional<Vec3> velocity{};   // m/s
  double start = 0.0, end = 1.0e9;  // s
  float fuel = 0.0f;                // kg/m^3, in a gas with combustion
};

// Fuel that burns in a gas. The smoke of its emitters carries it; where the gas is at least as hot as it ignites at, a part of it burns in
// every step, and its heat stays in the gas. Air enough is taken for granted, and the gas keeps its volume.
struct Combustion {
  float ignition_temperature = 600.0f;  // K
  float burn_rate = 5.0f;               // 1/s: fuel that burns falls to 1/e in 1 / burn_rate
  float heat_release = 4.6e7f;          // J/kg, of the fuel; that of propane
  float heat_capacity = 1005.0f;        // J/(kg K), of the gas; that of air
  float smoke_yield = 0.0f;             // kg of smoke from a kg of fuel
};

// Vortices in the x-y plane: u = a sin(kx x) cos(ky y), v = -a kx/ky cos(kx x) sin(ky y), from the lower corner of the box
// (G. I. Taylor, A. E. Green, 1937).
struct TaylorGreen {
  float amplitude = 1.0f;                        // m/s
  std::array<float, 2> wave_number{1.0f, 1.0f};  // rad/m, kx and ky
};

// The fields of a gas with which it goes on, in the order of cells: x fastest, then y, then z; velocities on the lower faces of cells, with
// the upper faces of the last ones, so cells + 1 along their own axis.
struct GasFields {
  std::vector<float> velocity_x{}, velocity_y{}, velocity_z{};  // m/s
  std::vector<float> density{};                  // kg/m^3, of smoke
  std::vector<float> temperature{};              // K
  std::vector<float> pressure{};                 // m^2/s^2, over the density of the gas
  std::vector<float> fuel{};                     // kg/m^3, of a gas with combustion; empty: none
};

// A gas that is computed only where something moves: in a box of whole tiles of 8^3 cells around all cells with smoke, heat or fuel, around those with a speed
// above `threshold` times the fastest, around emitters, soft matter and bodies that are awake. Beyond it the air is at rest. The air passes freely
// through the sides of that box, against the pressure of the air at rest. docs/fluids.md tells the error.
struct AdaptiveDomain {
  int margin = 8;           // cells, around all of these
  float threshold = 0.05f;  // of the fastest speed
};

struct GasDef {
  DVec3 lower{-1, 0, -1}, upper{1, 2, 1};  // m, corners of the box
  std::array<int, 3> cells{32, 32, 32};
  float density = 1.2f;    // kg/m^3, of the gas
  float viscosity = 0.0f;  // Pa s
  float buoyancy = 1.0f;   // the gas rises by buoyancy g (T - ambient) / ambient; 1: as an ideal gas does
  float vorticity = 0.0f;  // strength of the confinement of vortices; 0: none
  float ambient_temperature = 293.15f;  // K
  Advection advection = Advection::maccormack;
  // Sides -x, +x, -y, +y, -z, +z, and how closed ones move in their own plane (m/s).
  std::array<FluidBoundary, 6> sides{FluidBoundary::open, FluidBoundary::open, FluidBoundary::open,
                                     FluidBoundary::open, FluidBoundary::open, FluidBoundary::open};
  std::array<Vec3, 6> wall_velocities{};
  Vec3 initial_velocity{};                // m/s
  std::optional<TaylorGreen> vortices{};  // instead of the initial velocity
  std::vector<FluidEmitter> emitters{};
  std::optional<GasFields> fields{};  // instead of air at rest and of the initial velocity
  std::uint64_t user_data = 0;
  std::optional<Combustion> combustion{};  // without: nothing burns
  Pose pose{};  // world from the axes of the box
  Vec3 linear_velocity{}, angular_velocity{};  // of these axes at their origin, m/s and rad/s, in the world
  std::optional<AdaptiveDomain> adaptive_domain{};  // without: all cells are computed
};

struct FluidRegion {
  DVec3 lower{}, upper{};  // m
};

// The particles of a liquid with which it goes on.
struct LiquidParticles {
  std::vector<DVec3> positions{};  // m
  std::vector<Vec3> velocities{};  // m/s
  std::vector<float> volumes{};    // m^3; empty: an eighth of a cell each, a quarter in a plane flow
  std::vector<float>
      affine{};  // 1/s, 9 numbers each, rows first: how the velocity changes around the particle; empty: not at all
};

struct LiquidDef {
  DVec3 lower{0, 0, 0}, upper{1, 1, 1};  // m, corners of the box; widened at the upper one to whole cells
  float cell_size = 0.05f;               // m
  std::vector<FluidRegion> fill{};       // where the liquid is at the start; not where bodies are
  float density = 1000.0f;               // kg/m^3
  float viscosity = 0.0f;                // Pa s
  float surface_tension = 0.0f;          // N/m
  std::array<FluidBoundary, 6> sides{FluidBoundary::closed, FluidBoundary::closed, FluidBoundary::closed,
                                     FluidBoundary::closed, FluidBoundary::closed, FluidBoundary::closed};
  std::array<Vec3, 6> wall_velocities{};
  Vec3 initial_velocity{};  // m/s
  std::vector<FluidEmitter> emitters{};
  std::optional<LiquidParticles> particles{};  // instead of `fill`
  std::uint64_t user_data = 0;
  Pose pose{};  // world from the axes of the box
  Vec3 linear_velocity{}, angular_velocity{};  // of these axes at their origin, m/s and rad/s, in the world
};

// The fluid at a point, between the places of its grid linearly.
struct FluidProbe {
  Vec3 velocity{};           // m/s
  float pressure = 0.0f;     // Pa, relative to the open surface, or to the mean of a closed box
  float density = 0.0f;      // of a gas: kg/m^3 of smoke; of a liquid: 1 inside, 0 outside
  float temperature = 0.0f;  // K
  float surface =
      0.0f;  // m: height of the highest surface of a liquid in the column of the point; NaN if there is none
  float fuel = 0.0f;  // kg/m^3, of a gas with combustion
};

// The size and state of a fluid.
struct FluidInfo {
  FluidKind kind = FluidKind::gas;
  std::array<int, 3> cells{};
  DVec3 lower{};                // m, in the axes of the box
  Vec3 cell{};                  // m, edges of a cell
  int particles = 0;            // of a liquid
  double kinetic_energy = 0.0;  // J
  double smoke_mass = 0.0;      // kg
  double volume = 0.0;          // m^3, of a liquid, within its surface
  int substeps = 0;             // of the last step
  int iterations = 0;           // of the pressure, in the last step
  float divergence = 0.0f;      // 1/s: largest net outflow of a cell over its volume after the last step
  float residual = 0.0f;        // of the last solve, over its right side
  std::uint64_t user_data = 0;
  double fuel_mass = 0.0;       // kg, of a gas with combustion
  double heat_rate = 0.0;       // W, of its combustion in the last step
  Pose pose{};                  // world from the axes of the box
  Vec3 linear_velocity{}, angular_velocity{};  // of these axes at their origin, m/s and rad/s
  // Of a gas: the first of the cells that are computed, and how many there are along each axis. All cells but for an adaptive domain.
  std::array<int, 3> active_first{}, active_cells{};
};

// The load of all fluids on a body: the force and torque of their pressure, lift included, that act through the present step.
struct FluidLoad {
  Vec3 force{};             // N
  Vec3 torque{};            // N m, about the centre of mass
  double wet_volume = 0.0;  // m^3: of its convex shapes, below the level of the liquids beside it; shapes that overlap count twice
};

// The surface of a liquid: numbers of vertices and of indices, three for each triangle.
struct FluidSurfaceSize {
  std::size_t vertices = 0, indices = 0;
};

// A field of cell centres.
enum class FluidField : std::uint8_t { smoke, temperature, pressure, speed, fuel };
const char* to_string(FluidField field);

}  // namespace gyre
