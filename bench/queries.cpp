// Rays, moving balls and overlaps a second in a world of 10,000 boxes over a terrain of triangles: one by one, in batches over
// the workers, by brute force, by Bullet where its headers are at hand, and by Box3D where BOX3D_ROOT names a folder with its
// headers (include/) and its library (libbox3d.a).
//
//   bench/queries [rounds]
//
// Everything is measured in turn, round after round, so that what else the machine does falls on all alike. Printed are the
// median of the rounds, and ratios to Gyre's single queries as the median of the ratios within a round, with half the distance
// between their quartiles as the error.
#include <gyre/gyre.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#if defined(GYRE_HAVE_BULLET)
#include <btBulletCollisionCommon.h>
#endif
#if defined(GYRE_HAVE_BOX3D)
#include <box3d/box3d.h>
#endif

namespace {

using namespace gyre;

constexpr int kBoxes = 10000;
constexpr int kSide = 128;         // cells of the terrain
constexpr float kHalfWorld = 100;  // m

struct Scene {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Pose> boxes;
  std::vector<Ray> rays;
  std::vector<ShapeCast> casts;
  std::vector<ShapePlace> places;
};

Scene make_scene() {
  Scene s;
  std::mt19937 engine(1);
  const auto random = [&](float low, float high) {
    return low + (high - low) * float(engine() >> 8) / 16777216.0f;
  };
  const float cell = 2.0f * kHalfWorld / kSide;
  for (int row = 0; row <= kSide; ++row) {
    for (int column = 0; column <= kSide; ++column)
      s.vertices.push_back(
          {float(column) * cell - kHalfWorld, random(-1, 1), float(row) * cell - kHalfWorld});
  }
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const std::uint32_t at = row * (kSide + 1) + column;
      s.indices.insert(s.indices.end(), {at, at + kSide + 1, at + 1, at + 1, at + kSide + 1, at + kSide + 2});
    }
  }
  const auto place = [&](float low, float high) {
    return DVec3{double(random(-95, 95)), double(random(low, high)), double(random(-95, 95))};
  };
  const auto turn = [&] {
    return normalized(Quat{random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)});
  };
  for (int i = 0; i < kBoxes; ++i) s.boxes.push_back({place(2, 30), turn()});
  for (int i = 0; i < 4000; ++i) {
    const DVec3 from = place(1, 35);
    s.rays.push_back({from, difference(place(-3, 20), from)});
  }
  for (int i = 0; i < 1000; ++i) {
    const DVec3 from = place(1, 35);
    s.casts.push_back({Sphere{0.5f}, {from, {}}, 0.2f * difference(place(-3, 20), from)});
    s.places.push_back({Sphere{1.0f}, {place(0, 30), {}}});
  }
  return s;
}

World make_world(const Scene& scene, BroadPhaseKind kind, int threads) {
  WorldDef def;
  def.threads = threads;
  def.stepping.broad_phase = kind;
  World world = std::move(*World::create(def));
  world.add_body({.type = BodyType::fixed},
                 {.geometry = *cook_mesh({.vertices = scene.vertices, .indices = scene.indices})});
  for (const Pose& pose : scene.boxes)
    world.add_body({.type = BodyType::fixed, .pose = pose}, {.geometry = Box{}});
  return world;
}

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Row {
  std::string name;
  double count = 0;
  std::function<void()> work;
  std::vector<double> times;  // s a query, round after round
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::size_t(share * double(values.size() - 1) + 0.5)];
}

// The first row of a group is what the others are compared with.
void measure(const char* what, std::vector<Row>& rows, int rounds) {
  for (int round = -1; round < rounds; ++round) {
    for (Row& row : rows) {
      const double time = seconds(row.work) / row.count;
      if (round >= 0) row.times.push_back(time);
    }
  }
  std::printf("%s\n", what);
  for (const Row& row : rows) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < row.times.size(); ++i) ratios.push_back(rows[0].times[i] / row.times[i]);
    std::printf("  %-28s %12.0f a second   x %.3g +- %.2g\n", row.name.c_str(),
                1.0 / quantile(row.times, 0.5), quantile(ratios, 0.5),
                0.5 * (quantile(ratios, 0.75) - quantile(ratios, 0.25)));
  }
}

volatile std::size_t sink = 0;  // so that no answer is left out

#if defined(GYRE_HAVE_BULLET)
btVector3 bullet(DVec3 v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }
btVector3 bullet(Vec3 v) { return bullet(DVec3(v)); }

// The same world in Bullet: static objects in its dynamic tree of boxes.
class BulletWorld {
 public:
  explicit BulletWorld(const Scene& scene) {
    for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
      triangles_.addTriangle(bullet(scene.vertices[scene.indices[i]]),
                             bullet(scene.vertices[scene.indices[i + 1]]),
                             bullet(scene.vertices[scene.indices[i + 2]]));
    }
    terrain_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    add(terrain_.get(), btTransform::getIdentity());
    for (const Pose& pose : scene.boxes) {
      const Quat q = pose.orientation;
      add(&box_, btTransform(btQuaternion(q.x, q.y, q.z, q.w), bullet(pose.position)));
    }
    world_.updateAabbs();
  }
  ~BulletWorld() {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  bool ray(const Ray& ray) {
    const btVector3 from = bullet(ray.origin), to = bullet(ray.origin + ray.way);
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world_.rayTest(from, to, hit);
    return hit.hasHit();
  }
  bool ball(const ShapeCast& cast) {
    const btVector3 from = bullet(cast.pose.position), to = bullet(cast.pose.position + cast.way);
    btCollisionWorld::ClosestConvexResultCallback hit(from, to);
    world_.convexSweepTest(&small_ball_, btTransform(btQuaternion::getIdentity(), from),
                           btTransform(btQuaternion::getIdentity(), to), hit);
    return hit.hasHit();
  }
  std::size_t overlaps(const ShapePlace& place, bool box = false) {
    btCollisionObject object;
    object.setCollisionShape(box ? static_cast<btCollisionShape*>(&large_box_) : &ball_);
    object.setWorldTransform(btTransform(btQuaternion::getIdentity(), bullet(place.pose.position)));
    Counter counter;
    world_.contactTest(&object, counter);
    return counter.objects;
  }

 private:
  struct Counter : btCollisionWorld::ContactResultCallback {
    std::size_t objects = 0;
    const btCollisionObject* last = nullptr;
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper* other, int, int) override {
      if (other->getCollisionObject() != last) ++objects;
      last = other->getCollisionObject();
      return 0;
    }
  };
  void add(btCollisionShape* shape, const btTransform& place) {
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(shape);
    objects_.back()->setWorldTransform(place);
    objects_.back()->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    world_.addCollisionObject(objects_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> terrain_;
  btBoxShape box_{btVector3(0.5, 0.5, 0.5)}, large_box_{btVector3(1, 1, 1)};
  btSphereShape small_ball_{0.5}, ball_{1.0};
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};
#endif

#if defined(GYRE_HAVE_BOX3D)
b3Vec3 box3d(DVec3 v) { return {float(v.x), float(v.y), float(v.z)}; }

// The same world in Box3D: static bodies.
class Box3dWorld {
 public:
  explicit Box3dWorld(const Scene& scene) {
    b3WorldDef def = b3DefaultWorldDef();
    world_ = b3CreateWorld(&def);
    std::vector<b3Vec3> vertices;
    for (const Vec3& v : scene.vertices) vertices.push_back({v.x, v.y, v.z});
    std::vector<std::int32_t> indices(scene.indices.begin(), scene.indices.end());
    b3MeshDef mesh{};
    mesh.vertices = vertices.data();
    mesh.vertexCount = int(vertices.size());
    mesh.indices = indices.data();
    mesh.triangleCount = int(indices.size() / 3);
    mesh.identifyEdges = true;
    terrain_ = b3CreateMesh(&mesh, nullptr, 0);
    b3ShapeDef shape = b3DefaultShapeDef();
    b3BodyDef body = b3DefaultBodyDef();
    b3CreateMeshShape(b3CreateBody(world_, &body), &shape, terrain_, {1, 1, 1});
    const b3BoxHull box = b3MakeBoxHull(0.5f, 0.5f, 0.5f);
    for (const Pose& pose : scene.boxes) {
      const Quat q = pose.orientation;
      body.position = box3d(pose.position);
      body.rotation = {{q.x, q.y, q.z}, q.w};
      b3CreateHullShape(b3CreateBody(world_, &body), &shape, &box.base);
    }
    b3World_Step(world_, 1.0f / 60.0f, 1);
  }
  ~Box3dWorld() {
    b3DestroyWorld(world_);
    b3DestroyMesh(terrain_);
  }
  Box3dWorld(const Box3dWorld&) = delete;
  Box3dWorld& operator=(const Box3dWorld&) = delete;

  bool ray(const Ray& ray) const {
    return b3World_CastRayClosest(world_, box3d(ray.origin), box3d(DVec3(ray.way)), b3DefaultQueryFilter())
        .hit;
  }
  bool ball(const ShapeCast& cast) const {
    const b3Vec3 middle{0, 0, 0};
    const b3ShapeProxy proxy{&middle, 1, 0.5f};
    float nearest = 1.0f;
    b3World_CastShape(
        world_, box3d(cast.pose.position), &proxy, box3d(DVec3(cast.way)), b3DefaultQueryFilter(),
        [](b3ShapeId, b3Pos, b3Vec3, float fraction, uint64_t, int, int, void* context) {
          *static_cast<float*>(context) = fraction;
          return fraction;
        },
        &nearest);
    return nearest < 1.0f;
  }
  std::size_t overlaps(const ShapePlace& place, std::span<const b3Vec3> points, float radius) const {
    const b3ShapeProxy proxy{points.data(), int(points.size()), radius};
    std::size_t found = 0;
    b3World_OverlapShape(
        world_, box3d(place.pose.position), &proxy, b3DefaultQueryFilter(),
        [](b3ShapeId, void* context) {
          ++*static_cast<std::size_t*>(context);
          return true;
        },
        &found);
    return found;
  }

 private:
  b3WorldId world_;
  b3MeshData* terrain_ = nullptr;
};
#endif

}  // namespace

int main(int count, char** arguments) {
  const int rounds = count > 1 ? std::max(1, std::atoi(arguments[1])) : 15;
  const Scene scene = make_scene();
  const World one = make_world(scene, BroadPhaseKind::bvh, 1),
              all = make_world(scene, BroadPhaseKind::bvh, 0);
  const World brute = make_world(scene, BroadPhaseKind::brute_force, 1);
  std::vector<CastHit> hits(scene.rays.size());
  std::vector<std::uint32_t> counts(scene.places.size());
  std::vector<Row> rays, casts, overlaps, boxes;
  const auto few = [](std::size_t n) { return std::max<std::size_t>(n / 40, 1); };  // of what takes long

  const auto cast_rays = [&](const World& world, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      sink = sink + world.cast_ray(scene.rays[i].origin, scene.rays[i].way).has_value();
  };
  rays.push_back({"one by one", double(scene.rays.size()), [&] { cast_rays(one, scene.rays.size()); }, {}});
  rays.push_back({"batch, one worker",
                  double(scene.rays.size()),
                  [&] { sink = sink + std::size_t(one.cast_rays(scene.rays, hits).code); },
                  {}});
  rays.push_back({"batch, all workers",
                  double(scene.rays.size()),
                  [&] { sink = sink + std::size_t(all.cast_rays(scene.rays, hits).code); },
                  {}});
  rays.push_back(
      {"brute force", double(few(scene.rays.size())), [&] { cast_rays(brute, few(scene.rays.size())); }, {}});
  const auto cast_shapes = [&](const World& world, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) sink = sink + world.cast_shape(scene.casts[i]).has_value();
  };
  casts.push_back(
      {"one by one", double(scene.casts.size()), [&] { cast_shapes(one, scene.casts.size()); }, {}});
  casts.push_back(
      {"batch, all workers",
       double(scene.casts.size()),
       [&] {
         sink =
             sink + std::size_t(all.cast_shapes(scene.casts, std::span(hits).first(scene.casts.size())).code);
       },
       {}});
  casts.push_back({"brute force",
                   double(few(scene.casts.size())),
                   [&] { cast_shapes(brute, few(scene.casts.size())); },
                   {}});
  const auto count_overlaps = [&](const World& world, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) sink = sink + world.find_overlaps(scene.places[i], {});
  };
  overlaps.push_back(
      {"one by one", double(scene.places.size()), [&] { count_overlaps(one, scene.places.size()); }, {}});
  overlaps.push_back({"batch, all workers",
                      double(scene.places.size()),
                      [&] { sink = sink + std::size_t(all.count_overlaps(scene.places, counts).code); },
                      {}});
  overlaps.push_back({"brute force",
                      double(few(scene.places.size())),
                      [&] { count_overlaps(brute, few(scene.places.size())); },
                      {}});
  const auto box_at = [](const ShapePlace& place) { return ShapePlace{Box{{1, 1, 1}}, place.pose}; };
  std::vector<ShapePlace> box_places;
  for (const ShapePlace& place : scene.places) box_places.push_back(box_at(place));
  boxes.push_back({"one by one",
                   double(box_places.size()),
                   [&] {
                     for (const ShapePlace& place : box_places) sink = sink + one.find_overlaps(place, {});
                   },
                   {}});
  boxes.push_back({"batch, all workers",
                   double(box_places.size()),
                   [&] { sink = sink + std::size_t(all.count_overlaps(box_places, counts).code); },
                   {}});
  boxes.push_back({"brute force",
                   double(few(box_places.size())),
                   [&] {
                     for (std::size_t i = 0; i < few(box_places.size()); ++i)
                       sink = sink + brute.find_overlaps(box_places[i], {});
                   },
                   {}});
#if defined(GYRE_HAVE_BULLET)
  BulletWorld other(scene);
  // Bullet's rays do not see a box that they start in, and meet what they pass by centimetres, the more the longer they are.
  std::size_t differ = 0, near_misses = 0;
  for (const Ray& ray : scene.rays) {
    const std::optional<CastHit> hit = one.cast_ray(ray.origin, ray.way);
    if ((hit && hit->inside) || other.ray(ray) == hit.has_value()) continue;
    ++(one.shape_hits({Sphere{0.01f}, {ray.origin, {}}, ray.way}) ? near_misses : differ);
  }
  std::printf("of %zu rays %zu meet something in only one engine, %zu more pass something within 1 cm\n",
              scene.rays.size(), differ, near_misses);
  rays.push_back({"Bullet",
                  double(scene.rays.size()),
                  [&] {
                    for (const Ray& ray : scene.rays) sink = sink + other.ray(ray);
                  },
                  {}});
  casts.push_back({"Bullet",
                   double(scene.casts.size()),
                   [&] {
                     for (const ShapeCast& cast : scene.casts) sink = sink + other.ball(cast);
                   },
                   {}});
  overlaps.push_back({"Bullet",
                      double(scene.places.size()),
                      [&] {
                        for (const ShapePlace& place : scene.places) sink = sink + other.overlaps(place);
                      },
                      {}});
  boxes.push_back({"Bullet",
                   double(scene.places.size()),
                   [&] {
                     for (const ShapePlace& place : scene.places) sink = sink + other.overlaps(place, true);
                   },
                   {}});
#endif
#if defined(GYRE_HAVE_BOX3D)
  const Box3dWorld third(scene);
  std::size_t different = 0;
  for (const Ray& ray : scene.rays) {
    const std::optional<CastHit> hit = one.cast_ray(ray.origin, ray.way);
    different += !(hit && hit->inside) && third.ray(ray) != hit.has_value();
  }
  std::printf("of %zu rays %zu meet something in only one of Gyre and Box3D\n", scene.rays.size(), different);
  const b3Vec3 middle[1] = {{0, 0, 0}};
  std::vector<b3Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  rays.push_back({"Box3D",
                  double(scene.rays.size()),
                  [&] {
                    for (const Ray& ray : scene.rays) sink = sink + third.ray(ray);
                  },
                  {}});
  casts.push_back({"Box3D",
                   double(scene.casts.size()),
                   [&] {
                     for (const ShapeCast& cast : scene.casts) sink = sink + third.ball(cast);
                   },
                   {}});
  overlaps.push_back({"Box3D",
                      double(scene.places.size()),
                      [&] {
                        for (const ShapePlace& place : scene.places)
                          sink = sink + third.overlaps(place, middle, 1.0f);
                      },
                      {}});
  boxes.push_back({"Box3D",
                   double(scene.places.size()),
                   [&] {
                     for (const ShapePlace& place : scene.places)
                       sink = sink + third.overlaps(place, corners, 0.0f);
                   },
                   {}});
#endif
  measure("rays", rays, rounds);
  measure("moving balls", casts, rounds);
  measure("overlaps of a ball", overlaps, rounds);
  measure("overlaps of a box", boxes, rounds);
}
