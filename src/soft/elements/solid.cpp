#include "soft/elements/solid.h"

#include "math/rotation.h"

namespace gyre {

SoftBody tetrahedral_solid(std::span<const DVec3> places, std::span<const std::uint32_t> corners,
                           const SolidMaterial& material, std::span<const std::uint32_t> group) {
  SoftBody body;
  body.damping = material.damping;
  Particles& particles = body.particles;
  particles.resize(int(places.size()));
  for (int i = 0; i < particles.count; ++i) particles.set_place(i, places[std::size_t(i)]);
  body.continuum = make_continuum(corners, places, group);
  const double modulus = double(material.young_modulus), ratio = double(material.poisson_ratio);
  body.continuum.material.model = material.model;
  body.continuum.material.mu = float(modulus / (2.0 * (1.0 + ratio)));
  body.continuum.material.lambda = float(modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)));
  Array<double> mass;
  mass.resize(places.size());
  for (const TetBlock& block : body.continuum.tetrahedra) {
    for (int lane = 0; lane < kTetLanes; ++lane) {
      for (const auto& corner : block.corner)
        mass[corner[lane]] += 0.25 * double(material.density) * double(block.volume[lane]);
    }
  }
  for (int i = 0; i < particles.count; ++i) particles.mass[i] = float(mass[i]);
  return body;
}

constexpr std::uint32_t kCellTetrahedra = 5;

Array<std::uint32_t> box_groups(const int (&cells)[3]) {
  const std::uint32_t count = std::uint32_t(cells[0] * cells[1] * cells[2]) * kCellTetrahedra;
  Array<std::uint32_t> groups;
  for (std::uint32_t t = 0; t < count; ++t) groups.push_back(t / kCellTetrahedra);
  return groups;
}

Array<std::uint32_t> box_tetrahedra(const int (&cells)[3]) {
  // A cube has corners of two kinds, which alternate along its edges. A tetrahedron joins the four corners of one kind, and one more stands on
  // each of its faces. The kinds change places from cell to cell, so that neighbours fit and the solid has no grain.
  constexpr int kKinds[2][4] = {{0, 3, 5, 6}, {1, 2, 4, 7}};  // bits: along x, y and z
  const int stride[3] = {1, cells[0] + 1, (cells[0] + 1) * (cells[1] + 1)};
  Array<std::uint32_t> corners;
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        const int kind = (i + j + k) % 2;
        const auto add = [&](int corner) {
          corners.push_back(std::uint32_t((i + corner % 2) * stride[0] + (j + corner / 2 % 2) * stride[1] +
                                          (k + corner / 4) * stride[2]));
        };
        for (const int corner : kKinds[kind]) add(corner);
        for (const int corner : kKinds[1 - kind]) {
          add(corner);
          for (int axis = 0; axis < 3; ++axis) add(corner ^ (1 << axis));
        }
      }
    }
  }
  return corners;
}

Array<DVec3> box_places(Vec3 half_extents, const int (&cells)[3], const Pose& pose) {
  const DQuat turn = to_double(pose.orientation);
  Array<DVec3> places;
  for (int k = 0; k <= cells[2]; ++k) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int i = 0; i <= cells[0]; ++i) {
        const DVec3 local{(2.0 * i / cells[0] - 1.0) * double(half_extents.x),
                          (2.0 * j / cells[1] - 1.0) * double(half_extents.y),
                          (2.0 * k / cells[2] - 1.0) * double(half_extents.z)};
        places.push_back(pose.position + rotate(turn, local));
      }
    }
  }
  return places;
}

SoftBody box_solid(Vec3 half_extents, const int (&cells)[3], const Pose& pose,
                   const SolidMaterial& material) {
  return tetrahedral_solid(box_places(half_extents, cells, pose), box_tetrahedra(cells), material,
                           box_groups(cells));
}

}  // namespace gyre
