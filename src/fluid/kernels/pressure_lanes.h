// Kernels of the pressure equation, one template for every width (fluid/kernels/gas_kernels.h says what each does).
//
// In a plain row, all vectors but those at its ends have the same coefficients, which are then not read again: the same numbers in the same
// operations, so the same bits.
#pragma once

#include "fluid/kernels/grid_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The coefficients of W cells, of their lower and upper faces along each axis.
template <int W, bool HasGround>
struct FaceLanes {
  Wide<W> a[6];
  Wide<W> inverse, transfer, ground;

  GYRE_INLINE void load(const PressureLevel& level, int c) {
    a[0] = Wide<W>::load_unaligned(level.face[0] + c);
    a[1] = Wide<W>::load_unaligned(level.face[0] + c + 1);
    a[2] = Wide<W>::load_unaligned(level.face[1] + c);
    a[3] = Wide<W>::load_unaligned(level.face[1] + c + level.shape.pitch);
    a[4] = Wide<W>::load_unaligned(level.face[2] + c);
    a[5] = Wide<W>::load_unaligned(level.face[2] + c + level.shape.plane);
    inverse = Wide<W>::load_unaligned(level.inverse_diagonal + c);
    transfer = Wide<W>::load_unaligned(level.transfer + c);
    if constexpr (HasGround) ground = Wide<W>::load_unaligned(level.ground + c);
  }
  // The numbers of cell c in every lane.
  GYRE_INLINE void spread(const PressureLevel& level, int c) {
    a[0] = level.face[0][c], a[1] = level.face[0][c + 1];
    a[2] = level.face[1][c], a[3] = level.face[1][c + level.shape.pitch];
    a[4] = level.face[2][c], a[5] = level.face[2][c + level.shape.plane];
    inverse = level.inverse_diagonal[c], transfer = level.transfer[c];
    if constexpr (HasGround) ground = level.ground[c];
  }
};

// sum of a (x - x_n) and g x at cells c to c + W
template <int W, bool HasGround>
GYRE_INLINE Wide<W> apply_stencil(const FaceLanes<W, HasGround>& faces, const GridShape& shape,
                                  const float* x, int c, Wide<W> here) {
  const Wide<W> along_x = faces.a[0] * (here - Wide<W>::load_unaligned(x + c - 1)) +
                          faces.a[1] * (here - Wide<W>::load_unaligned(x + c + 1));
  const Wide<W> along_y = faces.a[2] * (here - Wide<W>::load_unaligned(x + c - shape.pitch)) +
                          faces.a[3] * (here - Wide<W>::load_unaligned(x + c + shape.pitch));
  const Wide<W> along_z = faces.a[4] * (here - Wide<W>::load_unaligned(x + c - shape.plane)) +
                          faces.a[5] * (here - Wide<W>::load_unaligned(x + c + shape.plane));
  if constexpr (HasGround) return along_x + along_y + along_z + faces.ground * here;
  return along_x + along_y + along_z;
}

// Calls fn(c, part, faces, lanes) for every W cells of the rows; `part`: which W of 16 these are. Empty rows of `out` become zero.
template <int W, bool HasGround, class Fn>
GYRE_INLINE void for_cells(const PressureLevel& level, float* out, int row_begin, int row_end, Fn&& fn) {
  using Faces = FaceLanes<W, HasGround>;
  const int n = level.shape.cells[0];
  for_rows(level.shape, level.shape.cells[1], row_begin, row_end, [&](int c, int, int, int row) {
    if (level.rows[row] == PressureRow::empty) {
      for (int i = 0; i < n; i += W) Wide<W>(0.0f).store(out + c + i);
      return;
    }
    const bool plain = level.rows[row] == PressureRow::plain;
    Faces inner;
    inner.spread(level, plain ? c + 1 : c);
    for (int i = 0; i < n; i += kGridLanes) {
      GYRE_UNROLL
      for (int part = 0; part < kGridLanes / W; ++part) {
        const int at = i + part * W;
        if (plain && at > 0 && at + W < n) {
          fn(c + at, part, inner, FullLanes<W>{});
        } else if (at + W <= n) {
          Faces faces;
          faces.load(level, c + at);
          fn(c + at, part, faces, FullLanes<W>{});
        } else if (at < n) {
          Faces faces;
          faces.load(level, c + at);
          fn(c + at, part, faces, PartLanes<W>(n - at));
        }
      }
    }
  });
}

template <int W, bool HasGround>
GYRE_INLINE double apply_rows(const PressureLevel& level, const float* x, float* y, int row_begin,
                              int row_end) {
  LaneSums<W> sums;
  for_cells<W, HasGround>(level, y, row_begin, row_end, [&](int c, int part, const auto& faces, auto lanes) {
    const Wide<W> here = Wide<W>::load(x + c);
    const Wide<W> result = lanes.keep_real(apply_stencil<W>(faces, level.shape, x, c, here));
    result.store(y + c);
    sums.add(part, here * result);
  });
  return sums.total();
}

template <int W>
double apply_cells(const PressureLevel& level, const float* x, float* y, int row_begin, int row_end) {
  return level.ground != nullptr ? apply_rows<W, true>(level, x, y, row_begin, row_end)
                                 : apply_rows<W, false>(level, x, y, row_begin, row_end);
}

template <int W, bool HasGround>
GYRE_INLINE void residual_rows(const PressureLevel& level, const float* b, const float* x, float* y,
                               int row_begin, int row_end) {
  for_cells<W, HasGround>(level, y, row_begin, row_end, [&](int c, int, const auto& faces, auto lanes) {
    const Wide<W> here = Wide<W>::load(x + c);
    const Wide<W> rest = Wide<W>::load(b + c) - apply_stencil<W>(faces, level.shape, x, c, here);
    lanes.keep_real(faces.transfer * rest).store(y + c);
  });
}

template <int W>
void find_residual(const PressureLevel& level, const float* b, const float* x, float* y, int row_begin,
                   int row_end) {
  level.ground != nullptr ? residual_rows<W, true>(level, b, x, y, row_begin, row_end)
                          : residual_rows<W, false>(level, b, x, y, row_begin, row_end);
}

template <int W, bool HasBefore, bool HasGround>
GYRE_INLINE double smooth_rows(const PressureLevel& level, const float* b, const float* x,
                               const float* before, float inertia, float gain, float* out, int row_begin,
                               int row_end) {
  LaneSums<W> sums;
  const Wide<W> keeps(inertia), gains(gain);
  for_cells<W, HasGround>(
      level, out, row_begin, row_end, [&](int c, int part, const auto& faces, auto lanes) {
        const Wide<W> here = Wide<W>::load(x + c), right = Wide<W>::load(b + c);
        const Wide<W> rest = right - apply_stencil<W>(faces, level.shape, x, c, here);
        Wide<W> last = here;
        if constexpr (HasBefore) last = here - Wide<W>::load(before + c);
        const Wide<W> result = lanes.keep_real(here + keeps * last + gains * faces.inverse * rest);
        result.store(out + c);
        sums.add(part, result * right);
      });
  return sums.total();
}

template <int W>
double smooth_cells(const PressureLevel& level, const float* b, const float* x, const float* before,
                    float inertia, float gain, float* out, int row_begin, int row_end) {
  // Called by their names: what must be inlined cannot be called by address.
  if (level.ground != nullptr) {
    if (before != nullptr)
      return smooth_rows<W, true, true>(level, b, x, before, inertia, gain, out, row_begin, row_end);
    return smooth_rows<W, false, true>(level, b, x, before, inertia, gain, out, row_begin, row_end);
  }
  if (before != nullptr)
    return smooth_rows<W, true, false>(level, b, x, before, inertia, gain, out, row_begin, row_end);
  return smooth_rows<W, false, false>(level, b, x, before, inertia, gain, out, row_begin, row_end);
}

template <int W>
void scale_cells(const PressureLevel& level, const float* b, float gain, float* out, int row_begin,
                 int row_end) {
  for_rows(level.shape, level.shape.cells[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(level.shape.cells[0], [&](int i, auto lanes) {
      const Wide<W> inverse = Wide<W>::load(level.inverse_diagonal + c + i);
      lanes.keep_real(Wide<W>(gain) * inverse * Wide<W>::load(b + c + i)).store(out + c + i);
    });
  });
}

// The rows of the finer level that a coarser row takes from along one axis, and their weights.
struct TransferRows {
  int begin = 0, count = 1;
  float weight[4] = {1.0f, 0.0f, 0.0f, 0.0f};
};
GYRE_INLINE TransferRows rows_below(bool halved, int coarse, int fine_cells) {
  if (!halved) return {coarse, 1, {1.0f, 0.0f, 0.0f, 0.0f}};
  TransferRows rows{2 * coarse - 1, 4, {0.25f, 0.75f, 0.75f, 0.25f}};
  if (rows.begin + rows.count > fine_cells + 1) rows.count = fine_cells + 1 - rows.begin;
  return rows;
}

constexpr int kTransferCells = 64;  // of a coarse row at a time

template <int W>
void restrict_cells(const PressureLevel& fine_level, const GridShape& coarse, const float* fine, float* b,
                    int row_begin, int row_end) {
  const GridShape& shape = fine_level.shape;
  const int n = coarse.cells[0];
  for_rows(coarse, coarse.cells[1], row_begin, row_end, [&](int c, int j, int k, int) {
    const TransferRows along_y = rows_below(fine_level.halved[1], j, shape.cells[1]);
    const TransferRows along_z = rows_below(fine_level.halved[2], k, shape.cells[2]);
    for (int start = 0; start < n; start += kTransferCells) {
      const int count = n - start < kTransferCells ? n - start : kTransferCells;
      // From the cell before the first of the finer row on.
      alignas(64) float sum[2 * kTransferCells + 2 * kGridLanes];
      const bool halved = fine_level.halved[0];
      const int from = halved ? 2 * start - 1 : start, length = halved ? 2 * count + 2 : count;
      for (int i = 0; i < length; i += W) {
        Wide<W> all(0.0f);
        for (int z = 0; z < along_z.count; ++z) {
          Wide<W> row(0.0f);
          for (int y = 0; y < along_y.count; ++y) {
            const float* const source =
                fine + shape.first + shape.pitch * (along_y.begin + y) + shape.plane * (along_z.begin + z);
            row += Wide<W>(along_y.weight[y]) * Wide<W>::load_unaligned(source + from + i);
          }
          all += Wide<W>(along_z.weight[z]) * row;
        }
        all.store(sum + i);
      }
      float* const to = b + c + start;
      for (int i = 0; i < count; ++i) {
        to[i] = halved ? 0.25f * (sum[2 * i] + sum[2 * i + 3]) + 0.75f * (sum[2 * i + 1] + sum[2 * i + 2])
                       : sum[i];
      }
    }
  });
}

// The two coarse rows between which a finer one lies.
GYRE_INLINE TransferRows rows_above(bool halved, int fine) {
  if (!halved) return {fine, 1, {1.0f, 0.0f, 0.0f, 0.0f}};
  if (fine % 2 == 0) return {fine / 2 - 1, 2, {0.25f, 0.75f, 0.0f, 0.0f}};
  return {fine / 2, 2, {0.75f, 0.25f, 0.0f, 0.0f}};
}

template <int W>
void prolong_cells(const PressureLevel& fine_level, const GridShape& coarse, const float* coarse_x, float* x,
                   int row_begin, int row_end) {
  const GridShape& shape = fine_level.shape;
  const int n = coarse.cells[0];
  const bool halved = fine_level.halved[0];
  for_rows(shape, shape.cells[1], row_begin, row_end, [&](int c, int j, int k, int) {
    const TransferRows along_y = rows_above(fine_level.halved[1], j);
    const TransferRows along_z = rows_above(fine_level.halved[2], k);
    for (int start = 0; start < n; start += kTransferCells) {
      const int count = n - start < kTransferCells ? n - start : kTransferCells;
      alignas(64) float mean[kTransferCells + 2 * kGridLanes];  // from the cell before `start` on
      for (int i = 0; i < count + 2; i += W) {
        Wide<W> all(0.0f);
        for (int z = 0; z < along_z.count; ++z) {
          Wide<W> row(0.0f);
          for (int y = 0; y < along_y.count; ++y) {
            const float* const source = coarse_x + coarse.first + coarse.pitch * (along_y.begin + y) +
                                        coarse.plane * (along_z.begin + z);
            row += Wide<W>(along_y.weight[y]) * Wide<W>::load_unaligned(source + start - 1 + i);
          }
          all += Wide<W>(along_z.weight[z]) * row;
        }
        all.store(mean + i);
      }
      alignas(64) float change[2 * kTransferCells + kGridLanes];
      for (int i = 0; i < count; ++i) {
        if (halved) {
          change[2 * i] = 0.25f * mean[i] + 0.75f * mean[i + 1];
          change[2 * i + 1] = 0.75f * mean[i + 1] + 0.25f * mean[i + 2];
        } else {
          change[i] = mean[i + 1];
        }
      }
      const int first = halved ? 2 * start : start;
      const int length = halved ? 2 * count : count, left = shape.cells[0] - first;
      for_lanes<W>(length < left ? length : left, [&](int i, auto lanes) {
        const int at = c + first + i;
        const Wide<W> addition = Wide<W>::load(fine_level.transfer + at) * Wide<W>::load(change + i);
        lanes.keep_real(Wide<W>::load(x + at) + lanes.keep_real(addition)).store(x + at);
      });
    }
  });
}

template <int W>
float advance_cells(const PressureLevel& level, float alpha, const float* p, const float* q, float* x,
                    float* r, int row_begin, int row_end) {
  Wide<W> largest(0.0f);
  for_rows(level.shape, level.shape.cells[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(level.shape.cells[0], [&](int i, auto lanes) {
      const int at = c + i;
      lanes.keep_real(Wide<W>::load(x + at) + Wide<W>(alpha) * Wide<W>::load(p + at)).store(x + at);
      const Wide<W> rest = lanes.keep_real(Wide<W>::load(r + at) - Wide<W>(alpha) * Wide<W>::load(q + at));
      rest.store(r + at);
      largest = max(absolute(rest), largest);
    });
  });
  float all = 0.0f;
  for (int lane = 0; lane < W; ++lane) all = largest[lane] > all ? largest[lane] : all;
  return all;
}

template <int W>
void update_direction_cells(const PressureLevel& level, float beta, const float* z, float* p, int row_begin,
                            int row_end) {
  for_rows(level.shape, level.shape.cells[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(level.shape.cells[0], [&](int i, auto lanes) {
      const Wide<W> turned = Wide<W>::load(z + c + i) + Wide<W>(beta) * Wide<W>::load(p + c + i);
      lanes.keep_real(turned).store(p + c + i);
    });
  });
}

template <int W>
void find_inflow_cells(const PressureLevel& level, const float* const (&velocity)[3], const float (&scale)[3],
                       float* to, int row_begin, int row_end) {
  const GridShape& shape = level.shape;
  const int stride[3] = {1, shape.pitch, shape.plane};
  for_rows(shape, shape.cells[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(shape.cells[0], [&](int i, auto lanes) {
      Wide<W> sum(0.0f);
      GYRE_UNROLL
      for (int axis = 0; axis < 3; ++axis) {
        const float* const at = velocity[axis] + c + i;
        sum += Wide<W>(scale[axis]) * (Wide<W>::load(at) - Wide<W>::load_unaligned(at + stride[axis]));
      }
      const Mask<W> active = Wide<W>::load(level.inverse_diagonal + c + i) > 0.0f;
      lanes.keep_real(keep(active, sum)).store(to + c + i);
    });
  });
}

template <int W>
void find_open_inflow_cells(const PressureLevel& level, const float* const (&open)[3],
                            const float* const (&velocity)[3], const float (&scale)[3], float* to,
                            int row_begin, int row_end) {
  const GridShape& shape = level.shape;
  const int stride[3] = {1, shape.pitch, shape.plane};
  for_rows(shape, shape.cells[1], row_begin, row_end, [&](int c, int, int, int row) {
    if (level.rows[row] == PressureRow::empty) {
      for (int i = 0; i < shape.cells[0]; i += W) Wide<W>(0.0f).store(to + c + i);
      return;
    }
    for_lanes<W>(shape.cells[0], [&](int i, auto lanes) {
      Wide<W> part[3];
      GYRE_UNROLL
      for (int axis = 0; axis < 3; ++axis) {
        const float *const v = velocity[axis] + c + i, *const share = open[axis] + c + i;
        part[axis] = Wide<W>(scale[axis]) * (Wide<W>::load(share) * Wide<W>::load(v) -
                                             Wide<W>::load_unaligned(share + stride[axis]) *
                                                 Wide<W>::load_unaligned(v + stride[axis]));
      }
      const Mask<W> active = Wide<W>::load(level.inverse_diagonal + c + i) > 0.0f;
      lanes.keep_real(keep(active, part[0] + part[1] + part[2])).store(to + c + i);
    });
  });
}

template <int W>
void subtract_weighted_faces(const float* weight, const float* x, int stride, float scale, float* field,
                             int count) {
  int f = 0;
  for (; f + W <= count; f += W) {
    const Wide<W> steep = Wide<W>(scale) * Wide<W>::load_unaligned(weight + f);
    const Wide<W> rise = Wide<W>::load_unaligned(x + f) - Wide<W>::load_unaligned(x + f - stride);
    (Wide<W>::load_unaligned(field + f) - steep * rise).store_unaligned(field + f);
  }
  for (; f < count; ++f) field[f] -= scale * weight[f] * (x[f] - x[f - stride]);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
