#include "soft/store/soft_builder.h"

#include "base/container/sort.h"
#include "math/rotation.h"
#include "math/standard_gravity.h"
#include "soft/body/enclosed_gas.h"
#include "soft/elements/cloth.h"
#include "soft/elements/crack_gap.h"
#include "soft/elements/rope.h"
#include "soft/elements/solid.h"
#include "soft/mesh/tetrahedral_fill.h"
#include "soft/mesh/tetrahedron_faces.h"
#include "soft/store/soft_damage.h"

#include <cmath>

namespace gyre {

namespace {

// A rod of a cloth is a spring under which the cloth hangs longer by this share by its own weight.
constexpr double kRodStrain = 1.0e-3;

Pose normalized_pose(const Pose& pose) { return {pose.position, normalized(pose.orientation)}; }

Array<DVec3> placed(std::span<const Vec3> vertices, const Pose& pose) {
  Array<DVec3> places;
  const DQuat turn = to_double(pose.orientation);
  for (const Vec3 vertex : vertices) places.push_back(pose.position + rotate(turn, DVec3(vertex)));
  return places;
}

Array<DVec3> places_of(const SoftBody& body) {
  Array<DVec3> places;
  for (int i = 0; i < body.particles.count; ++i) places.push_back(body.particles.place(i));
  return places;
}

// The diagonal of the box of all vertices, m.
double extent_of(const SoftBody& body) {
  DVec3 low = body.particles.place(0), high = low;
  for (int i = 1; i < body.particles.count; ++i) {
    const DVec3 p = body.particles.place(i);
    low = {min(low.x, p.x), min(low.y, p.y), min(low.z, p.z)};
    high = {max(high.x, p.x), max(high.y, p.y), max(high.z, p.z)};
  }
  return length(high - low);
}

void build(const RopeDef& def, SoftEntry& entry) {
  const int segments = def.segments > 0 ? def.segments : int(def.points.size()) - 1;
  entry.kind = SoftKind::rope;
  entry.radius = def.radius;
  entry.body = rope_along(def.points, segments,
                          {.linear_density = def.linear_density,
                           .stretch_stiffness = def.stretch_stiffness,
                           .bend_stiffness = def.bend_stiffness,
                           .damping = def.settings.damping,
                           .keeps_length = def.links == RopeLinks::rods});
}

void add_grid_triangles(const std::array<int, 2>& cells, Array<std::uint32_t>& triangles) {
  const std::uint32_t columns = std::uint32_t(cells[0]) + 1;
  for (std::uint32_t j = 0; j < std::uint32_t(cells[1]); ++j) {
    for (std::uint32_t i = 0; i < std::uint32_t(cells[0]); ++i) {
      const std::uint32_t a = i + j * columns, b = a + 1, c = a + columns, d = c + 1;
      // Diagonals alternate, so that the sheet has no grain.
      if ((i + j) % 2 == 0) {
        for (const std::uint32_t v : {a, c, d, a, d, b}) triangles.push_back(v);
      } else {
        for (const std::uint32_t v : {a, c, b, b, c, d}) triangles.push_back(v);
      }
    }
  }
}

void set_gas(const ClothDef& def, SoftEntry& entry) {
  EnclosedGas& gas = entry.body.gas;
  gas.triangles = entry.triangles;
  gas.rest_volume = enclosed_volume(entry.body.particles, gas.triangles);
  if (gas.rest_volume < 0.0) {
    gas.rest_volume = -gas.rest_volume;
    for (std::size_t t = 0; t + 2 < gas.triangles.size(); t += 3)
      std::swap(gas.triangles[t + 1], gas.triangles[t + 2]);
  }
  gas.pressure = double(*def.pressure), gas.ambient = double(def.ambient_pressure);
  gas.is_constant = def.pressure_law == PressureLaw::constant;
}

ClothMaterial material_of(const ClothDef& def) {
  return {.links = def.links,
          .area_density = def.area_density,
          .stretch_stiffness = def.stretch_stiffness,
          .shear_stiffness = def.shear_stiffness,
          .bend_stiffness = def.bend_stiffness,
          .damping = def.settings.damping,
          .is_visual = def.settings.integrator == SoftIntegrator::visual};
}
SolidMaterial material_of(const SolidDef& def) {
  return {.density = def.density,
          .young_modulus = def.young_modulus,
          .poisson_ratio = def.poisson_ratio,
          .damping = def.settings.damping,
          .model = ElementModel(def.model)};
}

Array<DVec3> places_of(const ClothDef& def) {
  const Pose pose = normalized_pose(def.pose);
  if (!def.grid) return placed(def.vertices, pose);
  const float size[2] = {def.grid->size[0], def.grid->size[1]};
  const int cells[2] = {def.grid->cells[0], def.grid->cells[1]};
  return grid_places(size, cells, pose);
}
Array<DVec3> places_of(const SolidDef& def) {
  const Pose pose = normalized_pose(def.pose);
  if (!def.box) return placed(def.vertices, pose);
  const int cells[3] = {def.box->cells[0], def.box->cells[1], def.box->cells[2]};
  return box_places(def.box->half_extents, cells, pose);
}

// The stretch stiffness of rods: that of springs under which the cloth hangs longer by a small share by its own weight.
float rod_stiffness(const ClothDef& def, const SoftBody& body) {
  const double weight = double(def.area_density) * kEarthGravity * extent_of(body);
  return float(weight / kRodStrain);
}

void build(const ClothDef& def, SoftEntry& entry) {
  entry.kind = SoftKind::cloth;
  entry.radius = 0.5f * def.thickness;
  ClothMaterial material = material_of(def);
  const Pose pose = normalized_pose(def.pose);
  const auto make = [&] {
    if (def.tear_strain > 0.0f) return mesh_cloth(places_of(def), entry.triangles, material);
    if (!def.grid) {
      return mesh_cloth(placed(def.vertices, pose), def.triangles, material);
    }
    const float size[2] = {def.grid->size[0], def.grid->size[1]};
    const int cells[2] = {def.grid->cells[0], def.grid->cells[1]};
    return grid_cloth(size, cells, pose, material);
  };
  if (def.grid) {
    add_grid_triangles(def.grid->cells, entry.triangles);
  } else {
    entry.triangles.assign(def.triangles);
  }
  if (def.links == ClothLinks::rods) {
    entry.body = make();
    material.stretch_stiffness = rod_stiffness(def, entry.body);
  }
  entry.body = make();
  if (def.pressure) set_gas(def, entry);
}

// The faces that belong to one tetrahedron alone, seen from outside counter-clockwise, in the order of the tetrahedra.
void add_outer_faces(std::span<const std::uint32_t> tetrahedra, std::span<const DVec3> places,
                     Array<std::uint32_t>& triangles) {
  const Array<TetrahedronFace> faces = sorted_faces(tetrahedra);
  Array<TetrahedronFace> outer, scratch;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[i].has_vertices_of(faces[end])) ++end;
    if (end - i == 1) outer.push_back(faces[i]);
    i = end;
  }
  scratch.resize(outer.size());
  merge_sort(outer.view(), scratch.view(), [](const TetrahedronFace& a, const TetrahedronFace& b) {
    return a.tetrahedron != b.tetrahedron ? a.tetrahedron < b.tetrahedron : a.opposite < b.opposite;
  });
  for (const TetrahedronFace& face : outer) {
    const DVec3 a = places[face.low], b = places[face.middle], c = places[face.high],
                inner = places[tetrahedra[4 * std::size_t(face.tetrahedron) + face.opposite]];
    const bool is_outward = dot(cross(b - a, c - a), inner - a) < 0.0;
    triangles.push_back(face.low);
    triangles.push_back(is_outward ? face.middle : face.high);
    triangles.push_back(is_outward ? face.high : face.middle);
  }
}

// The mass is that of the surface's volume, which the tetrahedra do not have exactly.
void build_filled(const SolidSurface& surface, const Pose& pose, SolidMaterial material, SoftEntry& entry) {
  Result<TetrahedralMesh> mesh =
      fill_with_tetrahedra(surface.vertices, surface.triangles, surface.resolution);
  material.density = float(double(material.density) * mesh->surface_volume / mesh->filled_volume);
  entry.body = tetrahedral_solid(placed(mesh->vertices, pose), mesh->tetrahedra, material);
  add_outer_faces(mesh->tetrahedra, places_of(entry.body), entry.triangles);
  entry.surface = std::move(mesh->surface);
}

void build(const SolidDef& def, SoftEntry& entry) {
  entry.kind = SoftKind::solid;
  const SolidMaterial material = material_of(def);
  const Pose pose = normalized_pose(def.pose);
  if (def.box) {
    const int cells[3] = {def.box->cells[0], def.box->cells[1], def.box->cells[2]};
    entry.body = box_solid(def.box->half_extents, cells, pose, material);
    add_outer_faces(box_tetrahedra(cells), places_of(entry.body), entry.triangles);
  } else if (def.surface) {
    build_filled(*def.surface, pose, material, entry);
  } else {
    entry.body = tetrahedral_solid(placed(def.vertices, pose), def.tetrahedra, material);
    add_outer_faces(def.tetrahedra, places_of(entry.body), entry.triangles);
  }
}

// The mean length of the edges of triangles, or of the segments of a rope.
float edge_size(const SoftEntry& entry) {
  const Particles& p = entry.body.particles;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < entry.triangles.size(); ++k) {
    const std::size_t next = k % 3 == 2 ? k - 2 : k + 1;
    sum += length(p.place(int(entry.triangles[k])) - p.place(int(entry.triangles[next])));
    ++count;
  }
  for (const double rest : entry.body.chain.rest_length) sum += rest, ++count;
  return count > 0 ? float(sum / double(count)) : 0.0f;
}

// Solids keep this share of the length of an edge from other surfaces and from themselves. The sides of a crack are twice as far apart at rest, so that they just touch.
constexpr float kSolidRadius = 0.02f;

std::shared_ptr<const SoftSurface> make_surface(const SoftEntry& entry, const SoftDef& def) {
  if (entry.triangles.empty()) return nullptr;
  const Array<DVec3> places = places_of(entry.body);
  const float radius = entry.kind == SoftKind::solid ? kSolidRadius * entry.size : entry.radius;
  SoftSurface surface = make_surface(places, entry.triangles, radius);
  const SoftSettings& settings = entry.settings();
  surface.touches_soft = settings.integrator != SoftIntegrator::visual;
  surface.static_friction = settings.static_friction;
  surface.dynamic_friction = settings.dynamic_friction;
  if (const ClothDef* const cloth = std::get_if<ClothDef>(&def))
    surface.self_collision = cloth->self_collision;
  return std::make_shared<const SoftSurface>(std::move(surface));
}

void set_start(const SoftSettings& settings, Particles& particles) {
  for (std::size_t i = 0; i < settings.positions.size(); ++i)
    particles.set_place(int(i), settings.positions[i]);
  for (std::size_t i = 0; i < settings.velocities.size(); ++i)
    particles.set_velocity(int(i), settings.velocities[i]);
}

}  // namespace

SoftEntry build_soft(std::shared_ptr<const SoftDef> def) {
  SoftEntry entry;
  std::visit([&](const auto& one) { build(one, entry); }, *def);
  entry.size = edge_size(entry);
  entry.def = std::move(def);
  entry.contact_surface = make_surface(entry, *entry.def);
  begin_damage(entry);
  set_start(entry.settings(), entry.body.particles);
  return entry;
}

Array<DVec3> whole_places(const SoftEntry& entry) {
  const ClothDef* const cloth = std::get_if<ClothDef>(entry.def.get());
  Array<DVec3> all = cloth != nullptr ? places_of(*cloth) : places_of(std::get<SolidDef>(*entry.def));
  if (entry.damage.empty()) return all;
  Array<DVec3> places;
  places.reserve(entry.damage.roots.size());
  for (const std::uint32_t root : entry.damage.roots) places.push_back(all[root]);
  return places;
}

Array<DVec3> rest_places(const SoftEntry& entry) {
  Array<DVec3> places = whole_places(entry);
  if (entry.kind != SoftKind::solid) return places;
  const SoftDamage& damage = entry.damage;
  open_cracks(damage.corners, damage.roots, double(2.0f * kSolidRadius * entry.size),
              {places.data(), places.size()});
  return places;
}

SoftBody build_elements(const SoftEntry& entry) {
  const Array<DVec3> places = rest_places(entry);
  const Array<std::uint32_t>& corners = entry.damage.corners;
  if (const ClothDef* const cloth = std::get_if<ClothDef>(entry.def.get())) {
    ClothMaterial material = material_of(*cloth);
    SoftBody body = mesh_cloth(places, corners, material);
    if (cloth->links != ClothLinks::rods) return body;
    material.stretch_stiffness = rod_stiffness(*cloth, body);
    return mesh_cloth(places, corners, material);
  }
  const SolidDef& solid = std::get<SolidDef>(*entry.def);
  Array<std::uint32_t> groups;
  if (solid.box) groups = box_groups({solid.box->cells[0], solid.box->cells[1], solid.box->cells[2]});
  return tetrahedral_solid(places, corners, material_of(solid), groups);
}

void build_surface(SoftEntry& entry) {
  const Array<std::uint32_t>& corners = entry.damage.corners;
  entry.triangles.clear();
  if (entry.kind == SoftKind::cloth) {
    entry.triangles.assign(corners);
  } else {
    add_outer_faces(corners, places_of(entry.body), entry.triangles);
  }
  entry.contact_surface = make_surface(entry, *entry.def);
}

}  // namespace gyre
