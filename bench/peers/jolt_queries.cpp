#include "bench/peers/jolt_queries.h"

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/CollisionCollectorImpl.h>
#include <Jolt/Physics/Collision/RayCast.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/ShapeCast.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

namespace gyre::bench {
namespace {

struct Layers final : JPH::BroadPhaseLayerInterface {
  JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override { return JPH::BroadPhaseLayer(0); }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "all"; }
#endif
};

// Bodies, not their triangles.
struct BodyCounter final : JPH::CollideShapeCollector {
  std::size_t bodies = 0;
  JPH::BodyID last;
  void AddHit(const JPH::CollideShapeResult& hit) override {
    if (hit.mBodyID2 != last) ++bodies;
    last = hit.mBodyID2;
  }
};

JPH::Vec3 vector(const float* v) { return {v[0], v[1], v[2]}; }
JPH::RVec3 place(const double* p) { return JPH::RVec3(float(p[0]), float(p[1]), float(p[2])); }

}  // namespace

struct JoltQueries::World {
  Layers layers;
  JPH::ObjectVsBroadPhaseLayerFilter against_broad;
  JPH::ObjectLayerPairFilter pairs;
  JPH::PhysicsSystem system;
};

JoltQueries::JoltQueries(std::span<const float> vertices, std::span<const unsigned> indices,
                         std::span<const JoltBox> boxes) {
  JPH::RegisterDefaultAllocator();
  JPH::Factory::sInstance = new JPH::Factory();
  JPH::RegisterTypes();
  world_ = std::make_unique<World>();
  JPH::PhysicsSystem& system = world_->system;
  system.Init(JPH::uint(boxes.size() + 8), 0, 1024, 1024, world_->layers, world_->against_broad,
              world_->pairs);
  JPH::BodyInterface& bodies = system.GetBodyInterface();
  JPH::VertexList corners;
  for (std::size_t i = 0; i < vertices.size(); i += 3)
    corners.push_back(JPH::Float3(vertices[i], vertices[i + 1], vertices[i + 2]));
  JPH::IndexedTriangleList triangles;
  for (std::size_t i = 0; i < indices.size(); i += 3)
    triangles.push_back(JPH::IndexedTriangle(indices[i], indices[i + 1], indices[i + 2], 0));
  const JPH::MeshShapeSettings mesh(std::move(corners), std::move(triangles));
  const auto add = [&](const JPH::Shape* shape, JPH::RVec3 at, JPH::Quat turn) {
    bodies.CreateAndAddBody(JPH::BodyCreationSettings(shape, at, turn, JPH::EMotionType::Static, 0),
                            JPH::EActivation::DontActivate);
  };
  add(mesh.Create().Get(), JPH::RVec3::sZero(), JPH::Quat::sIdentity());
  const JPH::RefConst<JPH::Shape> cube = new JPH::BoxShape(JPH::Vec3::sReplicate(0.5f), 0.0f);
  for (const JoltBox& box : boxes) {
    add(cube, place(box.place), JPH::Quat(box.turn[0], box.turn[1], box.turn[2], box.turn[3]).Normalized());
  }
  system.OptimizeBroadPhase();
}

JoltQueries::~JoltQueries() {
  world_.reset();
  JPH::UnregisterTypes();
  delete JPH::Factory::sInstance;
  JPH::Factory::sInstance = nullptr;
}

bool JoltQueries::ray(const double* from, const float* way) const {
  JPH::RayCastResult hit;
  return world_->system.GetNarrowPhaseQuery().CastRay(JPH::RRayCast(place(from), vector(way)), hit);
}

bool JoltQueries::ball(const double* from, const float* way, float radius) const {
  JPH::SphereShape shape(radius);
  shape.SetEmbedded();
  const JPH::RShapeCast cast(&shape, JPH::Vec3::sOne(), JPH::RMat44::sTranslation(place(from)), vector(way));
  JPH::ClosestHitCollisionCollector<JPH::CastShapeCollector> hits;
  world_->system.GetNarrowPhaseQuery().CastShape(cast, {}, JPH::RVec3::sZero(), hits);
  return hits.HadHit();
}

std::size_t JoltQueries::overlaps(const double* at, float size, bool cube) const {
  JPH::SphereShape round(size);
  JPH::BoxShape square(JPH::Vec3::sReplicate(size), 0.0f);
  round.SetEmbedded(), square.SetEmbedded();
  const JPH::Shape* const shape = cube ? static_cast<const JPH::Shape*>(&square) : &round;
  BodyCounter counter;
  world_->system.GetNarrowPhaseQuery().CollideShape(
      shape, JPH::Vec3::sOne(), JPH::RMat44::sTranslation(place(at)), {}, JPH::RVec3::sZero(), counter);
  return counter.bodies;
}

}  // namespace gyre::bench
