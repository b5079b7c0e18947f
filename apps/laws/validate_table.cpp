#include "validate_table.h"

#include "gyre/exit_code.h"
#include "gyre/output_file.h"
#include "gyre/progress.h"
#include "scene/json_writer.h"

#include <cmath>
#include <cstdio>

namespace gyre {

double ValidationRow::error() const { return is_limit ? measured : std::fabs(measured - expected); }
double ValidationRow::share() const {
  if (tolerance > 0.0) return error() / tolerance;
  return met ? 0.0 : HUGE_VAL;
}

namespace {

struct Totals {
  int rows = 0, missed = 0, goals = 0, laws = 0;
  int failed = 0;        // with the default parts
  int failed_other = 0;  // with others
};
Totals add_up(const Validation& v) {
  Totals t{int(v.rows.size()), 0, 0, int(v.laws.size()), 0, 0};
  for (const ValidationRow& row : v.rows) t.missed += !row.met, t.goals += row.met_goal;
  for (const ValidationLaw& law : v.laws)
    (law.default_parts ? t.failed : t.failed_other) += !law.failure.empty();
  return t;
}

void print_row(const ValidationRow& row) {
  const std::string parts = row.integrator + ", " + row.solver;
  if (row.is_limit) {
    std::printf("%-64.64s %12.5g %12s %10s %10.3g  %-6s %s\n", row.name.c_str(), row.measured, "at most", "",
                row.tolerance, row.met ? "met" : "MISSED", parts.c_str());
  } else {
    std::printf("%-64.64s %12.5g %12.5g %10.2e %10.2e  %-6s %s\n", row.name.c_str(), row.measured,
                row.expected, row.error(), row.tolerance, row.met ? "met" : "MISSED", parts.c_str());
  }
}

void print_text(const Validation& v) {
  std::printf("%-64s %12s %12s %10s %10s  %-6s %s\n", "row", "measured", "exact", "error", "tolerance", "",
              "integrator, solver");
  for (const ValidationRow& row : v.rows) print_row(row);
  for (const ValidationLaw& law : v.laws) {
    if (law.failure.empty()) continue;
    std::printf("%s does not hold with %s, %s%s\n", law.law.c_str(), law.integrator.c_str(),
                law.solver.c_str(), law.default_parts ? ":" : "");
    if (law.default_parts) std::printf("%s\n", law.failure.c_str());
  }
  const Totals t = add_up(v);
  std::printf(
      "\n%d rows: %d met, %d missed; the tighter goal met by %d. %d laws; with the default parts %d do not "
      "hold, with others %d.\n",
      t.rows, t.rows - t.missed, t.missed, t.goals, t.laws, t.failed, t.failed_other);
}

void print_json(const Validation& v) {
  JsonWriter json;
  json.begin_object();
  json.key("rows").begin_array();
  for (const ValidationRow& row : v.rows) {
    json.begin_object(JsonLayout::one_line);
    json.field("law", std::string_view(row.law));
    json.field("row", std::string_view(row.name));
    json.field("integrator", std::string_view(row.integrator));
    json.field("solver", std::string_view(row.solver));
    json.field("measured", row.measured);
    json.key("exact");
    row.is_limit ? json.null() : json.value(row.expected);
    json.field("error", row.error());
    json.field("tolerance", row.tolerance);
    json.field("goal", row.goal);
    json.field("met", row.met);
    json.field("met_goal", row.met_goal);
    json.end_object();
  }
  json.end_array();
  json.key("laws").begin_array();
  for (const ValidationLaw& law : v.laws) {
    json.begin_object(JsonLayout::one_line);
    json.field("law", std::string_view(law.law));
    json.field("integrator", std::string_view(law.integrator));
    json.field("solver", std::string_view(law.solver));
    json.field("default_parts", law.default_parts);
    json.field("seconds", law.seconds);
    json.field("holds", law.failure.empty());
    json.field("failure", std::string_view(law.failure));
    json.end_object();
  }
  json.end_array();
  json.end_object();
  std::fputs(json.take().c_str(), stdout);
}

bool write_page(const Validation& v, const std::string& path) {
  OutputFile file;
  if (file.open(path) && file.write(make_validation_page(v)) && file.commit()) return true;
  std::fprintf(stderr, "%s\n", file.message().c_str());
  return false;
}

}  // namespace

int validate_table(const ValidateOptions& options) {
  Progress progress(true, 1000, "thousandths");
  const Validation v = run_validation(options, progress);
  progress.clear();
  if (v.laws.empty()) {
    std::fprintf(stderr, "No law is called %s.\n", options.filter.c_str());
    return kExitUsage;
  }
  options.json ? print_json(v) : print_text(v);
  if (!options.html.empty() && !write_page(v, options.html)) return kExitInvalid;
  return add_up(v).failed == 0 ? kExitGood : kExitFailed;
}

}  // namespace gyre
