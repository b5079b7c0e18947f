// The charts of a study: each reading over each parameter that is a number. See sweep_results.h.
#include "plot/chart.h"
#include "sweep/sweep_results.h"

#include <algorithm>

namespace gyre {

std::string results_chart(const Study& study, const std::map<std::uint64_t, std::string>& lines) {
  // Without a parameter that is a number, the number of the case is the only axis.
  std::vector<std::string> across;
  std::vector<Json> rows;
  for (const auto& [number, line] : lines) rows.push_back(Json::parse(line));
  for (const StudyParameter& parameter : study.parameters) {
    const bool numbers = std::all_of(rows.begin(), rows.end(), [&](const Json& row) {
      return row["parameters"].value(parameter.name, Json()).is_number();
    });
    if (numbers) across.push_back(parameter.name);
  }
  const bool by_case = across.empty();
  if (by_case) across.emplace_back("case");
  std::vector<Chart> charts;
  for (const StudyReading& reading : study.readings) {
    for (const std::string& parameter : across) {
      Chart chart{.title = "", .x_label = parameter, .y_label = reading.name, .series = {{}}};
      chart.width = 400, chart.height = 280, chart.dots = true;
      ChartSeries& series = chart.series[0];
      for (const Json& row : rows) {
        if (!row.contains("readings")) continue;
        const Json y = row["readings"].value(reading.name, Json());
        const Json x = by_case ? row["case"] : row["parameters"][parameter];
        if (!y.is_number() || !x.is_number()) continue;
        series.x.push_back(x.get<double>());
        series.y.push_back(y.get<double>());
      }
      charts.push_back(std::move(chart));
    }
  }
  return charts_svg(charts, int(across.size()));
}

}  // namespace gyre
