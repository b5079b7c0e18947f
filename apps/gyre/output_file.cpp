// A file that appears whole or not at all. See output_file.h.
#include "output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

namespace gyre {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kBufferBytes = std::size_t(1) << 16;

long process_number() {
#ifdef _WIN32
  return _getpid();
#else
  return getpid();
#endif
}

}  // namespace

OutputFile::~OutputFile() { discard(); }

bool OutputFile::fail(const std::string& what) {
  message_ = (is_standard_output() ? "standard output" : path_) + ": " + what;
  discard();
  return false;
}

void OutputFile::discard() {
  if (file_ && !is_standard_output()) std::fclose(file_);
  file_ = nullptr;
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  temporary_.clear();
  buffer_.clear();
}

bool OutputFile::open(const std::string& path) {
  path_ = path;
  target_ = path;
  if (is_standard_output()) {
    file_ = stdout;
    return true;
  }
  std::error_code error;
  const fs::file_status status = fs::status(fs::path(path), error);
  if (fs::is_directory(status)) return fail("is a folder, expected a file to write");
  // Devices and pipes are written as they are: putting a file in their place would take them away.
  const bool in_place = fs::exists(status) && !fs::is_regular_file(status);
  if (!in_place) {
    if (fs::exists(status)) {
      const fs::path resolved = fs::canonical(fs::path(path), error);
      if (!error) target_ = resolved.string();
    }
    temporary_ = target_ + "." + std::to_string(process_number()) + ".part";
  }
  file_ = std::fopen((in_place ? target_ : temporary_).c_str(), "wb");
  if (!file_) {
    const std::string why = std::strerror(errno);
    temporary_.clear();
    return fail("cannot be written: " + why);
  }
  return true;
}

bool OutputFile::write(std::string_view bytes) {
  if (!file_) return false;
  buffer_ += bytes;
  if (buffer_.size() < kBufferBytes) return true;
  const bool good = std::fwrite(buffer_.data(), 1, buffer_.size(), file_) == buffer_.size();
  buffer_.clear();
  return good || fail(std::string("cannot be written: ") + std::strerror(errno));
}

bool OutputFile::commit() {
  if (!file_) return false;
  const bool written =
      buffer_.empty() || std::fwrite(buffer_.data(), 1, buffer_.size(), file_) == buffer_.size();
  const bool closed = (is_standard_output() ? std::fflush(file_) : std::fclose(file_)) == 0;
  file_ = nullptr;
  if (!written || !closed) return fail(std::string("cannot be written: ") + std::strerror(errno));
  buffer_.clear();
  if (temporary_.empty()) return true;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) return fail("cannot be written: " + error.message());
  temporary_.clear();
  return true;
}

}  // namespace gyre
