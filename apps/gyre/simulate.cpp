// gyre simulate: runs a scene and writes down what was asked for. All inputs are read and all outputs opened before the first
// step, so that a mistake shows at once and leaves nothing behind. See simulate.h.
#include "simulate.h"

#include "exit_code.h"
#include "formats/vtk_writer.h"
#include "interrupt.h"
#include "progress.h"
#include "scene/scene_labels.h"
#include "scene/scene_writer.h"
#include "spelling.h"
#include "summary.h"

#include <gyre/replay.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

namespace gyre {
namespace {

void say(const std::string& message) { std::fprintf(stderr, "gyre: %s\n", message.c_str()); }

class FileSink : public ByteSink {
 public:
  explicit FileSink(OutputFile& file) : file_(file) {}
  bool write(std::span<const std::byte> bytes) override {
    return file_.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

 private:
  OutputFile& file_;
};

// Two outputs in one file, or one in the place of the scene, would destroy each other. Only the final scene may take the
// place of the scene that it goes on from.
std::string find_clash(const SimulateOptions& options) {
  const std::pair<const char*, const std::string*> outputs[] = {
      {"--record", &options.record},     {"--trace", &options.trace},   {"--joints", &options.joints},
      {"--contacts", &options.contacts}, {"--probes", &options.probes}, {"--events", &options.events},
      {"--stats", &options.stats},       {"--final", &options.final}};
  const auto place = [](const std::string& path) {
    std::error_code error;
    const std::filesystem::path resolved = std::filesystem::weakly_canonical(path, error);
    return error ? path : resolved.string();
  };
  const auto is_device = [](const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  };
  for (const auto& [option, path] : outputs) {
    if (path->empty() || is_device(*path)) continue;
    if (path != &options.final && *path != kStandardOutput && place(*path) == place(options.scene)) {
      return std::string(option) + " would overwrite the scene";
    }
    for (const auto& [other_option, other] : outputs) {
      if (other == path) break;
      if (!other->empty() && place(*other) == place(*path)) {
        return std::string(option) + " and " + other_option + " name the same file";
      }
    }
  }
  return {};
}

bool writes_to_standard_output(const SimulateOptions& options) {
  for (const std::string* path : {&options.record, &options.trace, &options.joints, &options.contacts,
                                  &options.probes, &options.events, &options.stats, &options.final}) {
    if (*path == kStandardOutput) return true;
  }
  return false;
}

// One run: the scene, its outputs, and how it ended.
class Simulation {
 public:
  Simulation(const SimulateOptions& options, SceneRunner runner)
      : options_(options), runner_(std::move(runner)) {}

  // The first name in the options that the scene does not have, as a message; empty if all are known.
  std::string find_unknown_body() const;
  bool open_outputs();
  int run();

 private:
  int run_steps(std::uint64_t steps);
  bool record_step(double step_ms);
  bool write_vtk(const VtkFile& file) const;
  bool finish_outputs(int ended);
  void print_result() const;
  int fail(const OutputFile& file) {
    say(file.message());
    return kExitInvalid;
  }

  const SimulateOptions& options_;
  SceneRunner runner_;
  TraceTable trace_;
  JointForceTable joints_;
  ContactPointTable contacts_;
  ProbeTable probes_;
  EventTable events_;
  StatsTable stats_;
  OutputFile record_, final_;
  FileSink sink_{record_};
  std::unique_ptr<Recorder> recorder_;
  VtkSeries vtk_;
  StageSums stages_;
  RunFigures figures_;
};

std::string Simulation::find_unknown_body() const {
  const Scene& scene = runner_.scene();
  std::vector<std::string> bodies, all;
  for (const SceneBody& body : scene.bodies) bodies.push_back(body.name);
  all = bodies;
  for (const auto& soft : scene.ropes) all.push_back(soft.name);
  for (const auto& soft : scene.cloths) all.push_back(soft.name);
  for (const auto& soft : scene.soft_bodies) all.push_back(soft.name);
  for (const auto& fluid : scene.liquids) all.push_back(fluid.name);
  const auto find = [](const char* option, const std::vector<std::string>& wanted,
                       const std::vector<std::string>& known) -> std::string {
    for (const std::string& name : wanted) {
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const std::string guess = nearest_word(name, known);
      return std::string(option) + ": the scene has no body \"" + name + "\"" +
             (guess.empty() ? "" : "; did you mean \"" + guess + "\"?");
    }
    return {};
  };
  const std::string problem = find("--explain", options_.explain, bodies);
  return problem.empty() ? find("--trace-only", options_.trace_only, all) : problem;
}

bool Simulation::open_outputs() {
  const auto check = [](bool opened, const OutputFile& file) {
    if (!opened) say(file.message());
    return opened;
  };
  if (!options_.trace.empty() &&
      !check(trace_.open(options_.trace, options_.trace_only, options_.trace_liquids), trace_.file())) {
    return false;
  }
  if (!options_.joints.empty() && !check(joints_.open(options_.joints), joints_.file())) return false;
  if (!options_.contacts.empty() && !check(contacts_.open(options_.contacts), contacts_.file())) return false;
  if (!options_.probes.empty() && !check(probes_.open(options_.probes), probes_.file())) return false;
  if (!options_.events.empty() && !check(events_.open(options_.events), events_.file())) return false;
  if (!options_.stats.empty() && !check(stats_.open(options_.stats), stats_.file())) return false;
  if (!options_.final.empty() && !check(final_.open(options_.final), final_)) return false;
  if (!options_.vtk.empty()) {
    std::error_code error;
    std::filesystem::create_directories(options_.vtk, error);
    if (error) {
      say(options_.vtk + ": cannot be made (" + error.message() + ")");
      return false;
    }
  }
  if (!options_.record.empty()) {
    if (!check(record_.open(options_.record), record_)) return false;
    RecordOptions what;
    what.commands = options_.record_as != "poses";
    what.poses = options_.record_as != "commands";
    what.frame_interval = options_.record_every;
    what.pose_accuracy = options_.record_accuracy;
    what.hash_interval = options_.record_hash_every;
    recorder_ = std::make_unique<Recorder>(runner_.world(), sink_, what);
    label_bodies(*recorder_, runner_);
  }
  return true;
}

bool Simulation::write_vtk(const VtkFile& file) const {
  OutputFile out;
  const bool written = out.open((std::filesystem::path(options_.vtk) / file.name).string()) &&
                       out.write(file.bytes) && out.commit();
  if (!written) say(out.message());
  return written;
}

bool Simulation::record_step(double step_ms) {
  const bool is_traced = runner_.steps() % options_.trace_every == 0;
  const auto add_rows = [&](auto& table) {
    if (!is_traced || !table.file().is_open() || table.add_rows(runner_)) return true;
    return fail(table.file()) == kExitGood;
  };
  if (!add_rows(trace_) || !add_rows(joints_) || !add_rows(contacts_) || !add_rows(probes_)) return false;
  if (events_.file().is_open() && !events_.add_rows(runner_)) return fail(events_.file()) == kExitGood;
  if (!options_.vtk.empty() && runner_.steps() % options_.vtk_every == 0) {
    for (const VtkFile& file : vtk_.add_state(runner_)) {
      if (!write_vtk(file)) return false;
    }
  }
  if (stats_.file().is_open() && runner_.steps() > 0 &&
      !stats_.add_row(runner_, step_ms, options_.count_crossings)) {
    return fail(stats_.file()) == kExitGood;
  }
  if (recorder_ && recorder_->failed()) {
    say(record_.message().empty() ? options_.record + ": cannot be written" : record_.message());
    return false;
  }
  return true;
}

int Simulation::run_steps(std::uint64_t steps) {
  using Clock = std::chrono::steady_clock;
  Progress progress(!options_.quiet, steps);
  set_timing(runner_.world(), options_.times);
  if (!record_step(0)) return kExitInvalid;
  bool warned = false;
  for (std::uint64_t i = 0; i < steps; ++i) {
    const Clock::time_point begin = Clock::now();
    const bool finite = runner_.step();
    const double step_ms = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    figures_.step_ms.push_back(float(step_ms));
    if (options_.times) stages_.add(runner_.world());
    if (!warned && !runner_.warning().empty()) {
      warned = true;
      progress.clear();
      say("warning: " + runner_.warning());
    }
    if (!finite) {
      progress.clear();
      say("the simulation is no longer finite in step " + std::to_string(i + 1) + ": " + runner_.problem() +
          "; what was recorded up to there is kept");
      return kExitNotFinite;
    }
    if (!record_step(step_ms)) return kExitInvalid;
    progress.show(i + 1);
    if (interrupted()) {
      progress.clear();
      say("interrupted after step " + std::to_string(i + 1) + "; what was recorded up to there is kept");
      return kExitInterrupted;
    }
  }
  return kExitGood;
}

bool Simulation::finish_outputs(int ended) {
  if (recorder_) {
    const bool whole = recorder_->finish();
    recorder_.reset();
    if (!whole || !record_.commit()) {
      say(record_.message().empty() ? options_.record + ": cannot be written" : record_.message());
      return false;
    }
  }
  for (OutputFile* file : {&trace_.file(), &joints_.file(), &contacts_.file(), &probes_.file(),
                           &events_.file(), &stats_.file()}) {
    if (file->is_open() && !file->commit()) return fail(*file) == kExitGood;
  }
  if (!options_.vtk.empty() && !write_vtk(vtk_.collection("run"))) return false;
  // A state that is not finite is not a scene.
  if (final_.is_open() && ended != kExitNotFinite) {
    if (!final_.write(write_scene(runner_.final_scene())) || !final_.commit())
      return fail(final_) == kExitGood;
  }
  return true;
}

void Simulation::print_result() const {
  std::string out;
  if (options_.json) {
    out = summary_json(runner_, figures_);
  } else {
    if (!options_.quiet) out = summary_text(runner_, figures_);
    out += times_text(figures_) + explanations_text(figures_);
    if (options_.hash) out += hash_text(runner_.world()) + "\n";
  }
  // A table on standard output is for the next program alone.
  std::fwrite(out.data(), 1, out.size(), writes_to_standard_output(options_) ? stderr : stdout);
}

int Simulation::run() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const int ended = run_steps(step_count(options_, runner_.scene().world.time_step));
  figures_.wall_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  if (ended == kExitInvalid) return ended;
  figures_.stages = stages_.means();
  figures_.stages_step_ms = stages_.step_ms();
  for (const std::string& name : options_.explain)
    figures_.explanations.emplace_back(name, explain_body(runner_, find_body(runner_, name)));
  if (!finish_outputs(ended)) return kExitInvalid;
  print_result();
  return ended;
}

// With hulls for concave meshes, which take seconds when they are new.
SceneResult<Scene> load_decomposed(const SimulateOptions& options) {
  constexpr std::uint64_t ticks = 1000;
  Progress progress(!options.quiet, ticks, "permille of a mesh");
  SplitOptions split;
  split.threads = options.threads;
  split.progress = [](void* user, float done) {
    static_cast<Progress*>(user)->show(std::uint64_t(done * float(ticks)));
    return !interrupted();
  };
  split.user = &progress;
  return open_split_scene(options.scene, options.import, split);
}

}  // namespace

int simulate(const SimulateOptions& options) {
  const std::string clash = find_clash(options);
  if (!clash.empty()) {
    say(clash);
    return kExitUsage;
  }
  watch_interrupt();
  SceneResult<Scene> scene = load_decomposed(options);
  if (!scene && interrupted()) return kExitInterrupted;
  if (!scene) {
    say(scene.error().text());
    return kExitInvalid;
  }
  if (!options.quiet) {
    for (const std::string& note : scene->notes) say(note);
  }
  const std::string refusal = apply_overrides(options, scene->world);
  if (!refusal.empty()) {
    say(refusal);
    return kExitUsage;
  }
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), options.scene, options.threads);
  if (!runner) {
    say(runner.error().text());
    return kExitInvalid;
  }
  Simulation simulation(options, *std::move(runner));
  const std::string unknown = simulation.find_unknown_body();
  if (!unknown.empty()) {
    say(unknown);
    return kExitUsage;
  }
  if (!simulation.open_outputs()) return kExitInvalid;
  return simulation.run();
}

}  // namespace gyre
