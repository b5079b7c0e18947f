// Projection of a liquid.
#include "fluid/liquid/liquid_pressure.h"

#include "fluid/liquid/liquid_cells.h"

namespace gyre {

namespace {

constexpr int kX = 0, kRight = 1, kP = 2, kQ = 3, kZ = 4, kOther = 5;  // scratch

// Of the room that is too full or not full enough this share is made up for in a sub-step: all at once would overshoot where particles lie unevenly.
constexpr float kSpreadShare = 0.25f;
constexpr float kSpreadTolerance = 0.02f;  // of a full cell: what is left alone
constexpr float kMaxSpread =
    2.0f;  // of a full cell, that counts: half of one is too slow where a flat body presses particles together

PressureVectors vectors_of(const LiquidPass& pass) {
  PressureVectors vectors;
  vectors.x = pass.scratch(kX);
  vectors.r = pass.scratch(kRight);
  vectors.p = pass.scratch(kP);
  vectors.q = pass.scratch(kQ);
  vectors.z = pass.scratch(kZ);
  vectors.other = pass.scratch(kOther);
  for (float* vector : {vectors.x, vectors.r, vectors.p, vectors.z, vectors.other})
    clear_ghosts(pass.shape(), vector);
  return vectors;
}

// The net inflow of liquid cells over their volume, without what solids bring.
void find_open_inflow(const LiquidPass& pass, float* to) {
  const PressureLevel level = pass.memory.matrix.level(0);
  const float *open[3], *velocity[3];
  float scale[3];
  for (int axis = 0; axis < 3; ++axis) {
    open[axis] = pass.memory.open[axis].data();
    velocity[axis] = pass.memory.velocity[axis].data();
    scale[axis] = 1.0f / pass.edge(axis);
  }
  for_row_blocks(rows_of(pass.shape(), -1), pass.tasks, [&](int begin, int end) {
    pass.kernels.find_open_inflow(level, open, velocity, scale, to, begin, end);
  });
}

void add_solid_inflow(const LiquidPass& pass, float* to) {
  const BodyCoupling& coupling = pass.memory.coupling;
  for (const CutFace& face : coupling.faces) {
    const float inflow = face.share * coupling.velocity_of(face);
    if (face.upper >= 0) to[face.upper] += inflow;
    if (face.lower >= 0) to[face.lower] -= inflow;
  }
}

// field on faces -= scale times the gradient of x.
void subtract_liquid_gradient(const LiquidPass& pass, float* x, float scale, Array<float> (&fields)[3]) {
  wrap_points(pass, x);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const steepness = pass.memory.steepness[axis].data();
    float* const field = fields[axis].data();
    const int step = pass.shape().stride(axis);
    const float factor = scale / pass.edge(axis);
    each_row(pass, axis, [&](int c, int j, int k) {
      if (is_dry(pass, axis, j, k)) return;
      pass.kernels.subtract_weighted(steepness + c, x + c, step, factor, field + c,
                                     pass.shape().cells[0] + (axis == 0 ? 1 : 0));
    });
  }
}

float largest_cell(const LiquidPass& pass, const float* field) {
  return largest_of(rows_of(pass.shape(), -1), field, pass.kernels, pass.tasks);
}

// Faces that are closed beside liquid move as the wall or the solid does.
void set_closed_faces(const LiquidPass& pass, Array<float> (&fields)[3]) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const open = pass.memory.open[axis].data();
    float* const field = fields[axis].data();
    const bool solids = pass.solids.present();
    each_row(pass, axis, [&](int c, int j, int k) {
      const int count = shape.cells[0] + (axis == 0 ? 1 : 0), across = axis == 1 ? j : k;
      // Without solids only those of walls are closed.
      const bool inner = !solids && (axis == 0 || (across > 0 && across < shape.cells[axis]));
      const int step = inner ? count - 1 : 1;
      if (inner && axis != 0) return;
      for (int f = c; f < c + count; f += step) field[f] = open[f] > 0.0f ? field[f] : 0.0f;
    });
  }
  const BodyCoupling& coupling = pass.memory.coupling;
  for (const CutFace& face : coupling.faces) {
    if (!(pass.memory.open[face.axis][face.face] > 0.0f))
      fields[face.axis][face.face] = coupling.velocity_of(face);
  }
}

}  // namespace

PressureReport project_liquid(const LiquidPass& pass, const LiquidSettings& settings,
                              std::span<GasImpulse> impulses) {
  LiquidMemory& memory = pass.memory;
  const GridShape& shape = pass.shape();
  PressureVectors vectors = vectors_of(pass);
  const float* const active = memory.matrix.levels[0].inverse_diagonal.data();
  const float* const velocity[3] = {memory.velocity[0].data(), memory.velocity[1].data(),
                                    memory.velocity[2].data()};
  const bool solids = pass.solids.present();
  if (solids) {
    const CouplingGrid coupling{pass.box(),
                                shape,
                                pass.solids,
                                {memory.open[0].data(), memory.open[1].data(), memory.open[2].data()},
                                active,
                                settings.density,
                                {memory.window.first[0], memory.window.first[1], memory.window.first[2]}};
    find_cut_faces(coupling, true, memory.coupling);
    if (!(settings.blend < 1.0f)) {
      for (const CutFace& face : memory.coupling.faces) {
        const float fallen = pass.step * part_along(settings.gravity, face.axis);
        memory.before[face.axis][face.face] = memory.velocity[face.axis][face.face] - fallen;
      }
    }
    predict_motions(pass.bodies, pass.step, velocity, memory.coupling);
  }
  find_open_inflow(pass, vectors.r);
  if (solids) add_solid_inflow(pass, vectors.r);
  float before = largest_cell(pass, vectors.r);
  for (int axis = 0; axis < 3; ++axis) {
    // A liquid that only rests moves by this until pressure holds it.
    const float fall = absolute(part_along(settings.gravity, axis)) * pass.step / pass.edge(axis);
    if (!pass.flat(axis) && fall > before) before = fall;
  }
  // From the pressure of the step before.
  float* const pressure = memory.pressure.data();
  const float step = pass.step;
  const bool has_tension = settings.surface_tension > 0.0f;
  const LiquidCell* const cell = memory.cell.data();
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      pressure[i] = active[i] > 0.0f || (has_tension && cell[i] == LiquidCell::air) ? pressure[i] : 0.0f;
      vectors.x[i] = step * pressure[i];
    }
  });
  subtract_liquid_gradient(pass, vectors.x, 1.0f, memory.velocity);
  if (solids) push_bodies(vectors.x, memory.coupling);
  find_open_inflow(pass, vectors.r);
  if (solids) add_solid_inflow(pass, vectors.r);
  const float allowed = settings.projection.divergence / pass.step,
              reduced = settings.projection.reduction * before;
  const float target = allowed < reduced ? allowed : reduced;
  PressureReport report = solve_pressure(memory.matrix, vectors, target, settings.projection.max_iterations,
                                         pass.kernels, pass.tasks, solids ? &memory.coupling : nullptr);
  report.first = before;
  subtract_liquid_gradient(pass, vectors.x, 1.0f, memory.velocity);
  const float inverse_step = 1.0f / pass.step;
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) pressure[i] += inverse_step * vectors.x[i];
  });
  wrap_points(pass, pressure);
  if (solids) {
    push_bodies(vectors.x, memory.coupling);
    if (!impulses.empty()) add_body_impulses(velocity, memory.coupling, impulses);
  }
  set_closed_faces(pass, memory.velocity);
  return report;
}

PressureReport find_carrier(const LiquidPass& pass) {
  LiquidMemory& memory = pass.memory;
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const from = pass.memory.velocity[axis].data();
    float* const to = memory.drift[axis].data();
    each_row(pass, axis, [&](int c, int, int) {
      for (int f = c; f < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++f) to[f] = from[f];
    });
  }
  PressureVectors vectors = vectors_of(pass);
  const float* const active = memory.matrix.levels[0].inverse_diagonal.data();
  const LiquidCell* const cell = memory.cell.data();
  const float* const filled = memory.filled.data();
  const int py = shape.pitch, pz = shape.plane;
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      const bool deep = cell[i - 1] != LiquidCell::air && cell[i + 1] != LiquidCell::air &&
                        cell[i - py] != LiquidCell::air && cell[i + py] != LiquidCell::air &&
                        cell[i - pz] != LiquidCell::air && cell[i + pz] != LiquidCell::air;
      float excess = filled[i] - 1.0f;
      excess = excess < kMaxSpread ? excess : kMaxSpread;
      const bool counts =
          active[i] > 0.0f && (excess > kSpreadTolerance || (deep && excess < -kSpreadTolerance));
      vectors.r[i] = counts ? kSpreadShare * excess : 0.0f;
    }
  });
  const float largest = largest_cell(pass, vectors.r);
  if (!(largest > 0.0f)) return {};
  const PressureReport report =
      solve_pressure(memory.matrix, vectors, 0.1f * largest, 8, pass.kernels, pass.tasks, nullptr);
  subtract_liquid_gradient(pass, vectors.x, 1.0f / pass.step, memory.drift);
  set_closed_faces(pass, memory.drift);
  return report;
}

float largest_liquid_divergence(const LiquidPass& pass) {
  float* const scratch = pass.scratch(kRight);
  find_open_inflow(pass, scratch);
  if (pass.solids.present()) add_solid_inflow(pass, scratch);
  return largest_cell(pass, scratch);
}

}  // namespace gyre
