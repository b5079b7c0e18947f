// Scenes and recordings as one thing to play. See player.h.
#include "render/player.h"

#include "scene/mesh_file.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <optional>

namespace gyre {
namespace {

class ScenePlayer : public Player {
 public:
  ScenePlayer(Scene scene, std::string path, int threads)
      : source_(std::move(scene)), path_(std::move(path)), threads_(threads) {}

  const World& world() const override { return runner_->world(); }
  const Scene* scene() const override { return &runner_->scene(); }
  std::span<const BodyId> bodies() const override { return runner_->bodies(); }
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
  std::span<const JointId> joint_ids() const override { return runner_->joints(); }

  Scene source_;
  std::string path_;
  int threads_;
  std::optional<SceneRunner> runner_;
};

class RecordingPlayer : public Player {
 public:
  RecordingPlayer(Replay replay, std::optional<Scene> look)
      : replay_(std::move(replay)), look_(std::move(look)) {
    start_ = replay_.world().time();
    if (replay_.truncated()) note_ = "the recording has no end; it is played up to its last whole step";
  }

  const World& world() const override { return replay_.world(); }
  const Scene* scene() const override { return look_ ? &*look_ : nullptr; }
  std::span<const BodyId> bodies() const override { return bodies_; }
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
    if (why.code != ErrorCode::none) {
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
  std::vector<BodyId> bodies_;
  double start_ = 0;
};

bool looks_like_scene(const std::string& bytes) {
  const std::size_t at = bytes.find_first_not_of("\xef\xbb\xbf \t\r\n");
  return at == std::string::npos || bytes[at] == '{';
}

std::unique_ptr<Player> open_recording(const std::string& path, const std::string& bytes,
                                       const std::string& look, int threads, std::string& error) {
  const auto* data = reinterpret_cast<const std::byte*>(bytes.data());
  WorldDef def;
  def.threads = threads;
  Result<Replay> replay = Replay::open(std::vector<std::byte>(data, data + bytes.size()), def);
  if (!replay) {
    error = path + ": " + replay.error().message;
    return nullptr;
  }
  std::optional<Scene> scene;
  if (!look.empty()) {
    SceneResult<Scene> read = load_scene(look);
    if (!read) {
      error = read.error().text();
      return nullptr;
    }
    scene = *std::move(read);
  }
  return std::make_unique<RecordingPlayer>(*std::move(replay), std::move(scene));
}

}  // namespace

bool Player::advance_to(double seconds) {
  // The length of a recording's first step is only known when it is done.
  while (time() + 0.5 * last_step_ < seconds) {
    if (!step()) return false;
  }
  return true;
}

std::vector<SeenJoint> Player::joints() const {
  std::vector<SeenJoint> out;
  if (!scene()) return out;
  for (std::size_t i = 0; i < scene()->joints.size(); ++i) {
    const SceneJoint& joint = scene()->joints[i];
    SeenJoint seen;
    seen.joint = &joint;
    if (i < joint_ids().size()) seen.id = joint_ids()[i];
    const auto start = [&](int body) {
      return body < 0 ? Pose{} : scene()->bodies[std::size_t(body)].def.pose;
    };
    if (joint.a >= 0) seen.a = bodies()[std::size_t(joint.a)];
    if (joint.b >= 0) seen.b = bodies()[std::size_t(joint.b)];
    seen.place_a = seen.place_b = joint.def.anchor;
    if (joint.def.kind == JointKind::distance) {
      seen.place_b = joint.def.anchor_b ? *joint.def.anchor_b : start(joint.b).position;
    }
    seen.point_a = inverse_times(start(joint.a), seen.place_a);
    seen.point_b = inverse_times(start(joint.b), seen.place_b);
    out.push_back(seen);
  }
  return out;
}

std::unique_ptr<Player> open_player(const std::string& path, const std::string& look, int threads,
                                    std::string& error) {
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
  if (looks_like_scene(bytes)) {
    SceneResult<Scene> scene = load_scene(path);
    if (!scene) {
      error = scene.error().text();
      return nullptr;
    }
    player = std::make_unique<ScenePlayer>(*std::move(scene), path, threads);
  } else {
    player = open_recording(path, bytes, look, threads, error);
  }
  if (player && !player->rewind(error)) {
    if (error.find(path) != 0) error = path + ": " + error;
    player.reset();
  }
  return player;
}

}  // namespace gyre
