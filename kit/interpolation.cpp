// Poses between two steps. See gyre/kit/interpolation.h.
#include <gyre/kit/interpolation.h>

#include <algorithm>
#include <cmath>

namespace gyre::kit {

namespace {

constexpr std::uint32_t kNowhere = 0xffffffffu;

}  // namespace

int FixedTimestep::advance(double seconds) {
  if (!std::isfinite(seconds) || !(seconds > 0) || !(step > 0)) return 0;
  const double length = double(step);
  left_ = std::min(left_ + seconds, length * (double(max_steps) + 0.999));
  const int steps = std::min(int(left_ / length), max_steps);
  left_ = std::max(left_ - double(steps) * length, 0.0);
  left_ = std::min(left_, length);
  return steps;
}

void Interpolation::capture(const World& world) {
  std::swap(ids_, old_ids_);
  std::swap(now_, old_now_);
  const BodyColumns columns = world.bodies();
  ids_.assign(columns.ids.begin(), columns.ids.end());
  now_.assign(columns.poses.begin(), columns.poses.end());
  before_ = now_;
  // Both lists ascend by index.
  std::size_t old = 0;
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    while (old < old_ids_.size() && old_ids_[old].index < ids_[i].index) ++old;
    if (old < old_ids_.size() && old_ids_[old] == ids_[i]) before_[i] = old_now_[old];
  }
  at_.assign(ids_.empty() ? 0 : std::size_t(ids_.back().index) + 1, kNowhere);
  for (std::size_t i = 0; i < ids_.size(); ++i) at_[ids_[i].index] = std::uint32_t(i);
  for (const BodyId body : teleported_) {
    if (body.index < at_.size() && at_[body.index] != kNowhere)
      before_[at_[body.index]] = now_[at_[body.index]];
  }
  teleported_.clear();
}

void Interpolation::teleport(BodyId body) { teleported_.push_back(body); }

Pose Interpolation::blend(std::size_t i, float alpha) const {
  const float t = alpha < 0 ? 0.0f : alpha > 1 ? 1.0f : alpha;
  const DVec3 way = now_[i].position - before_[i].position;
  return {before_[i].position + double(t) * way, slerp(before_[i].orientation, now_[i].orientation, t)};
}

Pose Interpolation::pose(BodyId body, float alpha) const {
  if (body.index >= at_.size() || at_[body.index] == kNowhere) return {};
  const std::size_t i = at_[body.index];
  return ids_[i] == body ? blend(i, alpha) : Pose{};
}

void Interpolation::poses(float alpha, std::span<Pose> out) const {
  for (std::size_t i = 0; i < ids_.size() && i < out.size(); ++i) out[i] = blend(i, alpha);
}

}  // namespace gyre::kit
