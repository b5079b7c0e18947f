// Mass properties of shapes in closed form, and their algebra: rotate, move, combine, principal axes. See mass.h.
#include "geometry/mass/mass.h"

#include "base/float_mode.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"
#include "geometry/shape/shape.h"
#include "math/dense.h"

namespace gyre {
namespace {

// A body of the given mass and second moments that is symmetric about three planes through its centre.
Solid symmetric_solid(double mass, double xx, double yy, double zz) {
  Solid solid;
  solid.mass = mass;
  solid.moments.xx = xx;
  solid.moments.yy = yy;
  solid.moments.zz = zz;
  return solid;
}

Solid measure(const Sphere& sphere, double density) {
  const double r = double(sphere.radius);
  const double mass = density * 4.0 / 3.0 * kPiDouble * r * r * r;
  const double moment = mass * r * r / 5.0;
  return symmetric_solid(mass, moment, moment, moment);
}

// Along axis i of a rounded box with inner half extents e and rounding r (j and k are the other axes): the integral of
// i^2 over the inner box, 6 slabs on its faces, 12 quarter cylinders along its edges and 8 octants of a ball at its
// corners.
double rounded_box_moment(double ei, double ej, double ek, double r) {
  const double r2 = r * r, r3 = r2 * r, r4 = r2 * r2, r5 = r4 * r;
  const double core = 8.0 * ei * ej * ek * ei * ei / 3.0;
  const double ends = 8.0 * ej * ek * (ei * ei * r + ei * r2 + r3 / 3.0);
  const double sides = 8.0 * r * ei * (ej + ek) * ei * ei / 3.0;
  const double edges_along = kPiDouble * r2 * 2.0 * ei * ei * ei / 3.0;
  const double edges_across =
      2.0 * (ej + ek) * (kPiDouble * r2 * ei * ei + 8.0 / 3.0 * ei * r3 + kPiDouble * r4 / 4.0);
  const double corners = kPiDouble * (4.0 / 3.0 * r3 * ei * ei + r4 * ei + 4.0 / 15.0 * r5);
  return core + ends + sides + edges_along + edges_across + corners;
}

Solid measure(const Box& box, double density) {
  const double r = double(box.rounding);
  const double x = double(box.half_extents.x) - r, y = double(box.half_extents.y) - r,
               z = double(box.half_extents.z) - r;
  const double volume = 8.0 * (x * y * z + r * (x * y + y * z + z * x)) +
                        2.0 * kPiDouble * r * r * (x + y + z) + 4.0 / 3.0 * kPiDouble * r * r * r;
  return symmetric_solid(density * volume, density * rounded_box_moment(x, y, z, r),
                         density * rounded_box_moment(y, z, x, r), density * rounded_box_moment(z, x, y, r));
}

Solid measure(const Capsule& capsule, double density) {
  const double r = double(capsule.radius), h = double(capsule.half_height);
  const double tube = density * kPiDouble * r * r * 2.0 * h;
  const double ball = density * 4.0 / 3.0 * kPiDouble * r * r * r;
  const double across = tube * r * r / 4.0 + ball * r * r / 5.0;
  // Half balls at distance h; their centres of mass are 3/8 r farther out.
  const double along = tube * h * h / 3.0 + ball * (r * r / 5.0 + h * h + 0.75 * h * r);
  return symmetric_solid(tube + ball, across, along, across);
}

Solid measure(const Cylinder& cylinder, double density) {
  const double r = double(cylinder.radius), h = double(cylinder.half_height);
  const double mass = density * kPiDouble * r * r * 2.0 * h;
  return symmetric_solid(mass, mass * r * r / 4.0, mass * h * h / 3.0, mass * r * r / 4.0);
}

Solid measure(const Cone& cone, double density) {
  const double r = double(cone.radius), height = 2.0 * double(cone.half_height);
  const double mass = density * kPiDouble * r * r * height / 3.0;
  const double across = 3.0 / 20.0 * mass * r * r;
  Solid solid = symmetric_solid(mass, across, 3.0 / 80.0 * mass * height * height, across);
  // A quarter of the height above the base; half of the height lies below the origin.
  solid.center.y = -0.25 * height;
  return solid;
}

Solid hull_solid(const Hull& hull, double density) {
  TetrahedronSum sum{DVec3(hull.centroid)};
  const auto vertex = [&](std::uint32_t i) { return DVec3(hull.vertices[hull.face_vertices[i]]); };
  for (int f = 0; f < hull.face_count(); ++f) {
    const std::uint32_t begin = hull.face_offsets[std::size_t(f)],
                        end = hull.face_offsets[std::size_t(f) + 1];
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) sum.add(vertex(begin), vertex(i), vertex(i + 1));
  }
  return sum.solid(density);
}

const char* shape_name(const AnyShape& shape) {
  constexpr const char* kNames[] = {"sphere", "box", "capsule", "cylinder", "cone", "plane"};
  const Geometry* geometry = std::get_if<Geometry>(&shape);
  return geometry ? to_string(geometry->kind()) : kNames[shape.index()];
}

// A rotation matrix in double, by rows.
struct Rotation {
  DVec3 rows[3];
};

Rotation rotation_of(Quat orientation) {
  const double x0 = double(orientation.x), y0 = double(orientation.y), z0 = double(orientation.z);
  const double w0 = double(orientation.w);
  // Exactly a rotation, even if the length of the quaternion is 1 only to the precision of float.
  const double n = x0 * x0 + y0 * y0 + z0 * z0 + w0 * w0;
  const double s = n > 0.0 ? 2.0 / n : 0.0;
  const double xx = s * x0 * x0, yy = s * y0 * y0, zz = s * z0 * z0, xy = s * x0 * y0, xz = s * x0 * z0;
  const double yz = s * y0 * z0, wx = s * w0 * x0, wy = s * w0 * y0, wz = s * w0 * z0;
  return {{{1.0 - yy - zz, xy - wz, xz + wy},
           {xy + wz, 1.0 - xx - zz, yz - wx},
           {xz - wy, yz + wx, 1.0 - xx - yy}}};
}

// R C R^T.
SecondMoments rotated(const SecondMoments& c, const Rotation& r) {
  const auto apply = [&](DVec3 v) {
    return DVec3(c.xx * v.x + c.xy * v.y + c.xz * v.z, c.xy * v.x + c.yy * v.y + c.yz * v.z,
                 c.xz * v.x + c.yz * v.y + c.zz * v.z);
  };
  const DVec3 a = apply(r.rows[0]), b = apply(r.rows[1]), d = apply(r.rows[2]);
  return {dot(r.rows[0], a), dot(r.rows[1], b), dot(r.rows[2], d),
          dot(r.rows[0], b), dot(r.rows[0], d), dot(r.rows[1], d)};
}

}  // namespace

MassProperties to_mass_properties(const Solid& solid) {
  const SecondMoments& c = solid.moments;
  MassProperties out;
  out.mass = float(solid.mass);
  out.center = to_float(solid.center);
  out.inertia = {float(c.yy + c.zz), float(c.xx + c.zz), float(c.xx + c.yy),
                 float(-c.xy),       float(-c.xz),       float(-c.yz)};
  return out;
}

Solid to_solid(const MassProperties& mass) {
  const double x = double(mass.inertia.xx), y = double(mass.inertia.yy), z = double(mass.inertia.zz);
  Solid solid;
  solid.mass = double(mass.mass);
  solid.center = DVec3(mass.center);
  solid.moments = {0.5 * (y + z - x),        0.5 * (x + z - y),        0.5 * (x + y - z),
                   -double(mass.inertia.xy), -double(mass.inertia.xz), -double(mass.inertia.yz)};
  return solid;
}

Error check_density(double density, const char* unit) {
  if (density > 0.0 && is_finite(density)) return {};
  return make_error(ErrorCode::invalid_argument, "density is %g %s; allowed is any finite value above 0",
                    density, unit);
}

Result<MassProperties> checked_mass(const Solid& solid, const char* shape) {
  const MassProperties out = to_mass_properties(solid);
  const Sym3& i = out.inertia;
  const bool finite = is_finite(out.mass) && is_finite(out.center) && is_finite(i.xx + i.yy + i.zz) &&
                      is_finite(i.xy) && is_finite(i.xz) && is_finite(i.yz);
  // A denormal number has lost digits.
  constexpr float kSmallest = 1.17549435e-38f;
  if (finite && out.mass >= kSmallest && smallest(Vec3{i.xx, i.yy, i.zz}) >= kSmallest) return out;
  return make_error(ErrorCode::invalid_argument,
                    "%s: mass is %g kg and inertia (%g, %g, %g) kg m^2; allowed are 1.2e-38 to 3.4e38", shape,
                    solid.mass, solid.moments.yy + solid.moments.zz, solid.moments.xx + solid.moments.zz,
                    solid.moments.xx + solid.moments.yy);
}

void TetrahedronSum::add(DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 pa = a - middle_, pb = b - middle_, pc = c - middle_;
  const double volume = dot(pa, cross(pb, pc)) / 6.0;
  const DVec3 sum = pa + pb + pc;
  volume_ += volume;
  first_ += 0.25 * volume * sum;
  // The tetrahedron (0, a, b, c) has V / 20 (a a' + b b' + c c' + s s') with s = a + b + c.
  const double weight = volume / 20.0;
  add_product(second_, weight, pa);
  add_product(second_, weight, pb);
  add_product(second_, weight, pc);
  add_product(second_, weight, sum);
}

Solid TetrahedronSum::solid(double density) const {
  Solid out;
  out.mass = density * volume_;
  const DVec3 shift = volume_ != 0.0 ? first_ / volume_ : DVec3();
  out.center = middle_ + shift;
  const SecondMoments& m = second_;
  out.moments = {density * m.xx, density * m.yy, density * m.zz,
                 density * m.xy, density * m.xz, density * m.yz};
  add_product(out.moments, -out.mass, shift);
  return out;
}

Result<MassProperties> mass_properties(const AnyShape& shape, float density) {
  const FloatMode mode;
  if (const Error error = check_shape(shape)) return error;
  if (const Error error = check_density(double(density), "kg/m^3"))
    return error;
  const char* name = shape_name(shape);
  const double rho = double(density);
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return checked_mass(measure(*sphere, rho), name);
  if (const Box* box = std::get_if<Box>(&shape)) return checked_mass(measure(*box, rho), name);
  if (const Capsule* capsule = std::get_if<Capsule>(&shape))
    return checked_mass(measure(*capsule, rho), name);
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape))
    return checked_mass(measure(*cylinder, rho), name);
  if (const Cone* cone = std::get_if<Cone>(&shape)) return checked_mass(measure(*cone, rho), name);
  if (const Geometry* geometry = std::get_if<Geometry>(&shape)) {
    const CookedGeometry& data = *geometry->data();
    if (data.hull) return checked_mass(hull_solid(*data.hull, rho), name);
    if (data.mesh) {
      const Result<Solid> solid =
          closed_mesh_solid(data.mesh->vertices, data.mesh->indices, data.mesh->source, rho);
      if (!solid) return solid.error();
      return checked_mass(*solid, name);
    }
  }
  return make_error(ErrorCode::invalid_argument, "%s: has no volume; allowed are bounded solids", name);
}

MassProperties hollow_sphere_mass(float radius, float density_per_area) {
  const FloatMode mode;
  const double r = double(radius);
  const double mass = double(density_per_area) * 4.0 * kPiDouble * r * r;
  const double moment = mass * r * r / 3.0;
  return to_mass_properties(symmetric_solid(mass, moment, moment, moment));
}

MassProperties ellipsoid_mass(Vec3 semi_axes, float density) {
  const FloatMode mode;
  const DVec3 a(semi_axes);
  const double mass = double(density) * 4.0 / 3.0 * kPiDouble * a.x * a.y * a.z;
  return to_mass_properties(
      symmetric_solid(mass, mass * a.x * a.x / 5.0, mass * a.y * a.y / 5.0, mass * a.z * a.z / 5.0));
}

MassProperties tetrahedron_mass(Vec3 a, Vec3 b, Vec3 c, Vec3 d, float density) {
  const FloatMode mode;
  const DVec3 apex(d);
  const DVec3 edges[3] = {DVec3(a) - apex, DVec3(b) - apex, DVec3(c) - apex};
  const DVec3 middle = 0.25 * (edges[0] + edges[1] + edges[2]);
  Solid solid;
  solid.mass = double(density) * absolute(dot(edges[0], cross(edges[1], edges[2]))) / 6.0;
  solid.center = apex + middle;
  // About its centre: m / 20 times the sum of r r' over the corners.
  for (const DVec3& edge : edges) add_product(solid.moments, solid.mass / 20.0, edge - middle);
  add_product(solid.moments, solid.mass / 20.0, middle);
  return to_mass_properties(solid);
}

MassProperties transformed(const MassProperties& mass, const Transform& t) {
  const FloatMode mode;
  const Rotation r = rotation_of(t.orientation);
  Solid solid = to_solid(mass);
  const DVec3 c = solid.center;
  solid.center = DVec3(dot(r.rows[0], c), dot(r.rows[1], c), dot(r.rows[2], c)) + t.position;
  solid.moments = rotated(solid.moments, r);
  return to_mass_properties(solid);
}

MassProperties combined(std::span<const MassProperties> parts) {
  const FloatMode mode;
  if (parts.empty()) return {};
  // Centres are relative to that of the first part, so that parts far from the origin stay precise.
  const DVec3 origin(parts[0].center);
  double mass = 0.0;
  DVec3 first;
  for (const MassProperties& part : parts) {
    mass += double(part.mass);
    first += double(part.mass) * (DVec3(part.center) - origin);
  }
  const DVec3 center = mass != 0.0 ? first / mass : DVec3();
  Solid sum;
  sum.mass = mass;
  sum.center = origin + center;
  for (const MassProperties& part : parts) {
    const SecondMoments m = to_solid(part).moments;
    SecondMoments& s = sum.moments;
    s = {s.xx + m.xx, s.yy + m.yy, s.zz + m.zz, s.xy + m.xy, s.xz + m.xz, s.yz + m.yz};
    add_product(s, double(part.mass), DVec3(part.center) - origin - center);
  }
  return to_mass_properties(sum);
}

PrincipalAxes principal_axes(const Sym3& inertia) {
  const FloatMode mode;
  const double m[6] = {double(inertia.xx), double(inertia.yy), double(inertia.zz),
                       double(inertia.xy), double(inertia.xz), double(inertia.yz)};
  double moments[3], axes[9];
  symmetric_eigen(m, moments, axes);
  const auto column = [&](int i) {
    return Vec3{float(axes[3 * i]), float(axes[3 * i + 1]), float(axes[3 * i + 2])};
  };
  return {{float(moments[0]), float(moments[1]), float(moments[2])},
          from_matrix({column(0), column(1), column(2)})};
}

Error check_inertia(const Sym3& inertia) {
  const double m[6] = {double(inertia.xx), double(inertia.yy), double(inertia.zz),
                       double(inertia.xy), double(inertia.xz), double(inertia.yz)};
  constexpr const char* kFields[6] = {"xx", "yy", "zz", "xy", "xz", "yz"};
  for (int i = 0; i < 6; ++i) {
    if (is_finite(m[i]) && (i >= 3 || m[i] > 0.0)) continue;
    return make_error(ErrorCode::invalid_argument, "inertia: %s is %g kg m^2; allowed is any finite value%s",
                      kFields[i], m[i], i < 3 ? " above 0" : "");
  }
  double moments[3], axes[9];
  symmetric_eigen(m, moments, axes);
  // The principal axis, and the closest coordinate axis.
  const auto axis = [&](int i) { return DVec3(axes[3 * i], axes[3 * i + 1], axes[3 * i + 2]); };
  const auto letter = [](DVec3 a) {
    const double x = absolute(a.x), y = absolute(a.y), z = absolute(a.z);
    return x >= y && x >= z ? 'x' : y >= z ? 'y' : 'z';
  };
  constexpr double kSlack = 1.0e-4;  // of the largest moment: rounding of given inertias
  if (!(moments[0] > 0.0)) {
    const DVec3 a = axis(0);
    return make_error(ErrorCode::invalid_argument,
                      "inertia: the principal moment about (%.3g, %.3g, %.3g), nearest to axis %c, is %g kg "
                      "m^2; allowed is "
                      "any above 0",
                      a.x, a.y, a.z, letter(a), moments[0]);
  }
  if (moments[2] <= (moments[0] + moments[1]) * (1.0 + kSlack)) return {};
  const DVec3 a = axis(2);
  return make_error(ErrorCode::invalid_argument,
                    "inertia: the principal moment about (%.3g, %.3g, %.3g), nearest to axis %c, is %g kg "
                    "m^2; allowed is at "
                    "most the sum of the other two, %g + %g",
                    a.x, a.y, a.z, letter(a), moments[2], moments[0], moments[1]);
}

}  // namespace gyre
