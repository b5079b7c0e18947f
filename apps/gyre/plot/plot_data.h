// The figures behind a plot, read step by step from a scene that is simulated or a recording that is replayed.
#pragma once

#include "formats/import.h"
#include "plot/chart.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gyre {

struct PlotOptions {
  std::string source, out;  // a scene or a recording with commands; *.svg or *.png
  ImportOptions import;
  std::string what = "energy";      // or position, velocity, phase
  std::vector<std::string> bodies;  // names; empty: the first dynamic body
  std::string joint;                // of a phase portrait, instead of a body
  std::string axis = "y";           // of a phase portrait
  std::optional<double> duration;   // s; 10 of a scene, all of a recording
  int width = 900, height = 540;
  int threads = 1;
  bool quiet = false;
};

// Simulates or replays, and fills in the chart. Returns the exit status; other than kExitGood after a message on stderr.
int collect_plot(const PlotOptions& options, Chart& chart);

}  // namespace gyre
