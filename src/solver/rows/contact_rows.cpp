// Rows of contacts; rows of joints are in joint_rows.cpp.
#include "solver/rows/constraint_rows.h"
#include "solver/rows/constraint_rows_common.h"

#include "math/rotation.h"
#include "solver/core/error_bounds.h"

namespace gyre {

namespace {

constexpr double kNearlyAll = 1.0 - 1.0e-6;  // of the friction cone

bool has_friction(const ContactConstraint& c) {
  return c.static_friction > 0.0f || c.dynamic_friction > 0.0f;
}

struct ContactAxes {
  DVec3 normal, tangent_1, tangent_2;
};
ContactAxes axes_of(const Manifold& manifold) {
  const Vec3 t = any_perpendicular(manifold.normal);
  return {DVec3(manifold.normal), DVec3(t), DVec3(cross(manifold.normal, t))};
}

void point_row(Row& row, DVec3 axis, const ContactPointState& point) {
  row.linear_a = -axis, row.angular_a = -cross(DVec3(point.from_a), axis);
  row.linear_b = axis, row.angular_b = cross(DVec3(point.from_b), axis);
}
void angular_row(Row& row, DVec3 axis) {
  row.linear_a = row.linear_b = {};
  row.angular_a = -axis, row.angular_b = axis;
}

const BodyMotion& motion_of(std::int32_t body, const RowFrame& frame) {
  static constexpr BodyMotion kStill{};
  return body == kNoBody ? kStill : frame.motion[body];
}

double current_separation(const ContactConstraint& c, const ContactPointState& point, const RowFrame& frame) {
  const BodyMotion &a = motion_of(c.body_a, frame), &b = motion_of(c.body_b, frame);
  const DVec3 displacement = DVec3(b.delta_position) - DVec3(a.delta_position) +
                             cross(DVec3(b.delta_rotation), DVec3(point.from_b)) -
                             cross(DVec3(a.delta_rotation), DVec3(point.from_a));
  return double(point.separation) + dot(displacement, DVec3(c.manifold->normal));
}

}  // namespace

int count_contact_rows(const ContactConstraint& c) {
  return c.point_count * (has_friction(c) ? 3 : 1) + (c.spinning_friction > 0.0f ? 1 : 0) +
         (c.rolling_friction > 0.0f ? 2 : 0);
}

// Rows of a contact with n points: tangents of all points (2 n), normals (n), twist, rolling (2).
void add_contact_rows(const ContactConstraint& c, const RowFrame& frame, float warm, RowList& list) {
  const Manifold& manifold = *c.manifold;
  const ContactAxes axes = axes_of(manifold);
  const double friction = double(manifold.sliding != 0 ? c.dynamic_friction : c.static_friction);
  const int tangents = has_friction(c) ? 2 * c.point_count : 0;
  const std::int32_t normals = list.count + tangents;
  double load = 0.0;
  for (int k = 0; k < c.point_count; ++k) load += double(manifold.points[k].normal_impulse);
  for (int k = 0; k < tangents; ++k) {
    const ContactPointState& point = manifold.points[k / 2];
    const DVec3 axis = k % 2 == 0 ? axes.tangent_1 : axes.tangent_2;
    Row& row = begin_row(list);
    row.limits = {k % 2 == 0 ? RowKind::cone : RowKind::cone_second, 0.0, 0.0, friction, normals + k / 2, 1};
    point_row(row, axis, point);
    row.target_speed = dot(DVec3(c.surface_velocity), axis);
    // Friction is stored for the contact as a whole; points share it in proportion to the load.
    if (load > 0.0)
      row.impulse =
          double(warm) * dot(DVec3(manifold.friction_impulse), axis) * double(point.normal_impulse) / load;
    end_row(row, c.body_a, c.body_b, frame);
  }
  for (int k = 0; k < c.point_count; ++k) {
    const ContactPointState& point = manifold.points[k];
    Row& row = begin_row(list);
    row.limits.low = 0.0;
    point_row(row, axes.normal, point);
    row.target_speed = -max(current_separation(c, point, frame), 0.0) / frame.substep;
    row.impulse = double(warm) * double(point.normal_impulse);
    end_row(row, c.body_a, c.body_b, frame);
  }
  if (c.spinning_friction > 0.0f) {
    Row& row = begin_row(list);
    row.limits = {RowKind::load, 0.0, 0.0, double(c.spinning_friction), normals, c.point_count};
    angular_row(row, axes.normal);
    row.impulse = double(warm) * double(manifold.twist_impulse);
    end_row(row, c.body_a, c.body_b, frame);
  }
  for (int k = 0; k < 2 && c.rolling_friction > 0.0f; ++k) {
    const DVec3 axis = k == 0 ? axes.tangent_1 : axes.tangent_2;
    Row& row = begin_row(list);
    row.limits = {k == 0 ? RowKind::cone : RowKind::cone_second,
                  0.0,
                  0.0,
                  double(c.rolling_friction),
                  normals,
                  c.point_count};
    angular_row(row, axis);
    row.impulse = double(warm) * dot(DVec3(manifold.rolling_impulse), axis);
    end_row(row, c.body_a, c.body_b, frame);
  }
}

void store_contact_impulses(const ContactConstraint& c, const FrictionSet& set, std::span<const Row> rows) {
  Manifold& manifold = *c.manifold;
  const ContactAxes axes = axes_of(manifold);
  const std::size_t points = std::size_t(c.point_count), tangents = has_friction(c) ? 2 * points : 0;
  DVec3 friction;
  double load = 0.0;
  bool slides = tangents > 0;
  for (std::size_t k = 0; k < points; ++k) {
    ContactPointState& point = manifold.points[k];
    const double normal = rows[tangents + k].impulse;
    load += normal;
    point.normal_impulse = float(normal) + 0.0f;
    point.total_impulse += point.normal_impulse;
    point.mean_impulse = point.normal_impulse;
    if (tangents == 0) continue;
    const double x = rows[2 * k].impulse, y = rows[2 * k + 1].impulse;
    friction += x * axes.tangent_1 + y * axes.tangent_2;
    // At the limit, up to rounding.
    const double radius = kNearlyAll * rows[2 * k].limits.friction * normal;
    slides =
        slides && (normal == 0.0 || nearest_friction(set, radius, x, y).region != FrictionRegion::inside);
  }
  std::size_t next = tangents + points;
  manifold.friction_impulse = to_float(friction) + Vec3{};
  manifold.total_friction += manifold.friction_impulse;
  manifold.sliding = slides && load > 0.0 ? 1u : 0u;
  manifold.twist_impulse = c.spinning_friction > 0.0f ? float(rows[next++].impulse) + 0.0f : 0.0f;
  manifold.rolling_impulse = {};
  if (c.rolling_friction > 0.0f) {
    const DVec3 rolling = rows[next].impulse * axes.tangent_1 + rows[next + 1].impulse * axes.tangent_2;
    manifold.rolling_impulse = to_float(rolling) + Vec3{};
  }
}

bool add_overlap_rows(const ContactConstraint& c, const RowFrame& frame, float step, RowList& list) {
  const Manifold& manifold = *c.manifold;
  const DVec3 normal(manifold.normal);
  const double slop = kPushoutSlop * double(c.size), max_pushout = double(c.pushout_speed) * double(step);
  bool overlaps = false;
  for (int k = 0; k < c.point_count; ++k) {
    const ContactPointState& point = manifold.points[k];
    const double over = -current_separation(c, point, frame) - slop;
    overlaps = overlaps || over > 0.0;
    Row& row = begin_row(list);
    row.limits.low = 0.0;
    point_row(row, normal, point);
    row.target_speed = over > 0.0 ? min(kPushoutShare * over, max_pushout) : over;
    end_row(row, c.body_a, c.body_b, frame, true);
  }
  return overlaps;
}

}  // namespace gyre
