// PhysX 5 (CPU) in our scenes. Settings: its scene defaults (PCM contacts, patch friction, parallel
// automatic box pruning, 4 position + 1 velocity iterations). Compile with PHYSX_TGS for the
// temporal Gauss-Seidel solver instead of the default projected Gauss-Seidel one.
#include "bench/scenes/engine.h"

#include <algorithm>
#include <set>

#include <PxPhysicsAPI.h>

#ifndef POSITION_ITERATIONS
#define POSITION_ITERATIONS 4  // the library's default; more of them trade time for quality
#endif

using namespace physx;

namespace {

PxVec3 in(gyre::bench::V3 v) { return PxVec3(float(v.x), float(v.y), float(v.z)); }
PxQuat in(gyre::bench::Quat q) {
  return PxQuat(float(q.x), float(q.y), float(q.z), float(q.w)).getNormalized();
}
PxTransform in(const gyre::bench::Pose& p) { return PxTransform(in(p.p), in(p.q)); }
gyre::bench::V3 out(PxVec3 v) { return {v.x, v.y, v.z}; }

PxDefaultAllocator allocator;
PxDefaultErrorCallback errors;

// word0: 1 static, 2 normal, 4 never against its own kind
PxFilterFlags filter(PxFilterObjectAttributes, PxFilterData a, PxFilterObjectAttributes, PxFilterData b,
                     PxPairFlags& f, const void*, PxU32) {
  if ((a.word0 & 4) && (b.word0 & 4)) return PxFilterFlag::eSUPPRESS;
  f = PxPairFlag::eCONTACT_DEFAULT;
  return PxFilterFlag::eDEFAULT;
}

struct PhysX final : gyre::bench::Engine {
  PxPhysics* px = nullptr;
  PxScene* scene = nullptr;
  PxMaterial* mat = nullptr;
  std::vector<PxRigidActor*> actor;
  const gyre::bench::Scene* src = nullptr;
  std::vector<int> kinematic;
  double time = 0;

#ifdef PHYSX_TGS
  const char* name() const override { return POSITION_ITERATIONS == 4 ? "physx-tgs" : "physx-tgs-other"; }
#else
  const char* name() const override { return POSITION_ITERATIONS == 4 ? "physx-pgs" : "physx-pgs-other"; }
#endif
  std::string settings() const override {
    return std::to_string(POSITION_ITERATIONS) + " position + 1 velocity iterations, defaults";
  }

  bool create(const gyre::bench::Scene& sc, int threads, bool sleep, std::string&) override {
    using namespace gyre::bench;
    src = &sc;
    PxFoundation* f = PxCreateFoundation(PX_PHYSICS_VERSION, allocator, errors);
    PxTolerancesScale scale;
    px = PxCreatePhysics(PX_PHYSICS_VERSION, *f, scale);
    PxInitExtensions(*px, nullptr);
    PxSceneDesc d(scale);
    d.gravity = PxVec3(0, float(sc.gravity), 0);
    d.cpuDispatcher = PxDefaultCpuDispatcherCreate(threads > 1 ? PxU32(threads) : 0);
    d.filterShader = filter;
#ifdef PHYSX_TGS
    d.solverType = PxSolverType::eTGS;
#endif
    scene = px->createScene(d);
    mat = px->createMaterial(float(sc.friction), float(sc.friction), float(sc.restitution));
    PxCookingParams cp(scale);
    std::vector<PxConvexMesh*> hulls;
    for (auto& h : sc.hulls) {
      std::vector<PxVec3> v;
      for (auto& p : h.v) v.push_back(in(p));
      PxConvexMeshDesc cd;
      cd.points.count = PxU32(v.size());
      cd.points.stride = sizeof(PxVec3);
      cd.points.data = v.data();
      cd.flags = PxConvexFlag::eCOMPUTE_CONVEX;
      hulls.push_back(PxCreateConvexMesh(cp, cd));
    }
    std::vector<PxTriangleMesh*> meshes;
    for (auto& m : sc.meshes) {
      std::vector<PxVec3> v;
      for (auto& p : m.v) v.push_back(in(p));
      std::vector<PxU32> t(m.tri.begin(), m.tri.end());
      PxTriangleMeshDesc md;
      md.points.count = PxU32(v.size());
      md.points.stride = sizeof(PxVec3);
      md.points.data = v.data();
      md.triangles.count = PxU32(t.size() / 3);
      md.triangles.stride = 3 * sizeof(PxU32);
      md.triangles.data = t.data();
      meshes.push_back(PxCreateTriangleMesh(cp, md));
    }
    for (size_t i = 0; i < sc.bodies.size(); ++i) {
      const Body& b = sc.bodies[i];
      PxTransform t = in(Pose{b.pos, b.q});
      PxRigidActor* a;
      PxRigidDynamic* dyn = nullptr;
      if (b.motion == Motion::fixed)
        a = px->createRigidStatic(t);
      else
        a = dyn = px->createRigidDynamic(t);
      for (auto& s : b.shapes) {
        PxTransform l = in(s.local);
        PxShape* sh = nullptr;
        switch (s.kind) {
          case Kind::sphere:
            sh = PxRigidActorExt::createExclusiveShape(*a, PxSphereGeometry(float(s.radius)), *mat);
            break;
          case Kind::capsule:
            sh = PxRigidActorExt::createExclusiveShape(
                *a, PxCapsuleGeometry(float(s.radius), float(s.half_length)), *mat);
            l = l * PxTransform(in(axis_angle({0, 0, 1}, kPi / 2)));  // its capsules lie along x
            break;
          case Kind::box:
            sh = PxRigidActorExt::createExclusiveShape(*a, PxBoxGeometry(in(s.half)), *mat);
            break;
          case Kind::hull:
            sh = PxRigidActorExt::createExclusiveShape(*a, PxConvexMeshGeometry(hulls[s.data]), *mat);
            break;
          case Kind::mesh:
            sh = PxRigidActorExt::createExclusiveShape(*a, PxTriangleMeshGeometry(meshes[s.data]), *mat);
            break;
        }
        sh->setLocalPose(l);
        sh->setSimulationFilterData(PxFilterData(b.layer == Layer::fixed    ? 1u
                                                 : b.layer == Layer::normal ? 2u
                                                                            : 4u,
                                                 0, 0, 0));
      }
      if (dyn) {
        dyn->setAngularDamping(0);
        dyn->setLinearDamping(0);
        if (b.motion == Motion::kinematic) {
          dyn->setRigidBodyFlag(PxRigidBodyFlag::eKINEMATIC, true);
          kinematic.push_back(int(i));
        } else {
          PxRigidBodyExt::setMassAndUpdateInertia(*dyn, float(mass(sc, b)));
          dyn->setLinearVelocity(in(b.vel));
          dyn->setAngularVelocity(in(b.ang));
          dyn->setSolverIterationCounts(POSITION_ITERATIONS, 1);
          if (!sleep) dyn->setSleepThreshold(0);
        }
      }
      actor.push_back(a);
      scene->addActor(*a);
      if (!sleep && dyn && b.motion == Motion::dynamic) dyn->setWakeCounter(1e30f);
    }
    for (auto& j : sc.joints) {
      V3 x = unit(j.axis), y = any_perpendicular(x);
      Quat fr = from_axes(x, y, cross(x, y));
      auto frame = [&](int i) {
        const Body& b = sc.bodies[i];
        return PxTransform(in(apply_inverse({b.pos, b.q}, j.anchor)), in(normalized(conj(b.q) * fr)));
      };
      PxRigidActor *a = actor[j.a], *b = actor[j.b];
      if (j.kind == JointKind::ball)
        PxSphericalJointCreate(*px, a, frame(j.a), b, frame(j.b));
      else if (j.kind == JointKind::cone) {
        PxD6Joint* k = PxD6JointCreate(*px, a, frame(j.a), b, frame(j.b));
        k->setMotion(PxD6Axis::eSWING1, PxD6Motion::eLIMITED);
        k->setMotion(PxD6Axis::eSWING2, PxD6Motion::eLIMITED);
        k->setMotion(PxD6Axis::eTWIST, PxD6Motion::eLIMITED);
        k->setSwingLimit(PxJointLimitCone(float(j.cone), float(j.cone)));
        k->setTwistLimit(PxJointAngularLimitPair(float(j.lo), float(j.hi)));
      } else {
        PxRevoluteJoint* k = PxRevoluteJointCreate(*px, a, frame(j.a), b, frame(j.b));
        k->setLimit(PxJointAngularLimitPair(float(j.lo), float(j.hi)));
        k->setRevoluteJointFlag(PxRevoluteJointFlag::eLIMIT_ENABLED, true);
      }
    }
    return true;
  }
  void step() override {
    using namespace gyre::bench;
    time += kDt;
    for (int k : kinematic) {
      const Body& b = src->bodies[k];
      static_cast<PxRigidDynamic*>(actor[k])->setKinematicTarget(
          in(Pose{b.pos + time * b.vel, axis_angle(b.ang, len(b.ang) * time) * b.q}));
    }
    scene->simulate(float(kDt));
    scene->fetchResults(true);
  }
  gyre::bench::BodyState state(int i) override { return {pose(i), velocity(i), spin(i), asleep(i)}; }
  gyre::bench::Pose pose(int i) {
    PxTransform t = actor[i]->getGlobalPose();
    return {out(t.p), {t.q.x, t.q.y, t.q.z, t.q.w}};
  }
  PxRigidDynamic* dynamic(int i) { return actor[i]->is<PxRigidDynamic>(); }
  gyre::bench::V3 velocity(int i) {
    return dynamic(i) ? out(dynamic(i)->getLinearVelocity()) : gyre::bench::V3{};
  }
  gyre::bench::V3 spin(int i) {
    return dynamic(i) ? out(dynamic(i)->getAngularVelocity()) : gyre::bench::V3{};
  }
  bool asleep(int i) { return dynamic(i) && dynamic(i)->isSleeping(); }
  bool cast_ray(gyre::bench::V3 from, gyre::bench::V3 by, double& f) override {
    PxRaycastBuffer hit;
    double l = gyre::bench::len(by);
    bool h = scene->raycast(in(from), in((1 / l) * by), float(l), hit, PxHitFlags(PxHitFlag::eDEFAULT));
    f = h ? hit.block.distance / l : 1;
    return h;
  }
};

}  // namespace

int main(int argc, char** argv) {
  auto* engine = new PhysX;  // never destroyed: tear-down is not measured
  return gyre::bench::run_program(*engine, argc, argv);
}
