// What --out asks for: one picture, a movie, or pictures with numbers in their names.
#pragma once

#include <cstdint>
#include <string>

namespace gyre {

enum class OutputKind { picture, numbered, movie, video };  // movie: a GIF; video: an MP4 or WebM

struct FramePath {
  OutputKind kind = OutputKind::picture;
  std::string before,
      after;       // the number's place in the path; a picture's or movie's whole path is in `before`
  int digits = 0;  // at least so many, with leading zeros

  std::string at(std::uint64_t frame) const;
};

// A path that ends in .gif is a movie, in .mp4 or .webm a video; one that ends in .png is a picture, or many if it has a %d or %04d. - is a
// picture on standard output. Returns why it is none of these; empty if it is one.
std::string parse_frame_path(const std::string& text, FramePath& out);

}  // namespace gyre
