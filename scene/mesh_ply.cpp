// PLY files: text, and binary of both byte orders. The format: G. Turk, "The PLY Polygon File Format" (1994). See mesh_file.h.
#include "scene/mesh_file.h"
#include "scene/number_text.h"
#include "scene/polygon_triangles.h"

#include <cstring>
#include <limits>

namespace gyre {
namespace {

constexpr std::size_t kMaxPlyCorners = 4096;  // of a face

struct PlyProperty {
  std::string name;
  int size = 0;        // bytes of one value
  char kind = 'i';     // i, u or f
  int count_size = 0;  // bytes of the number of values of a list; 0: no list
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

bool set_ply_type(std::string_view word, int& size, char& kind) {
  struct Type {
    const char *word, *other;
    int size;
    char kind;
  };
  constexpr Type kTypes[] = {{"char", "int8", 1, 'i'},     {"uchar", "uint8", 1, 'u'},
                             {"short", "int16", 2, 'i'},   {"ushort", "uint16", 2, 'u'},
                             {"int", "int32", 4, 'i'},     {"uint", "uint32", 4, 'u'},
                             {"float", "float32", 4, 'f'}, {"double", "float64", 8, 'f'}};
  for (const Type& type : kTypes) {
    if (word != type.word && word != type.other) continue;
    size = type.size;
    kind = type.kind;
    return true;
  }
  return false;
}

class PlyParser {
 public:
  PlyParser(std::string_view text, const std::string& file, const SceneLimits& limits)
      : text_(text), file_(file), limits_(limits) {}

  SceneResult<MeshData> parse() {
    if (!read_header() || !read_body()) return SceneError{file_, 0, 0, "", problem_};
    if (mesh_.indices.empty()) return SceneError{file_, 0, 0, "", "found no face, expected at least one"};
    for (const std::uint32_t index : mesh_.indices) {
      if (index >= mesh_.vertices.size())
        return SceneError{file_, 0, 0, "", "found a face of a vertex that does not exist"};
    }
    return std::move(mesh_);
  }

 private:
  bool fail(std::string why) {
    if (problem_.empty()) problem_ = std::move(why);
    return false;
  }

  std::vector<std::string_view> header_line() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < line.size() && words.size() < 8;) {
      if (line[i] == ' ' || line[i] == '\r' || line[i] == '\t') {
        ++i;
        continue;
      }
      std::size_t stop = i;
      while (stop < line.size() && line[stop] != ' ' && line[stop] != '\r' && line[stop] != '\t') ++stop;
      words.push_back(line.substr(i, stop - i));
      i = stop;
    }
    return words;
  }

  bool read_property(const std::vector<std::string_view>& words) {
    if (elements_.empty()) return fail("found a property before its element");
    PlyProperty property;
    char list_kind = 'u';
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (is_list ? !set_ply_type(words[2], property.count_size, list_kind) || list_kind == 'f' ||
                      !set_ply_type(words[3], property.size, property.kind)
                : words.size() != 3 || !set_ply_type(words[1], property.size, property.kind)) {
      return fail("found a property of a type that PLY does not have");
    }
    property.name = std::string(words.back());
    if (elements_.back().properties.size() >= 256) return fail("found more than 256 properties");
    elements_.back().properties.push_back(std::move(property));
    return true;
  }

  bool read_header() {
    std::vector<std::string_view> words = header_line();
    if (words.size() != 1 || words[0] != "ply") return fail("found no PLY header");
    bool has_format = false;
    for (;;) {
      if (text_.empty()) return fail("found no end_header");
      words = header_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() >= 2) {
        has_format = true;
        is_text_ = words[1] == "ascii";
        is_big_ = words[1] == "binary_big_endian";
        if (!is_text_ && !is_big_ && words[1] != "binary_little_endian")
          return fail("found a format that PLY does not have");
      } else if (words[0] == "element" && words.size() == 3) {
        double count = 0;
        if (!parse_number(words[2], count) || !(count >= 0 && count < 4.0e9))
          return fail("found no number of elements");
        if (elements_.size() >= 64) return fail("found more than 64 elements");
        elements_.push_back({std::string(words[1]), std::uint64_t(count), {}});
      } else if (words[0] == "property") {
        if (!read_property(words)) return false;
      } else {
        return fail("found a header line that PLY does not have");
      }
    }
    return has_format || fail("found no format");
  }

  bool next_value(int size, char kind, double& out) {
    if (is_text_) {
      const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
      while (!text_.empty() && is_space(text_[0])) text_.remove_prefix(1);
      std::size_t end = 0;
      while (end < text_.size() && !is_space(text_[end])) ++end;
      if (!parse_number(text_.substr(0, end), out))
        return fail("found no number where the header announces one");
      text_.remove_prefix(end);
      return true;
    }
    if (text_.size() < std::size_t(size)) return fail("found the end of the file, expected more elements");
    std::uint64_t bits = 0;
    for (int i = 0; i < size; ++i) {
      const int at = is_big_ ? i : size - 1 - i;
      bits = bits << 8 | static_cast<unsigned char>(text_[std::size_t(at)]);
    }
    text_.remove_prefix(std::size_t(size));
    if (kind == 'f' && size == 8) {
      std::memcpy(&out, &bits, 8);
    } else if (kind == 'f') {
      const std::uint32_t half = std::uint32_t(bits);
      float value;
      std::memcpy(&value, &half, 4);
      out = double(value);
    } else {
      const bool negative = kind == 'i' && (bits >> (8 * size - 1) & 1u) != 0;
      out = negative ? double(bits) - std::pow(2.0, 8 * size) : double(bits);
    }
    return is_finite(out) || fail("found a number that is not finite");
  }

  bool read_list(const PlyProperty& property, std::vector<double>& list) {
    double count = 0;
    list.clear();
    if (!next_value(property.count_size, 'u', count)) return false;
    if (!(count >= 0 && count <= double(kMaxPlyCorners)))
      return fail("found a list of more than 4096 values");
    for (double left = count; left > 0; left -= 1) {
      if (!next_value(property.size, property.kind, list.emplace_back())) return false;
    }
    return true;
  }

  bool add_face(const std::vector<double>& list) {
    std::vector<std::uint32_t> face;
    std::vector<Vec3> corners;
    for (const double value : list) {
      if (!(value >= 0 && value < double(mesh_.vertices.size())))
        return fail("found a face of a vertex that does not exist");
      face.push_back(std::uint32_t(value));
      corners.push_back(mesh_.vertices[face.back()]);
    }
    if (face.size() < 3) return fail("found a face of fewer than 3 corners");
    if (mesh_.indices.size() / 3 + face.size() - 2 > limits_.triangles)
      return fail("found more than " + std::to_string(limits_.triangles) + " triangles");
    for (const std::uint32_t i : triangulate_polygon(corners)) mesh_.indices.push_back(face[i]);
    return true;
  }

  bool read_element(const PlyElement& element) {
    double place[3] = {0, 0, 0};
    std::vector<double> list;
    for (const PlyProperty& property : element.properties) {
      double value = 0;
      if (property.count_size > 0) {
        if (!read_list(property, list)) return false;
        const bool is_face =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (is_face && !add_face(list)) return false;
        continue;
      }
      if (!next_value(property.size, property.kind, value)) return false;
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
        place[property.name[0] - 'x'] = value;
    }
    if (element.name != "vertex") return true;
    for (const double part : place) {
      if (absolute(part) > double(std::numeric_limits<float>::max()))
        return fail("found a coordinate that is too large");
    }
    mesh_.vertices.push_back({float(place[0]), float(place[1]), float(place[2])});
    return true;
  }

  bool read_body() {
    for (const PlyElement& element : elements_) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex" && element.count > limits_.vertices)
        return fail("found " + std::to_string(element.count) + " vertices, expected at most " +
                    std::to_string(limits_.vertices));
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (!read_element(element)) return false;
      }
    }
    return true;
  }

  std::string_view text_;
  const std::string& file_;
  const SceneLimits& limits_;
  std::vector<PlyElement> elements_;
  bool is_text_ = false, is_big_ = false;
  MeshData mesh_;
  std::string problem_;
};

}  // namespace

SceneResult<MeshData> parse_ply(std::string_view text, const std::string& file, const SceneLimits& limits) {
  return PlyParser(text, file, limits).parse();
}

SceneResult<MeshData> parse_mesh(std::string_view text, const std::string& file, const SceneLimits& limits) {
  switch (mesh_format_of(file)) {
    case MeshFormat::stl:
      return parse_stl(text, file, limits);
    case MeshFormat::ply:
      return parse_ply(text, file, limits);
    default:
      return parse_obj(text, file, limits);
  }
}

MeshFormat mesh_format_of(std::string_view path) {
  if (path.size() < 5) return MeshFormat::none;
  std::string end(path.substr(path.size() - 4));
  for (char& c : end) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  if (end == ".obj") return MeshFormat::obj;
  if (end == ".stl") return MeshFormat::stl;
  return end == ".ply" ? MeshFormat::ply : MeshFormat::none;
}

}  // namespace gyre
