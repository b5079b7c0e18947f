// draw_debug: lines and points of every requested layer, from the same tables that users read. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/draw_soft.h"
#include "rigid/sleep/island.h"
#include "world/world_access.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr Color kGrey{150, 150, 150, 255};
constexpr Color kWhite{255, 255, 255, 255};
constexpr Color kRed{235, 64, 52, 255};
constexpr Color kGreen{72, 199, 92, 255};
constexpr Color kBlue{66, 135, 245, 255};
constexpr Color kYellow{245, 208, 66, 255};
constexpr Color kOrange{245, 145, 44, 255};
constexpr Color kViolet{171, 104, 240, 255};
constexpr Color kTeal{52, 195, 195, 255};
constexpr Color kDark{60, 66, 84, 255};

Color rest_color(RestState state, float still_time) {
  switch (state) {
    case RestState::fixed:
      return kGrey;
    case RestState::kinematic:
      return kTeal;
    case RestState::moving:
      return kRed;
    case RestState::resting:
      return mix(kOrange, kGreen, still_time / kTimeToSleep);
    case RestState::asleep:
      return kBlue;
    case RestState::frozen:
      return kViolet;
    case RestState::disabled:
      return kDark;
  }
  return kWhite;
}

Color contact_color(ContactState state) {
  switch (state) {
    case ContactState::idle:
      return kGrey;
    case ContactState::pressing:
      return kGreen;
    case ContactState::sliding:
      return kOrange;
    case ContactState::sensor:
      return kTeal;
  }
  return kWhite;
}

class Drawing {
 public:
  Drawing(const World& world, const DrawOptions& options, DebugDraw& out)
      : world_(world), w_(state_of(world).rigid), paint_(options, out) {
    read_bodies(world, options.origin, bodies_);
    row_.assign(w_.bodies.motion.size(), 0);
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) row_[bodies_.ids[i].index] = i;
  }

  void draw();

 private:
  void geometry();
  void boxes(DrawLayer layer, std::uint32_t kinds);
  void contact_points(const ContactTable& contacts);
  void contact_normals(const ContactTable& contacts);
  void contact_forces(const ContactTable& contacts);
  void friction_basis(const ContactTable& contacts);
  void mass_centers();
  void inertia();
  void velocities();
  void joints();
  void joint_limits(const JointTable& joints, std::size_t i, float size);
  void islands();

  Color body_color(std::size_t row) const;
  Color shape_color(std::uint32_t shape) const { return body_color(row_[w_.shapes.bodies[shape]]); }
  Color color_at(const ContactTable& contacts, std::size_t i) const {
    if (!paint_.options().solver_colors) return contact_color(contacts.states[i]);
    return contacts.colors[i] == kNoColor ? kGrey : color_of_number(contacts.colors[i]);
  }
  float meters_per_newton(std::uint32_t a, std::uint32_t b) const;
  float extent_of(std::uint32_t body) const;
  Vec3 center(std::uint32_t body) const { return vector_at(bodies_.centers, row_[body]); }

  const World& world_;
  const RigidWorld& w_;
  Painter paint_;
  BodyTable bodies_;
  std::vector<std::uint32_t> row_;  // by body slot: its row in bodies_
};

Color Drawing::body_color(std::size_t row) const {
  const RestState state = bodies_.states[row];
  switch (paint_.options().color_by) {
    case ColorBy::rest_state:
      return rest_color(state, bodies_.still_times[row]);
    case ColorBy::island:
      return bodies_.islands[row] == kNoIsland ? kGrey : color_of_number(bodies_.islands[row]);
    case ColorBy::type:
      break;
  }
  if (state == RestState::fixed) return kGrey;
  if (state == RestState::kinematic) return kTeal;
  return state == RestState::asleep ? kBlue : kOrange;
}

// The size in which marks of a body are drawn; planes and bodies without shapes have no extent.
float Drawing::extent_of(std::uint32_t body) const {
  const float r = w_.bodies.masses[body].bounding_radius;
  return r > 0.0f && r < kUnbounded ? r : 0.5f;
}

float Drawing::meters_per_newton(std::uint32_t a, std::uint32_t b) const {
  if (paint_.options().meters_per_newton > 0.0f) return paint_.options().meters_per_newton;
  const float gravity = reference_gravity(w_.settings);
  float scale = 0.0f;
  for (const std::uint32_t body : {a, b}) {
    const float mass = w_.bodies.masses[body].mass;
    if (mass > 0.0f) scale = max(scale, extent_of(body) / (mass * gravity));
  }
  return scale;
}

void Drawing::geometry() {
  paint_.begin(DrawLayer::geometry);
  std::vector<float> lines;
  w_.shapes.ids.for_each_live([&](std::uint32_t shape) {
    lines.clear();
    add_wireframe(w_.shapes.geometry[shape], lines, paint_.options().segments);
    const Pose pose = origin_pose(w_.bodies, w_.shapes.bodies[shape]) * w_.shapes.body_from_shape[shape];
    const Transform relative{difference(pose.position, paint_.options().origin), pose.orientation};
    const Color color = w_.shapes.proxies[shape].sensor ? kYellow : shape_color(shape);
    for (std::size_t i = 0; i < lines.size() / 6; ++i) {
      paint_.line(relative * vector_at(lines, 2 * i), relative * vector_at(lines, 2 * i + 1), color);
    }
  });
}

void Drawing::boxes(DrawLayer layer, std::uint32_t kinds) {
  paint_.begin(layer);
  BoxTable table;
  read_boxes(world_, kinds, paint_.options().origin, table);
  for (std::size_t i = 0; i < table.size(); ++i) {
    Color color;
    if (table.shapes[i] != kNoShape) {
      color = shape_color(table.shapes[i]);
    } else {
      const Color tree = table.kinds[i] == BoxKind::fixed_tree ? kViolet : kGreen;
      color = mix(tree, kDark, float(table.depths[i]) / 5.0f);
    }
    paint_.box(vector_at(table.corners, 2 * i), vector_at(table.corners, 2 * i + 1), color);
  }
}

void Drawing::contact_points(const ContactTable& contacts) {
  paint_.begin(DrawLayer::contact_points);
  for (std::size_t i = 0; i < contacts.size(); ++i)
    paint_.point(vector_at(contacts.positions, i), color_at(contacts, i));
}

void Drawing::contact_normals(const ContactTable& contacts) {
  paint_.begin(DrawLayer::contact_normals);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 at = vector_at(contacts.positions, i);
    paint_.line(at, at + contacts.scales[i] * vector_at(contacts.normals, i), color_at(contacts, i));
  }
}

void Drawing::contact_forces(const ContactTable& contacts) {
  paint_.begin(DrawLayer::contact_forces);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 at = vector_at(contacts.positions, i);
    const float scale = meters_per_newton(contacts.bodies[2 * i], contacts.bodies[2 * i + 1]);
    const float force = scale * contacts.forces[i];
    const Vec3 friction = scale * vector_at(contacts.friction_forces, i);
    if (force > 0.0f) paint_.line(at, at + force * vector_at(contacts.normals, i), kRed);
    if (friction != Vec3{}) paint_.line(at, at + friction, kOrange);
  }
}

void Drawing::friction_basis(const ContactTable& contacts) {
  paint_.begin(DrawLayer::friction_basis);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Vec3 at = vector_at(contacts.positions, i);
    const float size = 0.5f * contacts.scales[i];
    paint_.line(at, at + size * vector_at(contacts.tangents, 2 * i), kTeal);
    paint_.line(at, at + size * vector_at(contacts.tangents, 2 * i + 1), kViolet);
  }
}

void Drawing::mass_centers() {
  paint_.begin(DrawLayer::mass_centers);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_.islands[i] == kNoIsland) continue;  // static
    const Vec3 at = vector_at(bodies_.centers, i);
    const Mat3 axes = to_matrix(quaternion_at(bodies_.axes, i));
    const float size = 0.5f * extent_of(bodies_.ids[i].index);
    paint_.point(at, body_color(i));
    paint_.line(at, at + size * axes.x, kRed);
    paint_.line(at, at + size * axes.y, kGreen);
    paint_.line(at, at + size * axes.z, kBlue);
  }
}

void Drawing::inertia() {
  paint_.begin(DrawLayer::inertia);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vec3 sides = vector_at(bodies_.semi_axes, i);
    if (sides == Vec3{}) continue;
    const Vec3 at = vector_at(bodies_.centers, i);
    const Mat3 axes = to_matrix(quaternion_at(bodies_.axes, i));
    const Vec3 x = sides.x * axes.x, y = sides.y * axes.y, z = sides.z * axes.z;
    paint_.ellipse(at, x, y, kYellow);
    paint_.ellipse(at, y, z, kYellow);
    paint_.ellipse(at, z, x, kYellow);
  }
}

void Drawing::velocities() {
  paint_.begin(DrawLayer::velocities);
  const float seconds = paint_.options().velocity_seconds;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Vec3 at = vector_at(bodies_.centers, i);
    const Vec3 linear = seconds * vector_at(bodies_.linear_velocities, i);
    const Vec3 angular = seconds * extent_of(bodies_.ids[i].index) * vector_at(bodies_.angular_velocities, i);
    if (linear != Vec3{}) paint_.line(at, at + linear, kYellow);
    if (angular != Vec3{}) paint_.line(at, at + angular, kViolet);
  }
}

// A marker of rotation about x of the joint frame and of sliding along it, within limits and motor range of the main
// axis.
bool turns_about_x(JointKind kind) {
  return kind == JointKind::hinge || kind == JointKind::cone || kind == JointKind::universal;
}
bool slides_along_x(JointKind kind) { return kind == JointKind::slider || kind == JointKind::wheel; }

// The range of a joint, its position and its motor target: an arc about the axis of a hinge, a line along that of a
// slider.
void Drawing::joint_limits(const JointTable& joints, std::size_t i, float size) {
  const Vec3 anchor = vector_at(joints.anchors, 2 * i);
  const Mat3 frame = to_matrix(quaternion_at(joints.frames, 2 * i));
  const float low = joints.limits[2 * i], high = joints.limits[2 * i + 1], now = joints.positions[i];
  const bool limited = joints.has_limits[i] != 0;
  const float drive = joints.motors[2 * i + 1] > 0.0f ? clamp(joints.motors[2 * i], -1.0f, 1.0f) : 0.0f;
  if (turns_about_x(joints.kinds[i])) {
    const auto at = [&](float angle) {
      const SinCos direction = sin_cos(angle);
      return anchor + size * (direction.cos * frame.y + direction.sin * frame.z);
    };
    if (limited) {
      paint_.arc(anchor, size * frame.y, size * frame.z, low, high, kYellow);
      paint_.line(anchor, at(low), kYellow);
      paint_.line(anchor, at(high), kYellow);
    }
    paint_.line(anchor, at(now), kWhite);
    if (drive != 0.0f) paint_.arc(anchor, 0.8f * size * frame.y, 0.8f * size * frame.z, now, now + drive, kOrange);
  }
  if (slides_along_x(joints.kinds[i])) {
    if (limited) paint_.line(anchor + low * frame.x, anchor + high * frame.x, kYellow);
    // The motor of a wheel spins it.
    if (drive != 0.0f && joints.kinds[i] == JointKind::slider)
      paint_.line(anchor + now * frame.x, anchor + (now + drive * size) * frame.x, kOrange);
  }
}

void Drawing::joints() {
  paint_.begin(DrawLayer::joints);
  JointTable joints;
  read_joints(world_, paint_.options().origin, joints);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    float size = 0.0f;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vec3 anchor = vector_at(joints.anchors, 2 * i + side);
      const BodyId body = joints.bodies[2 * i + side];
      paint_.point(anchor, side == 0 ? kRed : kBlue);
      if (!body) continue;
      paint_.line(center(body.index), anchor, kGrey);
      const float own = 0.5f * extent_of(body.index);
      size = size > 0.0f ? min(size, own) : own;
    }
    const Vec3 anchor_a = vector_at(joints.anchors, 2 * i), anchor_b = vector_at(joints.anchors, 2 * i + 1);
    // The rod, or the position error.
    paint_.line(anchor_a, anchor_b, joints.kinds[i] == JointKind::distance ? kWhite : kRed);
    if (joints.kinds[i] == JointKind::hinge || joints.kinds[i] == JointKind::slider) {
      const Vec3 axis = rotate(quaternion_at(joints.frames, 2 * i), {size, 0, 0});
      paint_.line(anchor_a - axis, anchor_a + axis, kRed);
    }
    joint_limits(joints, i, size);
  }
}

void Drawing::islands() {
  paint_.begin(DrawLayer::islands);
  for_each_island_edge(w_, [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t island = bodies_.islands[row_[a]];
    if (island == kNoIsland || bodies_.islands[row_[b]] != island) return;
    paint_.line(center(a), center(b), color_of_number(island));
  });
}

void Drawing::draw() {
  if (paint_.wants(DrawLayer::geometry)) geometry();
  if (paint_.wants(DrawLayer::tight_bounds)) boxes(DrawLayer::tight_bounds, box_bit(BoxKind::tight));
  if (paint_.wants(DrawLayer::fat_bounds)) boxes(DrawLayer::fat_bounds, box_bit(BoxKind::fat));
  if (paint_.wants(DrawLayer::broad_phase)) {
    boxes(DrawLayer::broad_phase, box_bit(BoxKind::fixed_tree) | box_bit(BoxKind::moving_tree));
  }
  ContactTable contacts;
  read_contacts(world_, paint_.options().origin, contacts);
  if (paint_.wants(DrawLayer::contact_points)) contact_points(contacts);
  if (paint_.wants(DrawLayer::contact_normals)) contact_normals(contacts);
  if (paint_.wants(DrawLayer::contact_forces)) contact_forces(contacts);
  if (paint_.wants(DrawLayer::friction_basis)) friction_basis(contacts);
  if (paint_.wants(DrawLayer::mass_centers)) mass_centers();
  if (paint_.wants(DrawLayer::inertia)) inertia();
  if (paint_.wants(DrawLayer::velocities)) velocities();
  if (paint_.wants(DrawLayer::joints)) joints();
  if (paint_.wants(DrawLayer::islands)) islands();
  if (paint_.wants(DrawLayer::soft_edges)) draw_soft_edges(gyre::state_of(world_).soft, paint_);
  if (paint_.wants(DrawLayer::soft_contacts)) draw_soft_contacts(gyre::state_of(world_).soft, paint_);
}

}  // namespace

const char* to_string(DrawLayer layer) {
  switch (layer) {
    case DrawLayer::geometry:
      return "geometry";
    case DrawLayer::tight_bounds:
      return "tight_bounds";
    case DrawLayer::fat_bounds:
      return "fat_bounds";
    case DrawLayer::broad_phase:
      return "broad_phase";
    case DrawLayer::contact_points:
      return "contact_points";
    case DrawLayer::contact_normals:
      return "contact_normals";
    case DrawLayer::contact_forces:
      return "contact_forces";
    case DrawLayer::friction_basis:
      return "friction_basis";
    case DrawLayer::mass_centers:
      return "mass_centers";
    case DrawLayer::inertia:
      return "inertia";
    case DrawLayer::velocities:
      return "velocities";
    case DrawLayer::joints:
      return "joints";
    case DrawLayer::islands:
      return "islands";
    case DrawLayer::soft_edges:
      return "soft_edges";
    case DrawLayer::soft_contacts:
      return "soft_contacts";
  }
  return "unknown";
}

void draw_debug(const World& world, const DrawOptions& options, DebugDraw& out) {
  const FloatMode mode;
  clear_all(out.line_positions, out.line_colors, out.point_positions, out.point_colors);
  for (DebugDraw::Range& range : out.layers) range = {};
  out.cut = false;
  Drawing(world, options, out).draw();
}

}  // namespace gyre
