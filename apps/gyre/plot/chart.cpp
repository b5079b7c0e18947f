// Line charts. See chart.h.
#include "plot/chart.h"

#include "scene/number_text.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

// Colours that people with any colour vision tell apart (Okabe and Ito, 2008), without the yellow, which is faint on white.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#000000"};
constexpr double kLeft = 84, kRight = 24, kTop = 52, kBottom = 56;  // pixels around the drawing

struct Range {
  double low = 0, high = 0;
  bool empty = true;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = empty ? value : std::min(low, value);
    high = empty ? value : std::max(high, value);
    empty = false;
  }
  // Never without width, so that a constant has a place.
  void widen() {
    if (empty) low = 0, high = 1;
    const double least = 1e-9 * std::max({std::fabs(low), std::fabs(high), 1e-3});
    if (high - low < least) {
      const double half = std::max(0.5 * std::fabs(low), 0.5);
      low -= half;
      high += half;
    }
  }
};

std::string xml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

std::string pixel(double value) { return rounded(std::round(10 * value) / 10, 6); }

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const std::string& more = {}) {
  return "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         xml(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const char* color) {
  return "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) + "\" y2=\"" +
         pixel(y2) + "\" stroke=\"" + color + "\"/>\n";
}

// The points of one series; a value that is not finite interrupts the line.
template <class ToX, class ToY>
std::string path_of(const ChartSeries& series, ToX to_x, ToY to_y) {
  std::string out;
  bool down = false;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const bool good = std::isfinite(series.x[i]) && std::isfinite(series.y[i]);
    if (good) out += (down ? "L" : "M") + pixel(to_x(series.x[i])) + " " + pixel(to_y(series.y[i]));
    down = good;
  }
  return out;
}

template <class ToX, class ToY>
std::string dots_of(const ChartSeries& series, ToX to_x, ToY to_y, const char* color) {
  std::string out;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    out += "<circle cx=\"" + pixel(to_x(series.x[i])) + "\" cy=\"" + pixel(to_y(series.y[i])) +
           "\" r=\"2.4\" fill=\"" + color + "\" fill-opacity=\"0.6\"/>\n";
  }
  return out;
}

// A text of Python and of gnuplot in double quotes.
std::string quoted_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "\"";
}

std::string list_of(const std::vector<double>& values) {
  std::string out = "[";
  for (const double value : values) {
    out += (out.size() > 1 ? "," : "");
    if (std::isfinite(value)) {
      append_number(out, value);
    } else {
      out += "float('nan')";
    }
  }
  return out + "]";
}

}  // namespace

std::vector<double> chart_ticks(double low, double high, int wanted) {
  const double raw = (high - low) / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> out;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    out.push_back(k * step + 0.0);
  if (out.size() < 2) out = {low, high};
  return out;
}

namespace {

// Everything of a chart but the element around it; its upper left corner is at 0, 0.
std::string chart_body(const Chart& chart) {
  Range x, y;
  for (const ChartSeries& series : chart.series) {
    for (const double value : series.x) x.add(value);
    for (const double value : series.y) y.add(value);
  }
  x.widen();
  y.widen();
  const int wanted_x = std::max(chart.width / 110, 2), wanted_y = std::max(chart.height / 90, 2);
  const std::vector<double> x_ticks = chart_ticks(x.low, x.high, wanted_x),
                            y_ticks = chart_ticks(y.low, y.high, wanted_y);
  const double margin = 0.04 * (y.high - y.low), side = chart.dots ? 0.04 * (x.high - x.low) : 0.0;
  const double low = std::min(y.low - margin, y_ticks.front()),
               high = std::max(y.high + margin, y_ticks.back());
  const double first = std::min(x.low - side, chart.dots ? x_ticks.front() : x.low),
               last = std::max(x.high + side, chart.dots ? x_ticks.back() : x.high);
  const double right = chart.width - kRight, bottom = chart.height - kBottom;
  const auto to_x = [&](double value) { return kLeft + (value - first) / (last - first) * (right - kLeft); };
  const auto to_y = [&](double value) { return bottom - (value - low) / (high - low) * (bottom - kTop); };
  std::string out = text_at(0.5 * (kLeft + right), 24, "middle", chart.title, " font-size=\"16\"");
  for (const double tick : x_ticks) {
    out += line(to_x(tick), kTop, to_x(tick), bottom, "#ddd");
    out += text_at(to_x(tick), bottom + 18, "middle", rounded(tick, 6));
  }
  for (const double tick : y_ticks) {
    out += line(kLeft, to_y(tick), right, to_y(tick), "#ddd");
    out += text_at(kLeft - 8, to_y(tick) + 4, "end", rounded(tick, 6));
  }
  out += "<rect x=\"" + pixel(kLeft) + "\" y=\"" + pixel(kTop) + "\" width=\"" + pixel(right - kLeft) +
         "\" height=\"" + pixel(bottom - kTop) + "\" fill=\"none\" stroke=\"#888\"/>\n";
  out += text_at(0.5 * (kLeft + right), bottom + 42, "middle", chart.x_label);
  const std::string turned = " transform=\"rotate(-90 20 " + pixel(0.5 * (kTop + bottom)) + ")\"";
  out += text_at(20, 0.5 * (kTop + bottom), "middle", chart.y_label, turned);
  double key = kLeft;  // the names above the drawing, from the left
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const ChartSeries& series = chart.series[i];
    const char* const color = kColors[i % std::size(kColors)];
    if (chart.dots) {
      out += dots_of(series, to_x, to_y, color);
    } else {
      out += "<path d=\"" + path_of(series, to_x, to_y) + "\" fill=\"none\" stroke=\"" + color +
             "\" stroke-width=\"1.6\" stroke-linejoin=\"round\"/>\n";
    }
    if (series.name.empty() || key > right - 40) continue;
    out += line(key, 42, key + 20, 42, color) + text_at(key + 26, 46, "start", series.name);
    key += 44 + 7.2 * double(series.name.size());
  }
  return out;
}

std::string begin_svg(int width, int height) {
  const std::string size =
      "width=\"" + std::to_string(width) + "\" height=\"" + std::to_string(height) + "\"";
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " + std::to_string(width) +
         " " + std::to_string(height) +
         "\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n<rect " + size +
         " fill=\"#fff\"/>\n";
}

}  // namespace

std::string chart_svg(const Chart& chart) {
  return begin_svg(chart.width, chart.height) + chart_body(chart) + "</svg>\n";
}

std::string charts_svg(const std::vector<Chart>& charts, int columns) {
  if (charts.empty() || columns < 1) return begin_svg(0, 0) + "</svg>\n";
  const int width = charts[0].width, height = charts[0].height;
  const int rows = (int(charts.size()) + columns - 1) / columns;
  std::string out = begin_svg(columns * width, rows * height);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const int row = int(i) / columns, column = int(i) % columns;
    out += "<g transform=\"translate(" + std::to_string(column * width) + " " + std::to_string(row * height) +
           ")\">\n" + chart_body(charts[i]) + "</g>\n";
  }
  return out + "</svg>\n";
}

std::string chart_gnuplot(const Chart& chart, const std::string& png_path) {
  std::string out = "set terminal pngcairo size " + std::to_string(chart.width) + "," +
                    std::to_string(chart.height) + " noenhanced\nset output " + quoted_text(png_path) +
                    "\nset title " + quoted_text(chart.title) + "\nset xlabel " + quoted_text(chart.x_label) +
                    "\nset ylabel " + quoted_text(chart.y_label) + "\nset grid\nset key top left\n";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    out += "$s" + std::to_string(i) + " << GYRE_END\n";
    for (std::size_t k = 0; k < chart.series[i].x.size(); ++k)
      out += rounded(chart.series[i].x[k], 12) + " " + rounded(chart.series[i].y[k], 12) + "\n";
    out += "GYRE_END\n";
  }
  out += "plot ";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    out += (i > 0 ? ", " : "") + ("$s" + std::to_string(i)) + " using 1:2 with lines lw 1.6 lc rgb \"" +
           kColors[i % std::size(kColors)] + "\" title " + quoted_text(chart.series[i].name);
  }
  return out + "\n";
}

std::string chart_matplotlib(const Chart& chart, const std::string& png_path) {
  std::string out =
      "import matplotlib\nmatplotlib.use('Agg')\nimport matplotlib.pyplot as plt\nfig, ax = "
      "plt.subplots(figsize=(" +
      rounded(chart.width / 100.0) + "," + rounded(chart.height / 100.0) + "), dpi=100)\n";
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    out += "ax.plot(" + list_of(chart.series[i].x) + "," + list_of(chart.series[i].y) + ",color='" +
           kColors[i % std::size(kColors)] + "',label=" + quoted_text(chart.series[i].name) + ")\n";
  }
  return out + "ax.set_title(" + quoted_text(chart.title) + ")\nax.set_xlabel(" + quoted_text(chart.x_label) +
         ")\nax.set_ylabel(" + quoted_text(chart.y_label) +
         ")\nax.grid(True)\nax.legend()\nfig.tight_layout()\nfig.savefig(" + quoted_text(png_path) + ")\n";
}

}  // namespace gyre
