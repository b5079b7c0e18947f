// A first look at all that will be in a movie. See survey.h.
#include "render/survey.h"

#include "formats/turning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyre {
namespace {

constexpr std::size_t kMaxMoments = 48;
constexpr float kUsualFieldOfView = 0.6f;
constexpr float kShownShare = 0.98f;  // of all balls; what flies away shall not make the rest tiny

// The value below which `share` of them lie.
float quantile(std::vector<float> values, float share) {
  const auto at = std::size_t(share * float(values.size() - 1) + 0.5f);
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(at), values.end());
  return values[at];
}

// How far along a ray (unit direction) a box begins, if it is hit.
std::optional<float> enter_box(Vec3 start, Vec3 direction, const Aabb& box) {
  float begin = 0, end = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-9f) {
      if (start[axis] < box.low[axis] || start[axis] > box.high[axis]) return {};
      continue;
    }
    const float one = (box.low[axis] - start[axis]) / direction[axis];
    const float two = (box.high[axis] - start[axis]) / direction[axis];
    begin = max(begin, min(one, two));
    end = min(end, max(one, two));
  }
  if (begin > end) return {};
  return begin;
}

}  // namespace

Survey::Survey(Player& player, FramePlan& plan) {
  view_ = player.view();
  has_weight_ = player.has_weight();
  Sight sight;
  lowest_ = lowest_still_ = std::numeric_limits<double>::infinity();
  for (std::uint64_t frame = 0; frame < plan.count; ++frame) {
    if (!player.advance_to(plan.start + double(frame) * plan.interval)) {
      // A picture of the end is a picture all the same.
      plan.count = max(frame, std::uint64_t(1));
      if (frame > 0) break;
    }
    if (frame % every_ != 0) continue;
    player.look(sight);
    std::vector<float> readings;
    for (const SeenSoft& soft : sight.softs)
      readings.insert(readings.end(), soft.readings.begin(), soft.readings.end());
    readings_.add(std::move(readings));
    if (frame == 0) look_at_still(sight);
    look_at_moving(sight);
  }
}

void Survey::look_at_still(const Sight& sight) {
  for (const SeenBody& body : sight.bodies) {
    if (body.type != BodyType::fixed) continue;
    const std::span<const SeenShape> shapes = sight.shapes_of(body);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const AnyShape& shape = *shapes[i].geometry;
      if (std::holds_alternative<Plane>(shape)) {
        has_plane_ = true;
        continue;
      }
      const Aabb box = bounding_box(shape);
      if (box.low.x > box.high.x) continue;
      const Pose pose = body.pose * shapes[i].local;
      const bool solid =
          !std::holds_alternative<Geometry>(shape) || std::get<Geometry>(shape).kind() == ShapeKind::hull;
      walls_.push_back({shape_key(body.id, i), pose, box, solid});
      const Vec3 half = half_size(box);
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 side{corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f};
        const DVec3 place = pose * (center(box) + multiply_each(side, half));
        still_.push_back({place, 0.0f});
        lowest_still_ = min(lowest_still_, place.y);
      }
    }
  }
}

void Survey::look_at_moving(const Sight& sight) {
  for (const SeenBody& body : sight.bodies) {
    if (body.type == BodyType::fixed) continue;
    for (const SeenShape& shape : sight.shapes_of(body)) {
      const float radius = bounding_radius(*shape.geometry);
      const Pose pose = body.pose * shape.local;
      if (!(radius > 0.0f) || !is_finite(pose)) continue;
      moving_.push_back({pose.position, radius});
      lowest_ = min(lowest_, pose.position.y - double(radius));
    }
  }
  for (const SeenSoft& soft : sight.softs) look_at_soft(soft, sight.vertices_of(soft));
  for (const SeenFluid& fluid : sight.fluids) look_at_fluid(fluid);
  ends_.push_back(moving_.size());
  if (ends_.size() > kMaxMoments) thin_out();
}

// The vertices that lie farthest in some directions stand for all of them: so a cloth of many does not outvote all else.
void Survey::look_at_soft(const SeenSoft& soft, std::span<const DVec3> vertices) {
  constexpr Vec3 kDirections[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
  for (const Vec3 direction : kDirections) {
    const DVec3* farthest[2] = {nullptr, nullptr};
    float reach[2] = {0, 0};
    for (const DVec3& vertex : vertices) {
      if (!is_finite(vertex)) continue;
      const float far = dot(direction, difference(vertex, vertices[0]));
      for (int side = 0; side < 2; ++side) {
        const float ahead = side == 0 ? far : -far;
        if (farthest[side] == nullptr || ahead > reach[side]) farthest[side] = &vertex, reach[side] = ahead;
      }
    }
    for (const DVec3* const vertex : farthest) {
      if (vertex == nullptr) continue;
      moving_.push_back({*vertex, soft.radius});
      lowest_ = min(lowest_, vertex->y - double(soft.radius));
    }
  }
}

// The corners of its box.
void Survey::look_at_fluid(const SeenFluid& fluid) {
  const DVec3 low = fluid.lower, high = fluid.upper();
  for (int corner = 0; corner < 8; ++corner) {
    const DVec3 in_box{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
    const DVec3 at = fluid.pose == Pose{} ? in_box : fluid.pose * to_float(in_box);
    moving_.push_back({at, 0.0f});
    lowest_ = min(lowest_, at.y);
  }
}

// Every other moment goes.
void Survey::thin_out() {
  std::vector<Ball> kept;
  std::vector<std::size_t> ends;
  for (std::size_t moment = 0; moment < ends_.size(); moment += 2) {
    const std::size_t begin = moment == 0 ? 0 : ends_[moment - 1];
    kept.insert(kept.end(), moving_.begin() + std::ptrdiff_t(begin),
                moving_.begin() + std::ptrdiff_t(ends_[moment]));
    ends.push_back(kept.size());
  }
  moving_ = std::move(kept);
  ends_ = std::move(ends);
  every_ *= 2;
}

// What moves, without the few that went astray, and what stands still near it.
std::vector<Survey::Ball> Survey::important() const {
  if (moving_.empty()) return still_;
  std::vector<float> values[3];
  for (const Ball& ball : moving_) {
    const Vec3 offset = difference(ball.center, moving_[0].center);
    for (int axis = 0; axis < 3; ++axis) values[axis].push_back(offset[axis]);
  }
  Vec3 middle;
  middle = {quantile(values[0], 0.5f), quantile(values[1], 0.5f), quantile(values[2], 0.5f)};
  std::vector<float> away;
  for (const Ball& ball : moving_)
    away.push_back(distance(difference(ball.center, moving_[0].center), middle));
  const float usual = quantile(away, kShownShare);
  std::vector<Ball> out;
  float reach = 0;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (away[i] > 1.5f * usual + 2.0f * moving_[i].radius) continue;
    out.push_back(moving_[i]);
    reach = max(reach, away[i] + moving_[i].radius);
  }
  for (const Ball& ball : still_) {
    const float far = distance(difference(ball.center, moving_[0].center), middle) + ball.radius;
    if (far < 2.0f * reach) out.push_back(ball);
  }
  return out;
}

Camera Survey::camera(const CameraWish& wish, int width, int height) const {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.field_of_view = wish.field_of_view.value_or(kUsualFieldOfView);
  const bool wished = wish.eye || wish.target || wish.given_direction;
  if (view_ && !wished) {
    camera.eye = view_->eye;
    camera.target = view_->target;
    camera.field_of_view = wish.field_of_view.value_or(view_->field_of_view);
  } else if (wish.eye && wish.target) {
    camera.eye = *wish.eye;
    camera.target = *wish.target;
  } else {
    const std::vector<Ball> balls = important();
    const DVec3 base = wish.target ? *wish.target : balls.empty() ? DVec3{} : balls[0].center;
    const Turn turn = turn_of(wish.azimuth), rise = turn_of(wish.elevation);
    Vec3 back{rise.cosine * turn.sine, rise.sine, rise.cosine * turn.cosine};
    const CameraAxes axes = axes_towards(back);
    // The middle of what is seen, then so far away that all of it is within the picture's edges.
    Aabb seen{{0, 0, 0}, {0, 0, 0}};
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Vec3 offset = difference(balls[i].center, base);
      const Vec3 place{dot(axes.right, offset), dot(axes.up, offset), dot(axes.back, offset)};
      const Aabb ball = grow({place, place}, balls[i].radius);
      seen = i == 0 ? ball : merge(seen, ball);
    }
    const Vec3 middle = center(seen);
    camera.target = wish.target ? *wish.target
                                : base + (middle.x * axes.right + middle.y * axes.up + middle.z * axes.back);
    if (wish.eye) {
      camera.eye = *wish.eye;
      return camera;
    }
    const float up_slope = tangent(0.5f * camera.field_of_view);
    const float side_slope = up_slope * float(width) / float(height);
    float away = 1e-3f;
    for (const Ball& ball : balls) {
      const Vec3 offset = difference(ball.center, camera.target);
      const auto needed = [&](Vec3 axis, float slope) {
        return std::abs(dot(axis, offset)) / slope + dot(axes.back, offset) +
               ball.radius * std::sqrt(1.0f + 1.0f / (slope * slope));
      };
      away = max(away, max(needed(axes.right, side_slope), needed(axes.up, up_slope)));
    }
    camera.eye = camera.target + (1.04f * away) * axes.back;
  }
  if (wish.zoom != 1.0f)
    camera.eye = camera.target + (1.0 / double(wish.zoom)) * (camera.eye - camera.target);
  return camera;
}

Subject Survey::subject(const Camera& camera) const {
  Subject subject;
  subject.origin = camera.target;
  const double away = length(camera.eye - camera.target);
  subject.radius = float(away) * tangent(0.5f * camera.field_of_view) *
                   float(max(camera.width, camera.height)) / float(camera.height);
  subject.radius = max(subject.radius, 1e-3f);
  // As thick as suits the picture: a hundred-and-fiftieth of its height.
  subject.rod_radius = float(away) * tangent(0.5f * camera.field_of_view) / 150.0f;
  if (!has_plane_ && has_weight_) {
    const double lowest = still_.empty() ? lowest_ : lowest_still_;
    if (is_finite(lowest)) subject.floor = lowest;
  }
  return subject;
}

std::set<ShapeKey> Survey::hiding(const Camera& camera) const {
  constexpr float kTooMuch = 0.05f;
  std::set<ShapeKey> out;
  // A few thousand lines of sight say enough.
  const std::size_t stride = moving_.size() / 4096 + 1;
  std::size_t lines = 0;
  std::vector<std::size_t> hidden(walls_.size());
  for (std::size_t i = 0; i < moving_.size(); i += stride) {
    const PicturePoint seen = project(camera, moving_[i].center);
    if (seen.depth <= 0 || seen.x < 0 || seen.y < 0 || seen.x > float(camera.width) ||
        seen.y > float(camera.height)) {
      continue;
    }
    ++lines;
    for (std::size_t k = 0; k < walls_.size(); ++k) {
      if (!walls_[k].solid) continue;
      const Vec3 start = inverse_times(walls_[k].pose, camera.eye);
      const Vec3 way = inverse_times(walls_[k].pose, moving_[i].center) - start;
      const float far = length(way);
      const std::optional<float> hit = enter_box(start, normalized(way), walls_[k].box);
      if (hit && *hit < far - moving_[i].radius) ++hidden[k];
    }
  }
  for (std::size_t k = 0; k < walls_.size(); ++k) {
    if (float(hidden[k]) > kTooMuch * float(lines)) out.insert(walls_[k].key);
  }
  return out;
}

}  // namespace gyre
