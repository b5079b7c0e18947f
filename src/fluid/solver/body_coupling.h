// BodyCoupling: bodies that move as the pressure of a fluid tells them, within the pressure equation. A body that moves brings fluid into the
// cells beside it, as the pressure of these moves the body: with the same numbers J for both, the equation gets the term
// scale J M^-1 J^T, which is symmetric and not negative. So a body may be lighter than the fluid that moves with it.
//
// In: the faces that solids cut, the masses and motions of bodies, the fluid's velocity at the faces. Out: what pressure does to bodies.
// Source: C. Batty, F. Bertails, R. Bridson, "A Fast Variational Framework for Accurate Solid-Fluid Coupling", 2007.
#pragma once

#include "base/container/array.h"
#include "fluid/grid/fluid_body.h"
#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"
#include "task/task_system.h"

#include <cstdint>
#include <span>

namespace gyre {

// A face that a solid cuts.
struct CutFace {
  std::int32_t face = 0;
  std::int32_t lower = -1, upper = -1;  // the cells beside it; -1: it has no equation
  std::int16_t axis = 0, label = 0;
  float share = 0.0f;    // of the face: closed, over the edge of a cell, 1/m
  float layer = 0.0f;    // kg: of fluid between the last centre and the solid, which moves with it
  float told = 0.0f;     // m/s: the solid's velocity where there is no body
  float moment[3] = {};  // m: of a force along the axis about the centre of the body
};

// Velocities and forces: three parts along the axes, three about them.
struct SolidMotion {
  int begin = 0, end = 0;  // its faces
  bool has_body = false, moves = false;
  double center[3] = {};      // m, from the corner of the box
  double inertia[3][3] = {};  // of the body, kg m^2
  double mass = 0.0;
  double volume = 0.0;        // m^3; 0: not known
  double displaced[3] = {};   // m^3: its volume as the faces across each axis have it
  double inverse[6][6] = {};  // of the masses of body and layers
  double before[6] = {};      // the motion at the end of the sub-step without the fluid
  double motion[6] = {};      // and with it
  double push[6] = {};        // N s: of a body that moves as told
  // In a gas: a body flush with a wall has no gas there, and a pressure that is the same everywhere would push it. `seal` is what is missing:
  // behind it is the mean pressure of the cells around, of which there are `beside`.
  double seal[6] = {};
  int beside = 0;
};

struct BodyCoupling {
  Array<CutFace> faces;  // by label
  Array<SolidMotion> solids;
  double scale = 0.0;      // kg: a cell full of fluid
  bool any_moves = false;  // by pressure

  // q += scale J M^-1 J^T p; returns what that adds to the product of p and q.
  double add_product(const float* p, float* q) const;
  float velocity_of(const CutFace& face) const;
};

// Adds what the sealed sides of bodies bring into the cells around.
void add_sealed_inflow(const BodyCoupling& coupling, float* inflow);

// Fills the list of faces. `open`: of each face, `active`: positive where a cell has an equation. `layers`, of liquids: those count if the solids have distances.
struct CouplingGrid {
  const GasBox& box;
  const GridShape& shape;
  const GasSolids& solids;
  const float* open[3];
  const float* active;
  float density;
  int first[3] = {0, 0, 0};  // the cell of the fluid's box that is the first of the grid
};
void find_cut_faces(const CouplingGrid& grid, bool layers, BodyCoupling& coupling);
// The motions of bodies at the beginning of a step.
void begin_motions(const GasBox& box, std::span<const FluidBody> bodies, int labels, BodyCoupling& coupling);
// The motions after `step` without pressure, layers counted; `velocity`: of the fluid on faces.
void predict_motions(std::span<const FluidBody> bodies, float step, const float* const (&velocity)[3],
                     BodyCoupling& coupling);
// Adds to the motions the change by `x`, pressure over density times the step.
void push_bodies(const float* x, BodyCoupling& coupling);
// Adds the impulses of the sub-step on bodies, layers counted; `told`: on those that move as told, too.
void add_body_impulses(const float* const (&velocity)[3], const BodyCoupling& coupling,
                       std::span<GasImpulse> impulses, bool told = true);

}  // namespace gyre
