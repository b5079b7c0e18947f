// Prints the state's hash of every scene every 50 steps, and nothing else: whatever compiler, optimisation and processor
// this is built for, and whatever threads and SIMD width it is given, the output must be determinism/golden.txt.
// Usage: determinism [threads] [simd width]
#include "../determinism/scenes.h"

#include <cinttypes>
#include <cstdio>
#include <cstdlib>

namespace {

using namespace gyre;

bool print_scene(const scenes::Scene& scene, const WorldDef& def) {
  Result<World> made = World::create(def);
  if (!made) {
    std::printf("no world: %s\n", made.error().message);
    return false;
  }
  World world = *std::move(made);
  scene.build(world);
  for (int step = 0; step < scenes::kSteps; ++step) {
    scenes::step_scene(scene, world, step);
    if ((step + 1) % scenes::kHashEvery == 0)
      std::printf("%s %d %016" PRIx64 "\n", scene.name, step + 1, world.hash());
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  WorldDef def;
  def.threads = argc > 1 ? std::atoi(argv[1]) : 1;
  def.simd_width = argc > 2 ? std::atoi(argv[2]) : 0;
  for (const scenes::Scene& scene : scenes::kScenes) {
    if (!print_scene(scene, def)) return 1;
  }
  return 0;
}
