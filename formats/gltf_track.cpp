// Recordings to animated glTF files. The format: Khronos Group, "glTF 2.0 Specification". See export.h.
//
// Each body, and each rope, cloth or solid, is a node with keys at the times of the frames. Soft matter moves by morph targets, one for each
// key after the first. A body that is not in every frame has the scale 0 where it is missing.
#include "formats/export.h"
#include "formats/gltf_builder.h"
#include "scene/scene_color.h"

#include <algorithm>

namespace gyre {
namespace {

constexpr int kRoundSegments = 24;
constexpr std::size_t kMaxSoftKeys = 500;                     // three.js holds 2,048 targets of a mesh
constexpr std::size_t kMaxTrackBytes = std::size_t(1) << 30;  // of keys, in memory

struct BodyTrack {
  int node = 0;
  std::vector<float> times;
  std::vector<Vec3> positions;
  std::vector<Quat> orientations;
  std::vector<std::pair<std::size_t, std::size_t>> spans;  // frames in which it is there, first and last
};

struct SoftTrack {
  SoftId id{};
  std::uint32_t model = 0;
  int number = 0;
  std::vector<float> times;
  std::vector<std::vector<Vec3>> keys;
  std::vector<std::pair<std::size_t, std::size_t>> spans;
};

void extend_spans(std::vector<std::pair<std::size_t, std::size_t>>& spans, std::size_t frame) {
  if (spans.empty() || spans.back().second + 1 < frame) spans.push_back({frame, frame});
  spans.back().second = frame;
}

class TrackWriter {
 public:
  explicit TrackWriter(PoseTrack& track) : track_(track) {}
  SceneResult<ExportedFile> write(const std::string& file, bool binary);

 private:
  void take_frame(std::size_t frame);
  void add_body_node(BodyTrack& out, BodyId id, std::uint32_t model, const Pose& pose, std::size_t number);
  void animate(const BodyTrack& body);
  void animate(const SoftTrack& soft);
  void animate_presence(int node, const std::vector<std::pair<std::size_t, std::size_t>>& spans);
  void add_channel(int node, const char* path, int times, int values, const char* interpolation);
  Json model_node(const TrackShape& shape, SceneColor color);
  float seconds(std::size_t frame) const { return float(track_.time(frame) - track_.time(0)); }

  PoseTrack& track_;
  GltfBuilder built_;
  std::map<std::pair<std::uint64_t, std::uint32_t>, BodyTrack> bodies_;
  std::map<std::pair<std::uint64_t, std::uint32_t>, SoftTrack> softs_;
  std::map<std::string, int> meshes_;
  Json channels_ = Json::array(), samplers_ = Json::array();
  std::size_t bytes_ = 0, soft_stride_ = 1;
};

// A node with the mesh of a shape, in the frame of the body.
Json TrackWriter::model_node(const TrackShape& shape, SceneColor color) {
  Transform local = shape.local;
  ShapeMesh mesh;
  std::string key = color_text(color);
  if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
    mesh = ground_mesh();
    const Vec3 up = normalized(plane->normal);
    local.position = local * (plane->offset * up);
    local.orientation = local.orientation * from_directions({0, 1, 0}, up);
    key += " plane";
  } else if (const auto* cooked = std::get_if<Geometry>(&shape.geometry)) {
    key += " " + std::to_string(cooked->content_hash());
  } else {
    const Aabb box = bounding_box(shape.geometry);
    key += " " + std::to_string(shape.geometry.index());
    for (const float value : {box.high.x, box.high.y, box.high.z, rounding_radius(shape.geometry)})
      append_little(key, value);
  }
  const auto [found, is_new] = meshes_.try_emplace(key, -1);
  if (is_new) {
    if (mesh.indices.empty()) mesh = make_shape_mesh(shape.geometry, kRoundSegments);
    if (!mesh.indices.empty()) found->second = built_.add_mesh(built_.triangles(mesh, color));
  }
  Json node = Json::object();
  if (found->second >= 0) node["mesh"] = found->second;
  if (!(local.position == Vec3{})) node["translation"] = gltf_numbers(local.position);
  if (!(local.orientation == Quat{})) node["rotation"] = gltf_numbers(local.orientation);
  return node;
}

void TrackWriter::add_body_node(BodyTrack& out, BodyId id, std::uint32_t model, const Pose& pose,
                                std::size_t number) {
  const TrackModel& look = track_.models()[model];
  const TrackLabel label = track_.label(id);
  const std::string name(label.name);
  out.node = built_.add_node({{"name", name.empty() ? "body " + std::to_string(id.index) : name},
                              {"translation", gltf_numbers(to_float(pose.position))},
                              {"rotation", gltf_numbers(pose.orientation)}});
  built_.json()["scenes"][0]["nodes"].push_back(out.node);
  for (std::size_t i = 0; i < look.shapes.size(); ++i) {
    SceneColor color = std::holds_alternative<Plane>(look.shapes[i].geometry)
                           ? kGroundColor
                           : automatic_color(look.type, number);
    if (i < label.colors.size()) color = {label.colors[i].red, label.colors[i].green, label.colors[i].blue};
    const Json part = model_node(look.shapes[i], color);
    if (!part.contains("mesh") || look.shapes[i].sensor) continue;
    const int child = built_.add_node(part);
    built_.add_child(out.node, child);
  }
}

void TrackWriter::take_frame(std::size_t frame) {
  const TrackFrame now = track_.frame();
  for (std::size_t i = 0; i < now.ids.size(); ++i) {
    const auto [found, is_new] =
        bodies_.try_emplace({std::uint64_t(now.ids[i].index) << 32 | now.ids[i].generation, now.models[i]});
    BodyTrack& body = found->second;
    if (is_new) add_body_node(body, now.ids[i], now.models[i], now.poses[i], i);
    extend_spans(body.spans, frame);
    const Vec3 position = to_float(now.poses[i].position);
    Quat orientation = now.poses[i].orientation;
    const std::size_t keys = body.times.size();
    if (keys > 0 && dot(body.orientations.back(), orientation) < 0.0f) orientation = -orientation;
    // Of three equal keys in a row the middle one says nothing.
    const auto equals = [&](std::size_t k) {
      return body.positions[k] == position && body.orientations[k] == orientation;
    };
    if (keys >= 2 && equals(keys - 1) && equals(keys - 2)) {
      body.times.back() = seconds(frame);
      continue;
    }
    body.times.push_back(seconds(frame));
    body.positions.push_back(position);
    body.orientations.push_back(orientation);
    bytes_ += 32;
  }
  for (std::size_t i = 0; i < now.soft_ids.size(); ++i) {
    const auto [found, is_new] = softs_.try_emplace(
        {std::uint64_t(now.soft_ids[i].index) << 32 | now.soft_ids[i].generation, now.softs[i]});
    SoftTrack& soft = found->second;
    if (is_new) {
      soft.id = now.soft_ids[i];
      soft.model = now.softs[i];
      soft.number = int(i);
    }
    extend_spans(soft.spans, frame);
    if (frame % soft_stride_ != 0 && frame + 1 != track_.frame_count() && !is_new) continue;
    std::vector<Vec3> vertices;
    for (const DVec3 vertex : track_.soft_vertices(i)) vertices.push_back(to_float(vertex));
    bytes_ += 12 * vertices.size();
    soft.times.push_back(seconds(frame));
    soft.keys.push_back(std::move(vertices));
  }
}

void TrackWriter::add_channel(int node, const char* path, int times, int values, const char* interpolation) {
  channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
  samplers_.push_back({{"input", times}, {"output", values}, {"interpolation", interpolation}});
}

void TrackWriter::animate_presence(int node, const std::vector<std::pair<std::size_t, std::size_t>>& spans) {
  const std::size_t frames = track_.frame_count();
  if (spans.size() == 1 && spans[0].first == 0 && spans[0].second + 1 == frames) return;
  std::vector<float> times, scales;
  const auto add = [&](float time, float scale) {
    times.push_back(time);
    scales.insert(scales.end(), 3, scale);
  };
  if (spans[0].first > 0) add(0.0f, 0.0f);
  for (const auto& [first, last] : spans) {
    add(seconds(first), 1.0f);
    if (last + 1 < frames) add(seconds(last + 1), 0.0f);
  }
  add_channel(node, "scale", built_.add_floats(times, 1, true), built_.add_floats(scales, 3, false), "STEP");
}

void TrackWriter::animate(const BodyTrack& body) {
  bool moves = false, turns = false;
  std::vector<float> quaternions;
  for (std::size_t k = 0; k < body.times.size(); ++k) {
    moves = moves || !(body.positions[k] == body.positions[0]);
    turns = turns || !(body.orientations[k] == body.orientations[0]);
    const Quat q = normalized(body.orientations[k]);
    quaternions.insert(quaternions.end(), {q.x, q.y, q.z, q.w});
  }
  if (moves || turns) {
    const int times = built_.add_floats(body.times, 1, true);
    if (moves)
      add_channel(body.node, "translation", times, built_.add_vectors(body.positions, false), "LINEAR");
    if (turns) add_channel(body.node, "rotation", times, built_.add_floats(quaternions, 4, false), "LINEAR");
  }
  animate_presence(body.node, body.spans);
}

void TrackWriter::animate(const SoftTrack& soft) {
  const TrackSoft& look = track_.softs()[soft.model];
  const TrackLabel label = track_.soft_label(soft.id);
  SceneColor color = automatic_color(BodyType::dynamic, std::size_t(soft.number));
  if (!label.colors.empty()) color = {label.colors[0].red, label.colors[0].green, label.colors[0].blue};
  const std::vector<Vec3>& base = soft.keys[0];
  if (base.empty()) return;
  Json primitive;
  if (look.triangles.empty()) {
    primitive = {{"attributes", {{"POSITION", built_.add_vectors(base, true)}}},
                 {"mode", 3},
                 {"material", built_.color_material(color)}};
  } else {
    primitive = built_.triangles(base, look.triangles, color);
  }
  const std::size_t targets = soft.keys.size() - 1;
  std::vector<float> weights, none(targets, 0.0f);
  for (std::size_t k = 1; k < soft.keys.size(); ++k) {
    std::vector<Vec3> moved(base.size());
    for (std::size_t v = 0; v < base.size(); ++v) moved[v] = soft.keys[k][v] - base[v];
    primitive["targets"].push_back({{"POSITION", built_.add_vectors(moved, true)}});
  }
  const int mesh = built_.add_mesh(std::move(primitive));
  const std::string name(label.name);
  const int node = built_.add_node(
      {{"name", name.empty() ? "soft " + std::to_string(soft.id.index) : name}, {"mesh", mesh}});
  built_.json()["scenes"][0]["nodes"].push_back(node);
  if (targets > 0) {
    built_.json()["meshes"].back()["weights"] = none;
    for (std::size_t k = 0; k < soft.keys.size(); ++k) {
      for (std::size_t t = 0; t < targets; ++t) weights.push_back(t + 1 == k ? 1.0f : 0.0f);
    }
    add_channel(node, "weights", built_.add_floats(soft.times, 1, true), built_.add_floats(weights, 1, false),
                "LINEAR");
  }
  animate_presence(node, soft.spans);
}

SceneResult<ExportedFile> TrackWriter::write(const std::string& file, bool binary) {
  ExportedFile out;
  const std::size_t frames = track_.frame_count();
  soft_stride_ = (frames + kMaxSoftKeys - 1) / kMaxSoftKeys;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    if (const Error why = track_.seek(frame)) return SceneError{file, 0, 0, "", why.message};
    take_frame(frame);
    if (bytes_ > kMaxTrackBytes)
      return SceneError{file, 0, 0, "", "has poses of more than 1 GiB, which is the limit of an animation"};
  }
  if (soft_stride_ > 1 && !softs_.empty())
    out.notes.push_back("ropes, cloths and solids have a key for every " + std::to_string(soft_stride_) +
                        " frames, because a mesh has at most 500");
  for (const auto& [key, body] : bodies_) animate(body);
  for (const auto& [key, soft] : softs_) animate(soft);
  if (!channels_.empty())
    built_.json()["animations"] =
        Json::array({{{"name", "simulation"}, {"channels", channels_}, {"samplers", samplers_}}});
  out.bytes = built_.take(binary);
  return out;
}

}  // namespace

SceneResult<ExportedFile> export_gltf(PoseTrack& track, const std::string& file, bool binary) {
  return TrackWriter(track).write(file, binary);
}

}  // namespace gyre
