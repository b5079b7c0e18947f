// Fits each kind of bounding volume to a mesh. See mesh_bounds.h.
#include "mesh_bounds.h"

#include "scene/number_text.h"

#include <gyre/bounds.h>

#include <array>
#include <optional>

namespace gyre {
namespace {

struct MeshBounds {
  std::optional<double> volume;  // of what the triangles enclose
  std::string open;              // or why they enclose nothing
  std::array<std::optional<BoundCost>, kBoundKindCount> costs;

  std::optional<double> hull_volume() const {
    const std::optional<BoundCost>& hull = costs[std::size_t(BoundKind::hull)];
    return hull ? std::optional(hull->volume) : std::nullopt;
  }
};

MeshBounds measure(const SceneMesh& mesh) {
  MeshBounds found;
  const Result<MassProperties> solid = mesh_mass(mesh.vertices, mesh.indices, 1.0f);
  if (solid) {
    found.volume = double(solid->mass);
  } else {
    found.open = solid.error().message;
  }
  for (int kind = 0; kind < kBoundKindCount; ++kind) {
    if (const Result<BoundCost> cost = bound_cost(mesh.vertices, BoundKind(kind)))
      found.costs[std::size_t(kind)] = *cost;
  }
  return found;
}

std::string number(std::optional<double> value) {
  std::string out;
  if (value) {
    append_rounded(out, *value, 6);
  } else {
    out = "-";
  }
  return out;
}
std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  return a && b && *b > 0.0 ? std::optional(*a / *b) : std::nullopt;
}
std::string column(const std::string& text) {
  return std::string(text.size() < 14 ? 14 - text.size() : 1, ' ') + text;
}

}  // namespace

void append_mesh_bounds(std::string& out, const SceneMesh& mesh) {
  const MeshBounds found = measure(mesh);
  out += "\nmesh \"" + mesh.name + "\", " + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.indices.size() / 3) + " triangles\n";
  out += found.volume ? "  volume           " + number(found.volume) + " m^3\n"
                      : "  no volume        " + found.open + "\n";
  out += "  bounding volume         m^3           m^2   times hull   times mesh\n";
  for (int kind = 0; kind < kBoundKindCount; ++kind) {
    const std::optional<BoundCost>& cost = found.costs[std::size_t(kind)];
    const std::optional<double> volume = cost ? std::optional(cost->volume) : std::nullopt;
    std::string name = to_string(BoundKind(kind));
    name.resize(17, ' ');
    out += "  " + name + column(number(volume)).substr(4) +
           column(number(cost ? std::optional(cost->surface_area) : std::nullopt)) +
           column(number(ratio(volume, found.hull_volume()))).substr(1) +
           column(number(ratio(volume, found.volume))).substr(1) + "\n";
  }
}

void write_mesh_bounds(JsonWriter& json, const SceneMesh& mesh) {
  const MeshBounds found = measure(mesh);
  const auto field = [&](const char* name, std::optional<double> value) {
    if (value) {
      json.field(name, *value);
    } else {
      json.key(name).null();
    }
  };
  json.begin_object();
  json.field("name", mesh.name);
  json.field("vertices", std::int64_t(mesh.vertices.size()));
  json.field("triangles", std::int64_t(mesh.indices.size() / 3));
  field("volume", found.volume);
  json.key("bounds").begin_object();
  for (int kind = 0; kind < kBoundKindCount; ++kind) {
    const std::optional<BoundCost>& cost = found.costs[std::size_t(kind)];
    json.key(to_string(BoundKind(kind)));
    if (!cost) {
      json.null();
      continue;
    }
    json.begin_object(JsonLayout::one_line);
    json.field("volume", cost->volume);
    json.field("surface_area", cost->surface_area);
    field("times_hull", ratio(cost->volume, found.hull_volume()));
    field("times_mesh", ratio(cost->volume, found.volume));
    json.end_object();
  }
  json.end_object();
  json.end_object();
}

}  // namespace gyre
