// Poses and looks as JSON and arrays. See served_recording.h.
#include "view/served_recording.h"

#include <gyre/geometry.h>
#include <gyre/replay.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <set>
#include <vector>

namespace gyre {
namespace {

using Json = nlohmann::ordered_json;

// One answer is about this large: soon sent, and seldom asked for.
constexpr std::size_t kGroupBytes = std::size_t(1) << 20;
constexpr std::size_t kMaxFramesInGroup = 120;
constexpr std::size_t kRowBytes = 7 * sizeof(float) + 1;
// m; what lies nearer to zero is drawn where it is.
constexpr double kFar = 1000.0;

class Arrays {
 public:
  template <typename T>
  Json add(std::span<const T> values) {
    const std::size_t begin = bytes_.size();
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return Json::array({begin, values.size()});
  }
  // Three numbers each.
  Json add(std::span<const Vec3> points) {
    std::vector<float> numbers;
    numbers.reserve(3 * points.size());
    for (const Vec3 p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return add(std::span<const float>(numbers));
  }
  std::string answer(const Json& text) const {
    // Names are bytes of whoever recorded them.
    std::string out = text.dump(-1, ' ', false, Json::error_handler_t::replace);
    out.resize((out.size() + 3) / 4 * 4, ' ');
    const auto length = std::uint32_t(out.size());
    char head[sizeof length];
    std::memcpy(head, &length, sizeof length);
    return std::string(head, sizeof head) + out + bytes_;
  }

 private:
  std::string bytes_;
};

Json numbers(Vec3 v) { return Json::array({v.x, v.y, v.z}); }

const char* word(BodyType type) {
  return type == BodyType::dynamic ? "dynamic" : type == BodyType::kinematic ? "kinematic" : "fixed";
}

std::uint64_t number(BodyId id) { return id.index | std::uint64_t(id.generation) << 32; }

// Each surface once, however many shapes have it.
class Looks {
 public:
  explicit Looks(Arrays& arrays) : arrays_(arrays) {}

  Json operator()(const Sphere& s) { return {{"kind", "sphere"}, {"radius", s.radius}}; }
  Json operator()(const Box& b) {
    return {{"kind", "box"}, {"halfExtents", numbers(b.half_extents)}, {"rounding", b.rounding}};
  }
  Json operator()(const Capsule& s) { return round("capsule", s.radius, s.half_height); }
  Json operator()(const Cylinder& s) { return round("cylinder", s.radius, s.half_height); }
  Json operator()(const Cone& s) { return round("cone", s.radius, s.half_height); }
  Json operator()(const Plane& p) {
    return {{"kind", "plane"}, {"normal", numbers(p.normal)}, {"offset", p.offset}};
  }
  Json operator()(const Geometry& geometry) {
    char key[17];
    std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(geometry.content_hash()));
    if (known_.insert(key).second) surfaces_.push_back(surface(key, geometry));
    return {{"kind", "surface"}, {"surface", key}};
  }
  Json& surfaces() { return surfaces_; }

 private:
  static Json round(const char* kind, float radius, float half_height) {
    return {{"kind", kind}, {"radius", radius}, {"halfHeight", half_height}};
  }
  Json surface(const char* key, const Geometry& geometry) {
    if (geometry.kind() == ShapeKind::hull) {
      const HullView hull = view_hull(geometry);
      return {{"key", key},
              {"kind", "hull"},
              {"vertices", arrays_.add(hull.vertices)},
              {"face_offsets", arrays_.add(hull.face_offsets)},
              {"face_indices", arrays_.add(hull.face_indices)}};
    }
    if (geometry.kind() == ShapeKind::mesh) {
      const MeshView mesh = view_mesh(geometry);
      return {{"key", key},
              {"kind", "mesh"},
              {"vertices", arrays_.add(mesh.vertices)},
              {"indices", arrays_.add(mesh.indices)}};
    }
    const HeightFieldView field = view_height_field(geometry);
    return {{"key", key},
            {"kind", "height_field"},
            {"heights", arrays_.add(field.heights)},
            {"columns", field.columns},
            {"rows", field.rows},
            {"spacing", field.spacing}};
  }

  Arrays& arrays_;
  std::set<std::string> known_;
  Json surfaces_ = Json::array();
};

Json describe(const TrackModel& model, Looks& looks) {
  Json shapes = Json::array();
  for (const TrackShape& shape : model.shapes) {
    const Quat q = shape.local.orientation;
    shapes.push_back({{"geometry", std::visit(looks, shape.geometry)},
                      {"position", numbers(shape.local.position)},
                      {"rotation", Json::array({q.x, q.y, q.z, q.w})},
                      {"sensor", shape.sensor}});
  }
  return {{"type", word(model.type)}, {"shapes", std::move(shapes)}};
}

// The bodies of a frame, and of all others with its number.
Json describe_set(const PoseTrack& track, const TrackFrame& frame) {
  Json ids = Json::array(), names = Json::array(), colors = Json::array();
  for (const BodyId id : frame.ids) {
    const TrackLabel label = track.label(id);
    Json own = Json::array();
    for (const TrackColor c : label.colors) own.push_back(c.red << 16 | c.green << 8 | c.blue);
    ids.push_back(number(id));
    names.push_back(std::string(label.name));
    colors.push_back(std::move(own));
  }
  return {{"ids", std::move(ids)},
          {"models", std::vector<std::uint32_t>(frame.models.begin(), frame.models.end())},
          {"names", std::move(names)},
          {"colors", std::move(colors)}};
}

Json place(const TrackFrame& frame, DVec3 origin, Arrays& arrays) {
  std::vector<float> poses;
  poses.reserve(7 * frame.poses.size());
  for (const Pose& pose : frame.poses) {
    const DVec3 p = pose.position - origin;
    const Quat q = pose.orientation;
    poses.insert(poses.end(), {float(p.x), float(p.y), float(p.z), q.x, q.y, q.z, q.w});
  }
  return {{"step", frame.step},
          {"time", frame.time},
          {"set", frame.set_version},
          {"poses", arrays.add(std::span<const float>(poses))},
          {"awake", arrays.add(frame.awake)}};
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
  frames_in_group_ = std::clamp(kGroupBytes / (kRowBytes * std::max<std::size_t>(first.ids.size(), 1)),
                                std::size_t(1), kMaxFramesInGroup);
  return {};
}

Result<std::string> ServedRecording::scene() {
  const std::lock_guard lock(mutex_);
  if (Error why = open(); why.code != ErrorCode::none) return why;
  Arrays arrays;
  Looks looks(arrays);
  Json models = Json::array();
  for (const TrackModel& model : track_->models()) models.push_back(describe(model, looks));
  const TrackAccuracy accuracy = track_->accuracy();
  const double time_step = track_->frame_count() > 1 ? track_->time(1) - track_->time(0) : 1.0 / 60.0;
  return arrays.answer(
      {{"frames", track_->frame_count()},
       {"group", frames_in_group_},
       {"truncated", track_->truncated()},
       {"time_step", time_step},
       {"origin", Json::array({origin_.x, origin_.y, origin_.z})},
       {"accuracy", {{"position", accuracy.position}, {"orientation", accuracy.orientation}}},
       {"note", std::string(track_->note("scene"))},
       {"models", std::move(models)},
       {"surfaces", std::move(looks.surfaces())}});
}

Result<std::string> ServedRecording::frames(std::size_t group) {
  const std::lock_guard lock(mutex_);
  if (!track_) {
    if (Error why = open(); why.code != ErrorCode::none) return why;
  }
  const std::size_t count = track_->frame_count();
  if (group >= (count + frames_in_group_ - 1) / frames_in_group_) {
    return Error{ErrorCode::invalid_argument, "there is no such group of frames"};
  }
  Arrays arrays;
  Json list = Json::array(), sets = Json::object();
  const std::size_t begin = group * frames_in_group_;
  for (std::size_t i = begin; i < std::min(begin + frames_in_group_, count); ++i) {
    if (Error why = track_->seek(i); why.code != ErrorCode::none) return why;
    const TrackFrame frame = track_->frame();
    const std::string set = std::to_string(frame.set_version);
    if (!sets.contains(set)) sets[set] = describe_set(*track_, frame);
    list.push_back(place(frame, origin_, arrays));
  }
  return arrays.answer({{"frames", std::move(list)}, {"sets", std::move(sets)}});
}

}  // namespace gyre
