// Mass properties in double precision, for the public functions of gyre/geometry.h.
//
// In: shapes, triangles. Out: Solid, the volume integrals of a body. Rounding to float is the last step, so small
// bodies far from their origin and large ones with small holes stay precise.
// Sources: B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996; J. Blow, A. Binstock, "How
// to Find the Inertia Tensor of Any Rigid Body", 2004 (integrals as sums over tetrahedra); textbook closed forms.
#pragma once

#include <gyre/geometry.h>

#include <cstdint>
#include <span>

namespace gyre {

// Second moments of a body about a point: integrals of x x, y y, z z, x y, x z, y z times density.
struct SecondMoments {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};
inline void add_product(SecondMoments& m, double weight, DVec3 a) {
  m.xx += weight * a.x * a.x;
  m.yy += weight * a.y * a.y;
  m.zz += weight * a.z * a.z;
  m.xy += weight * a.x * a.y;
  m.xz += weight * a.x * a.z;
  m.yz += weight * a.y * a.z;
}

// Mass, centre of mass, and second moments about it.
struct Solid {
  double mass = 0.0;
  DVec3 center;
  SecondMoments moments;
};

// The inertia tensor is trace(C) - C for the second moments C.
MassProperties to_mass_properties(const Solid& solid);
Solid to_solid(const MassProperties& mass);

// check_density: the error of an unusable density. checked_mass: the result, or an error if it does not fit a float.
Error check_density(double density, const char* unit);
Result<MassProperties> checked_mass(const Solid& solid, const char* shape);

// Sums signed tetrahedra from one point to many triangles. The sum is exact for the solid inside a closed surface.
class TetrahedronSum {
 public:
  // `middle` should be near the centre of the triangles, where rounding errors are smallest.
  explicit TetrahedronSum(DVec3 middle) : middle_(middle) {}
  void add(DVec3 a, DVec3 b, DVec3 c);
  double volume() const { return volume_; }
  Solid solid(double density) const;

 private:
  DVec3 middle_;
  double volume_ = 0.0;
  DVec3 first_;  // integral of the position relative to middle_
  SecondMoments second_;
};

// The exact integrals of a closed mesh. `source` has the numbers by which errors name triangles; if empty, their
// indices.
Result<Solid> closed_mesh_solid(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                std::span<const std::uint32_t> source, double density);

}  // namespace gyre
