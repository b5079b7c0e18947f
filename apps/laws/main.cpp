// gyre-laws: the program behind gyre validate. It is apart from gyre because it holds the tests of laws, which take as long to
// build as all the rest.
#include "gyre/exit_code.h"
#include "gyre/validate_options.h"
#include "validate_table.h"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app("Measure laws of physics and compare them with what is exact", "gyre validate");
  gyre::ValidateOptions options;
  gyre::add_validate_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? gyre::kExitGood : gyre::kExitUsage;
  }
  return gyre::validate_table(options);
}
