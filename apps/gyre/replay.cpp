// gyre replay: plays a recording again and compares every hash with the recorded one. In: a recording with commands. Out: the number of
// steps that agree; or the first step that differs, with stage, column and row where hidden state shows them.
#include "commands.h"
#include "complain.h"
#include "exit_code.h"
#include "interrupt.h"
#include "option_checks.h"
#include "progress.h"
#include "recording_file.h"
#include "scene/json_writer.h"
#include "summary.h"

#include <gyre/replay.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <limits>
#include <memory>
#include <string>

namespace gyre {
namespace {

struct ReplayOptions {
  std::string file;
  int threads = 1, simd_width = 0;
  bool hash = false, json = false, quiet = false, keep_going = false;
};

struct Played {
  std::uint64_t steps = 0;      // played
  std::uint64_t different = 0;  // steps whose hash is not the recorded one
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max();  // of these, counted from 1
  double time = 0;                                                  // s, of the first
};

bool play(Replay& replay, const ReplayOptions& options, Played& played) {
  Progress progress(!options.quiet, replay.step_count(), "steps");
  bool matches = true;
  while (replay.step(&matches)) {
    ++played.steps;
    if (!matches && played.different++ == 0) {
      played.first = played.steps;
      played.time = replay.world().time();
      if (!options.keep_going) break;
    }
    progress.show(played.steps);
    if (interrupted()) break;
  }
  progress.clear();
  return !interrupted();
}

// " in the column "motions", row 3, after the stage solve"; empty where the two worlds agree.
std::string describe(const Result<Difference>& found) {
  if (!found || found->column[0] == 0) return {};
  return " State first differs in step " + std::to_string(found->step + 1) + ", column " +
         std::string(found->column) + ", row " + std::to_string(found->row) + ", after stage " +
         std::string(found->stage) + ".";
}

std::string text_of(const Played& played, const Replay& replay, const std::string& where) {
  if (played.different == 0) {
    return std::to_string(played.steps) + (played.steps == 1 ? " step" : " steps") +
           " replayed; every hash agrees.\n" +
           (replay.truncated() ? "The recording has no end; it was played up to its last whole step.\n" : "");
  }
  char time[32];
  std::snprintf(time, sizeof time, "%.6g", played.time);
  return "Step " + std::to_string(played.first) + " of " + std::to_string(replay.step_count()) + " (" + time +
         " s) is not as it was recorded." + where + "\n";
}

std::string json_of(const Played& played, Replay& replay, const Result<Difference>* found) {
  JsonWriter json;
  json.begin_object();
  json.field("steps", std::int64_t(played.steps));
  json.field("recorded_steps", std::int64_t(replay.step_count()));
  json.field("truncated", replay.truncated());
  json.field("different_steps", std::int64_t(played.different));
  json.key("first_difference");
  if (found == nullptr) {
    json.null();
  } else {
    json.begin_object(JsonLayout::one_line);
    json.field("step", std::int64_t(played.first));
    json.field("time", played.time);
    if (*found && (*found)->column[0] != 0) {
      json.field("state_step", std::int64_t((*found)->step + 1));
      json.field("stage", std::string((*found)->stage));
      json.field("column", std::string((*found)->column));
      json.field("row", std::int64_t((*found)->row));
    }
    json.end_object();
  }
  json.field("hash", hash_text(replay.world()));
  json.end_object();
  return json.take();
}

int run_replay(const ReplayOptions& options) {
  std::vector<std::byte> bytes;
  const std::string problem = read_recording(options.file, bytes);
  if (!problem.empty()) return complain(options.file + ": " + problem);
  WorldDef def;
  def.threads = options.threads;
  def.simd_width = options.simd_width;
  Result<Replay> replay = Replay::open(bytes, def);
  if (!replay) return complain(options.file + ": " + replay.error().message);
  watch_interrupt();
  Played played;
  if (!play(*replay, options, played))
    return complain("interrupted after step " + std::to_string(played.steps), kExitInterrupted);
  std::unique_ptr<Result<Difference>> found;
  if (played.different > 0) found = std::make_unique<Result<Difference>>(first_difference(bytes, def));
  std::string out;
  if (options.json) {
    out = json_of(played, *replay, found.get());
  } else {
    if (!options.quiet || found) out = text_of(played, *replay, found ? describe(*found) : std::string());
    if (options.hash) out += hash_text(replay->world()) + "\n";
  }
  std::fwrite(out.data(), 1, out.size(), stdout);
  return played.different == 0 ? kExitGood : kExitFailed;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "replay",
      "Play a recording again and compare its hashes; status 1 and the first difference if one differs");
  const auto options = std::make_shared<ReplayOptions>();
  command
      ->add_option("RECORDING", options->file, "The recording (*.gyrec) with commands, - for standard input")
      ->required()
      ->type_name("");
  add_threads_option(*command, options->threads, "Worker threads, 0 for all; never changes a result");
  take_one_of(command
                  ->add_option("--simd-width", options->simd_width,
                               "Lanes of the kernels: 1, 4, 8 or 16; 0, the best of the machine, if not "
                               "given; never changes a result")
                  ->type_name("N"),
              {"0", "1", "4", "8", "16"});
  command->add_flag("--keep-going", options->keep_going, "Play to the end although a step differs");
  command->add_flag("--hash", options->hash, "Print a hash of the last state");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->add_flag("--quiet", options->quiet, "Print only a difference and show no progress");
  command->callback([options, &exit_code] { exit_code = run_replay(*options); });
}

}  // namespace gyre
