#include "soft/body/enclosed_gas.h"

#include "math/trig.h"

namespace gyre {

namespace {

// A crushed balloon does not push harder than at this share of its volume at rest.
constexpr double kMinVolume = 0.01;

double held_volume(const EnclosedGas& gas, double volume) {
  return max(volume, kMinVolume * gas.rest_volume);
}

}  // namespace

double enclosed_volume(const Particles& particles, std::span<const std::uint32_t> triangles) {
  const DVec3 origin = particles.place(int(triangles[0]));
  double sum = 0.0;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const DVec3 a = particles.place(int(triangles[t])) - origin,
                b = particles.place(int(triangles[t + 1])) - origin,
                c = particles.place(int(triangles[t + 2])) - origin;
    sum += dot(a, cross(b, c));
  }
  return sum / 6.0;
}

double gauge_pressure(const EnclosedGas& gas, double volume) {
  if (gas.is_constant) return gas.pressure;
  return (gas.pressure + gas.ambient) * gas.rest_volume / held_volume(gas, volume) - gas.ambient;
}

double volume_stiffness(const EnclosedGas& gas, double volume) {
  if (gas.is_constant || volume < kMinVolume * gas.rest_volume) return 0.0;
  return (gas.pressure + gas.ambient) * gas.rest_volume / (volume * volume);
}

double gas_energy(const EnclosedGas& gas, double volume) {
  if (gas.is_constant) return -gas.pressure * (volume - gas.rest_volume);
  const double held = held_volume(gas, volume), content = (gas.pressure + gas.ambient) * gas.rest_volume;
  const double squeezed = volume < held ? (held - volume) * content / held : 0.0;
  return -content * log(held / gas.rest_volume) + squeezed + gas.ambient * (volume - gas.rest_volume);
}

void find_volume_gradient(const Particles& particles, const EnclosedGas& gas, std::span<Vec3> gradient) {
  for (Vec3& one : gradient) one = {};
  for (std::size_t t = 0; t + 2 < gas.triangles.size(); t += 3) {
    const std::uint32_t* const corner = gas.triangles.data() + t;
    const DVec3 a = particles.place(int(corner[0]));
    const Vec3 b = difference(particles.place(int(corner[1])), a),
               c = difference(particles.place(int(corner[2])), a);
    const Vec3 share = (1.0f / 6.0f) * cross(b, c);
    for (int k = 0; k < 3; ++k) gradient[corner[k]] += share;
  }
}

}  // namespace gyre
