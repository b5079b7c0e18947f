// Takes pictures and writes them as files: a PNG each, one GIF, or one MP4 or WebM of all.
#pragma once

#include "output_file.h"
#include "render/frame_path.h"
#include "render/picture.h"
#include "render/video_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gyre {

class FrameOutput {
 public:
  FrameOutput(FramePath path, double seconds_a_frame) : path_(std::move(path)), seconds_(seconds_a_frame) {}

  // Checks that the first file can be written, and makes the folder of numbered pictures. False and a message if not.
  bool open();
  bool add(Picture picture);
  // Writes what is still to be written.
  bool finish();

  const std::string& message() const { return message_; }
  std::uint64_t frames() const { return frames_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  bool write(OutputFile& file, const std::string& bytes);

  FramePath path_;
  double seconds_;
  OutputFile file_;  // of a picture or a movie
  VideoFile video_;
  std::vector<Picture> movie_;
  std::uint64_t frames_ = 0, bytes_ = 0;
  std::string message_;
};

}  // namespace gyre
