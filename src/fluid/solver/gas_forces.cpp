// Emitters, buoyancy and vorticity confinement.
#include "fluid/solver/gas_forces.h"

namespace gyre {

namespace {

float part_of(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

struct Ball {
  double center[3];
  double radius;
  int low[3], high[3];  // cells and faces that may lie in it
};

Ball ball_of(const GasPass& pass, const GasEmitter& emitter) {
  const DVec3 local = emitter.position - pass.box().corner;
  Ball ball{{local.x, local.y, local.z}, double(emitter.radius), {}, {}};
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = double(pass.edge(axis)), n = double(pass.shape().cells[axis]);
    const auto cell = [&](double at) {
      const double place = at / edge;
      return int(place < 0.0 ? 0.0 : place < n ? place : n);
    };
    ball.low[axis] = cell(ball.center[axis] - ball.radius - edge);
    ball.high[axis] = cell(ball.center[axis] + ball.radius + edge);
  }
  return ball;
}

// Calls fn(index) for the points in the ball: of centres, or of the faces across an axis. A flat axis has only its middle.
template <class Fn>
void for_ball(const GasPass& pass, const Ball& ball, int faces, Fn&& fn) {
  const GridShape& shape = pass.shape();
  const auto offset = [&](int axis, int i) {
    if (pass.flat(axis)) return 0.0;
    return (double(i) + (axis == faces ? 0.0 : 0.5)) * double(pass.edge(axis)) - ball.center[axis];
  };
  int nearest[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    last[axis] = shape.cells[axis] - (axis == faces ? 0 : 1);
    const double place = ball.center[axis] / double(pass.edge(axis)) + (axis == faces ? 0.5 : 0.0);
    nearest[axis] = place < 0.0 ? 0 : place > double(last[axis]) ? last[axis] : int(place);
  }
  for (int k = ball.low[2]; k <= ball.high[2] && k <= last[2]; ++k) {
    for (int j = ball.low[1]; j <= ball.high[1] && j <= last[1]; ++j) {
      for (int i = ball.low[0]; i <= ball.high[0] && i <= last[0]; ++i) {
        const double x = offset(0, i), y = offset(1, j), z = offset(2, k);
        const bool center = i == nearest[0] && j == nearest[1] && k == nearest[2];
        if (center || x * x + y * y + z * z <= ball.radius * ball.radius) fn(shape.at(i, j, k));
      }
    }
  }
}

}  // namespace

void apply_emitters(const GasPass& pass, std::span<const GasEmitter> emitters, std::span<const float> fuel,
                    double time) {
  for (std::size_t n = 0; n < emitters.size(); ++n) {
    const GasEmitter& emitter = emitters[n];
    if (!(time >= emitter.start && time < emitter.end)) continue;
    const Ball ball = ball_of(pass, emitter);
    const std::uint8_t* const solid = pass.solids.present() ? pass.solids.solid.data() : nullptr;
    for_ball(pass, ball, -1, [&](int c) {
      if (solid != nullptr && solid[c] != 0) return;
      pass.grid.density[c] = emitter.density;
      pass.grid.temperature[c] = emitter.temperature;
      if (n < fuel.size()) pass.grid.fuel[c] = fuel[n];
    });
    if (!emitter.has_velocity) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      const float* const face = pass.memory.matrix.levels[0].face[axis].data();
      for_ball(pass, ball, axis, [&](int c) {
        if (face[c] > 0.0f) pass.grid.velocity[axis][c] = part_of(emitter.velocity, axis);
      });
    }
  }
}

void add_buoyancy(const GasPass& pass, Vec3 gravity, float buoyancy) {
  const GridShape& shape = pass.shape();
  const float ambient = pass.grid.ambient_temperature, none = 0.0f;
  const float* const temperature = pass.grid.temperature.data();
  float* const warmth = pass.scratch(0);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) warmth[i] = temperature[i] - ambient;
  });
  fill_ghosts(pass.box(), shape, warmth, &none);
  for (int axis = 0; axis < 3; ++axis) {
    const float g = part_of(gravity, axis);
    if (pass.flat(axis) || g == 0.0f) continue;
    const float falling = pass.box().periodic(axis) ? pass.step * g : 0.0f;
    const float rising = -0.5f * pass.step * buoyancy * g / ambient;
    float* const velocity = pass.grid.velocity[axis].data();
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    const FieldRows rows = rows_of(shape, axis);
    for_row_blocks(rows, pass.tasks, [&](int begin, int end) {
      pass.kernels.add_mean(rows, face, warmth, shape.stride(axis), falling, rising, velocity, begin, end);
    });
  }
}

void turn_velocity(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    const float* const from = pass.grid.velocity[axis].data();
    float* const to = pass.scratch(axis);
    each_row(pass, axis, [&](int c, int, int) {
      for (int i = c; i < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++i) to[i] = from[i];
    });
  }
  const Quat back = from_rotation_vector(-2.0f * pass.step * pass.motion.spin);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    float* const velocity = pass.grid.velocity[axis].data();
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    const int stride = shape.stride(axis), last = shape.cells[axis];
    each_row(pass, axis, [&](int c, int j, int k) {
      for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
        if (!(face[c + i] > 0.0f)) continue;
        const int index[3] = {i, j, k};
        float parts[3];
        for (int other = 0; other < 3; ++other) {
          const float* const from = pass.scratch(other) + c + i;
          if (other == axis) {
            parts[other] = from[0];
            continue;
          }
          // The mean of the four faces around, or of two at a side of the box.
          const int step = shape.stride(other);
          const float here = from[0] + from[step], beside = from[-stride] + from[step - stride];
          parts[other] = index[axis] == 0      ? 0.5f * here
                         : index[axis] == last ? 0.5f * beside
                                               : 0.25f * (here + beside);
        }
        velocity[c + i] = part_of(rotate(back, Vec3{parts[0], parts[1], parts[2]}), axis);
      }
    });
  }
}

void add_outward(const GasPass& pass) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    float* const velocity = pass.grid.velocity[axis].data();
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    const auto along = [&](int index, int of) {
      return (float(index) + (of == axis ? 0.0f : 0.5f)) * pass.edge(of);
    };
    each_row(pass, axis, [&](int c, int j, int k) {
      for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
        if (!(face[c + i] > 0.0f)) continue;
        const Vec3 outward = pass.motion.outward({along(i, 0), along(j, 1), along(k, 2)});
        velocity[c + i] += pass.step * part_of(outward, axis);
      }
    });
  }
}

void add_confinement(const GasPass& pass, float strength) {
  const GridShape& shape = pass.shape();
  const FieldRows cells = rows_of(shape, -1);
  VortexPass work;
  work.shape = shape;
  work.size = pass.scratch(6);
  work.strength = strength * pass.edge(0);
  for (int axis = 0; axis < 3; ++axis) {
    work.center[axis] = pass.scratch(axis);
    work.vorticity[axis] = pass.scratch(3 + axis);
    work.half_inverse[axis] = pass.flat(axis) ? 0.0f : 0.5f / pass.edge(axis);
    const float* const from = pass.grid.velocity[axis].data();
    for_row_blocks(cells, pass.tasks, [&](int begin, int end) {
      pass.kernels.find_mean(cells, from, shape.stride(axis), 0.5f, work.center[axis], begin, end);
    });
    fill_ghosts(pass.box(), shape, work.center[axis]);
  }
  for_row_blocks(cells, pass.tasks,
                 [&](int begin, int end) { pass.kernels.find_vorticity(work, begin, end); });
  fill_ghosts(pass.box(), shape, work.size);
  for_row_blocks(cells, pass.tasks,
                 [&](int begin, int end) { pass.kernels.find_confinement(work, begin, end); });
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    fill_ghosts(pass.box(), shape, work.center[axis]);
    float* const velocity = pass.grid.velocity[axis].data();
    const float* const face = pass.memory.matrix.levels[0].face[axis].data();
    const FieldRows rows = rows_of(shape, axis);
    for_row_blocks(rows, pass.tasks, [&](int begin, int end) {
      pass.kernels.add_mean(rows, face, work.center[axis], shape.stride(axis), 0.0f, 0.5f * pass.step,
                            velocity, begin, end);
    });
  }
}

}  // namespace gyre
