// Makes a glTF 2.0 file: the JSON of the document, its binary buffer, and accessors, materials and meshes in them.
//
// In: numbers and triangles. Out: the text of a .gltf file, with the buffer in it as base64, or the bytes of a .glb file.
#pragma once

#include "formats/shape_mesh.h"
#include "scene/json_document.h"
#include "scene/scene.h"

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gyre {

// Numbers as the shortest text that reads back as the same float.
Json gltf_number(float value);
Json gltf_numbers(Vec3 v);
Json gltf_numbers(Quat q);

class GltfBuilder {
 public:
  GltfBuilder();

  Json& json() { return json_; }
  // The number of the node.
  int add_node(Json node);
  void add_child(int parent, int child) { json_["nodes"][std::size_t(parent)]["children"].push_back(child); }

  // The number of the accessor.
  int add_vectors(std::span<const Vec3> vectors, bool bounds);
  int add_indices(std::span<const std::uint32_t> indices, std::size_t vertices);
  int add_floats(std::span<const float> values, std::size_t width, bool bounds);

  int color_material(SceneColor color);
  int add_mesh(Json primitive) {
    json_["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
    return int(json_["meshes"].size()) - 1;
  }
  // A mesh of bare triangles, which viewers draw with flat faces.
  Json triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices, SceneColor color);
  Json triangles(const ShapeMesh& mesh, SceneColor color);

  std::string take(bool binary);

 private:
  int add_accessor(std::string_view bytes, int component, std::size_t count, const char* type, int target);

  Json json_;
  std::string binary_;
  std::map<std::uint32_t, int> materials_;
};

// Appends a number's bytes, lowest first.
template <class T>
void append_little(std::string& out, T value) {
  static_assert(sizeof(T) == 4);
  const std::uint32_t bits = __builtin_bit_cast(std::uint32_t, value);
  for (int i = 0; i < 4; ++i) out += char(bits >> (8 * i) & 0xffu);
}

// A square of 100 m around the origin, facing up: planes, which have no end, are shown as it.
ShapeMesh ground_mesh();

std::string base64(std::string_view bytes);

}  // namespace gyre
