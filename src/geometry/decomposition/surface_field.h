// Distance of a point from a triangle surface, and an inside test, for any triangles: open, intersecting, duplicated.
//
// Inside means a generalized winding number above kInsideWinding. The winding number is a sum of solid angles: an
// integer for closed surfaces, with a smooth transition at holes, and one half in the plane of a flat hole. Distant
// groups of triangles count as one dipole each.
// Sources: A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding
// Numbers", 2013; G. Barill et al., "Fast Winding Numbers for Soups and Clouds", 2018; A. van Oosterom, J. Strackee,
// "The Solid Angle of a Plane Triangle", 1983.
#pragma once

#include "geometry/tree/static_tree.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// Slightly below one half, so that a hull that closes a flat hole is inside.
constexpr double kInsideWinding = 0.4;

class SurfaceField {
 public:
  // Vertices within 0 to about 1, and one or more triangles. The spans must outlive the field.
  SurfaceField(std::span<const DVec3> vertices, std::span<const std::uint32_t> indices);

  double winding(DVec3 p) const;
  bool inside(DVec3 p) const { return winding(p) > kInsideWinding; }
  // The distance to the closest triangle, or `max_distance` if that is less.
  double distance(DVec3 p, double max_distance) const { return nearest(p, max_distance).distance; }
  // The same with the triangle, kNoTriangle if none is closer than `max_distance`.
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;
  struct Nearest {
    double distance;
    std::uint32_t triangle;
  };
  Nearest nearest(DVec3 p, double max_distance) const;
  // The first triangle that the segment from p to q meets, and the fraction of the segment before it.
  struct Crossing {
    double fraction;
    std::uint32_t triangle;
  };
  Crossing first_crossing(DVec3 p, DVec3 q) const;

 private:
  // Triangles as seen from far away.
  struct Dipole {
    DVec3 normal;  // times area
    DVec3 center;
    double radius = 0.0;
  };
  struct Sum {
    DVec3 normal, moment;
    double area = 0.0;
  };
  Sum gather(std::uint32_t child, std::uint32_t slot);
  DVec3 corner(std::uint32_t position, int i) const {
    return vertices_[indices_[3 * std::size_t(tree_.items[position]) + std::size_t(i)]];
  }

  std::span<const DVec3> vertices_;
  std::span<const std::uint32_t> indices_;
  StaticTree tree_;
  std::vector<Dipole> dipoles_;  // by node * 8 + lane
};

}  // namespace gyre
