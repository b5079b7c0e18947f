// glTF documents. The format: Khronos Group, "glTF 2.0 Specification". See gltf_document.h.
#include "formats/gltf_document.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gyre {
namespace {

// "1e12"
std::string power_of_ten(double value) { return "1e" + std::to_string(std::lround(std::log10(value))); }

constexpr std::size_t kMaxNodes = 1'000'000;

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 4; i-- > 0;) out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
  return out;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool decode_base64(std::string_view text, std::string& out) {
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int digit = base64_digit(c);
    if (digit < 0) return false;
    bits = (bits << 6 | std::uint32_t(digit)) & 0xffffffu;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += char(bits >> count & 0xffu);
  }
  return true;
}

std::string percent_decoded(const std::string& uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      out += char(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

struct Component {
  std::size_t size = 0;
  char kind = 'u';  // u, i or f
};

Component component_of(std::int64_t type) {
  switch (type) {
    case 5120:
      return {1, 'i'};
    case 5121:
      return {1, 'u'};
    case 5122:
      return {2, 'i'};
    case 5123:
      return {2, 'u'};
    case 5125:
      return {4, 'u'};
    case 5126:
      return {4, 'f'};
    default:
      return {};
  }
}

double component_value(const char* at, Component component, bool normalized) {
  std::uint32_t bits = 0;
  for (std::size_t i = component.size; i-- > 0;) bits = bits << 8 | static_cast<unsigned char>(at[i]);
  if (component.kind == 'f') {
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return double(value);
  }
  const double span = component.size == 1 ? 256.0 : component.size == 2 ? 65536.0 : 4294967296.0;
  const double value =
      component.kind == 'i' && double(bits) >= 0.5 * span ? double(bits) - span : double(bits);
  if (!normalized) return value;
  return component.kind == 'i' ? max(value / (0.5 * span - 1.0), -1.0) : value / (span - 1.0);
}

// One of length 1, as far as floats can tell, stays as it is, bit by bit.
Quat unit_quaternion(const std::vector<double>& q) {
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const Quat out{float(q[0]), float(q[1]), float(q[2]), float(q[3])};
  return absolute(size - 1.0) < 1.0e-6 ? out : normalized(out);
}

}  // namespace

const Json* json_member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::int64_t json_integer(const Json& object, const char* key, std::int64_t otherwise) {
  const Json* const value = json_member(object, key);
  if (value == nullptr) return otherwise;
  if (value->is_number_unsigned()) {
    const std::uint64_t number = value->get<std::uint64_t>();
    return number > std::uint64_t(1) << 62 ? -1 : std::int64_t(number);
  }
  return value->is_number_integer() ? value->get<std::int64_t>() : -1;
}

double json_number(const Json& object, const char* key, double otherwise, double most) {
  const Json* const value = json_member(object, key);
  if (value == nullptr) return otherwise;
  if (!value->is_number() || !(absolute(value->get<double>()) <= most))
    throw SceneError{"", 0, 0, std::string("/") + key,
                     "expected a finite number of at most " + power_of_ten(most)};
  return value->get<double>();
}

bool json_flag(const Json& object, const char* key, bool otherwise) {
  const Json* const value = json_member(object, key);
  return value == nullptr || !value->is_boolean() ? otherwise : value->get<bool>();
}

std::string json_text(const Json& object, const char* key, const std::string& otherwise) {
  const Json* const value = json_member(object, key);
  return value == nullptr || !value->is_string() ? otherwise : value->get<std::string>();
}

std::vector<double> json_numbers(const Json& object, const char* key, std::size_t count, double most) {
  const Json* const value = json_member(object, key);
  if (value == nullptr) return {};
  std::vector<double> out;
  if (value->is_array() && value->size() == count) {
    for (const Json& part : *value) {
      if (part.is_number() && absolute(part.get<double>()) <= most) out.push_back(part.get<double>());
    }
  }
  if (out.size() != count)
    throw SceneError{
        "", 0, 0, std::string("/") + key,
        "expected " + std::to_string(count) + " finite numbers of at most " + power_of_ten(most)};
  return out;
}

void GltfDocument::fail(const std::string& pointer, const std::string& message) const {
  throw SceneError{import_.file, 0, 0, pointer, message};
}

GltfDocument::GltfDocument(Import& import) : import_(import) {
  open();
  read_nodes();
}

void GltfDocument::open() {
  std::string_view text = import_.bytes;
  if (text.size() >= 12 && text.substr(0, 4) == "glTF") {
    if (u32_at(text, 4) != 2)
      fail("", "found version " + std::to_string(u32_at(text, 4)) + " of glTF, expected 2");
    std::string_view rest = text.substr(12);
    text = {};
    while (rest.size() >= 8) {
      const std::size_t size = u32_at(rest, 0);
      const std::uint32_t type = u32_at(rest, 4);
      if (size > rest.size() - 8) fail("", "found a chunk that is longer than the file");
      if (type == 0x4e4f534au && text.empty()) text = rest.substr(8, size);
      if (type == 0x004e4942u && !has_binary_) {
        binary_ = std::string(rest.substr(8, size));
        has_binary_ = true;
      }
      rest.remove_prefix(8 + size);
    }
  }
  json_ = parse_document(text, import_.file, import_.options.limits);
  if (!json_.is_object()) fail("", "expected an object");
  const Json* const asset = json_member(json_, "asset");
  if (asset == nullptr || json_text(*asset, "version", "").rfind("2.", 0) != 0)
    fail("/asset/version", "expected version 2.x");
  if (const Json* const required = json_member(json_, "extensionsRequired");
      required != nullptr && required->is_array()) {
    for (const Json& name : *required) {
      const std::string word = name.is_string() ? name.get<std::string>() : "";
      const bool known = word == "KHR_physics_rigid_bodies" || word == "KHR_implicit_shapes" ||
                         word == "KHR_collision_shapes" || word == "KHR_mesh_quantization";
      // Extensions of pictures and sounds move nothing.
      constexpr const char* kOfLooks[] = {"KHR_lights_",    "KHR_materials_",  "KHR_texture_",
                                          "KHR_audio",      "EXT_lights_",     "EXT_texture_",
                                          "KHR_animation_", "KHR_xmp",         "MSFT_texture",
                                          "KHR_node_",      "KHR_environment", "OMI_environment"};
      const bool is_look = std::any_of(std::begin(kOfLooks), std::end(kOfLooks),
                                       [&](const char* start) { return word.rfind(start, 0) == 0; });
      if (!known && !is_look) fail("/extensionsRequired", "requires \"" + word + "\", which is not read");
    }
  }
}

const Json& GltfDocument::element(const char* section, std::int64_t index) const {
  const Json* const list = json_member(json_, section);
  if (list == nullptr || !list->is_array() || index < 0 || std::size_t(index) >= list->size() ||
      !(*list)[std::size_t(index)].is_object())
    fail(std::string("/") + section + "/" + std::to_string(index), "is named, but there is no such object");
  return (*list)[std::size_t(index)];
}

const Json* GltfDocument::root_extension(const char* name) const {
  const Json* const all = json_member(json_, "extensions");
  return all == nullptr ? nullptr : json_member(*all, name);
}

const Json* GltfDocument::extension(int node, const char* name) const {
  const Json* const all = json_member(json_["nodes"][std::size_t(node)], "extensions");
  return all == nullptr ? nullptr : json_member(*all, name);
}

const Json* GltfDocument::gyre_extras(int node, const char* name) const {
  const Json* const extras = json_member(json_["nodes"][std::size_t(node)], "extras");
  const Json* const gyre = extras == nullptr ? nullptr : json_member(*extras, "gyre");
  const Json* const out = gyre == nullptr ? nullptr : json_member(*gyre, name);
  return out != nullptr && out->is_object() ? out : nullptr;
}

std::optional<Transform> GltfDocument::rigid_between(int above, int node) const {
  std::vector<int> chain;
  if (!nodes_[std::size_t(above)].pose) return std::nullopt;
  for (; node != above; node = nodes_[std::size_t(node)].parent) {
    if (node < 0 || !nodes_[std::size_t(node)].local) return std::nullopt;
    chain.push_back(node);
  }
  Transform out;
  for (std::size_t i = chain.size(); i-- > 0;) {
    const Transform& local = *nodes_[std::size_t(chain[i])].local;
    out = i + 1 == chain.size() ? local : out * local;
  }
  return out;
}

void GltfDocument::place_node(int node, int parent, const Json& json, const std::string& pointer) {
  Mat3 linear;
  DVec3 translation;
  std::optional<Transform> local;
  if (const auto m = json_numbers(json, "matrix", 16); !m.empty()) {
    const auto column = [&](std::size_t i) {
      return Vec3{float(m[4 * i]), float(m[4 * i + 1]), float(m[4 * i + 2])};
    };
    linear = {column(0), column(1), column(2)};
    translation = {m[12], m[13], m[14]};
  } else {
    Quat rotation;
    Vec3 scale{1, 1, 1};
    if (const auto q = json_numbers(json, "rotation", 4); !q.empty()) rotation = unit_quaternion(q);
    if (const auto s = json_numbers(json, "scale", 3); !s.empty())
      scale = {float(s[0]), float(s[1]), float(s[2])};
    if (const auto t = json_numbers(json, "translation", 3); !t.empty()) translation = {t[0], t[1], t[2]};
    linear = to_matrix(rotation) * diagonal(scale);
    if (scale == Vec3{1, 1, 1}) local = Transform{to_float(translation), rotation};
  }
  GltfNode& out = nodes_[std::size_t(node)];
  out.local = local;
  if (local && parent < 0) out.pose = Pose{translation, local->orientation};
  if (local && parent >= 0 && nodes_[std::size_t(parent)].pose)
    out.pose = *nodes_[std::size_t(parent)].pose * *local;
  out.parent = parent;
  out.name = json_text(json, "name", "node_" + std::to_string(node));
  out.linear = linear;
  out.translation = translation;
  if (parent >= 0) {
    const GltfNode& above = nodes_[std::size_t(parent)];
    out.linear = above.linear * linear;
    out.translation = above.translation + DVec3(above.linear * to_float(translation));
  }
  const bool finite = is_finite(out.linear.x) && is_finite(out.linear.y) && is_finite(out.linear.z) &&
                      is_finite(out.translation);
  if (!finite || !(absolute(determinant(out.linear)) > 1.0e-20f))
    fail(pointer, "has a transform that is singular or not finite");
}

void GltfDocument::read_nodes() {
  const Json* const list = json_member(json_, "nodes");
  if (list == nullptr || !list->is_array()) return;
  if (list->size() > kMaxNodes) fail("/nodes", "expected at most 1000000 nodes");
  nodes_.resize(list->size());
  std::vector<bool> is_child(list->size(), false), is_placed(list->size(), false);
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (!(*list)[i].is_object()) fail("/nodes/" + std::to_string(i), "expected an object");
    const Json* const children = json_member((*list)[i], "children");
    for (std::size_t k = 0; children != nullptr && children->is_array() && k < children->size(); ++k) {
      const Json& child = (*children)[k];
      if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= list->size())
        fail("/nodes/" + std::to_string(i) + "/children", "expected numbers of nodes");
      nodes_[i].children.push_back(child.get<int>());
      is_child[child.get<std::size_t>()] = true;
    }
  }
  std::vector<int> waiting;
  if (json_member(json_, "scenes") != nullptr) {
    const Json& scene = element("scenes", json_integer(json_, "scene", 0));
    const Json* const roots = json_member(scene, "nodes");
    for (std::size_t k = 0; roots != nullptr && roots->is_array() && k < roots->size(); ++k) {
      const Json& root = (*roots)[roots->size() - 1 - k];
      if (!root.is_number_unsigned() || root.get<std::uint64_t>() >= list->size())
        fail("/scenes", "expected numbers of nodes");
      waiting.push_back(root.get<int>());
    }
  } else {
    for (std::size_t i = list->size(); i-- > 0;) {
      if (!is_child[i]) waiting.push_back(int(i));
    }
  }
  while (!waiting.empty()) {
    const int node = waiting.back();
    waiting.pop_back();
    const std::string pointer = "/nodes/" + std::to_string(node);
    if (is_placed[std::size_t(node)]) fail(pointer, "has two parents, or is its own");
    is_placed[std::size_t(node)] = true;
    place_node(node, nodes_[std::size_t(node)].parent, (*list)[std::size_t(node)], pointer);
    order_.push_back(node);
    const std::vector<int>& children = nodes_[std::size_t(node)].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      nodes_[std::size_t(*child)].parent = node;
      waiting.push_back(*child);
    }
  }
}

const std::string& GltfDocument::buffer(std::int64_t index) {
  const Json& json = element("buffers", index);
  if (buffers_.size() <= std::size_t(index)) buffers_.resize(std::size_t(index) + 1);
  std::optional<std::string>& out = buffers_[std::size_t(index)];
  if (out) return *out;
  const std::string pointer = "/buffers/" + std::to_string(index);
  const std::string uri = json_text(json, "uri", "");
  if (uri.empty()) {
    if (index != 0 || !has_binary_) fail(pointer, "has neither an address nor a binary chunk");
    return binary_;
  }
  if (uri.rfind("data:", 0) == 0) {
    const std::size_t comma = uri.find(";base64,");
    std::string bytes;
    if (comma == std::string::npos || !decode_base64(std::string_view(uri).substr(comma + 8), bytes))
      fail(pointer + "/uri", "expected base64");
    out = std::move(bytes);
  } else {
    out = import_.read_file(percent_decoded(uri), import_.folder, 0);
  }
  return *out;
}

std::vector<double> GltfDocument::accessor(std::int64_t index, std::size_t width, const char* type) {
  const std::string pointer = "/accessors/" + std::to_string(index);
  const Json& json = element("accessors", index);
  if (json_text(json, "type", "") != type) fail(pointer + "/type", std::string("expected ") + type);
  if (json_member(json, "sparse") != nullptr) fail(pointer + "/sparse", "sparse accessors are not read");
  const Component component = component_of(json_integer(json, "componentType", 0));
  const std::int64_t count = json_integer(json, "count", -1), offset = json_integer(json, "byteOffset", 0);
  if (component.size == 0 || count < 0 || offset < 0)
    fail(pointer, "has no component type, count or offset of glTF");
  if (std::size_t(count) > 3 * import_.options.limits.triangles)
    fail(pointer + "/count", "is above the limit");
  const Json& view = element("bufferViews", json_integer(json, "bufferView", -1));
  const std::string& bytes = buffer(json_integer(view, "buffer", -1));
  const std::int64_t view_offset = json_integer(view, "byteOffset", 0),
                     view_size = json_integer(view, "byteLength", -1);
  const std::size_t tight = width * component.size;
  const std::int64_t stride = json_integer(view, "byteStride", std::int64_t(tight));
  if (view_offset < 0 || view_size < 0 || std::size_t(view_offset) > bytes.size() ||
      std::size_t(view_size) > bytes.size() - std::size_t(view_offset))
    fail(pointer, "has a view that is outside of its buffer");
  if (stride < std::int64_t(tight) || stride > 255)
    fail(pointer, "has a stride that is too short or above 255");
  const std::int64_t needed = count == 0 ? 0 : offset + (count - 1) * stride + std::int64_t(tight);
  if (offset > view_size || needed > view_size) fail(pointer, "reaches out of its view");
  std::vector<double> out;
  out.reserve(std::size_t(count) * width);
  const bool normalized = json_flag(json, "normalized", false);
  for (std::int64_t i = 0; i < count; ++i) {
    const char* const at = bytes.data() + view_offset + offset + i * stride;
    for (std::size_t k = 0; k < width; ++k)
      out.push_back(component_value(at + k * component.size, component, normalized));
  }
  return out;
}

MeshData GltfDocument::mesh_data(std::int64_t mesh) {
  const std::string pointer = "/meshes/" + std::to_string(mesh);
  const Json& json = element("meshes", mesh);
  const Json* const primitives = json_member(json, "primitives");
  MeshData out;
  for (std::size_t i = 0; primitives != nullptr && primitives->is_array() && i < primitives->size(); ++i) {
    const Json& primitive = (*primitives)[i];
    if (json_integer(primitive, "mode", 4) != 4) {
      import_.findings.left_out("primitive that is no list of triangles");
      continue;
    }
    const Json* const attributes = json_member(primitive, "attributes");
    if (attributes == nullptr) fail(pointer, "has a primitive without attributes");
    const std::vector<double> places = accessor(json_integer(*attributes, "POSITION", -1), 3, "VEC3");
    const std::size_t first = out.vertices.size();
    for (std::size_t k = 0; k + 2 < places.size(); k += 3) {
      const Vec3 place{float(places[k]), float(places[k + 1]), float(places[k + 2])};
      if (!is_finite(place)) fail(pointer, "has a position that is not finite");
      out.vertices.push_back(place);
    }
    std::vector<double> indices;
    if (json_member(primitive, "indices") != nullptr) {
      indices = accessor(json_integer(primitive, "indices", -1), 1, "SCALAR");
    } else {
      for (std::size_t k = first; k < out.vertices.size(); ++k) indices.push_back(double(k - first));
    }
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double index = indices[k + c];
        if (!(index >= 0 && index < double(out.vertices.size() - first)))
          fail(pointer, "has an index of no vertex");
        out.indices.push_back(std::uint32_t(first) + std::uint32_t(index));
      }
    }
    if (out.vertices.size() > import_.options.limits.vertices ||
        out.indices.size() / 3 > import_.options.limits.triangles)
      fail(pointer, "has more vertices or triangles than the limit");
  }
  if (out.indices.empty()) fail(pointer, "has no triangle");
  return out;
}

std::optional<SceneColor> GltfDocument::mesh_color(int node) const {
  const Json& json = json_["nodes"][std::size_t(node)];
  const std::int64_t mesh = json_integer(json, "mesh", -1);
  if (mesh < 0) return std::nullopt;
  const Json* const primitives = json_member(element("meshes", mesh), "primitives");
  if (primitives == nullptr || !primitives->is_array() || primitives->empty()) return std::nullopt;
  const std::int64_t material = json_integer((*primitives)[0], "material", -1);
  if (material < 0) return std::nullopt;
  const Json* const surface = json_member(element("materials", material), "pbrMetallicRoughness");
  if (surface == nullptr) return std::nullopt;
  const auto factor = json_numbers(*surface, "baseColorFactor", 4);
  if (factor.empty()) return std::nullopt;
  const auto encoded = [](double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  };
  return color_of(encoded(factor[0]), encoded(factor[1]), encoded(factor[2]));
}

}  // namespace gyre
