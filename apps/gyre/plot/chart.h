// Line charts. In: series of points with names. Out: a drawing as SVG, made here and the same on every machine; or a script for gnuplot or
// Matplotlib, which draw a PNG.
#pragma once

#include <string>
#include <vector>

namespace gyre {

struct ChartSeries {
  std::string name;
  std::vector<double> x, y;  // of equal length
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartSeries> series;
  int width = 900, height = 540;  // pixels
};

std::string chart_svg(const Chart& chart);
std::string chart_gnuplot(const Chart& chart, const std::string& png_path);
std::string chart_matplotlib(const Chart& chart, const std::string& png_path);

// Round numbers, about `wanted` of them, that divide the range; at least two.
std::vector<double> chart_ticks(double low, double high, int wanted);

}  // namespace gyre
