// The stress or strain of ropes, cloths and solids as colours: what is read, the range of a movie, and its key.
#pragma once

#include "render/picture.h"
#include "scene/scene_color.h"

#include <gyre/world.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gyre {

enum class SoftReading { none, stress, strain };

// By vertex, the mean of the elements around it: Pa, of solids alone, or a share. None where there is nothing to be read.
std::vector<float> read_by_vertex(const World& world, SoftId soft, SoftReading reading);

// The numbers at both ends of the key.
struct ReadingRange {
  double low = 0.0, high = 0.0;
};

// Finds a range for all frames: what is read there, zero included, but for the outermost hundredth on either side, so that one element does not make all others look alike.
class RangeFinder {
 public:
  void add(std::vector<float> readings);
  // An end that is below a thousandth of the other is rounding, and zero.
  ReadingRange range() const;

 private:
  ReadingRange range_;
};

// From blue at the low end to red at the high one.
SceneColor reading_color(float value, const ReadingRange& range);

// Draws the key at the right side of a picture: the colours, and what stands for both ends with its unit.
void draw_key(const ReadingRange& range, SoftReading reading, Picture& picture);
// The words at an end: "1.2 MPa", "-3.5 %".
std::string key_label(double value, SoftReading reading);

}  // namespace gyre
