// The transport of velocity, smoke and temperature.
#include "fluid/solver/transport.h"

namespace gyre {

namespace {

constexpr int kBack = 0, kAhead = 3, kMoved = 6, kLower = 7, kUpper = 8;  // scratch
constexpr int kCenters = 6;                                               // and before these three

// Limits of the sample points of cell centres; `outside`: the ghosts beyond open sides are of use.
template <class Pass>
void limit_samples(const GasBox& box, const GridShape& shape, bool outside, int faces, Pass& pass) {
  for (int axis = 0; axis < 3; ++axis) {
    const float n = float(shape.cells[axis]);
    if (box.periodic(axis) && !box.flat(axis)) {
      pass.low[axis] = 0.0f;
      pass.high[axis] = pass.period[axis] = n;
    } else if (axis == faces) {
      pass.low[axis] = 0.0f;
      pass.high[axis] = n;
    } else {
      pass.low[axis] = outside && box.open(2 * axis) ? -1.0f : 0.0f;
      pass.high[axis] = outside && box.open(2 * axis + 1) ? n : n - 1.0f;
    }
  }
}

// Calls fn(place, i, j) for each place of the layer at `index` along an axis, with the ghosts of the other axes.
template <class Fn>
void for_layer(const GridShape& shape, int axis, int index, Fn&& fn) {
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  const int first = shape.first + index * shape.stride(axis);
  for (int j = -1; j <= shape.cells[b]; ++j) {
    for (int i = -1; i <= shape.cells[a]; ++i) fn(first + i * shape.stride(a) + j * shape.stride(b), i, j);
  }
}

// The velocity across `faces` of air at rest in the world, for places of the layer at `index` along an axis.
float rest_velocity(const GasPass& pass, int faces, int axis, int index, int i, int j) {
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  int at[3];
  at[axis] = index, at[a] = i, at[b] = j;
  float place[3];
  for (int n = 0; n < 3; ++n) place[n] = (float(at[n]) + (n == faces ? 0.0f : 0.5f)) * pass.edge(n);
  const Vec3 rest = pass.motion.rest_at({place[0], place[1], place[2]});
  return faces == 0 ? rest.x : faces == 1 ? rest.y : rest.z;
}

// Air at rest beyond open sides: ghosts of the velocity across faces, but along their own axis, where there are none.
void still_ghosts(const GasPass& pass, int faces, float* field) {
  const GasBox& box = pass.box();
  const GridShape& shape = pass.shape();
  const bool moves = pass.motion.moves();
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    if (axis == faces || !box.open(side)) continue;
    const int index = side % 2 == 0 ? -1 : shape.cells[axis];
    for_layer(shape, axis, index, [&](int c, int i, int j) {
      field[c] = moves ? rest_velocity(pass, faces, axis, index, i, j) : 0.0f;
    });
  }
}

void transport(const GasPass& pass, Advection advection, int faces, const float* outside, float* field) {
  const GasBox& box = pass.box();
  const GridShape& shape = pass.shape();
  TransportPass work;
  work.shape = shape;
  for (int axis = 0; axis < 3; ++axis) {
    work.points[axis] = shape.cells[axis] + (axis == faces ? 1 : 0);
    if (pass.flat(axis)) continue;
    work.back[axis] = pass.scratch(kBack + axis);
    work.ahead[axis] = pass.scratch(kAhead + axis);
  }
  work.average = faces < 0 ? 0 : shape.stride(faces);
  work.field = field;
  work.moved = pass.scratch(kMoved);
  work.lower = pass.scratch(kLower);
  work.upper = pass.scratch(kUpper);
  limit_samples(box, shape, outside != nullptr, faces, work);
  const bool periodic[3] = {box.periodic(0), box.periodic(1), box.periodic(2)};
  const auto fill = [&](float* of) {
    if (faces < 0) return fill_ghosts(box, shape, of, outside);
    wrap_ghosts(shape, periodic, of);
    still_ghosts(pass, faces, of);
  };
  const auto run = [&](void (*kernel)(const TransportPass&, int, int)) {
    for_blocks(pass.tasks, work.points[1] * work.points[2], kGridRows,
               [&](int begin, int end, int) { kernel(work, begin, end); });
  };
  fill(field);
  run(pass.kernels.move);
  if (advection == Advection::semi_lagrangian) {
    each_row(pass, faces, [&](int c, int, int) {
      for (int i = c; i < c + work.points[0]; ++i) field[i] = work.moved[i];
    });
    return fill(field);
  }
  fill(work.moved);
  if (faces < 0) {
    run(pass.kernels.find_correction);
    fill_ghosts(box, shape, work.lower);
    run(pass.kernels.add_correction);
  } else {
    run(pass.kernels.correct);
    fill(field);
  }
}

}  // namespace

void trace_paths(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  TracePass work;
  work.shape = shape;
  limit_samples(pass.box(), shape, false, -1, work);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const from = pass.grid.velocity[axis].data();
    float* const to = pass.scratch(kCenters + axis);
    const int step = shape.stride(axis);
    const float scale = 0.5f * pass.step / pass.edge(axis);
    const FieldRows rows = rows_of(shape, -1);
    for_row_blocks(rows, pass.tasks, [&](int begin, int end) {
      pass.kernels.find_mean(rows, from, step, scale, to, begin, end);
    });
    fill_ghosts(pass.box(), shape, to);
    work.velocity[axis] = to;
    work.back[axis] = pass.scratch(kBack + axis);
    work.ahead[axis] = pass.scratch(kAhead + axis);
  }
  for_blocks(pass.tasks, shape.rows(), kGridRows,
             [&](int begin, int end, int) { pass.kernels.trace(work, begin, end); });
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    fill_ghosts(pass.box(), shape, work.back[axis]);
    fill_ghosts(pass.box(), shape, work.ahead[axis]);
  }
}

// Air that enters comes from rest: upwind and implicit, from a point at rest a cell outside. Air that came in with the velocity of the side
// would bring energy without bound.
void slow_inflow(const GasPass& pass, int axis) {
  const GridShape& shape = pass.shape();
  float* const velocity = pass.grid.velocity[axis].data();
  const float scale = pass.step / pass.edge(axis);
  for (int side = 0; side < 2; ++side) {
    if (!pass.box().open(2 * axis + side)) continue;
    const int index = side * shape.cells[axis];
    for_layer(shape, axis, index, [&](int c, int i, int j) {
      const float in = side == 0 ? velocity[c] : -velocity[c];
      if (!(in > 0.0f)) return;
      if (!pass.motion.moves()) {
        velocity[c] /= 1.0f + scale * in;
        return;
      }
      const float rest = rest_velocity(pass, axis, axis, index, i, j);
      velocity[c] = rest + (velocity[c] - rest) / (1.0f + scale * in);
    });
  }
}

void transport_fields(const GasPass& pass, Advection advection) {
  const float none = 0.0f, ambient = pass.grid.ambient_temperature;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    transport(pass, advection, axis, &none, pass.grid.velocity[axis].data());
    slow_inflow(pass, axis);
  }
  transport(pass, advection, -1, &none, pass.grid.density.data());
  transport(pass, advection, -1, &ambient, pass.grid.temperature.data());
  if (!pass.grid.fuel.empty()) transport(pass, advection, -1, &none, pass.grid.fuel.data());
}

float max_displacement(const GasPass& pass) {
  float longest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float fastest =
        largest_of(rows_of(pass.shape(), axis), pass.grid.velocity[axis].data(), pass.kernels, pass.tasks);
    const float displacement = fastest * pass.step / pass.edge(axis);
    longest = displacement > longest ? displacement : longest;
  }
  return longest;
}

}  // namespace gyre
