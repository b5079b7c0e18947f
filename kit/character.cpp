// Moves the kinematic character. One call rides on the ground, leaves overlaps, updates the velocity, slides with steps, and finds the
// ground again.
//
// Source of the ideas: K. Fauerby, "Improved Collision Detection and Response", 2003 (collide and slide). docs/decisions/character.md tells
// what is different here, and why.
#include "kit/character_walk.h"

namespace gyre::kit {

namespace {

constexpr int kMaxPlanes = 6;

Error refuse(const char* what, double value, double low, double high) {
  return make_error(ErrorCode::invalid_argument, "character: %s is %g; it must lie within %g and %g", what,
                    value, low, high);
}

bool lies_within(float value, float low, float high) {
  return is_finite(value) && value >= low && value <= high;
}

Vec3 towards(Vec3 from, Vec3 to, float most) {
  const Vec3 change = to - from;
  const float size = length(change);
  return size > most ? from + (most / size) * change : to;
}

// One call of move_character.
class Mover {
 public:
  Mover(World& world, const CharacterDef& def, CharacterState& state, float seconds)
      : world_(world), def_(def), s_(state), walk_(world, def, state), seconds_(seconds) {}

  void move(const CharacterMove& move) {
    ride();
    s_.stuck = !walk_.escape(s_.feet);
    const bool stood = s_.ground == GroundKind::firm;
    const bool jumps = stood && move.jump_speed > 0.0f;
    choose_velocity(move, stood, jumps);
    walks_ = stood && !jumps;
    start_ = s_.feet;
    Vec3 way = seconds_ * s_.velocity;
    if (walks_) way = along_ground(walk_.flat(way));
    slide(way);
    find_ground();
    if (walks_ && s_.ground == GroundKind::firm)
      s_.velocity = walk_.flat((1.0f / seconds_) * difference(s_.feet, start_));
    if (s_.ground == GroundKind::firm) weigh();
    if (s_.body) {
      const ShapePose place = walk_.shape_at(s_.feet, s_.height);
      world_.move_kinematic(s_.body, place.pose, seconds_);
    }
  }

 private:
  // Rides on the ground body, exactly as that moved since the last call.
  void ride() {
    s_.ground_velocity = {};
    s_.ground_rotation = 0.0f;
    if (s_.ground != GroundKind::firm || !world_.exists(s_.ground_body)) return;
    const Pose now = world_.pose(s_.ground_body), then = s_.ground_pose;
    if (now == then) return;
    const DVec3 target = now * inverse_times(then, s_.feet);
    const Vec3 way = difference(target, s_.feet);
    WalkHit hit;
    walk_.go(s_.feet, way, hit, s_.ground_body);
    if (!hit.any) s_.feet = target;
    s_.ground_velocity = (1.0f / seconds_) * way;
    const Quat turn = now.orientation * conjugate(then.orientation);
    const float about = dot(Vec3{turn.x, turn.y, turn.z}, def_.up);
    s_.ground_rotation = turn.w < 0.0f ? 2.0f * atan2(-about, -turn.w) : 2.0f * atan2(about, turn.w);
    s_.ground_normal = rotate(turn, s_.ground_normal);
    s_.ground_point = now * inverse_times(then, s_.ground_point);
  }

  void choose_velocity(const CharacterMove& move, bool stood, bool jumps) {
    const Vec3 wanted = walk_.flat(move.velocity);
    const Vec3 level = walk_.flat(s_.velocity);
    if (jumps) {
      s_.velocity = level + s_.ground_velocity + move.jump_speed * def_.up;
      s_.ground = GroundKind::none;
    } else if (stood) {
      s_.velocity = def_.ground_acceleration > 0.0f
                        ? towards(level, wanted, seconds_ * def_.ground_acceleration)
                        : wanted;
    } else {
      const Vec3 fall = walk_.along_up(s_.velocity) * def_.up + seconds_ * world_.gravity();
      // Steep ground gives no grip to brake.
      const bool may_steer = def_.air_acceleration > 0.0f && s_.ground != GroundKind::steep;
      s_.velocity = (may_steer ? towards(level, wanted, seconds_ * def_.air_acceleration) : level) + fall;
    }
  }

  // Leads a level displacement along the ground; it is as long as before, seen from above.
  Vec3 along_ground(Vec3 way) const {
    return walk_.is_firm(s_.ground_normal) ? led(way, s_.ground_normal) : way;
  }
  Vec3 led(Vec3 level, Vec3 normal) const {
    return level - (dot(level, normal) / walk_.along_up(normal)) * def_.up;
  }

  void slide(Vec3 way) {
    Vec3 planes[kMaxPlanes];
    int count = 0;
    const Vec3 first = way;
    for (int round = 0; round < kMaxPlanes; ++round) {
      if (!(length_squared(way) > 1.0e-14f)) return;
      WalkHit hit;
      way = way - walk_.go(s_.feet, way, hit);
      if (!hit.any) return;
      if (hit.dynamic) push(hit);
      Vec3 normal = hit.normal;
      if (!walk_.is_firm(normal)) {
        if (walks_ && !hit.dynamic && step(way)) continue;
        // Steep ground is a wall to a walking character and lifts nobody. A sloped ceiling is a wall, too.
        const Vec3 wall = walk_.flat(normal);
        const bool lifts = walk_.along_up(normal) > 0.0f &&
                           walk_.along_up(way) > walk_.along_up(first) - 1.0e-6f && !falls(way);
        if ((walks_ || lifts) && length_squared(wall) > 1.0e-4f) normal = normalized(wall);
      }
      planes[count++] = normal;
      // A walking character keeps its speed, seen from above, on firm ground.
      if (walks_ && walk_.is_firm(normal)) way = led(walk_.flat(way), normal);
      way = clipped(way, planes, count);
      if (!walks_) s_.velocity = clipped(s_.velocity, planes, count);
      // If the planes turn it back, it stops; it would rock to and fro otherwise.
      if (dot(walk_.flat(way), walk_.flat(first)) < 0.0f) way = walk_.along_up(way) * def_.up;
    }
  }

  bool falls(Vec3 way) const { return walk_.along_up(way) < 0.0f; }

  // Returns the component of a displacement that enters none of the planes.
  static Vec3 clipped(Vec3 way, const Vec3* planes, int count) {
    const auto enters = [&](Vec3 v, int but_1, int but_2) {
      for (int i = 0; i < count; ++i) {
        if (i != but_1 && i != but_2 && dot(v, planes[i]) < -1.0e-6f * length(v)) return i;
      }
      return -1;
    };
    const int first = enters(way, -1, -1);
    if (first < 0) return way;
    Vec3 out = way - dot(way, planes[first]) * planes[first];
    const int second = enters(out, first, -1);
    if (second < 0) return out;
    const Vec3 crease = cross(planes[first], planes[second]);
    if (!(length_squared(crease) > 1.0e-6f)) return {};
    const Vec3 along = normalized(crease);
    out = dot(way, along) * along;
    return enters(out, first, second) < 0 ? out : Vec3{};
  }

  // Steps over a ledge: up, on, and down onto firm ground that is not too high. Removes the moved part from `way`.
  bool step(Vec3& way) {
    const Vec3 level = walk_.flat(way);
    const float size = length(level);
    if (!(def_.step_up > 0.0f) || !(size > 1.0e-5f)) return false;
    DVec3 feet = s_.feet;
    WalkHit hit;
    const float rise = length(walk_.go(feet, (def_.step_up + 2.0f * kGap) * def_.up, hit));
    const Vec3 gone = walk_.go(feet, level, hit);
    if (!(length(gone) > 0.1f * size)) return false;
    walk_.go(feet, -(rise + kGap) * def_.up, hit);
    if (!walk_.is_firm(hit)) return false;
    const double ledge = walk_.height_of(hit.point) - (walk_.height_of(start_) - double(kGap));
    if (ledge > double(def_.step_up) + double(kGap)) return false;
    s_.feet = feet;
    way = way - gone;
    return true;
  }

  void find_ground() {
    const bool rises = walk_.along_up(s_.velocity) > 1.0e-3f && !walks_;
    s_.ground = GroundKind::none;
    s_.ground_body = {};
    s_.ground_normal = {};
    if (rises) return;
    const float reach = walks_ ? def_.step_down + 4.0f * kGap : 4.0f * kGap;
    const WalkHit hit = walk_.cast_down(s_.feet, reach);
    if (!hit.any || walk_.along_up(hit.normal) <= 0.0f) return;
    const bool firm = walk_.is_firm(hit);
    const float facing = walk_.along_up(hit.normal);
    const double gap = double(kGap) / double(facing > 0.3f ? facing : 0.3f);
    // It follows ground below its contact only if that is firm, and no deeper than a step below the last ground. (The feet are lower than
    // an edge on which they stand.)
    const double drop = walk_.height_of(s_.ground_point) - walk_.height_of(hit.point);
    const bool follows = firm && walks_ && drop <= double(def_.step_down + kGap);
    if (!follows && hit.distance > gap + 2.0 * double(kGap)) return;
    // It moves down to the ground, never up: a gap that is too small by rounding stays.
    if (firm && hit.distance > gap) s_.feet = s_.feet - (hit.distance - gap) * DVec3(def_.up);
    s_.ground = firm ? GroundKind::firm : GroundKind::steep;
    s_.ground_body = hit.body;
    s_.ground_pose = world_.pose(hit.body);
    s_.ground_normal = firm ? walk_.face_normal(hit) : hit.normal;
    s_.ground_point = hit.point;
    if (firm && !walks_) s_.velocity = walk_.flat(s_.velocity - world_.velocity_at(hit.body, hit.point));
  }

  void push(const WalkHit& hit) {
    if (!(def_.push_force > 0.0f)) return;
    const float speed = dot(world_.velocity_at(hit.body, hit.point) - s_.velocity, hit.normal);
    if (!(speed > 0.0f)) return;
    const float needed = speed * world_.mass_properties(hit.body).mass;
    const float most = def_.push_force * seconds_;
    world_.add_impulse_at(hit.body, -(needed < most ? needed : most) * hit.normal, hit.point);
  }

  void weigh() {
    if (!(def_.mass > 0.0f) || world_.type(s_.ground_body) != BodyType::dynamic) return;
    world_.add_force_at(s_.ground_body, def_.mass * world_.gravity(), s_.ground_point);
  }

  World& world_;
  const CharacterDef& def_;
  CharacterState& s_;
  Walker walk_;
  float seconds_;
  bool walks_ = false;
  DVec3 start_;
};

}  // namespace

Error check_character(const CharacterDef& d) {
  if (!lies_within(d.radius, 1.0e-3f, 1.0e3f)) return refuse("radius", double(d.radius), 1.0e-3, 1.0e3);
  if (!lies_within(d.height, 2.0f * d.radius, 1.0e4f))
    return refuse("height", double(d.height), 2.0 * double(d.radius), 1.0e4);
  const float up = length(d.up);
  if (!lies_within(up, 0.999f, 1.001f)) return refuse("the length of up", double(up), 0.999, 1.001);
  const struct {
    const char* name;
    float value, high;
  } numbers[] = {{"max_slope", d.max_slope, 1.5533f},
                 {"step_up", d.step_up, 1.0e3f},
                 {"step_down", d.step_down, 1.0e3f},
                 {"ground_acceleration", d.ground_acceleration, 1.0e6f},
                 {"air_acceleration", d.air_acceleration, 1.0e6f},
                 {"mass", d.mass, 1.0e9f},
                 {"push_force", d.push_force, 1.0e12f}};
  for (const auto& n : numbers) {
    if (!lies_within(n.value, 0.0f, n.high)) return refuse(n.name, double(n.value), 0.0, double(n.high));
  }
  return {};
}

CharacterState make_character(const CharacterDef& def, DVec3 feet) {
  CharacterState state;
  state.feet = feet;
  state.height = def.height;
  return state;
}

ShapePose character_shape(const CharacterDef& def, const CharacterState& state) {
  return capsule_place(def, state.feet, state.height);
}

Error move_character(World& world, const CharacterDef& def, CharacterState& state, const CharacterMove& move,
                     float seconds) {
  Error e = check_character(def);
  if (e) return e;
  if (!lies_within(seconds, 1.0e-6f, 1.0f)) return refuse("seconds", double(seconds), 1.0e-6, 1.0);
  if (!is_finite(move.velocity) || length(move.velocity) > 1.0e4f) {
    return refuse("the size of move.velocity", double(length(move.velocity)), 0.0, 1.0e4);
  }
  if (!lies_within(move.jump_speed, 0.0f, 1.0e4f))
    return refuse("move.jump_speed", double(move.jump_speed), 0.0, 1.0e4);
  if (!lies_within(state.height, 2.0f * def.radius, 1.0e4f)) {
    return refuse("state.height", double(state.height), 2.0 * double(def.radius), 1.0e4);
  }
  if (!is_finite(state.feet) || !is_finite(state.velocity)) {
    return make_error(ErrorCode::invalid_argument, "character: its place or velocity is not finite");
  }
  Mover(world, def, state, seconds).move(move);
  return {};
}

bool set_character_height(const World& world, const CharacterDef& def, CharacterState& state, float height) {
  if (!lies_within(height, 2.0f * def.radius, 1.0e4f)) return false;
  const Walker walk(world, def, state);
  if (height > state.height && !walk.is_free(state.feet, height)) return false;
  state.height = height;
  return true;
}

}  // namespace gyre::kit
