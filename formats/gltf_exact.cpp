// Exact members of glTF files. See gltf_exact.h.
#include "formats/gltf_exact.h"

#include <algorithm>
#include <set>

namespace gyre {
namespace {

void set_members(Json& object, const Json& members) {
  for (const auto& [key, value] : members.items()) object[key] = value;
}

// The object with the named members alone.
Json with_members(const Json& object, std::initializer_list<const char*> names) {
  Json out = Json::object();
  for (const char* name : names) {
    if (object.contains(name)) out[name] = object[name];
  }
  return out;
}

}  // namespace

// The exact materials and pairs; of the others only those that a shape still names.
void GltfExact::put_materials(Json& scene) const {
  std::set<std::string> used;
  for (const Json& body : scene["bodies"]) {
    for (const Json& shape : body["shapes"]) {
      if (shape.contains("material") && shape["material"].is_string())
        used.insert(shape["material"].get<std::string>());
    }
  }
  Json materials = Json::object();
  if (scene_.contains("materials") && scene_["materials"].is_object()) materials = scene_["materials"];
  if (scene.contains("materials")) {
    for (const auto& [name, material] : scene["materials"].items()) {
      if (!materials.contains(name) && used.count(name) != 0) materials[name] = material;
    }
  }
  scene.erase("material_pairs");
  scene["materials"] = std::move(materials);
  if (scene_.contains("material_pairs")) scene["material_pairs"] = scene_["material_pairs"];
}

void GltfExact::put_into(Json& scene) const {
  std::vector<std::string> mesh_names;
  if (scene.contains("meshes")) {
    for (const auto& entry : scene["meshes"].items()) mesh_names.push_back(entry.key());
  }
  for (const Shape& at : shapes_) {
    Json& shape = scene["bodies"][std::size_t(at.body)]["shapes"][at.shape];
    Json out = with_members(shape, {"position", "orientation"});
    set_members(out, with_members(at.gyre, {"position", "orientation"}));
    set_members(out, at.gyre["exact"]);
    if (at.mesh >= 0) out["mesh"] = mesh_names[std::size_t(at.mesh)];
    shape = std::move(out);
  }
  for (const auto& [body, exact] : bodies_) {
    Json& at = scene["bodies"][std::size_t(body)];
    Json out = with_members(at, {"name", "position", "orientation", "shapes"});
    for (const auto& [key, value] : exact.items()) {
      if (!out.contains(key) && key != "position" && key != "orientation") out[key] = value;
    }
    at = std::move(out);
  }
  if (!joints_.empty()) {
    std::vector<std::pair<std::int64_t, Json>> joints = joints_;
    std::stable_sort(joints.begin(), joints.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    Json list = Json::array();
    for (auto& [index, joint] : joints) list.push_back(std::move(joint));
    if (scene.contains("joints")) {
      for (const Json& joint : scene["joints"]) list.push_back(joint);
    }
    scene["joints"] = std::move(list);
  }
  if (has_materials_) put_materials(scene);
  for (const auto& [key, value] : scene_.items()) {
    if (key == "materials" || key == "material_pairs" || key == "bodies" || key == "joints" ||
        key == "gyre_scene" || key == "name")
      continue;
    if (key != "meshes") {
      scene[key] = value;
    } else if (value.is_object()) {
      for (const auto& [name, mesh] : value.items()) scene["meshes"][name] = mesh;
    }
  }
}

}  // namespace gyre
