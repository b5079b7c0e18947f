#include "validate_integrators.h"

#include "integrator_trials.h"

#include <cstdio>

namespace gyre {

namespace {

constexpr double kWithin = 0.1;

bool print_row(const trials::Trial& trial, IntegratorKind kind) {
  const std::vector<double> errors = trials::errors_of(trial, kind);
  std::printf("%-8s %-20s", trial.name, to_string(kind));
  for (int k = 0; k < trials::kCuts; ++k) {
    const int parts = trial.first_parts[int(kind)] << k;
    std::printf("  %9.3e: %9.3e", trial.seconds / parts, errors[std::size_t(k)]);
  }
  if (trials::is_exact(kind, trial)) {
    const bool good = errors.back() <= trials::kExact;
    std::printf("  exact       %s\n", good ? "met" : "FAIL");
    return good;
  }
  const double measured = trials::order(errors[errors.size() - 2], errors.back()),
               expected = trials::expected_order(kind);
  const bool good = std::fabs(measured - expected) <= kWithin;
  std::printf("  order %5.3f %s\n", measured, good ? "met" : "FAIL");
  return good;
}

void print_csv(const trials::Trial& trial, IntegratorKind kind) {
  const std::vector<double> errors = trials::errors_of(trial, kind);
  for (int k = 0; k < trials::kCuts; ++k) {
    const int parts = trial.first_parts[int(kind)] << k;
    std::printf("%s,%s,%d,%.9g,%.9g\n", trial.name, to_string(kind), parts, trial.seconds / parts,
                errors[std::size_t(k)]);
  }
}

}  // namespace

bool validate_integrators(bool csv) {
  if (csv) std::printf("motion,integrator,parts,step,error\n");
  bool good = true;
  for (const trials::Trial& trial : trials::kTrials) {
    if (!csv)
      std::printf("# %s: step in s: error in %s after %g s\n", trial.title, trial.unit, trial.seconds);
    for (int kind = 0; kind < kIntegratorKindCount; ++kind) {
      if (csv)
        print_csv(trial, IntegratorKind(kind));
      else
        good = print_row(trial, IntegratorKind(kind)) && good;
    }
  }
  return good;
}

}  // namespace gyre
