// Shapes of KHR_implicit_shapes and meshes of glTF to shapes of a scene.
#pragma once

#include "formats/gltf_document.h"

#include <map>
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

  // The body that a shape is made for: its node, its pose, and whether it is dynamic.
  struct Owner {
    int node = 0;
    Pose pose{};
    bool moving = false;
  };
  // The shape that a collider or trigger names, at the node, in the frame of the body. None: left out.
  std::optional<SceneShape> shape_of(const Json& collider, int node, const Owner& owner,
                                     const std::string& pointer);
  // The frame of a node in that of the body.
  Transform local_at(int node, const Owner& owner) const;
  // The triangles of a mesh at a node, in the frame of the body: the index of the mesh in the scene. `local` becomes the frame of these
  // triangles. It is the identity where the node has a scale.
  int mesh_at(std::int64_t mesh, int node, const Owner& owner, Transform& local);
  // The index in the scene of a mesh as it stands in the file.
  int plain_mesh(std::int64_t mesh, const std::string& name);

 private:
  const Json& implicit_shape(std::int64_t index, const std::string& pointer) const;
  std::optional<SceneGeometry> implicit_geometry(const Json& shape, Vec3 scale, bool moving,
                                                 const std::string& pointer);

  Import& import_;
  GltfDocument& document_;
  std::map<std::int64_t, int> plain_meshes_;
};

}  // namespace gyre
