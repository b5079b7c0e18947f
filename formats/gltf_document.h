// A glTF document: JSON, its buffers and nodes, every access checked. Errors name the place as a JSON pointer.
#pragma once

#include "formats/import_parts.h"
#include "scene/scene_fields.h"

#include <optional>
#include <string>
#include <vector>

namespace gyre {

// A node of the chosen scene, in the world.
struct GltfNode {
  int parent = -1;
  std::string name;
  Mat3 linear{};        // world_from_node without its translation: rotation and scale
  DVec3 translation{};  // m
  std::vector<int> children{};
  // Of nodes without scale, as the file gives it: with respect to the parent, and in the world if no node above has a scale.
  std::optional<Transform> local{};
  std::optional<Pose> pose{};
};

class GltfDocument {
 public:
  explicit GltfDocument(Import& import);

  const Json& json() const { return json_; }
  const std::vector<GltfNode>& nodes() const { return nodes_; }
  // The numbers of the nodes of the scene, parents before children.
  const std::vector<int>& order() const { return order_; }
  // The object nodes[node].extensions[name]; null if there is none.
  const Json* extension(int node, const char* name) const;
  const Json* root_extension(const char* name) const;
  // The object nodes[node].extras.gyre[name] of a file that Gyre wrote; null if there is none.
  const Json* gyre_extras(int node, const char* name) const;
  // The frame of a node in that of a node above it, or of itself; none if there is a scale between them.
  std::optional<Transform> rigid_between(int above, int node) const;

  // All triangles of a mesh, in the frame of its node. Null indices are an error.
  MeshData mesh_data(std::int64_t mesh);
  std::optional<SceneColor> mesh_color(int node) const;

  [[noreturn]] void fail(const std::string& pointer, const std::string& message) const;

 private:
  void open();
  void read_nodes();
  void place_node(int node, int parent, const Json& json, const std::string& pointer);
  const std::string& buffer(std::int64_t index);
  std::vector<double> accessor(std::int64_t index, std::size_t width, const char* type);
  const Json& element(const char* section, std::int64_t index) const;

  Import& import_;
  Json json_;
  std::string binary_;  // the second chunk of a .glb
  bool has_binary_ = false;
  std::vector<std::optional<std::string>> buffers_;
  std::vector<GltfNode> nodes_;
  std::vector<int> order_;
};

// Members of objects that may be absent.
std::int64_t json_integer(const Json& object, const char* key, std::int64_t otherwise);
// Finite numbers, in size at most `most`.
constexpr double kLargestGltfNumber = 1.0e12;
constexpr double kLargestGltfMass =
    1.0e37;  // kg; also of moments of inertia, stiffness, damping and forces, which scale with masses
double json_number(const Json& object, const char* key, double otherwise, double most = kLargestGltfNumber);
bool json_flag(const Json& object, const char* key, bool otherwise);
std::string json_text(const Json& object, const char* key, const std::string& otherwise);
std::vector<double> json_numbers(const Json& object, const char* key, std::size_t count,
                                 double most = kLargestGltfNumber);
const Json* json_member(const Json& object, const char* key);

}  // namespace gyre
