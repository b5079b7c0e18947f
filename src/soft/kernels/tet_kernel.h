// The kernel of elements with one deformation gradient, tetrahedra and cells, one template for every width: forces and stiffness of each, added to its
// particles and edges.
//
// With F = R S and S = Q diag(s) Q^T, the second derivative of an isotropic energy is, in the frame of U = R Q on the side of places and
// Q on that of the rest shape, a 3 x 3 matrix A for the stretches and two numbers for each pair of axes, for their shear (flip) and
// their turning (twist). Negative ones are left out, so that the stiffness is positive semi-definite (B. Smith, F. de Goes, T. Kim,
// "Analytic Eigensystems for Isotropic Distortion Energies", 2019). The linear and the corotated law have the same form with Q = 1, the
// stiffness at rest turned along with the element (M. Mueller, M. Gross, "Interactive Virtual Materials", 2004).
#pragma once

#include "soft/kernels/element_sums.h"
#include "soft/kernels/polar_lanes.h"
#include "soft/kernels/row_lanes.h"

#include <type_traits>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The second derivative of the energy density in its frame: stretches (xx, yy, zz, xy, xz, yz), and half the sum and half the difference
// of flip and twist for the pairs yz, xz, xy.
template <int W>
struct FrameStiffness {
  Sym3W<W> stretch;
  Vec3W<W> sum, difference;
};

// The answer of one law to a deformation gradient.
template <int W>
struct ElementResponse {
  Mat3W<W> stress;  // P
  Mat3W<W> turn;    // U
  Mat3W<W> rest;    // Q
  FrameStiffness<W> stiffness;
};

template <int W>
GYRE_INLINE Mat3W<W> unit_matrix() {
  const Wide<W> one(1.0f), zero(0.0f);
  return {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
}

template <int W>
GYRE_INLINE ElementResponse<W> linear_response(const Mat3W<W>& f, bool corotated, float mu_of,
                                               float lambda_of) {
  const Wide<W> mu(mu_of), lambda(lambda_of);
  ElementResponse<W> out;
  out.rest = unit_matrix<W>();
  out.turn = corotated ? polar_rotation(f) : unit_matrix<W>();
  const Mat3W<W> s = transpose(out.turn) * f;
  const Wide<W> xx = s.x.x - 1.0f, yy = s.y.y - 1.0f, zz = s.z.z - 1.0f;
  const Wide<W> xy = mu * (s.x.y + s.y.x), xz = mu * (s.x.z + s.z.x), yz = mu * (s.y.z + s.z.y);
  const Wide<W> pressure = lambda * (xx + yy + zz), two = 2.0f * mu;
  out.stress =
      out.turn *
      Mat3W<W>{{two * xx + pressure, xy, xz}, {xy, two * yy + pressure, yz}, {xz, yz, two * zz + pressure}};
  out.stiffness.stretch = {two + lambda, two + lambda, two + lambda, lambda, lambda, lambda};
  out.stiffness.sum = {mu, mu, mu};
  out.stiffness.difference = {mu, mu, mu};
  return out;
}

template <int W>
GYRE_INLINE Wide<W> positive(Wide<W> a) {
  return max(a, Wide<W>(0.0f));
}

template <int W>
GYRE_INLINE ElementResponse<W> neo_hookean_response(const Mat3W<W>& f, float mu_of, float lambda_of) {
  const float lambda = lambda_of + mu_of, rest_volume = 1.0f + mu_of / lambda;
  ElementResponse<W> out;
  const Mat3W<W> rotation = polar_rotation(f);
  const Mat3W<W> s = transpose(rotation) * f;
  const EigenLanes<W> eigen = symmetric_eigen_lanes(
      Sym3W<W>{s.x.x, s.y.y, s.z.z, 0.5f * (s.x.y + s.y.x), 0.5f * (s.x.z + s.z.x), 0.5f * (s.y.z + s.z.y)});
  const Vec3W<W> sigma = eigen.values;
  out.rest = eigen.axes;
  out.turn = rotation * eigen.axes;
  const Wide<W> square = dot(sigma, sigma);
  const Wide<W> mu = Wide<W>(mu_of) * min(2.0f * square, Wide<W>(1.0f));
  const Vec3W<W> cofactor{sigma.y * sigma.z, sigma.x * sigma.z, sigma.x * sigma.y};
  const Wide<W> volume = sigma.x * cofactor.x;
  const Wide<W> pressure = Wide<W>(lambda) * (volume - rest_volume);
  const Vec3W<W> pull = mu * sigma + pressure * cofactor;
  out.stress = Mat3W<W>{pull.x * out.turn.x, pull.y * out.turn.y, pull.z * out.turn.z} * transpose(out.rest);
  const Vec3W<W> scaled = Wide<W>(lambda) * cofactor;
  const Vec3W<W> across = pressure * sigma;
  out.stiffness.stretch = without_negative_part(Sym3W<W>{
      mu + scaled.x * cofactor.x, mu + scaled.y * cofactor.y, mu + scaled.z * cofactor.z,
      scaled.x * cofactor.y + across.z, scaled.x * cofactor.z + across.y, scaled.y * cofactor.z + across.x});
  const Vec3W<W> twist{positive(mu + across.x), positive(mu + across.y), positive(mu + across.z)};
  const Vec3W<W> flip{positive(mu - across.x), positive(mu - across.y), positive(mu - across.z)};
  out.stiffness.sum = 0.5f * (flip + twist);
  out.stiffness.difference = 0.5f * (flip - twist);
  return out;
}

// V U K' U^T, K'_ij the second derivative along the gradients a and b of two corners in the frame of the rest shape.
template <int W>
GYRE_INLINE Mat3W<W> corner_stiffness(const ElementResponse<W>& element, Vec3W<W> a, Vec3W<W> b,
                                      Wide<W> volume) {
  const FrameStiffness<W>& k = element.stiffness;
  const Vec3W<W> ab{a.x * b.x, a.y * b.y, a.z * b.z};
  const Wide<W> xx = k.stretch.xx * ab.x + k.sum.z * ab.y + k.sum.y * ab.z;
  const Wide<W> yy = k.stretch.yy * ab.y + k.sum.z * ab.x + k.sum.x * ab.z;
  const Wide<W> zz = k.stretch.zz * ab.z + k.sum.y * ab.x + k.sum.x * ab.y;
  const Wide<W> xy = k.stretch.xy * (a.x * b.y) + k.difference.z * (a.y * b.x);  // row x, column y
  const Wide<W> yx = k.stretch.xy * (a.y * b.x) + k.difference.z * (a.x * b.y);
  const Wide<W> xz = k.stretch.xz * (a.x * b.z) + k.difference.y * (a.z * b.x);
  const Wide<W> zx = k.stretch.xz * (a.z * b.x) + k.difference.y * (a.x * b.z);
  const Wide<W> yz = k.stretch.yz * (a.y * b.z) + k.difference.x * (a.z * b.y);
  const Wide<W> zy = k.stretch.yz * (a.z * b.y) + k.difference.x * (a.y * b.z);
  const Mat3W<W> inner{{volume * xx, volume * yx, volume * zx},
                       {volume * xy, volume * yy, volume * zy},
                       {volume * xz, volume * yz, volume * zz}};
  return element.turn * inner * transpose(element.turn);
}

template <int W, int Corners>
GYRE_INLINE Vec3W<W> corner_edge(const SoftPass& pass, const SolidBlock<Corners>& block, int corner,
                                 int lane) {
  alignas(64) float edge[3][W];
  for (int i = 0; i < W; ++i) {
    const std::int32_t a = block.corner[0][lane + i], b = block.corner[corner][lane + i];
    edge[0][i] = float(pass.x[b] - pass.x[a]);
    edge[1][i] = float(pass.y[b] - pass.y[a]);
    edge[2][i] = float(pass.z[b] - pass.z[a]);
  }
  return {Wide<W>::load(edge[0]), Wide<W>::load(edge[1]), Wide<W>::load(edge[2])};
}

// Gradients of all corners, edges from the first corner, and the deformation gradient.
template <int W, int Corners>
struct Deformation {
  Vec3W<W> gradient[Corners], edge[Corners];
  Mat3W<W> f;

  GYRE_INLINE Deformation(const SoftPass& pass, const SolidBlock<Corners>& block, int lane) {
    constexpr int kOthers = SolidBlock<Corners>::kOthers;
    edge[0] = {0.0f, 0.0f, 0.0f};
    for (int a = 0; a < kOthers; ++a) {
      const auto part = [&](int axis) { return Wide<W>::load(block.gradient[kOthers * axis + a] + lane); };
      const Vec3W<W> own{part(0), part(1), part(2)}, way = corner_edge<W>(pass, block, a + 1, lane);
      gradient[a + 1] = own, edge[a + 1] = way;
      gradient[0] = a == 0 ? own : gradient[0] + own;
      f = a == 0 ? Mat3W<W>{own.x * way, own.y * way, own.z * way}
                 : Mat3W<W>{f.x + own.x * way, f.y + own.y * way, f.z + own.z * way};
    }
    gradient[0] = -gradient[0];
  }
};

template <class Block>
using BlockSums = ElementSums<Block::kOthers, Block::kEdges>;

template <int W, bool WithBlocks, class Block>
GYRE_INLINE void respond(const SoftPass& pass, const Block& block, int lane, BlockSums<Block>& out) {
  constexpr int kCorners = Block::kCorners;
  constexpr bool kHasTies = std::is_same_v<Block, CellBlock>;
  const Deformation<W, kCorners> now(pass, block, lane);
  const ElementMaterial& material = pass.material;
  const ElementResponse<W> element =
      material.model == ElementModel::neo_hookean
          ? neo_hookean_response(now.f, material.mu, material.lambda)
          : linear_response(now.f, material.model == ElementModel::corotated, material.mu, material.lambda);
  const Wide<W> volume = Wide<W>::load(block.volume + lane);
  Vec3W<W> force[kCorners];
  force[0] = {0.0f, 0.0f, 0.0f};  // add_lane() finds what it lacks
  for (int a = 1; a < kCorners; ++a) force[a] = -volume * (element.stress * now.gradient[a]);
  if constexpr (kHasTies) {
    int edge = 0;
    for (int a = 0; a < kCorners; ++a) {
      for (int b = a + 1; b < kCorners; ++b) {
        const Wide<W> tie = Wide<W>(material.mu) * Wide<W>::load(block.tie[edge++] + lane);
        const Vec3W<W> pull = tie * (now.edge[b] - now.edge[a]);
        force[a] += pull;
        force[b] -= pull;
      }
    }
  }
  for (int a = 1; a < kCorners; ++a) put_columns<W>(out.force[a - 1], lane, 0, force[a]);
  if constexpr (WithBlocks) {
    const Wide<W> scale(pass.material_scale), scaled = -scale * volume;
    Vec3W<W> turned[kCorners];
    for (int a = 0; a < kCorners; ++a) turned[a] = transpose_times(element.rest, now.gradient[a]);
    int edge = 0;
    for (int a = 0; a < kCorners; ++a) {
      for (int b = a + 1; b < kCorners; ++b, ++edge) {
        Mat3W<W> own = corner_stiffness(element, turned[a], turned[b], scaled);
        if constexpr (kHasTies) {
          const Wide<W> tie = scale * Wide<W>(material.mu) * Wide<W>::load(block.tie[edge] + lane);
          own.x.x += tie, own.y.y += tie, own.z.z += tie;
        }
        put_block<W>(out.block[edge], lane, own);
      }
    }
  }
}

template <int W, bool WithBlocks, class Block>
GYRE_INLINE void add_elements(const SoftPass& pass, const Block* blocks, int block_begin, int block_end) {
  for (int b = block_begin; b < block_end; ++b) {
    const Block& block = blocks[b];
    BlockSums<Block> sums;
    GYRE_ROLLED
    for (int lane = 0; lane < kTetLanes; lane += W) respond<W, WithBlocks>(pass, block, lane, sums);
    for (int lane = 0; lane < kTetLanes; ++lane) {
      if (block.stiffness[lane] == 0.0f) continue;
      add_lane<W, WithBlocks>(pass.corner_force, pass.edge_blocks, block, sums, lane);
    }
  }
}

// Parts of cells that are pressed below kMinPartVolume, W = 1/2 k (det F - kMinPartVolume)^2. The second derivative of det F is left out, so that the stiffness is
// positive semi-definite. False if none of W lanes is.
template <int W, bool WithBlocks>
GYRE_INLINE bool guard_volume(const SoftPass& pass, const TetBlock& block, int lane, BlockSums<TetBlock>& out,
                              bool (&is_pressed)[kTetLanes]) {
  const Deformation<W, 4> now(pass, block, lane);
  const Mat3W<W> cofactor{cross(now.f.y, now.f.z), cross(now.f.z, now.f.x), cross(now.f.x, now.f.y)};
  const Wide<W> missing = dot(now.f.x, cofactor.x) - kMinPartVolume;
  bool any = false;
  for (int i = 0; i < W; ++i) {
    is_pressed[lane + i] = missing[i] < 0.0f && block.stiffness[lane + i] == 0.0f;
    any = any || is_pressed[lane + i];
  }
  if (!any) return false;
  const Wide<W> bulk = Wide<W>(kGuardStiffness * pass.material.mu) * Wide<W>::load(block.volume + lane);
  Vec3W<W> along[4];
  GYRE_UNROLL
  for (int a = 0; a < 4; ++a) along[a] = cofactor * now.gradient[a];
  GYRE_UNROLL
  for (int a = 1; a < 4; ++a) put_columns<W>(out.force[a - 1], lane, 0, -(bulk * missing) * along[a]);
  if constexpr (WithBlocks) {
    const Wide<W> scaled = -Wide<W>(pass.material_scale) * bulk;
    int edge = 0;
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b, ++edge) {
        const Vec3W<W> left = scaled * along[a];
        put_block<W>(out.block[edge], lane, {along[b].x * left, along[b].y * left, along[b].z * left});
      }
    }
  }
  return true;
}

template <int W, bool WithBlocks>
void add_tetrahedra(const SoftPass& pass, int block_begin, int block_end) {
  for (int b = block_begin; b < block_end; ++b) {
    const TetBlock& block = pass.tetrahedra[b];
    bool acts = false, has_parts = false;
    for (int lane = 0; lane < kTetLanes; ++lane) {
      acts = acts || block.stiffness[lane] > 0.0f;
      has_parts = has_parts || (block.stiffness[lane] == 0.0f && block.volume[lane] > 0.0f);
    }
    if (acts) add_elements<W, WithBlocks>(pass, pass.tetrahedra, b, b + 1);
    if (!has_parts) continue;
    BlockSums<TetBlock> sums;
    bool is_pressed[kTetLanes] = {}, any = false;
    GYRE_ROLLED
    for (int lane = 0; lane < kTetLanes; lane += W)
      any = guard_volume<W, WithBlocks>(pass, block, lane, sums, is_pressed) || any;
    if (!any) continue;
    for (int lane = 0; lane < kTetLanes; ++lane) {
      if (is_pressed[lane] && block.volume[lane] > 0.0f)
        add_lane<W, WithBlocks>(pass.corner_force, pass.edge_blocks, block, sums, lane);
    }
  }
}

template <int W, bool WithBlocks>
void add_cells(const SoftPass& pass, int block_begin, int block_end) {
  add_elements<W, WithBlocks>(pass, pass.cells, block_begin, block_end);
}

// Rows of the matrix from its edges, with forces and diagonals.
template <int W>
void fill_rows(const SoftPass& pass, int slice_begin, int slice_end) {
  for (int slice = slice_begin; slice < slice_end; ++slice) {
    for (int row = slice * kSliceRows; row < (slice + 1) * kSliceRows; ++row) {
      const float* const force = pass.corner_force + 4 * std::int64_t(row);
      pass.force.x[row] = force[0], pass.force.y[row] = force[1], pass.force.z[row] = force[2];
    }
    alignas(64) float diagonal[9][kSliceRows] = {};
    for (int slot = pass.full.slot_begin[slice]; slot < pass.full.slot_begin[slice + 1]; ++slot) {
      float* const to = pass.full_blocks + slot * 9 * kSliceRows;
      const std::int32_t* const edges = pass.edge_of_place + slot * kSliceRows;
      for (int lane = 0; lane < kSliceRows; ++lane) {
        if (edges[lane] < 0) {
          for (int part = 0; part < 9; ++part) to[part * kSliceRows + lane] = 0.0f;
          continue;
        }
        const float* const edge = pass.edge_blocks + kEdgeFloats * std::int64_t(edges[lane] / 2);
        const bool higher = (edges[lane] & 1) != 0;
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r)
            to[(3 * c + r) * kSliceRows + lane] = edge[higher ? 4 * r + c : 4 * c + r];
        }
      }
      for (int part = 0; part < 9; ++part) {
        for (int lane = 0; lane < kSliceRows; lane += W) {
          const Wide<W> sum =
              Wide<W>::load(diagonal[part] + lane) + Wide<W>::load(to + part * kSliceRows + lane);
          sum.store(diagonal[part] + lane);
        }
      }
    }
    constexpr int kPart[6][2] = {{0, 0}, {4, 4}, {8, 8}, {1, 3}, {2, 6}, {5, 7}};
    for (int part = 0; part < 6; ++part) {
      for (int lane = 0; lane < kSliceRows; ++lane) {
        pass.diagonal[part][slice * kSliceRows + lane] =
            0.5f * (diagonal[kPart[part][0]][lane] + diagonal[kPart[part][1]][lane]);
      }
    }
  }
}

template <int W>
void fill_forces(const SoftPass& pass, int slice_begin, int slice_end) {
  for (int row = slice_begin * kSliceRows; row < slice_end * kSliceRows; ++row) {
    const float* const force = pass.corner_force + 4 * std::int64_t(row);
    pass.force.x[row] = force[0], pass.force.y[row] = force[1], pass.force.z[row] = force[2];
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
