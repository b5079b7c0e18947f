// Implicit viscosity by conjugate gradients.
#include "fluid/liquid/liquid_viscosity.h"

namespace gyre {

namespace {

constexpr float kMinWeight =
    0.05f;  // of a face that has liquid beside it: less would make its equation stand apart from the others
constexpr float kTolerance = 1.0e-3f;  // of the first residual
constexpr int kMaxIterations = 200;

struct Viscosity {
  const LiquidPass& pass;
  float scale = 0.0f;            // step times kinematic viscosity
  Array<float> share;            // of cells: how much of them is liquid
  Array<float> edge[3];          // weights of the edges along each axis
  Array<float> weight[3];        // of faces; 0: its velocity is given
  Array<std::uint8_t> known[3];  // faces beside liquid
  Array<float> inverse[3];       // of the diagonal
  Array<float> stress[6];        // along the axes, then of edges along each axis
  Array<float> r[3], p[3], q[3];

  explicit Viscosity(const LiquidPass& of, float kinematic_viscosity)
      : pass(of), scale(of.step * kinematic_viscosity) {
    const std::size_t size = std::size_t(of.shape().size);
    share.resize(size, 0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      for (Array<float>* one : {&edge[axis], &weight[axis], &inverse[axis], &r[axis], &p[axis], &q[axis]})
        one->resize(size, 0.0f);
    }
    for (Array<std::uint8_t>& one : known) one.resize(size, std::uint8_t(0));
    for (Array<float>& one : stress) one.resize(size, 0.0f);
    find_weights();
  }

  float over(int axis) const { return pass.flat(axis) ? 0.0f : 1.0f / pass.edge(axis); }
  template <class Fn>
  void each_face(int axis, Fn&& fn) const {
    each_row(pass, axis, [&](int c, int, int) {
      for (int f = c; f < c + pass.shape().cells[0] + (axis == 0 ? 1 : 0); ++f) fn(f);
    });
  }
  // Edges along an axis stand at all corners of the plane across it.
  template <class Fn>
  void each_edge(int axis, Fn&& fn) const {
    const GridShape& shape = pass.shape();
    const int rows_y = shape.cells[1] + (axis == 1 ? 0 : 1), rows_z = shape.cells[2] + (axis == 2 ? 0 : 1);
    for_blocks(pass.tasks, rows_y * rows_z, kGridRows, [&](int begin, int end, int) {
      for (int row = begin; row < end; ++row) {
        const int k = row / rows_y, j = row - k * rows_y;
        for (int i = 0; i < shape.cells[0] + (axis == 0 ? 0 : 1); ++i) fn(shape.at(i, j, k), i, j, k);
      }
    });
  }

  void find_weights() {
    const GridShape& shape = pass.shape();
    const LiquidCell* const cell = pass.memory.cell.data();
    const float* const surface = pass.memory.surface.data();
    const float inverse_edge = 1.0f / pass.edge(0);
    each_row(pass, -1, [&](int c, int, int) {
      for (int i = c; i < c + shape.cells[0]; ++i)
        share[i] = cell[i] == LiquidCell::liquid ? clamp(0.5f - surface[i] * inverse_edge, 0.0f, 1.0f) : 0.0f;
    });
    fill_ghosts(pass.box(), shape, share.data());
    for (int axis = 0; axis < 3; ++axis) {
      const int step = shape.stride(axis);
      if (pass.flat(axis)) continue;
      const float* const open = pass.memory.open[axis].data();
      const float* const sums = pass.memory.sums[axis].data();
      const float inverse_volume = 1.0f / (pass.edge(0) * pass.edge(1) * pass.edge(2));
      each_face(axis, [&](int f) {
        const bool beside = cell[f] == LiquidCell::liquid || cell[f - step] == LiquidCell::liquid;
        const float full = inverse_volume * sums[2 * f];
        known[axis][f] = beside ? 1 : 0;
        weight[axis][f] = beside && open[f] > 0.0f ? clamp(full, kMinWeight, 1.0f) : 0.0f;
      });
      wrap_points(pass, known[axis].data());
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      if (pass.flat(a) || pass.flat(b)) continue;
      const int sa = shape.stride(a), sb = shape.stride(b);
      each_edge(axis, [&](int e, int i, int j, int k) {
        const int index[3] = {i, j, k};
        bool slips = false;
        for (const int other : {a, b}) {
          if (pass.wraps(other)) continue;
          if (index[other] == 0) slips = slips || pass.box().side[2 * other] != GasBoundary::no_slip;
          if (index[other] == shape.cells[other])
            slips = slips || pass.box().side[2 * other + 1] != GasBoundary::no_slip;
        }
        // A ghost beyond a wall that holds the liquid is solid but has the share of the cell inside.
        // Stress needs the velocity on all four faces, but for those beyond a wall.
        const auto is_known = [&](int of, int f, int across) {
          const int place = index[across] - (f == e ? 0 : 1);
          return place < 0 || place >= shape.cells[across] || known[of][f] != 0;
        };
        slips = slips || !is_known(a, e, b) || !is_known(a, e - sb, b) || !is_known(b, e, a) ||
                !is_known(b, e - sa, a);
        const auto blocked = [&](int c) { return pass.solids.present() && pass.memory.blocked[c] != 0; };
        slips = slips || blocked(e) || blocked(e - sa) || blocked(e - sb) || blocked(e - sa - sb);
        edge[axis][e] =
            slips ? 0.0f : 0.25f * ((share[e] + share[e - sa]) + (share[e - sb] + share[e - sa - sb]));
      });
    }
    find_diagonals();
  }

  void find_diagonals() {
    const GridShape& shape = pass.shape();
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      const int step = shape.stride(axis);
      const float along = over(axis) * over(axis);
      each_face(axis, [&](int f) {
        if (!(weight[axis][f] > 0.0f)) return;
        float diagonal = 2.0f * along * (share[f] + share[f - step]);
        for (int other = 0; other < 3; ++other) {
          if (other == axis || pass.flat(other)) continue;
          const Array<float>& edges = edge[3 - axis - other];
          diagonal += over(other) * over(other) * (edges[f] + edges[f + shape.stride(other)]);
        }
        inverse[axis][f] = 1.0f / (weight[axis][f] + scale * diagonal);
      });
    }
  }

  // Ghosts of faces beyond walls that hold the liquid. `moves`: with the velocity of the wall.
  void fill_wall_ghosts(int axis, float* faces, bool moves) const {
    const GridShape& shape = pass.shape();
    wrap_points(pass, faces);
    for (int other = 0; other < 3; ++other) {
      if (other == axis || pass.flat(other) || pass.wraps(other)) continue;
      const int third = 3 - axis - other, step = shape.stride(other), last = shape.cells[other] - 1;
      for (int side = 0; side < 2; ++side) {
        const float wall = moves ? part_along(pass.box().wall_velocity[2 * other + side], axis) : 0.0f;
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

  // out = A of a field of faces, zero where the velocity is given.
  void apply(Array<float> (&field)[3], Array<float> (&out)[3], bool moves) {
    const GridShape& shape = pass.shape();
    for (int axis = 0; axis < 3; ++axis)
      if (!pass.flat(axis)) fill_wall_ghosts(axis, field[axis].data(), moves);
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      const int step = shape.stride(axis);
      const float factor = 2.0f * scale * over(axis);
      const float* const u = field[axis].data();
      each_row(pass, -1, [&](int c, int, int) {
        for (int i = c; i < c + shape.cells[0]; ++i)
          stress[axis][i] = factor * share[i] * (u[i + step] - u[i]);
      });
      wrap_points(pass, stress[axis].data());
    }
    for (int axis = 0; axis < 3; ++axis) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      if (pass.flat(a) || pass.flat(b)) continue;
      const int sa = shape.stride(a), sb = shape.stride(b);
      const float fa = over(a), fb = over(b);
      const float *const ua = field[a].data(), *const ub = field[b].data();
      each_edge(axis, [&](int e, int, int, int) {
        stress[3 + axis][e] = scale * edge[axis][e] * (fb * (ua[e] - ua[e - sb]) + fa * (ub[e] - ub[e - sa]));
      });
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      const int step = shape.stride(axis);
      const float* const u = field[axis].data();
      each_face(axis, [&](int f) {
        if (!(weight[axis][f] > 0.0f)) {
          out[axis][f] = 0.0f;
          return;
        }
        float sum = over(axis) * (stress[axis][f] - stress[axis][f - step]);
        for (int other = 0; other < 3; ++other) {
          if (other == axis || pass.flat(other)) continue;
          const Array<float>& shear = stress[3 + 3 - axis - other];
          sum += over(other) * (shear[f + shape.stride(other)] - shear[f]);
        }
        out[axis][f] = weight[axis][f] * u[f] - sum;
      });
    }
  }

  // Over all faces but the upper ones of periodic axes, which are the lower ones.
  template <class Fn>
  double sum(Fn&& fn) const {
    const GridShape& shape = pass.shape();
    double all = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      all += sum_rows(shape, pass.tasks, [&](int c, int, int) {
        double part = 0.0;
        for (int f = c; f < c + shape.cells[0]; ++f) part += fn(axis, f);
        return part;
      });
    }
    return all;
  }
};

}  // namespace

int add_liquid_viscosity(const LiquidPass& pass, float kinematic_viscosity) {
  Viscosity work(pass, kinematic_viscosity);
  Array<float>(&velocity)[3] = pass.memory.velocity;
  work.apply(velocity, work.q, true);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    work.each_face(axis, [&](int f) {
      work.r[axis][f] = work.weight[axis][f] * velocity[axis][f] - work.q[axis][f];
      work.p[axis][f] = work.inverse[axis][f] * work.r[axis][f];
    });
  }
  const auto product = [&] {
    return work.sum([&](int axis, int f) {
      return double(work.r[axis][f]) * double(work.r[axis][f]) * double(work.inverse[axis][f]);
    });
  };
  double now = product();
  const double target = double(kTolerance) * double(kTolerance) * now;
  int iterations = 0;
  while (iterations < kMaxIterations && now > target && now > 0.0) {
    work.apply(work.p, work.q, false);
    const double curvature =
        work.sum([&](int axis, int f) { return double(work.p[axis][f]) * double(work.q[axis][f]); });
    if (!(curvature > 0.0)) break;
    const float alpha = float(now / curvature);
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      work.each_face(axis, [&](int f) {
        velocity[axis][f] += alpha * work.p[axis][f];
        work.r[axis][f] -= alpha * work.q[axis][f];
      });
    }
    const double next = product();
    const float beta = float(next / now);
    now = next;
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      work.each_face(axis, [&](int f) {
        work.p[axis][f] = work.inverse[axis][f] * work.r[axis][f] + beta * work.p[axis][f];
      });
    }
    ++iterations;
  }
  return iterations;
}

}  // namespace gyre
