// The checks of definitions. See soft_builder.h.
#include "base/container/sort.h"
#include "soft/mesh/tetrahedral_fill.h"
#include "soft/mesh/tetrahedron_faces.h"
#include "soft/store/soft_builder.h"

namespace gyre {

namespace {

constexpr float kLargest = 1.0e12f;   // of lengths and stiffness, in their units
constexpr double kFarthest = 1.0e12;  // m
constexpr std::size_t kMaxElements = 8u << 20;

Error refused(const char* words) { return make_error(ErrorCode::invalid_argument, "%s", words); }
template <class... Args>
Error refused(const char* format, Args... args) {
  return make_error(ErrorCode::invalid_argument, format, args...);
}

Error above_zero(const char* field, float value) {
  if (is_finite(value) && value > 0.0f && value <= kLargest) return {};
  return refused("%s is %g; it must be above 0 and at most 1e12", field, double(value));
}
Error not_negative(const char* field, float value) {
  if (is_finite(value) && value >= 0.0f && value <= kLargest) return {};
  return refused("%s is %g; it must be at least 0 and at most 1e12", field, double(value));
}
Error within_bounds(const char* field, std::size_t index, DVec3 p) {
  if (is_finite(p) && absolute(p.x) <= kFarthest && absolute(p.y) <= kFarthest && absolute(p.z) <= kFarthest)
    return {};
  return refused("%s[%zu] is (%g, %g, %g); every component must be finite and within 1e12 m", field, index,
                 p.x, p.y, p.z);
}
Error good_pose(const Pose& pose) {
  const Error e = within_bounds("pose.position", 0, pose.position);
  if (e) return e;
  const float size = dot(pose.orientation, pose.orientation);
  if (is_finite(pose.orientation) && size > 1.0e-12f && is_finite(size)) return {};
  return refused("pose.orientation is (%g, %g, %g, %g); it must be a finite quaternion that is not zero",
                 double(pose.orientation.x), double(pose.orientation.y), double(pose.orientation.z),
                 double(pose.orientation.w));
}
Error good_count(std::size_t vertices) {
  if (vertices <= std::size_t(kMaxSoftVertices)) return {};
  return refused("there are %zu vertices; at most %d are possible", vertices, kMaxSoftVertices);
}

Error good_settings(const SoftSettings& s, std::size_t vertices) {
  Error e = not_negative("settings.damping", s.damping);
  if (e.ok()) e = not_negative("settings.static_friction", s.static_friction);
  if (e.ok()) e = not_negative("settings.dynamic_friction", s.dynamic_friction);
  if (e.ok() && !s.positions.empty() && s.positions.size() != vertices)
    e = refused("settings.positions has %zu entries; there are %zu vertices", s.positions.size(), vertices);
  if (e.ok() && !s.velocities.empty() && s.velocities.size() != vertices)
    e = refused("settings.velocities has %zu entries; there are %zu vertices", s.velocities.size(), vertices);
  for (std::size_t i = 0; e.ok() && i < s.positions.size(); ++i)
    e = within_bounds("settings.positions", i, s.positions[i]);
  for (std::size_t i = 0; e.ok() && i < s.velocities.size(); ++i)
    e = within_bounds("settings.velocities", i, DVec3(s.velocities[i]));
  return e;
}

// Checks vertices and the indices of elements of `corners` vertices each. A vertex without an element has no mass.
Error good_elements(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                    std::size_t corners, const char* element) {
  Error e = good_count(vertices.size());
  if (e) return e;
  if (indices.empty() || indices.size() % corners != 0)
    return refused("%s has %zu indices; it must have %zu for each, and at least one", element, indices.size(),
                   corners);
  if (indices.size() / corners > kMaxElements)
    return refused("%s has %zu elements; at most %zu are possible", element, indices.size() / corners,
                   kMaxElements);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    e = within_bounds("vertices", i, DVec3(vertices[i]));
    if (e) return e;
  }
  Array<std::uint8_t> used;
  used.resize(vertices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= vertices.size())
      return refused("%s[%zu] has vertex %u; there are %zu vertices", element, i / corners, indices[i],
                     vertices.size());
    for (std::size_t k = i - i % corners; k < i; ++k) {
      if (indices[k] == indices[i])
        return refused("%s[%zu] has vertex %u twice", element, i / corners, indices[i]);
    }
    used[indices[i]] = 1;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (used[i] == 0)
      return refused("vertices[%zu] belongs to none of %s; it would have no mass", i, element);
  }
  return {};
}

Error has_areas(const ClothDef& def) {
  for (std::size_t t = 0; t + 2 < def.triangles.size(); t += 3) {
    const DVec3 a(def.vertices[def.triangles[t]]), b(def.vertices[def.triangles[t + 1]]),
        c(def.vertices[def.triangles[t + 2]]);
    const double longest = max(length(b - a), max(length(c - a), length(c - b)));
    // Heights below this share of the longest side are lost in the rounding of float.
    if (length(cross(b - a, c - a)) > 1.0e-6 * longest * longest) continue;
    return refused("triangles[%zu] has no area", t / 3);
  }
  return {};
}

Error has_volumes(const SolidDef& def) {
  for (std::size_t t = 0; t + 3 < def.tetrahedra.size(); t += 4) {
    const DVec3 a(def.vertices[def.tetrahedra[t]]);
    const DVec3 b = DVec3(def.vertices[def.tetrahedra[t + 1]]) - a,
                c = DVec3(def.vertices[def.tetrahedra[t + 2]]) - a,
                d = DVec3(def.vertices[def.tetrahedra[t + 3]]) - a;
    const double longest = max(length(b), max(length(c), length(d))), volume = dot(b, cross(c, d)) / 6.0;
    if (!(absolute(6.0 * volume) > 1.0e-7 * longest * longest * longest))
      return refused("tetrahedra[%zu] has no volume", t / 4);
    if (volume < 0.0)
      return refused(
          "tetrahedra[%zu] is inverted: its volume is %g m^3; seen from its last corner the others go clockwise",
          t / 4, volume);
  }
  return {};
}

// Tetrahedra that have a face in common lie on its two sides.
Error has_separate_neighbours(const SolidDef& def) {
  const Array<TetrahedronFace> faces = sorted_faces(def.tetrahedra);
  const auto is_above = [&](const TetrahedronFace& face) {
    const DVec3 a(def.vertices[face.low]);
    const DVec3 b = DVec3(def.vertices[face.middle]) - a, c = DVec3(def.vertices[face.high]) - a;
    return dot(cross(b, c),
               DVec3(def.vertices[def.tetrahedra[4 * std::size_t(face.tetrahedron) + face.opposite]]) - a) >
           0.0;
  };
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    const TetrahedronFace* side[2] = {};  // below and above
    for (; end < faces.size() && faces[end].has_vertices_of(faces[begin]); ++end) {
      const TetrahedronFace*& here = side[is_above(faces[end]) ? 1 : 0];
      if (here != nullptr)
        return refused("tetrahedra[%u] and tetrahedra[%u] overlap: they lie on the same side of their common face",
                       here->tetrahedron, faces[end].tetrahedron);
      here = &faces[end];
    }
  }
  return {};
}

// Each edge of a closed surface whose triangles are alike belongs to two of them, which go along it in opposite directions.
bool is_closed(std::span<const std::uint32_t> triangles) {
  Array<std::uint64_t> keys, scratch_keys;
  Array<std::uint32_t> side, scratch_side;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t from = triangles[i], to = triangles[i % 3 == 2 ? i - 2 : i + 1];
    keys.push_back(std::uint64_t(min(from, to)) << 32 | max(from, to));
    side.push_back(from < to ? 1 : 0);
  }
  scratch_keys.resize(keys.size()), scratch_side.resize(keys.size());
  radix_sort_pairs(keys, side, scratch_keys, scratch_side);
  if (keys.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < keys.size(); i += 2) {
    if (keys[i] != keys[i + 1] || side[i] == side[i + 1] || (i > 0 && keys[i] == keys[i - 1])) return false;
  }
  return true;
}

Error good_gas(const ClothDef& def) {
  const Error e = not_negative("ambient_pressure", def.ambient_pressure);
  if (e) return e;
  const float pressure = *def.pressure;
  if (!is_finite(pressure) || absolute(pressure) > kLargest)
    return refused("pressure is %g; it must be finite and within 1e12 Pa", double(pressure));
  if (def.pressure_law == PressureLaw::ideal_gas && !(pressure + def.ambient_pressure > 0.0f))
    return refused("pressure is %g and ambient_pressure %g; a gas needs a sum above 0", double(pressure), double(def.ambient_pressure));
  if (def.grid) return refused("pressure is given for a grid; only a closed cloth of triangles holds gas");
  if (!is_closed(def.triangles))
    return refused("pressure is given for an open cloth; every edge must belong to two triangles that are alike");
  double volume = 0.0;
  const DVec3 origin(def.vertices[0]);
  for (std::size_t t = 0; t + 2 < def.triangles.size(); t += 3) {
    const auto corner = [&](std::size_t k) { return DVec3(def.vertices[def.triangles[t + k]]) - origin; };
    volume += dot(corner(0), cross(corner(1), corner(2))) / 6.0;
  }
  if (!(absolute(volume) > 0.0)) return refused("pressure is given for a cloth that encloses no volume");
  return {};
}

// Sets how many vertices the box has.
Error good_box(const SolidBox& box, std::size_t& vertices) {
  Error e = above_zero("box.half_extents.x", box.half_extents.x);
  if (e.ok()) e = above_zero("box.half_extents.y", box.half_extents.y);
  if (e.ok()) e = above_zero("box.half_extents.z", box.half_extents.z);
  vertices = 1;
  for (const int cells : box.cells) {
    if (e.ok() && (cells < 1 || cells > 256))
      e = refused("box.cells has %d; it must lie within 1 and 256", cells);
    vertices *= e.ok() ? std::size_t(cells) + 1 : 1;
  }
  return e.ok() ? good_count(vertices) : e;
}

// Fills the surface, since only that tells whether it can be done, and how many vertices it takes.
Error good_surface(const SolidSurface& surface, std::size_t& vertices) {
  const Result<TetrahedralMesh> mesh =
      fill_with_tetrahedra(surface.vertices, surface.triangles, surface.resolution);
  if (!mesh) return make_error(mesh.error().code, "surface.%s", mesh.error().message);
  vertices = mesh->vertices.size();
  return good_count(vertices);
}

}  // namespace

Error check_soft(const RopeDef& def) {
  if (def.points.size() < 2)
    return refused("points has %zu entries; a rope needs at least 2", def.points.size());
  Error e = good_count(max(def.points.size(), def.segments > 0 ? std::size_t(def.segments) + 1 : 0));
  double whole = 0.0;
  for (std::size_t i = 0; e.ok() && i < def.points.size(); ++i) {
    e = within_bounds("points", i, def.points[i]);
    if (i > 0) whole += length(def.points[i] - def.points[i - 1]);
  }
  if (e) return e;
  if (def.segments < 0)
    return refused("segments is %d; it must be at least 1, or 0 for the points as they are", def.segments);
  if (!(whole > 0.0)) return refused("points lie in one place; a rope needs a length");
  const bool as_given = def.segments == 0 || std::size_t(def.segments) + 1 == def.points.size();
  for (std::size_t i = 1; as_given && i < def.points.size(); ++i) {
    if (!(length(def.points[i] - def.points[i - 1]) > 1.0e-9 * whole))
      return refused("points[%zu] lies where points[%zu] does; a segment needs a length", i, i - 1);
  }
  e = not_negative("radius", def.radius);
  if (e.ok()) e = above_zero("linear_density", def.linear_density);
  if (e.ok() && def.links == RopeLinks::springs) e = above_zero("stretch_stiffness", def.stretch_stiffness);
  if (e.ok()) e = not_negative("stretch_stiffness", def.stretch_stiffness);
  if (e.ok()) e = not_negative("bend_stiffness", def.bend_stiffness);
  if (e) return e;
  return good_settings(def.settings, def.segments > 0 ? std::size_t(def.segments) + 1 : def.points.size());
}

Error check_soft(const ClothDef& def) {
  Error e;
  std::size_t vertices = def.vertices.size();
  if (def.grid) {
    const ClothGrid& grid = *def.grid;
    if (!def.vertices.empty() || !def.triangles.empty())
      return refused("grid and triangles are both given; a cloth is one of them");
    e = above_zero("grid.size[0]", grid.size[0]);
    if (e.ok()) e = above_zero("grid.size[1]", grid.size[1]);
    for (const int cells : grid.cells) {
      if (e.ok() && (cells < 1 || cells > 4096))
        e = refused("grid.cells has %d; it must lie within 1 and 4096", cells);
    }
    if (e) return e;
    vertices = (std::size_t(grid.cells[0]) + 1) * (std::size_t(grid.cells[1]) + 1);
    e = good_count(vertices);
  } else {
    if (def.vertices.empty()) return refused("neither grid nor vertices are given; a cloth is one of them");
    e = good_elements(def.vertices, def.triangles, 3, "triangles");
    if (e.ok()) e = has_areas(def);
  }
  if (e.ok()) e = good_pose(def.pose);
  if (e.ok()) e = above_zero("area_density", def.area_density);
  if (e.ok())
    e = def.links == ClothLinks::rods ? not_negative("stretch_stiffness", def.stretch_stiffness)
                                      : above_zero("stretch_stiffness", def.stretch_stiffness);
  // A grid that may tear is made of triangles.
  const bool needs_shear = def.links == ClothLinks::membrane && (!def.grid || def.tear_strain > 0.0f);
  if (e.ok())
    e = needs_shear ? above_zero("shear_stiffness", def.shear_stiffness)
                    : not_negative("shear_stiffness", def.shear_stiffness);
  // An isotropic sheet has 4 G > E: its Poisson ratio is below 1.
  if (e.ok() && needs_shear && !(4.0f * def.shear_stiffness > def.stretch_stiffness))
    e = refused(
        "shear_stiffness is %g; a membrane of triangles needs more than a quarter of stretch_stiffness, %g",
        double(def.shear_stiffness), double(def.stretch_stiffness));
  if (e.ok()) e = not_negative("bend_stiffness", def.bend_stiffness);
  if (e.ok()) e = not_negative("thickness", def.thickness);
  if (e.ok() && def.pressure) e = good_gas(def);
  if (e.ok()) e = not_negative("tear_strain", def.tear_strain);
  if (e.ok() && def.settings.integrator == SoftIntegrator::visual && (def.links == ClothLinks::membrane || def.pressure))
    e = refused("settings.integrator is visual; it moves cloths of springs or rods without gas");
  return e ? e : good_settings(def.settings, vertices);
}

Error check_soft(const SolidDef& def) {
  Error e;
  std::size_t vertices = 0;
  const int forms = int(def.box.has_value()) + int(def.surface.has_value()) +
                    int(!def.vertices.empty() || !def.tetrahedra.empty());
  if (forms > 1) return refused("%d of box, surface and tetrahedra are given; a solid is one of them", forms);
  if (def.box) {
    e = good_box(*def.box, vertices);
  } else if (def.surface) {
    e = good_surface(*def.surface, vertices);
  } else {
    if (def.vertices.empty())
      return refused("neither box nor surface nor vertices are given; a solid is one of them");
    vertices = def.vertices.size();
    e = good_elements(def.vertices, def.tetrahedra, 4, "tetrahedra");
    if (e.ok()) e = has_volumes(def);
    if (e.ok()) e = has_separate_neighbours(def);
  }
  if (e.ok()) e = good_pose(def.pose);
  if (e.ok()) e = above_zero("density", def.density);
  if (e.ok()) e = above_zero("young_modulus", def.young_modulus);
  if (e.ok() && !(def.poisson_ratio > -1.0f && def.poisson_ratio < 0.5f))
    e = refused("poisson_ratio is %g; it must lie between -1 and 1/2", double(def.poisson_ratio));
  if (e.ok()) e = not_negative("fracture_stress", def.fracture_stress);
  if (e.ok()) e = not_negative("yield_stress", def.yield_stress);
  if (e.ok()) e = not_negative("creep_time", def.creep_time);
  if (e.ok() && def.fracture_stress > 0.0f && def.surface)
    e = refused("fracture_stress is given for a filled surface; only boxes and tetrahedra break");
  if (e.ok() && def.yield_stress > 0.0f && def.model == SolidModel::linear)
    e = refused("yield_stress is given for the linear model; corotated and neo_hookean yield");
  if (e.ok() && def.settings.integrator == SoftIntegrator::visual)
    e = refused("settings.integrator is visual; it moves ropes and cloths, not solids");
  return e ? e : good_settings(def.settings, vertices);
}

}  // namespace gyre
