// gyre: the command line. Results go to stdout, messages to stderr, one line each; the exit status is one of exit_code.h.
#include "commands.h"
#include "exit_code.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>

namespace {

// What is wrong with the arguments, in one line, and where to look.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  std::string command = "gyre";
  for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
  std::string message = error.what();
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "%s: %s (%s --help shows what there is)\n", command.c_str(), message.c_str(),
               command.c_str());
  return gyre::kExitUsage;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Gyre simulates scenes of bodies: reads a scene, moves it on in time, writes down what happened.",
      "gyre");
  app.set_version_flag("--version", "gyre " GYRE_VERSION_STRING, "Print the version and exit");
  app.require_subcommand(0, 1);
  int exit_code = gyre::kExitGood;
  gyre::add_simulate(app, exit_code);
  gyre::add_info(app, exit_code);
  gyre::add_convert(app, exit_code);
  gyre::add_decompose(app, exit_code);
  gyre::add_render(app, exit_code);
  gyre::add_view(app, exit_code);
  gyre::add_bench(app, exit_code);
  gyre::add_validate(app, exit_code);
  gyre::add_sweep(app, exit_code);
  gyre::add_schema(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);  // --help and --version, on stdout
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
  if (app.get_subcommands().empty()) {
    std::fputs(app.help().c_str(), stderr);
    return gyre::kExitUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  int exit_code = gyre::kExitInvalid;
  try {
    exit_code = run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gyre: %s\n", error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fprintf(stderr, "gyre: the standard output cannot be written\n");
    if (exit_code == gyre::kExitGood) exit_code = gyre::kExitInvalid;
  }
  return exit_code;
}
