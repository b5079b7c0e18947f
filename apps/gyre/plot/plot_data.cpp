// The figures behind a plot. See plot_data.h.
#include "plot/plot_data.h"

#include "complain.h"
#include "exit_code.h"
#include "interrupt.h"
#include "progress.h"
#include "recording_file.h"
#include "scene/scene_runner.h"
#include "spelling.h"

#include <gyre/replay.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace gyre {
namespace {

constexpr std::uint64_t kMostPoints = 4000;  // of a series; of longer runs every nth step is drawn

// A scene or a recording as a world that goes on step by step, with names.
struct Source {
  std::optional<SceneRunner> runner;
  std::optional<Replay> replay;
  std::optional<PoseTrack> track;  // of a recording: its names
  std::string title;
  std::uint64_t steps = 0;  // to be played

  World& world() { return runner ? runner->world() : replay->world(); }
  bool step() { return runner ? runner->step() : replay->step(); }
  double time() { return world().time(); }
  std::vector<std::string> names() {
    std::vector<std::string> out;
    for (const BodyId id : world().bodies().ids) out.push_back(name(id));
    return out;
  }
  std::string name(BodyId id) {
    if (runner) return runner->body_of(id) != nullptr ? runner->body_of(id)->name : std::string();
    return track ? std::string(track->label(id).name) : std::string();
  }
  BodyId find(const std::string& wanted) {
    for (const BodyId id : world().bodies().ids) {
      if (name(id) == wanted) return id;
    }
    return {};
  }
  BodyId first_dynamic() {
    for (const BodyId id : world().bodies().ids) {
      if (world().type(id) == BodyType::dynamic) return id;
    }
    return {};
  }
};

int open_recording_source(const PlotOptions& options, Source& source) {
  std::vector<std::byte> bytes;
  const std::string problem = read_recording(options.source, bytes);
  if (!problem.empty()) return complain(options.source + ": " + problem);
  Result<PoseTrack> track = PoseTrack::open(bytes);
  if (track) source.track.emplace(*std::move(track));
  WorldDef def;
  def.threads = options.threads;
  Result<Replay> replay = Replay::open(std::move(bytes), def);
  if (!replay) return complain(options.source + ": " + replay.error().message);
  source.replay.emplace(*std::move(replay));
  source.steps = source.replay->step_count();
  source.title = options.source;
  return kExitGood;
}

int open_source(const PlotOptions& options, Source& source) {
  if (is_recording(options.source)) return open_recording_source(options, source);
  SceneResult<Scene> scene = open_split_scene(options.source, options.import);
  if (!scene) return complain(scene.error().text());
  const double time_step = scene->world.time_step;
  source.title = scene->name.empty() ? options.source : scene->name;
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), options.source, options.threads);
  if (!runner) return complain(runner.error().text());
  source.runner.emplace(*std::move(runner));
  source.steps = std::uint64_t(std::ceil(options.duration.value_or(10.0) / time_step - 1e-6));
  return kExitGood;
}

// Reads the values of one moment into the series of the chart.
class Reader {
 public:
  virtual ~Reader() = default;
  virtual void begin(Chart& chart) = 0;
  virtual void read(Source& source, Chart& chart) = 0;
};

void add_point(ChartSeries& series, double x, double y) {
  series.x.push_back(x);
  series.y.push_back(y);
}

class EnergyReader : public Reader {
 public:
  void begin(Chart& chart) override {
    chart.x_label = "time (s)";
    chart.y_label = "energy (J)";
    for (const char* name : {"kinetic", "potential", "elastic", "total"})
      chart.series.push_back({name, {}, {}});
  }
  void read(Source& source, Chart& chart) override {
    const Energy e = source.world().energy();
    const double elastic = e.elastic + e.soft_elastic;
    const double values[] = {e.kinetic, e.potential, elastic, e.kinetic + e.potential + elastic};
    for (std::size_t i = 0; i < 4; ++i) add_point(chart.series[i], source.time(), values[i]);
  }
};

struct NamedBody {
  BodyId id;
  std::string name;
};

class MotionReader : public Reader {
 public:
  MotionReader(std::vector<NamedBody> bodies, bool velocity)
      : bodies_(std::move(bodies)), velocity_(velocity) {}
  void begin(Chart& chart) override {
    chart.x_label = "time (s)";
    chart.y_label = velocity_ ? "velocity (m/s)" : "position of the centre of mass (m)";
    for (const NamedBody& body : bodies_) {
      for (const char* axis : {" x", " y", " z"}) chart.series.push_back({body.name + axis, {}, {}});
    }
  }
  void read(Source& source, Chart& chart) override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!source.world().exists(bodies_[i].id)) continue;
      const DVec3 p = source.world().center_of_mass(bodies_[i].id);
      const Vec3 v = source.world().linear_velocity(bodies_[i].id);
      for (int axis = 0; axis < 3; ++axis)
        add_point(chart.series[3 * i + std::size_t(axis)], source.time(),
                  velocity_ ? double(v[axis]) : p[axis]);
    }
  }

 private:
  std::vector<NamedBody> bodies_;
  bool velocity_;
};

class PhaseReader : public Reader {
 public:
  PhaseReader(std::vector<NamedBody> bodies, const std::string& axis)
      : bodies_(std::move(bodies)), axis_(axis) {}
  void begin(Chart& chart) override {
    chart.x_label = axis_ + " (m)";
    chart.y_label = "velocity along " + axis_ + " (m/s)";
    for (const NamedBody& body : bodies_) chart.series.push_back({body.name, {}, {}});
  }
  void read(Source& source, Chart& chart) override {
    const int axis = axis_[0] - 'x';
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!source.world().exists(bodies_[i].id)) continue;
      add_point(chart.series[i], source.world().center_of_mass(bodies_[i].id)[axis],
                double(source.world().linear_velocity(bodies_[i].id)[axis]));
    }
  }

 private:
  std::vector<NamedBody> bodies_;
  std::string axis_;
};

class JointPhaseReader : public Reader {
 public:
  JointPhaseReader(JointId id, std::string name, JointKind kind)
      : id_(id), name_(std::move(name)), kind_(kind) {}
  void begin(Chart& chart) override {
    const bool linear =
        kind_ == JointKind::slider || kind_ == JointKind::distance || kind_ == JointKind::path;
    chart.x_label = linear ? "position (m)" : "position (rad)";
    chart.y_label = linear ? "velocity (m/s)" : "velocity (rad/s)";
    chart.series.push_back({name_, {}, {}});
  }
  void read(Source& source, Chart& chart) override {
    if (!source.world().exists(id_)) return;
    const JointState state = source.world().joint_state(id_);
    add_point(chart.series[0], double(state.position), double(state.velocity));
  }

 private:
  JointId id_;
  std::string name_;
  JointKind kind_;
};

// Names to bodies. False after a message if one is unknown.
bool find_bodies(const PlotOptions& options, Source& source, std::vector<NamedBody>& out) {
  if (options.bodies.empty()) {
    const BodyId first = source.first_dynamic();
    if (first) out.push_back({first, source.name(first).empty() ? "body" : source.name(first)});
    if (!first) complain("no body moves; --body names one", kExitUsage);
    return bool(first);
  }
  for (const std::string& name : options.bodies) {
    const BodyId id = source.find(name);
    if (!id) {
      const std::string guess = nearest_word(name, source.names());
      complain("--body: there is no body \"" + name + "\"" +
                   (guess.empty() ? "" : "; did you mean \"" + guess + "\"?"),
               kExitUsage);
      return false;
    }
    out.push_back({id, name});
  }
  return true;
}

std::unique_ptr<Reader> joint_reader(const PlotOptions& options, Source& source) {
  if (!source.runner) {
    complain("--joint: a recording has no names of joints; plot the scene", kExitUsage);
    return nullptr;
  }
  const auto& joints = source.runner->scene().joints;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    names.push_back(joints[i].name.empty() ? "joint " + std::to_string(i) : joints[i].name);
    if (names.back() == options.joint)
      return std::make_unique<JointPhaseReader>(source.runner->joints()[i], names.back(),
                                                kind_of(joints[i].def));
  }
  const std::string guess = nearest_word(options.joint, names);
  complain("--joint: there is no joint \"" + options.joint + "\"" +
               (guess.empty() ? "" : "; did you mean \"" + guess + "\"?"),
           kExitUsage);
  return nullptr;
}

std::unique_ptr<Reader> make_reader(const PlotOptions& options, Source& source) {
  if (options.what == "energy") return std::make_unique<EnergyReader>();
  if (options.what == "phase" && !options.joint.empty()) return joint_reader(options, source);
  std::vector<NamedBody> bodies;
  if (!find_bodies(options, source, bodies)) return nullptr;
  if (options.what == "phase") return std::make_unique<PhaseReader>(std::move(bodies), options.axis);
  return std::make_unique<MotionReader>(std::move(bodies), options.what == "velocity");
}

}  // namespace

int collect_plot(const PlotOptions& options, Chart& chart) {
  Source source;
  const int opened = open_source(options, source);
  if (opened != kExitGood) return opened;
  const std::unique_ptr<Reader> reader = make_reader(options, source);
  if (!reader) return kExitUsage;
  chart.title = source.title;
  chart.width = options.width;
  chart.height = options.height;
  reader->begin(chart);
  const std::uint64_t every = std::max<std::uint64_t>(1, source.steps / kMostPoints);
  const double end = source.time() + options.duration.value_or(HUGE_VAL);
  Progress progress(!options.quiet, source.steps, "steps");
  reader->read(source, chart);
  for (std::uint64_t i = 1; i <= source.steps && source.time() < end * (1 - 1e-9); ++i) {
    if (!source.step()) {
      progress.clear();
      if (source.runner)
        return complain("the simulation is no longer finite: " + source.runner->problem(), kExitNotFinite);
      break;
    }
    if (i % every == 0 || i == source.steps) reader->read(source, chart);
    progress.show(i);
    if (interrupted()) {
      progress.clear();
      return complain("interrupted after step " + std::to_string(i), kExitInterrupted);
    }
  }
  progress.clear();
  return kExitGood;
}

}  // namespace gyre
