// Readings, actions and draws of one world. See batch_channels.h.
#include "batch/batch_channels.h"

#include "base/hash.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kAllComponents = 15;

bool has_component(std::uint8_t components, int i) { return components == 0 || (components >> i & 1) != 0; }
int component_count(std::uint8_t components, int most) {
  int count = 0;
  for (int i = 0; i < most; ++i) count += has_component(components, i);
  return count;
}

// Writes the chosen components.
template <class Value, int Count>
float* write_components(float* out, const Value (&parts)[Count], std::uint8_t components) {
  for (int i = 0; i < Count; ++i) {
    if (has_component(components, i)) *out++ = float(parts[i]);
  }
  return out;
}
template <class Vector>
float* write_vector(float* out, const Vector& v, std::uint8_t components) {
  const decltype(v.x) parts[3] = {v.x, v.y, v.z};
  return write_components(out, parts, components);
}
Vec3 vector_of(const float* values, std::uint8_t components) {
  float parts[3] = {};
  for (int i = 0; i < 3; ++i) {
    if (has_component(components, i)) parts[i] = *values++;
  }
  return {parts[0], parts[1], parts[2]};
}

float contact_force(const World& world, BodyId body, float seconds, std::vector<ContactPoint>& points) {
  std::size_t count = world.contacts(points);
  if (count > points.size()) {
    points.resize(2 * count);  // room for more, since contacts come and go
    count = world.contacts(points);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    if (points[i].body_a == body || points[i].body_b == body) sum += double(points[i].normal_impulse);
  }
  return seconds > 0.0f ? float(sum / double(seconds)) : 0.0f;
}

Motor motor_of(const BatchAction& action, float value) {
  Motor motor{
      .max_force = action.max_force, .frequency = action.frequency, .damping_ratio = action.damping_ratio};
  if (action.kind == ActionKind::motor_position) {
    motor.target_position = value;
  } else if (action.kind == ActionKind::motor_force) {
    // A motor that never reaches its target speed acts with its largest force.
    motor.target_velocity = value < 0.0f ? -1.0e4f : 1.0e4f;
    motor.max_force = absolute(value);
  } else {
    motor.target_velocity = value;
  }
  return motor;
}

Error out_of_range(const char* what, std::size_t index) {
  return make_error(ErrorCode::invalid_argument, "batch: %s %zu: kind, components or axis is out of range",
                    what, index);
}
Error no_such(const char* what, std::size_t index, bool joint) {
  return make_error(ErrorCode::stale_id, "batch: %s %zu: the world has no such %s", what, index,
                    joint ? "joint" : "body");
}

bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Evenly in [0, 1): the upper 24 bits, which a float has exactly.
float unit_number(std::uint64_t bits) { return float(bits >> 40) * (1.0f / 16777216.0f); }

bool set_shapes(World& world, BodyId body, const BatchDraw& draw, float value) {
  bool done = true;
  for (const ShapeId shape : world.shapes(body)) {
    Material material = world.material(shape);
    if (draw.kind == DrawKind::friction) {
      material.static_friction *= value;
      material.dynamic_friction *= value;
    } else {
      material.restitution = value;
    }
    done = world.set_material(shape, material) && done;
  }
  return done;
}

}  // namespace

bool is_of_joint(const BatchReading& reading) {
  return reading.kind >= ReadingKind::joint_position && reading.kind <= ReadingKind::joint_force;
}
bool is_of_joint(const BatchAction& action) {
  return action.kind >= ActionKind::motor_velocity && action.kind <= ActionKind::motor_force;
}

int width_of(const BatchReading& reading) {
  switch (reading.kind) {
    case ReadingKind::orientation:
      return component_count(reading.components, 4);
    case ReadingKind::position:
    case ReadingKind::linear_velocity:
    case ReadingKind::angular_velocity:
      return component_count(reading.components, 3);
    case ReadingKind::joint_position:
    case ReadingKind::joint_velocity:
    case ReadingKind::joint_force:
    case ReadingKind::contact_force:
      break;
  }
  return 1;
}
int width_of(const BatchAction& action) {
  return is_of_joint(action) ? 1 : component_count(action.components, 3);
}

Error check_reading(const BatchReading& reading, std::size_t index, const World& world,
                    std::uint16_t number) {
  const int most = reading.kind == ReadingKind::orientation ? kAllComponents : 7;
  if (int(reading.kind) >= kReadingKindCount || int(reading.axis) >= kJointAxisCount ||
      reading.components > most)
    return out_of_range("observation", index);
  const bool exists = is_of_joint(reading) ? world.exists(with_number(reading.joint, number))
                                           : world.exists(with_number(reading.body, number));
  return exists ? Error{} : no_such("observation", index, is_of_joint(reading));
}
Error check_action(const BatchAction& action, std::size_t index, const World& world, std::uint16_t number) {
  if (int(action.kind) >= kActionKindCount || action.components > 7) return out_of_range("action", index);
  const bool exists = is_of_joint(action) ? world.exists(with_number(action.joint, number))
                                          : world.exists(with_number(action.body, number));
  return exists ? Error{} : no_such("action", index, is_of_joint(action));
}
Error check_draw(const BatchDraw& draw, std::size_t index, const World& world, std::uint16_t number) {
  if (int(draw.kind) >= kDrawKindCount) return out_of_range("draw", index);
  if (!finite(draw.low) || !finite(draw.high)) {
    return make_error(ErrorCode::invalid_argument, "batch: draw %zu: low and high must be finite", index);
  }
  const bool needs_body = draw.kind != DrawKind::gravity;
  return !needs_body || world.exists(with_number(draw.body, number)) ? Error{}
                                                                     : no_such("draw", index, false);
}

float* read_channel(const World& world, std::uint16_t number, const BatchReading& reading, float seconds,
                    std::vector<ContactPoint>& points, float* out) {
  const BodyId body = with_number(reading.body, number);
  if (is_of_joint(reading)) {
    const JointAxisState state = world.joint_axis_state(with_number(reading.joint, number), reading.axis);
    *out = reading.kind == ReadingKind::joint_position   ? state.position
           : reading.kind == ReadingKind::joint_velocity ? state.velocity
                                                         : state.force;
    return out + 1;
  }
  switch (reading.kind) {
    case ReadingKind::position:
      return write_vector(out, world.pose(body).position, reading.components);
    case ReadingKind::orientation: {
      const Quat q = world.pose(body).orientation;
      const float parts[4] = {q.x, q.y, q.z, q.w};
      return write_components(out, parts, reading.components);
    }
    case ReadingKind::linear_velocity:
      return write_vector(out, world.linear_velocity(body), reading.components);
    case ReadingKind::angular_velocity:
      return write_vector(out, world.angular_velocity(body), reading.components);
    default:
      *out = contact_force(world, body, seconds, points);
      return out + 1;
  }
}

bool apply_action(World& world, std::uint16_t number, const BatchAction& action, const float* values,
                  bool first) {
  const BodyId body = with_number(action.body, number);
  if (action.kind == ActionKind::force) return world.add_force(body, vector_of(values, action.components));
  if (action.kind == ActionKind::torque) return world.add_torque(body, vector_of(values, action.components));
  if (!first) return true;
  if (is_of_joint(action))
    return world.set_motor(with_number(action.joint, number), motor_of(action, *values));
  return world.set_velocity(body, vector_of(values, action.components), world.angular_velocity(body));
}

Vec3 draw_values(const BatchDraw& draw, std::uint64_t seed, std::size_t world, std::uint64_t run,
                 std::size_t index) {
  std::uint64_t bits = mix_bits(seed + 0x9e3779b97f4a7c15u);
  bits = mix_bits(bits + world);
  bits = mix_bits(bits + run);
  bits = mix_bits(bits + index);
  const float x = unit_number(mix_bits(bits + 1)), y = unit_number(mix_bits(bits + 2)),
              z = unit_number(mix_bits(bits + 3));
  return {draw.low.x + x * (draw.high.x - draw.low.x), draw.low.y + y * (draw.high.y - draw.low.y),
          draw.low.z + z * (draw.high.z - draw.low.z)};
}

bool apply_draw(World& world, std::uint16_t number, const BatchDraw& draw, Vec3 values) {
  const BodyId body = with_number(draw.body, number);
  switch (draw.kind) {
    case DrawKind::position: {
      Pose pose = world.pose(body);
      pose.position = pose.position + DVec3{double(values.x), double(values.y), double(values.z)};
      return world.set_pose(body, pose);
    }
    case DrawKind::linear_velocity:
      return world.set_velocity(body, world.linear_velocity(body) + values, world.angular_velocity(body));
    case DrawKind::angular_velocity:
      return world.set_velocity(body, world.linear_velocity(body), world.angular_velocity(body) + values);
    case DrawKind::gravity:
      return world.set_gravity(world.gravity() + values);
    case DrawKind::gravity_scale:
      return world.set_gravity_scale(body, world.gravity_scale(body) * values.x);
    case DrawKind::friction:
    case DrawKind::restitution:
      return set_shapes(world, body, draw, values.x);
  }
  return false;
}

}  // namespace gyre
