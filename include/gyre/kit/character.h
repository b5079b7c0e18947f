// Characters: a kinematic mover that walks, climbs, rides and pushes, and a dynamic character that is a body of the world.
//
// The library gyre_kit (gyre::kit) uses the public headers only, so a user can copy and change it. SI units, world frame. A character is
// an upright capsule; its reference point is its lowest point, the feet.
//
// The mover is plain data: CharacterDef has its abilities, CharacterState its state. Copy the state together with a snapshot of the world,
// and both can be rolled back. The same calls give the same bits on every platform. Call move_character once after each World::step with
// the same seconds. docs/characters.md tells how it moves and docs/decisions/character.md why.
#pragma once

#include <gyre/world.h>

namespace gyre::kit {

struct CharacterDef {
  float radius = 0.3f;            // m
  float height = 1.8f;            // m, standing, caps included; at least twice the radius
  Vec3 up{0, 1, 0};               // length 1
  float max_slope = 0.8726646f;   // rad: it cannot stand on steeper ground (50 degrees)
  float step_up = 0.35f;          // m: it climbs ledges up to this height; higher ones are walls
  float step_down = 0.35f;        // m: the feet follow ground that drops by up to this height; 0: they leave it
  float ground_acceleration = 0;  // m/s^2, towards the desired velocity; 0: at once
  float air_acceleration = 8;     // m/s^2, the same in the air; 0: no control in the air
  float mass = 80;                // kg: its weight acts on dynamic bodies it stands on; 0: no weight
  float push_force = 400;         // N, at most, on dynamic bodies that it pushes; 0: they are walls
  std::uint32_t layers = 0xffffffffu;  // shapes that stop it, by Filter::layer
  std::uint32_t one_way_layers = 0;    // of these, shapes that carry it from above and let it pass from below
};

enum class GroundKind : std::uint8_t {
  none,   // in the air
  steep,  // touches ground that is too steep to stand on
  firm,   // stands
};

struct CharacterState {
  DVec3 feet{};
  Vec3 velocity{};      // m/s, relative to the ground
  float height = 1.8f;  // m, at present
  GroundKind ground = GroundKind::none;
  BodyId ground_body{};  // the body it stands on
  Pose ground_pose{};    // of that body in the last move
  Vec3 ground_normal{};
  DVec3 ground_point{};
  Vec3 ground_velocity{};        // m/s, of the ground at the feet in the last move
  float ground_rotation = 0.0f;  // rad about `up`, by which the ground rotated the character in the last move
  bool stuck = false;            // it overlapped something in the last move and could not resolve it
  BodyId body{};  // optional: a kinematic body that represents it in the world. It is moved along and does not block the character.
};

struct CharacterMove {
  Vec3 velocity{};          // m/s, the desired velocity relative to the ground; its component along `up` is ignored
  float jump_speed = 0.0f;  // m/s along `up`, if it stands; 0: no jump
};

// A character with its feet at a point, standing upright. Its first move resolves overlaps.
CharacterState make_character(const CharacterDef& def, DVec3 feet);

// The reason why a definition is invalid; code none if it is valid.
Error check_character(const CharacterDef& def);

// The capsule of the character at its position.
ShapePose character_shape(const CharacterDef& def, const CharacterState& state);

// Moves the character for `seconds`. The ground carries it, overlaps push it out, and it walks or falls in the world's gravity, slides along
// obstacles and climbs steps up and down. It pushes dynamic bodies and puts its weight on the body it stands on, by impulses that the next
// World::step sees. Returns an error, and moves nothing, if the definition or the numbers are invalid.
Error move_character(World& world, const CharacterDef& def, CharacterState& state, const CharacterMove& move,
                     float seconds);

// Sets the height (at least twice the radius) for crouching and standing up; the feet stay. False, and nothing changes, if there is no room.
bool set_character_height(const World& world, const CharacterDef& def, CharacterState& state, float height);

// ------------------------------------------------------------------------------------------------------------ dynamic

// A character that is a rigid body. It is pushed, carried and crushed like any other body, and never falls over. `feet` is on the ground.
BodyId add_character_body(World& world, const CharacterDef& def, DVec3 feet, const Filter& filter = {});

struct BodyDrive {
  float grip = 1.0f;         // its force along the ground is at most this times the normal force
  float air_force = 100.0f;  // N, at most, in the air
};

// The ground of a dynamic character.
struct CharacterGround {
  GroundKind kind = GroundKind::none;
  BodyId body{};
  DVec3 point{};
  Vec3 normal{};
  Vec3 velocity{};  // m/s, of the ground at the point
};
CharacterGround find_character_ground(const World& world, const CharacterDef& def, BodyId character);

// Drives a dynamic character for the next step of `seconds` towards a velocity relative to the ground; call it before World::step. It acts
// like a motor with the limit of friction, and the opposite force acts on the ground. It jumps if it stands and jump_speed is above 0.
Error drive_character_body(World& world, const CharacterDef& def, BodyId character, const CharacterMove& move,
                           float seconds, const BodyDrive& drive = {});

}  // namespace gyre::kit
