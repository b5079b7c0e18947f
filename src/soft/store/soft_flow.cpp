// Plastic flow of solids. See soft_damage.h.
#include "math/dense.h"
#include "math/trig.h"
#include "soft/body/deformation.h"
#include "soft/store/soft_damage.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kBlocksOfFlow = 16;
constexpr int kCellsOfFlow = 64;
// Beyond this |P|^2 a tetrahedron flows no further: it is drawn out to several times its length.
constexpr double kMaxFlow = 40.0;

// Dm^-1 P as the rest shape of a lane.
void set_rest_shape(const SoftDamage& damage, TetBlock& block, std::size_t tetrahedron, int lane) {
  const float* const rest = damage.rest_inverse.data() + 9 * tetrahedron;
  const float* const flow = damage.flow.data() + 9 * tetrahedron;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) sum += double(rest[3 * k + r]) * double(flow[3 * c + k]);
      block.gradient[3 * c + r][lane] = float(sum);
    }
  }
}

class Flow {
 public:
  Flow(SoftEntry& entry, float seconds) : entry_(entry), def_(std::get<SolidDef>(*entry.def)) {
    const double time = double(def_.creep_time);
    share_ = time > 0.0 ? 1.0 - exp(-double(seconds) / time) : 1.0;
  }

  void flow(std::size_t tetrahedron) {
    TetBlock& block = entry_.body.continuum.tetrahedra[tetrahedron / kTetLanes];
    const int lane = int(tetrahedron % kTetLanes);
    DVec3 f[3];
    find_stressed_deformation(entry_.body, tetrahedron, f);
    if (!(dot(f[0], cross(f[1], f[2])) > 0.0)) return;  // inside out
    const double right[6] = {dot(f[0], f[0]), dot(f[1], f[1]), dot(f[2], f[2]),
                             dot(f[0], f[1]), dot(f[0], f[2]), dot(f[1], f[2])};
    double moments[3], axes[9], strain[3], mean = 0.0;
    symmetric_eigen(right, moments, axes);
    for (int k = 0; k < 3; ++k) {
      if (!(moments[k] > 0.0)) return;
      strain[k] = 0.5 * log(moments[k]);
      mean += strain[k] / 3.0;
    }
    double square = 0.0;
    for (double& one : strain) one -= mean, square += one * one;
    const double stress = 2.0 * double(entry_.body.continuum.material.mu) * std::sqrt(1.5 * square);
    const double yield = double(def_.yield_stress);
    if (!(stress > yield)) return;
    const double part = share_ * (stress - yield) / stress;
    double turn[3];
    for (int k = 0; k < 3; ++k) turn[k] = exp(-part * strain[k]);
    take_up(tetrahedron, axes, turn);
    set_rest_shape(entry_.damage, block, tetrahedron, lane);
  }

 private:
  // P becomes P V diag(turn) V^T, of columns V.
  void take_up(std::size_t tetrahedron, const double (&axes)[9], const double (&turn)[3]) {
    double stretch[9] = {}, next[9], square = 0.0;
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) stretch[3 * c + r] += turn[k] * axes[3 * k + r] * axes[3 * k + c];
      }
    }
    float* const flow = entry_.damage.flow.data() + 9 * tetrahedron;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        next[3 * c + r] = 0.0;
        for (int k = 0; k < 3; ++k) next[3 * c + r] += double(flow[3 * k + r]) * stretch[3 * c + k];
        square += next[3 * c + r] * next[3 * c + r];
      }
    }
    if (square > kMaxFlow) return;
    for (int k = 0; k < 9; ++k) flow[k] = float(next[k]);
  }

  SoftEntry& entry_;
  const SolidDef& def_;
  double share_ = 1.0;  // of the excess that is taken up
};

}  // namespace

void renew_flow(SoftEntry& entry) {
  SoftDamage& damage = entry.damage;
  Array<TetBlock>& blocks = entry.body.continuum.tetrahedra;
  damage.rest_inverse.resize(damage.flow.size());
  for (std::size_t t = 0; t < damage.flow.size() / 9; ++t) {
    TetBlock& block = blocks[t / kTetLanes];
    const int lane = int(t % kTetLanes);
    for (int k = 0; k < 9; ++k) damage.rest_inverse[9 * t + std::size_t(k)] = block.gradient[k][lane];
    set_rest_shape(damage, block, t, lane);
  }
  for (int c = 0; c < entry.body.continuum.cell_count(); ++c) renew_cell(entry.body.continuum, c);
}

void begin_flow(SoftEntry& entry) {
  std::size_t count = 0;
  for (const TetBlock& block : entry.body.continuum.tetrahedra) {
    for (const float volume : block.volume) count += volume > 0.0f ? 1 : 0;
  }
  entry.damage.flow.resize(9 * count);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 9; ++k) entry.damage.flow[9 * t + k] = k % 4 == 0 ? 1.0f : 0.0f;
  }
  renew_flow(entry);
}

void flow_soft(SoftEntry& entry, float seconds, TaskSystem& tasks) {
  if (entry.damage.flow.empty()) return;
  Flow flow(entry, seconds);
  const int count = int(entry.damage.flow.size() / 9);
  for_blocks(tasks, count, kBlocksOfFlow * kTetLanes, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t) flow.flow(std::size_t(t));
  });
  Continuum& continuum = entry.body.continuum;
  for_blocks(tasks, continuum.cell_count(), kCellsOfFlow, [&](int begin, int end, int) {
    for (int c = begin; c < end; ++c) renew_cell(continuum, c);
  });
}

}  // namespace gyre
