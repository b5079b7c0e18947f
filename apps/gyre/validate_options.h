// The options of gyre validate, for the program that takes them and for the one that holds the laws (apps/laws).
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gyre {

struct ValidateOptions {
  std::string filter = "*";    // of suites and tests, as GoogleTest reads it
  bool slow = false;           // also laws that take minutes
  bool default_parts = false;  // only with the default integrator and solver
  bool json = false;
  std::string html;  // path of a page to write; empty: none
};

void add_validate_options(CLI::App& app, ValidateOptions& options);
std::vector<std::string> to_arguments(const ValidateOptions& options);

}  // namespace gyre
