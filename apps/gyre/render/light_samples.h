// Where the samples of a picture lie: within the pixel, on the sun's disc and in the sky. Evenly spread and without chance, so that
// a picture is the same each time.
#pragma once

#include <gyre/math.h>

namespace gyre {

struct LightSample {
  float pixel_x, pixel_y;  // pixels off the middle, right and up; denser near it, so that edges are smooth
  Vec3 sun,
      sky;  // unit vectors towards the light; the sky's are spread evenly over the upper half of all directions
  float chance;  // evenly spread from 0 to 1
};

// Sample `index` of `count`, for a sun whose middle stands in direction `sun`.
LightSample light_sample(int index, int count, Vec3 sun);

}  // namespace gyre
