// The table of kernels of one width (fluid/kernels/gas_kernels.h).
#pragma once

#include "fluid/kernels/field_lanes.h"
#include "fluid/kernels/particle_lanes.h"
#include "fluid/kernels/pressure_lanes.h"
#include "fluid/kernels/transport_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
constexpr GasKernels gas_kernels() {
  GasKernels kernels{};
  kernels.width = W;
  kernels.apply = apply_cells<W>;
  kernels.residual = find_residual<W>;
  kernels.smooth = smooth_cells<W>;
  kernels.scale = scale_cells<W>;
  kernels.restrict_rows = restrict_cells<W>;
  kernels.prolong = prolong_cells<W>;
  kernels.advance = advance_cells<W>;
  kernels.update_direction = update_direction_cells<W>;
  kernels.subtract_gradient = subtract_gradient_points<W>;
  kernels.add_mean = add_mean_points<W>;
  kernels.find_mean = find_mean_points<W>;
  kernels.find_inflow = find_inflow_cells<W>;
  kernels.find_open_inflow = find_open_inflow_cells<W>;
  kernels.subtract_weighted = subtract_weighted_faces<W>;
  kernels.find_cells = find_particle_cells<W>;
  kernels.add_particles = add_particle_sums<W>;
  kernels.move_particles = move_particle_lanes<W>;
  kernels.largest = largest_point<W>;
  kernels.find_vorticity = find_vorticity_cells<W>;
  kernels.find_confinement = find_confinement_cells<W>;
  kernels.trace = trace_cells<W>;
  kernels.move = move_cells<W>;
  kernels.correct = correct_cells<W, false>;
  kernels.find_correction = correct_cells<W, true>;
  kernels.add_correction = add_correction_cells<W>;
  return kernels;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
