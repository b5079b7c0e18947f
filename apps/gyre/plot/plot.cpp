// gyre plot: draws energy, motion or a phase portrait of a scene or a recording. SVG is drawn by plot/chart.cpp; PNG by gnuplot or, without
// it, by Matplotlib.
#include "child_program.h"
#include "commands.h"
#include "complain.h"
#include "exit_code.h"
#include "import_options.h"
#include "interrupt.h"
#include "option_checks.h"
#include "output_file.h"
#include "plot/plot_data.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace gyre {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Feeds a script to the program that draws. Its name, for the summary; empty if it failed.
std::string draw_png(const Chart& chart, const std::string& path) {
  const std::string gnuplot = find_program("gnuplot"), python = find_program("python3");
  const bool with_gnuplot = !gnuplot.empty();
  ChildProgram drawer;
  const std::string script = with_gnuplot ? chart_gnuplot(chart, path) : chart_matplotlib(chart, path);
  const std::string program = with_gnuplot ? gnuplot : python;
  if (program.empty() || !drawer.start(with_gnuplot ? std::vector<std::string>{program}
                                                    : std::vector<std::string>{program, "-"}))
    return {};
  const bool whole = drawer.write(script);
  return drawer.finish() && whole ? (with_gnuplot ? "gnuplot" : "Matplotlib") : "";
}

int write_chart(const Chart& chart, const PlotOptions& options) {
  std::string by = "gyre";
  if (ends_with(options.out, ".png")) {
    const std::string part = options.out + ".part.png";
    by = draw_png(chart, part);
    std::error_code error;
    if (by.empty()) {
      std::filesystem::remove(part, error);
      return complain(
          options.out +
          ": a PNG needs gnuplot (gnuplot-nox), or python3 with Matplotlib; an SVG needs neither");
    }
    std::filesystem::rename(part, options.out, error);
    if (error) return complain(options.out + ": cannot be written: " + error.message());
  } else {
    OutputFile file;
    if (!file.open(options.out) || !file.write(chart_svg(chart)) || !file.commit())
      return complain(file.message());
  }
  if (!options.quiet && options.out != kStandardOutput) {
    std::size_t points = 0;
    for (const ChartSeries& series : chart.series) points += series.x.size();
    std::printf("%s: %s, %zu series of %zu points, drawn by %s\n", options.out.c_str(), options.what.c_str(),
                chart.series.size(), chart.series.empty() ? 0 : points / chart.series.size(), by.c_str());
  }
  return kExitGood;
}

int run_plot(const PlotOptions& options) {
  if (options.out != kStandardOutput && !ends_with(options.out, ".svg") && !ends_with(options.out, ".png"))
    return complain("--out: found " + options.out +
                        ", expected a path that ends in .svg or .png, or - for an SVG on standard output",
                    kExitUsage);
  if (!options.joint.empty() && options.what != "phase")
    return complain("--joint is for --what phase", kExitUsage);
  watch_interrupt();
  Chart chart;
  const int collected = collect_plot(options, chart);
  return collected == kExitGood ? write_chart(chart, options) : collected;
}

}  // namespace

void add_plot(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("plot", "Draw energy, motion or a phase portrait of a scene or a recording");
  const auto options = std::make_shared<PlotOptions>();
  command
      ->add_option("SCENE|RECORDING", options->source,
                   "The scene, robot, glTF file or recording with commands; - for standard input")
      ->required()
      ->type_name("");
  command
      ->add_option("--out", options->out,
                   "The drawing: .svg, or .png by gnuplot or Matplotlib; - is an SVG on standard output")
      ->required()
      ->type_name("FILE.svg");
  take_one_of(
      command->add_option("--what", options->what, "energy (if not given), position, velocity or phase")
          ->type_name("WORD"),
      {"energy", "position", "velocity", "phase"});
  command
      ->add_option("--body", options->bodies,
                   "Whose motion; may be repeated. The first dynamic body if not given")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--joint", options->joint, "Of a phase portrait: velocity over position of this joint")
      ->type_name("NAME");
  take_one_of(
      command->add_option("--axis", options->axis, "Of a phase portrait of bodies: x, y (if not given) or z")
          ->type_name("AXIS"),
      {"x", "y", "z"});
  command
      ->add_option("--duration", options->duration, "Simulated time in s; 10 of a scene, all of a recording")
      ->type_name("S")
      ->check(number_between(0, true, 1e9, "a number above 0 and at most 1e9"));
  command->add_option("--width", options->width, "Pixels (900)")
      ->type_name("N")
      ->check(number_between(200, false, 8192, "an integer from 200 to 8192"));
  command->add_option("--height", options->height, "Pixels (540)")
      ->type_name("N")
      ->check(number_between(200, false, 8192, "an integer from 200 to 8192"));
  add_threads_option(*command, options->threads, "Worker threads, 0 for all; never changes a result");
  add_import_options(*command, options->import);
  command->add_flag("--quiet", options->quiet, "Print no summary and show no progress");
  command->callback([options, &exit_code] { exit_code = run_plot(*options); });
}

}  // namespace gyre
