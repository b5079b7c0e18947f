// Kernels of fields that need only the neighbours of a point: gradients, means, the largest number, vorticity and its confinement.
#pragma once

#include "fluid/kernels/grid_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Calls fn(c, lanes) for every W points of the rows.
template <int W, class Fn>
GYRE_INLINE void for_points(const FieldRows& rows, int row_begin, int row_end, Fn&& fn) {
  for_rows(rows.shape, rows.points[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(rows.points[0], [&](int i, auto lanes) { fn(c + i, lanes); });
  });
}

template <int W>
void subtract_gradient_points(const FieldRows& rows, const float* face, const float* field, int stride,
                              float scale, float* velocity, int row_begin, int row_end) {
  const Wide<W> scales(scale);
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    const Wide<W> change = scales * (Wide<W>::load(field + c) - Wide<W>::load_unaligned(field + c - stride));
    const Wide<W> before = Wide<W>::load(velocity + c);
    const Wide<W> after = select(Wide<W>::load(face + c) > 0.0f, before - change, before);
    lanes.keep_real(after).store(velocity + c);
  });
}

template <int W>
void add_mean_points(const FieldRows& rows, const float* face, const float* field, int stride, float constant,
                     float scale, float* velocity, int row_begin, int row_end) {
  const Wide<W> scales(scale), constants(constant);
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    const Wide<W> change =
        constants + scales * (Wide<W>::load(field + c) + Wide<W>::load_unaligned(field + c - stride));
    const Wide<W> before = Wide<W>::load(velocity + c);
    const Wide<W> after = select(Wide<W>::load(face + c) > 0.0f, before + change, before);
    lanes.keep_real(after).store(velocity + c);
  });
}

template <int W>
void find_mean_points(const FieldRows& rows, const float* from, int stride, float scale, float* to,
                      int row_begin, int row_end) {
  const Wide<W> scales(scale);
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    const Wide<W> both = Wide<W>::load(from + c) + Wide<W>::load_unaligned(from + c + stride);
    lanes.keep_real(scales * both).store(to + c);
  });
}

template <int W>
float largest_point(const FieldRows& rows, const float* field, int row_begin, int row_end) {
  Wide<W> largest(0.0f);
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    largest = max(lanes.keep_real(absolute(Wide<W>::load(field + c))), largest);
  });
  float all = 0.0f;
  for (int lane = 0; lane < W; ++lane) all = largest[lane] > all ? largest[lane] : all;
  return all;
}

template <int W>
GYRE_INLINE Wide<W> slope(const VortexPass& pass, const float* of, int axis, int c) {
  const int stride = pass.shape.stride(axis);
  return Wide<W>(pass.half_inverse[axis]) *
         (Wide<W>::load_unaligned(of + c + stride) - Wide<W>::load_unaligned(of + c - stride));
}

template <int W>
void find_vorticity_cells(const VortexPass& pass, int row_begin, int row_end) {
  const FieldRows rows{pass.shape, {pass.shape.cells[0], pass.shape.cells[1], pass.shape.cells[2]}};
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    const Wide<W> x = slope<W>(pass, pass.center[2], 1, c) - slope<W>(pass, pass.center[1], 2, c);
    const Wide<W> y = slope<W>(pass, pass.center[0], 2, c) - slope<W>(pass, pass.center[2], 0, c);
    const Wide<W> z = slope<W>(pass, pass.center[1], 0, c) - slope<W>(pass, pass.center[0], 1, c);
    lanes.keep_real(x).store(pass.vorticity[0] + c);
    lanes.keep_real(y).store(pass.vorticity[1] + c);
    lanes.keep_real(z).store(pass.vorticity[2] + c);
    lanes.keep_real(sqrt(x * x + y * y + z * z)).store(pass.size + c);
  });
}

template <int W>
void find_confinement_cells(const VortexPass& pass, int row_begin, int row_end) {
  const FieldRows rows{pass.shape, {pass.shape.cells[0], pass.shape.cells[1], pass.shape.cells[2]}};
  for_points<W>(rows, row_begin, row_end, [&](int c, auto lanes) {
    const Wide<W> nx = slope<W>(pass, pass.size, 0, c), ny = slope<W>(pass, pass.size, 1, c),
                  nz = slope<W>(pass, pass.size, 2, c);
    const Wide<W> steep = sqrt(nx * nx + ny * ny + nz * nz);
    const Wide<W> scale = keep(steep > 0.0f, Wide<W>(pass.strength) / steep);
    const Wide<W> wx = Wide<W>::load(pass.vorticity[0] + c), wy = Wide<W>::load(pass.vorticity[1] + c),
                  wz = Wide<W>::load(pass.vorticity[2] + c);
    lanes.keep_real(scale * (ny * wz - nz * wy)).store(pass.center[0] + c);
    lanes.keep_real(scale * (nz * wx - nx * wz)).store(pass.center[1] + c);
    lanes.keep_real(scale * (nx * wy - ny * wx)).store(pass.center[2] + c);
  });
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
