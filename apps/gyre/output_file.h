// A file that appears whole or not at all: written under another name beside its place and put there by commit(). Devices, pipes and standard
// output ("-") are written as they are.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace gyre {

constexpr std::string_view kStandardOutput = "-";  // as a path

class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // False and a message if nothing can be written there.
  bool open(const std::string& path);
  bool write(std::string_view bytes);
  bool commit();

  bool is_open() const { return file_ != nullptr; }
  const std::string& path() const { return path_; }
  const std::string& message() const { return message_; }  // names the path

 private:
  bool fail(const std::string& what);
  void discard();
  bool is_standard_output() const { return path_ == kStandardOutput; }

  std::FILE* file_ = nullptr;
  std::string path_;
  std::string target_;     // where the file goes, symbolic links resolved
  std::string temporary_;  // empty: written in place (a device or a pipe)
  std::string message_;
  std::string buffer_;
};

}  // namespace gyre
