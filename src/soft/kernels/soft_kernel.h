// The kernels of the implicit step, one template for every width (soft/kernels/soft_kernels.h says what each does).
//
// A spring of length l, direction n and tension T = k (l - l0) has the stiffness k n n^T + (T / l)(1 - n n^T). Where T < 0 the second part
// is negative: it is left out, so that the matrix is positive semi-definite (D. Baraff, A. Witkin, 1998, leave out as much).
#pragma once

#include "soft/kernels/row_lanes.h"
#include "soft/kernels/tet_kernel.h"
#include "soft/kernels/triangle_kernel.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct RowForces {
  Vec3W<W> force{0.0f, 0.0f, 0.0f};
  Sym3W<W> diagonal{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
};

// W places, as seen from W others.
template <int W>
struct Neighbourhood {
  PlaceLanes<W> x, y, z;

  GYRE_INLINE Neighbourhood(const SoftPass& pass, int row) : x(pass.x, row), y(pass.y, row), z(pass.z, row) {}
  GYRE_INLINE Vec3W<W> edge(const SoftPass& pass, const SlotLanes<W>& slot) const {
    return {difference(PlaceLanes<W>(pass.x, slot), x), difference(PlaceLanes<W>(pass.y, slot), y),
            difference(PlaceLanes<W>(pass.z, slot), z)};
  }
};

template <int W, bool WithBlocks>
GYRE_INLINE void add_springs(const SoftPass& pass, int slice, int row, const Neighbourhood<W>& here,
                             RowForces<W>& sum) {
  const int lane = row % kSliceRows;
  for (int slot = pass.springs.slot_begin[slice]; slot < pass.springs.slot_begin[slice + 1]; ++slot) {
    const SlotLanes<W> lanes(pass.springs, slot, row);
    const Vec3W<W> edge = here.edge(pass, lanes);
    const Wide<W> rest = Wide<W>::load(pass.rest_length + slot * kSliceRows + lane);
    const Wide<W> stiffness = Wide<W>::load(pass.stiffness + slot * kSliceRows + lane);
    const Wide<W> span = length(edge);
    const Wide<W> inverse_span = keep(span > 0.0f, 1.0f / span);
    const Vec3W<W> direction = inverse_span * edge;
    const Wide<W> bend = Wide<W>::load(pass.spring_bend + slot * kSliceRows + lane);
    Wide<W> tension = stiffness * (span - rest);
    sum.force += bend * edge;
    if constexpr (!WithBlocks) {
      if (pass.damping > 0.0f) {
        const Vec3W<W> apart = lanes.load(pass.velocity) - load_rows<W>(pass.velocity, row);
        tension += Wide<W>(pass.damping) * stiffness * dot(direction, apart);
        sum.force += Wide<W>(pass.damping) * bend * apart;
      }
    }
    sum.force += tension * direction;
    if constexpr (WithBlocks) {
      const Wide<W> across = Wide<W>(pass.geometric_scale) * max(tension, Wide<W>(0.0f)) * inverse_span;
      const Wide<W> along = max(pass.material_scale * stiffness - across, Wide<W>(0.0f));
      const Vec3W<W> n = sqrt(along) * direction;
      const Wide<W> even = across + Wide<W>(pass.material_scale) * bend;
      float* const block = pass.spring_blocks + slot * 4 * kSliceRows + lane;
      n.x.store(block);
      n.y.store(block + kSliceRows);
      n.z.store(block + 2 * kSliceRows);
      even.store(block + 3 * kSliceRows);
      sum.diagonal = sum.diagonal + Sym3W<W>{even + n.x * n.x, even + n.y * n.y, even + n.z * n.z,
                                             n.x * n.y,        n.x * n.z,        n.y * n.z};
    }
  }
}

template <int W, bool WithBlocks>
GYRE_INLINE void add_bend(const SoftPass& pass, int slice, int row, const Neighbourhood<W>& here,
                          RowForces<W>& sum) {
  Wide<W> diagonal(0.0f);
  for (int slot = pass.bend.slot_begin[slice]; slot < pass.bend.slot_begin[slice + 1]; ++slot) {
    const SlotLanes<W> lanes(pass.bend, slot, row);
    const Wide<W> c = Wide<W>::load(pass.bend_stiffness + slot * kSliceRows + row % kSliceRows);
    sum.force += c * here.edge(pass, lanes);
    if constexpr (!WithBlocks) {
      if (pass.damping > 0.0f) {
        sum.force +=
            Wide<W>(pass.damping) * c * (lanes.load(pass.velocity) - load_rows<W>(pass.velocity, row));
      }
    }
    diagonal += c;
  }
  if constexpr (WithBlocks) {
    const Wide<W> scaled = pass.material_scale * diagonal;
    sum.diagonal.xx += scaled;
    sum.diagonal.yy += scaled;
    sum.diagonal.zz += scaled;
  }
}

template <int W, bool WithBlocks>
void add_forces(const SoftPass& pass, int slice_begin, int slice_end) {
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    for (int row = slice * kSliceRows; row < (slice + 1) * kSliceRows; row += W) {
      RowForces<W> sum;
      const Neighbourhood<W> here(pass, row);
      if (pass.full.slot_begin != nullptr) {  // what continua have left there already
        sum.force = load_rows<W>(pass.force, row);
        if constexpr (WithBlocks) {
          sum.diagonal = {Wide<W>::load(pass.diagonal[0] + row), Wide<W>::load(pass.diagonal[1] + row),
                          Wide<W>::load(pass.diagonal[2] + row), Wide<W>::load(pass.diagonal[3] + row),
                          Wide<W>::load(pass.diagonal[4] + row), Wide<W>::load(pass.diagonal[5] + row)};
        }
      }
      if (pass.springs.slot_begin != nullptr) add_springs<W, WithBlocks>(pass, slice, row, here, sum);
      if (pass.bend.slot_begin != nullptr) add_bend<W, WithBlocks>(pass, slice, row, here, sum);
      store_rows<W>(pass.force, row, sum.force);
      if constexpr (WithBlocks) {
        const Wide<W> parts[6] = {sum.diagonal.xx, sum.diagonal.yy, sum.diagonal.zz,
                                  sum.diagonal.xy, sum.diagonal.xz, sum.diagonal.yz};
        GYRE_UNROLL
        for (int part = 0; part < 6; ++part) parts[part].store(pass.diagonal[part] + row);
      }
    }
  }
}

// sum_j B_ij (u_i - u_j)
template <int W>
GYRE_INLINE Vec3W<W> times_blocks(const SoftPass& pass, const VectorRows& u, int slice, int row) {
  const int lane = row % kSliceRows;
  const Vec3W<W> own = load_rows<W>(u, row);
  Vec3W<W> sum{0.0f, 0.0f, 0.0f};
  if (pass.springs.slot_begin != nullptr) {
    for (int slot = pass.springs.slot_begin[slice]; slot < pass.springs.slot_begin[slice + 1]; ++slot) {
      const Vec3W<W> d = own - SlotLanes<W>(pass.springs, slot, row).load(u);
      const float* const block = pass.spring_blocks + slot * 4 * kSliceRows + lane;
      const Vec3W<W> n{Wide<W>::load(block), Wide<W>::load(block + kSliceRows),
                       Wide<W>::load(block + 2 * kSliceRows)};
      sum += Wide<W>::load(block + 3 * kSliceRows) * d + dot(n, d) * n;
    }
  }
  if (pass.full.slot_begin != nullptr) {
    for (int slot = pass.full.slot_begin[slice]; slot < pass.full.slot_begin[slice + 1]; ++slot) {
      const Vec3W<W> d = own - SlotLanes<W>(pass.full, slot, row).load(u);
      const float* const block = pass.full_blocks + slot * 9 * kSliceRows + lane;
      const auto part = [&](int k) { return Wide<W>::load(block + k * kSliceRows); };
      sum += d.x * Vec3W<W>{part(0), part(1), part(2)} + d.y * Vec3W<W>{part(3), part(4), part(5)} +
             d.z * Vec3W<W>{part(6), part(7), part(8)};
    }
  }
  if (pass.bend.slot_begin != nullptr) {
    Vec3W<W> bend{0.0f, 0.0f, 0.0f};
    for (int slot = pass.bend.slot_begin[slice]; slot < pass.bend.slot_begin[slice + 1]; ++slot) {
      const Vec3W<W> d = own - SlotLanes<W>(pass.bend, slot, row).load(u);
      bend += Wide<W>::load(pass.bend_stiffness + slot * kSliceRows + lane) * d;
    }
    sum += Wide<W>(pass.material_scale) * bend;
  }
  return sum;
}

template <int W>
void start_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  for (int row = slice_begin * kSliceRows; row < slice_end * kSliceRows; row += W) {
    store_rows<W>(pass.product, row,
                  load_rows<W>(pass.change, row) + pass.velocity_scale * load_rows<W>(pass.velocity, row));
  }
}

template <int W>
GYRE_INLINE Sym3W<W> load_inverse(const SoftPass& pass, int row) {
  return {Wide<W>::load(pass.inverse[0] + row), Wide<W>::load(pass.inverse[1] + row),
          Wide<W>::load(pass.inverse[2] + row), Wide<W>::load(pass.inverse[3] + row),
          Wide<W>::load(pass.inverse[4] + row), Wide<W>::load(pass.inverse[5] + row)};
}

template <int W>
double begin_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  RowSums<W> sums;
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) {
      const int row = slice * kSliceRows + part * W;
      const Wide<W> mass = Wide<W>::load(pass.mass + row), loose = Wide<W>::load(pass.loose + row);
      const auto diagonal = [&](int k) { return Wide<W>::load(pass.diagonal[k] + row); };
      const Sym3W<W> inverse_block =
          loose * inverse(Sym3W<W>{mass + diagonal(0), mass + diagonal(1), mass + diagonal(2), diagonal(3),
                                   diagonal(4), diagonal(5)});
      const Wide<W> inverse_parts[6] = {inverse_block.xx, inverse_block.yy, inverse_block.zz,
                                        inverse_block.xy, inverse_block.xz, inverse_block.yz};
      GYRE_UNROLL
      for (int k = 0; k < 6; ++k) inverse_parts[k].store(pass.inverse[k] + row);
      const Vec3W<W> force =
          load_rows<W>(pass.force, row) + load_rows<W>(pass.outside, row) + mass * splat<W>(pass.gravity);
      const Vec3W<W> residual = pass.step * force - mass * load_rows<W>(pass.change, row) -
                                times_blocks<W>(pass, pass.product, slice, row);
      store_rows<W>(pass.residual, row, residual);
      const Vec3W<W> z = inverse_block * residual;
      store_rows<W>(pass.direction, row, z);
      sums.sums[part] += dot(residual, z);
    }
  }
  return sums.total();
}

template <int W>
double precondition_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  RowSums<W> sums;
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) {
      const int row = slice * kSliceRows + part * W;
      const Vec3W<W> residual = load_rows<W>(pass.residual, row), z = load_inverse<W>(pass, row) * residual;
      store_rows<W>(pass.direction, row, z);
      sums.sums[part] += dot(residual, z);
    }
  }
  return sums.total();
}

template <int W>
double match_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  RowSums<W> sums;
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) {
      const int row = slice * kSliceRows + part * W;
      sums.sums[part] += dot(load_rows<W>(pass.direction, row), load_rows<W>(pass.residual, row));
    }
  }
  return sums.total();
}

template <int W>
double apply_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  RowSums<W> sums;
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) {
      const int row = slice * kSliceRows + part * W;
      const Vec3W<W> p = load_rows<W>(pass.direction, row);
      const Vec3W<W> product =
          Wide<W>::load(pass.mass + row) * p + times_blocks<W>(pass, pass.direction, slice, row);
      store_rows<W>(pass.product, row, product);
      sums.sums[part] += dot(p, product);
    }
  }
  return sums.total();
}

template <int W>
double advance_rows(const SoftPass& pass, float alpha, int slice_begin, int slice_end) {
  RowSums<W> sums;
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) {
      const int row = slice * kSliceRows + part * W;
      store_rows<W>(pass.change, row,
                    load_rows<W>(pass.change, row) + alpha * load_rows<W>(pass.direction, row));
      const Vec3W<W> residual = load_rows<W>(pass.residual, row) - alpha * load_rows<W>(pass.product, row);
      store_rows<W>(pass.residual, row, residual);
      const Vec3W<W> z = load_inverse<W>(pass, row) * residual;
      store_rows<W>(pass.product, row, z);
      sums.sums[part] += dot(residual, z);
    }
  }
  return sums.total();
}

template <int W>
void turn_rows(const SoftPass& pass, float beta, int slice_begin, int slice_end) {
  for (int row = slice_begin * kSliceRows; row < slice_end * kSliceRows; row += W) {
    store_rows<W>(pass.direction, row,
                  load_rows<W>(pass.product, row) + beta * load_rows<W>(pass.direction, row));
  }
}

// The places of W rows, each with what it moves by.
template <int W>
GYRE_INLINE void move_places(double* places, int row, Wide<W> way) {
  PlaceLanes<W> place(places, row);
  place.low += half_of<0>(way);
  place.low.store(places + row);
  if constexpr (W > 1) {
    place.high += half_of<1>(way);
    place.high.store(places + row + W / 2);
  }
}

template <int W>
void finish_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  for (int row = slice_begin * kSliceRows; row < slice_end * kSliceRows; row += W) {
    const Vec3W<W> way = pass.step * (load_rows<W>(pass.velocity, row) +
                                      (pass.move_scale - 1.0f) * load_rows<W>(pass.change, row));
    move_places<W>(pass.x, row, way.x);
    move_places<W>(pass.y, row, way.y);
    move_places<W>(pass.z, row, way.z);
  }
}

template <int W>
constexpr SoftKernels soft_kernels() {
  return {W,
          add_tetrahedra<W, true>,
          add_tetrahedra<W, false>,
          add_cells<W, true>,
          add_cells<W, false>,
          add_triangles<W, true>,
          add_triangles<W, false>,
          fill_rows<W>,
          fill_forces<W>,
          add_forces<W, true>,
          add_forces<W, false>,
          start_rows<W>,
          begin_rows<W>,
          precondition_rows<W>,
          match_rows<W>,
          apply_rows<W>,
          advance_rows<W>,
          turn_rows<W>,
          finish_rows<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
