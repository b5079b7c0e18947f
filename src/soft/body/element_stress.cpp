#include "soft/body/element_stress.h"

#include "math/dense.h"
#include "soft/body/deformation.h"

#include <cmath>

namespace gyre {

namespace {

// The principal strains, and their axes in the world, the columns of a rotation.
void find_principal_strains(const SoftBody& body, std::size_t tetrahedron, double (&strain)[3],
                            double (&axes)[9]) {
  DVec3 f[3];
  find_stressed_deformation(body, tetrahedron, f);
  double left[6] = {}, moments[3];
  for (const DVec3& c : f) {
    left[0] += c.x * c.x, left[1] += c.y * c.y, left[2] += c.z * c.z;
    left[3] += c.x * c.y, left[4] += c.x * c.z, left[5] += c.y * c.z;
  }
  symmetric_eigen(left, moments, axes);
  for (int k = 0; k < 3; ++k) strain[k] = std::sqrt(max(moments[k], 0.0)) - 1.0;
}

}  // namespace

ElementStress stress_of(const SoftBody& body, std::size_t tetrahedron) {
  double strain[3], axes[9];
  find_principal_strains(body, tetrahedron, strain, axes);
  const double mu = double(body.continuum.material.mu), lambda = double(body.continuum.material.lambda);
  const double trace = strain[0] + strain[1] + strain[2];
  ElementStress out;
  out.volume = double(body.continuum.tetrahedra[tetrahedron / kTetLanes].volume[tetrahedron % kTetLanes]);
  for (int k = 0; k < 3; ++k) {
    const double pull = out.volume * (2.0 * mu * strain[k] + lambda * trace);
    const double x = axes[3 * k], y = axes[3 * k + 1], z = axes[3 * k + 2];
    const double parts[6] = {x * x, y * y, z * z, x * y, x * z, y * z};
    for (int i = 0; i < 6; ++i) out.stress[i] += pull * parts[i];
  }
  return out;
}

double von_mises(const ElementStress& element) {
  const double(&s)[6] = element.stress;
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  const double apart = xy * xy + yz * yz + zx * zx, shear = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  return element.volume > 0.0 ? std::sqrt(0.5 * apart + 3.0 * shear) / element.volume : 0.0;
}

double largest_strain(const SoftBody& body, std::size_t tetrahedron) {
  double strain[3], axes[9];
  find_principal_strains(body, tetrahedron, strain, axes);
  return largest_of(largest_of(strain[0], strain[1]), strain[2]);
}

}  // namespace gyre
