// Pressure: its gradient, its equation, and its impulses on solids.
#include "fluid/solver/projection.h"

namespace gyre {

namespace {

constexpr int kX = 0, kRight = 1, kP = 2, kQ = 3, kZ = 4, kOther = 5;  // scratch

// The net inflow of the cells of a row over their volume, where solids cut faces: the open part of a face moves with the gas, the rest with
// the solid.
void find_cut_inflow(const GasPass& pass, int c, int j, int k, float* to) {
  const GridShape& shape = pass.shape();
  const PressureGrid& finest = pass.memory.matrix.levels[0];
  const int n = shape.cells[0];
  for (int i = 0; i < n; ++i) to[i] = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float edge = pass.edge(axis), inverse_edge = 1.0f / edge;
    const float* const face = finest.face[axis].data() + c;
    const float* const velocity = pass.grid.velocity[axis].data() + c;
    const float* const solid = pass.solid_velocity(axis) + c;
    const auto flux = [&](int i, bool open_side) {  // at open sides coefficients are doubled
      const float open = face[i] * (open_side ? 0.5f * edge * edge : edge * edge);
      return inverse_edge * (open * velocity[i] + (1.0f - open) * solid[i]);
    };
    const int step = shape.stride(axis), last = shape.cells[axis] - 1;
    const bool open_low = pass.box().open(2 * axis), open_high = pass.box().open(2 * axis + 1);
    for (int i = 0; i < n; ++i) {
      const int at = axis == 0 ? i : axis == 1 ? j : k;
      to[i] += flux(i, at == 0 && open_low) - flux(i + step, at == last && open_high);
    }
  }
  const float* const inverse = finest.inverse_diagonal.data() + c;
  for (int i = 0; i < n; ++i) to[i] = inverse[i] > 0.0f ? to[i] : 0.0f;
}

// The net inflow of cells over their volume.
void find_inflow(const GasPass& pass, float* to) {
  const PressureLevel level = pass.memory.matrix.level(0);
  const Array<std::uint8_t>& cut = pass.memory.matrix.cut_row;
  const float* velocity[3];
  float scale[3];
  for (int axis = 0; axis < 3; ++axis) {
    velocity[axis] = pass.grid.velocity[axis].data();
    scale[axis] = pass.flat(axis) ? 0.0f : 1.0f / pass.edge(axis);
  }
  const int rows_y = pass.shape().cells[1];
  for_row_blocks(rows_of(pass.shape(), -1), pass.tasks, [&](int begin, int end) {
    if (cut.empty()) return pass.kernels.find_inflow(level, velocity, scale, to, begin, end);
    for (int row = begin; row < end; ++row) {
      const int k = row / rows_y, j = row - k * rows_y, c = pass.shape().row(j, k);
      if (cut[row] != 0) {
        find_cut_inflow(pass, c, j, k, to + c);
      } else {
        pass.kernels.find_inflow(level, velocity, scale, to, row, row + 1);
      }
    }
  });
  if (pass.couples()) add_sealed_inflow(pass.memory.coupling, to);
}

// velocity -= scale times the gradient of a pressure, on faces that have a coefficient.
void subtract_gradient(const GasPass& pass, float* field, float scale) {
  fill_pressure_ghosts(pass.box(), pass.shape(), field);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    float* const velocity = pass.grid.velocity[axis].data();
    const FieldRows rows = rows_of(pass.shape(), axis);
    for_row_blocks(rows, pass.tasks, [&](int begin, int end) {
      pass.kernels.subtract_gradient(rows, face, field, pass.shape().stride(axis), scale / pass.edge(axis),
                                     velocity, begin, end);
    });
  }
}

// At the side walls: the gradient of the next face inside, with the sign and scale of subtract_gradient.
void add_wall_gradient(const GasPass& pass, float scale) {
  const GridShape& shape = pass.shape();
  const float* const field = pass.grid.pressure.data();
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis) || pass.box().periodic(axis)) continue;
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    const int step = shape.stride(axis), last = shape.cells[axis];
    const float inner = scale / pass.edge(axis);
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    float* const velocity = pass.grid.velocity[axis].data();
    for (int side = 0; side < 2; ++side) {
      if (pass.box().open(2 * axis + side)) continue;
      const int wall = side == 0 ? 0 : last * step, inside = side == 0 ? step : (last - 1) * step;
      for (int j = 0; j < shape.cells[b]; ++j) {
        for (int i = 0; i < shape.cells[a]; ++i) {
          const int c = shape.first + i * shape.stride(a) + j * shape.stride(b);
          if (face[c + inside] > 0.0f)
            velocity[c + wall] -= inner * (field[c + inside] - field[c + inside - step]);
        }
      }
    }
  }
}

}  // namespace

void add_pressure(const GasPass& pass, float share, bool over_walls) {
  subtract_gradient(pass, pass.grid.pressure.data(), share * pass.step);
  if (over_walls) add_wall_gradient(pass, share * pass.step);
}

void set_walls(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    float* const velocity = pass.grid.velocity[axis].data();
    const int step = shape.stride(axis), last = shape.cells[axis];
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    for (int side = 0; side < 2; ++side) {
      if (pass.box().open(2 * axis + side) || pass.box().periodic(axis)) continue;
      for (int j = 0; j < shape.cells[b]; ++j) {
        for (int i = 0; i < shape.cells[a]; ++i)
          velocity[shape.first + i * shape.stride(a) + j * shape.stride(b) + side * last * step] = 0.0f;
      }
    }
    if (!pass.solids.present() || pass.flat(axis)) continue;
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    const std::int16_t* const label = pass.solids.label[axis].data();
    const float* const solid = pass.solid_velocity(axis);
    const auto is_cut = [&](int j, int k) {
      return j >= 0 && j < shape.cells[1] && k >= 0 && k < shape.cells[2] &&
             pass.memory.matrix.cut_row[j + k * shape.cells[1]] != 0;
    };
    each_row(pass, axis, [&](int c, int j, int k) {
      if (!is_cut(j, k) && !is_cut(axis == 1 ? j - 1 : j, axis == 2 ? k - 1 : k)) return;
      for (int i = c; i < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
        if (face[i] == 0.0f && label[i] >= 0) velocity[i] = solid[i];
      }
    });
  }
}

namespace {

// A wall stays where it is, whatever body crosses it.
void still_walls(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2, step = shape.stride(axis);
    for (int side = 0; side < 2; ++side) {
      if (pass.box().open(2 * axis + side) || pass.box().periodic(axis)) continue;
      float* const wall = pass.memory.solid_velocity[axis].data() + side * shape.cells[axis] * step;
      for (int j = 0; j < shape.cells[b]; ++j)
        for (int i = 0; i < shape.cells[a]; ++i)
          wall[shape.first + i * shape.stride(a) + j * shape.stride(b)] = 0.0f;
    }
  }
}

}  // namespace

void begin_bodies(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  GasMemory& memory = pass.memory;
  BodyCoupling& coupling = memory.coupling;
  begin_motions(pass.box(), pass.bodies, pass.solids.present() ? pass.solids.labels : 0, coupling);
  if (!pass.couples()) return;
  const PressureGrid& finest = memory.matrix.levels[0];
  for (int axis = 0; axis < 3; ++axis) {
    memory.solid_velocity[axis] = pass.solids.velocity[axis];
    // The share of each face in the equation; sides of the box are not asked for.
    const float* const face = finest.face[axis].data();
    const float square = pass.edge(axis) * pass.edge(axis);
    Array<float>& open = memory.open[axis];
    open.resize(std::size_t(shape.size), 0.0f);
    each_row(pass, axis, [&](int c, int, int) {
      for (int i = c; i < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++i) open[i] = square * face[i];
    });
  }
  const CouplingGrid grid{pass.box(),
                          shape,
                          pass.solids,
                          {memory.open[0].data(), memory.open[1].data(), memory.open[2].data()},
                          finest.inverse_diagonal.data(),
                          pass.density};
  find_cut_faces(grid, false, coupling);
  still_walls(pass);
}

namespace {

// Faces that are closed, or in part, by bodies that move by the pressure.
void tell_motions(const GasPass& pass) {
  const BodyCoupling& coupling = pass.memory.coupling;
  for (const CutFace& face : coupling.faces) {
    if (coupling.solids[face.label].moves)
      pass.memory.solid_velocity[face.axis][face.face] = coupling.velocity_of(face);
  }
}

// Bodies as they would move without the change of pressure that is to be found: by other forces, and by the pressure of the step before.
void predict_bodies(const GasPass& pass, float* x) {
  BodyCoupling& coupling = pass.memory.coupling;
  const float* const velocity[3] = {pass.grid.velocity[0].data(), pass.grid.velocity[1].data(),
                                    pass.grid.velocity[2].data()};
  predict_motions(pass.bodies, pass.step, velocity, coupling);
  const float* const pressure = pass.grid.pressure.data();
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + pass.shape().cells[0]; ++i) x[i] = pass.step * pressure[i];
  });
  push_bodies(x, coupling);
  tell_motions(pass);
}

}  // namespace

PressureReport project_velocity(const GasPass& pass, const ProjectionSettings& settings) {
  const GridShape& shape = pass.shape();
  PressureVectors vectors;
  vectors.x = pass.scratch(kX);
  vectors.r = pass.scratch(kRight);
  vectors.p = pass.scratch(kP);
  vectors.q = pass.scratch(kQ);
  vectors.z = pass.scratch(kZ);
  vectors.other = pass.scratch(kOther);
  for (float* vector : {vectors.p, vectors.z, vectors.other}) clear_ghosts(shape, vector);
  const bool couples = pass.couples();
  const BodyCoupling* const coupling = couples ? &pass.memory.coupling : nullptr;
  if (couples) predict_bodies(pass, vectors.x);
  find_inflow(pass, vectors.r);
  const float before = largest_of(rows_of(shape, -1), vectors.r, pass.kernels, pass.tasks);
  const float allowed = settings.divergence / pass.step, reduced = settings.reduction * before;
  const float target = allowed < reduced ? allowed : reduced;
  const PressureReport report = solve_pressure(pass.memory.matrix, vectors, target, settings.max_iterations,
                                               pass.kernels, pass.tasks, coupling);
  subtract_gradient(pass, vectors.x, 1.0f);
  if (couples) {
    push_bodies(vectors.x, pass.memory.coupling);
    tell_motions(pass);
  }
  float* const pressure = pass.grid.pressure.data();
  const float* const inverse = pass.memory.matrix.levels[0].inverse_diagonal.data();
  const float scale = 1.0f / pass.step;
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i)
      pressure[i] = inverse[i] > 0.0f ? pressure[i] + scale * vectors.x[i] : 0.0f;
  });
  return report;
}

float largest_divergence(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  float* const scratch = pass.scratch(kRight);
  find_inflow(pass, scratch);
  return largest_of(rows_of(shape, -1), scratch, pass.kernels, pass.tasks);
}

void add_impulses(const GasPass& pass, float density, std::span<GasImpulse> impulses) {
  const bool couples = pass.couples();
  if (couples) {
    const float* const velocity[3] = {pass.grid.velocity[0].data(), pass.grid.velocity[1].data(),
                                      pass.grid.velocity[2].data()};
    add_body_impulses(velocity, pass.memory.coupling, impulses, false);
  }
  const GridShape& shape = pass.shape();
  const float* const pressure = pass.grid.pressure.data();
  const float* const inverse = pass.memory.matrix.levels[0].inverse_diagonal.data();
  const double volume = double(pass.edge(0)) * double(pass.edge(1)) * double(pass.edge(2));
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const open = pass.solids.open[axis].data();
    const std::int16_t* const label = pass.solids.label[axis].data();
    const int step = shape.stride(axis);
    const double scale = double(pass.step) * double(density) * volume / double(pass.edge(axis));
    for (int k = 0; k < shape.cells[2]; ++k) {
      for (int j = 0; j < shape.cells[1]; ++j) {
        if (!pass.solids.may_cut(shape, j, k)) continue;
        const int c = shape.row(j, k);
        for (int i = 0; i < shape.cells[0]; ++i) {
          const int at = axis == 0 ? i : axis == 1 ? j : k;
          const int one = label[c + i];
          if (at == 0 || one < 0 || one >= int(impulses.size())) continue;
          if (couples && pass.memory.coupling.solids[one].moves) continue;
          const bool lower = inverse[c + i - step] > 0.0f, upper = inverse[c + i] > 0.0f;
          const double closed = lower && upper && open[c + i] >= kMinOpen ? 1.0 - double(open[c + i]) : 1.0;
          const double push =
              scale * closed *
              (double(lower ? pressure[c + i - step] : 0.0f) - double(upper ? pressure[c + i] : 0.0f));
          DVec3 position{(i + (axis == 0 ? 0.0 : 0.5)) * double(pass.edge(0)),
                         (j + (axis == 1 ? 0.0 : 0.5)) * double(pass.edge(1)),
                         (k + (axis == 2 ? 0.0 : 0.5)) * double(pass.edge(2))};
          if (one < int(pass.bodies.size()))
            position += image_shift(pass.box(), position, pass.bodies[std::size_t(one)].center - pass.box().corner);
          const DVec3 force = axis == 0   ? DVec3{push, 0, 0}
                              : axis == 1 ? DVec3{0, push, 0}
                                          : DVec3{0, 0, push};
          impulses[std::size_t(one)].linear += force;
          impulses[std::size_t(one)].angular += cross(position, force);
        }
      }
    }
  }
}

}  // namespace gyre
