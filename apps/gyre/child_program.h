// Another program that takes bytes on its standard input, such as ffmpeg and gnuplot. It is started without a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gyre {

// The path of a program in the folders of PATH; empty if it is not installed.
std::string find_program(const std::string& name);

class ChildProgram {
 public:
  ChildProgram() = default;
  ~ChildProgram();  // ends the program's input and waits
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  // Its output is dropped; its messages go where this program's do. False if it cannot be started.
  bool start(const std::vector<std::string>& arguments);
  bool write(std::string_view bytes);
  // Ends its input and waits for its end. True if its exit status is 0.
  bool finish();

 private:
  int input_ = -1;
  long process_ = -1;
};

}  // namespace gyre
