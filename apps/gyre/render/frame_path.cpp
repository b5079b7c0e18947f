// What --out asks for. See frame_path.h.
#include "render/frame_path.h"

namespace gyre {
namespace {

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Reads the number's place at `at`, just beyond a percent sign: "d", "04d" or "%" for itself.
std::string parse_place(const std::string& text, std::size_t& at, FramePath& out) {
  constexpr const char* kExpected =
      "expected one %d or %04d for the number of the frame (and %% for a percent sign)";
  int digits = 0;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9' && digits < 100)
    digits = 10 * digits + (text[at++] - '0');
  if (at >= text.size() || text[at] != 'd' || digits > 18) return "found " + text + ", " + kExpected;
  if (out.kind == OutputKind::numbered) return "found two numbers in " + text + ", " + kExpected;
  out.kind = OutputKind::numbered;
  out.digits = digits;
  return {};
}

}  // namespace

std::string FramePath::at(std::uint64_t frame) const {
  if (kind != OutputKind::numbered) return before;
  std::string number = std::to_string(frame);
  if (int(number.size()) < digits) number.insert(0, std::size_t(digits) - number.size(), '0');
  return before + number + after;
}

std::string parse_frame_path(const std::string& text, FramePath& out) {
  out = {};
  const bool video = ends_with(text, ".mp4") || ends_with(text, ".webm");
  const bool movie = ends_with(text, ".gif") || video;
  if (!movie && !ends_with(text, ".png") && text != "-")
    return "found " + text + ", expected a path that ends in .png, .gif, .mp4 or .webm, or - for a PNG on standard output";
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string& part = out.kind == OutputKind::numbered ? out.after : out.before;
    if (text[i] != '%') {
      part += text[i];
    } else if (i + 1 < text.size() && text[i + 1] == '%') {
      part += text[++i];
    } else {
      const std::string problem = parse_place(text, ++i, out);
      if (!problem.empty()) return problem;
    }
  }
  if (movie && out.kind == OutputKind::numbered)
    return "found " + text + ", a movie is one file without a number";
  if (movie) out.kind = video ? OutputKind::video : OutputKind::movie;
  return {};
}

}  // namespace gyre
