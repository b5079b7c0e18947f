// gyre sweep: its options. See sweep.h.
#include "commands.h"
#include "sweep/sweep.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace gyre {

void add_sweep_options(CLI::App& command, SweepOptions& options) {
  command.add_option("STUDY", options.study, "The study file (*.json): a scene, parameters, readings")
      ->required()
      ->type_name("");
  command
      .add_option(
          "--output", options.output,
          "The file of results, a line of JSON a case; NAME.results.jsonl beside the study if not given")
      ->type_name("FILE.jsonl");
  CLI::Option* only =
      command.add_option("--case", options.only, "Run only this case, from 0, and print its line")
          ->type_name("K");
  command.add_flag("--count", options.count, "Print the number of cases")->excludes(only);
  command.add_flag("--quiet", options.quiet, "Print no summary and show no progress");
}

void add_sweep(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("sweep", "Run the cases of a study: a scene under many parameters");
  const auto options = std::make_shared<SweepOptions>();
  add_sweep_options(*command, *options);
  command
      ->add_option("--threads", options->threads,
                   "Cases that run at once, 0 for as many as the machine has cores; never changes a result")
      ->type_name("N")
      ->check(CLI::Range(0, 1024));
  command->callback([options, &exit_code] {
    ThreadedCases runner(options->threads);
    exit_code = sweep(*options, runner);
  });
}

}  // namespace gyre
