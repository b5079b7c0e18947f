// Round bars along lines of points. See tube.h.
#include "render/tube.h"

#include "formats/turning.h"

namespace gyre {
namespace {

float length_of(const std::vector<Vec3>& line) {
  float sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += distance(line[i - 1], line[i]);
  return sum;
}

std::vector<Vec3> sagging(Vec3 from, Vec3 to, Vec3 sag) {
  constexpr int kPieces = 24;
  std::vector<Vec3> line;
  for (int i = 0; i <= kPieces; ++i) {
    const float t = float(i) / float(kPieces);
    line.push_back(from + t * (to - from) + 4.0f * t * (1.0f - t) * sag);
  }
  return line;
}

}  // namespace

std::vector<Vec3> hanging_line(Vec3 from, Vec3 to, float length, Vec3 down) {
  if (length <= 1.001f * distance(from, to)) return {from, to};
  float low = 0, high = length;
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5f * (low + high);
    (length_of(sagging(from, to, middle * down)) < length ? low : high) = middle;
  }
  return sagging(from, to, low * down);
}

std::vector<Vec3> coil_line(Vec3 from, Vec3 to, float radius, int turns) {
  constexpr int kPointsATurn = 16;
  constexpr float kEnd = 0.08f;  // share of the length that is straight at each end
  const Vec3 along = to - from;
  const Vec3 axis = normalized(along, Vec3{0, 1, 0});
  const Vec3 side = any_perpendicular(axis), other = cross(axis, side);
  std::vector<Vec3> line{from};
  const int points = turns * kPointsATurn;
  for (int i = 0; i <= points; ++i) {
    const float t = float(i) / float(points);
    const Turn turn = turn_of(2.0f * kHalfTurn * float(i) / float(kPointsATurn));
    line.push_back(from + (kEnd + (1.0f - 2.0f * kEnd) * t) * along +
                   radius * (turn.cosine * side + turn.sine * other));
  }
  line.push_back(to);
  return line;
}

std::vector<TubePoint> tube_rings(const std::vector<Vec3>& line, float radius, int sides) {
  std::vector<TubePoint> out;
  Vec3 side;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 before = line[i] - line[i > 0 ? i - 1 : i],
               after = line[i + 1 < line.size() ? i + 1 : i] - line[i];
    const Vec3 along = normalized(normalized(before, Vec3{}) + normalized(after, Vec3{}), Vec3{0, 1, 0});
    // Carried along from ring to ring, so that the tube does not twist.
    side = i == 0 ? any_perpendicular(along) : side - dot(side, along) * along;
    side = normalized(side, any_perpendicular(along));
    const Vec3 other = cross(along, side);
    for (int k = 0; k <= sides; ++k) {
      const Turn turn = turn_of(2.0f * kHalfTurn * float(k) / float(sides));
      const Vec3 normal = turn.cosine * side + turn.sine * other;
      out.push_back({line[i] + radius * normal, normal});
    }
  }
  return out;
}

}  // namespace gyre
