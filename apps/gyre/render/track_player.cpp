// Recordings with a pose track as something to play. See track_player.h.
#include "render/track_player.h"

#include "scene/scene_color.h"
#include "scene/scene_labels.h"

namespace gyre {
namespace {

class TrackPlayer : public Player {
 public:
  explicit TrackPlayer(PoseTrack track) : track_(std::move(track)) {
    if (track_.truncated()) note_ = kTruncatedNote;
  }

  void look(Sight& out) const override {
    out = {};
    const TrackFrame frame = track_.frame();
    for (std::size_t i = 0; i < frame.ids.size(); ++i) {
      const TrackModel& model = track_.models()[frame.models[i]];
      out.bodies.push_back(
          {frame.ids[i], model.type, frame.poses[i], out.shapes.size(), model.shapes.size()});
      for (const TrackShape& shape : model.shapes) {
        const bool plane = std::holds_alternative<Plane>(shape.geometry);
        out.shapes.push_back({&shape.geometry, shape.local,
                              plane ? kGroundColor : automatic_color(model.type, i), shape.sensor});
      }
    }
    for (std::size_t i = 0; i < frame.soft_ids.size(); ++i) {
      const TrackSoft& soft = track_.softs()[frame.softs[i]];
      const std::span<const DVec3> vertices = track_.soft_vertices(i);
      out.softs.push_back({frame.soft_ids[i], soft.kind, soft.radius, soft.triangles, out.vertices.size(),
                           vertices.size(), automatic_color(BodyType::dynamic, i), {}});
      out.vertices.insert(out.vertices.end(), vertices.begin(), vertices.end());
    }
    apply_track_colors(track_, out);
  }
  std::optional<SceneView> view() const override { return view_of_track(track_); }
  BodyId find(const std::string& name) const override {
    Sight sight;
    look(sight);
    return find_in_track(track_, sight.bodies, name);
  }
  bool has_readings() const override { return false; }
  bool has_weight() const override { return true; }
  bool is_recording() const override { return true; }
  double time() const override { return track_.time(track_.position()) - track_.time(0); }

  bool step() override {
    if (track_.position() + 1 >= track_.frame_count()) return false;
    const double before = time();
    const Error why = track_.seek(track_.position() + 1);
    if (why) {
      note_ = why.message;
      return false;
    }
    last_step_ = time() - before;
    return true;
  }
  bool rewind(std::string& error) override {
    const Error why = track_.seek(0);
    last_step_ = 0;
    if (why) error = why.message;
    return why.ok();
  }

 private:
  PoseTrack track_;
};

}  // namespace

std::unique_ptr<Player> make_track_player(PoseTrack track) {
  return std::make_unique<TrackPlayer>(std::move(track));
}

BodyId find_in_track(const PoseTrack& track, std::span<const SeenBody> bodies, const std::string& name) {
  for (const SeenBody& body : bodies) {
    if (track.label(body.id).name == name) return body.id;
  }
  return {};
}

void apply_track_colors(const PoseTrack& track, Sight& sight) {
  for (const SeenBody& body : sight.bodies) {
    const std::span<const TrackColor> colors = track.label(body.id).colors;
    for (std::size_t k = 0; k < min(colors.size(), body.shape_count); ++k) {
      sight.shapes[body.first_shape + k].color = {colors[k].red, colors[k].green, colors[k].blue};
    }
  }
  for (SeenSoft& soft : sight.softs) {
    const std::span<const TrackColor> colors = track.soft_label(soft.id).colors;
    if (!colors.empty()) soft.color = {colors[0].red, colors[0].green, colors[0].blue};
  }
}

std::optional<SceneView> view_of_track(const PoseTrack& track) { return view_of_note(track.note("scene")); }

}  // namespace gyre
