#include "debug/painter.h"

namespace gyre {

namespace {

std::uint8_t to_byte(float share) { return std::uint8_t(clamp(share, 0.0f, 1.0f) * 255.0f + 0.5f); }

void append(std::vector<std::uint8_t>& out, Color color) {
  out.push_back(color.red);
  out.push_back(color.green);
  out.push_back(color.blue);
  out.push_back(color.alpha);
}

}  // namespace

Color color_of_number(std::uint32_t number) {
  // Golden-section steps give neighbouring numbers distant hues.
  const std::uint32_t golden_step = (number + 1) * 2654435769u;
  const float hue = 6.0f * (float(golden_step >> 8) / 16777216.0f);
  const auto channel = [&](float shift) {
    float h = hue + shift;
    h = h >= 6.0f ? h - 6.0f : h;
    const float wave = h < 1.0f ? h : (h < 3.0f ? 1.0f : (h < 4.0f ? 4.0f - h : 0.0f));
    return to_byte(0.25f + 0.75f * wave);
  };
  return {channel(2.0f), channel(0.0f), channel(4.0f), 255};
}

Color mix(Color a, Color b, float t) {
  t = clamp(t, 0.0f, 1.0f);
  const auto channel = [&](std::uint8_t from, std::uint8_t to) {
    return std::uint8_t(float(from) + t * (float(to) - float(from)) + 0.5f);
  };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue),
          channel(a.alpha, b.alpha)};
}

void Painter::begin(DrawLayer layer) {
  range_ = &out_.layers[int(layer)];
  *range_ = {std::uint32_t(out_.line_count()), 0, std::uint32_t(out_.point_count()), 0};
}

void Painter::line(Vec3 from, Vec3 to, Color color) {
  if (out_.line_count() >= options_.max_lines) {
    out_.cut = true;
    return;
  }
  append(out_.line_positions, from);
  append(out_.line_positions, to);
  append(out_.line_colors, color);
  append(out_.line_colors, color);
  ++range_->lines;
}

void Painter::point(Vec3 position, Color color) {
  append(out_.point_positions, position);
  append(out_.point_colors, color);
  ++range_->points;
}

void Painter::box(Vec3 low, Vec3 high, Color color) {
  const auto corner = [&](int i) {
    return Vec3{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z};
  };
  for (int i = 0; i < 8; ++i) {
    for (const int side : {1, 2, 4}) {
      if ((i & side) == 0) line(corner(i), corner(i | side), color);
    }
  }
}

void Painter::arc(Vec3 center, Vec3 u, Vec3 v, float low, float high, Color color) {
  const float turns = absolute(high - low) / (2.0f * kPi);
  const int count = 1 + int(min(turns, 8.0f) * float(clamp(options_.segments, 4, 1024)));
  Vec3 from{};
  for (int i = 0; i <= count; ++i) {
    const SinCos angle = sin_cos(low + (high - low) * float(i) / float(count));
    const Vec3 to = center + angle.cos * u + angle.sin * v;
    if (i > 0) line(from, to, color);
    from = to;
  }
}

}  // namespace gyre
