// Volume integrals over closed triangle meshes, and the errors of meshes that bound no solid. See mass.h.
#include "base/float_mode.h"
#include "geometry/mass/closed_surface.h"
#include "geometry/mass/mass.h"
#include "geometry/shape/mesh_weld.h"

#include <vector>

namespace gyre {
namespace {

DVec3 middle_of(const TriangleSurface& surface) {
  Vec3 low = surface.vertices[surface.indices[0]], high = low;
  for (const std::uint32_t i : surface.indices) {
    low = min(low, surface.vertices[i]);
    high = max(high, surface.vertices[i]);
  }
  return 0.5 * (DVec3(low) + DVec3(high));
}

}  // namespace

Result<Solid> closed_mesh_solid(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                std::span<const std::uint32_t> source, double density) {
  TriangleSurface surface{vertices, indices, source, {}};
  if (const Error error = check_surface_data(surface)) return error;
  const std::vector<std::uint32_t> welded = weld_vertices(vertices, indices);
  surface.welded = welded;
  if (const Error error = check_edges(surface)) return error;

  TetrahedronSum sum(middle_of(surface));
  double size = 0.0;  // the scale of rounding errors
  for (std::uint32_t i = 0; i < surface.triangle_count(); ++i) {
    const double before = sum.volume();
    sum.add(surface.corner(i, 0), surface.corner(i, 1), surface.corner(i, 2));
    size += absolute(sum.volume() - before);
  }
  if (absolute(sum.volume()) <= 1.0e-12 * size) {
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: its %u triangles enclose %g m^3; allowed are surfaces that enclose a volume",
                      surface.triangle_count(), sum.volume());
  }
  if (sum.volume() < 0.0) {
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: is inside out (volume %g m^3, from triangle %u on); allowed are triangles wound "
                      "counter-clockwise seen from outside",
                      sum.volume(), surface.name(0));
  }
  if (const Error error = check_covered_once(surface)) return error;
  return sum.solid(density);
}

Result<MassProperties> mesh_mass(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                 float density) {
  const FloatMode mode;
  if (const Error error = check_density(double(density), "kg/m^3"))
    return error;
  const Result<Solid> solid = closed_mesh_solid(vertices, indices, {}, double(density));
  if (!solid) return solid.error();
  return checked_mass(*solid, "mesh");
}

}  // namespace gyre
