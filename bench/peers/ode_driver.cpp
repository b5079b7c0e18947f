// ODE in our scenes. Settings: 60 Hz, QuickStep with its default 20 iterations, ERP 0.2 and CFM as by
// default, at most 8 contacts a pair, sweep-and-prune space. More than one thread: the library's own pool
// (islands only; its collision search stays single-threaded).
#include "bench/scenes/engine.h"

#include <algorithm>
#include <set>

#include <ode/ode.h>

using namespace gyre::bench;

struct Ode final : Engine {
  dWorldID world{};
  dSpaceID space{};
  dJointGroupID contacts{};
  std::vector<dBodyID> body;  // null for static bodies
  std::vector<Pose> fixed;
  std::vector<std::vector<dReal>> keepR;
  std::vector<std::vector<unsigned>> keepU;
  const Scene* scene = nullptr;
  int threads = 1;
  std::set<std::pair<dBodyID, dBodyID>> joined;
  std::vector<dGeomID> geoms;

  const char* name() const override { return "ode"; }
  std::string settings() const override { return "QuickStep 20 iterations, ERP 0.2"; }

  dGeomID simple(const Scene& sc, const Shape& s, dQuaternion extra) {
    extra[0] = 1;
    extra[1] = extra[2] = extra[3] = 0;
    switch (s.kind) {
      case Kind::sphere:
        return dCreateSphere(space, s.radius);
      case Kind::capsule: {
        Quat q = axis_angle({1, 0, 0}, kPi / 2);  // its capsules lie along z
        extra[0] = q.w;
        extra[1] = q.x;
        extra[2] = q.y;
        extra[3] = q.z;
        return dCreateCapsule(space, s.radius, 2 * s.half_length);
      }
      case Kind::box:
        return dCreateBox(space, 2 * s.half.x, 2 * s.half.y, 2 * s.half.z);
      case Kind::hull: {
        const Hull& h = sc.hulls[s.data];
        std::vector<dReal> planes, pts;
        std::vector<unsigned> poly;
        for (auto& v : h.v)
          for (double c : {v.x, v.y, v.z}) pts.push_back(c);
        for (auto& n : h.face_normals) {
          double d = -1e300;
          for (auto& v : h.v) d = std::max(d, dot(n, v));
          for (double c : {n.x, n.y, n.z, d}) planes.push_back(c);
          std::vector<std::pair<double, unsigned>> on;
          V3 u = any_perpendicular(n), w = cross(n, u), c{};
          for (unsigned i = 0; i < h.v.size(); ++i)
            if (dot(n, h.v[i]) > d - 1e-7) {
              on.push_back({0, i});
              c = c + h.v[i];
            }
          c = (1.0 / double(on.size())) * c;
          for (auto& o : on) o.first = std::atan2(dot(h.v[o.second] - c, w), dot(h.v[o.second] - c, u));
          std::sort(on.begin(), on.end());
          poly.push_back(unsigned(on.size()));
          for (auto& o : on) poly.push_back(o.second);
        }
        keepR.push_back(planes);
        keepR.push_back(pts);
        keepU.push_back(poly);
        return dCreateConvex(space, keepR[keepR.size() - 2].data(), unsigned(h.face_normals.size()),
                             keepR.back().data(), unsigned(h.v.size()), keepU.back().data());
      }
      case Kind::mesh: {
        const Mesh& m = sc.meshes[s.data];
        std::vector<dReal> v;
        std::vector<unsigned> t(m.tri.begin(), m.tri.end());
        for (auto& p : m.v)
          for (double c : {p.x, p.y, p.z}) v.push_back(c);
        keepR.push_back(v);
        keepU.push_back(t);
        dTriMeshDataID d = dGeomTriMeshDataCreate();
#ifdef dDOUBLE
        dGeomTriMeshDataBuildDouble(d, keepR.back().data(), 3 * sizeof(dReal), int(m.v.size()),
                                    keepU.back().data(), int(t.size()), 3 * sizeof(unsigned));
#else
        dGeomTriMeshDataBuildSingle(d, keepR.back().data(), 3 * sizeof(dReal), int(m.v.size()),
                                    keepU.back().data(), int(t.size()), 3 * sizeof(unsigned));
#endif
        dGeomTriMeshDataPreprocess2(d, 1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);  // hulls need it
        return dCreateTriMesh(space, d, nullptr, nullptr, nullptr);
      }
    }
    return nullptr;
  }

  bool create(const Scene& sc, int n_threads, bool sleep, std::string&) override {
    scene = &sc;
    threads = n_threads;
    keepR.reserve(200000);
    keepU.reserve(100000);
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    world = dWorldCreate();
    space = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY);
    contacts = dJointGroupCreate(0);
    dWorldSetGravity(world, 0, sc.gravity, 0);
    dWorldSetAutoDisableFlag(world, sleep);
    if (threads > 1) {
      auto* impl = dThreadingAllocateMultiThreadedImplementation();
      auto* pool = dThreadingAllocateThreadPool(unsigned(threads), 0, dAllocateMaskAll, nullptr);
      dThreadingThreadPoolServeMultiThreadedImplementation(pool, impl);
      dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(impl), impl);
      dWorldSetStepIslandsProcessingMaxThreadCount(world, unsigned(threads));
    }
    for (auto& b : sc.bodies) {
      dBodyID id = nullptr;
      if (b.motion != Motion::fixed) {
        id = dBodyCreate(world);
        dBodySetPosition(id, b.pos.x, b.pos.y, b.pos.z);
        dQuaternion q{b.q.w, b.q.x, b.q.y, b.q.z};
        dBodySetQuaternion(id, q);
        dBodySetLinearVel(id, b.vel.x, b.vel.y, b.vel.z);
        dBodySetAngularVel(id, b.ang.x, b.ang.y, b.ang.z);
        if (b.motion == Motion::kinematic)
          dBodySetKinematic(id);
        else {
          dMass m;
          const Shape& s = b.shapes[0];
          if (s.kind == Kind::sphere)
            dMassSetSphere(&m, b.density, s.radius);
          else if (s.kind == Kind::capsule)
            dMassSetCapsule(&m, b.density, 3, s.radius, 2 * s.half_length);
          else if (s.kind == Kind::box)
            dMassSetBox(&m, b.density, 2 * s.half.x, 2 * s.half.y, 2 * s.half.z);
          else
            dMassSetSphereTotal(&m, mass(sc, b), 0.5);
          if (s.kind == Kind::capsule) {
            dMatrix3 r;
            dRFromAxisAndAngle(r, 1, 0, 0, kPi / 2);
            dMassRotate(&m, r);
          }
          dBodySetMass(id, &m);
        }
      }
      for (auto& s : b.shapes) {
        dQuaternion e;
        dGeomID g = simple(sc, s, e);
        Quat local = s.local.q * Quat{e[1], e[2], e[3], e[0]};
        dGeomSetCategoryBits(g, b.layer == Layer::fixed ? 1ul : b.layer == Layer::normal ? 2ul : 4ul);
        dGeomSetCollideBits(g, b.layer == Layer::fixed ? 6ul : b.layer == Layer::no_self ? 3ul : 7ul);
        if (id) {
          dGeomSetBody(g, id);
          dQuaternion lq{local.w, local.x, local.y, local.z};
          dGeomSetOffsetPosition(g, s.local.p.x, s.local.p.y, s.local.p.z);
          dGeomSetOffsetQuaternion(g, lq);
        } else {
          Quat w = b.q * local;
          V3 p = apply({b.pos, b.q}, s.local.p);
          dQuaternion wq{w.w, w.x, w.y, w.z};
          dGeomSetPosition(g, p.x, p.y, p.z);
          dGeomSetQuaternion(g, wq);
        }
        geoms.push_back(g);
      }
      body.push_back(id);
      fixed.push_back({b.pos, b.q});
    }
    for (auto& j : sc.joints) {
      dBodyID a = body[j.a], b = body[j.b];
      V3 ax = unit(j.axis);
      if (j.kind == JointKind::hinge) {
        dJointID h = dJointCreateHinge(world, nullptr);
        dJointAttach(h, a, b);
        dJointSetHingeAnchor(h, j.anchor.x, j.anchor.y, j.anchor.z);
        dJointSetHingeAxis(h, ax.x, ax.y, ax.z);
        // Its angle is that of the first body against the second.
        dJointSetHingeParam(h, dParamLoStop, -j.hi);
        dJointSetHingeParam(h, dParamHiStop, -j.lo);
      } else {
        dJointID k = dJointCreateBall(world, nullptr);
        dJointAttach(k, a, b);
        dJointSetBallAnchor(k, j.anchor.x, j.anchor.y, j.anchor.z);
        if (j.kind == JointKind::cone) {
          // No cone joint here: an angular motor with Euler limits stands in for it.
          dJointID m = dJointCreateAMotor(world, nullptr);
          dJointAttach(m, a, b);
          dJointSetAMotorMode(m, dAMotorEuler);
          V3 p = any_perpendicular(ax);
          dJointSetAMotorAxis(m, 0, 1, ax.x, ax.y, ax.z);
          dJointSetAMotorAxis(m, 2, 2, p.x, p.y, p.z);
          dJointSetAMotorParam(m, dParamLoStop, j.lo);
          dJointSetAMotorParam(m, dParamHiStop, j.hi);
          dJointSetAMotorParam(m, dParamLoStop2, -j.cone);
          dJointSetAMotorParam(m, dParamHiStop2, j.cone);
          dJointSetAMotorParam(m, dParamLoStop3, -j.cone);
          dJointSetAMotorParam(m, dParamHiStop3, j.cone);
        }
      }
      if (a && b) joined.insert({std::min(a, b), std::max(a, b)});
    }
    return true;
  }

  static void near(void* self, dGeomID g1, dGeomID g2) {
    Ode& o = *static_cast<Ode*>(self);
    dBodyID a = dGeomGetBody(g1), b = dGeomGetBody(g2);
    if (a == b) return;
    if (a && b && !o.joined.empty() && dAreConnectedExcluding(a, b, dJointTypeContact)) return;
    if ((!a || !dBodyIsEnabled(a)) && (!b || !dBodyIsEnabled(b))) return;
    const int most = 8;
    dContact c[most];
    int n = dCollide(g1, g2, most, &c[0].geom, sizeof(dContact));
    for (int i = 0; i < n; ++i) {
      c[i].surface.mode = dContactApprox1;
      c[i].surface.mu = o.scene->friction;
      dJointAttach(dJointCreateContact(o.world, o.contacts, &c[i]), a, b);
    }
  }
  void step() override {
    dSpaceCollide(space, this, &Ode::near);
    dWorldQuickStep(world, kDt);
    dJointGroupEmpty(contacts);
  }
  BodyState state(int i) override { return {pose(i), velocity(i), spin(i), asleep(i)}; }
  Pose pose(int i) {
    if (!body[i]) return fixed[i];
    const dReal *p = dBodyGetPosition(body[i]), *q = dBodyGetQuaternion(body[i]);
    return {{p[0], p[1], p[2]}, {q[1], q[2], q[3], q[0]}};
  }
  V3 velocity(int i) {
    if (!body[i]) return {};
    const dReal* v = dBodyGetLinearVel(body[i]);
    return {v[0], v[1], v[2]};
  }
  V3 spin(int i) {
    if (!body[i]) return {};
    const dReal* v = dBodyGetAngularVel(body[i]);
    return {v[0], v[1], v[2]};
  }
  bool asleep(int i) { return body[i] && !dBodyIsEnabled(body[i]); }

  struct Hit {
    double depth;
    bool any;
  };
  static void rayNear(void* data, dGeomID g1, dGeomID g2) {
    Hit& h = *static_cast<Hit*>(data);
    dContactGeom c[1];
    if (dCollide(g1, g2, 1, c, sizeof(dContactGeom)) > 0 && c[0].depth < h.depth) {
      h.depth = c[0].depth;
      h.any = true;
    }
  }
  dGeomID ray = nullptr;
  bool cast_ray(V3 from, V3 by, double& f) override {
    double l = len(by);
    if (!ray) {
      ray = dCreateRay(nullptr, l);
      dGeomRaySetClosestHit(ray, 1);
    }
    V3 d = unit(by);
    dGeomRaySet(ray, from.x, from.y, from.z, d.x, d.y, d.z);
    dGeomRaySetLength(ray, l);
    Hit h{l, false};
    dSpaceCollide2(ray, dGeomID(space), &h, &Ode::rayNear);
    f = h.depth / l;
    return h.any;
  }
};

int main(int argc, char** argv) {
  auto* engine = new Ode;  // never destroyed: tear-down is not measured
  return run_program(*engine, argc, argv);
}
