#include "solver/joint/path.h"

namespace gyre {

namespace {

struct Piece {
  int number = 0;
  float t = 0.0f;
};

int piece_count(const PathCurve& path) {
  return int(path.closed ? path.points.size() : path.points.size() - 1);
}

// Parameters of a closed curve are periodic; an open curve is straight beyond its ends.
Piece piece_at(const PathCurve& path, float parameter) {
  const int count = piece_count(path);
  if (path.closed) parameter -= float(count) * std::floor(parameter / float(count));
  const int number = clamp(int(std::floor(parameter)), 0, count - 1);
  return {number, parameter - float(number)};
}

Vec3 point_at(const PathCurve& path, int i) {
  const int count = int(path.points.size());
  if (path.closed) return path.points[std::size_t((i + count) % count)].position;
  // The end pieces are mirrored beyond the ends.
  if (i < 0) return 2.0f * path.points[0].position - path.points[1].position;
  if (i >= count)
    return 2.0f * path.points[std::size_t(count - 1)].position - path.points[std::size_t(count - 2)].position;
  return path.points[std::size_t(i)].position;
}

// Knots by the square root of distance: no piece has a cusp or a loop, however the points are spaced.
float knot(Vec3 from, Vec3 to) { return std::sqrt(distance(from, to)); }

PathSample sample_piece(const PathCurve& path, Piece piece) {
  const Vec3 p0 = point_at(path, piece.number - 1), p1 = point_at(path, piece.number);
  const Vec3 p2 = point_at(path, piece.number + 1), p3 = point_at(path, piece.number + 2);
  const float d0 = knot(p0, p1), d1 = knot(p1, p2), d2 = knot(p2, p3);
  const Vec3 m1 = d1 * ((p1 - p0) / d0 - (p2 - p0) / (d0 + d1) + (p2 - p1) / d1);
  const Vec3 m2 = d1 * ((p2 - p1) / d1 - (p3 - p1) / (d1 + d2) + (p3 - p2) / d2);
  const Vec3 c1 = m1;
  const Vec3 c2 = 3.0f * (p2 - p1) - 2.0f * m1 - m2;
  const Vec3 c3 = 2.0f * (p1 - p2) + m1 + m2;
  const float end = clamp(piece.t, 0.0f, 1.0f);
  const float t = path.closed ? piece.t : end;
  PathSample s;
  s.position = p1 + t * (c1 + t * (c2 + t * c3));
  s.first = c1 + t * (2.0f * c2 + (3.0f * t) * c3);
  s.second = 2.0f * c2 + (6.0f * t) * c3;
  if (t != piece.t) {
    s.position += (piece.t - t) * s.first;
    s.second = {};
  }
  return s;
}

// The length of a piece up to `to`, by Gauss-Legendre quadrature with five nodes.
float length_of(const PathCurve& path, int number, float to) {
  constexpr float kNodes[5] = {0.046910077f, 0.23076534f, 0.5f, 0.76923466f, 0.95308992f};
  constexpr float kWeights[5] = {0.11846344f, 0.23931433f, 0.28444445f, 0.23931433f, 0.11846344f};
  float sum = 0.0f;
  for (int i = 0; i < 5; ++i) sum += kWeights[i] * length(sample_piece(path, {number, to * kNodes[i]}).first);
  return to * sum;
}

// Transports `up` from one sample of the curve to another.
Vec3 carry(const PathSample& from, const PathSample& to, Vec3 up) {
  const Vec3 offset = to.position - from.position;
  const Vec3 t0 = normalized(from.first), t1 = normalized(to.first);
  const float c = length_squared(offset);
  if (!(c > 0.0f)) return up;
  const Vec3 up_mirrored = up - (2.0f / c * dot(offset, up)) * offset;
  const Vec3 t_mirrored = t0 - (2.0f / c * dot(offset, t0)) * offset;
  const Vec3 second = t1 - t_mirrored;
  const float c2 = length_squared(second);
  const Vec3 carried =
      c2 > 0.0f ? up_mirrored - (2.0f / c2 * dot(second, up_mirrored)) * second : up_mirrored;
  return normalized(carried - dot(carried, t1) * t1, any_perpendicular(t1));
}

constexpr int kCarrySteps = 8;  // per piece

Vec3 carry_over_piece(const PathCurve& path, int number, Vec3 up) {
  PathSample from = sample_piece(path, {number, 0.0f});
  for (int i = 1; i <= kCarrySteps; ++i) {
    const PathSample to = sample_piece(path, {number, float(i) / float(kCarrySteps)});
    up = carry(from, to, up);
    from = to;
  }
  return up;
}

}  // namespace

PathSample sample_path(const PathCurve& path, float parameter) {
  return sample_piece(path, piece_at(path, parameter));
}

Quat path_frame(const PathCurve& path, float parameter) {
  const Piece piece = piece_at(path, parameter);
  const PathSample start = sample_piece(path, {piece.number, 0.0f}), here = sample_piece(path, piece);
  const Vec3 x = normalized(here.first);
  const std::size_t count = path.points.size();
  // `up` is transported from the point before, and rotated towards that of the next point in proportion.
  const Vec3 up = path.points[std::size_t(piece.number)].up;
  const Vec3 end_up = path.points[(std::size_t(piece.number) + 1) % count].up;
  const Vec3 carried = carry(start, here, up);
  const PathSample end = sample_piece(path, {piece.number, 1.0f});
  const Vec3 end_x = normalized(end.first), end_carried = carry(start, end, up);
  const float missing =
      atan2(dot(cross(end_carried, end_up), end_x), dot(end_carried, end_up)) * clamp(piece.t, 0.0f, 1.0f);
  const SinCos turn = sin_cos(missing);
  const Vec3 y = normalized(turn.cos * carried + turn.sin * cross(x, carried));
  return from_matrix({x, y, cross(x, y)});
}

float path_length(const PathCurve& path, float parameter) {
  const Piece piece = piece_at(path, parameter);
  const float rounds = path.closed ? std::floor(parameter / path.end()) : 0.0f;
  const std::size_t last = path.points.size() - 1;
  const float whole =
      path.closed ? path.points[last].along + length_of(path, int(last), 1.0f) : path.points[last].along;
  const float inside = clamp(piece.t, 0.0f, 1.0f);
  const float beyond = (piece.t - inside) * length(sample_piece(path, {piece.number, inside}).first);
  return rounds * whole + path.points[std::size_t(piece.number)].along +
         length_of(path, piece.number, inside) + beyond;
}

float nearest_on_path(const PathCurve& path, Vec3 p, float from) {
  float parameter = from;
  for (int i = 0; i < 4; ++i) {
    const PathSample s = sample_path(path, parameter);
    const Vec3 off = p - s.position;
    const float slope = length_squared(s.first);
    // Newton's step for the distance; Gauss-Newton where that would climb.
    const float curved = slope - dot(off, s.second);
    const float step = dot(off, s.first) / (curved > 0.25f * slope ? curved : slope);
    if (!is_finite(step)) return from;
    parameter += clamp(step, -1.0f, 1.0f);
  }
  return parameter;
}

float nearest_on_path(const PathCurve& path, Vec3 p) {
  float best = 0.0f, closest = length_squared(p - sample_path(path, 0.0f).position);
  const int samples = 8 * piece_count(path);
  for (int i = 1; i <= samples; ++i) {
    const float parameter = float(i) / 8.0f;
    const float far = length_squared(p - sample_path(path, parameter).position);
    if (far < closest) closest = far, best = parameter;
  }
  const float parameter = nearest_on_path(path, p, best);
  return path.closed ? parameter : clamp(parameter, 0.0f, path.end());
}

void finish_path(std::span<PathPoint> points, bool closed) {
  const PathCurve path{points, closed};
  points[0].along = 0.0f;
  const Vec3 start = normalized(sample_piece(path, {0, 0.0f}).first);
  const Vec3 up{0, 1, 0};
  points[0].up = normalized(up - dot(up, start) * start, any_perpendicular(start));
  for (std::size_t i = 1; i < points.size(); ++i) {
    points[i].along = points[i - 1].along + length_of(path, int(i) - 1, 1.0f);
    points[i].up = carry_over_piece(path, int(i) - 1, points[i - 1].up);
  }
  if (!closed) return;
  // The twist missing after one round is spread over the curve.
  const int last = int(points.size()) - 1;
  const Vec3 around = carry_over_piece(path, last, points[std::size_t(last)].up);
  const float missing = atan2(dot(cross(around, points[0].up), start), dot(around, points[0].up));
  const float whole = points[std::size_t(last)].along + length_of(path, last, 1.0f);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3 x = normalized(sample_piece(path, {int(i), 0.0f}).first);
    const SinCos turn = sin_cos(missing * points[i].along / whole);
    points[i].up = normalized(turn.cos * points[i].up + turn.sin * cross(x, points[i].up));
  }
}

}  // namespace gyre
