// gyre render: plays a scene or a recording twice, once to see where things will be and once to draw them. Nothing is written
// before all inputs are read and the machine has shown that it can draw. See render.h.
#include "render/render.h"

#include "exit_code.h"
#include "interrupt.h"
#include "progress.h"
#include "render/draw_list.h"
#include "render/frame_output.h"
#include "render/player.h"
#include "render/renderer.h"
#include "render/survey.h"
#include "formats/turning.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

namespace gyre {
namespace {

constexpr double kUsualSeconds = 5, kUsualFrameRate = 20;
constexpr std::uint64_t kUntilTheEnd = std::numeric_limits<std::uint64_t>::max();  // of a recording
constexpr std::uint64_t kMaxPictures = 10'000'000;
constexpr std::uint64_t kMaxMovieBytes = std::uint64_t(2)
                                         << 30;  // of memory, as a GIF needs all its frames at once

void say(const std::string& message) { std::fprintf(stderr, "gyre: %s\n", message.c_str()); }

float radians(double degrees) { return float(degrees) * (kHalfTurn / 180.0f); }

double frame_rate(const RenderOptions& options) { return options.frame_rate.value_or(kUsualFrameRate); }

// Which moments are drawn. A recording without an end in the options is played to its own.
FramePlan plan_frames(const RenderOptions& options, bool is_recording) {
  FramePlan plan;
  if (options.out.kind == OutputKind::picture) {
    plan.start = options.at.value_or(0);
    return plan;
  }
  plan.start = options.from.value_or(0);
  plan.interval = options.speed / frame_rate(options);
  if (options.frames) {
    plan.count = *options.frames;
  } else if (is_recording && !options.seconds && !options.to) {
    plan.count = kUntilTheEnd;
  } else {
    const double seconds =
        options.to ? *options.to - plan.start : options.seconds.value_or(kUsualSeconds) * options.speed;
    plan.count = std::uint64_t(max(std::floor(seconds / plan.interval + 1e-6), 1.0));
  }
  return plan;
}

CameraWish wish_of(const RenderOptions& options) {
  CameraWish wish;
  const auto place = [](const std::vector<double>& v) { return DVec3{v[0], v[1], v[2]}; };
  if (!options.eye.empty()) wish.eye = place(options.eye);
  if (!options.target.empty()) wish.target = place(options.target);
  if (options.field_of_view) wish.field_of_view = radians(*options.field_of_view);
  if (!options.direction.empty()) {
    wish.azimuth = radians(options.direction[0]);
    wish.elevation = radians(options.direction[1]);
    wish.given_direction = true;
  }
  wish.zoom = float(options.zoom);
  return wish;
}

// Where a body is; the place it was at, if it is gone.
DVec3 place_of(const Sight& sight, BodyId id, DVec3 before) {
  for (const SeenBody& body : sight.bodies) {
    if (body.id.index == id.index && body.id.generation == id.generation) return body.pose.position;
  }
  return before;
}

// One movie in the making.
class Rendering {
 public:
  explicit Rendering(const RenderOptions& options)
      : options_(options), output_(options.out, 1.0 / frame_rate(options)) {
    const bool movie = options.out.kind == OutputKind::movie;
    width_ = options.width.value_or(movie ? 480 : 960);
    height_ = options.height.value_or(movie ? 300 : 600);
  }

  int run();

 private:
  bool find_follow();
  bool fits_in_memory() const;
  bool prepare();
  int draw_frames();
  int stop(const std::string& message) {
    say(message);
    return kExitInvalid;
  }

  const RenderOptions& options_;
  FrameOutput output_;
  int width_, height_;
  std::unique_ptr<Player> player_;
  std::unique_ptr<Renderer> renderer_;
  FramePlan plan_;
  Camera camera_;
  Subject subject_;
  std::set<ShapeKey> glass_;
  ReadingRange range_;
  BodyId followed_;
  std::string problem_;  // why the simulation ends before the plan does
};

bool Rendering::find_follow() {
  if (options_.follow.empty()) return true;
  followed_ = player_->find(options_.follow);
  if (followed_) return true;
  const bool nameless = player_->is_recording() && options_.look.empty();
  say("--follow: there is no body \"" + options_.follow + "\"" +
      (nameless ? " (the names of a recording come from its scene: --scene)" : ""));
  return false;
}

// A movie's frames are all kept until it is written.
bool Rendering::fits_in_memory() const {
  const std::uint64_t frame_bytes = std::uint64_t(width_) * std::uint64_t(height_) * 3;
  const std::uint64_t most =
      options_.out.kind == OutputKind::movie ? kMaxMovieBytes / frame_bytes : kMaxPictures;
  if (plan_.count <= most) return true;
  say("found " + std::to_string(plan_.count) + " frames, expected at most " + std::to_string(most) +
      (options_.out.kind == OutputKind::movie
           ? " in a GIF of this size; numbered pictures (--out frames/%04d.png) can be more"
           : std::string()));
  return false;
}

// The first look at everything.
bool Rendering::prepare() {
  if (plan_.count != kUntilTheEnd && !fits_in_memory()) return false;
  // Everything is simulated once before the first frame is drawn, which may take long.
  const double end = plan_.count == kUntilTheEnd ? 0 : plan_.start + double(plan_.count - 1) * plan_.interval;
  Progress progress(!options_.quiet && end > 0, 1000, "thousandths, before the drawing");
  struct Watch {
    Progress& progress;
    const Player& player;
    double end;  // s; 0: not known
  } watch{progress, *player_, end};
  player_->watch(
      [](void* user) {
        const Watch& w = *static_cast<Watch*>(user);
        if (w.end > 0) w.progress.show(std::uint64_t(1000 * min(w.player.time() / w.end, 1.0)));
        return !interrupted();
      },
      &watch);
  const Survey survey(*player_, plan_);
  player_->watch(nullptr, nullptr);
  progress.clear();
  if (interrupted()) return false;
  problem_ = player_->problem();
  if (!fits_in_memory()) return false;  // how long a recording is, is only known now
  camera_ = survey.camera(wish_of(options_), width_, height_);
  if (!(length(camera_.eye - camera_.target) > 1e-6) || !is_finite(camera_.eye) ||
      !is_finite(camera_.target)) {
    say("the camera must stand somewhere else than where it looks at");
    return false;
  }
  subject_ = survey.subject(camera_);
  glass_ = survey.hiding(camera_);
  range_ = options_.range.empty() ? survey.readings() : ReadingRange{options_.range[0], options_.range[1]};
  return true;
}

int Rendering::draw_frames() {
  DrawListMaker maker;
  Sight sight;
  maker.set_glass(glass_);
  maker.set_range(range_);
  Progress progress(!options_.quiet, plan_.count, "frames");
  Camera camera = camera_;
  Subject subject = subject_;
  std::optional<DVec3> follow_start;
  for (std::uint64_t frame = 0; frame < plan_.count; ++frame) {
    player_->advance_to(plan_.start + double(frame) * plan_.interval);
    player_->look(sight);
    if (followed_) {
      const DVec3 place = place_of(sight, followed_, follow_start.value_or(camera_.target));
      if (!follow_start) follow_start = place;
      camera.eye = camera_.eye + (place - *follow_start);
      camera.target = camera_.target + (place - *follow_start);
      subject.origin = camera.target;
    }
    Picture picture = renderer_->draw(maker.make(sight, camera, subject), camera, subject);
    if (options_.reading != SoftReading::none) draw_key(range_, options_.reading, picture);
    if (!output_.add(std::move(picture))) {
      progress.clear();
      return stop(output_.message());
    }
    progress.show(frame + 1);
    if (interrupted()) {
      progress.clear();
      if (!output_.finish()) return stop(output_.message());
      say("interrupted after frame " + std::to_string(frame + 1) + "; what was drawn up to there is kept");
      return kExitInterrupted;
    }
  }
  progress.clear();
  if (!output_.finish()) return stop(output_.message());
  if (problem_.empty()) return kExitGood;
  say("the simulation is no longer finite after " + std::to_string(output_.frames()) +
      " frames: " + problem_ + "; what was drawn up to there is kept");
  return kExitNotFinite;
}

int Rendering::run() {
  std::string error;
  player_ = open_player(options_.source, options_.look, options_.import, options_.threads, error);
  if (!player_) return stop(error);
  if (!player_->note().empty()) say(options_.source + ": " + player_->note());
  if (!options_.look.empty() && !player_->is_recording()) {
    say("--scene is for recordings; " + options_.source + " is a scene itself");
    return kExitUsage;
  }
  if (options_.reading != SoftReading::none && !player_->has_readings()) {
    say("--color-by: " + options_.source + " holds poses alone; record with all, or render the scene");
    return kExitUsage;
  }
  player_->read(options_.reading);
  if (!find_follow()) return kExitUsage;
  plan_ = plan_frames(options_, player_->is_recording());
  const bool usual_movie = options_.out.kind == OutputKind::movie || options_.out.kind == OutputKind::video;
  renderer_ = Renderer::create(width_, height_, options_.samples.value_or(usual_movie ? 16 : 48), error);
  if (!renderer_) return stop(error);
  const std::string noted = player_->note();
  if (!prepare()) {
    if (!interrupted()) return kExitUsage;
    say("interrupted before the first frame");
    return kExitInterrupted;
  }
  if (player_->note() != noted) say(options_.source + ": " + player_->note());
  if (!player_->rewind(error)) return stop(options_.source + ": " + error);
  if (!output_.open()) return stop(output_.message());
  const int ended = draw_frames();
  if (ended != kExitInvalid && !options_.quiet) {
    std::fprintf(
        options_.out.before == kStandardOutput ? stderr : stdout, "%s: %llu %s of %d x %d, %.1f kB\n",
        options_.out.at(0).c_str(), static_cast<unsigned long long>(output_.frames()),
        output_.frames() == 1 ? "frame" : "frames", width_, height_, double(output_.bytes()) / 1000.0);
  }
  return ended;
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  return std::filesystem::equivalent(a, b, error);
}

}  // namespace

int render(const RenderOptions& options) {
  if (same_file(options.source, options.out.at(0))) {
    say("--out would overwrite " + options.source);
    return kExitUsage;
  }
  watch_interrupt();
  return Rendering(options).run();
}

}  // namespace gyre
