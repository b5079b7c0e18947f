// Bullet 2/3 in our scenes. Settings: one 1/60 s step, sequential impulse solver with its default 10
// iterations, dynamic AABB tree broad phase, split impulse as by default. With more than one
// thread: the Mt world, its solver pool and the library's own task scheduler (the library must be
// built thread-safe for that; otherwise a run with two threads is skipped).
#include "bench/scenes/engine.h"

#include <algorithm>
#include <set>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolverMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <LinearMath/btConvexHullComputer.h>
#include <LinearMath/btThreads.h>
#include <btBulletDynamicsCommon.h>

using namespace gyre::bench;

static btVector3 vec(V3 v) { return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z)); }
static btQuaternion quat(Quat q) {
  return btQuaternion(btScalar(q.x), btScalar(q.y), btScalar(q.z), btScalar(q.w));
}
static V3 vec(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
static btTransform xf(const Pose& p) { return btTransform(quat(p.q), vec(p.p)); }

struct Bullet final : Engine {
  btDefaultCollisionConfiguration* config = nullptr;
  btCollisionDispatcher* dispatcher = nullptr;
  btDbvtBroadphase* broad = nullptr;
  btDiscreteDynamicsWorld* world = nullptr;
  std::vector<btRigidBody*> body;
  std::vector<int> kinematic;
  const Scene* scene = nullptr;
  double time = 0;
  int threads = 1;

  const char* name() const override { return "bullet"; }
  std::string settings() const override {
    return threads > 1 ? "Mt world, 10 iterations" : "10 iterations, sequential impulse";
  }

  btCollisionShape* simple(const Scene& sc, const Shape& s, double density) {
    (void)density;
    switch (s.kind) {
      case Kind::sphere:
        return new btSphereShape(btScalar(s.radius));
      case Kind::capsule:
        return new btCapsuleShape(btScalar(s.radius), btScalar(2 * s.half_length));
      case Kind::box: {
        auto* b = new btBoxShape(vec(s.half));
        double thin = std::min({s.half.x, s.half.y, s.half.z});
        if (thin < 0.08) b->setMargin(btScalar(0.5 * thin));
        return b;
      }
      case Kind::hull: {
        // The margin lies outside a hull here, so shrink the faces by it to keep the true size.
        const double margin = 0.04;
        std::vector<float> p;
        for (auto& v : sc.hulls[s.data].v) {
          p.push_back(float(v.x));
          p.push_back(float(v.y));
          p.push_back(float(v.z));
        }
        btConvexHullComputer c;
        c.compute(p.data(), 3 * sizeof(float), int(p.size() / 3), btScalar(margin), btScalar(0));
        auto* h = new btConvexHullShape;
        for (int i = 0; i < c.vertices.size(); ++i) h->addPoint(c.vertices[i], false);
        h->setMargin(btScalar(margin));
        h->recalcLocalAabb();
        return h;
      }
      case Kind::mesh: {
        const Mesh& m = sc.meshes[s.data];
        auto* t = new btTriangleMesh(true, false);
        for (size_t i = 0; i < m.tri.size(); i += 3)
          t->addTriangle(vec(m.v[m.tri[i]]), vec(m.v[m.tri[i + 1]]), vec(m.v[m.tri[i + 2]]));
        return new btBvhTriangleMeshShape(t, true);
      }
    }
    return nullptr;
  }

  bool create(const Scene& sc, int n_threads, bool sleep, std::string&) override {
    scene = &sc;
    threads = n_threads;
    btDefaultCollisionConstructionInfo ci;
    ci.m_defaultMaxPersistentManifoldPoolSize = ci.m_defaultMaxCollisionAlgorithmPoolSize =
        std::max(4096, 8 * int(sc.bodies.size()));
    config = new btDefaultCollisionConfiguration(ci);
    broad = new btDbvtBroadphase;
    if (threads > 1) {
      btITaskScheduler* ts = btCreateDefaultTaskScheduler();
      if (!ts) {
        std::printf(
            "{\"engine\":\"bullet\",\"scene\":\"%s\",\"threads\":%d,\"skipped\":\"library built without "
            "threads\"}\n",
            sc.name.c_str(), threads);
        std::exit(0);
      }
      ts->setNumThreads(threads);
      btSetTaskScheduler(ts);
      dispatcher = new btCollisionDispatcherMt(config, 40);
      auto* pool = new btConstraintSolverPoolMt(threads);
      auto* mt = new btSequentialImpulseConstraintSolverMt;
      world = new btDiscreteDynamicsWorldMt(dispatcher, broad, pool, mt, config);
    } else {
      dispatcher = new btCollisionDispatcher(config);
      world = new btDiscreteDynamicsWorld(dispatcher, broad, new btSequentialImpulseConstraintSolver, config);
    }
    world->setGravity(btVector3(0, btScalar(sc.gravity), 0));

    std::vector<btCollisionShape*> hulls(sc.hulls.size());
    for (size_t i = 0; i < sc.bodies.size(); ++i) {
      const Body& b = sc.bodies[i];
      btCollisionShape* shape;
      if (b.shapes.size() == 1) {
        const Shape& s = b.shapes[0];
        if (s.kind == Kind::hull) {
          if (!hulls[s.data]) hulls[s.data] = simple(sc, s, b.density);
          shape = hulls[s.data];
        } else
          shape = simple(sc, s, b.density);
      } else {
        auto* c = new btCompoundShape;
        for (auto& s : b.shapes) c->addChildShape(xf(s.local), simple(sc, s, b.density));
        shape = c;
      }
      btScalar m = b.motion == Motion::dynamic ? btScalar(mass(sc, b)) : 0;
      btVector3 inertia(0, 0, 0);
      if (m > 0) shape->calculateLocalInertia(m, inertia);
      btRigidBody::btRigidBodyConstructionInfo info(m, nullptr, shape, inertia);
      info.m_startWorldTransform = xf({b.pos, b.q});
      // Friction of a pair is the product here: take the root to get the scene's number.
      info.m_friction = btScalar(std::sqrt(sc.friction));
      info.m_restitution = btScalar(sc.restitution);
      auto* rb = new btRigidBody(info);
      rb->setLinearVelocity(vec(b.vel));
      rb->setAngularVelocity(vec(b.ang));
      if (b.motion == Motion::kinematic) {
        rb->setCollisionFlags(rb->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        rb->setActivationState(DISABLE_DEACTIVATION);
        rb->setMotionState(new btDefaultMotionState(xf({b.pos, b.q})));
        kinematic.push_back(int(i));
      } else if (!sleep)
        rb->setActivationState(DISABLE_DEACTIVATION);
      int group = b.layer == Layer::fixed ? 1 : b.layer == Layer::normal ? 2 : 4;
      int mask = b.layer == Layer::fixed ? 6 : b.layer == Layer::no_self ? 3 : 7;
      world->addRigidBody(rb, group, mask);
      body.push_back(rb);
    }
    for (auto& j : sc.joints) {
      auto frame = [&](int i, Quat f) {
        const Body& b = sc.bodies[i];
        return btTransform(quat(normalized(conj(b.q) * f)), vec(apply_inverse({b.pos, b.q}, j.anchor)));
      };
      V3 ax = unit(j.axis), p = any_perpendicular(ax);
      btTypedConstraint* c;
      if (j.kind == JointKind::ball)
        c = new btPoint2PointConstraint(*body[j.a], *body[j.b], frame(j.a, {}).getOrigin(),
                                        frame(j.b, {}).getOrigin());
      else if (j.kind == JointKind::cone) {
        Quat f = from_axes(ax, p, cross(ax, p));  // twist about x
        auto* k = new btConeTwistConstraint(*body[j.a], *body[j.b], frame(j.a, f), frame(j.b, f));
        // It takes one symmetric twist span.
        k->setLimit(btScalar(j.cone), btScalar(j.cone), btScalar(0.5 * (j.hi - j.lo)));
        c = k;
      } else {
        Quat f = from_axes(p, cross(ax, p), ax);  // hinge about z
        auto* k = new btHingeConstraint(*body[j.a], *body[j.b], frame(j.a, f), frame(j.b, f), true);
        k->setLimit(btScalar(j.lo), btScalar(j.hi));
        c = k;
      }
      world->addConstraint(c, true);
    }
    return true;
  }
  void step() override {
    time += kDt;
    for (int k : kinematic) {
      const Body& b = scene->bodies[k];
      btTransform t = xf({b.pos + time * b.vel, axis_angle(b.ang, len(b.ang) * time) * b.q});
      body[k]->getMotionState()->setWorldTransform(t);
    }
    world->stepSimulation(btScalar(kDt), 0);
  }
  BodyState state(int i) override { return {pose(i), velocity(i), spin(i), asleep(i)}; }
  Pose pose(int i) {
    const btTransform& t = body[i]->getWorldTransform();
    btQuaternion q = t.getRotation();
    return {vec(t.getOrigin()), {q.x(), q.y(), q.z(), q.w()}};
  }
  V3 velocity(int i) { return vec(body[i]->getLinearVelocity()); }
  V3 spin(int i) { return vec(body[i]->getAngularVelocity()); }
  bool asleep(int i) { return !body[i]->isActive(); }
  bool cast_ray(V3 from, V3 by, double& f) override {
    btVector3 a = vec(from), b = vec(from + by);
    btCollisionWorld::ClosestRayResultCallback cb(a, b);
    cb.m_collisionFilterGroup = -1;
    world->rayTest(a, b, cb);
    f = cb.m_closestHitFraction;
    return cb.hasHit();
  }
};

int main(int argc, char** argv) {
  auto* engine = new Bullet;  // never destroyed: tear-down is not measured
  return run_program(*engine, argc, argv);
}
