// A few colours that stand for many, and which of them a pixel gets.
#pragma once

#include "render/picture.h"

#include <array>
#include <cstdint>
#include <vector>

namespace gyre {

using Rgb = std::array<std::uint8_t, 3>;

// Counts the colours of pictures, in cells of 8 values a side.
class ColorCount {
 public:
  ColorCount();
  void add(const Picture& picture);

  struct Cell {
    std::array<double, 3> mean;
    double count;
  };
  std::vector<Cell> cells() const;  // those that are not empty, in a fixed order

 private:
  struct Sum {
    std::uint64_t parts[3] = {0, 0, 0};
    std::uint64_t count = 0;
  };
  std::vector<Sum> sums_;
};

// At most `most` colours for what was counted: the box of colours that errs most is cut where that helps most, again and again (as
// in X. Wu, "Efficient statistical computations for optimal color quantization", 1991), then each colour moves to the mean of
// those that are nearest to it (S. Lloyd, 1982). Differences in green count most and in blue least, as the eye has it.
std::vector<Rgb> make_palette(const ColorCount& colors, std::size_t most);

// The number of the nearest colour of a palette, for pixels that are moved by a fixed pattern so that smooth areas stay smooth.
class PaletteMap {
 public:
  explicit PaletteMap(std::vector<Rgb> palette);
  const std::vector<Rgb>& palette() const { return palette_; }
  std::uint8_t at(const Picture& picture, int x, int y);

 private:
  std::uint8_t nearest(int red, int green, int blue);

  std::vector<Rgb> palette_;
  std::vector<std::int16_t> known_;  // by colour in cells of 4 values a side; -1: not asked for yet
};

}  // namespace gyre
