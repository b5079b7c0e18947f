// A few colours that stand for many. See palette.h.
#include "render/palette.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyre {
namespace {

constexpr int kCellBits = 5;  // of each part
constexpr std::array<double, 3> kWeight = {0.299, 0.587, 0.25};
constexpr int kPatternReach = 3;  // of 255: about half of what neighbouring colours of a palette differ by

using Cells = std::vector<ColorCount::Cell>;

// A run of cells, what their colours are on average, and how far they are off.
struct ColorBox {
  std::size_t begin = 0, end = 0;
  int axis = 0;
  double error = 0;
};

struct Moments {
  double count = 0;
  std::array<double, 3> sum{}, squares{};

  void add(const ColorCount::Cell& cell) {
    count += cell.count;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += cell.count * cell.mean[k];
      squares[k] += cell.count * cell.mean[k] * cell.mean[k];
    }
  }
  double error(std::size_t k) const {
    return count > 0 ? kWeight[k] * (squares[k] - sum[k] * sum[k] / count) : 0.0;
  }
  double error() const { return error(0) + error(1) + error(2); }
};

Moments moments_of(const Cells& cells, std::size_t begin, std::size_t end) {
  Moments out;
  for (std::size_t i = begin; i < end; ++i) out.add(cells[i]);
  return out;
}

ColorBox make_box(const Cells& cells, std::size_t begin, std::size_t end) {
  const Moments moments = moments_of(cells, begin, end);
  ColorBox box{begin, end, 0, moments.error()};
  for (std::size_t k = 1; k < 3; ++k) {
    if (moments.error(k) > moments.error(std::size_t(box.axis))) box.axis = int(k);
  }
  return box;
}

// Where to cut a sorted run so that both parts together err least.
std::size_t best_cut(const Cells& cells, const ColorBox& box) {
  const Moments all = moments_of(cells, box.begin, box.end);
  Moments low;
  std::size_t best = box.begin + 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = box.begin; i + 1 < box.end; ++i) {
    low.add(cells[i]);
    Moments high = all;
    high.count -= low.count;
    for (std::size_t k = 0; k < 3; ++k) {
      high.sum[k] -= low.sum[k];
      high.squares[k] -= low.squares[k];
    }
    const double error = low.error() + high.error();
    if (error < least) {
      least = error;
      best = i + 1;
    }
  }
  return best;
}

double difference_of(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += kWeight[k] * (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

void move_to_means(const Cells& cells, std::vector<std::array<double, 3>>& colors) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Moments> near(colors.size());
    for (const ColorCount::Cell& cell : cells) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < colors.size(); ++i) {
        if (difference_of(cell.mean, colors[i]) < difference_of(cell.mean, colors[best])) best = i;
      }
      near[best].add(cell);
    }
    for (std::size_t i = 0; i < colors.size(); ++i) {
      if (near[i].count == 0) continue;
      for (std::size_t k = 0; k < 3; ++k) colors[i][k] = near[i].sum[k] / near[i].count;
    }
  }
}

// Thresholds of ordered dither from -0.5 to 0.5, each cell of 8 x 8 different (B. Bayer, 1973).
float pattern(int x, int y) {
  unsigned value = 0;
  const auto column = unsigned(x), row = unsigned(y);
  for (unsigned bit = 0; bit < 3; ++bit) {
    const unsigned a = (column ^ row) >> bit & 1u, b = row >> bit & 1u;
    value |= (a << 1 | b) << (2 * (2 - bit));
  }
  return (float(value) + 0.5f) / 64.0f - 0.5f;
}

}  // namespace

ColorCount::ColorCount() : sums_(std::size_t(1) << (3 * kCellBits)) {}

void ColorCount::add(const Picture& picture) {
  for (std::size_t i = 0; i < picture.bytes.size(); i += 3) {
    std::size_t index = 0;
    for (std::size_t k = 0; k < 3; ++k) index = index << kCellBits | picture.bytes[i + k] >> (8 - kCellBits);
    Sum& sum = sums_[index];
    ++sum.count;
    for (std::size_t k = 0; k < 3; ++k) sum.parts[k] += picture.bytes[i + k];
  }
}

Cells ColorCount::cells() const {
  Cells out;
  for (const Sum& sum : sums_) {
    if (sum.count == 0) continue;
    Cell cell{{}, double(sum.count)};
    for (std::size_t k = 0; k < 3; ++k) cell.mean[k] = double(sum.parts[k]) / cell.count;
    // A colour that fills half of the picture shall not take all of the palette.
    cell.count = std::sqrt(cell.count);
    out.push_back(cell);
  }
  return out;
}

std::vector<Rgb> make_palette(const ColorCount& counted, std::size_t most) {
  Cells cells = counted.cells();
  if (cells.empty()) return {{0, 0, 0}};
  std::vector<ColorBox> boxes{make_box(cells, 0, cells.size())};
  while (boxes.size() < most) {
    const auto worst = std::max_element(
        boxes.begin(), boxes.end(), [](const ColorBox& a, const ColorBox& b) { return a.error < b.error; });
    if (worst->end - worst->begin < 2 || !(worst->error > 0)) break;
    const auto axis = std::size_t(worst->axis);
    std::stable_sort(cells.begin() + std::ptrdiff_t(worst->begin), cells.begin() + std::ptrdiff_t(worst->end),
                     [axis](const auto& a, const auto& b) { return a.mean[axis] < b.mean[axis]; });
    const std::size_t cut = best_cut(cells, *worst);
    const std::size_t end = worst->end;
    *worst = make_box(cells, worst->begin, cut);
    boxes.push_back(make_box(cells, cut, end));
  }
  std::vector<std::array<double, 3>> colors;
  for (const ColorBox& box : boxes) {
    const Moments moments = moments_of(cells, box.begin, box.end);
    colors.push_back(
        {moments.sum[0] / moments.count, moments.sum[1] / moments.count, moments.sum[2] / moments.count});
  }
  move_to_means(cells, colors);
  std::vector<Rgb> out;
  for (const auto& color : colors) {
    out.push_back({std::uint8_t(color[0] + 0.5), std::uint8_t(color[1] + 0.5), std::uint8_t(color[2] + 0.5)});
  }
  return out;
}

PaletteMap::PaletteMap(std::vector<Rgb> palette)
    : palette_(std::move(palette)), known_(std::size_t(1) << 18, -1) {}

std::uint8_t PaletteMap::nearest(int red, int green, int blue) {
  std::int16_t& known = known_[std::size_t(red >> 2 << 12 | green >> 2 << 6 | blue >> 2)];
  if (known >= 0) return std::uint8_t(known);
  // For the middle of the cell, so that the answer does not depend on who asked first.
  const std::array<double, 3> color = {double(red / 4 * 4) + 1.5, double(green / 4 * 4) + 1.5,
                                       double(blue / 4 * 4) + 1.5};
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < palette_.size(); ++i) {
    const double error =
        difference_of(color, {double(palette_[i][0]), double(palette_[i][1]), double(palette_[i][2])});
    if (error < least) {
      least = error;
      best = i;
    }
  }
  known = std::int16_t(best);
  return std::uint8_t(best);
}

std::uint8_t PaletteMap::at(const Picture& picture, int x, int y) {
  const std::uint8_t* pixel =
      &picture.bytes[3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))];
  const int shift = int(std::lround(2.0f * float(kPatternReach) * pattern(x, y)));
  const auto moved = [shift](std::uint8_t part) { return std::clamp(int(part) + shift, 0, 255); };
  return nearest(moved(pixel[0]), moved(pixel[1]), moved(pixel[2]));
}

}  // namespace gyre
