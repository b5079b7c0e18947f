// Helpers of the tests of liquids.
#pragma once

#include "fluid/gas/gas_test_kit.h"
#include "fluid/liquid/liquid_reading.h"
#include "fluid/liquid/liquid_step.h"

namespace gyre::liquid_test {

using gas_test::box_of;
using gas_test::Random;

// The solids of a window, from those of the whole box.
struct WindowSolids {
  const LiquidGrid& grid;
  const GasSolids& whole;
  GasSolids part;

  void cut(const FluidWindow& window) {
    part = whole;
    if (!whole.present()) return;
    const auto copy = [&](const auto& from, auto& to) {
      if (from.empty()) return;
      to.resize(std::size_t(window.shape.size));
      for (int k = 0; k <= window.box.cells[2]; ++k)
        for (int j = 0; j <= window.box.cells[1]; ++j)
          for (int i = 0; i <= window.box.cells[0]; ++i)
            to[std::size_t(window.shape.at(i, j, k))] = from[std::size_t(
                grid.shape.at(window.first[0] + i, window.first[1] + j, window.first[2] + k))];
    };
    for (int axis = 0; axis < 3; ++axis) {
      copy(whole.open[axis], part.open[axis]), copy(whole.velocity[axis], part.velocity[axis]);
      copy(whole.label[axis], part.label[axis]);
    }
    copy(whole.solid, part.solid), copy(whole.distance, part.distance), copy(whole.nearest, part.nearest);
    part.near.clear();
  }
};

inline LiquidReport step_in_windows(LiquidGrid& grid, const GasSolids& solids,
                                    std::span<const FluidBody> bodies,
                                    std::span<const LiquidEmitter> emitters, const LiquidSettings& settings,
                                    double time, float step, LiquidMemory& memory, const GasKernels& kernels,
                                    TaskSystem& tasks, std::span<GasImpulse> impulses) {
  WindowSolids own{grid, solids, {}};
  return step_liquid(
      grid, own.part, [&](const FluidWindow& window) { own.cut(window); }, bodies, emitters, settings, time,
      step, memory, kernels, tasks, impulses);
}

struct Bench {
  TaskSystem tasks{1};
  const GasKernels* kernels = &select_gas_kernels(0);
  LiquidMemory memory;
  GasSolids solids;
  LiquidSettings settings;
  std::span<const FluidBody> bodies{};
  double time = 0.0;

  LiquidReport step(LiquidGrid& grid, float step = 1.0f / 60.0f, std::span<const LiquidEmitter> emitters = {},
                    std::span<GasImpulse> impulses = {}) {
    const LiquidReport report = step_in_windows(grid, solids, bodies, emitters, settings, time, step, memory,
                                                *kernels, tasks, impulses);
    time += double(step);
    return report;
  }
};

inline float fastest_particle(const LiquidGrid& grid) {
  float most = 0.0f;
  for (int p = 0; p < grid.particles(); ++p) {
    const Vec3 v{grid.motion[0][p], grid.motion[1][p], grid.motion[2][p]};
    most = std::fmax(most, length(v));
  }
  return most;
}

// The solids of a grid from the distance of a point from them, negative within: fractions of faces by 8 x 8 points. Adds to what is there
// already with another label.
template <class Distance, class Velocity>
void place_solid(const LiquidGrid& grid, int label, GasSolids& solids, Distance&& distance,
                 Velocity&& velocity) {
  const GridShape& shape = grid.shape;
  const float h = grid.box.cell.x;
  const std::size_t size = std::size_t(shape.size);
  if (solids.labels <= label) solids.labels = label + 1;
  if (solids.distance.size() != size) {
    solids.distance.clear();
    solids.distance.resize(size, 4.0f * h);
    solids.nearest.clear();
    solids.nearest.resize(size, std::int16_t(-1));
  }
  constexpr int kSamples = 8;
  for (int k = 0; k <= shape.cells[2]; ++k) {
    for (int j = 0; j <= shape.cells[1]; ++j) {
      for (int i = 0; i <= shape.cells[0]; ++i) {
        const int c = shape.at(i, j, k);
        const Vec3 lower{float(i) * h, float(j) * h, float(k) * h};
        const float d = distance(lower + Vec3{0.5f * h, 0.5f * h, 0.5f * h});
        const bool is_cell = i < shape.cells[0] && j < shape.cells[1] && k < shape.cells[2];
        if (is_cell && d < solids.distance[c]) {
          solids.distance[c] = d;
          solids.nearest[c] = std::int16_t(label);
          if (d < 0.0f) solids.solid[c] = 1;
        }
        if (d > 3.0f * h) continue;
        for (int axis = 0; axis < 3; ++axis) {
          if (grid.box.flat(axis)) continue;
          const int index[3] = {i, j, k};
          bool exists = true;
          for (int other = 0; other < 3; ++other)
            exists = exists && (other == axis || index[other] < shape.cells[other]);
          if (!exists) continue;
          int open = 0;
          for (int a = 0; a < kSamples; ++a) {
            for (int b = 0; b < kSamples; ++b) {
              const float s = h * (float(a) + 0.5f) / kSamples, t = h * (float(b) + 0.5f) / kSamples;
              const Vec3 at = axis == 0   ? lower + Vec3{0, s, t}
                              : axis == 1 ? lower + Vec3{s, 0, t}
                                          : lower + Vec3{s, t, 0};
              open += distance(at) > 0.0f ? 1 : 0;
            }
          }
          if (open == kSamples * kSamples) continue;
          const Vec3 middle = axis == 0   ? lower + Vec3{0, 0.5f * h, 0.5f * h}
                              : axis == 1 ? lower + Vec3{0.5f * h, 0, 0.5f * h}
                                          : lower + Vec3{0.5f * h, 0.5f * h, 0};
          const Vec3 speed = velocity(middle);
          solids.open[axis][c] = float(open) / float(kSamples * kSamples);
          solids.velocity[axis][c] = axis == 0 ? speed.x : axis == 1 ? speed.y : speed.z;
          solids.label[axis][c] = std::int16_t(label);
        }
      }
    }
  }
  ++solids.revision;
}

// The distance from a box with these half edges that is turned about z by an angle.
inline float box_distance(Vec3 point, Vec3 center, Vec3 half, float angle = 0.0f) {
  const float c = std::cos(angle), s = std::sin(angle);
  const Vec3 d = point - center;
  const Vec3 local{std::fabs(c * d.x + s * d.y) - half.x, std::fabs(-s * d.x + c * d.y) - half.y,
                   std::fabs(d.z) - half.z};
  const Vec3 out = max(local, Vec3{});
  return length(out) + std::fmin(largest(local), 0.0f);
}

}  // namespace gyre::liquid_test
