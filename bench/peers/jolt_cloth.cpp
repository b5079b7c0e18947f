// The cloth of bench/matter.cpp in Jolt: 100 x 100 vertices, 2 m x 2 m, 0.8 kg, structural and shear springs of 1,000 N/m, hung from two corners.
//
//   jolt_cloth [ITERATIONS] [COLLISION_STEPS] [FRAMES]     5, 1 and 120 if not given: its defaults
//
// One thread, steps of 1/60 s. Prints time a step and the mean strain of the structural springs at the end.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyCreationSettings.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>
#include <Jolt/RegisterTypes.h>

namespace {

constexpr unsigned kSide = 100;
constexpr float kStiffness = 1000.0f;  // N/m

struct Layers final : JPH::BroadPhaseLayerInterface {
  JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override { return JPH::BroadPhaseLayer(0); }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
};

JPH::Ref<JPH::SoftBodySharedSettings> make_sheet() {
  JPH::Ref<JPH::SoftBodySharedSettings> sheet = new JPH::SoftBodySharedSettings;
  const float spacing = 2.0f / float(kSide - 1), inverse_mass = float(kSide * kSide) / 0.8f;
  for (unsigned j = 0; j < kSide; ++j) {
    for (unsigned i = 0; i < kSide; ++i) {
      const bool held = j == 0 && (i == 0 || i == kSide - 1);
      sheet->mVertices.push_back(JPH::SoftBodySharedSettings::Vertex(
          JPH::Float3(float(i) * spacing - 1.0f, 0, float(j) * spacing - 1.0f), JPH::Float3(0, 0, 0),
          held ? 0.0f : inverse_mass));
    }
  }
  const auto link = [&](unsigned a, unsigned b) {
    sheet->mEdgeConstraints.push_back(JPH::SoftBodySharedSettings::Edge(a, b, 1.0f / kStiffness));
  };
  for (unsigned j = 0; j < kSide; ++j) {
    for (unsigned i = 0; i < kSide; ++i) {
      const unsigned at = i + j * kSide;
      if (i + 1 < kSide) link(at, at + 1);
      if (j + 1 < kSide) link(at, at + kSide);
      if (i + 1 < kSide && j + 1 < kSide) link(at, at + kSide + 1), link(at + 1, at + kSide);
      if (i + 1 < kSide && j + 1 < kSide) {
        sheet->AddFace(JPH::SoftBodySharedSettings::Face(at, at + kSide, at + 1));
        sheet->AddFace(JPH::SoftBodySharedSettings::Face(at + 1, at + kSide, at + kSide + 1));
      }
    }
  }
  sheet->CalculateEdgeLengths();
  sheet->Optimize();
  return sheet;
}

}  // namespace

int main(int argc, char** argv) {
  const int iterations = argc > 1 ? std::atoi(argv[1]) : 5, steps = argc > 2 ? std::atoi(argv[2]) : 1,
            frames = argc > 3 ? std::atoi(argv[3]) : 120;
  JPH::RegisterDefaultAllocator();
  JPH::Factory::sInstance = new JPH::Factory();
  JPH::RegisterTypes();
  JPH::TempAllocatorImpl temp(64 * 1024 * 1024);
  JPH::JobSystemSingleThreaded jobs(JPH::cMaxPhysicsJobs);
  Layers layers;
  JPH::ObjectVsBroadPhaseLayerFilter broad;
  JPH::ObjectLayerPairFilter pairs;
  JPH::PhysicsSystem system;
  system.Init(16, 0, 1024, 1024, layers, broad, pairs);
  system.SetGravity(JPH::Vec3(0, -9.81f, 0));
  JPH::SoftBodyCreationSettings settings(make_sheet(), JPH::RVec3(0, 3, 0), JPH::Quat::sIdentity(), 0);
  settings.mNumIterations = JPH::uint32(iterations);
  settings.mLinearDamping = 0.0f;
  settings.mUpdatePosition = false;
  settings.mAllowSleeping = false;
  JPH::BodyInterface& bodies = system.GetBodyInterfaceNoLock();
  const JPH::BodyID id = bodies.CreateAndAddSoftBody(settings, JPH::EActivation::Activate);
  std::vector<double> ms;
  for (int i = 0; i < frames; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    system.Update(1.0f / 60.0f, steps, &temp, &jobs);
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(ms.begin(), ms.end());
  const JPH::Body& body = *system.GetBodyLockInterfaceNoLock().TryGetBody(id);
  const auto& vertices =
      static_cast<const JPH::SoftBodyMotionProperties*>(body.GetMotionProperties())->GetVertices();
  double sum = 0.0;
  int count = 0;
  const double rest = 2.0 / double(kSide - 1);
  const auto strain = [&](unsigned a, unsigned b) {
    sum += std::fabs(double((vertices[a].mPosition - vertices[b].mPosition).Length()) / rest - 1.0), ++count;
  };
  for (unsigned j = 0; j < kSide; ++j) {
    for (unsigned i = 0; i < kSide; ++i) {
      if (i + 1 < kSide) strain(i + j * kSide, i + 1 + j * kSide);
      if (j + 1 < kSide) strain(i + j * kSide, i + (j + 1) * kSide);
    }
  }
  std::printf(
      "jolt: %d iterations, %d steps: %.2f ms a step (half quartile distance %.2f), mean strain %.3g %%\n",
      iterations, steps, ms[ms.size() / 2], 0.5 * (ms[ms.size() * 3 / 4] - ms[ms.size() / 4]),
      100.0 * sum / count);
  return 0;
}
