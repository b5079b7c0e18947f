// Meshes of a scene: from a file beside it, or with vertices and triangles in place. See scene_parts.h.
#include "scene/mesh_file.h"
#include "scene/scene_parts.h"

namespace gyre {
namespace {

void read_vertices(const Field& field, const SceneLimits& limits, std::vector<Vec3>& out) {
  const std::size_t count = field.array("an array of points");
  if (count < 3) field.expected("at least 3 points");
  if (count > limits.vertices) field.expected("at most " + std::to_string(limits.vertices) + " points");
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.push_back(field.element(i).vec3());
}

void read_triangles(const Field& field, const SceneLimits& limits, std::size_t vertices,
                    std::vector<std::uint32_t>& out) {
  const std::size_t count = field.array("an array of triangles");
  if (count < 1) field.expected("at least 1 triangle");
  if (count > limits.triangles) field.expected("at most " + std::to_string(limits.triangles) + " triangles");
  out.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const Field triangle = field.element(i);
    triangle.array("an array of 3 vertex numbers", 3);
    for (std::size_t k = 0; k < 3; ++k) {
      out.push_back(std::uint32_t(triangle.element(k).integer(0, std::int64_t(vertices) - 1)));
    }
  }
}

std::string file_not_here(const Field& file, const ReadOptions& options) {
  std::string text = "found " + file.found() + ", but no files can be opened here";
  if (options.files.empty()) return text;
  text += "; given were:";
  for (const auto& [name, bytes] : options.files) text += " \"" + name + "\"";
  return text;
}

}  // namespace

void read_mesh(SceneReading& reading, const Field& field, const std::string& name) {
  const ReadOptions& options = reading.options;
  Members members(field, "a mesh");
  SceneMesh mesh;
  mesh.name = name;
  if (const auto file = members.find("file")) {
    members.refuse("vertices", "a mesh is given by \"file\" or by \"vertices\" and \"triangles\", not both");
    members.refuse("triangles", "a mesh is given by \"file\" or by \"vertices\" and \"triangles\", not both");
    mesh.file = file->text();
    const std::string refusal = refuse_mesh_path(mesh.file);
    if (!refusal.empty()) file->fail("found " + file->found() + ", " + refusal);
    const auto given = options.files.find(mesh.file);
    const bool here = given != options.files.end();
    if (!here && !options.mesh_files) file->fail(file_not_here(*file, options));
    SceneResult<MeshData> data = here ? parse_mesh(given->second, mesh.file, options.limits)
                                      : load_mesh_file(options.folder, mesh.file, options.limits);
    if (!data) file->fail(data.error().text());
    mesh.vertices = std::move(data->vertices);
    mesh.indices = std::move(data->indices);
  } else {
    read_vertices(members.need("vertices"), options.limits, mesh.vertices);
    read_triangles(members.need("triangles"), options.limits, mesh.vertices.size(), mesh.indices);
  }
  members.finish();
  reading.meshes.emplace(name, int(reading.scene.meshes.size()));
  reading.scene.meshes.push_back(std::move(mesh));
}

}  // namespace gyre
