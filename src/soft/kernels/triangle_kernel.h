// The kernel of membrane triangles (soft/body/continuum.h), one template for every width.
//
// With S the stress of St Venant and Kirchhoff, the second derivative is that of the strains with the material's constants, and
// (g_a . S g_b) 1 from the stress that is there. Of S its negative part is left out, as with springs.
#pragma once

#include "soft/kernels/element_sums.h"
#include "soft/kernels/row_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A symmetric 2 x 2 matrix.
template <int W>
struct Sym2W {
  Wide<W> xx, yy, xy;
};

// With eigenvalues m + r and m - r: all of it, the part of the larger one, or nothing.
template <int W>
GYRE_INLINE Sym2W<W> without_negative_part(Sym2W<W> s) {
  const Wide<W> half = 0.5f * (s.xx - s.yy), mean = 0.5f * (s.xx + s.yy);
  const Wide<W> radius = sqrt(half * half + s.xy * s.xy), low = mean - radius;
  const Wide<W> share = keep((radius > 0.0f) & (mean + radius > 0.0f), 0.5f * (mean + radius) / radius);
  const Mask<W> whole = low >= 0.0f;
  return {select(whole, s.xx, share * (s.xx - low)), select(whole, s.yy, share * (s.yy - low)),
          select(whole, s.xy, share * s.xy)};
}

using TriangleSums = ElementSums<2, 3>;

template <int W>
GYRE_INLINE Vec3W<W> triangle_edge(const SoftPass& pass, const TriangleBlock& block, int corner, int lane) {
  alignas(64) float edge[3][W];
  for (int i = 0; i < W; ++i) {
    const std::int32_t a = block.corner[0][lane + i], b = block.corner[corner][lane + i];
    edge[0][i] = float(pass.x[b] - pass.x[a]);
    edge[1][i] = float(pass.y[b] - pass.y[a]);
    edge[2][i] = float(pass.z[b] - pass.z[a]);
  }
  return {Wide<W>::load(edge[0]), Wide<W>::load(edge[1]), Wide<W>::load(edge[2])};
}

template <int W, bool WithBlocks>
GYRE_INLINE void respond(const SoftPass& pass, const TriangleBlock& block, int lane, TriangleSums& out) {
  const ElementMaterial& material = pass.material;
  const Wide<W> c(material.stretch), contraction(material.contraction), shear(material.shear);
  const auto rest = [&](int k) { return Wide<W>::load(block.inverse[k] + lane); };
  const Vec3W<W> first = triangle_edge<W>(pass, block, 1, lane),
                 second = triangle_edge<W>(pass, block, 2, lane);
  const Vec3W<W> f1 = rest(0) * first + rest(1) * second, f2 = rest(2) * first + rest(3) * second;
  const Wide<W> e11 = 0.5f * (dot(f1, f1) - 1.0f), e22 = 0.5f * (dot(f2, f2) - 1.0f);
  const Sym2W<W> stress{c * e11 + contraction * e22, c * e22 + contraction * e11, shear * dot(f1, f2)};
  const Wide<W> area = Wide<W>::load(block.area + lane);
  // Gradients of the corners: rows of Dm^-1, and minus their sum.
  const Wide<W> g1[3] = {-(rest(0) + rest(1)), rest(0), rest(1)},
                g2[3] = {-(rest(2) + rest(3)), rest(2), rest(3)};
  const Vec3W<W> p1 = stress.xx * f1 + stress.xy * f2, p2 = stress.xy * f1 + stress.yy * f2;
  GYRE_UNROLL
  for (int a = 1; a < 3; ++a) {
    put_columns<W>(out.force[a - 1], lane, 0, -area * (g1[a] * p1 + g2[a] * p2));
  }
  if constexpr (WithBlocks) {
    constexpr int kPair[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    const Sym2W<W> pulling = without_negative_part(stress);
    const Wide<W> scale = -Wide<W>(pass.material_scale) * area,
                  across = -Wide<W>(pass.geometric_scale) * area;
    GYRE_UNROLL
    for (int e = 0; e < 3; ++e) {
      const int a = kPair[e][0], b = kPair[e][1];
      const Vec3W<W> a1 = g1[a] * f1, a2 = g2[a] * f2, a12 = g2[a] * f1 + g1[a] * f2;
      const Vec3W<W> b1 = g1[b] * f1, b2 = g2[b] * f2, b12 = g2[b] * f1 + g1[b] * f2;
      const Vec3W<W> left1 = scale * (c * a1 + contraction * a2), left2 = scale * (c * a2 + contraction * a1);
      const Vec3W<W> left12 = scale * shear * a12;
      const Wide<W> turning = across * (g1[a] * (pulling.xx * g1[b] + pulling.xy * g2[b]) +
                                        g2[a] * (pulling.xy * g1[b] + pulling.yy * g2[b]));
      const Vec3W<W> columns[3] = {b1.x * left1 + b2.x * left2 + b12.x * left12,
                                   b1.y * left1 + b2.y * left2 + b12.y * left12,
                                   b1.z * left1 + b2.z * left2 + b12.z * left12};
      put_block<W>(out.block[e], lane,
                   {{columns[0].x + turning, columns[0].y, columns[0].z},
                    {columns[1].x, columns[1].y + turning, columns[1].z},
                    {columns[2].x, columns[2].y, columns[2].z + turning}});
    }
  }
}

template <int W, bool WithBlocks>
void add_triangles(const SoftPass& pass, int block_begin, int block_end) {
  for (int b = block_begin; b < block_end; ++b) {
    const TriangleBlock& block = pass.triangles[b];
    TriangleSums sums;
    GYRE_ROLLED
    for (int lane = 0; lane < kTetLanes; lane += W) respond<W, WithBlocks>(pass, block, lane, sums);
    for (int lane = 0; lane < kTetLanes; ++lane) {
      if (block.area[lane] == 0.0f) continue;
      add_lane<W, WithBlocks>(pass.corner_force, pass.edge_blocks, block, sums, lane);
    }
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
