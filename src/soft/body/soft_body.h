// SoftBody: particles and what holds them together. Particles are structures of arrays, padded to whole slices of 16 rows
// (soft/body/sliced_rows.h). Places are double, so that the difference of two neighbours is exact however far from the origin they lie and
// however large the body is beside their distance; velocities and forces are float.
//
// Elements: tetrahedra (soft/body/continuum.h). Springs (Hooke): T = k (l - l0). Bending: a quadratic energy 1/2 sum_e w_e |sum_a s_a x_a|^2, whose
// matrix is constant and the same for x, y and z; for surfaces and rods that are flat at rest.
//
// Sources: D. Baraff, A. Witkin, "Large Steps in Cloth Simulation", 1998; M. Bergou, M. Wardetzky, D. Harmon, D. Zorin, E. Grinspun, "A
// Quadratic Bending Model for Inextensible Surfaces", 2006.
#pragma once

#include "base/container/array.h"
#include "soft/body/continuum.h"
#include "soft/body/sliced_rows.h"
#include "soft/body/visual_links.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

struct Particles {
  int count = 0;
  Array<double> x, y, z;    // m
  Array<float> vx, vy, vz;  // m/s
  Array<float> fx, fy, fz;  // N, from outside (wind, drag); gravity is added by the step
  Array<float> mass;        // kg; 0 in rows that fill up the last slice
  Array<float> loose;       // 1, or 0 where the particle is held or there is none
  void resize(int particles);
  DVec3 place(int i) const { return {x[i], y[i], z[i]}; }
  Vec3 velocity(int i) const { return {vx[i], vy[i], vz[i]}; }
  void set_place(int i, DVec3 p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
  void set_velocity(int i, Vec3 v) { vx[i] = v.x, vy[i] = v.y, vz[i] = v.z; }
};

// A particle that goes where it is told: it is at `place` when the sub-step ends, and what hangs on it is pulled along within the sub-step.
struct HeldParticle {
  std::int32_t particle = 0;
  DVec3 place{};
};

// A particle that carries inertia of something else, which moves as one with it: in a sub-step from the velocity `target`.
struct CarriedInertia {
  std::int32_t particle = 0;
  Sym3 inertia{};  // kg
  Vec3 target{};   // m/s
  Vec3 axis{};     // a unit vector if the inertia is along it alone; else zero
};

// The momentum that brings it from a velocity to its own. A matrix along an axis would turn the rounding of a large velocity across the axis into a
// drag: a thousand times the mass of a particle may be carried.
inline Vec3 momentum_to_target(const CarriedInertia& one, Vec3 velocity) {
  const Vec3 off = one.target - velocity;
  if (one.axis == Vec3{}) return one.inertia * off;
  return (dot(one.axis, off) * dot(one.axis, one.inertia * one.axis)) * one.axis;
}

// The spring of two particles, as the builders give it.
struct Spring {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float rest_length = 0.0f;  // m
  float stiffness = 0.0f;    // N/m
};

// Each spring stands in the rows of both its particles.
struct SpringRows {
  SlicedRows rows;
  Array<float> rest_length;  // by place
  Array<float> stiffness;
  Array<float> bend;  // N/m: B_ij of the bending energy where there is a place for a spring
};

// B_ij of the bending energy, N/m, of all other pairs.
struct BendRows {
  SlicedRows rows;
  Array<float> stiffness;  // by place
};

// A rope: particles 0, 1, 2, ... one after the other. What the exact solve of ropes (soft/solver/rope_step.h) knows beside the particles; the same
// springs and bending stand in the rows too, for the other solvers.
struct Chain {
  Array<double> rest_length;       // m, of each segment; none: not a rope
  Array<double> tension;           // N, of each segment at the end of the last sub-step
  double stretch_stiffness = 0.0;  // N: EA; 0 where the segments keep their length
  double bend_stiffness = 0.0;     // N m^2: EI
};

// Gas within closed triangles (soft/body/enclosed_gas.h).
struct EnclosedGas {
  Array<std::uint32_t> triangles;  // counter-clockwise seen from outside; none: there is no gas
  double rest_volume = 0.0;        // m^3
  double pressure = 0.0;           // Pa, above that outside, at the volume at rest
  double ambient = 0.0;            // Pa, outside
  bool is_constant = false;        // the pressure does not change with the volume
};

// A value for each piece of a body. That of a single piece needs no memory.
template <class T>
class ByPiece {
 public:
  explicit ByPiece(int pieces = 1) {
    if (pieces > 1) many_.assign(std::size_t(pieces), T{});
  }
  T& operator[](std::size_t piece) { return many_.empty() ? one_ : many_[piece]; }
  const T& operator[](std::size_t piece) const { return many_.empty() ? one_ : many_[piece]; }
  std::size_t size() const { return many_.empty() ? 1 : many_.size(); }

 private:
  T one_{};
  Array<T> many_;
};

struct SoftBody {
  Particles particles;
  SpringRows springs;
  BendRows bend;
  Continuum continuum;
  Chain chain;
  EnclosedGas gas;
  Array<float> pull
      [3];  // m/s^2: changes of velocity in the last implicit sub-step, where the next begins to look; else empty
  Array<double>
      moved[3];  // m, in the last sub-step: what Verlet's scheme knows instead of velocities; else empty
  Array<HeldParticle> held;
  VisualLinks visual;    // of the visual scheme; derived
  float damping = 0.0f;  // s: stress grows by this times its rate of change

  // N: EA of the segments of a rope; 0 where they keep their length.
  double rope_stiffness() const;
  int pieces() const { return continuum.piece.empty() ? 1 : continuum.pieces; }
  std::size_t piece_of(int particle) const {
    return continuum.piece.empty() ? 0 : continuum.piece[std::size_t(particle)];
  }
};

// A term 1/2 w |sum_a s_a x_a|^2 of a quadratic energy adds w s_a s_b to the matrix of its particles.
void add_quadratic(Array<MatrixEntry>& entries, std::span<const std::uint32_t> particles,
                   std::span<const double> signs, double weight);

void set_springs(SoftBody& body, std::span<const Spring> springs);
// `entries` is the matrix of the energy, with its diagonal or without. Springs are set before.
void set_bending(SoftBody& body, Array<MatrixEntry>& entries);
void hold(SoftBody& body, int particle, DVec3 place);
void let_go(SoftBody& body, int particle);

}  // namespace gyre
