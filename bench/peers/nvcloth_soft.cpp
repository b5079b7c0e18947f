// Sheets in NvCloth: nvcloth_soft SCENE FRAMES [FREQUENCY] [tethers] [DISTANCE]
//
// FREQUENCY is that of its solver, 1/s: 300 if not given, its default. `tethers`: those of its cooker, along edges. DISTANCE, mm: vertices keep
// it from each other; without it the sheet does not touch itself. Constraints are those of its cooker for a mesh of quadrilaterals, all with
// stiffness 1, as in its samples. It knows no stiffness in N/m: constraints are rigid, and give as far as they have not converged.
#include "bench/scenes/soft_judge.h"

#include <cstdio>
#include <cstdlib>
#include <memory>

#include <NvCloth/Callbacks.h>
#include <NvCloth/Cloth.h>
#include <NvCloth/Fabric.h>
#include <NvCloth/Factory.h>
#include <NvCloth/Solver.h>
#include <NvClothExt/ClothFabricCooker.h>
#include <foundation/PxAllocatorCallback.h>
#include <foundation/PxErrorCallback.h>

namespace {

using namespace gyre::bench::soft;
using physx::PxVec3;
using physx::PxVec4;

struct Allocator final : physx::PxAllocatorCallback {
  void* allocate(std::size_t size, const char*, const char*, int) override {
    return std::aligned_alloc(16, (size + 15) / 16 * 16);
  }
  void deallocate(void* memory) override { std::free(memory); }
};
struct Errors final : physx::PxErrorCallback {
  void reportError(physx::PxErrorCode::Enum, const char* message, const char*, int) override {
    std::fprintf(stderr, "%s\n", message);
  }
};
struct Asserts final : nv::cloth::PxAssertHandler {
  void operator()(const char* expression, const char*, int, bool&) override {
    std::fprintf(stderr, "%s\n", expression);
  }
};

template <typename T>
nv::cloth::Range<T> range(std::vector<T>& v) {
  return {v.data(), v.data() + v.size()};
}
template <typename T>
nv::cloth::Range<const T> constant_range(const std::vector<T>& v) {
  return {v.data(), v.data() + v.size()};
}

nv::cloth::Fabric* cook(nv::cloth::Factory* factory, const Sheet& sheet,
                        const std::vector<PxVec4>& particles) {
  std::vector<std::uint32_t> quads;
  for (std::uint32_t at = 0; at + Sheet::kSide + 1 < particles.size(); ++at) {
    if ((at + 1) % Sheet::kSide == 0) continue;
    for (const std::uint32_t v : {at, at + 1, at + Sheet::kSide + 1, at + Sheet::kSide}) quads.push_back(v);
  }
  nv::cloth::ClothMeshDesc mesh;
  mesh.points.data = particles.data();
  mesh.points.count = std::uint32_t(particles.size());
  mesh.points.stride = sizeof(PxVec4);
  mesh.invMasses.data = &particles[0].w;
  mesh.invMasses.count = mesh.points.count;
  mesh.invMasses.stride = sizeof(PxVec4);
  mesh.quads.data = quads.data();
  mesh.quads.count = std::uint32_t(quads.size() / 4);
  mesh.quads.stride = 4 * sizeof(std::uint32_t);
  // A sheet that hangs has its rows across the pull of gravity.
  return NvClothCookFabricFromMesh(factory, mesh, sheet.held ? PxVec3(0, 0, 1) : PxVec3(0, -1, 0));
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  if (arguments.scene != "hanging" && arguments.scene != "folded") return skip("nvcloth", arguments.scene);
  const int frequency = arguments.number(0, 300);
  const bool tethers = arguments.has("tethers");
  const int distance = arguments.number(1, 0);
  const Sheet sheet = make_sheet(arguments.scene);

  Allocator allocator;
  Errors errors;
  Asserts asserts;
  nv::cloth::InitializeNvCloth(&allocator, &errors, &asserts, nullptr);
  nv::cloth::Factory* factory = NvClothCreateFactoryCPU();
  std::vector<PxVec4> particles;
  for (std::size_t i = 0; i < sheet.vertices.size(); ++i) {
    const gyre::DVec3& p = sheet.vertices[i];
    particles.push_back(PxVec4(float(p.x), float(p.y), float(p.z), 1.0f / sheet.masses[i]));
  }
  if (sheet.held) {
    for (const std::uint32_t v : Sheet::kHeld) particles[v].w = 0.0f;
  }
  nv::cloth::Fabric* fabric = cook(factory, sheet, particles);
  if (fabric == nullptr) return skip("nvcloth", "without a fabric");
  std::unique_ptr<nv::cloth::Cloth> cloth(factory->createCloth(range(particles), *fabric));
  cloth->setGravity(PxVec3(0, kGravity, 0));
  cloth->setSolverFrequency(float(frequency));
  cloth->setTetherConstraintStiffness(tethers ? 1.0f : 0.0f);
  std::vector<nv::cloth::PhaseConfig> phases;
  for (std::uint16_t i = 0; i < fabric->getNumPhases(); ++i) phases.push_back(nv::cloth::PhaseConfig(i));
  cloth->setPhaseConfig(constant_range(phases));
  if (arguments.scene == "folded") {
    const float gap = Sheet::kThickness / 2.0f;
    const PxVec4 ball(0, Sheet::kBallHeight, 0, Sheet::kBallRadius + gap), floor(0, 1, 0, -gap);
    const std::uint32_t planes = 1;  // a bit for each plane of the convex shape
    cloth->setSpheres({&ball, &ball + 1}, 0, 0);
    cloth->setPlanes({&floor, &floor + 1}, 0, 0);
    cloth->setConvexes({&planes, &planes + 1}, 0, 0);
    cloth->setFriction(kFriction);
    cloth->setSelfCollisionDistance(1e-3f * float(distance));
  }
  std::unique_ptr<nv::cloth::Solver> solver(factory->createSolver());
  solver->addCloth(cloth.get());
  std::string settings = std::to_string(frequency) + "/s";
  if (tethers) settings += ", tethers";
  if (distance > 0) settings += ", " + std::to_string(distance) + " mm apart";
  const int result = judge(arguments.scene, arguments.frames,
                           {.engine = "nvcloth",
                            .settings = settings,
                            .step =
                                [&] {
                                  if (!solver->beginSimulation(kStep)) return;
                                  for (int i = 0; i < solver->getSimulationChunkCount(); ++i)
                                    solver->simulateChunk(i);
                                  solver->endSimulation();
                                },
                            .read =
                                [&](std::vector<gyre::DVec3>& to) {
                                  const nv::cloth::MappedRange<const PxVec4> now =
                                      nv::cloth::readCurrentParticles(*cloth);
                                  to.clear();
                                  for (const PxVec4& p : now)
                                    to.push_back({double(p.x), double(p.y), double(p.z)});
                                }});
  solver->removeCloth(cloth.get());
  return result;
}
