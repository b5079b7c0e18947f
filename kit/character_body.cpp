// Moves the dynamic character: an upright capsule without friction of its own, driven by a motor at its feet.
#include "kit/character_walk.h"

namespace gyre::kit {

namespace {

CharacterState state_of(const World& world, const CharacterDef& def, BodyId character) {
  CharacterState state;
  state.height = def.height;
  state.feet = world.pose(character).position - 0.5 * double(def.height) * DVec3(def.up);
  state.body = character;
  return state;
}

Vec3 within(Vec3 v, float most) {
  const float size = length(v);
  return size > most ? (most / size) * v : v;
}

// strike_apart applies an impulse at the feet and its reaction; push_apart does so with a force through the next step. (An impulse against
// gravity's pull down a slope would lift the body at once and let it sink through the step: it would creep uphill.)
void strike_apart(World& world, BodyId character, const CharacterGround& ground, Vec3 impulse) {
  world.add_impulse(character, impulse);
  if (world.type(ground.body) == BodyType::dynamic) world.add_impulse_at(ground.body, -impulse, ground.point);
}
void push_apart(World& world, BodyId character, const CharacterGround& ground, Vec3 force) {
  world.add_force(character, force);
  if (world.type(ground.body) == BodyType::dynamic) world.add_force_at(ground.body, -force, ground.point);
}

}  // namespace

BodyId add_character_body(World& world, const CharacterDef& def, DVec3 feet, const Filter& filter) {
  if (check_character(def)) return {};
  const ShapePose place = capsule_place(def, feet, def.height);
  BodyDef body;
  body.pose = place.pose;
  for (bool& locked : body.locked.angular) locked = true;
  body.can_sleep = false;  // it must react in every step
  if (def.mass > 0.0f) body.mass = def.mass;
  ShapeDef shape;
  shape.geometry = place.shape;
  // The drive has the grip. With friction, too, the body would hang on walls.
  shape.material.static_friction = shape.material.dynamic_friction = 0.0f;
  shape.filter = filter;
  return world.add_body(body, shape);
}

CharacterGround find_character_ground(const World& world, const CharacterDef& def, BodyId character) {
  CharacterGround ground;
  if (!world.exists(character)) return ground;
  const CharacterState state = state_of(world, def, character);
  const Walker walk(world, def, state);
  // Contacts may rest a little deep or separate for a step.
  constexpr float kReach = 0.03f;
  const DVec3 lifted = state.feet + double(kReach) * DVec3(def.up);
  const WalkHit hit = walk.cast(lifted, -2.0f * kReach * def.up);
  if (!hit.any || walk.along_up(hit.normal) <= 0.0f) return ground;
  ground.kind = walk.is_firm(hit) ? GroundKind::firm : GroundKind::steep;
  ground.body = hit.body;
  ground.point = hit.point;
  ground.normal = hit.normal;
  ground.velocity = world.velocity_at(hit.body, hit.point);
  return ground;
}

Error drive_character_body(World& world, const CharacterDef& def, BodyId character, const CharacterMove& move,
                           float seconds, const BodyDrive& drive) {
  const Error e = check_character(def);
  if (e) return e;
  if (!world.exists(character)) {
    return make_error(ErrorCode::stale_id, "character: body %u does not exist in this world",
                      character.index);
  }
  if (!is_finite(move.velocity) || !(seconds > 0.0f && seconds <= 1.0f)) {
    return make_error(ErrorCode::invalid_argument,
                      "character: velocity must be finite, and seconds above 0 and at most 1");
  }
  const CharacterGround ground = find_character_ground(world, def, character);
  const float mass = world.mass_properties(character).mass;
  const Vec3 velocity = world.linear_velocity(character), gravity = world.gravity();
  const auto flat = [&](Vec3 v) { return v - dot(v, def.up) * def.up; };
  if (ground.kind != GroundKind::firm) {
    const Vec3 lack = flat(move.velocity) - flat(velocity);
    world.add_force(character, within((mass / seconds) * lack, drive.air_force));
    return {};
  }
  const Vec3 n = ground.normal;
  if (move.jump_speed > 0.0f) {
    const float lack = move.jump_speed - dot(velocity - ground.velocity, def.up);
    if (lack > 0.0f) strike_apart(world, character, ground, mass * lack * def.up);
  }
  // The force along the ground reaches the target velocity against gravity's pull in the step, up to the grip under the load.
  const Vec3 wanted = flat(move.velocity);
  const Vec3 along = wanted - (dot(wanted, n) / dot(n, def.up)) * def.up;
  const Vec3 pull = seconds * (gravity - dot(gravity, n) * n);
  Vec3 lack = along - (velocity - ground.velocity) - pull;
  lack -= dot(lack, n) * n;
  const float held = -dot(gravity, n) * mass;
  push_apart(world, character, ground,
             within((mass / seconds) * lack, drive.grip * (held > 0.0f ? held : 0.0f)));
  return {};
}

}  // namespace gyre::kit
