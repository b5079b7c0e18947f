// A recording for a page without the engine: the poses of its track, decoded here (web/viewer/src/worker/served_poses.ts asks).
//
// An answer is the length of a JSON text (4 bytes), that text, and the arrays that the text names by [offset behind the text,
// count]. Numbers are little-endian as the processors are that Gyre runs on, arrays begin at multiples of 4 bytes.
#pragma once

#include <gyre/result.h>
#include <gyre/track.h>

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

namespace gyre {

class ServedRecording {
 public:
  explicit ServedRecording(std::string path) : path_(std::move(path)) {}

  // Returns the models, the surfaces and the number of frames. Reads the file anew; a recording of commands alone is simulated.
  Result<std::string> scene();
  // One group of frames, with the sets of bodies that occur in it. invalid_argument: there is no such group.
  Result<std::string> frames(std::size_t group);

 private:
  Error open();

  std::string path_;
  std::mutex mutex_;  // requests come from several threads
  std::optional<PoseTrack> track_;
  DVec3 origin_{};  // drawn places are 32-bit and counted from here
  std::size_t frames_in_group_ = 1;
};

}  // namespace gyre
