// Poses and looks as JSON and arrays. See served_recording.h.
#include "view/served_recording.h"

#include "scene/json_writer.h"

#include <gyre/geometry.h>
#include <gyre/replay.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <vector>

namespace gyre {
namespace {

// One answer is about this large: soon sent, and seldom asked for.
constexpr std::size_t kGroupBytes = std::size_t(1) << 20;
constexpr std::size_t kMaxFramesInGroup = 120;
constexpr std::size_t kRowBytes = 7 * sizeof(float) + 1;
constexpr std::size_t kVertexBytes = 3 * sizeof(float);
// m; what lies nearer to zero is drawn where it is.
constexpr double kFar = 1000.0;

// The text, and the arrays that it names.
class Answer {
 public:
  JsonWriter json;

  template <typename T>
  void array(const char* name, std::span<const T> values) {
    json.key(name).begin_array(JsonLayout::one_line);
    json.value(std::int64_t(bytes_.size()));
    json.value(std::int64_t(values.size()));
    json.end_array();
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
  }
  // Three numbers each.
  void array(const char* name, std::span<const Vec3> points) {
    std::vector<float> numbers;
    numbers.reserve(3 * points.size());
    for (const Vec3 p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    array(name, std::span<const float>(numbers));
  }
  std::string take() {
    std::string text = json.take();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto length = std::uint32_t(text.size());
    char head[sizeof length];
    std::memcpy(head, &length, sizeof length);
    return std::string(head, sizeof head) + text + bytes_;
  }

 private:
  std::string bytes_;
};

const char* word(BodyType type) {
  return type == BodyType::dynamic ? "dynamic" : type == BodyType::kinematic ? "kinematic" : "fixed";
}

std::string key_of(const Geometry& geometry) {
  char key[17];
  std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(geometry.content_hash()));
  return key;
}

struct DescribeGeometry {
  JsonWriter& json;

  void operator()(const Sphere& s) const {
    json.field("kind", "sphere");
    json.field("radius", s.radius);
  }
  void operator()(const Box& b) const {
    json.field("kind", "box");
    json.field("halfExtents", b.half_extents);
    json.field("rounding", b.rounding);
  }
  void operator()(const Capsule& s) const { round("capsule", s.radius, s.half_height); }
  void operator()(const Cylinder& s) const { round("cylinder", s.radius, s.half_height); }
  void operator()(const Cone& s) const { round("cone", s.radius, s.half_height); }
  void operator()(const Plane& p) const {
    json.field("kind", "plane");
    json.field("normal", p.normal);
    json.field("offset", p.offset);
  }
  void operator()(const Geometry& geometry) const {
    json.field("kind", "surface");
    json.field("surface", std::string_view(key_of(geometry)));
  }
  void round(const char* kind, float radius, float half_height) const {
    json.field("kind", kind);
    json.field("radius", radius);
    json.field("halfHeight", half_height);
  }
};

void describe_model(JsonWriter& json, const TrackModel& model) {
  json.begin_object(JsonLayout::one_line);
  json.field("type", word(model.type));
  json.key("shapes").begin_array();
  for (const TrackShape& shape : model.shapes) {
    json.begin_object();
    json.key("geometry").begin_object();
    std::visit(DescribeGeometry{json}, shape.geometry);
    json.end_object();
    json.field("position", shape.local.position);
    json.field("rotation", shape.local.orientation);
    json.field("sensor", shape.sensor);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

void describe_surface(Answer& answer, const Geometry& geometry) {
  JsonWriter& json = answer.json;
  json.begin_object(JsonLayout::one_line);
  json.field("key", std::string_view(key_of(geometry)));
  if (geometry.kind() == ShapeKind::hull) {
    const HullView hull = view_hull(geometry);
    json.field("kind", "hull");
    answer.array("vertices", hull.vertices);
    answer.array("face_offsets", hull.face_offsets);
    answer.array("face_indices", hull.face_indices);
  } else if (geometry.kind() == ShapeKind::mesh) {
    const MeshView mesh = view_mesh(geometry);
    json.field("kind", "mesh");
    answer.array("vertices", mesh.vertices);
    answer.array("indices", mesh.indices);
  } else {
    const HeightFieldView field = view_height_field(geometry);
    json.field("kind", "height_field");
    answer.array("heights", field.heights);
    json.field("columns", std::int64_t(field.columns));
    json.field("rows", std::int64_t(field.rows));
    json.field("spacing", field.spacing);
  }
  json.end_object();
}

// Each surface once, however many shapes have it.
void describe_surfaces(Answer& answer, std::span<const TrackModel> models) {
  std::set<std::uint64_t> told;
  answer.json.key("surfaces").begin_array();
  for (const TrackModel& model : models) {
    for (const TrackShape& shape : model.shapes) {
      const auto* const geometry = std::get_if<Geometry>(&shape.geometry);
      if (geometry != nullptr && told.insert(geometry->content_hash()).second)
        describe_surface(answer, *geometry);
    }
  }
  answer.json.end_array();
}

void describe_softs(Answer& answer, std::span<const TrackSoft> softs) {
  JsonWriter& json = answer.json;
  json.key("softs").begin_array();
  for (const TrackSoft& soft : softs) {
    json.begin_object(JsonLayout::one_line);
    json.field("kind", to_string(soft.kind));
    json.field("radius", soft.radius);
    json.field("vertices", std::int64_t(soft.vertices));
    answer.array("triangles", std::span<const std::uint32_t>(soft.triangles));
    json.end_object();
  }
  json.end_array();
}

// Parallel arrays: the ids of bodies or of soft matter, the numbers of their models or surfaces, and their labels.
template <typename Tag, typename LabelOf>
void describe_members(JsonWriter& json, std::span<const Id<Tag>> ids, const char* looks_name,
                      std::span<const std::uint32_t> looks, LabelOf label_of) {
  json.key("ids").begin_array();
  for (const Id<Tag> id : ids) json.value(std::int64_t(id.index | std::uint64_t(id.generation) << 32));
  json.end_array();
  json.key(looks_name).begin_array();
  for (const std::uint32_t look : looks) json.value(std::int64_t(look));
  json.end_array();
  json.key("names").begin_array();
  for (const Id<Tag> id : ids) json.value(label_of(id).name);
  json.end_array();
  json.key("colors").begin_array();
  for (const Id<Tag> id : ids) {
    json.begin_array();
    for (const TrackColor c : label_of(id).colors) json.value(c.red << 16 | c.green << 8 | c.blue);
    json.end_array();
  }
  json.end_array();
}

// The bodies and the soft matter of a frame, and of all others with its number.
void describe_set(JsonWriter& json, const PoseTrack& track, const TrackFrame& frame) {
  json.begin_object(JsonLayout::one_line);
  describe_members(json, frame.ids, "models", frame.models, [&](BodyId id) { return track.label(id); });
  json.key("soft").begin_object();
  describe_members(json, frame.soft_ids, "surfaces", frame.softs,
                   [&](SoftId id) { return track.soft_label(id); });
  json.end_object();
  json.end_object();
}

void place(Answer& answer, const TrackFrame& frame, DVec3 origin) {
  std::vector<float> poses;
  poses.reserve(7 * frame.poses.size());
  for (const Pose& pose : frame.poses) {
    const DVec3 p = pose.position - origin;
    const Quat q = pose.orientation;
    poses.insert(poses.end(), {float(p.x), float(p.y), float(p.z), q.x, q.y, q.z, q.w});
  }
  std::vector<float> vertices;
  vertices.reserve(3 * frame.vertices.size());
  for (const DVec3 vertex : frame.vertices) {
    const DVec3 p = vertex - origin;
    vertices.insert(vertices.end(), {float(p.x), float(p.y), float(p.z)});
  }
  answer.json.begin_object(JsonLayout::one_line);
  answer.json.field("step", std::int64_t(frame.step));
  answer.json.field("time", frame.time);
  answer.json.field("set", std::int64_t(frame.set_version));
  answer.array("poses", std::span<const float>(poses));
  answer.array("awake", frame.awake);
  answer.array("vertices", std::span<const float>(vertices));
  answer.json.end_object();
}

// The middle of all bodies, in whole metres.
DVec3 origin_of(const TrackFrame& frame) {
  DVec3 sum{};
  for (const Pose& pose : frame.poses) sum = sum + pose.position;
  const double count = double(std::max<std::size_t>(frame.poses.size(), 1));
  const DVec3 middle{sum.x / count, sum.y / count, sum.z / count};
  if (std::abs(middle.x) < kFar && std::abs(middle.y) < kFar && std::abs(middle.z) < kFar) return {};
  return {std::round(middle.x), std::round(middle.y), std::round(middle.z)};
}

struct BytesInMemory : ByteSink {
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
};

Result<PoseTrack> open_track(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<std::byte> bytes(file ? std::size_t(file.tellg()) : 0);
  file.seekg(0).read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  Result<PoseTrack> track = PoseTrack::open(bytes);
  if (track || track.error().code != ErrorCode::unsupported) return track;
  Result<Replay> replay = Replay::open(std::move(bytes));
  if (!replay) return replay.error();  // it can say more about what was recorded
  BytesInMemory poses;
  {
    Recorder recorder(replay->world(), poses, {.commands = false});
    while (replay->step()) {
    }
    recorder.finish();
  }
  return PoseTrack::open(std::move(poses.bytes));
}

}  // namespace

Error ServedRecording::open() {
  Result<PoseTrack> track = open_track(path_);
  if (!track) return track.error();
  track_ = *std::move(track);
  const TrackFrame first = track_->frame();
  origin_ = origin_of(first);
  const std::size_t frame_bytes = kRowBytes * first.ids.size() + kVertexBytes * first.vertices.size();
  frames_in_group_ =
      std::clamp(kGroupBytes / std::max<std::size_t>(frame_bytes, 1), std::size_t(1), kMaxFramesInGroup);
  return {};
}

Result<std::string> ServedRecording::scene() {
  const std::lock_guard lock(mutex_);
  if (Error why = open()) return why;
  Answer answer;
  JsonWriter& json = answer.json;
  json.begin_object();
  json.field("frames", std::int64_t(track_->frame_count()));
  json.field("group", std::int64_t(frames_in_group_));
  json.field("truncated", track_->truncated());
  json.field("time_step", track_->frame_count() > 1 ? track_->time(1) - track_->time(0) : 1.0 / 60.0);
  json.field("origin", origin_);
  json.key("accuracy").begin_object(JsonLayout::one_line);
  json.field("position", track_->accuracy().position);
  json.field("orientation", track_->accuracy().orientation);
  json.end_object();
  json.field("note", track_->note("scene"));
  json.key("models").begin_array();
  for (const TrackModel& model : track_->models()) describe_model(json, model);
  json.end_array();
  describe_surfaces(answer, track_->models());
  describe_softs(answer, track_->softs());
  json.end_object();
  return answer.take();
}

Result<std::string> ServedRecording::frames(std::size_t group) {
  const std::lock_guard lock(mutex_);
  if (!track_) {
    if (Error why = open()) return why;
  }
  const std::size_t begin = group * frames_in_group_;
  const std::size_t end = std::min(begin + frames_in_group_, track_->frame_count());
  if (begin >= end) return make_error(ErrorCode::invalid_argument, "there is no group %zu of frames", group);
  Answer answer;
  std::vector<std::size_t> sets;  // a frame of each
  std::set<std::uint64_t> known;
  answer.json.begin_object();
  answer.json.key("frames").begin_array();
  for (std::size_t i = begin; i < end; ++i) {
    if (Error why = track_->seek(i)) return why;
    if (known.insert(track_->frame().set_version).second) sets.push_back(i);
    place(answer, track_->frame(), origin_);
  }
  answer.json.end_array();
  answer.json.key("sets").begin_object();
  for (const std::size_t i : sets) {
    if (Error why = track_->seek(i)) return why;
    answer.json.key(std::to_string(track_->frame().set_version));
    describe_set(answer.json, *track_, track_->frame());
  }
  answer.json.end_object();
  answer.json.end_object();
  return answer.take();
}

}  // namespace gyre
