// How the shapes of bodies cut the cells of a fluid: signed distances at the corners of cells, then the fraction of each face that is open
// (C. Batty, F. Bertails, R. Bridson, "A Fast Variational Framework for Accurate Solid-Fluid Coupling", 2007).
//
// In: shapes and the motion of their bodies, the box of a fluid. Out: GasSolids, and the body of each label. A wall thinner than a cell may
// leave faces open; a double-sided mesh has no inside and is not seen.
#pragma once

#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// Signed distances at the corners of cells, x fastest, and the body whose shape is nearest there.
struct CornerDistances {
  Array<float> distance;      // m, at most two cells
  Array<std::uint32_t> body;  // kNoIndex: no shape within two cells
  std::uint64_t key = 0;      // of the shapes that it was found from
};

// Belongs to one fluid from step to step; with another box it must be new.
struct FluidSolids {
  GasSolids solids;
  Array<std::uint32_t> bodies;  // by label, ascending
  CornerDistances fixed, all;   // of shapes of fixed bodies, of all shapes
  Array<std::uint32_t> shapes_near;
  Array<std::int16_t> label_of;  // by body, while labels are given
};

void cut_fluid_cells(const RigidWorld& w, const GasBox& box, const GridShape& shape, TaskSystem& tasks,
                     FluidSolids& out);

}  // namespace gyre
