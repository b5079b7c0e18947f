// Particles against walls and solids.
#include "fluid/liquid/particle_collision.h"

namespace gyre {

namespace {

constexpr float kStride = 0.2f;  // edges: between the points of a path that are looked at

}  // namespace

ParticleCollision::ParticleCollision(const LiquidPass& pass)
    : pass_(pass), has_solids_(pass.solids.present()) {
  edge_ = 1.0e30f;
  for (int axis = 0; axis < 3; ++axis) {
    axes_[axis] = particle_axis(pass.grid.box, axis);
    if (!pass.flat(axis) && pass.edge(axis) < edge_) edge_ = pass.edge(axis);
  }
  diagonal_ = 1.01f * length(pass.box().cell);
  if (!has_solids_) return;
  const GridShape& shape = pass.shape();
  const BodyCoupling& coupling = pass.memory.coupling;
  Array<double> sums;
  Array<int> counts;
  sums.resize(3 * std::size_t(pass.solids.labels), 0.0);
  counts.resize(3 * std::size_t(pass.solids.labels), 0);
  for (const CutFace& face : coupling.faces) {
    sums[3 * face.label + face.axis] += double(face.told);
    ++counts[3 * face.label + face.axis];
  }
  for (int label = 0; label < pass.solids.labels; ++label) {
    Motion motion;
    const SolidMotion& solid = coupling.solids[label];
    if (solid.has_body) {
      motion.center = {float(solid.center[0]), float(solid.center[1]), float(solid.center[2])};
      motion.velocity = {float(solid.motion[0]), float(solid.motion[1]), float(solid.motion[2])};
      motion.spin = {float(solid.motion[3]), float(solid.motion[4]), float(solid.motion[5])};
    } else {
      float mean[3];
      for (int axis = 0; axis < 3; ++axis) {
        const int at = 3 * label + axis;
        mean[axis] = counts[at] > 0 ? float(sums[at] / double(counts[at])) : 0.0f;
      }
      motion.velocity = {mean[0], mean[1], mean[2]};
    }
    motions_.push_back(motion);
  }
  if (!pass.solids.distance.empty()) {
    distance_ = pass.solids.distance.data();
    has_exact_ = true;
    return;
  }
  // Half an edge within solids and without, in proportion between: the fraction of the cell's faces that is open.
  derived_.resize(std::size_t(shape.size), edge_);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      float open = 0.0f;
      for (int axis = 0; axis < 3; ++axis)
        open += pass.solids.open[axis][i] + pass.solids.open[axis][i + shape.stride(axis)];
      derived_[i] = pass.solids.solid[i] != 0 ? -0.5f * edge_
                    : open < 6.0f             ? edge_ * (open / 6.0f - 0.4f)
                                              : edge_;
    }
  });
  distance_ = derived_.data();
}

Vec3 ParticleCollision::velocity_at(int label, Vec3 point) const {
  const Motion& motion = motions_[label];
  const Vec3 shift = to_float(image_shift(pass_.box(), DVec3(point), DVec3(motion.center)));
  return motion.velocity + cross(motion.spin, point - motion.center + shift);
}

float ParticleCollision::distance_at(Vec3 point) const {
  return sample_field(pass_.box(), pass_.shape(), distance_, -1, point - pass_.memory.window.origin());
}

void ParticleCollision::avoid_solids(int particle, const float (&from)[3], float (&to)[3]) const {
  const GridShape& shape = pass_.shape();
  int index[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int i = int(from[axis] / pass_.edge(axis)) - pass_.memory.window.first[axis],
              last = shape.cells[axis] - 1;
    index[axis] = i < 0 ? 0 : i < last ? i : last;
  }
  const int here = shape.at(index[0], index[1], index[2]);
  Vec3 begin{from[0], from[1], from[2]}, end{to[0], to[1], to[2]};
  int label = pass_.solids.nearest.empty() ? -1 : pass_.solids.nearest[here];
  if (pass_.solids.nearest.empty()) {
    for (int axis = 0; axis < 3 && label < 0; ++axis) {
      label = pass_.solids.label[axis][here];
      if (label < 0) label = pass_.solids.label[axis][here + shape.stride(axis)];
    }
  }
  // The path as the solid sees it from where it stood at the beginning of the step.
  Vec3 shift_begin{}, shift_end{};
  if (label >= 0 && label < int(motions_.size())) {
    const Vec3 speed = velocity_at(label, begin);
    shift_begin = pass_.elapsed * speed;
    shift_end = (pass_.elapsed + pass_.step) * speed;
  }
  begin -= shift_begin;
  end -= shift_end;
  const float skin = kParticleSkin * edge_;
  const Vec3 way = end - begin;
  const float span = length(way);
  // Values between centres are at most the diagonal of a cell less than that at the nearest one.
  if (has_exact_ && distance_[here] - diagonal_ - length(shift_begin) > span + skin) return;
  // Farther from every solid than the way is long.
  if (distance_at(begin) > span + skin && distance_at(end) > skin) return;
  const int points = 1 + int(min(span / (kStride * edge_), 64.0f));
  Vec3 reached = begin;
  bool hit = false;
  for (int i = 1; i <= points; ++i) {
    const Vec3 next = i == points ? end : begin + (float(i) / float(points)) * way;
    reached = next;
    if (distance_at(next) < skin) {
      hit = true;
      break;
    }
  }
  if (!hit) return;
  // Out along the slope of the distance, and on along the surface by what is left of the way.
  const auto push_out = [&](Vec3 at) {
    for (int round = 0; round < 4; ++round) {
      const float d = distance_at(at);
      if (d >= skin) break;
      const float e = 0.5f * edge_;
      Vec3 slope{};
      if (!pass_.flat(0)) slope.x = distance_at(at + Vec3{e, 0, 0}) - distance_at(at - Vec3{e, 0, 0});
      if (!pass_.flat(1)) slope.y = distance_at(at + Vec3{0, e, 0}) - distance_at(at - Vec3{0, e, 0});
      if (!pass_.flat(2)) slope.z = distance_at(at + Vec3{0, 0, e}) - distance_at(at - Vec3{0, 0, e});
      const float size = length(slope);
      if (!(size > 0.0f)) break;
      at += ((skin - d) / size) * slope;
    }
    return at;
  };
  const Vec3 out = push_out(reached);
  Vec3 rest = end - reached;
  const Vec3 outward = out - reached;
  const float square = dot(outward, outward);
  if (square > 0.0f && dot(rest, outward) < 0.0f) rest -= (dot(rest, outward) / square) * outward;
  Vec3 slid = out + rest;
  if (distance_at(slid) < skin) slid = distance_at(out) >= 0.0f ? out : push_out(slid);
  slid += shift_end;
  to[0] = slid.x, to[1] = slid.y, to[2] = slid.z;
  if (square > 0.0f && flies(from))
    stop(particle, label >= 0 && label < int(motions_.size()) ? velocity_at(label, begin) : Vec3{}, outward);
}

void ParticleCollision::stop(int particle, Vec3 solid, Vec3 outward) const {
  Array<float>(&motion)[3] = pass_.grid.motion;
  const Vec3 velocity{motion[0][particle], motion[1][particle], motion[2][particle]};
  const float into = dot(velocity - solid, outward) / dot(outward, outward);
  if (!(into < 0.0f)) return;
  for (int axis = 0; axis < 3; ++axis)
    if (!pass_.flat(axis)) motion[axis][particle] -= into * part_along(outward, axis);
}

bool ParticleCollision::flies(const float (&from)[3]) const {
  int index[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int low = pass_.wraps(axis) ? -1 : 0,
              last = pass_.shape().cells[axis] - (pass_.wraps(axis) ? 1 : 2);
    const float place = from[axis] / pass_.edge(axis) - 0.5f - float(pass_.memory.window.first[axis]);
    const int i = place > 0.0f ? int(place) : low;
    index[axis] = pass_.flat(axis) ? 0 : i > last ? last : i;
  }
  return pass_.memory.wet[pass_.shape().at(index[0], index[1], index[2])] == 0;
}

void ParticleCollision::finish(int particle, const float (&from)[3], float (&to)[3]) const {
  LiquidGrid& grid = pass_.grid;
  if (has_solids_) avoid_solids(particle, from, to);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass_.flat(axis)) continue;
    const ParticleAxis& limits = axes_[axis];
    float at = to[axis];
    float& speed = grid.motion[axis][particle];
    if (limits.wraps) {
      if (at < 0.0f) at += limits.length;
      if (at >= limits.length) at -= limits.length;
    }
    if (at < limits.lower_limit) at = limits.lower_limit, speed = max(speed, limits.lower_speed);
    if (at > limits.upper_limit) at = limits.upper_limit, speed = min(speed, limits.upper_speed);
    grid.position[axis][particle] = at;
  }
}

}  // namespace gyre
