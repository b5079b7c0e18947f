// Makes glTF 2.0 files. The format: Khronos Group, "glTF 2.0 Specification". See gltf_builder.h.
#include "formats/gltf_builder.h"

#include "scene/number_text.h"

#include <cmath>

namespace gyre {
namespace {

constexpr int kFloatComponents = 5126, kShortIndices = 5123, kLongIndices = 5125;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

double linear_of(std::uint8_t part) {
  const double encoded = double(part) / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace

Json gltf_number(float value) {
  std::string text;
  append_number(text, value);
  double out = double(value);
  parse_number(text, out);
  return out;
}
Json gltf_numbers(Vec3 v) { return Json::array({gltf_number(v.x), gltf_number(v.y), gltf_number(v.z)}); }
Json gltf_numbers(Quat q) {
  return Json::array({gltf_number(q.x), gltf_number(q.y), gltf_number(q.z), gltf_number(q.w)});
}

ShapeMesh ground_mesh() {
  ShapeMesh out;
  for (const auto& [x, z] : {std::pair{-50.0f, -50.0f}, {-50.0f, 50.0f}, {50.0f, 50.0f}, {50.0f, -50.0f}})
    out.vertices.push_back({{x, 0, z}, {0, 1, 0}});
  out.indices = {0, 1, 2, 0, 2, 3};
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

GltfBuilder::GltfBuilder() {
  json_["asset"] = {{"version", "2.0"}, {"generator", "gyre"}};
  json_["scene"] = 0;
  json_["scenes"] = Json::array({{{"nodes", Json::array()}}});
  json_["nodes"] = Json::array();
}

int GltfBuilder::add_node(Json node) {
  json_["nodes"].push_back(std::move(node));
  return int(json_["nodes"].size()) - 1;
}

int GltfBuilder::add_accessor(std::string_view bytes, int component, std::size_t count, const char* type,
                              int target) {
  Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  json_["bufferViews"].push_back(std::move(view));
  binary_ += bytes;
  while (binary_.size() % 4 != 0) binary_ += '\0';
  json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                {"componentType", component},
                                {"count", count},
                                {"type", type}});
  return int(json_["accessors"].size()) - 1;
}

int GltfBuilder::add_vectors(std::span<const Vec3> vectors, bool bounds) {
  std::string bytes;
  bytes.reserve(12 * vectors.size());
  Vec3 low = vectors.empty() ? Vec3{} : vectors[0], high = low;
  for (const Vec3 v : vectors) {
    append_little(bytes, v.x), append_little(bytes, v.y), append_little(bytes, v.z);
    low = min(low, v);
    high = max(high, v);
  }
  const int out = add_accessor(bytes, kFloatComponents, vectors.size(), "VEC3", bounds ? kVertexTarget : 0);
  if (bounds) {
    json_["accessors"].back()["min"] = gltf_numbers(low);
    json_["accessors"].back()["max"] = gltf_numbers(high);
  }
  return out;
}

int GltfBuilder::add_indices(std::span<const std::uint32_t> indices, std::size_t vertices) {
  const bool is_long = vertices > 65535;
  std::string bytes;
  bytes.reserve((is_long ? 4 : 2) * indices.size());
  for (const std::uint32_t index : indices) {
    if (is_long) {
      append_little(bytes, index);
    } else {
      bytes += char(index & 0xffu);
      bytes += char(index >> 8 & 0xffu);
    }
  }
  return add_accessor(bytes, is_long ? kLongIndices : kShortIndices, indices.size(), "SCALAR", kIndexTarget);
}

int GltfBuilder::add_floats(std::span<const float> values, std::size_t width, bool bounds) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const float value : values) append_little(bytes, value);
  const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const int out = add_accessor(bytes, kFloatComponents, values.size() / width, types[width], 0);
  if (bounds && !values.empty()) {
    float low = values[0], high = values[0];
    for (const float value : values) low = min(low, value), high = max(high, value);
    json_["accessors"].back()["min"] = Json::array({gltf_number(low)});
    json_["accessors"].back()["max"] = Json::array({gltf_number(high)});
  }
  return out;
}

int GltfBuilder::color_material(SceneColor color) {
  const std::uint32_t key =
      std::uint32_t(color.red) << 16 | std::uint32_t(color.green) << 8 | std::uint32_t(color.blue);
  const auto [found, is_new] = materials_.try_emplace(key, int(materials_.size()));
  if (is_new) {
    const auto part = [](std::uint8_t value) { return gltf_number(float(linear_of(value))); };
    json_["materials"].push_back(
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", Json::array({part(color.red), part(color.green), part(color.blue), 1})},
           {"metallicFactor", 0},
           {"roughnessFactor", gltf_number(0.8f)}}},
         {"doubleSided", true}});
  }
  return found->second;
}

Json GltfBuilder::triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                            SceneColor color) {
  return {{"attributes", {{"POSITION", add_vectors(vertices, true)}}},
          {"indices", add_indices(indices, vertices.size())},
          {"material", color_material(color)}};
}

Json GltfBuilder::triangles(const ShapeMesh& mesh, SceneColor color) {
  std::vector<Vec3> positions, normals;
  for (const MeshVertex& vertex : mesh.vertices) {
    positions.push_back(vertex.position);
    normals.push_back(vertex.normal);
  }
  Json out = triangles(positions, mesh.indices, color);
  out["attributes"]["NORMAL"] = add_vectors(normals, false);
  json_["bufferViews"].back()["target"] = kVertexTarget;
  return out;
}

std::string GltfBuilder::take(bool binary) {
  if (!binary_.empty()) {
    Json buffer{{"byteLength", binary_.size()}};
    if (!binary) buffer["uri"] = "data:application/octet-stream;base64," + base64(binary_);
    json_["buffers"] = Json::array({std::move(buffer)});
  }
  if (!binary) return json_.dump(1) + "\n";
  std::string text = json_.dump();
  while (text.size() % 4 != 0) text += ' ';
  std::string out = "glTF";
  const std::size_t chunk = binary_.empty() ? 0 : 8 + binary_.size();
  append_little(out, std::uint32_t(2));
  append_little(out, std::uint32_t(20 + text.size() + chunk));
  append_little(out, std::uint32_t(text.size()));
  out += "JSON" + text;
  if (chunk == 0) return out;
  append_little(out, std::uint32_t(binary_.size()));
  out += std::string("BIN\0", 4);
  return out + binary_;
}

}  // namespace gyre
