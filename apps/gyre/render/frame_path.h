// What --out asks for: one picture, a movie, or pictures with numbers in their names.
#pragma once

#include <cstdint>
#include <string>

namespace gyre {

enum class OutputKind { picture, numbered, movie };

struct FramePath {
  OutputKind kind = OutputKind::picture;
  std::string before,
      after;       // the number's place in the path; a picture's or movie's whole path is in `before`
  int digits = 0;  // at least so many, with leading zeros

  std::string at(std::uint64_t frame) const;
};

// A path that ends in .gif is a movie; one that ends in .png is a picture, or many if it has a %d or %04d. Returns why it is
// none of these; empty if it is one.
std::string parse_frame_path(const std::string& text, FramePath& out);

}  // namespace gyre
