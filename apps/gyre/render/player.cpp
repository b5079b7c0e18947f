// Scenes and recordings as one thing to play. See player.h.
#include "render/player.h"

#include "render/track_player.h"
#include "scene/decomposition_folder.h"
#include "scene/mesh_file.h"
#include "scene/scene_runner.h"

#include <gyre/replay.h>

#include <span>
#include <vector>

namespace gyre {
namespace {

BodyId find_body(const Scene& scene, std::span<const BodyId> bodies, const std::string& name) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return bodies[i];
  }
  return {};
}

class ScenePlayer : public Player {
 public:
  ScenePlayer(Scene scene, std::string path, int threads)
      : source_(std::move(scene)), path_(std::move(path)), threads_(threads) {}

  void look(Sight& out) const override { look_at(runner_->world(), &source_, runner_->bodies(), reading_, out); }
  std::optional<SceneView> view() const override { return source_.view; }
  BodyId find(const std::string& name) const override { return find_body(source_, runner_->bodies(), name); }
  bool has_weight() const override { return !(runner_->world().gravity() == Vec3{}); }
  bool is_recording() const override { return false; }
  double time() const override { return runner_->time(); }

  bool step() override {
    if (runner_->step()) return true;
    problem_ = runner_->problem();
    return false;
  }
  bool rewind(std::string& error) override {
    SceneResult<SceneRunner> made = SceneRunner::create(source_, path_, threads_);
    if (!made) {
      error = made.error().text();
      return false;
    }
    runner_.emplace(*std::move(made));
    problem_.clear();
    last_step_ = source_.world.time_step;
    return true;
  }

 private:
  Scene source_;
  std::string path_;
  int threads_;
  std::optional<SceneRunner> runner_;
};

class RecordingPlayer : public Player {
 public:
  // How things look is told by `look`, a scene, or else by the recording's own track, if there is one.
  RecordingPlayer(Replay replay, std::optional<Scene> look, std::optional<PoseTrack> track)
      : replay_(std::move(replay)), look_(std::move(look)), track_(std::move(track)) {
    start_ = replay_.world().time();
    if (replay_.truncated()) note_ = kTruncatedNote;
  }

  void look(Sight& out) const override {
    look_at(replay_.world(), look_ ? &*look_ : nullptr, bodies_, reading_, out);
    if (!look_ && track_) apply_track_colors(*track_, out);
  }
  std::optional<SceneView> view() const override {
    if (look_) return look_->view;
    return track_ ? view_of_track(*track_) : std::nullopt;
  }
  BodyId find(const std::string& name) const override {
    if (look_) return find_body(*look_, bodies_, name);
    Sight sight;
    look(sight);
    return track_ ? find_in_track(*track_, sight.bodies, name) : BodyId{};
  }
  bool has_weight() const override { return !(replay_.world().gravity() == Vec3{}); }
  bool is_recording() const override { return true; }
  double time() const override { return replay_.world().time() - start_; }

  bool step() override {
    if (replay_.position() >= replay_.step_count()) return false;
    const double before = replay_.world().time();
    bool matches = true;
    if (!replay_.step(&matches)) return false;
    last_step_ = replay_.world().time() - before;
    if (!matches && note_.empty()) {
      note_ = "step " + std::to_string(replay_.position()) +
              " is not as it was recorded: another version of Gyre may have written the recording";
    }
    return true;
  }
  bool rewind(std::string& error) override {
    const Error why = replay_.seek(0);
    if (why) {
      error = why.message;
      return false;
    }
    last_step_ = 0;
    return find_bodies(error);
  }

 private:
  bool is_like(BodyId id, const SceneBody& body) const {
    const World& world = replay_.world();
    return world.type(id) == body.def.type && world.shapes(id).size() == body.shapes.size();
  }

  // Bodies of a scene carry their number in it as user data.
  bool find_bodies(std::string& error) {
    if (!look_) return true;
    bodies_.assign(look_->bodies.size(), BodyId{});
    std::size_t found = 0;
    for (const BodyId id : replay_.world().bodies().ids) {
      const std::uint64_t index = replay_.world().user_data(id);
      if (index < bodies_.size() && is_like(id, look_->bodies[index])) {
        bodies_[index] = id;
        ++found;
      }
    }
    if (found == bodies_.size()) return true;
    error = "the recording is not one of this scene: " + std::to_string(found) + " of its " +
            std::to_string(bodies_.size()) + " bodies are there";
    return false;
  }

  // World::time() and its like do not change a replay.
  mutable Replay replay_;
  std::optional<Scene> look_;
  std::optional<PoseTrack> track_;
  std::vector<BodyId> bodies_;
  double start_ = 0;
};

bool looks_like_scene(const std::string& bytes) {
  const std::size_t at = bytes.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return at == std::string::npos || bytes[at] == '{';
}

// Whether the first step comes out as it was recorded. What another version of Gyre recorded mostly does not.
bool replays_alike(Replay& replay) {
  bool matches = true;
  if (replay.step_count() > 0) replay.step(&matches);
  return replay.seek(0).ok() && matches;
}

// Replayed where that is possible, as a track knows no links; else its track is looked at.
std::unique_ptr<Player> open_recording(const std::string& path, const std::string& bytes,
                                       std::optional<Scene> look, int threads, std::string& error) {
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  WorldDef def;
  def.threads = threads;
  Result<Replay> replay = Replay::open(std::vector<std::byte>(data, data + bytes.size()), def);
  Result<PoseTrack> track = PoseTrack::open(std::vector<std::byte>(data, data + bytes.size()));
  const bool good = replay && replays_alike(*replay);
  if (!good && track && !look) return make_track_player(*std::move(track));
  if (replay) {
    std::optional<PoseTrack> looks;
    if (track) looks.emplace(*std::move(track));
    return std::make_unique<RecordingPlayer>(*std::move(replay), std::move(look), std::move(looks));
  }
  error = path + ": " + replay.error().message;
  return nullptr;
}

}  // namespace

bool Player::advance_to(double seconds) {
  // The length of a recording's first step is only known when it is done.
  while (time() + 0.5 * last_step_ < seconds) {
    if (!step() || (watcher_ != nullptr && !watcher_(user_))) return false;
  }
  return true;
}

std::unique_ptr<Player> open_player(const std::string& path, const std::string& look,
                                    const ImportOptions& import, int threads, std::string& error) {
  // A recording may be far larger than a scene; the scene reader keeps its own limit.
  SceneLimits limits;
  limits.file_bytes = std::size_t(1) << 32;
  std::string bytes;
  const std::string problem = read_whole_file(path, limits, bytes);
  if (!problem.empty()) {
    error = path + ": " + problem;
    return nullptr;
  }
  std::unique_ptr<Player> player;
  if (format_of(path) != FileFormat::scene || looks_like_scene(bytes)) {
    SceneResult<Scene> scene = open_split_scene(path, import);
    if (!scene) {
      error = scene.error().text();
      return nullptr;
    }
    player = std::make_unique<ScenePlayer>(*std::move(scene), path, threads);
  } else {
    std::optional<Scene> scene;
    if (!look.empty()) {
      SceneResult<Scene> read = open_split_scene(look, import);
      if (!read) {
        error = read.error().text();
        return nullptr;
      }
      scene = *std::move(read);
    }
    player = open_recording(path, bytes, std::move(scene), threads, error);
  }
  if (player && !player->rewind(error)) {
    if (error.find(path) != 0) error = path + ": " + error;
    player.reset();
  }
  return player;
}

}  // namespace gyre
