// A picture: rows from the top, red, green, blue, 8 bits each, sRGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;  // 3 a pixel

  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

// From sums of linear light (4 floats a pixel, the last unused; rows from the bottom) over `samples` samples.
Picture develop(std::span<const float> sums, int width, int height, int samples);

// The light of an sRGB value of 0 to 255, 0 to 1.
float linear_light(std::uint8_t value);

}  // namespace gyre
