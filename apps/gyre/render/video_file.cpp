// Movies by ffmpeg. See video_file.h.
#include "render/video_file.h"

#include "scene/number_text.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#ifndef _WIN32
#include <unistd.h>
#endif

namespace gyre {
namespace {

bool is_webm(const std::string& path) {
  return path.size() > 5 && path.compare(path.size() - 5, 5, ".webm") == 0;
}

long own_process() {
#ifdef _WIN32
  return 0;
#else
  return getpid();
#endif
}

}  // namespace

VideoFile::~VideoFile() {
  if (temporary_.empty()) return;
  encoder_.finish();
  std::remove(temporary_.c_str());
}

bool VideoFile::fail(const std::string& why) {
  message_ = path_ + ": " + why;
  return false;
}

bool VideoFile::open(const std::string& path, double seconds_a_frame) {
  path_ = path;
  frame_rate_ = 1.0 / seconds_a_frame;
  program_ = find_program("ffmpeg");
  if (program_.empty())
    return fail("needs ffmpeg, which is not installed; .gif and frames/%04d.png need nothing");
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return fail("is a folder, expected a file to write");
  const std::string temporary = path + "." + std::to_string(own_process()) + ".part";
  std::FILE* const file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) return fail(std::string("cannot be written: ") + std::strerror(errno));
  std::fclose(file);
  temporary_ = temporary;
  return true;
}

bool VideoFile::start(const Picture& first) {
  std::vector<std::string> arguments = {program_, "-v", "error", "-y", "-f", "rawvideo", "-pixel_format",
                                        "rgb24", "-video_size",
                                        std::to_string(first.width) + "x" + std::to_string(first.height),
                                        "-framerate", rounded(frame_rate_, 9), "-i", "-", "-an",
                                        // Players want even sizes.
                                        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"};
  const std::vector<std::string> codec =
      is_webm(path_)
          ? std::vector<std::string>{"-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0", "-f", "webm"}
          : std::vector<std::string>{"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"};
  arguments.insert(arguments.end(), codec.begin(), codec.end());
  arguments.push_back(temporary_);
  started_ = true;
  return encoder_.start(arguments) || fail("ffmpeg cannot be started");
}

bool VideoFile::add(const Picture& picture) {
  if (!started_ && !start(picture)) return false;
  const bool written =
      encoder_.write({reinterpret_cast<const char*>(picture.bytes.data()), picture.bytes.size()});
  return written || fail("ffmpeg ended before the movie did");
}

bool VideoFile::commit() {
  if (!started_) return true;
  if (!encoder_.finish()) return fail("ffmpeg failed");
  std::error_code error;
  bytes_ = std::filesystem::file_size(temporary_, error);
  std::filesystem::rename(temporary_, path_, error);
  if (error) return fail("cannot be written: " + error.message());
  temporary_.clear();
  return true;
}

}  // namespace gyre
