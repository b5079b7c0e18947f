// From light to a picture. See picture.h. The curve is that of IEC 61966-2-1 (sRGB).
#include "render/picture.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

// What is brighter than this is taken back softly instead of being cut off at white.
constexpr float kShoulder = 0.8f;

float with_shoulder(float light) {
  if (light <= kShoulder) return light;
  const float over = (light - kShoulder) / (1.0f - kShoulder);
  return kShoulder + (1.0f - kShoulder) * over / (1.0f + over);
}

// From light in steps of 1/4095 to sRGB. The middle of a step is off by less than half an 8-bit value except for the very darkest.
const std::vector<std::uint8_t>& curve() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> out(4096);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double light = double(i) / 4095.0;
      const double value = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
      out[i] = std::uint8_t(255.0 * value + 0.5);
    }
    return out;
  }();
  return table;
}

}  // namespace

float linear_light(std::uint8_t value) {
  const double c = double(value) / 255.0;
  return float(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

Picture develop(std::span<const float> sums, int width, int height, int samples) {
  Picture picture{width, height, {}};
  picture.bytes.resize(3 * picture.pixels());
  const std::vector<std::uint8_t>& table = curve();
  const float share = 1.0f / float(samples);
  for (int row = 0; row < height; ++row) {
    const float* from = &sums[4 * std::size_t(height - 1 - row) * std::size_t(width)];
    std::uint8_t* to = &picture.bytes[3 * std::size_t(row) * std::size_t(width)];
    for (int column = 0; column < width; ++column, from += 4, to += 3) {
      for (int k = 0; k < 3; ++k) {
        const float light = std::clamp(with_shoulder(share * from[k]), 0.0f, 1.0f);
        to[k] = table[std::size_t(light * 4095.0f + 0.5f)];
      }
    }
  }
  return picture;
}

}  // namespace gyre
