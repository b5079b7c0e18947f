// Writes pictures. See frame_output.h.
#include "render/frame_output.h"

#include "render/gif_file.h"
#include "render/png_file.h"

#include <filesystem>
#include <system_error>

namespace gyre {

bool FrameOutput::open() {
  if (path_.kind == OutputKind::video) {
    if (video_.open(path_.before, seconds_)) return true;
    message_ = video_.message();
    return false;
  }
  if (path_.kind != OutputKind::numbered) {
    if (file_.open(path_.before)) return true;
    message_ = file_.message();
    return false;
  }
  const std::filesystem::path folder = std::filesystem::path(path_.at(0)).parent_path();
  if (folder.empty() || std::filesystem::is_directory(folder)) return true;
  // Only one new folder: a mistyped path shall not become a tree.
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) message_ = folder.string() + ": the folder cannot be made: " + error.message();
  return !error;
}

bool FrameOutput::write(OutputFile& file, const std::string& bytes) {
  bytes_ += bytes.size();
  if (file.write(bytes) && file.commit()) return true;
  message_ = file.message();
  return false;
}

bool FrameOutput::add(Picture picture) {
  ++frames_;
  if (path_.kind == OutputKind::video) {
    if (video_.add(picture)) return true;
    message_ = video_.message();
    return false;
  }
  if (path_.kind == OutputKind::movie) {
    movie_.push_back(std::move(picture));
    return true;
  }
  const std::string bytes = png_bytes(picture, message_);
  if (bytes.empty()) return false;
  if (path_.kind == OutputKind::picture) return write(file_, bytes);
  OutputFile file;
  if (file.open(path_.at(frames_ - 1))) return write(file, bytes);
  message_ = file.message();
  return false;
}

bool FrameOutput::finish() {
  if (path_.kind == OutputKind::video) {
    const bool whole = video_.commit();
    message_ = video_.message();
    bytes_ = video_.bytes();
    return whole;
  }
  if (path_.kind != OutputKind::movie || movie_.empty()) return true;
  const std::string bytes = gif_bytes(movie_, seconds_, message_);
  return !bytes.empty() && write(file_, bytes);
}

}  // namespace gyre
