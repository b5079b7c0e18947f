// A small hand-made world for tests of the narrow-phase stage: bodies with one shape each.
#pragma once

#include "collision/broadphase/broadphase.h"
#include "collision/broadphase/fat_box.h"
#include "collision/contact/collide.h"
#include "collision/contact/contact_recycle.h"
#include "collision/contact/pair_update.h"

#include <vector>

namespace gyre {

class CollideScene {
 public:
  explicit CollideScene(int threads = 1) : tasks_(threads) {}

  // Returns the index of the body and its shape.
  std::uint32_t add(const AnyShape& geometry, const Pose& pose, bool awake = true,
                    const Transform& local = {}) {
    const auto index = std::uint32_t(bodies.size());
    ColliderShape shape;
    shape.shape = make_shape(geometry);
    shape.body_from_shape = local;
    shape.size = inner_radius(shape.shape);
    shapes.push_back(shape);
    ColliderBody body;
    body.pose = pose;
    body.center = local.position;
    body.bounding_radius = outer_radius(shape.shape, {});
    body.awake = awake;
    bodies.push_back(body);
    Proxy proxy;
    proxy.body = index;
    proxy.motion = awake ? ProxyMotion::moving : ProxyMotion::fixed;
    proxy.pushes = awake;
    proxies.push_back(proxy);
    return index;
  }

  BoxMotion motion_of(std::uint32_t i) const {
    const ColliderBody& body = bodies[i];
    return {shapes[i].size, seconds * body.linear_velocity,
            seconds * length(body.angular_velocity) * body.bounding_radius};
  }

  // Refits boxes, finds pairs, runs the stage, and removes contacts that have ended.
  void step() {
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      const WorldBox needed =
          needed_box(world_box(shapes[i].shape, bodies[i].pose * shapes[i].body_from_shape), motion_of(i));
      if (!fresh_ && !needs_refit(proxies[i].fat_box, needed, motion_of(i))) continue;
      proxies[i].fat_box = fat_box(needed, motion_of(i));
      changed.push_back(i);
    }
    fresh_ = false;
    broadphase_->update(proxies, changed);
    keys_.clear();
    broadphase_->find_pairs(proxies, changed, tasks_, keys_);
    add_pairs(store, keys_, blocked_, [&](std::uint64_t key) {
      PairShapes pair;
      pair.body_a = std::uint32_t(key >> 32);
      pair.body_b = std::uint32_t(key);
      const ShapeKind a = shapes[pair.body_a].shape.kind, b = shapes[pair.body_b].shape.kind;
      pair.against_mesh = a >= ShapeKind::mesh || b >= ShapeKind::mesh;
      pair.sensor = proxies[pair.body_a].sensor || proxies[pair.body_b].sensor;
      return pair;
    });
    update_contacts();
    remove_gone(store, changes.gone, [](std::uint32_t, const Contact&) {});
  }

  void update_contacts() {
    std::vector<CollisionBody> collision_bodies;
    std::vector<BodyCenter> centers;
    std::vector<std::uint8_t> awake;
    for (const ColliderBody& body : bodies) {
      collision_bodies.push_back(make_collision_body(body, seconds));
      centers.push_back({body.center, body.bounding_radius});
      awake.push_back(body.awake ? 1 : 0);
    }
    all_.resize(store.contacts.size());
    all_.set_all();
    collide(store, {shapes, collision_bodies, centers, awake, proxies, all_, select_recycling(width), recycle}, tasks_,
            changes);
  }

  // The contact of two shapes; null if there is none.
  Contact* contact(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t slot = find_contact(store, pair_key(a, b));
    return slot != SlotTable::kNone ? &store.contacts[slot] : nullptr;
  }
  // The only manifold of two shapes; a manifold without points if there is none.
  Manifold manifold(std::uint32_t a, std::uint32_t b) {
    const Contact* const found = contact(a, b);
    return found != nullptr && found->manifold_count > 0 ? store.manifolds[found->first_manifold]
                                                         : Manifold{};
  }

  std::vector<ColliderShape> shapes;
  std::vector<ColliderBody> bodies;
  std::vector<Proxy> proxies;
  ContactStore store;
  TouchChanges changes;
  float seconds = 1.0f / 60.0f;
  bool recycle = true;
  int width = 0;  // of recycling

 private:
  TaskSystem tasks_;
  std::unique_ptr<Broadphase> broadphase_ = make_broadphase(BroadPhaseKind::bvh);
  BlockedBodies blocked_;
  Array<std::uint64_t> keys_;
  Bitset all_;  // contacts
  bool fresh_ = true;
};

}  // namespace gyre
