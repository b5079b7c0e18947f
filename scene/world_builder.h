// Fills a world with what a scene describes. What the engine refuses becomes an error that names the place in the scene.
#pragma once

#include "scene/scene.h"
#include "scene/scene_error.h"

#include <gyre/world.h>

#include <string>
#include <vector>

namespace gyre {

class WorldBuilder {
 public:
  WorldBuilder(const Scene& scene, World& world, const std::string& file)
      : scene_(scene), world_(world), file_(file) {}

  bool build();
  const SceneError& error() const { return error_; }
  std::vector<BodyId> take_bodies() { return std::move(bodies_); }
  std::vector<JointId> take_joints() { return std::move(joints_); }
  std::vector<CouplingId> take_couplings() { return std::move(couplings_); }
  std::vector<SoftId> take_ropes() { return std::move(ropes_); }
  std::vector<SoftId> take_cloths() { return std::move(cloths_); }
  std::vector<SoftId> take_soft_bodies() { return std::move(soft_bodies_); }
  std::vector<FluidId> take_gases() { return std::move(gases_); }
  std::vector<FluidId> take_liquids() { return std::move(liquids_); }
  std::vector<std::vector<DVec3>> take_anchors() { return std::move(anchors_); }
  std::vector<std::vector<int>> take_region_pins() { return std::move(region_pins_); }

 private:
  bool fail(std::string pointer, std::string message);
  std::string last_refusal() const;
  bool add_pairs();
  bool add_bodies();
  bool add_joints();
  bool add_couplings();
  bool add_fields();
  bool add_soft_matter();
  bool hold(const SceneSoft& soft, SoftId id, const std::string& pointer);
  bool hold_points(const SceneSoft& soft, SoftId id, const std::string& pointer);
  bool pin_region(const SceneSoftBody& solid, SoftId id, const std::string& pointer);
  bool blame_soft(const std::string& pointer, const SceneSoft& soft);
  bool add_fluids();
  bool make_shape(std::size_t body, std::size_t shape, ShapeDef& out);
  bool cook(const SceneHull& hull, const std::string& pointer, Geometry& out);
  bool cook(const SceneTriangles& mesh, const std::string& pointer, Geometry& out);
  bool cook(const SceneHeightField& field, const std::string& pointer, Geometry& out);
  void take_solid_mass(std::size_t body, const std::vector<ShapeDef>& shapes, BodyDef& def) const;
  Material surface_of(const SceneShape& shape) const;
  bool blame(std::size_t body, const BodyDef& def, const std::vector<ShapeDef>& shapes);

  const Scene& scene_;
  World& world_;
  const std::string& file_;
  SceneError error_;
  std::vector<BodyId> bodies_;
  std::vector<JointId> joints_;
  std::vector<CouplingId> couplings_;
  std::vector<SoftId> ropes_, cloths_, soft_bodies_;
  std::vector<FluidId> gases_, liquids_;
  std::vector<std::vector<int>> region_pins_;
  std::vector<std::vector<DVec3>> anchors_;  // by index of the id: of held points, m, in the frame of what holds them
  std::vector<Geometry> mesh_cache_, hull_cache_;  // by mesh
};

}  // namespace gyre
