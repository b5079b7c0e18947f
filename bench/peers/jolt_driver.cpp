// Jolt in our scenes. Settings: its defaults (one collision step, 10 velocity and 2 position iterations,
// discrete motion quality, convex radius 5 cm inside the shape, deterministic), damping set to zero.
#include "bench/scenes/engine.h"

#include <algorithm>
#include <set>

#include <Jolt/Jolt.h>

#include <Jolt/Core/Factory.h>
#include <Jolt/Core/JobSystemThreadPool.h>
#include <Jolt/Core/TempAllocator.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/GroupFilterTable.h>
#include <Jolt/Physics/Collision/RayCast.h>
#include <Jolt/Physics/Collision/Shape/BoxShape.h>
#include <Jolt/Physics/Collision/Shape/CapsuleShape.h>
#include <Jolt/Physics/Collision/Shape/ConvexHullShape.h>
#include <Jolt/Physics/Collision/Shape/MeshShape.h>
#include <Jolt/Physics/Collision/Shape/SphereShape.h>
#include <Jolt/Physics/Collision/Shape/StaticCompoundShape.h>
#include <Jolt/Physics/Constraints/HingeConstraint.h>
#include <Jolt/Physics/Constraints/PointConstraint.h>
#include <Jolt/Physics/Constraints/SwingTwistConstraint.h>
#include <Jolt/Physics/PhysicsSettings.h>
#include <Jolt/Physics/PhysicsSystem.h>
#include <Jolt/RegisterTypes.h>

#ifndef COLLISION_STEPS
#define COLLISION_STEPS 1  // the library's default; more of them trade time for quality
#endif

namespace {

gyre::bench::V3 out(JPH::Vec3 v) { return {v.GetX(), v.GetY(), v.GetZ()}; }
JPH::Vec3 in(gyre::bench::V3 v) { return JPH::Vec3(float(v.x), float(v.y), float(v.z)); }
JPH::Quat in(gyre::bench::Quat q) {
  return JPH::Quat(float(q.x), float(q.y), float(q.z), float(q.w)).Normalized();
}

enum : JPH::ObjectLayer { kStatic, kMoving, kNoSelf };

struct Layers final : JPH::BroadPhaseLayerInterface {
  JPH::uint GetNumBroadPhaseLayers() const override { return 2; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer l) const override {
    return JPH::BroadPhaseLayer(l == kStatic ? 0 : 1);
  }
#if defined(JPH_EXTERNAL_PROFILE) || defined(JPH_PROFILE_ENABLED)
  const char* GetBroadPhaseLayerName(JPH::BroadPhaseLayer) const override { return "layer"; }
#endif
};
struct AgainstBroad final : JPH::ObjectVsBroadPhaseLayerFilter {
  bool ShouldCollide(JPH::ObjectLayer a, JPH::BroadPhaseLayer b) const override {
    return a != kStatic || b == JPH::BroadPhaseLayer(1);
  }
};
struct Pairs final : JPH::ObjectLayerPairFilter {
  bool ShouldCollide(JPH::ObjectLayer a, JPH::ObjectLayer b) const override {
    return !(a == kStatic && b == kStatic) && !(a == kNoSelf && b == kNoSelf);
  }
};

struct Jolt final : gyre::bench::Engine {
  Layers layers;
  AgainstBroad against_broad;
  Pairs pairs;
  JPH::TempAllocatorImpl* temp = nullptr;
  JPH::JobSystemThreadPool* jobs = nullptr;
  JPH::PhysicsSystem sys;
  std::vector<JPH::BodyID> id;

  const char* name() const override { return COLLISION_STEPS == 1 ? "jolt" : "jolt-other"; }
  std::string settings() const override {
    return std::to_string(COLLISION_STEPS) +
           " collision step(s), 10 velocity + 2 position iterations, defaults";
  }

  JPH::RefConst<JPH::Shape> simple(const gyre::bench::Scene& sc, const gyre::bench::Shape& s) {
    using gyre::bench::Kind;
    switch (s.kind) {
      case Kind::sphere:
        return new JPH::SphereShape(float(s.radius));
      case Kind::capsule:
        return new JPH::CapsuleShape(float(s.half_length), float(s.radius));
      case Kind::box: {
        // The default convex radius, but never more than the thinnest half extent allows.
        double thin = std::min({s.half.x, s.half.y, s.half.z});
        return new JPH::BoxShape(in(s.half), float(std::min(0.05, 0.5 * thin)));
      }
      case Kind::hull: {
        JPH::Array<JPH::Vec3> p;
        for (auto& v : sc.hulls[s.data].v) p.push_back(in(v));
        return JPH::ConvexHullShapeSettings(p).Create().Get();
      }
      case Kind::mesh: {
        const auto& m = sc.meshes[s.data];
        JPH::VertexList v;
        JPH::IndexedTriangleList t;
        for (auto& p : m.v) v.push_back(JPH::Float3(float(p.x), float(p.y), float(p.z)));
        for (size_t i = 0; i < m.tri.size(); i += 3)
          t.push_back(JPH::IndexedTriangle(JPH::uint32(m.tri[i]), JPH::uint32(m.tri[i + 1]),
                                           JPH::uint32(m.tri[i + 2])));
        return JPH::MeshShapeSettings(v, t).Create().Get();
      }
    }
    return nullptr;
  }

  bool create(const gyre::bench::Scene& sc, int threads, bool sleep, std::string&) override {
    using namespace gyre::bench;
    temp = new JPH::TempAllocatorImpl(256 * 1024 * 1024);
    jobs = new JPH::JobSystemThreadPool(JPH::cMaxPhysicsJobs, JPH::cMaxPhysicsBarriers, threads - 1);
    JPH::uint n = JPH::uint(sc.bodies.size());
    sys.Init(n + 16, 0, 32 * n + 4096, 16 * n + 4096, layers, against_broad, pairs);
    sys.SetGravity(JPH::Vec3(0, float(sc.gravity), 0));
    JPH::PhysicsSettings ps;
    ps.mAllowSleeping = sleep;
    sys.SetPhysicsSettings(ps);
    JPH::BodyInterface& bi = sys.GetBodyInterfaceNoLock();

    // Bodies joined to one another do not collide: one table per connected group.
    std::vector<int> root(n), sub(n, 0), size(n, 0);
    for (JPH::uint i = 0; i < n; ++i) root[i] = int(i);
    auto find = [&](int i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (auto& j : sc.joints) root[find(j.a)] = find(j.b);
    for (JPH::uint i = 0; i < n; ++i) sub[i] = size[find(int(i))]++;
    std::vector<JPH::Ref<JPH::GroupFilterTable>> table(n);
    for (auto& j : sc.joints) {
      if (sc.bodies[j.a].layer == Layer::no_self || sc.bodies[j.b].layer == Layer::no_self) continue;
      int r = find(j.a);
      if (!table[r]) table[r] = new JPH::GroupFilterTable(JPH::uint(size[r]));
      table[r]->DisableCollision(JPH::uint(sub[j.a]), JPH::uint(sub[j.b]));
    }

    std::vector<JPH::RefConst<JPH::Shape>> hull_cache(sc.hulls.size());
    for (JPH::uint i = 0; i < n; ++i) {
      const Body& b = sc.bodies[i];
      JPH::RefConst<JPH::Shape> shape;
      if (b.shapes.size() == 1) {
        const Shape& s = b.shapes[0];
        if (s.kind == Kind::hull) {
          if (!hull_cache[s.data]) hull_cache[s.data] = simple(sc, s);
          shape = hull_cache[s.data];
        } else
          shape = simple(sc, s);
      } else {
        JPH::StaticCompoundShapeSettings c;
        for (auto& s : b.shapes) c.AddShape(in(s.local.p), in(s.local.q), simple(sc, s));
        shape = c.Create().Get();
      }
      JPH::EMotionType mt = b.motion == Motion::fixed       ? JPH::EMotionType::Static
                            : b.motion == Motion::kinematic ? JPH::EMotionType::Kinematic
                                                            : JPH::EMotionType::Dynamic;
      JPH::BodyCreationSettings bs(shape, JPH::RVec3(in(b.pos)), in(b.q), mt,
                                   b.layer == Layer::fixed    ? kStatic
                                   : b.layer == Layer::normal ? kMoving
                                                              : kNoSelf);
      bs.mFriction = float(sc.friction);
      bs.mRestitution = float(sc.restitution);
      bs.mLinearDamping = bs.mAngularDamping = 0;
      bs.mLinearVelocity = in(b.vel);
      bs.mAngularVelocity = in(b.ang);
      bs.mAllowSleeping = sleep;
      if (b.motion == Motion::dynamic) {
        bs.mOverrideMassProperties = JPH::EOverrideMassProperties::CalculateInertia;
        bs.mMassPropertiesOverride.mMass = float(mass(sc, b));
      }
      if (table[find(int(i))])
        bs.mCollisionGroup =
            JPH::CollisionGroup(table[find(int(i))], JPH::uint32(find(int(i))), JPH::uint32(sub[i]));
      id.push_back(bi.CreateBody(bs)->GetID());
    }
    // One batch for everything, as the library advises.
    std::vector<JPH::BodyID> batch = id;
    auto state = bi.AddBodiesPrepare(batch.data(), int(batch.size()));
    bi.AddBodiesFinalize(batch.data(), int(batch.size()), state, JPH::EActivation::Activate);

    const JPH::BodyLockInterfaceNoLock& li = sys.GetBodyLockInterfaceNoLock();
    for (auto& j : sc.joints) {
      JPH::Body &a = *li.TryGetBody(id[j.a]), &b = *li.TryGetBody(id[j.b]);
      JPH::RVec3 p(in(j.anchor));
      JPH::Vec3 ax = in(unit(j.axis)), nx = in(any_perpendicular(unit(j.axis)));
      JPH::Constraint* c = nullptr;
      if (j.kind == JointKind::ball) {
        JPH::PointConstraintSettings s;
        s.mPoint1 = s.mPoint2 = p;
        c = s.Create(a, b);
      } else if (j.kind == JointKind::cone) {
        JPH::SwingTwistConstraintSettings s;
        s.mPosition1 = s.mPosition2 = p;
        s.mTwistAxis1 = s.mTwistAxis2 = ax;
        s.mPlaneAxis1 = s.mPlaneAxis2 = nx;
        s.mNormalHalfConeAngle = s.mPlaneHalfConeAngle = float(j.cone);
        s.mTwistMinAngle = float(j.lo);
        s.mTwistMaxAngle = float(j.hi);
        c = s.Create(a, b);
      } else {
        JPH::HingeConstraintSettings s;
        s.mPoint1 = s.mPoint2 = p;
        s.mHingeAxis1 = s.mHingeAxis2 = ax;
        s.mNormalAxis1 = s.mNormalAxis2 = nx;
        s.mLimitsMin = float(j.lo);
        s.mLimitsMax = float(j.hi);
        c = s.Create(a, b);
      }
      sys.AddConstraint(c);
    }
    sys.OptimizeBroadPhase();
    return true;
  }
  void step() override { sys.Update(float(gyre::bench::kDt), COLLISION_STEPS, temp, jobs); }
  gyre::bench::BodyState state(int i) override { return {pose(i), velocity(i), spin(i), asleep(i)}; }
  gyre::bench::Pose pose(int i) {
    JPH::BodyInterface& bi = sys.GetBodyInterfaceNoLock();
    JPH::Vec3 p(bi.GetPosition(id[i]));
    JPH::Quat q = bi.GetRotation(id[i]);
    return {out(p), {q.GetX(), q.GetY(), q.GetZ(), q.GetW()}};
  }
  gyre::bench::V3 velocity(int i) { return out(sys.GetBodyInterfaceNoLock().GetLinearVelocity(id[i])); }
  gyre::bench::V3 spin(int i) { return out(sys.GetBodyInterfaceNoLock().GetAngularVelocity(id[i])); }
  bool asleep(int i) { return !sys.GetBodyInterfaceNoLock().IsActive(id[i]); }
  bool cast_ray(gyre::bench::V3 from, gyre::bench::V3 by, double& f) override {
    JPH::RRayCast r{JPH::RVec3(in(from)), in(by)};
    JPH::RayCastResult hit;
    bool h = sys.GetNarrowPhaseQueryNoLock().CastRay(r, hit);
    f = hit.mFraction;
    return h;
  }
};

}  // namespace

int main(int argc, char** argv) {
  JPH::RegisterDefaultAllocator();
  JPH::Factory::sInstance = new JPH::Factory();
  JPH::RegisterTypes();
  auto* engine = new Jolt;  // never destroyed: tear-down is not measured
  return gyre::bench::run_program(*engine, argc, argv);
}
