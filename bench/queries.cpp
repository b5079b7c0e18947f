// Rays, moving balls, overlaps, closest points and ways out of overlap a second in a world of 10,000 boxes over a terrain of
// triangles: one by one, in batches over one worker, two and all, by brute force, by Bullet where its headers are at hand, by Box3D
// where BOX3D_ROOT names a folder with its headers (include/) and its library (libbox3d.a), and by Jolt where GYRE_JOLT names its
// built source (bench/peers).
//
//   bench/queries [rounds [question]]      question: the first letters of those to be asked, such as 'moving'
//
// Everything is measured in turn, round after round, so that what else the machine does falls on all alike. Printed are the
// median of the rounds, and ratios to Gyre's single queries as the median of the ratios within a round, with half the distance
// between their quartiles as the error: by the time of the processors, and by the clock on the wall.
#include <gyre/gyre.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#if defined(GYRE_HAVE_BULLET)
#include <btBulletCollisionCommon.h>
#endif
#if defined(GYRE_HAVE_BOX3D)
#include <box3d/box3d.h>
#endif
#if defined(GYRE_HAVE_JOLT)
#include "bench/peers/jolt_queries.h"
#endif

namespace {

using namespace gyre;

constexpr int kBoxes = 10000;
constexpr int kSide = 128;         // cells of the terrain
constexpr float kHalfWorld = 100;  // m
constexpr std::size_t kRoom = 16;  // answers kept where all are asked for

struct Scene {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<Pose> boxes;
  std::vector<Ray> rays;
  std::vector<ShapeCast> casts;
  std::vector<ShapePose> places;
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

struct Row {
  std::string name;
  double count = 0;
  std::function<void()> work;
  std::vector<double> times;  // s a query, round after round: of the clock on the wall
  std::vector<double>
      processor;  // and of all processors together, which other work on the machine does not lengthen
};

void time_round(Row& row, bool kept) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t begin_processor = std::clock();
  row.work();
  const double processor = double(std::clock() - begin_processor) / double(CLOCKS_PER_SEC);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!kept) return;
  row.times.push_back(wall / row.count);
  row.processor.push_back(processor / row.count);
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::size_t(share * double(values.size() - 1) + 0.5)];
}

struct Ratio {
  double middle, error;
};
Ratio ratio(const std::vector<double>& first, const std::vector<double>& second) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < first.size(); ++i) ratios.push_back(first[i] / second[i]);
  return {quantile(ratios, 0.5), 0.5 * (quantile(ratios, 0.75) - quantile(ratios, 0.25))};
}

// The first row of a group is what the others are compared with.
void measure(const char* what, std::vector<Row>& rows, int rounds) {
  for (int round = -1; round < rounds; ++round) {
    for (Row& row : rows) time_round(row, round >= 0);
  }
  std::printf("%s\n", what);
  for (const Row& row : rows) {
    const Ratio wall = ratio(rows[0].times, row.times), processor = ratio(rows[0].processor, row.processor);
    std::printf("  %-20s %10.0f a second of a processor, x %.3g +- %.2g; on the wall x %.3g +- %.2g\n",
                row.name.c_str(), 1.0 / quantile(row.processor, 0.5), processor.middle, processor.error,
                wall.middle, wall.error);
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
    const btVector3 from = bullet(ray.origin), to = bullet(ray.origin + ray.translation);
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    world_.rayTest(from, to, hit);
    return hit.hasHit();
  }
  bool ball(const ShapeCast& cast) {
    const btVector3 from = bullet(cast.pose.position), to = bullet(cast.pose.position + cast.translation);
    btCollisionWorld::ClosestConvexResultCallback hit(from, to);
    world_.convexSweepTest(&small_ball_, btTransform(btQuaternion::getIdentity(), from),
                           btTransform(btQuaternion::getIdentity(), to), hit);
    return hit.hasHit();
  }
  std::size_t overlaps(const ShapePose& place, bool box = false) {
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
    return b3World_CastRayClosest(world_, box3d(ray.origin), box3d(DVec3(ray.translation)), b3DefaultQueryFilter())
        .hit;
  }
  bool ball(const ShapeCast& cast) const {
    const b3Vec3 middle{0, 0, 0};
    const b3ShapeProxy proxy{&middle, 1, 0.5f};
    float nearest = 1.0f;
    b3World_CastShape(
        world_, box3d(cast.pose.position), &proxy, box3d(DVec3(cast.translation)), b3DefaultQueryFilter(),
        [](b3ShapeId, b3Pos, b3Vec3, float fraction, uint64_t, int, int, void* context) {
          *static_cast<float*>(context) = fraction;
          return fraction;
        },
        &nearest);
    return nearest < 1.0f;
  }
  std::size_t overlaps(const ShapePose& place, std::span<const b3Vec3> points, float radius) const {
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

#if defined(GYRE_HAVE_JOLT)
bench::JoltQueries make_jolt(const Scene& scene) {
  std::vector<bench::JoltBox> boxes;
  for (const Pose& pose : scene.boxes) {
    const DVec3 p = pose.position;
    const Quat q = pose.orientation;
    boxes.push_back({{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}});
  }
  return bench::JoltQueries({&scene.vertices[0].x, 3 * scene.vertices.size()},
                            {&scene.indices[0], scene.indices.size()}, boxes);
}
#endif

// The rows of one question: asked one by one, in batches, by brute force, and of others.
class Bench {
 public:
  Bench(int rounds, std::string wanted) : rounds_(rounds), wanted_(std::move(wanted)) {}
  void run() {
    const std::size_t n = scene_.places.size();
    ask(
        "rays", scene_.rays.size(),
        [&](const World& w, std::size_t i) {
          return w.cast_ray(scene_.rays[i].origin, scene_.rays[i].translation).has_value();
        },
        [&](const World& w) { return w.cast_ray_batch(scene_.rays, hits_); });
#if defined(GYRE_HAVE_BULLET)
    other("Bullet", scene_.rays.size(), [&](std::size_t i) { return bullet_.ray(scene_.rays[i]); });
#endif
#if defined(GYRE_HAVE_BOX3D)
    other("Box3D", scene_.rays.size(), [&](std::size_t i) { return box3d_.ray(scene_.rays[i]); });
#endif
#if defined(GYRE_HAVE_JOLT)
    other("Jolt", scene_.rays.size(),
          [&](std::size_t i) { return jolt_.ray(&scene_.rays[i].origin.x, &scene_.rays[i].translation.x); });
#endif
    finish();
    ask(
        "rays, all hits", scene_.rays.size(),
        [&](const World& w, std::size_t i) {
          return w.cast_ray_all(scene_.rays[i].origin, scene_.rays[i].translation, all_hits_);
        },
        [&](const World& w) { return w.cast_ray_all_batch(scene_.rays, many_hits_, ray_counts_); });
    finish();
    ask(
        "rays, any hit", scene_.rays.size(),
        [&](const World& w, std::size_t i) {
          return std::size_t(w.cast_ray_any(scene_.rays[i].origin, scene_.rays[i].translation));
        },
        [&](const World& w) { return w.cast_ray_any_batch(scene_.rays, any_); });
    finish();
    ask(
        "moving balls", n,
        [&](const World& w, std::size_t i) { return w.cast_shape(scene_.casts[i]).has_value(); },
        [&](const World& w) { return w.cast_shape_batch(scene_.casts, std::span(hits_).first(n)); });
#if defined(GYRE_HAVE_BULLET)
    other("Bullet", n, [&](std::size_t i) { return bullet_.ball(scene_.casts[i]); });
#endif
#if defined(GYRE_HAVE_BOX3D)
    other("Box3D", n, [&](std::size_t i) { return box3d_.ball(scene_.casts[i]); });
#endif
#if defined(GYRE_HAVE_JOLT)
    other("Jolt", n, [&](std::size_t i) {
      return jolt_.ball(&scene_.casts[i].pose.position.x, &scene_.casts[i].translation.x, 0.5f);
    });
#endif
    finish();
    ask(
        "moving balls, all hits", n,
        [&](const World& w, std::size_t i) { return w.cast_shape_all(scene_.casts[i], all_hits_); },
        [&](const World& w) {
          return w.cast_shape_all_batch(scene_.casts, std::span(many_hits_).first(kRoom * n), counts_);
        });
    finish();
    overlaps("overlaps of a ball", scene_.places, false);
    std::vector<ShapePose> cubes;
    for (const ShapePose& place : scene_.places) cubes.push_back({Box{{1, 1, 1}}, place.pose});
    overlaps("overlaps of a box", cubes, true);
    ask(
        "closest points within 5 m of a ball", n,
        [&](const World& w, std::size_t i) { return w.closest_point(scene_.places[i], 5.0).has_value(); },
        [&](const World& w) { return w.closest_point_batch(scene_.places, 5.0, closest_); });
    finish();
    ask(
        "all shapes within 5 m of a ball", n,
        [&](const World& w, std::size_t i) { return w.closest_point_all(scene_.places[i], 5.0, near_); },
        [&](const World& w) { return w.closest_point_all_batch(scene_.places, 5.0, many_near_, counts_); });
    finish();
    ask(
        "ways out of overlap of a box", n,
        [&](const World& w, std::size_t i) { return w.penetration_all(cubes[i], deep_); },
        [&](const World& w) { return w.penetration_all_batch(cubes, many_deep_, counts_); });
    finish();
  }

 private:
  using One = std::function<std::size_t(const World&, std::size_t)>;
  using Batch = std::function<Error(const World&)>;

  void ask(const char* what, std::size_t count, const One& one, const Batch& batch) {
    what_ = what;
    rows_.clear();
    const auto singly = [one](const World& world, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) sink = sink + one(world, i);
    };
    const std::size_t few = std::max<std::size_t>(count / 40, 1);  // of what takes long
    rows_.push_back({"one by one", double(count), [this, singly, count] { singly(one_, count); }, {}, {}});
    if (batch) {
      const auto together = [&](const char* name, const World& world) {
        rows_.push_back(
            {name, double(count), [batch, &world] { sink = sink + std::size_t(batch(world).code); }, {}, {}});
      };
      together("batch, one worker", one_);
      together("batch, two workers", two_);
      together("batch, all workers", all_);
    }
    rows_.push_back({"brute force", double(few), [this, singly, few] { singly(brute_, few); }, {}, {}});
  }
  void overlaps(const char* what, const std::vector<ShapePose>& places, bool cube) {
    const std::size_t n = places.size();
    ask(
        what, n, [&](const World& w, std::size_t i) { return w.overlap_all(places[i], {}); },
        [&](const World& w) { return w.overlap_count_batch(places, counts_); });
    static_cast<void>(cube);
#if defined(GYRE_HAVE_BULLET)
    other("Bullet", n, [&, cube](std::size_t i) { return bullet_.overlaps(places[i], cube); });
#endif
#if defined(GYRE_HAVE_BOX3D)
    std::vector<b3Vec3> points(1, b3Vec3{0, 0, 0});
    if (cube) points.clear();
    for (int i = 0; i < (cube ? 8 : 0); ++i)
      points.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
    other("Box3D", n, [&, points, cube](std::size_t i) {
      return box3d_.overlaps(places[i], points, cube ? 0.0f : 1.0f);
    });
#endif
#if defined(GYRE_HAVE_JOLT)
    other("Jolt", n,
          [&, cube](std::size_t i) { return jolt_.overlaps(&places[i].pose.position.x, 1.0f, cube); });
#endif
    finish();
  }
  template <class Fn>
  void other(const char* name, std::size_t count, Fn fn) {
    const auto all = [fn, count] {
      std::size_t met = 0;
      for (std::size_t i = 0; i < count; ++i) met += std::size_t(fn(i));
      sink = sink + met;
      return met;
    };
    found_.push_back({name, all()});
    rows_.push_back({name, double(count), [all] { all(); }, {}, {}});
  }
  void finish() {
    const bool asked = std::string(what_).starts_with(wanted_);
    if (asked) measure(what_, rows_, rounds_);
    if (asked && !found_.empty()) {
      // That all answer the same question: how much each of them met.
      const std::size_t before = sink;
      rows_[0].work();
      std::printf("  met: Gyre %zu", sink - before);
      for (const auto& [name, count] : found_) std::printf(", %s %zu", name, count);
      std::printf("\n");
    }
    found_.clear();
  }

  int rounds_;
  std::string wanted_;
  const Scene scene_ = make_scene();
  const World one_ = make_world(scene_, BroadPhaseKind::bvh, 1),
              two_ = make_world(scene_, BroadPhaseKind::bvh, 2),
              all_ = make_world(scene_, BroadPhaseKind::bvh, 0);
  const World brute_ = make_world(scene_, BroadPhaseKind::brute_force, 1);
#if defined(GYRE_HAVE_BULLET)
  BulletWorld bullet_{scene_};
#endif
#if defined(GYRE_HAVE_BOX3D)
  const Box3dWorld box3d_{scene_};
#endif
#if defined(GYRE_HAVE_JOLT)
  const bench::JoltQueries jolt_ = make_jolt(scene_);
#endif
  std::vector<CastHit> hits_ = std::vector<CastHit>(scene_.rays.size());
  std::vector<std::uint32_t> counts_ = std::vector<std::uint32_t>(scene_.places.size());
  std::vector<ClosestPoint> closest_ = std::vector<ClosestPoint>(scene_.places.size());
  std::array<Penetration, kRoom> deep_;
  std::array<CastHit, kRoom> all_hits_;
  std::array<ClosestPoint, kRoom> near_;
  std::vector<CastHit> many_hits_ = std::vector<CastHit>(kRoom * scene_.rays.size());
  std::vector<std::uint32_t> ray_counts_ = std::vector<std::uint32_t>(scene_.rays.size());
  std::vector<std::uint8_t> any_ = std::vector<std::uint8_t>(scene_.rays.size());
  std::vector<ClosestPoint> many_near_ = std::vector<ClosestPoint>(kRoom * scene_.places.size());
  std::vector<Penetration> many_deep_ = std::vector<Penetration>(kRoom * scene_.places.size());
  const char* what_ = "";
  std::vector<Row> rows_;
  std::vector<std::pair<const char*, std::size_t>> found_;
};

}  // namespace

int main(int count, char** arguments) {
  Bench(count > 1 ? std::max(1, std::atoi(arguments[1])) : 15, count > 2 ? arguments[2] : "").run();
}
