// gyre render: its options. See render.h.
#include "commands.h"
#include "exit_code.h"
#include "import_options.h"
#include "option_checks.h"
#include "render/render.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>

namespace gyre {
namespace {

// Reads "640x400". Returns what is wrong; empty if nothing is.
std::string parse_size(const std::string& text, RenderOptions& options) {
  const std::size_t middle = text.find('x');
  int width = 0, height = 0;
  const bool good = middle != std::string::npos && CLI::detail::lexical_cast(text.substr(0, middle), width) &&
                    CLI::detail::lexical_cast(text.substr(middle + 1), height) && width >= 16 &&
                    height >= 16 && width <= 8192 && height <= 8192;
  if (!good) return "found " + text + ", expected WIDTHxHEIGHT in pixels, 16 to 8192 each";
  options.width = width;
  options.height = height;
  return {};
}

// "1,2,3": `count` finite numbers. Returns what is wrong; empty if nothing is.
std::string parse_numbers(const std::string& text, std::size_t count, std::vector<double>& out) {
  out.clear();
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    double value = 0;
    if (!CLI::detail::lexical_cast(text.substr(begin, end - begin), value) || !(std::abs(value) <= 1e12))
      break;
    out.push_back(value);
    begin = end + 1;
  }
  if (begin > text.size() && out.size() == count) return {};
  return "found " + text + ", expected " + std::to_string(count) + " numbers with commas between them";
}

template <class Parse>
void add_parsed(CLI::App& command, const char* name, const char* type, const char* help, Parse parse) {
  command
      .add_option_function<std::string>(
          name,
          [name, parse](const std::string& text) {
            const std::string problem = parse(text);
            if (!problem.empty()) throw CLI::ValidationError(name, problem);
          },
          help)
      ->type_name(type);
}

void add_camera_options(CLI::App& command, RenderOptions& options) {
  add_parsed(
      command, "--camera", "X,Y,Z",
      "Where the camera stands, in m; left out: where the scene says, or so that all that moves is seen",
      [&options](const std::string& text) { return parse_numbers(text, 3, options.eye); });
  add_parsed(command, "--look-at", "X,Y,Z", "Where the camera looks, in m",
             [&options](const std::string& text) { return parse_numbers(text, 3, options.target); });
  add_parsed(command, "--direction", "AZIMUTH,ELEVATION",
             "From where to look if --camera does not say: degrees from +z towards +x, and above the horizon "
             "(35,23)",
             [&options](const std::string& text) { return parse_numbers(text, 2, options.direction); });
  command.add_option("--fov", options.field_of_view, "Field of view from bottom to top, in degrees (34)")
      ->type_name("DEGREES")
      ->check(number_between(1, false, 170, "a number from 1 to 170"));
  command.add_option("--zoom", options.zoom, "Above 1: nearer, below 1: farther away")
      ->type_name("FACTOR")
      ->check(number_between(0.01, false, 100, "a number from 0.01 to 100"));
  command.add_option("--follow", options.follow, "The camera moves with this body")->type_name("NAME");
}

void add_reading_options(CLI::App& command, RenderOptions& options) {
  add_parsed(command, "--color-by", "stress|strain",
             "Colour soft matter by the stress of von Mises (solids) or by strain, with a key",
             [&options](const std::string& text) {
               options.reading = text == "stress"   ? SoftReading::stress
                                 : text == "strain" ? SoftReading::strain
                                                    : SoftReading::none;
               const bool good = options.reading != SoftReading::none;
               return good ? std::string() : "found " + text + ", expected stress or strain";
             });
  add_parsed(command, "--color-range", "LOW,HIGH",
             "What the ends of the key stand for, in Pa or as a share (0.05 is 5 %); left out: what is seen in all frames",
             [&options](const std::string& text) { return parse_numbers(text, 2, options.range); });
}

void add_time_options(CLI::App& command, RenderOptions& options) {
  const CLI::Validator time = number_between(0, false, 1e9, "a number from 0 to 1e9");
  command.add_option("--at", options.at, "The moment of a single picture, in s (0)")
      ->type_name("S")
      ->check(time);
  command.add_option("--from", options.from, "Where a movie begins, in s of the scene (0)")
      ->type_name("S")
      ->check(time);
  CLI::Option* to = command.add_option("--to", options.to, "Where a movie ends, in s of the scene")
                        ->type_name("S")
                        ->check(time);
  CLI::Option* seconds = command
                             .add_option("--seconds", options.seconds,
                                         "How long a movie runs, in s (5; a recording: to its end)")
                             ->type_name("S")
                             ->check(time)
                             ->excludes(to);
  command.add_option("--frames", options.frames, "How many frames, instead of a time")
      ->type_name("N")
      ->check(number_between(1, false, 1e7, "an integer from 1 to 1e7"))
      ->excludes(to)
      ->excludes(seconds);
  command.add_option("--fps", options.frame_rate, "Frames in a second of the movie (20)")
      ->type_name("N")
      ->check(number_between(0.01, false, 1000, "a number from 0.01 to 1000"));
  command
      .add_option("--speed", options.speed,
                  "Seconds of the scene in a second of the movie: 0.1 is slow motion (1)")
      ->type_name("FACTOR")
      ->check(number_between(1e-6, false, 1e6, "a number from 1e-6 to 1e6"));
}

// What one option alone cannot know. Returns what is wrong; empty if nothing is.
std::string check_together(const RenderOptions& options) {
  const bool movie_option =
      options.from || options.to || options.seconds || options.frames || options.frame_rate;
  if (options.out.kind == OutputKind::picture && movie_option) {
    return "--out " + options.out.at(0) +
           " is one picture, whose moment is --at; for more frames it is a .gif, .mp4 or .webm, or has a " +
           "number: frames/%04d.png";
  }
  if (options.out.kind != OutputKind::picture && options.at)
    return "--at is for a single picture; a movie has --from and --to";
  if (options.to && *options.to <= options.from.value_or(0)) return "--to must be later than --from";
  if (options.out.kind == OutputKind::movie && options.frame_rate && *options.frame_rate > 50) {
    return "--fps: a GIF has at most 50 frames a second";
  }
  if (!options.eye.empty() && options.eye == options.target) {
    return "--camera must stand somewhere else than --look-at";
  }
  if (!options.range.empty() && options.reading == SoftReading::none)
    return "--color-range has no meaning without --color-by";
  if (!options.range.empty() && !(options.range[0] < options.range[1]))
    return "--color-range: the first number must be below the second";
  if (!options.direction.empty() && !options.eye.empty()) return "--direction has no meaning with --camera";
  if (!options.direction.empty() && std::abs(options.direction[1]) > 90) {
    return "--direction: the elevation goes from -90 to 90 degrees";
  }
  return {};
}

}  // namespace

void add_render(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("render", "Draw pictures or a movie of a scene or a recording");
  const auto options = std::make_shared<RenderOptions>();
  command->add_option("SCENE|RECORDING", options->source, "The scene (*.gyre.json), robot, glTF file or recording (*.gyrec); - for standard input")
      ->required()
      ->type_name("");
  add_parsed(*command, "--out", "FILE", "picture.png, movie.gif, movie.mp4 or movie.webm (by ffmpeg), frames/%04d.png for many pictures, or - for a PNG on standard output",
             [options](const std::string& text) { return parse_frame_path(text, options->out); });
  command->get_option("--out")->required();
  add_parsed(*command, "--size", "WIDTHxHEIGHT", "Of the picture, in pixels (960x600; a GIF: 480x300)",
             [options](const std::string& text) { return parse_size(text, *options); });
  add_camera_options(*command, *options);
  add_time_options(*command, *options);
  add_reading_options(*command, *options);
  command->add_option("--scene", options->look, "The scene of a recording, for its colours, names and ropes")
      ->type_name("SCENE");
  command
      ->add_option("--samples", options->samples,
                   "Samples a pixel: more are smoother and take longer (48; a GIF: 16)")
      ->type_name("N")
      ->check(number_between(1, false, 1024, "an integer from 1 to 1024"));
  add_threads_option(*command, options->threads, "Worker threads of the simulation, 0 for all; never changes a picture");
  add_import_options(*command, options->import);
  command->add_flag("--quiet", options->quiet, "Print no summary and show no progress");
  command->callback([options, &exit_code] {
    const std::string problem = check_together(*options);
    if (problem.empty()) {
      exit_code = render(*options);
    } else {
      std::fprintf(stderr, "gyre render: %s\n", problem.c_str());
      exit_code = kExitUsage;
    }
  });
}

}  // namespace gyre
