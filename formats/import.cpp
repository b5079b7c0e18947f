// Opens files of every format and checks the scenes made from them. See import.h.
#include "formats/import.h"

#include "formats/xml_collada.h"
#include "formats/import_parts.h"
#include "scene/decomposition_folder.h"
#include "scene/scene_reader.h"
#include "scene/scene_writer.h"

#include <filesystem>
#include <new>

namespace gyre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMeshBytes = std::size_t(1) << 30;  // of all files that an imported one names

bool lies_within(const fs::path& folder, const fs::path& inner) {
  auto i = inner.begin();
  for (auto f = folder.begin(); f != folder.end() && !f->empty(); ++f, ++i) {
    if (i == inner.end() || *f != *i) return false;
  }
  return i != inner.end();
}

bool ends_with(std::string_view path, std::string_view end) {
  if (path.size() < end.size()) return false;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const char c = path[path.size() - end.size() + i];
    if ((c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c) != end[i]) return false;
  }
  return true;
}

// The scene as the scene reader makes it from its text, so that all of its checks and limits hold for imported files too.
Scene checked(Import& import) {
  std::string text = write_scene(import.scene, {.inline_meshes = true});
  if (!import.exact.empty()) {
    Json json = Json::parse(text);
    import.exact.put_into(json);
    text = json.dump();
  }
  ReadOptions options;
  options.file = import.file;
  options.limits = import.options.limits;
  options.limits.file_bytes = text.size();
  SceneResult<Scene> scene = read_scene(text, options);
  if (!scene) {
    SceneError error = scene.error();
    error.line = error.column = 0;  // of a text that nobody sees
    if (!error.pointer.empty()) error.message = "(of the scene made from it) " + error.message;
    throw error;
  }
  scene->notes = import.scene.notes;
  return *std::move(scene);
}

SceneResult<MeshData> collada_mesh([[maybe_unused]] const Import& import,
                                   [[maybe_unused]] std::string_view bytes, const std::string& file) {
#ifdef GYRE_WITH_XML
  return read_collada(import, bytes, file);
#else
  return SceneError{file, 0, 0, "", "COLLADA is not read by a gyre that was built without tinyxml2"};
#endif
}

}  // namespace

bool is_collada(std::string_view path) { return ends_with(path, ".dae"); }

FileFormat format_of(std::string_view path) {
  if (ends_with(path, ".urdf")) return FileFormat::urdf;
  if (ends_with(path, ".mjcf") || ends_with(path, ".xml")) return FileFormat::mjcf;
  if (ends_with(path, ".gltf") || ends_with(path, ".glb")) return FileFormat::gltf;
  return FileFormat::scene;
}

std::string missing_format([[maybe_unused]] FileFormat format) {
#ifndef GYRE_WITH_XML
  if (format == FileFormat::urdf || format == FileFormat::mjcf)
    return "this gyre was built without tinyxml2 (libtinyxml2-dev), which reads URDF and MJCF";
#endif
  return {};
}

std::string Findings::text() const {
  std::string out;
  for (const auto& [what, count] : counts_)
    out += (out.empty() ? "" : ", ") + what + " (" + std::to_string(count) + ")";
  return out;
}

void Import::fail(std::string message, int line) const {
  throw SceneError{file, line, line > 0 ? 1 : 0, "", std::move(message)};
}

std::string Import::unique(std::set<std::string>& names, std::string name, const char* otherwise) {
  if (name.empty()) name = otherwise;
  if (name == "world") name = "world_body";  // in a scene this is the fixed world
  std::string out = name;
  for (int i = 2; !names.insert(out).second; ++i) out = name + "_" + std::to_string(i);
  return out;
}

std::string Import::read_file(const std::string& uri, const std::string& base, int line) {
  if (const auto given = options.files.find(uri); given != options.files.end()) return given->second;
  if (!options.open_files) fail("names the file \"" + uri + "\", but no files can be opened here", line);
  if (uri.empty() || uri.size() > 1024)
    fail("found a file name that is empty or longer than 1024 bytes", line);
  for (const char c : uri) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\')
      fail("found a file name with a control character or a backslash", line);
  }
  fs::path place;
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  std::string roots_text = folder.empty() ? "." : folder;
  std::vector<fs::path> roots{fs::path(folder.empty() ? "." : folder)};
  std::string path = uri;
  const bool is_package = uri.rfind(kPackage, 0) == 0;
  if (is_package) path = uri.substr(kPackage.size());
  if (uri.rfind(kFile, 0) == 0) path = uri.substr(kFile.size());
  if (path.find("://") != std::string::npos)
    fail("found the address \"" + uri + "\"; nothing is fetched", line);
  const std::string package = is_package ? path.substr(0, path.find('/')) : "";
  std::error_code error;
  for (const std::string& option : options.packages) {
    const std::size_t equals = option.find('=');
    const std::string root = equals == std::string::npos ? option : option.substr(equals + 1);
    roots.emplace_back(root);
    roots_text += ", " + root;
    if (!is_package || !place.empty()) continue;
    if (equals != std::string::npos && option.substr(0, equals) == package && path.size() > package.size()) {
      place = fs::path(root) / path.substr(package.size() + 1);
    } else if (equals == std::string::npos && fs::exists(fs::path(root) / path, error)) {
      place = fs::path(root) / path;
    }
  }
  // Without an option, the folder of the file stands for the package's parent.
  if (is_package && place.empty() && fs::exists(roots[0] / path, error)) place = roots[0] / path;
  if (is_package && place.empty())
    fail("found \"" + uri + "\", but --package names no folder for \"" + package + "\" (as in --package " +
             package + "=FOLDER)",
         line);
  if (place.empty())
    place = fs::path(path).is_absolute() ? fs::path(path) : fs::path(base.empty() ? "." : base) / path;
  place = fs::canonical(place, error);
  if (error) fail("there is no file \"" + uri + "\"", line);
  bool allowed = false;
  for (const fs::path& root : roots) {
    const fs::path whole = fs::canonical(root, error);
    allowed = allowed || (!error && lies_within(whole, place));
  }
  if (!allowed)
    fail("\"" + uri + "\" leads out of the folders that may be read (" + roots_text + "; --package adds one)",
         line);
  std::string out;
  const std::string problem = read_whole_file(place.string(), options.limits, out);
  if (!problem.empty()) fail("\"" + uri + "\" " + problem, line);
  mesh_bytes += out.size();
  if (mesh_bytes > kMaxMeshBytes) fail("names files of more than 1 GiB together", line);
  return out;
}

int Import::add_mesh(MeshData mesh, const std::string& name) {
  SceneMesh out;
  out.name = unique(mesh_names, name, "mesh");
  out.vertices = std::move(mesh.vertices);
  out.indices = std::move(mesh.indices);
  scene.meshes.push_back(std::move(out));
  return int(scene.meshes.size()) - 1;
}

int Import::mesh_index(const std::string& uri, const std::string& base, Vec3 scale, int line) {
  const std::string key = base + "\n" + uri + "\n" + std::to_string(scale.x) + " " + std::to_string(scale.y) +
                          " " + std::to_string(scale.z);
  const auto found = meshes.find(key);
  if (found != meshes.end()) return found->second;
  const std::string file_bytes = read_file(uri, base, line);
  SceneResult<MeshData> mesh =
      is_collada(uri) ? collada_mesh(*this, file_bytes, uri) : parse_mesh(file_bytes, uri, options.limits);
  if (!mesh) throw mesh.error();
  for (Vec3& vertex : mesh->vertices) {
    vertex = multiply_each(scale, vertex);
    if (!is_finite(vertex)) fail("\"" + uri + "\" has a coordinate that is not finite once scaled", line);
  }
  if (scale.x * scale.y * scale.z < 0.0f) {  // mirrored: the triangles turn over
    for (std::size_t i = 0; i + 2 < mesh->indices.size(); i += 3)
      std::swap(mesh->indices[i + 1], mesh->indices[i + 2]);
  }
  const int index = add_mesh(*std::move(mesh), fs::path(uri).stem().string());
  meshes.emplace(key, index);
  return index;
}

SceneGeometry Import::solid_mesh(int mesh, bool moving) const {
  if (!moving) return SceneTriangles{mesh};
  if (options.decompose) {
    SceneDecomposition hulls;
    hulls.mesh = mesh;
    return hulls;
  }
  SceneHull hull;
  hull.mesh = mesh;
  return hull;
}

SceneColor color_of(double red, double green, double blue) {
  const auto byte = [](double part) { return std::uint8_t(clamp(part, 0.0, 1.0) * 255.0 + 0.5); };
  return {byte(red), byte(green), byte(blue)};
}

SceneResult<Scene> import_scene(std::string_view bytes, FileFormat format, const std::string& path,
                                const ImportOptions& options) noexcept {
  try {
    const std::string missing = missing_format(format);
    if (!missing.empty()) return SceneError{path, 0, 0, "", missing};
    Import import{bytes, path, fs::path(path).parent_path().string(), options};
    import.scene.name = fs::path(path).stem().string();
    if (format == FileFormat::gltf) read_gltf(import);
#ifdef GYRE_WITH_XML
    if (format == FileFormat::urdf || format == FileFormat::mjcf) read_urdf_or_mjcf(import);
#endif
    if (!import.findings.empty()) {
      if (options.strict)
        import.fail("holds what is not simulated, which --strict refuses: " + import.findings.text());
      import.scene.notes.push_back(path + ": not simulated: " + import.findings.text());
    }
    return checked(import);
  } catch (SceneError& error) {
    // Words of the file stand in the message, which is one line.
    for (char& c : error.message) {
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    }
    return error;
  } catch (const std::bad_alloc&) {
    return SceneError{path, 0, 0, "", "needs more memory than there is"};
  } catch (const std::exception& error) {
    return SceneError{path, 0, 0, "", error.what()};
  }
}

SceneResult<Scene> open_scene(const std::string& path, const ImportOptions& options) noexcept {
  const FileFormat format = format_of(path);
  if (format == FileFormat::scene) return load_scene(path, options.limits);
  std::string bytes;
  const std::string problem = read_whole_file(path, options.limits, bytes);
  if (!problem.empty()) return SceneError{path, 0, 0, "", problem};
  return import_scene(bytes, format, path, options);
}

SceneResult<Scene> open_split_scene(const std::string& path, const ImportOptions& options,
                                    SplitOptions split) {
  if (format_of(path) == FileFormat::scene) return load_split_scene(path, split);
  SceneResult<Scene> scene = open_scene(path, options);
  if (!scene) return scene;
  DecompositionFolder store(default_decomposition_folder());
  split.store = &store;
  if (std::optional<SceneError> error = split_decompositions(*scene, path, split)) return *std::move(error);
  return scene;
}

}  // namespace gyre
