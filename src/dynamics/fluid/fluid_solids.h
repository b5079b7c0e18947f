// How the shapes of bodies cut the cells of a fluid: signed distances at the corners of cells, then the fraction of each face that is open
// (C. Batty, F. Bertails, R. Bridson, "A Fast Variational Framework for Accurate Solid-Fluid Coupling", 2007).
//
// In: shapes and the motion of their bodies, the box of a fluid. Out: GasSolids, and the body of each label. A wall thinner than a cell may
// leave faces open; a double-sided mesh has no inside and is not seen.
#pragma once

#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"
#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// Signed distances at points of a grid, x fastest, and the body whose shape is nearest there.
struct GridDistances {
  Array<float> distance;      // m, at most the reach
  Array<std::uint32_t> body;  // kNoIndex: no shape within the reach
  std::uint64_t key = 0;      // of the shapes that it was found from
};
// Those of shapes of fixed bodies, which stay, and of all shapes.
struct SolidDistances {
  GridDistances fixed, all;
};

// A shape whose box meets that of the fluid.
struct NearShape {
  const Shape* shape = nullptr;
  std::uint32_t body = 0;
  Pose pose;  // world_from_shape
  Aabb box;
};

// Belongs to one fluid from step to step; with another box it must be new.
struct FluidSolids {
  GasSolids solids;
  FluidWindow window;                        // the cells of `solids`
  Array<NearShape> fixed, moving;            // of the present step
  std::uint64_t fixed_key = 1, all_key = 1;  // of these shapes and where they are
  Array<std::uint32_t> bodies;               // by label, ascending
  SolidDistances corners, centers;           // of cells; centers for liquids alone
  Array<std::int16_t> label_of;              // by body, while labels are given
  Array<std::uint8_t> within_row;            // rows of corners: 1 if one is within a solid
};

// Lists the shapes that meet the box of a fluid and numbers their bodies.
void find_near_shapes(const RigidWorld& w, const FluidEntry& entry, FluidSolids& out);
// Then: makes the solids those of a window; for a liquid with the distances of centres.
void cut_fluid_cells(const RigidWorld& w, const FluidEntry& entry, const FluidWindow& window,
                     TaskSystem& tasks, FluidSolids& out);

}  // namespace gyre
