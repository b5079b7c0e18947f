// gyre render: its options, and one run of it.
#pragma once

#include "formats/import.h"
#include "render/frame_path.h"
#include "render/soft_reading.h"

#include <gyre/math.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gyre {

struct RenderOptions {
  std::string source;  // a scene or a recording
  ImportOptions import;
  std::string look;    // the scene of a recording; may be empty
  FramePath out;
  std::optional<int> width, height;
  std::optional<int> samples;
  std::vector<double> eye, target;      // 3 numbers each, or none
  std::vector<double> direction;        // azimuth and elevation, degrees, or none
  std::optional<double> field_of_view;  // degrees
  double zoom = 1;
  std::string follow;  // the name of a body
  std::optional<double> at, from, to, seconds;
  std::optional<std::uint64_t> frames;
  std::optional<double> frame_rate;
  SoftReading reading = SoftReading::none;
  std::vector<double> range;  // of what is read, in Pa or as a share: two numbers, or none
  double speed = 1;  // seconds of the scene in a second of the movie
  int threads = 1;
  bool quiet = false;
};

// Draws what the options say; the exit status.
int render(const RenderOptions& options);

}  // namespace gyre
