// Where the samples of a picture lie. See light_samples.h.
//
// Every quantity visits the middles of as many equal parts of its range as there are samples, each once, and each in an order of
// its own: with strides near irrational shares of the count, so that no two go together.
#include "render/light_samples.h"

#include "formats/turning.h"

#include <cmath>
#include <cstdint>
#include <numeric>

namespace gyre {
namespace {

constexpr double kGoldenStep = 0.61803398874989485;
constexpr double kPlasticStep = 0.75487766624669276, kPlasticStep2 = 0.32471795724474602;
constexpr float kSunSize = 0.05f;  // rad, radius of the disc
constexpr float kPixelReach = 0.8f;

double fraction(double x) { return x - std::floor(x); }

// From evenly spread over 0..1 to a triangle over -1..1.
float triangle(double u) {
  return float(u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * u));
}

// The part that sample `index` gets, 0 to count - 1, when walking in steps of about `share` of them.
int part_of(int index, int count, double share) {
  int stride = max(1, int(share * count));
  while (std::gcd(stride, count) != 1) ++stride;
  return int(std::int64_t(index) * stride % count);
}

}  // namespace

LightSample light_sample(int index, int count, Vec3 sun) {
  LightSample out;
  const auto middle = [&](int part) { return (double(part) + 0.5) / double(count); };
  out.pixel_x = kPixelReach * triangle(middle(part_of(index, count, kPlasticStep)));
  out.pixel_y = kPixelReach * triangle(middle(part_of(index, count, kPlasticStep2)));
  out.chance = float(fraction((index + 0.5) * kGoldenStep));

  const int stratum = part_of(index, count, kGoldenStep);
  const float disc = count == 1 ? 0.0f : kSunSize * std::sqrt(float(middle(stratum)));
  const Turn sun_turn = turn_of(2.0f * kHalfTurn * float(fraction(stratum * kGoldenStep)));
  const Vec3 side = any_perpendicular(sun), other = cross(sun, side);
  out.sun = normalized(sun + disc * sun_turn.cosine * side + disc * sun_turn.sine * other);

  const auto rise = float(middle(index));
  const float flat = std::sqrt(1.0f - rise * rise);
  const Turn sky_turn = turn_of(2.0f * kHalfTurn * float(fraction(index * kGoldenStep)));
  out.sky = {flat * sky_turn.cosine, rise, flat * sky_turn.sine};
  return out;
}

}  // namespace gyre
