// Where the samples of a picture lie. See light_samples.h.
//
// Steps of irrational length fill an interval evenly: by the golden ratio in one dimension, by the plastic number's powers in two.
#include "render/light_samples.h"

#include "render/turning.h"

#include <cmath>
#include <numeric>

namespace gyre {
namespace {

constexpr double kGoldenStep = 0.61803398874989485;
constexpr double kPlasticStep = 0.75487766624669276, kPlasticStep2 = 0.56984029099805327;
constexpr float kSunSize = 0.05f;  // rad, radius of the disc
constexpr float kPixelReach = 0.8f;

double fraction(double x) { return x - std::floor(x); }

// From evenly spread over 0..1 to a triangle over -1..1.
float triangle(double u) {
  return float(u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * u));
}

// A step that visits all of 0..count-1, close to the golden share of it.
int golden_stride(int count) {
  int stride = max(1, int(kGoldenStep * count));
  while (std::gcd(stride, count) != 1) ++stride;
  return stride;
}

}  // namespace

LightSample light_sample(int index, int count, Vec3 sun) {
  LightSample out;
  out.pixel_x = kPixelReach * triangle(fraction(0.5 + index * kPlasticStep));
  out.pixel_y = kPixelReach * triangle(fraction(0.5 + index * kPlasticStep2));
  out.chance = float(fraction((index + 0.5) * kGoldenStep));

  const int stratum = int(std::int64_t(index) * golden_stride(count) % count);
  const float disc = count == 1 ? 0.0f : kSunSize * std::sqrt((float(stratum) + 0.5f) / float(count));
  const Turn sun_turn = turn_of(2.0f * kHalfTurn * float(fraction(stratum * kGoldenStep)));
  const Vec3 side = any_perpendicular(sun), other = cross(sun, side);
  out.sun = normalized(sun + disc * sun_turn.cosine * side + disc * sun_turn.sine * other);

  const float rise = (float(index) + 0.5f) / float(count);
  const float flat = std::sqrt(1.0f - rise * rise);
  const Turn sky_turn = turn_of(2.0f * kHalfTurn * float(fraction(index * kGoldenStep)));
  out.sky = {flat * sky_turn.cosine, rise, flat * sky_turn.sine};
  return out;
}

}  // namespace gyre
