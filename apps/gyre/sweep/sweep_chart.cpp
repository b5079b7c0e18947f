// The chart of a study (SVG 1.1, written without a library). See sweep_results.h.
#include "scene/number_text.h"
#include "sweep/sweep_results.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyre {
namespace {

constexpr double kPanelWidth = 300, kPanelHeight = 200, kLeft = 70, kBottom = 46, kTop = 26, kRight = 14;

struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  // Makes room around the values, and around a single one.
  void widen() {
    if (!(low <= high)) low = 0, high = 1;
    const double room = high > low ? 0.05 * (high - low) : std::max(0.5 * std::fabs(low), 0.5);
    low -= room, high += room;
  }
  double place(double value) const { return (value - low) / (high - low); }
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return "<text x=\"" + rounded(x, 5) + "\" y=\"" + rounded(y, 5) + "\" text-anchor=\"" + anchor + "\">" +
         escaped(text) + "</text>\n";
}

struct Dot {
  double x = 0, y = 0;
};

std::string panel(double left, double top, const std::string& across, const std::string& up,
                  const std::vector<Dot>& dots) {
  Axis x, y;
  for (const Dot& dot : dots) x.add(dot.x), y.add(dot.y);
  x.widen(), y.widen();
  const double wide = kPanelWidth - kLeft - kRight, high = kPanelHeight - kTop - kBottom;
  const double begin = left + kLeft, bottom = top + kTop + high;
  std::string out = "<rect x=\"" + rounded(begin, 5) + "\" y=\"" + rounded(top + kTop, 5) + "\" width=\"" +
                    rounded(wide, 5) + "\" height=\"" + rounded(high, 5) +
                    "\" fill=\"none\" stroke=\"#888\"/>\n";
  for (const double share : {0.0, 0.5, 1.0}) {
    out += text_at(begin + share * wide, bottom + 14, "middle", rounded(x.low + share * (x.high - x.low), 3));
    out += text_at(begin - 5, bottom - share * high + 4, "end", rounded(y.low + share * (y.high - y.low), 3));
  }
  out += text_at(begin + 0.5 * wide, bottom + 32, "middle", across);
  out += text_at(begin, top + kTop - 8, "start", up);
  for (const Dot& dot : dots) {
    out += "<circle cx=\"" + rounded(begin + x.place(dot.x) * wide, 6) + "\" cy=\"" +
           rounded(bottom - y.place(dot.y) * high, 6) +
           "\" r=\"2.2\" fill=\"#1f6fb4\" fill-opacity=\"0.6\"/>\n";
  }
  return out;
}

}  // namespace

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
  const double width = kPanelWidth * double(across.size()),
               height = kPanelHeight * double(study.readings.size());
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + rounded(width, 6) +
                    "\" height=\"" + rounded(height, 6) + "\" viewBox=\"0 0 " + rounded(width, 6) + " " +
                    rounded(height, 6) +
                    "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n";
  for (std::size_t i = 0; i < across.size(); ++i) {
    for (std::size_t k = 0; k < study.readings.size(); ++k) {
      std::vector<Dot> dots;
      for (const Json& row : rows) {
        if (!row.contains("readings")) continue;
        const Json y = row["readings"].value(study.readings[k].name, Json());
        const Json x = by_case ? row["case"] : row["parameters"][across[i]];
        if (y.is_number() && x.is_number()) dots.push_back({x.get<double>(), y.get<double>()});
      }
      out +=
          panel(kPanelWidth * double(i), kPanelHeight * double(k), across[i], study.readings[k].name, dots);
    }
  }
  return out + "</svg>\n";
}

}  // namespace gyre
