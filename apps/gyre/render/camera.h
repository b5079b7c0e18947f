// A pinhole camera, and the matrices of it and of the lights' shadow maps. Everything is seen from an origin near the subject, so
// that places far from the world's origin keep their precision.
#pragma once

#include <gyre/math.h>

namespace gyre {

struct Camera {
  DVec3 eye{3, 2, 5};
  DVec3 target{};
  float field_of_view = 0.6f;  // rad, from bottom to top
  int width = 960, height = 600;

  // Pixels that a length of 1 m has at a distance of 1 m.
  float focal_pixels() const;
};

// The picture's axes in the world: right, up, and from the subject to the eye; right-handed.
struct CameraAxes {
  Vec3 right, up, back;
};
CameraAxes axes_of(const Camera& camera);
CameraAxes axes_towards(Vec3 back);

// Where a place appears: x from the left, y from the top, in pixels (pixel i covers i to i + 1); `depth` is the distance along
// the line of sight and not above 0 behind the eye.
struct PicturePoint {
  float x, y, depth;
};
PicturePoint project(const Camera& camera, DVec3 place);

// Clip space from places given relative to `origin`; the picture is moved by (shift_x, shift_y) pixels, right and up.
struct ClipRange {
  float near, far;
};
Mat4 clip_matrix(const Camera& camera, DVec3 origin, ClipRange range, float shift_x, float shift_y);

// A parallel projection along -axes.back of the box `bounds` given in these axes: x and y to -1..1, nearest z to -1.
Mat4 shadow_matrix(const CameraAxes& axes, const Aabb& bounds);

// The smallest box in these axes around a box given in world axes.
Aabb box_along(const CameraAxes& axes, const Aabb& box);

}  // namespace gyre
