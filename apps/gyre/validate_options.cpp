#include "validate_options.h"

#include <CLI/CLI.hpp>

namespace gyre {

void add_validate_options(CLI::App& app, ValidateOptions& options) {
  app.add_option("--filter", options.filter,
                 "Which laws: suites and tests with * and ?, several with :, after - those left out");
  app.add_flag("--slow", options.slow, "Also those that take minutes");
  app.add_flag("--default-parts", options.default_parts, "Only with the default integrator and solver");
  app.add_flag("--json", options.json, "Print one JSON object");
  app.add_option("--html", options.html, "Write a page with a bar for each row");
}

std::vector<std::string> to_arguments(const ValidateOptions& options) {
  std::vector<std::string> arguments = {"--filter=" + options.filter};
  if (options.slow) arguments.push_back("--slow");
  if (options.default_parts) arguments.push_back("--default-parts");
  if (options.json) arguments.push_back("--json");
  if (!options.html.empty()) arguments.push_back("--html=" + options.html);
  return arguments;
}

}  // namespace gyre
