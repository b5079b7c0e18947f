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
  bool dots = false;              // of SVG: points without lines between them
};

std::string chart_svg(const Chart& chart);
// Charts of one size beside and below each other, row by row.
std::string charts_svg(const std::vector<Chart>& charts, int columns);
std::string chart_gnuplot(const Chart& chart, const std::string& png_path);
std::string chart_matplotlib(const Chart& chart, const std::string& png_path);

// Round numbers, about `wanted` of them, that divide the range; at least two.
std::vector<double> chart_ticks(double low, double high, int wanted);

}  // namespace gyre
