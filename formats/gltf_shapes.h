// Shapes of KHR_implicit_shapes and meshes of glTF to shapes of a scene.
#pragma once

#include "formats/gltf_document.h"

#include <optional>

namespace gyre {

// A node's place taken apart: rotation, and scale along its axes. A mirrored node has a negative scale along x.
struct GltfPlace {
  Pose pose{};
  Vec3 scale{1, 1, 1};
};
GltfPlace place_of(const GltfNode& node);

class GltfShapes {
 public:
  GltfShapes(Import& import, GltfDocument& document) : import_(import), document_(document) {}

  // The shape that a collider or trigger names, at the node, in the frame of the body. None: left out.
  std::optional<SceneShape> shape_of(const Json& collider, int node, const Pose& body, bool moving,
                                     const std::string& pointer);
  // The triangles of a mesh at a node, in the frame of the body; the index of the mesh in the scene.
  int mesh_at(std::int64_t mesh, int node, const Pose& body);

 private:
  const Json& implicit_shape(std::int64_t index, const std::string& pointer) const;
  std::optional<SceneGeometry> implicit_geometry(const Json& shape, Vec3 scale, bool moving,
                                                 const std::string& pointer);
  SceneGeometry mesh_geometry(std::int64_t mesh, int node, const Pose& body, bool moving, bool hull);

  Import& import_;
  GltfDocument& document_;
};

}  // namespace gyre
