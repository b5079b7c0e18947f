// Box3D in our scenes. Settings: its recommended ones (60 Hz, 4 substeps, soft contacts as by
// default, continuous collision on, contact recycling on). SIMD width is whatever the library was built with.
#include "bench/scenes/engine.h"

#include <algorithm>
#include <set>

#include "box3d/box3d.h"
#include "box3d/collision.h"

#ifndef SUBSTEPS
#define SUBSTEPS 4  // the library's recommendation; set another one to trade time for quality
#endif

using namespace gyre::bench;

static b3Vec3 vec(V3 v) { return {float(v.x), float(v.y), float(v.z)}; }
static b3Quat quat(Quat q) { return {{float(q.x), float(q.y), float(q.z)}, float(q.w)}; }
static V3 vec(b3Vec3 v) { return {v.x, v.y, v.z}; }
static Quat quat(b3Quat q) { return {q.v.x, q.v.y, q.v.z, q.s}; }

struct Box3d final : Engine {
  b3WorldId world{};
  std::vector<b3BodyId> id;
  const char* name() const override { return SUBSTEPS == 4 ? "box3d" : "box3d-other"; }
  std::string settings() const override { return std::to_string(SUBSTEPS) + " substeps, defaults"; }

  bool create(const Scene& sc, int threads, bool sleep, std::string&) override {
    b3WorldDef wd = b3DefaultWorldDef();
    wd.gravity = {0, float(sc.gravity), 0};
    wd.enableSleep = sleep;
    wd.workerCount = uint32_t(threads);
    wd.capacity.dynamicBodyCount = int(sc.bodies.size());
    wd.capacity.dynamicShapeCount = int(sc.bodies.size());
    wd.capacity.contactCount = 8 * int(sc.bodies.size());
    world = b3CreateWorld(&wd);

    std::vector<b3HullData*> hulls;
    for (auto& h : sc.hulls) {
      std::vector<b3Vec3> p;
      for (auto& v : h.v) p.push_back(vec(v));
      hulls.push_back(b3CreateHull(p.data(), int(p.size()), int(p.size())));
    }
    std::vector<b3MeshData*> meshes;
    for (auto& m : sc.meshes) {
      std::vector<b3Vec3> v;
      for (auto& p : m.v) v.push_back(vec(p));
      std::vector<int32_t> t(m.tri.begin(), m.tri.end());
      b3MeshDef md{};
      md.vertices = v.data();
      md.indices = t.data();
      md.vertexCount = int(v.size());
      md.triangleCount = int(t.size() / 3);
      md.identifyEdges = true;
      meshes.push_back(b3CreateMesh(&md, nullptr, 0));
    }
    for (auto& b : sc.bodies) {
      b3BodyDef bd = b3DefaultBodyDef();
      bd.type = b.motion == Motion::fixed       ? b3_staticBody
                : b.motion == Motion::kinematic ? b3_kinematicBody
                                                : b3_dynamicBody;
      bd.position = vec(b.pos);
      bd.rotation = quat(b.q);
      bd.linearVelocity = vec(b.vel);
      bd.angularVelocity = vec(b.ang);
      bd.enableSleep = sleep;
      b3BodyId body = b3CreateBody(world, &bd);
      id.push_back(body);
      b3ShapeDef sd = b3DefaultShapeDef();
      sd.density = float(b.density);
      sd.baseMaterial.friction = float(sc.friction);
      sd.baseMaterial.restitution = float(sc.restitution);
      sd.filter.categoryBits = b.layer == Layer::fixed ? 1 : b.layer == Layer::normal ? 2 : 4;
      sd.filter.maskBits = b.layer == Layer::no_self ? 3 : 7;
      for (auto& s : b.shapes) {
        b3Transform local{vec(s.local.p), quat(s.local.q)};
        switch (s.kind) {
          case Kind::sphere: {
            b3Sphere g{vec(s.local.p), float(s.radius)};
            b3CreateSphereShape(body, &sd, &g);
            break;
          }
          case Kind::capsule: {
            b3Capsule g{vec(apply(s.local, {0, s.half_length, 0})),
                        vec(apply(s.local, {0, -s.half_length, 0})), float(s.radius)};
            b3CreateCapsuleShape(body, &sd, &g);
            break;
          }
          case Kind::box: {
            b3BoxHull g = b3MakeTransformedBoxHull(float(s.half.x), float(s.half.y), float(s.half.z), local);
            b3CreateHullShape(body, &sd, &g.base);
            break;
          }
          case Kind::hull:
            b3CreateHullShape(body, &sd, hulls[s.data]);
            break;
          case Kind::mesh:
            b3CreateMeshShape(body, &sd, meshes[s.data], {1, 1, 1});
            break;
        }
      }
    }
    for (auto& j : sc.joints) {
      // Both kinds turn about the frames' z axis.
      V3 z = unit(j.axis), x = any_perpendicular(z);
      Quat f = from_axes(x, cross(z, x), z);
      auto frame = [&](int i) {
        const Body& b = sc.bodies[i];
        b3Transform t;
        t.p = vec(apply_inverse({b.pos, b.q}, j.anchor));
        t.q = quat(normalized(conj(b.q) * f));
        return t;
      };
      if (j.kind == JointKind::hinge) {
        b3RevoluteJointDef d = b3DefaultRevoluteJointDef();
        d.base.bodyIdA = id[j.a];
        d.base.bodyIdB = id[j.b];
        d.base.localFrameA = frame(j.a);
        d.base.localFrameB = frame(j.b);
        d.enableLimit = true;
        d.lowerAngle = float(j.lo);
        d.upperAngle = float(j.hi);
        b3CreateRevoluteJoint(world, &d);
      } else {
        b3SphericalJointDef d = b3DefaultSphericalJointDef();
        d.base.bodyIdA = id[j.a];
        d.base.bodyIdB = id[j.b];
        d.base.localFrameA = frame(j.a);
        d.base.localFrameB = frame(j.b);
        if (j.kind == JointKind::cone) {
          d.enableConeLimit = true;
          d.coneAngle = float(j.cone);
          d.enableTwistLimit = true;
          d.lowerTwistAngle = float(j.lo);
          d.upperTwistAngle = float(j.hi);
        }
        b3CreateSphericalJoint(world, &d);
      }
    }
    if (sc.rays) b3World_RebuildStaticTree(world);
    return true;
  }
  void step() override { b3World_Step(world, float(kDt), SUBSTEPS); }
  BodyState state(int i) override { return {pose(i), velocity(i), spin(i), asleep(i)}; }
  Pose pose(int i) { return {vec(b3Body_GetPosition(id[i])), quat(b3Body_GetRotation(id[i]))}; }
  V3 velocity(int i) { return vec(b3Body_GetLinearVelocity(id[i])); }
  V3 spin(int i) { return vec(b3Body_GetAngularVelocity(id[i])); }
  bool asleep(int i) { return !b3Body_IsAwake(id[i]); }
  bool cast_ray(V3 from, V3 by, double& f) override {
    b3RayResult r = b3World_CastRayClosest(world, vec(from), vec(by), b3DefaultQueryFilter());
    f = r.fraction;
    return r.hit;
  }
};

int main(int argc, char** argv) {
  auto* engine = new Box3d;  // never destroyed: tear-down is not measured
  return run_program(*engine, argc, argv);
}
