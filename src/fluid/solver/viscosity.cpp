// Viscosity by stabilised explicit stages.
#include "fluid/solver/viscosity.h"

namespace gyre {

namespace {

float edge_of(const GasBox& box, int axis) {
  return axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z;
}
float along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Ghosts of faces: beyond walls that hold the gas, so that the mean with the face inside is the wall's velocity.
void fill_wall_ghosts(const GasPass& pass, int axis, float* faces) {
  const GasBox& box = pass.box();
  const GridShape& shape = pass.shape();
  wrap_faces(box, shape, axis, faces);
  for (int other = 0; other < 3; ++other) {
    if (other == axis || pass.flat(other)) continue;
    const int third = 3 - axis - other;
    const int step = shape.stride(other), last = shape.cells[other] - 1;
    for (int side = 0; side < 2; ++side) {
      if (box.side[2 * other + side] != GasBoundary::no_slip) continue;
      const float wall = along(box.wall_velocity[2 * other + side], axis);
      const int inside = side == 0 ? 0 : last * step, beyond = side == 0 ? -step : (last + 1) * step;
      for (int j = 0; j < shape.cells[third]; ++j) {
        for (int i = 0; i <= shape.cells[axis]; ++i) {
          float* const at = faces + shape.first + i * shape.stride(axis) + j * shape.stride(third);
          at[beyond] = 2.0f * wall - at[inside];
        }
      }
    }
  }
}

struct StageWeights {
  float last = 0.0f, older = 0.0f, first = 0.0f;  // of the states
  float change = 0.0f, first_change = 0.0f;       // of the changes in a step: of Y(j-1) and of Y0
};

// state = last Y(j-1) + older Y(j-2) + first Y0 + change F(Y(j-1)) + first_change F(Y0), F(Y) = step nu laplace Y + (target - Y0).
// `first_rate` = F(Y0) is found where `older` is null.
struct StageArrays {
  const float* target;
  const float* first;
  const float* last;
  const float* older;
  float* first_rate;
  float* state;
};

void run_stage(const GasPass& pass, int axis, float scale, const StageWeights& weights,
               const StageArrays& arrays) {
  const GridShape& shape = pass.shape();
  const float* const face = pass.memory.matrix.levels[0].face[axis].data();
  float inverse[3];
  for (int other = 0; other < 3; ++other)
    inverse[other] = pass.flat(other) ? 0.0f : scale / (pass.edge(other) * pass.edge(other));
  const float ix = inverse[0], iy = inverse[1], iz = inverse[2];
  const int py = shape.pitch, pz = shape.plane, last_face = shape.cells[axis];
  const bool wraps = pass.box().periodic(axis);
  const float* const y = arrays.last;
  each_row(pass, axis, [&](int c, int j, int k) {
    const int across = axis == 1 ? j : k;
    for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
      const int at = axis == 0 ? i : across, f = c + i;
      const bool side = (at == 0 || at == last_face) && !wraps;
      if (side || !(face[f] > 0.0f)) {
        arrays.state[f] = arrays.target[f];
        if (arrays.older == nullptr) arrays.first_rate[f] = 0.0f;
        continue;
      }
      const float laplacian = ix * ((y[f - 1] - y[f]) + (y[f + 1] - y[f])) +
                              iy * ((y[f - py] - y[f]) + (y[f + py] - y[f])) +
                              iz * ((y[f - pz] - y[f]) + (y[f + pz] - y[f]));
      const float rate = laplacian + (arrays.target[f] - arrays.first[f]);
      if (arrays.older == nullptr) {
        arrays.first_rate[f] = rate;
        arrays.state[f] = y[f] + weights.change * rate;
      } else {
        arrays.state[f] = weights.last * y[f] + weights.older * arrays.older[f] +
                          weights.first * arrays.first[f] + weights.change * rate +
                          weights.first_change * arrays.first_rate[f];
      }
    }
  });
}

// 1/m^2: times a kinematic viscosity this is the rate at which a difference between neighbours decays.
float viscous_scale(const GasBox& box) {
  float scale = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float edge = edge_of(box, axis);
    if (!box.flat(axis)) scale += 2.0f / (edge * edge);
  }
  return scale;
}

// So many stages are stable up to a viscosity that smooths the velocity over 300 cells within a step, which is more than a box has. A larger
// viscosity acts like that one.
constexpr int kMaxStages = 1001;
constexpr float kMaxDecay = 0.25f * float(kMaxStages * kMaxStages + kMaxStages - 2);

}  // namespace

int count_viscous_stages(const GasBox& box, float kinematic_viscosity, float step) {
  const float rate = kinematic_viscosity * viscous_scale(box);
  int stages = 3;
  while (float(stages * stages + stages - 2) < 4.0f * rate * step && stages < kMaxStages) stages += 2;
  return stages;
}

void save_velocity(const GasPass& pass) {
  for (int axis = 0; axis < 3; ++axis) {
    const Array<float>& from = pass.grid.velocity[axis];
    Array<float>& to = pass.memory.before[axis];
    to.resize(from.size(), 0.0f);
    each_row(pass, axis, [&](int c, int, int) {
      for (int i = c; i < c + pass.shape().cells[0] + (axis == 0 ? 1 : 0); ++i) to[i] = from[i];
    });
  }
}

void add_viscosity(const GasPass& pass, float kinematic_viscosity) {
  const GridShape& shape = pass.shape();
  const int stages = count_viscous_stages(pass.box(), kinematic_viscosity, pass.step);
  const double s = double(stages), w = 4.0 / (s * s + s - 2.0);
  const auto share = [](int j) {  // b_j
    const double n = double(j);
    return j < 2 ? 1.0 / 3.0 : (n * n + n - 2.0) / (2.0 * n * (n + 1.0));
  };
  const float most = kMaxDecay / viscous_scale(pass.box()), wanted = pass.step * kinematic_viscosity;
  const float scale = wanted < most ? wanted : most;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    float* const field = pass.grid.velocity[axis].data();
    float* const first = pass.memory.before[axis].data();
    float* const rate = pass.scratch(1);
    float* const states[3] = {pass.scratch(2), pass.scratch(3), pass.scratch(4)};  // Y_j is in states[j % 3]
    fill_wall_ghosts(pass, axis, first);
    StageWeights weights;
    weights.change = float(w / 3.0);
    run_stage(pass, axis, scale, weights, {field, first, first, nullptr, rate, states[1]});
    for (int j = 2; j <= stages; ++j) {
      const double n = double(j);
      const double mu = (2.0 * n - 1.0) / n * share(j) / share(j - 1);
      const double nu = -(n - 1.0) / n * share(j) / share(j - 2);
      weights.last = float(mu);
      weights.older = float(nu);
      weights.first = 1.0f - weights.last - weights.older;
      weights.change = float(mu * w);
      weights.first_change = float(-(1.0 - share(j - 1)) * mu * w);
      float* const last = states[(j - 1) % 3];
      fill_wall_ghosts(pass, axis, last);
      run_stage(pass, axis, scale, weights,
                {field, first, last, j == 2 ? first : states[(j - 2) % 3], rate, states[j % 3]});
    }
    const float* const last = states[stages % 3];
    each_row(pass, axis, [&](int c, int, int) {
      for (int i = c; i < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++i) field[i] = last[i];
    });
    wrap_faces(pass.box(), shape, axis, field);
  }
}

}  // namespace gyre
