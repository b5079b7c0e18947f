// Stress and strain as colours. See soft_reading.h.
#include "render/soft_reading.h"

#include "scene/number_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace gyre {
namespace {

// The share of vertices beyond each end of the key.
constexpr double kBeyond = 0.01;

std::vector<float> elements_of(const World& world, SoftId soft, SoftReading reading) {
  const auto read = [&](auto&& with) {
    std::vector<float> out(with(std::span<float>{}));
    with(std::span<float>(out));
    return out;
  };
  if (reading == SoftReading::strain)
    return read([&](std::span<float> out) { return world.soft_strain(soft, out); });
  return read([&](std::span<float> out) { return world.solid_stress(soft, out); });
}

// The corners of the elements, and how many each has.
std::vector<std::uint32_t> corners_of(const World& world, SoftId soft, std::size_t& each) {
  const SoftKind kind = world.soft_info(soft).kind;
  std::vector<std::uint32_t> out;
  each = kind == SoftKind::rope ? 2 : kind == SoftKind::cloth ? 3 : 4;
  if (kind == SoftKind::rope) {
    for (std::uint32_t i = 0; i + 1 < std::uint32_t(world.vertices(soft).size()); ++i)
      out.insert(out.end(), {i, i + 1});
  } else if (kind == SoftKind::cloth) {
    const std::span<const std::uint32_t> triangles = world.soft_triangles(soft);
    out.assign(triangles.begin(), triangles.end());
  } else {
    out.resize(world.solid_tetrahedra(soft, {}));
    (void)world.solid_tetrahedra(soft, out);
  }
  return out;
}

// ------------------------------------------------------------------------------------------------------- the key's letters

constexpr int kGlyphWidth = 5, kGlyphHeight = 7;
struct Glyph {
  char letter;
  std::array<std::uint8_t, kGlyphHeight> rows;  // from the top; the highest of five bits is at the left
};
// The letters of numbers and units.
constexpr Glyph kGlyphs[] = {
    {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},
    {'2', {14, 17, 1, 2, 4, 8, 31}},     {'3', {31, 2, 4, 2, 1, 17, 14}},
    {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
    {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},
    {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 2, 12}},
    {'.', {0, 0, 0, 0, 0, 12, 12}},      {'-', {0, 0, 0, 31, 0, 0, 0}},
    {'+', {0, 4, 4, 31, 4, 4, 0}},       {'e', {0, 0, 14, 17, 31, 16, 14}},
    {'%', {24, 25, 2, 4, 8, 19, 3}},     {'P', {30, 17, 17, 30, 16, 16, 16}},
    {'a', {0, 0, 14, 1, 15, 17, 15}},    {'k', {16, 16, 18, 20, 24, 20, 18}},
    {'M', {17, 27, 21, 21, 17, 17, 17}}, {'G', {14, 17, 16, 23, 17, 17, 15}},
};

void paint(Picture& picture, int x, int y, SceneColor color) {
  if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
  std::uint8_t* const at = &picture.bytes[3 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x))];
  at[0] = color.red, at[1] = color.green, at[2] = color.blue;
}
void fill(Picture& picture, int x, int y, int width, int height, SceneColor color) {
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) paint(picture, x + i, y + j, color);
}

int width_of(std::string_view text, int size) { return int(text.size()) * (kGlyphWidth + 1) * size - size; }

void write_text(Picture& picture, int x, int y, std::string_view text, int size, SceneColor color) {
  for (const char letter : text) {
    for (const Glyph& glyph : kGlyphs) {
      if (glyph.letter != letter) continue;
      for (int row = 0; row < kGlyphHeight; ++row)
        for (int column = 0; column < kGlyphWidth; ++column)
          if ((glyph.rows[std::size_t(row)] >> (kGlyphWidth - 1 - column) & 1) != 0)
            fill(picture, x + column * size, y + row * size, size, size, color);
    }
    x += (kGlyphWidth + 1) * size;
  }
}

}  // namespace

std::vector<float> read_by_vertex(const World& world, SoftId soft, SoftReading reading) {
  std::vector<float> elements;
  if (reading != SoftReading::none) elements = elements_of(world, soft, reading);
  if (elements.empty()) return {};
  std::size_t each = 0;
  const std::vector<std::uint32_t> corners = corners_of(world, soft, each);
  std::vector<float> sum(world.vertices(soft).size(), 0.0f), count(sum.size(), 0.0f);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    sum[corners[k]] += elements[k / each];
    count[corners[k]] += 1.0f;
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0.0f) sum[i] /= count[i];
  return sum;
}

void RangeFinder::add(std::vector<float> readings) {
  std::erase_if(readings, [](float one) { return !std::isfinite(one); });
  if (readings.empty()) return;
  std::sort(readings.begin(), readings.end());
  const auto beyond = std::size_t(kBeyond * double(readings.size()));
  range_.low = std::min(range_.low, double(readings[beyond]));
  range_.high = std::max(range_.high, double(readings[readings.size() - 1 - beyond]));
}

ReadingRange RangeFinder::range() const {
  const double least = 1e-3 * (range_.high - range_.low);
  return {range_.low > -least ? 0.0 : range_.low, range_.high < least ? 0.0 : range_.high};
}

SceneColor reading_color(float value, const ReadingRange& range) {
  using Color3 = std::array<double, 3>;
  constexpr Color3 kStops[] = {{38, 70, 196}, {46, 166, 208}, {128, 200, 104}, {244, 200, 64}, {214, 48, 36}};
  const double width = range.high - range.low;
  const double part = width > 0.0 ? (double(value) - range.low) / width : 0.0;
  const double at = 4.0 * std::clamp(std::isfinite(part) ? part : 1.0, 0.0, 1.0);
  const auto stop = std::size_t(std::min(int(at), 3));
  const auto mixed = [&](std::size_t k) {
    return std::uint8_t(kStops[stop][k] + (at - double(stop)) * (kStops[stop + 1][k] - kStops[stop][k]) +
                        0.5);
  };
  return {mixed(0), mixed(1), mixed(2)};
}

std::string key_label(double value, SoftReading reading) {
  // Two digits, or all before the point.
  const auto label = [](double number, const char* unit) {
    return rounded(number, std::abs(number) < 99.5 ? 2 : std::abs(number) < 999.5 ? 3 : 4) + unit;
  };
  if (reading == SoftReading::strain) return label(100.0 * value, " %");
  const double size = std::abs(value);
  if (size >= 1e9) return label(1e-9 * value, " GPa");
  if (size >= 1e6) return label(1e-6 * value, " MPa");
  if (size >= 1e3) return label(1e-3 * value, " kPa");
  return label(value, " Pa");
}

void draw_key(const ReadingRange& range, SoftReading reading, Picture& picture) {
  constexpr SceneColor kInk{32, 36, 44}, kPaper{246, 247, 249};
  const int size = std::max(1, picture.height / 300);
  const std::string high = key_label(range.high, reading), low = key_label(range.low, reading);
  const int edge = 4 * size, bar = 10 * size, text = std::max(width_of(high, size), width_of(low, size));
  const int height = std::max(picture.height / 3, 3 * kGlyphHeight * size);
  const int width = 3 * edge + bar + text, left = picture.width - width - edge,
            top = (picture.height - height) / 2;
  fill(picture, left, top - edge, width, height + 2 * edge, kPaper);
  for (int y = 0; y < height; ++y) {
    const double part = height > 1 ? double(height - 1 - y) / double(height - 1) : 0.0;
    const double value = range.low + part * (range.high - range.low);
    fill(picture, left + edge, top + y, bar, 1, reading_color(float(value), range));
  }
  const int at = left + 2 * edge + bar;
  write_text(picture, at, top, high, size, kInk);
  write_text(picture, at, top + height - kGlyphHeight * size, low, size, kInk);
}

}  // namespace gyre
