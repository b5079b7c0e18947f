// Writes and reads the chunks of a track. See track_format.h.
#include "io/track/track_format.h"

#include "io/codec/enum_counts.h"
#include "io/codec/geometry_codec.h"

namespace gyre {

namespace {

Error bad_recording(const char* what) { return make_error(ErrorCode::invalid_data, "recording: %s", what); }

// The reader fails on values that no shape can have.
float get_finite(ByteReader& in) {
  const auto value = in.get<float>();
  if (!is_finite(value)) in.fail();
  return value;
}
float get_size(ByteReader& in) {
  const float value = get_finite(in);
  if (value < 0.0f) in.fail();
  return value;
}
Vec3 get_finite_vector(ByteReader& in) {
  Vec3 v;
  v.x = get_finite(in), v.y = get_finite(in), v.z = get_finite(in);
  return v;
}

void put_vectors(ByteWriter& out, std::span<const Vec3> vectors) {
  out.put(std::uint64_t(vectors.size()));
  for (const Vec3& v : vectors) put_vector(out, v);
}
std::vector<Vec3> get_finite_vectors(ByteReader& in) {
  std::vector<Vec3> vectors(in.get_count(3 * sizeof(float)));
  for (Vec3& v : vectors) v = get_finite_vector(in);
  return vectors;
}

void put_text(ByteWriter& out, std::string_view text) {
  out.put(std::uint64_t(text.size()));
  out.put_bytes(std::as_bytes(std::span<const char>(text)));
}
std::string get_text(ByteReader& in) {
  const std::span<const std::byte> bytes = in.get_bytes(in.get<std::uint64_t>());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void write_track_start(ByteWriter& out, const TrackStart& start) {
  out.put(start.version);
  out.put(std::int8_t(start.steps.position_bits));
  out.put(std::uint8_t(start.steps.orientation_bits));
  out.put(std::uint16_t(0));
  out.put(start.frame_interval);
}

Error read_track_start(std::span<const std::byte> payload, TrackStart& start) {
  ByteReader in(payload);
  start.version = in.get<std::uint32_t>();
  if (!in.failed() && start.version != kTrackVersion) {
    return make_error(ErrorCode::unsupported,
                      "recording: its track is of format %u; this version reads format %u", start.version,
                      kTrackVersion);
  }
  start.steps.position_bits = in.get<std::int8_t>();
  start.steps.orientation_bits = in.get<std::uint8_t>();
  in.get<std::uint16_t>();
  start.frame_interval = in.get<std::uint32_t>();
  if (!in.finished() || start.steps.position_bits < kMinPositionBits ||
      start.steps.position_bits > kMaxPositionBits || start.steps.orientation_bits < kMinOrientationBits ||
      start.steps.orientation_bits > kMaxOrientationBits) {
    return bad_recording("its track has an accuracy that cannot be");
  }
  return {};
}

void write_track_geometry(ByteWriter& out, const Geometry& geometry) {
  const ShapeKind kind = geometry.kind();
  out.put(kind);
  if (kind == ShapeKind::hull) put_vectors(out, view_hull(geometry).vertices);
  if (kind == ShapeKind::mesh) {
    const MeshView mesh = view_mesh(geometry);
    put_vectors(out, mesh.vertices);
    out.put_all(mesh.indices);
  }
  if (kind == ShapeKind::height_field) {
    const HeightFieldView field = view_height_field(geometry);
    out.put(field.columns);
    out.put(field.rows);
    out.put(field.spacing);
    out.put_all(field.heights);
  }
}

Result<Geometry> read_track_geometry(std::span<const std::byte> payload) {
  ByteReader in(payload);
  const auto kind = in.get<ShapeKind>();
  if (kind == ShapeKind::hull) {
    const std::vector<Vec3> points = get_finite_vectors(in);
    if (in.finished()) return cook_hull(points);
  }
  if (kind == ShapeKind::mesh) {
    const std::vector<Vec3> vertices = get_finite_vectors(in);
    const std::vector<std::uint32_t> indices = in.get_all<std::uint32_t>();
    if (in.finished()) return cook_mesh({vertices, indices, false});
  }
  if (kind == ShapeKind::height_field) {
    HeightFieldDef def;
    def.columns = in.get<std::uint32_t>();
    def.rows = in.get<std::uint32_t>();
    def.spacing = in.get<float>();
    const std::vector<float> heights = in.get_all<float>();
    def.heights = heights;
    if (in.finished()) return cook_height_field(def);
  }
  return bad_recording("a geometry of its track cannot be read");
}

void write_track_shape(ByteWriter& out, const TrackShape& shape, std::uint32_t geometry_number) {
  static_assert(std::variant_size_v<AnyShape> == 7, "a new shape needs its lines here and in read_shape");
  out.put(std::uint8_t(shape.geometry.index()));
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) out.put(sphere->radius);
  if (const auto* box = std::get_if<Box>(&shape.geometry)) {
    put_vector(out, box->half_extents);
    out.put(box->rounding);
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape.geometry))
    out.put(capsule->radius), out.put(capsule->half_height);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry))
    out.put(cylinder->radius), out.put(cylinder->half_height);
  if (const auto* cone = std::get_if<Cone>(&shape.geometry))
    out.put(cone->radius), out.put(cone->half_height);
  if (const auto* plane = std::get_if<Plane>(&shape.geometry))
    put_vector(out, plane->normal), out.put(plane->offset);
  if (std::holds_alternative<Geometry>(shape.geometry)) out.put(geometry_number);
  put_vector(out, shape.local.position);
  const Quat q = shape.local.orientation;
  out.put(q.x), out.put(q.y), out.put(q.z), out.put(q.w);
  out.put(shape.material_id);
  out.put(shape.sensor);
}

namespace {

template <class Round>
Round get_round(ByteReader& in) {
  Round shape;
  shape.radius = get_size(in);
  shape.half_height = get_size(in);
  return shape;
}

AnyShape get_geometry(ByteReader& in, std::span<const Geometry> geometry) {
  switch (in.get<std::uint8_t>()) {
    case 0:
      return Sphere{get_size(in)};
    case 1: {
      Box box;
      box.half_extents.x = get_size(in), box.half_extents.y = get_size(in), box.half_extents.z = get_size(in);
      box.rounding = get_size(in);
      return box;
    }
    case 2:
      return get_round<Capsule>(in);
    case 3:
      return get_round<Cylinder>(in);
    case 4:
      return get_round<Cone>(in);
    case 5: {
      Plane plane;
      plane.normal = get_finite_vector(in);
      plane.offset = get_finite(in);
      return plane;
    }
    case 6: {
      const auto number = in.get<std::uint32_t>();
      if (number < geometry.size()) return geometry[number];
      break;
    }
    default:
      break;
  }
  in.fail();
  return Sphere{};
}

}  // namespace

void write_track_model(ByteWriter& out, BodyType type, std::uint32_t shape_count,
                       std::span<const std::byte> shapes) {
  out.put(type);
  out.put(shape_count);
  out.put_bytes(shapes);
}

bool read_track_model(std::span<const std::byte> payload, std::span<const Geometry> geometry,
                      TrackModel& model) {
  ByteReader in(payload);
  model.type = in.get<BodyType>();
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && !in.failed(); ++i) {
    TrackShape shape;
    shape.geometry = get_geometry(in, geometry);
    shape.local.position = get_finite_vector(in);
    Quat& q = shape.local.orientation;
    q.x = get_finite(in), q.y = get_finite(in), q.z = get_finite(in), q.w = get_finite(in);
    shape.material_id = in.get<std::uint16_t>();
    shape.sensor = in.get<bool>();
    model.shapes.push_back(std::move(shape));
  }
  return in.finished();
}

void write_track_label(ByteWriter& out, std::uint32_t index, std::uint16_t generation, std::string_view name,
                       std::span<const TrackColor> colors) {
  out.put(index);
  out.put(generation);
  put_text(out, name);
  out.put(std::uint64_t(colors.size()));
  for (const TrackColor& color : colors) out.put(color.red), out.put(color.green), out.put(color.blue);
}

bool read_track_label(std::span<const std::byte> payload, StoredLabel& label) {
  ByteReader in(payload);
  label.index = in.get<std::uint32_t>();
  label.generation = in.get<std::uint16_t>();
  label.name = get_text(in);
  label.colors.resize(in.get_count(3));
  for (TrackColor& color : label.colors) {
    color.red = in.get<std::uint8_t>(), color.green = in.get<std::uint8_t>(),
    color.blue = in.get<std::uint8_t>();
  }
  return in.finished();
}

void write_track_note(ByteWriter& out, std::string_view key, std::string_view text) {
  put_text(out, key);
  put_text(out, text);
}

bool read_track_note(std::span<const std::byte> payload, StoredNote& note) {
  ByteReader in(payload);
  note.key = get_text(in);
  note.text = get_text(in);
  return in.finished();
}

void write_track_soft(ByteWriter& out, SoftKind kind, float radius, std::uint32_t vertex_count,
                      std::span<const std::uint32_t> triangles) {
  out.put(kind);
  out.put(radius);
  out.put(vertex_count);
  out.put_all(triangles);
}

bool read_track_soft(std::span<const std::byte> payload, TrackSoft& soft) {
  ByteReader in(payload);
  soft.kind = in.get<SoftKind>();
  soft.radius = get_size(in);
  soft.vertices = in.get<std::uint32_t>();
  soft.triangles = in.get_all<std::uint32_t>();
  if (soft.triangles.size() % 3 != 0) in.fail();
  for (const std::uint32_t vertex : soft.triangles)
    if (vertex >= soft.vertices) in.fail();
  return in.finished();
}

void write_frame_head(ByteWriter& out, const FrameHead& head) {
  out.put(head.step);
  out.put(head.time);
  out.put(head.set_version);
}

FrameHead read_frame_head(std::span<const std::byte> payload) {
  ByteReader in(payload);
  FrameHead head;
  head.step = in.get<std::uint64_t>();
  head.time = in.get<double>();
  head.set_version = in.get<std::uint64_t>();
  return head;
}

}  // namespace gyre
