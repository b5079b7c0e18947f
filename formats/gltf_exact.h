// Bodies, shapes and joints of glTF files that Gyre wrote, exactly as they stood in the scene file (`extras.gyre`).
//
// In: the objects `exact`, collected while a file is read. Out: the scene as JSON with them in place.
#pragma once

#include "scene/json_document.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gyre {

class GltfExact {
 public:
  void set_scene(const Json& exact, bool has_materials) {
    scene_ = exact;
    has_materials_ = has_materials;
  }
  void add_body(int body, const Json& exact) { bodies_.push_back({body, exact}); }
  // `mesh`: the number of the shape's mesh in the scene, or -1.
  void add_shape(int body, std::size_t shape, int mesh, const Json& gyre) {
    shapes_.push_back({body, shape, mesh, gyre});
  }
  // `index`: its place among the joints.
  void add_joint(std::int64_t index, const Json& exact) { joints_.push_back({index, exact}); }
  bool empty() const { return bodies_.empty() && shapes_.empty() && joints_.empty() && scene_.empty(); }

  void put_into(Json& scene) const;

 private:
  struct Shape {
    int body;
    std::size_t shape;
    int mesh;
    Json gyre;
  };
  void put_materials(Json& scene) const;

  Json scene_ = Json::object();
  bool has_materials_ = false;
  std::vector<std::pair<int, Json>> bodies_;
  std::vector<Shape> shapes_;
  std::vector<std::pair<std::int64_t, Json>> joints_;
};

}  // namespace gyre
