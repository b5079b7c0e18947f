// Mesh files of a scene. The format: Wavefront Technologies, "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
// See mesh_file.h.
#include "scene/mesh_file.h"

#include "scene/number_text.h"
#include "scene/polygon_triangles.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

namespace gyre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxConcaveCorners = 4096;  // of a face; more would take seconds

// Cuts the next word off the front of the line; empty at its end.
std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && (line[begin] == ' ' || line[begin] == '\t')) ++begin;
  std::size_t end = begin;
  while (end < line.size() && line[end] != ' ' && line[end] != '\t') ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

bool is_comment(std::string_view line) {
  const std::string_view word = next_word(line);
  return !word.empty() && word[0] == '#';
}

std::string shown(std::string_view word) {
  std::string out = "\"";
  for (const char c : word.substr(0, 40)) out += c >= 0x20 && c < 0x7f ? c : '?';
  return out + (word.size() > 40 ? "...\"" : "\"");
}

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& file, const SceneLimits& limits)
      : text_(text), limits_(limits) {
    error_.file = file;
  }

  bool parse() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);
    for (int next = 1; !text_.empty();) {
      line_ = next;
      const std::string line = take_line(next);
      if (!parse_line(line)) return false;
    }
    if (mesh_.indices.empty()) {
      line_ = 0;
      return fail("found no face, expected at least one");
    }
    return true;
  }

  MeshData take() { return std::move(mesh_); }
  const SceneError& error() const { return error_; }

 private:
  bool fail(std::string message) {
    error_.line = line_;
    error_.column = line_ > 0 ? 1 : 0;
    error_.message = std::move(message);
    return false;
  }

  // Takes the next line off the text, with the lines that follow a backslash at its end unless it is a comment, and counts
  // their number. Lines end in a line feed, a carriage return, or both.
  std::string take_line(int& number) {
    std::string line;
    for (bool more = true; more && !text_.empty(); ++number) {
      const std::size_t end = std::min(text_.find_first_of("\r\n"), text_.size());
      line += text_.substr(0, end);
      const bool both = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
      text_.remove_prefix(std::min(end + (both ? 2 : 1), text_.size()));
      more = !line.empty() && line.back() == '\\' && !is_comment(line);
      if (more) line.back() = ' ';
    }
    return line;
  }

  bool parse_line(std::string_view line) {
    const std::string_view word = next_word(line);
    if (word.empty() || word[0] == '#') return true;
    if (word == "v") return parse_vertex(line);
    if (word == "f") return parse_face(line);
    if (word == "fo") return parse_face(line);  // faces in files of version 2
    // All other words of the format: curves, surfaces, materials, groups, and those of version 2.
    constexpr const char* kIgnored[] = {
        "vn",     "vt",    "vp",     "cstype", "deg",      "bmat",      "step",       "l",     "p",
        "curv",   "curv2", "surf",   "parm",   "trim",     "hole",      "scrv",       "sp",    "end",
        "con",    "g",     "s",      "mg",     "o",        "bevel",     "c_interp",   "lod",   "usemtl",
        "maplib", "call",  "usemap", "mtllib", "d_interp", "trace_obj", "shadow_obj", "ctech", "stech",
        "csh",    "bsp",   "bzp",    "cdc",    "cdp",      "res"};
    for (const char* known : kIgnored) {
      if (word == known) return true;
    }
    return fail("found " + shown(word) + ", expected v, f or another word of Wavefront OBJ");
  }

  bool parse_vertex(std::string_view line) {
    double parts[3];
    for (double& part : parts) {
      const std::string_view word = next_word(line);
      if (!parse_number(word, part) || absolute(part) > double(std::numeric_limits<float>::max())) {
        return fail("found " + (word.empty() ? "the end of the line" : shown(word)) +
                    ", expected a coordinate");
      }
    }
    if (mesh_.vertices.size() >= limits_.vertices) {
      return fail("found more than " + std::to_string(limits_.vertices) + " vertices");
    }
    mesh_.vertices.push_back({float(parts[0]), float(parts[1]), float(parts[2])});
    return true;
  }

  bool parse_face(std::string_view line) {
    std::vector<std::uint32_t> face;
    std::vector<Vec3> corners;
    for (std::string_view word = next_word(line); !word.empty() && word[0] != '#'; word = next_word(line)) {
      std::uint32_t corner = 0;
      if (!parse_corner(word, corner)) return false;
      face.push_back(corner);
      corners.push_back(mesh_.vertices[corner]);
    }
    if (face.size() < 3)
      return fail("found a face of " + std::to_string(face.size()) + ", expected at least 3 corners");
    if (mesh_.indices.size() / 3 + face.size() - 2 > limits_.triangles)
      return fail("found more than " + std::to_string(limits_.triangles) + " triangles");
    if (face.size() > kMaxConcaveCorners && !is_fan(corners)) {
      return fail("found a concave face of " + std::to_string(face.size()) + ", expected at most " +
                  std::to_string(kMaxConcaveCorners) + " corners");
    }
    for (const std::uint32_t i : triangulate_polygon(corners)) mesh_.indices.push_back(face[i]);
    return true;
  }

  // "7", "7/1", "7//3" or "7/1/3": only the vertex counts. From 1, or from -1 back from the latest.
  bool parse_corner(std::string_view word, std::uint32_t& corner) {
    const std::string_view digits = word.substr(0, word.find('/'));
    const bool back = !digits.empty() && digits[0] == '-';
    const std::size_t count = mesh_.vertices.size();
    std::uint64_t value = 0;
    bool good = digits.size() > (back ? 1u : 0u) && digits.size() < 16;
    for (std::size_t i = back ? 1 : 0; good && i < digits.size(); ++i) {
      good = digits[i] >= '0' && digits[i] <= '9';
      value = 10 * value + std::uint64_t(digits[i] - '0');
    }
    if (!good || value < 1 || value > count) {
      return fail("found " + shown(word) + ", expected a vertex index from 1 to " + std::to_string(count) +
                  " (so many are there at this line)");
    }
    corner = std::uint32_t(back ? count - value : value - 1);
    return true;
  }

  std::string_view text_;
  const SceneLimits& limits_;
  SceneError error_;
  MeshData mesh_;
  int line_ = 0;
};

// Whether `inner` lies in `folder`; both canonical.
bool lies_in(const fs::path& folder, const fs::path& inner) {
  auto f = folder.begin();
  auto i = inner.begin();
  for (; f != folder.end(); ++f, ++i) {
    if (f->empty()) break;  // a trailing separator
    if (i == inner.end() || *f != *i) return false;
  }
  return i != inner.end();
}

}  // namespace

std::string refuse_mesh_path(std::string_view path) {
  if (path.empty()) return "expected a path";
  if (path.size() > 1024) return "expected a path of at most 1024 bytes";
  if (path[0] == '/') return "expected a path relative to the scene file";
  for (const char c : path) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return "expected a path without control characters";
    if (c == '\\') return "expected a path with forward slashes";
    if (c == ':') return "expected a path without a drive or an address";
  }
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    if (path.substr(begin, end - begin) == "..") return "expected a path within the scene's folder";
    begin = end + 1;
  }
  if (mesh_format_of(path) == MeshFormat::none) return "expected a mesh file (.obj, .stl or .ply)";
  return {};
}

namespace {

// To the end rather than trusting a size that may change; one byte beyond the limit tells that there is more.
std::string read_to_end(std::FILE* file, const SceneLimits& limits, std::string& bytes) {
  bytes.clear();
  for (;;) {
    const std::size_t had = bytes.size();
    const std::size_t chunk = std::min<std::size_t>(std::size_t(1) << 20, limits.file_bytes + 1 - had);
    if (chunk == 0) return "is larger than " + std::to_string(limits.file_bytes) + " bytes";
    bytes.resize(had + chunk);
    const std::size_t got = std::fread(bytes.data() + had, 1, chunk, file);
    bytes.resize(had + got);
    if (got < chunk) break;
  }
  if (std::ferror(file)) return "cannot be read to its end";
  return {};
}

// Standard input can be read once; its bytes are kept for a second reader.
std::string read_standard_input(const SceneLimits& limits, std::string& bytes) {
  static std::string kept;
  static bool is_read = false;
  if (!is_read) {
    const std::string problem = read_to_end(stdin, limits, kept);
    if (!problem.empty()) return problem;
    is_read = true;
  }
  bytes = kept;
  return bytes.size() > limits.file_bytes ? "is larger than " + std::to_string(limits.file_bytes) + " bytes"
                                          : std::string();
}

}  // namespace

std::string read_whole_file(const std::string& path, const SceneLimits& limits, std::string& bytes) {
  if (path == kStandardInput) return read_standard_input(limits, bytes);
  std::error_code error;
  const fs::file_status status = fs::status(fs::path(path), error);
  if (status.type() == fs::file_type::not_found) return "there is no such file";
  if (error) return "cannot be read: " + error.message();
  if (fs::is_directory(status)) return "is a folder, expected a file";
  if (!fs::is_regular_file(status)) return "is not a regular file";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return "cannot be opened for reading";
  return read_to_end(file.get(), limits, bytes);
}

SceneResult<MeshData> load_mesh_file(const std::string& folder, const std::string& path,
                                     const SceneLimits& limits) {
  const std::string refusal = refuse_mesh_path(path);
  if (!refusal.empty()) return SceneError{path, 0, 0, "", refusal};
  std::error_code error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : fs::path(folder), error);
  if (error) return SceneError{path, 0, 0, "", "the scene's folder cannot be found: " + error.message()};
  const fs::path place = fs::canonical(root / path, error);
  if (error) return SceneError{path, 0, 0, "", "there is no such file"};
  if (!lies_in(root, place)) return SceneError{path, 0, 0, "", "leads out of the scene's folder"};
  std::string bytes;
  const std::string problem = read_whole_file(place.string(), limits, bytes);
  if (!problem.empty()) return SceneError{path, 0, 0, "", problem};
  return parse_mesh(bytes, path, limits);
}

SceneResult<MeshData> parse_obj(std::string_view text, const std::string& file, const SceneLimits& limits) {
  ObjParser parser(text, file, limits);
  if (!parser.parse()) return parser.error();
  return parser.take();
}

}  // namespace gyre
