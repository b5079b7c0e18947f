// The page of gyre validate --html.
#include "validate_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace gyre {

namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Gyre: laws measured</title>
<style>
body{font:14px/1.4 system-ui,sans-serif;margin:2em auto;max-width:80em;padding:0 1em;color:#222;background:#fff}
table{border-collapse:collapse;width:100%}
th,td{text-align:right;padding:.15em .6em;border-bottom:1px solid #e4e4e4;font-variant-numeric:tabular-nums}
th:first-child,td:first-child{text-align:left}td:not(:first-child){white-space:nowrap}
.bar{width:14em;background:#f0f0f0;position:relative;height:.8em}
.bar i{position:absolute;left:0;top:0;bottom:0;background:#5b86a8}
.bar b{position:absolute;left:75%;top:-.2em;bottom:-.2em;border-left:2px solid #222}
.missed .bar i{background:#d9604a}
.missed td:nth-child(7){color:#b23b25;font-weight:600}
pre{background:#f7f2f0;padding:.6em;white-space:pre-wrap}
</style></head><body>
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Six decades below the tolerance fill three quarters of the bar; two above it the rest.
double width_of(double share) {
  if (!(share > 0.0)) return 0.0;
  return std::clamp(75.0 + std::log10(share) * 12.5, 0.5, 100.0);
}

std::string row_of(const ValidationRow& row) {
  std::string out = row.met ? "<tr>" : "<tr class=\"missed\">";
  const auto cell = [&](const std::string& text) { out += "<td>" + text + "</td>"; };
  cell(escaped(row.name) + "<br><small>" + escaped(row.law) + "</small>");
  cell(number(row.measured));
  cell(row.is_limit ? "at most" : number(row.expected));
  cell(row.is_limit ? "" : number(row.error()));
  cell(number(row.tolerance));
  cell("<div class=\"bar\"><i style=\"width:" + number(width_of(row.share())) + "%\"></i><b></b></div>");
  cell(row.met ? (row.met_goal ? "met, goal too" : "met") : "missed");
  cell(escaped(row.integrator) + "<br>" + escaped(row.solver));
  return out + "</tr>\n";
}

}  // namespace

std::string make_validation_page(const Validation& v) {
  const auto missed =
      std::count_if(v.rows.begin(), v.rows.end(), [](const ValidationRow& row) { return !row.met; });
  const auto failed = std::count_if(v.laws.begin(), v.laws.end(),
                                    [](const ValidationLaw& law) { return !law.failure.empty(); });
  std::string page = kHead;
  page += "<h1>Laws measured</h1><p>" + std::to_string(v.rows.size()) + " rows, " + std::to_string(missed) +
          " missed; " + std::to_string(v.laws.size()) + " laws, " + std::to_string(failed) +
          " do not hold. Bars are errors over tolerances, a decade an eighth of the width; the mark is the "
          "tolerance.</p>\n";
  for (const ValidationLaw& law : v.laws) {
    if (law.failure.empty()) continue;
    page += "<h2>" + escaped(law.law) + " does not hold (" + escaped(law.integrator) + ", " +
            escaped(law.solver) + ")</h2><pre>" + escaped(law.failure) + "</pre>\n";
  }
  page +=
      "<table><tr><th>row</th><th>measured</th><th>exact</th><th>error</th><th>tolerance</th><th></th><th></"
      "th><th>integrator, "
      "solver</th></tr>\n";
  for (const ValidationRow& row : v.rows) page += row_of(row);
  return page + "</table></body></html>\n";
}

}  // namespace gyre
