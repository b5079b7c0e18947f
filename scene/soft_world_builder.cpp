// Ropes, cloths and soft bodies of a scene in a world that has its bodies. See world_builder.h.
#include "scene/world_builder.h"

#include "scene/number_text.h"

#include <string_view>

namespace gyre {
namespace {

std::string soft_pointer(const char* section, std::size_t index) {
  return std::string("/") + section + "/" + std::to_string(index);
}

constexpr std::string_view kSoftMembers[] = {"points",
                                             "segments",
                                             "radius",
                                             "linear_density",
                                             "stretch_stiffness",
                                             "bend_stiffness",
                                             "vertices",
                                             "triangles",
                                             "tetrahedra",
                                             "area_density",
                                             "shear_stiffness",
                                             "thickness",
                                             "pressure",
                                             "ambient_pressure",
                                             "tear_strain",
                                             "fracture_stress",
                                             "yield_stress",
                                             "creep_time",
                                             "grid",
                                             "box",
                                             "density",
                                             "young_modulus",
                                             "poisson_ratio",
                                             "state",
                                             "integrator",
                                             "damping",
                                             "position",
                                             "orientation",
                                             "mesh",
                                             "resolution",
                                             "static_friction",
                                             "dynamic_friction"};

// The engine's messages begin with the member that they are about: settings.positions[3], surface.mesh. Returns the pointer to it
// below an entry; empty if it is none of the format.
std::string member_pointer(std::string_view message) {
  std::string path;
  for (const char c : message.substr(0, message.find_first_of(" :"))) {
    if (c == '.' || c == '[') {
      path += '/';
    } else if (c != ']') {
      path += c;
    }
  }
  for (const auto& [from, to] :
       {std::pair<std::string_view, const char*>{"settings/positions", "state/positions"},
        {"settings/velocities", "state/velocities"},
        {"settings/", ""},
        {"pose/", ""},
        {"surface/", ""}}) {
    if (path.compare(0, from.size(), from) == 0) path = to + path.substr(from.size());
  }
  const std::string_view first = std::string_view(path).substr(0, path.find('/'));
  for (const std::string_view member : kSoftMembers) {
    if (member == first) return "/" + path;
  }
  return {};
}

}  // namespace

bool WorldBuilder::blame_soft(const std::string& pointer, const SceneSoft& soft) {
  const std::string why = last_refusal();
  std::string member = member_pointer(why);
  // Vertices and triangles stand in the mesh, not in the entry.
  const bool is_of_mesh = member.compare(0, 10, "/triangles") == 0 || member.compare(0, 9, "/vertices") == 0;
  if (is_of_mesh && pointer.compare(0, 7, "/cloths") == 0) member = "/mesh";
  return fail(pointer + member, "\"" + soft.name + "\": " + why);
}

bool WorldBuilder::hold(const SceneSoft& soft, SoftId id, const std::string& pointer) {
  const int count = world_.soft_info(id).vertices;
  for (std::size_t i = 0; i < soft.holds.size(); ++i) {
    const SceneHold& one = soft.holds[i];
    // Only of a filled surface the reader cannot know.
    if (one.vertex >= count) {
      const std::string place = one.body < 0 ? "/pinned/" + std::to_string(i) : std::string("/pinned_to");
      return fail(pointer + place, "found vertex " + std::to_string(one.vertex) +
                                       ", expected one from 0 to " + std::to_string(count - 1));
    }
    const bool done = one.body < 0 ? world_.pin(id, one.vertex)
                                   : world_.attach(id, one.vertex, bodies_[std::size_t(one.body)]);
    if (!done) return fail(pointer, last_refusal());
  }
  return hold_points(soft, id, pointer);
}

bool WorldBuilder::hold_points(const SceneSoft& soft, SoftId id, const std::string& pointer) {
  if (anchors_.size() <= id.index) anchors_.resize(id.index + 1);
  const SoftVertices vertices = world_.vertices(id);
  const std::span<const std::uint32_t> corners = world_.soft_triangles(id);
  double edges = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    edges += length(vertices.position(corners[k]) - vertices.position(corners[k % 3 == 2 ? k - 2 : k + 1]));
  const double edge = edges / double(corners.size());
  for (std::size_t i = 0; i < soft.points.size(); ++i) {
    const SceneHeldPoint& one = soft.points[i];
    const SoftPoint point = world_.nearest_soft_point(id, one.place);
    DVec3 place{};
    for (std::size_t k = 0; k < 4; ++k)
      place += double(point.weights[k]) * vertices.position(std::size_t(point.vertices[k]));
    const double apart = length(place - one.place);
    if (!(apart <= edge))
      return fail(pointer + "/pinned_to", "found a point " + rounded(apart) + " m away from it, expected one within an edge (" +
                                              rounded(edge) + " m)");
    const BodyId body = one.body < 0 ? BodyId{} : bodies_[std::size_t(one.body)];
    const bool done = one.body < 0 ? world_.pin_point(id, point) : world_.attach_point(id, point, body);
    if (!done) return fail(pointer + "/pinned_to", last_refusal());
    anchors_[id.index].push_back(one.body < 0 ? place : DVec3(inverse_times(world_.pose(body), place)));
  }
  return true;
}

bool WorldBuilder::pin_region(const SceneSoftBody& solid, SoftId id, const std::string& pointer) {
  std::vector<int>& pins = region_pins_.emplace_back();
  if (!solid.pinned_region) return true;
  const DVec3 low = solid.pinned_region->low, high = solid.pinned_region->high;
  const SoftVertices vertices = world_.vertices(id);
  std::vector<bool> held(vertices.size(), false);
  for (const SceneHold& one : solid.holds) held[std::size_t(one.vertex)] = true;
  bool any = false;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const DVec3 p = vertices.position(i);
    const bool is_in =
        p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
    any = any || is_in;
    if (is_in && !held[i]) pins.push_back(int(i));
  }
  if (!any)
    return fail(pointer + "/pinned_region", "found no vertex of \"" + solid.name + "\" in this box of the world, expected some");
  for (const int vertex : pins) {
    if (!world_.pin(id, vertex)) return fail(pointer + "/pinned_region", last_refusal());
  }
  return true;
}

bool WorldBuilder::add_soft_matter() {
  for (std::size_t i = 0; i < scene_.ropes.size(); ++i) {
    const SceneRope& rope = scene_.ropes[i];
    const std::string pointer = soft_pointer("ropes", i);
    RopeDef def = rope.def;
    def.settings.user_data = i;
    ropes_.push_back(world_.add_rope(def));
    if (!ropes_.back()) return blame_soft(pointer, rope);
    if (!hold(rope, ropes_.back(), pointer)) return false;
  }
  for (std::size_t i = 0; i < scene_.cloths.size(); ++i) {
    const SceneCloth& cloth = scene_.cloths[i];
    const std::string pointer = soft_pointer("cloths", i);
    ClothDef def = cloth.def;
    def.settings.user_data = i;
    if (cloth.mesh >= 0) {
      def.vertices = scene_.meshes[std::size_t(cloth.mesh)].vertices;
      def.triangles = scene_.meshes[std::size_t(cloth.mesh)].indices;
    }
    cloths_.push_back(world_.add_cloth(def));
    if (!cloths_.back()) return blame_soft(pointer, cloth);
    if (!hold(cloth, cloths_.back(), pointer)) return false;
  }
  for (std::size_t i = 0; i < scene_.soft_bodies.size(); ++i) {
    const SceneSoftBody& solid = scene_.soft_bodies[i];
    const std::string pointer = soft_pointer("soft_bodies", i);
    SolidDef def = solid.def;
    def.settings.user_data = i;
    if (solid.mesh >= 0) {
      const SceneMesh& mesh = scene_.meshes[std::size_t(solid.mesh)];
      def.surface = SolidSurface{mesh.vertices, mesh.indices, solid.resolution};
    }
    soft_bodies_.push_back(world_.add_solid(def));
    if (!soft_bodies_.back()) return blame_soft(pointer, solid);
    if (!hold(solid, soft_bodies_.back(), pointer) || !pin_region(solid, soft_bodies_.back(), pointer))
      return false;
  }
  return true;
}

}  // namespace gyre
