// COLLADA meshes. The format: Khronos Group, "COLLADA - Digital Asset Schema Release 1.4.1". See xml_collada.h.
#include "formats/xml_collada.h"
#include "formats/xml_element.h"
#include "scene/number_text.h"

#include <tinyxml2.h>

#include <map>
#include <utility>
#include <vector>

namespace gyre {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxNodeDepth = 100;
constexpr std::size_t kMaxInstances = 100'000;

// A frame with scale: x -> linear x + translation.
struct Affine {
  Mat3 linear{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 translation{};
};
Affine operator*(const Affine& a, const Affine& b) {
  return {a.linear * b.linear, a.linear * b.translation + a.translation};
}

// Numbers between white space, one after the other.
class NumberList {
 public:
  explicit NumberList(const XMLElement* element) {
    const char* const text = element != nullptr ? element->GetText() : nullptr;
    if (text != nullptr) rest_ = text;
  }
  // False at the end; `good` turns false where the next word is no number.
  bool next(double& out, bool& good) {
    const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return false;
    rest_.remove_prefix(begin);
    const std::size_t end = min(rest_.find_first_of(" \t\r\n"), rest_.size());
    good = good && parse_number(rest_.substr(0, end), out) && absolute(out) <= 1.0e12;
    rest_.remove_prefix(end);
    return good;
  }

 private:
  std::string_view rest_;
};

class ColladaReader {
 public:
  ColladaReader(const Import& import, const std::string& file, const XMLElement& root)
      : import_(import), file_(file), root_(root) {}
  MeshData read();

 private:
  [[noreturn]] void fail(const XMLElement& at, const std::string& message) const {
    throw SceneError{file_, at.GetLineNum(), 1, "", "<" + std::string(at.Name()) + ">: " + message};
  }
  void find_ids(const XMLElement& element);
  const XMLElement& named(const XMLElement& at, const char* attribute) const;
  std::vector<double> numbers(const XMLElement& element);
  std::vector<std::size_t> indices(const XMLElement& element);
  Affine transform_of(const XMLElement& element);
  std::vector<Vec3> positions(const XMLElement& vertices);
  void add_node(const XMLElement& node, const Affine& above, int depth);
  void add_geometry(const XMLElement& geometry, const Affine& frame);
  void add_polygons(const XMLElement& list, const Affine& frame);
  void add_polygon(const std::vector<std::size_t>& corners, std::size_t first, std::size_t count,
                   std::size_t stride, std::size_t offset, std::size_t vertices, bool mirrored);

  const Import& import_;
  const std::string& file_;
  const XMLElement& root_;
  std::map<std::string, const XMLElement*> by_id_;
  std::size_t instances_ = 0, numbers_read_ = 0;  // a geometry counts each time that it is shown
  MeshData mesh_;
};

void ColladaReader::find_ids(const XMLElement& element) {
  for (const XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (const char* const id = e->Attribute("id")) by_id_.emplace(id, e);
    find_ids(*e);
  }
}

// The element that an address within the file names.
const XMLElement& ColladaReader::named(const XMLElement& at, const char* attribute) const {
  const char* const url = at.Attribute(attribute);
  const auto found = url != nullptr && *url == '#' ? by_id_.find(url + 1) : by_id_.end();
  if (found == by_id_.end()) fail(at, std::string("its ") + attribute + " names nothing in the file");
  return *found->second;
}

std::vector<double> ColladaReader::numbers(const XMLElement& element) {
  std::vector<double> out;
  NumberList list(&element);
  bool good = true;
  for (double value = 0; list.next(value, good);) {
    if (++numbers_read_ > 10 * import_.options.limits.vertices)
      fail(element, "the file shows more numbers than the limit");
    out.push_back(value);
  }
  if (!good) fail(element, "expected finite numbers of at most 1e12");
  return out;
}

std::vector<std::size_t> ColladaReader::indices(const XMLElement& element) {
  std::vector<std::size_t> out;
  for (const double value : numbers(element)) {
    if (!(value >= 0 && value < 4.0e9)) fail(element, "expected indices of at least 0");
    out.push_back(std::size_t(value));
  }
  return out;
}

Affine ColladaReader::transform_of(const XMLElement& element) {
  const std::string kind = element.Name();
  const std::vector<double> n = numbers(element);
  const auto need = [&](std::size_t count) {
    if (n.size() != count) fail(element, "expected " + std::to_string(count) + " numbers");
  };
  const auto part = [&](std::size_t i) { return float(n[i]); };
  Affine out;
  if (kind == "translate") {
    need(3);
    out.translation = {part(0), part(1), part(2)};
  } else if (kind == "scale") {
    need(3);
    out.linear = diagonal({part(0), part(1), part(2)});
  } else if (kind == "rotate") {
    need(4);
    const Vec3 axis{part(0), part(1), part(2)};
    if (length(axis) > 0.0f)
      out.linear = to_matrix(from_axis_angle(normalized(axis), float(n[3] / 180.0) * kPi));
  } else if (kind == "matrix") {
    need(16);
    for (int c = 0; c < 3; ++c) {
      Vec3& column = c == 0 ? out.linear.x : c == 1 ? out.linear.y : out.linear.z;
      const std::size_t i = std::size_t(c);
      column = {part(i), part(4 + i), part(8 + i)};
    }
    out.translation = {part(3), part(7), part(11)};
  } else {
    fail(element, "is a transform that is not read");
  }
  return out;
}

// The places of a <vertices>: the first three numbers of each row of its source.
std::vector<Vec3> ColladaReader::positions(const XMLElement& vertices) {
  for (const XMLElement* input = vertices.FirstChildElement("input"); input != nullptr;
       input = input->NextSiblingElement("input")) {
    const char* const semantic = input->Attribute("semantic");
    if (semantic == nullptr || std::string_view(semantic) != "POSITION") continue;
    const XMLElement& source = named(*input, "source");
    const XMLElement* const array = source.FirstChildElement("float_array");
    if (array == nullptr) fail(source, "found no <float_array>");
    const XMLElement* const common = source.FirstChildElement("technique_common");
    const XMLElement* const accessor = common != nullptr ? common->FirstChildElement("accessor") : nullptr;
    const int stride = accessor != nullptr ? accessor->IntAttribute("stride", 1) : 3;
    const int offset = accessor != nullptr ? accessor->IntAttribute("offset", 0) : 0;
    if (stride < 3 || stride > 1000 || offset < 0) fail(source, "expected a stride of at least 3");
    const std::vector<double> n = numbers(*array);
    std::vector<Vec3> out;
    for (std::size_t i = std::size_t(offset); i + 3 <= n.size(); i += std::size_t(stride))
      out.push_back({float(n[i]), float(n[i + 1]), float(n[i + 2])});
    return out;
  }
  fail(vertices, "found no <input> with the semantic POSITION");
}

void ColladaReader::add_polygon(const std::vector<std::size_t>& corners, std::size_t first, std::size_t count,
                                std::size_t stride, std::size_t offset, std::size_t vertices, bool mirrored) {
  const auto corner = [&](std::size_t i) {
    return std::uint32_t(vertices + corners[(first + i) * stride + offset]);
  };
  for (std::size_t i = 1; i + 1 < count; ++i) {
    mesh_.indices.push_back(corner(0));
    mesh_.indices.push_back(corner(mirrored ? i + 1 : i));
    mesh_.indices.push_back(corner(mirrored ? i : i + 1));
  }
}

// <triangles>, <polylist> and <polygons>; polygons become fans.
void ColladaReader::add_polygons(const XMLElement& list, const Affine& frame) {
  const XMLElement* vertices = nullptr;
  std::size_t stride = 1, offset = 0;
  for (const XMLElement* input = list.FirstChildElement("input"); input != nullptr;
       input = input->NextSiblingElement("input")) {
    const int at = input->IntAttribute("offset", -1);
    if (at < 0 || at > 100) fail(*input, "expected an offset from 0 to 100");
    stride = max(stride, std::size_t(at) + 1);
    const char* const semantic = input->Attribute("semantic");
    if (semantic == nullptr || std::string_view(semantic) != "VERTEX") continue;
    vertices = &named(*input, "source");
    offset = std::size_t(at);
  }
  if (vertices == nullptr) fail(list, "found no <input> with the semantic VERTEX");
  const std::vector<Vec3> places = positions(*vertices);
  const std::size_t first_vertex = mesh_.vertices.size();
  const bool mirrored = determinant(frame.linear) < 0.0f;
  for (const Vec3 place : places) {
    const Vec3 vertex = frame.linear * place + frame.translation;
    if (!is_finite(vertex)) fail(list, "has a coordinate that is not finite");
    mesh_.vertices.push_back(vertex);
  }
  const XMLElement* const vcount = list.FirstChildElement("vcount");
  const std::vector<std::size_t> counts = vcount != nullptr ? indices(*vcount) : std::vector<std::size_t>();
  const bool are_triangles = std::string_view(list.Name()) == "triangles";
  for (const XMLElement* p = list.FirstChildElement("p"); p != nullptr; p = p->NextSiblingElement("p")) {
    const std::vector<std::size_t> corners = indices(*p);
    const std::size_t rows = corners.size() / stride;
    for (std::size_t i = 0; i < rows; ++i) {
      if (corners[i * stride + offset] >= places.size()) fail(*p, "has an index out of range");
    }
    std::size_t at = 0;
    for (std::size_t k = 0; at < rows && (vcount == nullptr || k < counts.size()); ++k) {
      const std::size_t count = are_triangles ? 3 : vcount != nullptr ? counts[k] : rows;
      if (count > rows - at) fail(*p, "has fewer indices than its polygons need");
      add_polygon(corners, at, count, stride, offset, first_vertex, mirrored);
      at += count;
    }
  }
  const SceneLimits& limits = import_.options.limits;
  if (mesh_.vertices.size() > limits.vertices || mesh_.indices.size() / 3 > limits.triangles)
    fail(list, "has more vertices or triangles than the limit");
}

void ColladaReader::add_geometry(const XMLElement& geometry, const Affine& frame) {
  const XMLElement* const mesh = geometry.FirstChildElement("mesh");
  if (mesh == nullptr) return;  // a spline
  for (const XMLElement* e = mesh->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    if (kind == "triangles" || kind == "polylist" || kind == "polygons") add_polygons(*e, frame);
    if (kind == "tristrips" || kind == "trifans") fail(*e, "is not read; expected triangles or polygons");
  }
}

void ColladaReader::add_node(const XMLElement& node, const Affine& above, int depth) {
  if (depth > kMaxNodeDepth || ++instances_ > kMaxInstances)
    fail(node, "has nodes nested too deep, or more than 100000");
  Affine frame = above;
  for (const XMLElement* e = node.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view kind = e->Name();
    if (kind == "translate" || kind == "scale" || kind == "rotate" || kind == "matrix" || kind == "skew" ||
        kind == "lookat") {
      frame = frame * transform_of(*e);
    } else if (kind == "node") {
      add_node(*e, frame, depth + 1);
    } else if (kind == "instance_node") {
      add_node(named(*e, "url"), frame, depth + 1);
    } else if (kind == "instance_geometry") {
      if (++instances_ > kMaxInstances) fail(*e, "is more than the 100000th");
      add_geometry(named(*e, "url"), frame);
    }
  }
}

MeshData ColladaReader::read() {
  if (std::string_view(root_.Name()) != "COLLADA") fail(root_, "expected <COLLADA>");
  find_ids(root_);
  Affine frame;
  if (const XMLElement* const asset = root_.FirstChildElement("asset")) {
    const XMLElement* const unit = asset->FirstChildElement("unit");
    const double meter = unit != nullptr ? unit->DoubleAttribute("meter", 1.0) : 1.0;
    if (!(meter > 1.0e-9 && meter < 1.0e9)) fail(*unit, "expected a unit in metres above 0");
    frame.linear = diagonal(Vec3{1, 1, 1} * float(meter));
  }
  const XMLElement* const scene = root_.FirstChildElement("scene");
  const XMLElement* const shown =
      scene != nullptr ? scene->FirstChildElement("instance_visual_scene") : nullptr;
  if (shown != nullptr) {
    add_node(named(*shown, "url"), frame, 0);
  } else if (const XMLElement* const library = root_.FirstChildElement("library_geometries")) {
    for (const XMLElement* e = library->FirstChildElement("geometry"); e != nullptr;
         e = e->NextSiblingElement("geometry"))
      add_geometry(*e, frame);
  }
  if (mesh_.indices.empty()) fail(root_, "shows no triangle");
  return std::move(mesh_);
}

}  // namespace

MeshData read_collada(const Import& import, std::string_view bytes, const std::string& file) {
  tinyxml2::XMLDocument document;
  parse_xml(import, bytes, file, document);
  return ColladaReader(import, file, *document.RootElement()).read();
}

}  // namespace gyre
