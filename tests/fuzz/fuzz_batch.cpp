// Readings, actions and draws of batches from any bytes: refused in words or obeyed, and the same batch made twice has the same hashes.
#include "edits.h"
#include "small_scene.h"

#include <gyre/batch.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

using namespace gyre;

float any_float(fuzz::Input& input) {
  const std::uint32_t bits = input.word();
  if (bits % 4 != 0) return float(std::int32_t(bits) / 1'000'000) * 0.01f;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
Vec3 any_vector(fuzz::Input& input) {
  const float x = any_float(input), y = any_float(input);
  return {x, y, any_float(input)};
}

std::vector<std::uint64_t> play(const World& start, fuzz::Input input) {
  const std::span<const BodyId> ids = start.bodies().ids;
  std::vector<BodyId> bodies(ids.begin(), ids.end());
  bodies.push_back({});
  const auto any_body = [&] { return bodies[input.below(bodies.size())]; };
  std::vector<BatchReading> readings(input.below(4));
  for (BatchReading& reading : readings) {
    reading.kind = ReadingKind(input.byte() % (kReadingKindCount + 1));
    reading.components = std::uint8_t(input.byte() % 17);
    reading.body = any_body();
  }
  std::vector<BatchAction> actions(input.below(4));
  for (BatchAction& action : actions) {
    action.kind = ActionKind(input.byte() % (kActionKindCount + 1));
    action.components = std::uint8_t(input.byte() % 9);
    action.body = any_body();
    action.max_force = any_float(input);
  }
  std::vector<BatchDraw> draws(input.below(6));
  for (BatchDraw& draw : draws) {
    draw.kind = DrawKind(input.byte() % (kDrawKindCount + 1));
    draw.body = any_body();
    draw.low = any_vector(input);
    draw.high = any_vector(input);
  }
  Result<WorldBatch> made = WorldBatch::create(start, 3, 1);
  if (!made) std::abort();
  WorldBatch batch = *std::move(made);
  (void)batch.set_observations(readings);
  (void)batch.set_actions(actions);
  if (batch.set_draws(draws, input.word()).ok()) {
    for (std::size_t k = 0; k < draws.size(); ++k) {
      const Vec3 value = batch.drawn(1, k);
      if (!is_finite(value)) std::abort();
    }
  }
  std::vector<float> pushes(3 * batch.action_width()), rows(3 * batch.observation_width());
  for (float& push : pushes) push = any_float(input);
  (void)batch.step(1.0f / 60, 2, pushes, rows);
  const std::uint8_t which[] = {1, 0, std::uint8_t(input.byte() % 2)};
  (void)batch.reset(which);
  (void)batch.step(1.0f / 60, 1, {}, rows);
  std::vector<std::uint64_t> hashes(3);
  if (!batch.hashes(hashes).ok()) std::abort();
  return hashes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const World start = [] {
    World world = *World::create();
    fuzz::build_small_scene(world);
    return world;
  }();
  if (size > 600) return 0;
  const fuzz::Input input(data, size);
  if (play(start, input) != play(start, input)) std::abort();
  return 0;
}
