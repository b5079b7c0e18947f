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

// Belongs to one fluid from step to step; with another box it must be new.
struct FluidSolids {
  GasSolids solids;
  Array<std::uint32_t> bodies;      // by label, ascending
  SolidDistances corners, centers;  // of cells; centers for liquids alone
  Array<std::int16_t> label_of;     // by body, while labels are given
  Array<std::uint8_t> within_row;   // rows of corners: 1 if one is within a solid
};

// For a liquid with the distances of centres.
void cut_fluid_cells(const RigidWorld& w, const FluidEntry& entry, TaskSystem& tasks, FluidSolids& out);

}  // namespace gyre
