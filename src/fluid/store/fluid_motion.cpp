#include "fluid/store/fluid_motion.h"

#include "fluid/gas/gas_window.h"

namespace gyre {

namespace {

float part_of(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// True if no cell beside a face, or beside these across the other axes, has liquid near: the fields there are those of air.
bool is_far_from_liquid(const LiquidGrid& liquid, int axis, int i, int j, int k) {
  int low[3] = {i - 1, j - 1, k - 1}, high[3] = {i + 1, j + 1, k + 1};
  high[axis] -= 1;
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        if (liquid.surface[liquid.shape.at(x, y, z)] < liquid.box.cell.x) return false;
  return true;
}

// Subtracts from a field of velocities on faces the velocity linear + angular x place. `liquid`: only near it, null: everywhere.
void subtract_motion(const GasBox& box, const GridShape& shape, Vec3 linear, Vec3 angular,
                     const LiquidGrid* liquid, Array<float> (&velocity)[3]) {
  const bool periodic[3] = {box.periodic(0), box.periodic(1), box.periodic(2)};
  for (int axis = 0; axis < 3; ++axis) {
    if (box.flat(axis)) continue;
    float* const faces = velocity[axis].data();
    const Vec3 half{axis == 0 ? 0.0f : 0.5f, axis == 1 ? 0.0f : 0.5f, axis == 2 ? 0.0f : 0.5f};
    for (int k = 0; k < shape.cells[2] + (axis == 2 ? 1 : 0); ++k) {
      for (int j = 0; j < shape.cells[1] + (axis == 1 ? 1 : 0); ++j) {
        for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
          if (liquid != nullptr && is_far_from_liquid(*liquid, axis, i, j, k)) continue;
          const Vec3 place{(float(i) + half.x) * box.cell.x, (float(j) + half.y) * box.cell.y,
                           (float(k) + half.z) * box.cell.z};
          faces[shape.at(i, j, k)] -= part_of(linear + cross(angular, place), axis);
        }
      }
    }
    wrap_ghosts(shape, periodic, faces);
  }
}

void subtract_motion(LiquidGrid& liquid, Vec3 linear, Vec3 angular) {
  const float turn[3][3] = {
      {0.0f, -angular.z, angular.y}, {angular.z, 0.0f, -angular.x}, {-angular.y, angular.x, 0.0f}};
  for (int p = 0; p < liquid.particles(); ++p) {
    const Vec3 place{liquid.position[0][p], liquid.position[1][p], liquid.position[2][p]};
    const Vec3 change = linear + cross(angular, place);
    for (int a = 0; a < 3; ++a) {
      if (liquid.box.flat(a)) continue;
      liquid.motion[a][p] -= part_of(change, a);
      for (int b = 0; b < 3; ++b)
        if (!liquid.box.flat(b)) liquid.affine[3 * a + b][p] -= turn[a][b];
    }
  }
}

}  // namespace

FluidFrame advanced(const FluidFrame& frame, float seconds) {
  FluidFrame out = frame;
  const double time = double(seconds);
  out.pose.position += time * DVec3(frame.velocity);
  if (frame.angular_velocity != Vec3{})
    out.pose.orientation = to_float(normalized(exponential_map(time * DVec3(frame.angular_velocity)) *
                                               to_double(frame.pose.orientation)));
  return out;
}

void advance_frame(FluidEntry& entry, float seconds) {
  if (entry.frame() != nullptr && entry.frame()->moves())
    entry.frames[0] = advanced(entry.frames[0], seconds);
}

void set_frame(FluidEntry& entry, const FluidFrame& frame) {
  // A fluid that has had a frame keeps one, so that snapshots hold it.
  if (entry.frames.empty() && frame.pose == Pose{} && !frame.moves()) return;
  entry.frames.clear();
  entry.frames.push_back(frame);
}

void change_frame_velocity(FluidEntry& entry, Vec3 linear, Vec3 angular) {
  if (linear == Vec3{} && angular == Vec3{}) return;
  FluidFrame frame = entry.frame() != nullptr ? *entry.frame() : FluidFrame{};
  frame.velocity += linear, frame.angular_velocity += angular;
  const Vec3 turn = vector_to_frame(&frame, angular);
  const Vec3 corner = to_float(entry.box().corner);
  const Vec3 shift = vector_to_frame(&frame, linear) + cross(turn, corner);
  if (entry.is_liquid()) {
    subtract_motion(entry.liquid, shift, turn);
    subtract_motion(entry.liquid.box, entry.liquid.shape, shift, turn, &entry.liquid, entry.liquid.velocity);
  } else {
    // All of the air moves relative to the box.
    if (entry.is_adaptive()) set_gas_window(entry.gas, whole_window(entry.gas.whole));
    subtract_motion(entry.gas.box, entry.gas.shape, shift, turn, nullptr, entry.gas.velocity);
  }
  set_frame(entry, frame);
}

FrameMotion frame_motion(const FluidEntry& entry) {
  const FluidFrame& frame = *entry.frame();
  const Vec3 corner = to_float(entry.box().corner);
  FrameMotion out;
  out.spin = vector_to_frame(&frame, frame.angular_velocity);
  out.velocity = vector_to_frame(&frame, frame.velocity) + cross(out.spin, corner);
  out.center = -corner;
  return out;
}

}  // namespace gyre
