// Movies as MP4 or WebM, which ffmpeg encodes where it is installed. Frames go to it one by one, so that a movie needs no memory.
#pragma once

#include "child_program.h"
#include "render/picture.h"

#include <string>

namespace gyre {

class VideoFile {
 public:
  VideoFile() = default;
  ~VideoFile();  // removes what was not committed
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  // A path that ends in .mp4 (H.264) or .webm (VP9). False and a message if ffmpeg is not there or nothing can be written there.
  bool open(const std::string& path, double seconds_a_frame);
  bool add(const Picture& picture);
  bool commit();

  const std::string& message() const { return message_; }
  std::uint64_t bytes() const { return bytes_; }  // of the file, after commit()

 private:
  bool start(const Picture& first);
  bool fail(const std::string& why);

  ChildProgram encoder_;
  std::string path_, temporary_, message_, program_;
  double frame_rate_ = 20;
  bool started_ = false;
  std::uint64_t bytes_ = 0;
};

}  // namespace gyre
