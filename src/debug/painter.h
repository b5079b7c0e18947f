// The painter of draw_debug: coloured lines and points in layers.
#pragma once

#include "debug/flat.h"

#include <gyre/debug.h>

namespace gyre {

struct Color {
  std::uint8_t red = 255, green = 255, blue = 255, alpha = 255;
};

// A fixed colour for each number; neighbouring numbers get distant hues.
Color color_of_number(std::uint32_t number);
// t = 0: a, t = 1: b.
Color mix(Color a, Color b, float t);

class Painter {
 public:
  Painter(const DrawOptions& options, DebugDraw& out) : options_(options), out_(out) {}

  bool wants(DrawLayer layer) const { return (options_.layers & draw_bit(layer)) != 0; }
  // Starts a layer. Layers are drawn in order, each at most once.
  void begin(DrawLayer layer);
  void line(Vec3 from, Vec3 to, Color color);
  void point(Vec3 position, Color color);
  void box(Vec3 low, Vec3 high, Color color);
  // An arc about `center` from angle `low` to `high` (rad); u is angle 0 and v a quarter turn.
  void arc(Vec3 center, Vec3 u, Vec3 v, float low, float high, Color color);
  void ellipse(Vec3 center, Vec3 u, Vec3 v, Color color) { arc(center, u, v, 0.0f, 2.0f * kPi, color); }
  const DrawOptions& options() const { return options_; }

 private:
  const DrawOptions& options_;
  DebugDraw& out_;
  DebugDraw::Range* range_ = nullptr;
};

}  // namespace gyre
