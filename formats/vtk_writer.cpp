// VTK files of a run. The format: W. Schroeder, K. Martin, B. Lorensen, "The Visualization Toolkit", "VTK XML file formats"; arrays in line
// as base64, each behind its length. See vtk_writer.h.
#include "formats/vtk_writer.h"

#include "formats/gltf_builder.h"
#include "formats/shape_mesh.h"
#include "scene/number_text.h"

#include <algorithm>

namespace gyre {
namespace {

constexpr int kVtkSegments = 24;  // of a full circle, of round shapes

template <class T>
void append_bytes(std::string& out, T value) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&value);
  if constexpr (sizeof(T) == 4) {
    append_little(out, value);
  } else if constexpr (sizeof(T) == 8) {
    const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, value);
    append_little(out, std::uint32_t(bits & 0xffffffffu));
    append_little(out, std::uint32_t(bits >> 32));
  } else {
    out += char(*bytes);
  }
}

// One array of numbers. `type` is that of VTK.
template <class T>
std::string data_array(const char* type, const std::string& name, int components,
                       const std::vector<T>& values) {
  std::string bytes;
  bytes.reserve(8 + values.size() * sizeof(T));
  append_bytes(bytes, std::uint64_t(values.size() * sizeof(T)));
  for (const T value : values) append_bytes(bytes, value);
  return "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\">" + base64(bytes) + "</DataArray>\n";
}

std::string begin_file(const char* type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(type) +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type;
}

struct Piece {
  std::vector<double> points;
  std::vector<float> velocities;
  std::vector<std::int64_t> connectivity, offsets;
  std::string point_data, cell_data;  // arrays

  std::int64_t count() const { return std::int64_t(points.size() / 3); }
  void add_point(DVec3 p, Vec3 v) {
    points.insert(points.end(), {p.x, p.y, p.z});
    velocities.insert(velocities.end(), {v.x, v.y, v.z});
  }
  void close_cell() { offsets.push_back(std::int64_t(connectivity.size())); }
};

std::string points_of(const Piece& piece) {
  return "<PointData Vectors=\"velocity\">\n" + data_array("Float32", "velocity", 3, piece.velocities) +
         piece.point_data + "</PointData>\n" + "<CellData>\n" + piece.cell_data + "</CellData>\n<Points>\n" +
         data_array("Float64", "Points", 3, piece.points) + "</Points>\n";
}
std::string cells_of(const Piece& piece) {
  return data_array("Int64", "connectivity", 1, piece.connectivity) +
         data_array("Int64", "offsets", 1, piece.offsets);
}

// `kind`: Verts, Lines or Polys.
std::string poly_data(const Piece& piece, const std::string& kind) {
  const auto number = [&](const char* of) {
    return " NumberOf" + std::string(of) + "=\"" + std::to_string(kind == of ? piece.offsets.size() : 0) +
           "\"";
  };
  return begin_file("PolyData") + ">\n<Piece NumberOfPoints=\"" + std::to_string(piece.count()) + "\"" +
         number("Verts") + number("Lines") + number("Polys") + ">\n" + points_of(piece) + "<" + kind + ">\n" +
         cells_of(piece) + "</" + kind + ">\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string tetrahedra(const Piece& piece) {
  constexpr std::uint8_t kTetrahedron = 10;
  const std::vector<std::uint8_t> types(piece.offsets.size(), kTetrahedron);
  return begin_file("UnstructuredGrid") + ">\n<Piece NumberOfPoints=\"" + std::to_string(piece.count()) +
         "\" NumberOfCells=\"" + std::to_string(types.size()) + "\">\n" + points_of(piece) + "<Cells>\n" +
         cells_of(piece) + data_array("UInt8", "types", 1, types) +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

// The surfaces of all bodies in one, planes left out.
std::string body_surfaces(const SceneRunner& runner) {
  const World& world = runner.world();
  Piece piece;
  std::vector<std::int32_t> bodies;
  std::vector<std::uint8_t> awake;
  for (std::size_t i = 0; i < runner.bodies().size(); ++i) {
    const BodyId body = runner.bodies()[i];
    if (!world.exists(body)) continue;
    const Pose pose = world.pose(body);
    const DVec3 center = world.center_of_mass(body);
    const Vec3 linear = world.linear_velocity(body), angular = world.angular_velocity(body);
    const std::span<const ShapeId> shapes = world.shapes(body);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const Transform local = runner.scene().bodies[i].shapes[k].local;
      const ShapeMesh mesh = make_shape_mesh(*world.geometry(shapes[k]), kVtkSegments);
      const std::int64_t first = piece.count();
      for (const MeshVertex& vertex : mesh.vertices) {
        const DVec3 place = pose * (local * vertex.position);
        piece.add_point(place, linear + cross(angular, difference(place, center)));
      }
      for (std::size_t n = 0; n + 2 < mesh.indices.size(); n += 3) {
        for (std::size_t c = 0; c < 3; ++c) piece.connectivity.push_back(first + mesh.indices[n + c]);
        piece.close_cell();
        bodies.push_back(std::int32_t(i));
        awake.push_back(world.is_awake(body) ? 1 : 0);
      }
    }
  }
  piece.cell_data = data_array("Int32", "body", 1, bodies) + data_array("UInt8", "awake", 1, awake);
  return poly_data(piece, "Polys");
}

// Returns the ending of the file.
const char* soft_file(const World& world, SoftId soft, std::string& bytes) {
  const SoftVertices vertices = world.vertices(soft);
  Piece piece;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    piece.add_point(vertices.position(i), vertices.velocity(i));
  const auto add_cells = [&](std::span<const std::uint32_t> corners, std::size_t size) {
    for (std::size_t i = 0; i + size <= corners.size(); i += size) {
      for (std::size_t c = 0; c < size; ++c) piece.connectivity.push_back(corners[i + c]);
      piece.close_cell();
    }
  };
  const SoftKind kind = world.soft_info(soft).kind;
  std::vector<float> strain(world.soft_strain(soft, {}));
  (void)world.soft_strain(soft, strain);
  if (kind == SoftKind::solid) {
    std::vector<std::uint32_t> corners(world.solid_tetrahedra(soft, {}));
    (void)world.solid_tetrahedra(soft, corners);
    add_cells(corners, 4);
    std::vector<float> stress(world.solid_stress(soft, {}));
    (void)world.solid_stress(soft, stress);
    piece.cell_data = data_array("Float32", "stress", 1, stress) + data_array("Float32", "strain", 1, strain);
    bytes = tetrahedra(piece);
    return ".vtu";
  }
  if (kind == SoftKind::rope) {
    for (std::size_t i = 0; i < vertices.size(); ++i) piece.connectivity.push_back(std::int64_t(i));
    piece.close_cell();
    // The line is one cell: a vertex has the mean of its segments.
    std::vector<float> mean(vertices.size(), 0.0f);
    for (std::size_t s = 0; s < strain.size(); ++s) {
      mean[s] += s > 0 ? 0.5f * strain[s] : strain[s];
      mean[s + 1] += s + 1 < strain.size() ? 0.5f * strain[s] : strain[s];
    }
    piece.point_data = data_array("Float32", "strain", 1, mean);
    bytes = poly_data(piece, "Lines");
  } else {
    add_cells(world.soft_triangles(soft), 3);
    piece.cell_data = data_array("Float32", "strain", 1, strain);
    bytes = poly_data(piece, "Polys");
  }
  return ".vtp";
}

std::string gas_image(const World& world, FluidId gas) {
  const FluidInfo info = world.fluid_info(gas);
  const Vec3 columns[3] = {rotate(info.pose.orientation, Vec3{1, 0, 0}),
                           rotate(info.pose.orientation, Vec3{0, 1, 0}),
                           rotate(info.pose.orientation, Vec3{0, 0, 1})};
  const auto place = [&](DVec3 in_box) {
    return info.pose.position + in_box.x * DVec3(columns[0]) + in_box.y * DVec3(columns[1]) +
           in_box.z * DVec3(columns[2]);
  };
  const DVec3 corner = info.pose == Pose{} ? info.lower : place(info.lower);
  std::string extent, origin, spacing, direction;
  if (info.pose.orientation != Quat{}) {
    direction = "\" Direction=\"";
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        append_number(direction += row + column > 0 ? " " : "", columns[column][row]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    extent += (axis > 0 ? " 0 " : "0 ") + std::to_string(info.cells[std::size_t(axis)]);
    append_number(origin += axis > 0 ? " " : "", corner[axis]);
    append_number(spacing += axis > 0 ? " " : "", info.cell[axis]);
  }
  std::string out = begin_file("ImageData") + " WholeExtent=\"" + extent + "\" Origin=\"" + origin +
                    "\" Spacing=\"" + spacing + direction + "\">\n<Piece Extent=\"" + extent +
                    "\">\n<CellData Scalars=\"smoke\" Vectors=\"velocity\">\n";
  std::vector<DVec3> centers;
  for (int z = 0; z < info.cells[2]; ++z) {
    for (int y = 0; y < info.cells[1]; ++y) {
      for (int x = 0; x < info.cells[0]; ++x)
        centers.push_back(info.lower +
                          multiply_each(info.cell, Vec3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f}));
      if (info.pose != Pose{}) centers.back() = place(centers.back());
    }
  }
  std::vector<float> values(centers.size());
  for (const FluidField field : {FluidField::smoke, FluidField::temperature, FluidField::pressure}) {
    (void)world.fluid_field(gas, field, values);
    out += data_array("Float32", to_string(field), 1, values);
  }
  std::vector<Vec3> velocities(centers.size());
  world.sample_velocity(gas, centers, velocities);
  values.clear();
  for (const Vec3 v : velocities) values.insert(values.end(), {v.x, v.y, v.z});
  out += data_array("Float32", "velocity", 3, values);
  return out + "</CellData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
}

std::string liquid_points(const World& world, FluidId liquid) {
  const std::size_t count = world.liquid_particles(liquid, {}, {});
  std::vector<DVec3> places(count);
  std::vector<Vec3> velocities(count);
  (void)world.liquid_particles(liquid, places, velocities);
  Piece piece;
  for (std::size_t i = 0; i < count; ++i) {
    piece.add_point(places[i], velocities[i]);
    piece.connectivity.push_back(std::int64_t(i));
    piece.close_cell();
  }
  return poly_data(piece, "Verts");
}

std::string liquid_surface_file(const World& world, FluidId liquid) {
  const FluidSurfaceSize size = world.liquid_surface(liquid, {}, {});
  std::vector<Vec3> vertices(size.vertices), velocities(size.vertices);
  std::vector<std::uint32_t> indices(size.indices);
  (void)world.liquid_surface(liquid, vertices, indices);
  std::vector<DVec3> places;
  for (const Vec3 vertex : vertices) places.push_back(DVec3(vertex));
  world.sample_velocity(liquid, places, velocities);
  Piece piece;
  for (std::size_t i = 0; i < places.size(); ++i) piece.add_point(places[i], velocities[i]);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) piece.connectivity.push_back(indices[i + c]);
    piece.close_cell();
  }
  return poly_data(piece, "Polys");
}

// A name as a part of a file name: letters, digits, '-' and '_' stay.
std::string file_word(const std::string& name) {
  std::string out;
  for (const char c : name.substr(0, 60)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    out += plain ? c : '_';
  }
  return out.empty() ? "part" : out;
}

}  // namespace

void VtkSeries::add(std::vector<VtkFile>& files, const SceneRunner& runner, const std::string& part,
                    const char* ending, std::string bytes) {
  auto at = std::find(parts_.begin(), parts_.end(), part);
  if (at == parts_.end()) at = parts_.insert(parts_.end(), part);
  std::string step = std::to_string(runner.steps());
  step.insert(0, step.size() < 6 ? 6 - step.size() : 0, '0');
  // The number of the part keeps names apart that differ in other letters only.
  const std::string file = file_word(part) + "_" + std::to_string(at - parts_.begin()) + "_" + step + ending;
  entries_.push_back({runner.time(), part, file});
  files.push_back({file, std::move(bytes)});
}

std::vector<VtkFile> VtkSeries::add_state(const SceneRunner& runner) {
  std::vector<VtkFile> files;
  const World& world = runner.world();
  if (!runner.bodies().empty()) add(files, runner, "bodies", ".vtp", body_surfaces(runner));
  runner.for_each_soft([&](const SceneSoft& soft, SoftId id) {
    std::string bytes;
    const char* const ending = soft_file(world, id, bytes);
    add(files, runner, soft.name, ending, std::move(bytes));
  });
  runner.for_each_fluid([&](const SceneFluid& fluid, FluidId id) {
    if (world.fluid_info(id).kind == FluidKind::gas) {
      add(files, runner, fluid.name, ".vti", gas_image(world, id));
    } else {
      add(files, runner, fluid.name, ".vtp", liquid_points(world, id));
      add(files, runner, fluid.name + " surface", ".vtp", liquid_surface_file(world, id));
    }
  });
  return files;
}

VtkFile VtkSeries::collection(const std::string& name) const {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const Entry& entry : entries_) {
    const auto part = std::find(parts_.begin(), parts_.end(), entry.part) - parts_.begin();
    out += "<DataSet timestep=\"";
    append_number(out, entry.time);
    out += "\" part=\"" + std::to_string(part) + "\" name=\"" + file_word(entry.part) + "\" file=\"" +
           entry.file + "\"/>\n";
  }
  return {name + ".pvd", out + "</Collection>\n</VTKFile>\n"};
}

}  // namespace gyre
