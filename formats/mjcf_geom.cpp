// Geoms of MJCF. See mjcf_geom.h.
#include "formats/mjcf_geom.h"

#include "formats/model_tree.h"

#include <cmath>

namespace gyre {
namespace {

Vec3 vec3_of(const std::vector<double>& v, std::size_t at = 0) {
  return {float(v[at]), float(v[at + 1]), float(v[at + 2])};
}

Quat orientation_of(const XmlElement& element, const MjcfCompiler& compiler) {
  if (const auto q = element.numbers("quat", 4, 4); !q.empty())
    return normalized(Quat{float(q[1]), float(q[2]), float(q[3]), float(q[0])});
  if (const auto a = element.numbers("axisangle", 4, 4); !a.empty())
    return from_axis_angle(vec3_of(a), float(compiler.angle(a[3])));
  if (const auto e = element.numbers("euler", 3, 3); !e.empty()) {
    Quat out;
    for (std::size_t i = 0; i < 3; ++i) {
      const char axis = compiler.euler[i];
      const bool fixed_frame = axis >= 'X' && axis <= 'Z';
      const int which = fixed_frame ? axis - 'X' : axis - 'x';
      const Quat turn =
          from_axis_angle({which == 0 ? 1.0f : 0.0f, which == 1 ? 1.0f : 0.0f, which == 2 ? 1.0f : 0.0f},
                          float(compiler.angle(e[i])));
      out = fixed_frame ? turn * out : out * turn;
    }
    return normalized(out);
  }
  if (const auto v = element.numbers("xyaxes", 6, 6); !v.empty()) {
    const Vec3 x = normalized(vec3_of(v));
    const Vec3 y = normalized(vec3_of(v, 3) - dot(vec3_of(v, 3), x) * x, any_perpendicular(x));
    return from_matrix({x, y, cross(x, y)});
  }
  if (const auto v = element.numbers("zaxis", 3, 3); !v.empty())
    return from_directions({0, 0, 1}, normalized(vec3_of(v), {0, 0, 1}));
  return {};
}

std::vector<Vec3> ellipsoid_points(Vec3 axes) {
  std::vector<Vec3> points{{0, 0, axes.z}, {0, 0, -axes.z}};
  constexpr int kRings = 7, kAround = 12;
  for (int ring = 1; ring <= kRings; ++ring) {
    const SinCos tilt = sin_cos(kPi * float(ring) / float(kRings + 1));
    for (int k = 0; k < kAround; ++k) {
      const SinCos turn = sin_cos(2.0f * kPi * float(k) / float(kAround));
      points.push_back(multiply_each(axes, {tilt.sin * turn.cos, tilt.sin * turn.sin, tilt.cos}));
    }
  }
  return points;
}

class GeomReader {
 public:
  GeomReader(Import& import, const XmlElement& geom, const MjcfCompiler& compiler, const MjcfAssets& assets)
      : import_(import), geom_(geom), compiler_(compiler), assets_(assets) {}

  MjcfGeom read(bool needs_mass);

 private:
  std::vector<double> sizes(std::size_t count);
  bool read_geometry();
  void read_mesh_geom();
  void set_mass(MjcfGeom& out) const;
  void set_surface(MjcfGeom& out);

  Import& import_;
  const XmlElement& geom_;
  const MjcfCompiler& compiler_;
  const MjcfAssets& assets_;
  SceneShape shape_;
  Vec3 ellipsoid_{};
  std::string type_;
};

std::vector<double> GeomReader::sizes(std::size_t count) {
  const std::vector<double> size = geom_.numbers("size", 1, 3);
  if (size.size() < count)
    geom_.fail("found a size of " + std::to_string(size.size()) + " numbers, expected " +
               std::to_string(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!(size[i] > 0)) geom_.fail("found a size that is not above 0");
  }
  return size;
}

void GeomReader::read_mesh_geom() {
  const auto found = assets_.meshes.find(geom_.need_text("mesh"));
  if (found == assets_.meshes.end())
    geom_.fail("found mesh \"" + geom_.text("mesh") + "\", expected the name of a mesh asset");
  const XmlElement& mesh = found->second;
  const Vec3 scale = mesh.vec3("scale", {1, 1, 1});
  if (scale.x * scale.y * scale.z == 0.0f) mesh.fail("found a scale of 0");
  if (mesh.has("vertex")) {
    const std::vector<double> numbers = mesh.numbers("vertex", 12, 300'000);
    SceneHull hull;
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
      hull.points.push_back(multiply_each(scale, vec3_of(numbers, i)));
    shape_.geometry = std::move(hull);
    return;
  }
  const std::string file = mesh.need_text("file");
  if (mesh_format_of(file) == MeshFormat::none)
    mesh.fail("found the mesh \"" + file + "\", expected .stl, .obj or .ply");
  const std::string folder = compiler_.mesh_folder.empty() ? import_.folder
                             : import_.folder.empty()      ? compiler_.mesh_folder
                                                           : import_.folder + "/" + compiler_.mesh_folder;
  shape_.geometry = SceneTriangles{import_.mesh_index(file, folder, scale, mesh.line())};
}

// False: left out.
bool GeomReader::read_geometry() {
  const Quat z_from_y = from_axis_angle({1, 0, 0}, 0.5f * kPi);
  const bool is_long = type_ == "capsule" || type_ == "cylinder";
  const std::vector<double> ends = geom_.numbers("fromto", 6, 6);
  double half = 0;
  if (!ends.empty()) {
    const Vec3 from = vec3_of(ends), to = vec3_of(ends, 3);
    half = 0.5 * double(length(to - from));
    if (!(half > 0)) geom_.fail("found a fromto of no length");
    shape_.local = {0.5f * (from + to), from_directions({0, 0, 1}, normalized(to - from))};
  } else if (is_long) {
    half = sizes(2)[1];
  }
  if (is_long) shape_.local.orientation = shape_.local.orientation * z_from_y;
  if (type_ == "sphere") {
    shape_.geometry = Sphere{float(sizes(1)[0])};
  } else if (type_ == "capsule") {
    shape_.geometry = Capsule{float(sizes(1)[0]), float(half)};
  } else if (type_ == "cylinder") {
    shape_.geometry = Cylinder{float(sizes(1)[0]), float(half)};
  } else if (type_ == "box" || type_ == "ellipsoid") {
    const std::vector<double> size = sizes(ends.empty() ? 3 : 1);
    const Vec3 axes = ends.empty()
                          ? vec3_of(size)
                          : Vec3{float(size[0]), float(size.size() > 1 ? size[1] : size[0]), float(half)};
    if (type_ == "box") {
      shape_.geometry = Box{axes};
    } else {
      ellipsoid_ = axes;
      shape_.geometry = SceneHull{ellipsoid_points(axes), -1};
    }
  } else if (type_ == "plane") {
    shape_.geometry = Plane{{0, 0, 1}, 0};
  } else if (type_ == "mesh") {
    read_mesh_geom();
  } else {
    import_.findings.left_out("geom of type " + type_);
    return false;
  }
  return true;
}

void GeomReader::set_mass(MjcfGeom& out) const {
  Result<MassProperties> unit = type_ == "ellipsoid"
                                    ? Result<MassProperties>(ellipsoid_mass(ellipsoid_, 1.0f))
                                    : unit_mass(import_.scene, shape_.geometry);
  if (!unit) geom_.fail(unit.error().message);
  if (!(unit->mass > 0.0f)) return;
  const double mass = geom_.number("mass", -1);
  const float factor = float(mass >= 0 ? mass / double(unit->mass) : geom_.number("density", 1000));
  if (!(factor >= 0.0f)) geom_.fail("found a density below 0");
  unit->mass *= factor;
  unit->inertia = factor * unit->inertia;
  out.mass = transformed(*unit, shape_.local);
}

void GeomReader::set_surface(MjcfGeom& out) {
  const std::vector<double> friction = geom_.numbers("friction", 1, 3);
  const double dimension = geom_.number("condim", 3);
  const double slide = friction.empty() ? 1.0 : friction[0];
  if (!(slide >= 0)) geom_.fail("found a friction below 0");
  shape_.static_friction = shape_.dynamic_friction = float(slide);
  if (dimension >= 4) shape_.spinning_friction = float(max(0.0, friction.size() > 1 ? friction[1] : 0.005));
  if (dimension >= 6) shape_.rolling_friction = float(max(0.0, friction.size() > 2 ? friction[2] : 0.0001));
  const auto named = assets_.colors.find(geom_.text("material"));
  if (named != assets_.colors.end()) shape_.color = named->second;
  if (const auto rgba = geom_.numbers("rgba", 3, 4); !rgba.empty())
    shape_.color = color_of(rgba[0], rgba[1], rgba[2]);
  const auto bits = [&](const char* name) {
    const double value = geom_.number(name, 1);
    if (!(value >= 0 && value <= 4294967295.0))
      geom_.fail(std::string("found a ") + name + " that has no 32 bits");
    return std::uint32_t(value);
  };
  out.contype = bits("contype");
  out.conaffinity = bits("conaffinity");
}

MjcfGeom GeomReader::read(bool needs_mass) {
  MjcfGeom out;
  type_ = geom_.text("type", geom_.has("mesh") ? "mesh" : "sphere");
  set_surface(out);
  const bool is_seen_only = out.contype == 0 && out.conaffinity == 0;
  if (is_seen_only && !needs_mass) return out;
  shape_.local = mjcf_frame(geom_, compiler_);
  if (!read_geometry()) return out;
  if (needs_mass) set_mass(out);
  if (!is_seen_only) out.shape = std::move(shape_);
  return out;
}

}  // namespace

Transform mjcf_frame(const XmlElement& element, const MjcfCompiler& compiler) {
  return {element.vec3("pos", {}), orientation_of(element, compiler)};
}

MjcfGeom read_geom(Import& import, const XmlElement& geom, const MjcfCompiler& compiler,
                   const MjcfAssets& assets, bool needs_mass) {
  return GeomReader(import, geom, compiler, assets).read(needs_mass);
}

}  // namespace gyre
