// gyre validate: measured against exact.
#include "commands.h"
#include "exit_code.h"
#include "validate_integrators.h"
#include "validate_options.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

#include <unistd.h>

namespace gyre {

namespace {

namespace fs = std::filesystem;

// Becomes the program that holds the laws, which lies beside this one.
int run_laws(const ValidateOptions& options) {
  std::error_code error;
  const fs::path laws = fs::read_symlink("/proc/self/exe", error).parent_path() / "gyre-laws";
  if (!fs::exists(laws, error)) {
    std::fprintf(stderr,
                 "%s is not there: it is built with the tests (GYRE_BUILD_TESTS=ON, target gyre_laws)\n",
                 laws.c_str());
    return kExitUsage;
  }
  std::vector<std::string> arguments = to_arguments(options);
  arguments.insert(arguments.begin(), laws.string());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::fflush(nullptr);
  execv(laws.c_str(), argv.data());
  std::fprintf(stderr, "%s cannot be run\n", laws.c_str());
  return kExitInvalid;
}

struct Options {
  bool integrators = false;
  bool csv = false;
  ValidateOptions laws;
};

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("validate", "Measure laws of physics against what is exact");
  const auto options = std::make_shared<Options>();
  add_validate_options(*command, options->laws);
  CLI::Option* integrators =
      command->add_flag("--integrators", options->integrators,
                        "Instead: error of each integrator against the size of its step");
  command->add_flag("--csv", options->csv, "With --integrators: rows of CSV instead of a table")
      ->needs(integrators);
  command->callback([options, &exit_code] {
    if (!options->integrators) {
      exit_code = run_laws(options->laws);
    } else {
      exit_code = validate_integrators(options->csv) ? kExitGood : kExitFailed;
    }
  });
}

}  // namespace gyre
