#include "bench/scenes/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace gyre::bench {
namespace {

constexpr double kNear = 0.02;  // m: pairs closer than this are looked at
constexpr double kDeep = 0.05;  // m
constexpr double kCell = 2.0;   // m: at least the largest moving shape

bool is_finite(const Pose& pose) {
  return std::isfinite(pose.p.x) && std::isfinite(pose.p.y) && std::isfinite(pose.p.z) &&
         std::isfinite(pose.q.w);
}

using CellIndex = std::array<int, 3>;
CellIndex cell_of(const Core& core) {
  const V3 c = 0.5 * (core.lo + core.hi);
  return {int(std::floor(c.x / kCell)), int(std::floor(c.y / kCell)), int(std::floor(c.z / kCell))};
}
std::uint64_t key_of(CellIndex c) {
  const auto bits = [](int i) { return std::uint64_t(std::uint32_t(i) & 0x1fffff); };
  return bits(c[0]) << 42 | bits(c[1]) << 21 | bits(c[2]);
}

// Calls fn(i, k) for every two cores, i before k, in the same or in neighbouring cells.
template <class Fn>
void for_each_near_pair(const std::vector<Core>& cores, Fn&& fn) {
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> grid;
  for (std::size_t i = 0; i < cores.size(); ++i) grid[key_of(cell_of(cores[i]))].push_back(i);
  for (std::size_t i = 0; i < cores.size(); ++i) {
    const CellIndex at = cell_of(cores[i]);
    for (int n = 0; n < 27; ++n) {
      const auto found = grid.find(key_of({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1}));
      if (found == grid.end()) continue;
      for (const std::size_t k : found->second) {
        if (k > i) fn(i, k);
      }
    }
  }
}

}  // namespace

Judge::Judge(const Scene& scene) : scene_(scene) {
  for (const Joint& j : scene.joints) {
    const Body &a = scene.bodies[std::size_t(j.a)], &b = scene.bodies[std::size_t(j.b)];
    const Pose pose_a{a.pos, a.q}, pose_b{b.pos, b.q};
    joints_.push_back({apply_inverse(pose_a, j.anchor), apply_inverse(pose_b, j.anchor),
                       rot(conj(a.q), j.axis), rot(conj(b.q), j.axis), conj(a.q) * b.q});
    jointed_.insert(std::minmax(j.a, j.b));
  }
  for (const Body& b : scene.bodies) {
    if (b.motion != Motion::dynamic) continue;
    low_ = {std::min(low_.x, b.pos.x), std::min(low_.y, b.pos.y), std::min(low_.z, b.pos.z)};
    high_ = {std::max(high_.x, b.pos.x), std::max(high_.y, b.pos.y), std::max(high_.z, b.pos.z)};
  }
}

Quality Judge::look(const std::vector<BodyState>& bodies) const {
  Quality q;
  look_at_bodies(bodies, q);
  if (!q.finite) return q;
  look_at_joints(bodies, q);
  look_at_overlaps(bodies, q);
  return q;
}

// Through the floor, or far outside where everything started.
bool Judge::is_lost(const Body&, V3 p) const {
  if (p.y < -3 && scene_.joints.empty()) return true;
  return p.x < low_.x - 60 || p.x > high_.x + 60 || p.z < low_.z - 60 || p.z > high_.z + 60 ||
         std::fabs(p.y) > 500;
}

void Judge::look_at_bodies(const std::vector<BodyState>& bodies, Quality& q) const {
  double speeds = 0, heights = 0;
  long moving = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = scene_.bodies[i];
    const BodyState& now = bodies[i];
    if (!is_finite(now.pose)) {
      q.finite = false;
      ++q.lost;
      continue;
    }
    if (body.motion != Motion::dynamic) continue;
    ++moving;
    const double speed = len(now.velocity);
    q.speed_max = std::max(q.speed_max, speed);
    q.spin_max = std::max(q.spin_max, len(now.spin));
    q.energy += 0.5 * mass(scene_, body) * speed * speed;
    speeds += speed;
    heights += now.pose.p.y;
    if (now.asleep) ++q.asleep;
    if (rot(now.pose.q, V3{0, 1, 0}).y < 0.5) ++q.fallen;
    if (is_lost(body, now.pose.p)) ++q.lost;
  }
  if (!q.finite) return;
  if (moving > 0) {
    q.speed_mean = speeds / double(moving);
    q.height_mean = heights / double(moving);
  }
  for (const int top : scene_.tops) {
    const V3 d = bodies[std::size_t(top)].pose.p - scene_.bodies[std::size_t(top)].pos;
    q.drift_max = std::max(q.drift_max, std::hypot(d.x, d.z));
    q.drift_mean += std::hypot(d.x, d.z) / double(scene_.tops.size());
    q.sink_max = std::max(q.sink_max, -d.y);
  }
}

void Judge::look_at_joints(const std::vector<BodyState>& bodies, Quality& q) const {
  double openings = 0, excesses = 0;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const Joint& j = scene_.joints[k];
    const JointPlace& place = joints_[k];
    const Pose &a = bodies[std::size_t(j.a)].pose, &b = bodies[std::size_t(j.b)].pose;
    const double opening = len(apply(a, place.anchor_a) - apply(b, place.anchor_b));
    openings += opening;
    q.joint_max = std::max(q.joint_max, opening);
    if (j.kind == JointKind::ball) continue;
    const double cosine = dot(rot(a.q, place.axis_a), rot(b.q, place.axis_b));
    const double between = std::acos(std::clamp(cosine, -1.0, 1.0));
    // Rotation of b against a since the start, seen from a.
    Quat d = conj(a.q) * b.q * conj(place.start);
    if (d.w < 0) d = {-d.x, -d.y, -d.z, -d.w};
    const double about = 2 * std::atan2(dot(V3{d.x, d.y, d.z}, place.axis_a), d.w);
    double excess = std::max(0.0, between - j.cone);
    if (j.kind == JointKind::hinge) excess = std::max({between, j.lo - about, about - j.hi, 0.0});
    excess *= 180 / kPi;
    q.limit_max = std::max(q.limit_max, excess);
    excesses += excess;
  }
  if (!joints_.empty()) {
    q.joint_mean = openings / double(joints_.size());
    q.limit_mean = excesses / double(joints_.size());
  }
  if (scene_.chain_end >= 0) {
    q.stretch = 100 * openings / scene_.chain_length;
    q.extension =
        100 *
        (len(bodies[std::size_t(scene_.chain_end)].pose.p - scene_.chain_root) / scene_.chain_length - 1);
  }
}

void Judge::find_overlap(const Mesh& m, const Core& core, std::vector<double>& depths) const {
  double worst = -1;
  for (const V3& p : core.v) {
    const double x = (p.x + m.size / 2) * m.n / m.size, z = (p.z + m.size / 2) * m.n / m.size;
    const int i = int(std::floor(x)), j = int(std::floor(z));
    if (i < 0 || j < 0 || i >= m.n || j >= m.n) continue;
    const int quad = (j * m.n + i) * 6;
    const auto corner = [&](int c) {
      const int first = (x - i) + (z - j) < 1 ? quad : quad + 3;
      return m.v[std::size_t(m.tri[std::size_t(first + c)])];
    };
    const V3 n = unit(cross(corner(1) - corner(0), corner(2) - corner(0)));
    worst = std::max(worst, core.r - dot(n, p - corner(0)));
  }
  if (worst > -kNear) depths.push_back(worst);
}

void Judge::find_overlap(const Core& a, const Core& b, std::vector<double>& depths) const {
  const Body &x = scene_.bodies[std::size_t(a.body)], &y = scene_.bodies[std::size_t(b.body)];
  if (a.body == b.body || (x.layer == Layer::no_self && y.layer == Layer::no_self)) return;
  if (a.lo.x > b.hi.x + kNear || a.hi.x < b.lo.x - kNear || a.lo.y > b.hi.y + kNear ||
      a.hi.y < b.lo.y - kNear || a.lo.z > b.hi.z + kNear || a.hi.z < b.lo.z - kNear) {
    return;
  }
  if (jointed_.count(std::minmax(a.body, b.body)) != 0) return;
  const double depth = -gap(a, b);
  if (depth > -kNear) depths.push_back(depth);
}

void Judge::look_at_overlaps(const std::vector<BodyState>& bodies, Quality& q) const {
  std::vector<Core> moving, others;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (const Shape& s : scene_.bodies[i].shapes) {
      if (s.kind == Kind::mesh) continue;
      const Pose t{apply(bodies[i].pose, s.local.p), bodies[i].pose.q * s.local.q};
      (scene_.bodies[i].motion == Motion::dynamic ? moving : others)
          .push_back(make_core(scene_, s, t, int(i)));
    }
  }
  std::vector<double> depths;
  for_each_near_pair(moving,
                     [&](std::size_t i, std::size_t k) { find_overlap(moving[i], moving[k], depths); });
  for (const Core& core : moving) {
    for (const Core& other : others) find_overlap(core, other, depths);
    for (const Mesh& mesh : scene_.meshes) find_overlap(mesh, core, depths);
  }
  std::sort(depths.begin(), depths.end());
  double sum = 0;
  for (const double depth : depths) {
    if (depth <= 0) continue;
    ++q.touching;
    sum += depth;
    if (depth > kDeep) ++q.deep;
  }
  q.near = long(depths.size());
  q.pen_mean = q.touching > 0 ? sum / double(q.touching) : 0;
  if (depths.empty()) return;
  q.pen_max = std::max(0.0, depths.back());
  q.pen_p99 = std::max(0.0, depths[std::size_t(0.99 * double(depths.size() - 1))]);
}

}  // namespace gyre::bench
