// A pinhole camera. See camera.h.
#include "render/camera.h"

#include "formats/turning.h"

namespace gyre {
namespace {

// Rows of a matrix to the columns that OpenGL takes.
Mat4 from_rows(const float (&rows)[4][4]) {
  Mat4 out;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) out.elements[4 * column + row] = rows[row][column];
  }
  return out;
}

}  // namespace

float Camera::focal_pixels() const { return 0.5f * float(height) / tangent(0.5f * field_of_view); }

CameraAxes axes_towards(Vec3 back) {
  back = normalized(back);
  // Straight up or down, the top of the picture is the north: -z.
  const Vec3 side = cross(Vec3{0, 1, 0}, back);
  const Vec3 right = dot(side, side) > 1e-10f ? normalized(side) : Vec3{1, 0, 0};
  return {right, cross(back, right), back};
}

CameraAxes axes_of(const Camera& camera) { return axes_towards(difference(camera.eye, camera.target)); }

PicturePoint project(const Camera& camera, DVec3 place) {
  const CameraAxes axes = axes_of(camera);
  const Vec3 offset = difference(place, camera.eye);
  const float depth = -dot(axes.back, offset);
  const float scale = camera.focal_pixels() / depth;
  return {0.5f * float(camera.width) + scale * dot(axes.right, offset),
          0.5f * float(camera.height) - scale * dot(axes.up, offset), depth};
}

Mat4 clip_matrix(const Camera& camera, DVec3 origin, ClipRange range, float shift_x, float shift_y) {
  const CameraAxes axes = axes_of(camera);
  const Vec3 eye = difference(camera.eye, origin);
  const float x_scale = 2.0f * camera.focal_pixels() / float(camera.width);
  const float y_scale = 2.0f * camera.focal_pixels() / float(camera.height);
  const float x_shift = 2.0f * shift_x / float(camera.width), y_shift = 2.0f * shift_y / float(camera.height);
  const float depth_scale = (range.far + range.near) / (range.far - range.near);
  const float depth_shift = -2.0f * range.far * range.near / (range.far - range.near);
  float rows[4][4];
  const auto set = [&](int row, Vec3 v, float last) {
    rows[row][0] = v.x;
    rows[row][1] = v.y;
    rows[row][2] = v.z;
    rows[row][3] = last - dot(v, eye);
  };
  const Vec3 forward = -axes.back;
  set(0, x_scale * axes.right + x_shift * forward, 0);
  set(1, y_scale * axes.up + y_shift * forward, 0);
  set(2, depth_scale * forward, depth_shift);
  set(3, forward, 0);
  return from_rows(rows);
}

Mat4 shadow_matrix(const CameraAxes& axes, const Aabb& bounds) {
  const Vec3 size = max(bounds.high - bounds.low, Vec3{1e-6f, 1e-6f, 1e-6f});
  const Vec3 middle = center(bounds);
  float rows[4][4] = {};
  const auto set = [&](int row, Vec3 v, float scale, float shift) {
    rows[row][0] = scale * v.x;
    rows[row][1] = scale * v.y;
    rows[row][2] = scale * v.z;
    rows[row][3] = -scale * shift;
  };
  set(0, axes.right, 2.0f / size.x, middle.x);
  set(1, axes.up, 2.0f / size.y, middle.y);
  set(2, axes.back, -2.0f / size.z, middle.z);
  rows[3][3] = 1;
  return from_rows(rows);
}

Aabb box_along(const CameraAxes& axes, const Aabb& box) {
  const Vec3 middle = center(box), half = half_size(box);
  const auto reach = [&](Vec3 axis) {
    return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
  };
  const Vec3 along{dot(axes.right, middle), dot(axes.up, middle), dot(axes.back, middle)};
  const Vec3 around{reach(axes.right), reach(axes.up), reach(axes.back)};
  return {along - around, along + around};
}

}  // namespace gyre
