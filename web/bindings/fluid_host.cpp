// Fluids in the browser: the calls that fill several arrays, whose answers are arrays here.
#include "web/bindings/hosts.h"

#include <emscripten.h>

#include <vector>

namespace gyre::web {
namespace {

// Answers that live until the next call.
struct FluidArrays {
  std::vector<DVec3> places;
  std::vector<Vec3> vectors;
  std::vector<std::uint32_t> indices;
};

}  // namespace
}  // namespace gyre::web

using namespace gyre;
using namespace gyre::web;

extern "C" {

// Arguments: the fluid and points. The answer: a velocity for each point.
EMSCRIPTEN_KEEPALIVE int gyre_sample_velocity(Host* host) {
  Call call(host);
  Answer answer(host, 0);
  FluidId fluid;
  std::span<const DVec3> points;
  get(call, fluid);
  get(call, points);
  FluidArrays& arrays = answer.kept<FluidArrays>();
  arrays.vectors.assign(points.size(), Vec3{});
  object<World>(host).sample_velocity(fluid, points, arrays.vectors);
  put_array(answer, std::span(arrays.vectors));
  return answer.done();
}

// Argument: the fluid. The answer: positions and velocities of its particles.
EMSCRIPTEN_KEEPALIVE int gyre_liquid_particles(Host* host) {
  Call call(host);
  Answer answer(host, 0);
  FluidId fluid;
  get(call, fluid);
  const World& world = object<World>(host);
  FluidArrays& arrays = answer.kept<FluidArrays>();
  const std::size_t count = world.liquid_particles(fluid, {}, {});
  arrays.places.resize(count);
  arrays.vectors.resize(count);
  world.liquid_particles(fluid, arrays.places, arrays.vectors);
  put_array(answer, std::span(arrays.places));
  put_array(answer, std::span(arrays.vectors));
  return answer.done();
}

// Argument: the fluid. The answer: vertices of its surface, and three indices for each triangle.
EMSCRIPTEN_KEEPALIVE int gyre_liquid_surface(Host* host) {
  Call call(host);
  Answer answer(host, 0);
  FluidId fluid;
  get(call, fluid);
  const World& world = object<World>(host);
  FluidArrays& arrays = answer.kept<FluidArrays>();
  // The surface is made at each call, so a second one is needed only where it has grown.
  FluidSurfaceSize size = world.liquid_surface(fluid, arrays.vectors, arrays.indices);
  if (size.vertices > arrays.vectors.size() || size.indices > arrays.indices.size()) {
    arrays.vectors.resize(size.vertices + size.vertices / 4);
    arrays.indices.resize(size.indices + size.indices / 4);
    size = world.liquid_surface(fluid, arrays.vectors, arrays.indices);
  }
  put_array(answer, std::span(arrays.vectors).first(size.vertices));
  put_array(answer, std::span(arrays.indices).first(size.indices));
  return answer.done();
}

}  // extern "C"
