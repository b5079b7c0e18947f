// What gyre validate prints: laws of physics, each measured in small worlds and compared with what is exact. The laws
// themselves, and run_validation(), are in tests/laws.
#pragma once

#include "gyre/progress.h"
#include "gyre/validate_options.h"

#include <string>
#include <vector>

namespace gyre {

struct ValidationRow {
  std::string law;  // suite and test
  std::string
      name;  // the row's, beginning with its number in the table where it has one; empty: the law has no figures
  std::string integrator, solver;
  double measured = 0.0, expected = 0.0;
  double tolerance = 0.0;  // greatest error, or greatest value of a limit
  double goal = 0.0;       // likewise, of the best that is hoped for
  bool is_limit = false;   // measured is to be at most the tolerance; nothing is expected
  bool met = false, met_goal = false;

  double error() const;
  // Of the tolerance; above 1 it is missed.
  double share() const;
};

struct ValidationLaw {
  std::string law, integrator, solver;
  bool default_parts = false;  // what the engine promises; with other parts it is a comparison
  double seconds = 0.0;
  std::string failure;  // empty: it holds
};

struct Validation {
  std::vector<ValidationRow> rows;
  std::vector<ValidationLaw> laws;
};

// `progress` counts thousandths of what is to be done.
Validation run_validation(const ValidateOptions& options, Progress& progress);

}  // namespace gyre
