// Soft matter in Jolt: jolt_soft SCENE FRAMES [ITERATIONS] [tethers] [rods] [STIFFNESS]
//
// ITERATIONS are its sub-steps, 5 if not given: its default. `tethers`: its long range attachments, along edges. `rods`: the rope is one of
// Cosserat rods instead of edges. STIFFNESS of the sheet that hangs, N/m: 1,000 if not given. One thread. Its damping is off.
//
// Jolt knows no Young's modulus. The beam has springs along the edges of its tetrahedra and a constraint on the volume of each; their
// compliances are those of the material, see `make_beam_settings`. A sheet of Jolt does not touch itself.
#include "bench/scenes/soft_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemSingleThreaded.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/Physics/SoftBody/SoftBodyCreationSettings.h>
#include <Jolt/Physics/SoftBody/SoftBodyMotionProperties.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>
#include <Jolt/RegisterTypes.h>

namespace {

using namespace gyre::bench::soft;
using Settings = JPH::SoftBodySharedSettings;

struct Layers final : JPH::BroadPhaseLayerInterface {
  JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override { return JPH::BroadPhaseLayer(0); }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
};

void add_vertices(Settings& settings, const std::vector<gyre::DVec3>& vertices,
                  const std::vector<float>& masses) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const gyre::DVec3& p = vertices[i];
    settings.mVertices.push_back(Settings::Vertex(JPH::Float3(float(p.x), float(p.y), float(p.z)),
                                                  JPH::Float3(0, 0, 0), 1.0f / masses[i]));
  }
}
void hold(Settings& settings, std::uint32_t vertex) { settings.mVertices[vertex].mInvMass = 0.0f; }

// Each vertex keeps its way along the edges of the sheet to the nearer held corner; its own maker of these wants to make all edges, too.
void add_tethers(Settings& settings, const Sheet& sheet) {
  const double diagonal = std::sqrt(2.0);
  for (std::uint32_t v = 0; v < sheet.vertices.size(); ++v) {
    const std::uint32_t i = v % Sheet::kSide, j = v / Sheet::kSide;
    const std::uint32_t from_end = std::min(i, Sheet::kSide - 1 - i),
                        held = Sheet::kHeld[2 * i < Sheet::kSide ? 0 : 1];
    if (v == held) continue;
    const std::uint32_t oblique = std::min(from_end, j), straight = std::max(from_end, j) - oblique;
    settings.mLRAConstraints.push_back(
        Settings::LRA(held, v, float(Sheet::kSpacing * (oblique * diagonal + straight))));
  }
}

JPH::Ref<Settings> make_sheet_settings(const std::string& scene, float stiffness, bool tethers) {
  const Sheet sheet = make_sheet(scene);
  JPH::Ref<Settings> settings = new Settings;
  add_vertices(*settings, sheet.vertices, sheet.masses);
  if (sheet.held) {
    for (const std::uint32_t v : Sheet::kHeld) hold(*settings, v);
    if (tethers) add_tethers(*settings, sheet);
  }
  for (const auto* pairs : {&sheet.edges, &sheet.diagonals}) {
    for (const Pair& pair : *pairs)
      settings->mEdgeConstraints.push_back(Settings::Edge(pair[0], pair[1], 1.0f / stiffness));
  }
  for (std::size_t i = 0; i < sheet.triangles.size(); i += 3)
    settings->AddFace(Settings::Face(sheet.triangles[i], sheet.triangles[i + 1], sheet.triangles[i + 2]));
  settings->CalculateEdgeLengths();
  return settings;
}

// Springs along edges, of stiffness 6 E V / l^2 with the share V of the volume that an edge of length l has: in all directions alike these are
// Cauchy's solid with Lame's constants of 0.4 E (Poisson's ratio 1/4). Constraints of volumes add what the material's first constant has more.
JPH::Ref<Settings> make_beam_settings() {
  const Beam beam = make_beam();
  JPH::Ref<Settings> settings = new Settings;
  add_vertices(*settings, beam.vertices, beam.masses);
  for (const std::uint32_t v : beam.clamped) hold(*settings, v);
  const double e = double(Beam::kYoungModulus), nu = double(Beam::kPoissonRatio);
  const double more = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) - 0.4 * e;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> shares;  // m^3
  for (const Tetrahedron& t : beam.tetrahedra) {
    const double volume = six_volumes(beam.vertices, t) / 6.0;
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < a; ++b) shares[std::minmax(t[a], t[b])] += volume / 6.0;
    }
    // Its constraint measures six volumes.
    settings->mVolumeConstraints.push_back(
        Settings::Volume(t[0], t[1], t[2], t[3], float(36.0 * volume / more)));
  }
  for (const auto& [edge, share] : shares) {
    const gyre::DVec3 along = beam.vertices[edge.second] - beam.vertices[edge.first];
    settings->mEdgeConstraints.push_back(
        Settings::Edge(edge.first, edge.second, float(dot(along, along) / (6.0 * e * share))));
  }
  settings->CalculateEdgeLengths();
  settings->CalculateVolumeConstraintVolumes();
  return settings;
}

JPH::Ref<Settings> make_rope_settings(bool rods, bool tethers) {
  const Rope rope = make_rope();
  const float segment = float(Rope::kLength / (Rope::kVertices - 1));
  JPH::Ref<Settings> settings = new Settings;
  add_vertices(*settings, rope.vertices, rope.masses);
  hold(*settings, 0);
  for (std::uint32_t i = 0; i + 1 < Rope::kVertices; ++i) {
    if (rods)
      settings->mRodStretchShearConstraints.push_back(Settings::RodStretchShear(i, i + 1));
    else
      settings->mEdgeConstraints.push_back(Settings::Edge(i, i + 1));
    // Its constraint measures half the angle between two rods.
    if (rods && i > 0)
      settings->mRodBendTwistConstraints.push_back(
          Settings::RodBendTwist(i - 1, i, segment / (4.0f * Rope::kBendStiffness)));
    if (tethers) settings->mLRAConstraints.push_back(Settings::LRA(0, i + 1, segment * float(i + 1)));
  }
  settings->CalculateEdgeLengths();
  if (rods) settings->CalculateRodProperties();
  return settings;
}

JPH::BodyID add_soft(JPH::BodyInterface& bodies, const JPH::Ref<Settings>& shared, int iterations) {
  shared->Optimize();
  JPH::SoftBodyCreationSettings settings(shared, JPH::RVec3::sZero(), JPH::Quat::sIdentity(), 0);
  settings.mNumIterations = JPH::uint32(iterations);
  settings.mLinearDamping = 0.0f;
  settings.mFriction = kFriction;
  settings.mVertexRadius = Sheet::kThickness / 2.0f;
  settings.mUpdatePosition = false;
  settings.mAllowSleeping = false;
  return bodies.CreateAndAddSoftBody(settings, JPH::EActivation::Activate);
}

void add_ball_and_floor(JPH::BodyInterface& bodies) {
  const auto add = [&](const JPH::Shape* shape, float height) {
    JPH::BodyCreationSettings settings(shape, JPH::RVec3(0, height, 0), JPH::Quat::sIdentity(),
                                       JPH::EMotionType::Static, 0);
    settings.mFriction = kFriction;
    bodies.CreateAndAddBody(settings, JPH::EActivation::DontActivate);
  };
  add(new JPH::BoxShape(JPH::Vec3(20, 1, 20)), -1.0f);
  add(new JPH::SphereShape(Sheet::kBallRadius), Sheet::kBallHeight);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  const std::string& scene = arguments.scene;
  const int iterations = arguments.number(0, 5), stiffness = arguments.number(1, 1000);
  const bool tethers = arguments.has("tethers"), rods = arguments.has("rods");
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
  system.SetGravity(JPH::Vec3(0, kGravity, 0));
  JPH::BodyInterface& bodies = system.GetBodyInterfaceNoLock();
  JPH::BodyID id;
  if (scene == "hanging" || scene == "folded")
    id = add_soft(bodies, make_sheet_settings(scene, float(stiffness), tethers), iterations);
  else if (scene == "beam")
    id = add_soft(bodies, make_beam_settings(), iterations);
  else if (scene == "rope")
    id = add_soft(bodies, make_rope_settings(rods, tethers), iterations);
  else
    return skip("jolt", scene);
  if (scene == "folded") add_ball_and_floor(bodies);
  std::string settings = count_of(iterations, "iteration");
  if (tethers) settings += ", tethers";
  if (rods) settings += ", rods";
  if (scene == "hanging") settings += ", " + std::to_string(stiffness) + " N/m";
  return judge(scene, arguments.frames,
               {.engine = "jolt",
                .settings = settings,
                .step = [&] { system.Update(kStep, 1, &temp, &jobs); },
                .read =
                    [&](std::vector<gyre::DVec3>& to) {
                      const JPH::Body& body = *system.GetBodyLockInterfaceNoLock().TryGetBody(id);
                      const JPH::RVec3 origin = body.GetCenterOfMassPosition();
                      to.clear();
                      for (const auto& v :
                           static_cast<const JPH::SoftBodyMotionProperties*>(body.GetMotionProperties())
                               ->GetVertices()) {
                        const JPH::RVec3 p = origin + v.mPosition;
                        to.push_back({double(p.GetX()), double(p.GetY()), double(p.GetZ())});
                      }
                    }});
}
