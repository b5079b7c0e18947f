// STL files, text and binary. The format: 3D Systems, "StereoLithography Interface Specification" (1988). See mesh_file.h.
#include "scene/mesh_file.h"
#include "scene/mesh_weld.h"
#include "scene/number_text.h"

#include <cstring>
#include <limits>

namespace gyre {
namespace {

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;  // bytes

std::uint32_t little_u32(const char* at) {
  const auto byte = [&](int i) { return std::uint32_t(static_cast<unsigned char>(at[i])); };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}
float little_float(const char* at) {
  const std::uint32_t bits = little_u32(at);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

// A binary file may begin with "solid" too, so the size decides.
bool is_binary_stl(std::string_view text) {
  if (text.size() < kStlHeader) return false;
  const std::size_t count = little_u32(text.data() + 80);
  if (text.size() >= kStlHeader + count * kStlTriangle && text.size() - kStlHeader - count * kStlTriangle < 2)
    return true;
  return text.substr(0, 5) != "solid";
}

SceneError stl_error(const std::string& file, int line, std::string message) {
  return SceneError{file, line, line > 0 ? 1 : 0, "", std::move(message)};
}

SceneResult<MeshData> parse_binary_stl(std::string_view text, const std::string& file,
                                       const SceneLimits& limits) {
  const std::size_t count = little_u32(text.data() + 80);
  if (count > limits.triangles)
    return stl_error(file, 0,
                     "found " + std::to_string(count) + " triangles, expected at most " +
                         std::to_string(limits.triangles));
  if (text.size() < kStlHeader + count * kStlTriangle) {
    return stl_error(file, 0,
                     "found " + std::to_string(text.size()) + " bytes, expected " +
                         std::to_string(kStlHeader + count * kStlTriangle) + " for its " +
                         std::to_string(count) + " triangles");
  }
  MeshWeld weld;
  for (std::size_t i = 0; i < count; ++i) {
    const char* at = text.data() + kStlHeader + i * kStlTriangle + 12;
    for (int k = 0; k < 3; ++k) {
      const Vec3 corner{little_float(at + 12 * k), little_float(at + 12 * k + 4),
                        little_float(at + 12 * k + 8)};
      if (!is_finite(corner))
        return stl_error(file, 0,
                         "found a coordinate in triangle " + std::to_string(i) + " that is not finite");
      weld.add(corner);
    }
  }
  if (count == 0) return stl_error(file, 0, "found no triangle, expected at least one");
  return weld.take();
}

class StlWords {
 public:
  explicit StlWords(std::string_view text) : text_(text) {}
  std::string_view next() {
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    while (!text_.empty() && is_space(text_[0])) {
      if (text_[0] == '\n') ++line_;
      text_.remove_prefix(1);
    }
    std::size_t end = 0;
    while (end < text_.size() && !is_space(text_[end])) ++end;
    const std::string_view word = text_.substr(0, end);
    text_.remove_prefix(end);
    return word;
  }
  // The name behind "solid" may hold spaces.
  void skip_line() { text_.remove_prefix(std::min(text_.find('\n'), text_.size())); }
  int line() const { return line_; }

 private:
  std::string_view text_;
  int line_ = 1;
};

SceneResult<MeshData> parse_text_stl(std::string_view text, const std::string& file,
                                     const SceneLimits& limits) {
  StlWords words(text);
  MeshWeld weld;
  std::size_t corners = 0;  // of the present facet
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid" || word == "endsolid") {
      words.skip_line();
    } else if (word == "vertex") {
      double part[3];
      for (double& p : part) {
        if (!parse_number(words.next(), p) || absolute(p) > double(std::numeric_limits<float>::max()))
          return stl_error(file, words.line(), "found no number, expected a coordinate");
      }
      if (++corners > 3) return stl_error(file, words.line(), "found a facet of more than 3 corners");
      if (weld.corners() / 3 >= limits.triangles)
        return stl_error(file, words.line(),
                         "found more than " + std::to_string(limits.triangles) + " triangles");
      weld.add({float(part[0]), float(part[1]), float(part[2])});
    } else if (word == "endfacet") {
      if (corners != 3)
        return stl_error(file, words.line(),
                         "found a facet of " + std::to_string(corners) + " corners, expected 3");
      corners = 0;
    } else if (word == "facet" || word == "normal" || word == "outer" || word == "loop" ||
               word == "endloop") {
      if (word == "normal") {
        for (int k = 0; k < 3; ++k) words.next();  // of no use: the order of the corners says it
      }
    } else {
      return stl_error(file, words.line(), "found a word that is none of STL");
    }
  }
  if (corners != 0) return stl_error(file, words.line(), "found the end of the file within a facet");
  if (weld.corners() == 0) return stl_error(file, 0, "found no triangle, expected at least one");
  return weld.take();
}

}  // namespace

SceneResult<MeshData> parse_stl(std::string_view text, const std::string& file, const SceneLimits& limits) {
  return is_binary_stl(text) ? parse_binary_stl(text, file, limits) : parse_text_stl(text, file, limits);
}

}  // namespace gyre
