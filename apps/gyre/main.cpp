// gyre: the command line. Results go to stdout, messages to stderr, one line each; the exit status is one of exit_code.h.
#include "commands.h"
#include "exit_code.h"
#include "spelling.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

namespace gyre {
namespace {

// The words that could have been meant: names of options, or of commands where none was chosen.
std::vector<std::string> known_words(const CLI::App& app, bool options) {
  std::vector<std::string> words;
  if (options) {
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
    }
  } else {
    for (const CLI::App* command : app.get_subcommands({})) words.push_back(command->get_name());
  }
  return words;
}

// Arguments that nothing takes, in their order, with a guess at the first. Empty if there are none.
std::string describe_unknown(const CLI::App& app, const CLI::App& chosen) {
  std::vector<std::string> unknown = chosen.remaining();
  if (unknown.empty()) unknown = app.remaining();
  if (unknown.empty()) return {};
  const bool is_option = unknown[0].rfind("-", 0) == 0;
  const bool is_command = !is_option && &chosen == &app;
  const std::string word = unknown[0].substr(0, unknown[0].find('='));
  std::string message = is_option    ? "unknown option "
                        : is_command ? "unknown command "
                                     : "unexpected argument ";
  message += word;
  const std::string guess =
      is_option || is_command ? nearest_word(word, known_words(chosen, is_option)) : std::string();
  if (!guess.empty()) message += "; did you mean " + guess + "?";
  return message;
}

// The error of the arguments, in one line, and where to look.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
  std::string command = "gyre";
  const CLI::App* chosen = &app;
  for (const CLI::App* named : app.get_subcommands()) {
    command += " " + named->get_name();
    chosen = named;
  }
  std::string message = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::string unknown = describe_unknown(app, *chosen);
    if (!unknown.empty()) message = unknown;
  }
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "%s: %s (%s --help shows what there is)\n", command.c_str(), message.c_str(),
               command.c_str());
  return kExitUsage;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Gyre simulates scenes of bodies, ropes, cloth, solids, gases and liquids: reads a scene, steps it, "
      "writes down what happened.",
      "gyre");
  app.set_version_flag("--version", "gyre " GYRE_VERSION_STRING, "Print the version and exit");
  app.require_subcommand(0, 1);
  int exit_code = kExitGood;
  add_simulate(app, exit_code);
  add_info(app, exit_code);
  add_convert(app, exit_code);
  add_decompose(app, exit_code);
  add_replay(app, exit_code);
  add_render(app, exit_code);
  add_plot(app, exit_code);
  add_view(app, exit_code);
  add_bench(app, exit_code);
  add_validate(app, exit_code);
  add_sweep(app, exit_code);
  add_schema(app, exit_code);
  add_completion(app, exit_code);
  add_manual(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);  // --help and --version, on stdout
  } catch (const CLI::ParseError& error) {
    return report_usage(app, error);
  }
  if (app.get_subcommands().empty()) {
    std::fputs(app.help().c_str(), stderr);
    return kExitUsage;
  }
  return exit_code;
}

}  // namespace
}  // namespace gyre

int main(int argc, char** argv) {
  int exit_code = gyre::kExitInvalid;
  try {
    exit_code = gyre::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gyre: %s\n", error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) {
    std::fprintf(stderr, "gyre: the standard output cannot be written\n");
    if (exit_code == gyre::kExitGood) exit_code = gyre::kExitInvalid;
  }
  return exit_code;
}
