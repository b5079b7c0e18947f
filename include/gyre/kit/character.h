// Characters: a kinematic mover that walks, climbs, rides and pushes, and a dynamic one that is a body of the world.
//
// Library gyre_kit (gyre::kit), made of the public queries alone: what it cannot do, no user can, and it may be copied and changed.
// SI units, world frame. A character is an upright capsule; the point that stands for it is its lowest one, the feet.
//
// The mover is plain data: CharacterDef says what it can, CharacterState where it is. Copy the state with a snapshot of the world
// and both can be rolled back; the same calls give the same bits on every platform. Call move_character once after each
// World::step with the same seconds. docs/characters.md tells how it moves and docs/decisions/character.md why so.
#pragma once

#include <gyre/world.h>

namespace gyre::kit {

struct CharacterDef {
  float radius = 0.3f;            // m
  float height = 1.8f;            // m, standing, caps included; at least twice the radius
  Vec3 up{0, 1, 0};               // length 1
  float max_slope = 0.8726646f;   // rad: ground that is steeper is not walked on (50 degrees)
  float step_up = 0.35f;          // m: ledges this much above the ground are climbed, higher ones are walls
  float step_down = 0.35f;        // m: the feet follow ground that falls away by this much; 0: they leave it
  float ground_acceleration = 0;  // m/s^2, towards the velocity that is asked for; 0: at once
  float air_acceleration = 8;     // m/s^2, the same in the air; 0: no say in the air
  float mass = 80;                // kg: weighs on dynamic bodies it stands on; 0: weighs nothing
  float push_force = 400;         // N, at most, against dynamic bodies in its way; 0: they are walls
  std::uint32_t layers = 0xffffffffu;  // shapes that stop it, by Filter::layer
  std::uint32_t one_way_layers = 0;    // of these, those that hold from above only
};

enum class GroundKind : std::uint8_t {
  none,   // in the air
  steep,  // touches ground that is too steep to stand on
  firm,   // stands
};

struct CharacterState {
  DVec3 feet{};
  Vec3 velocity{};      // m/s, its own: without that of the ground it rides on
  float height = 1.8f;  // m, as it is now
  GroundKind ground = GroundKind::none;
  BodyId ground_body{};  // what it stands on,
  Pose ground_pose{};    // where that was as the character stood on it last,
  Vec3 ground_normal{};  // and where and how it touches it
  DVec3 ground_point{};
  Vec3 ground_velocity{};  // m/s, of the ground at the feet in the last move
  float turned = 0.0f;     // rad about `up`, by the ground it rides on, in the last move
  bool stuck = false;      // overlaps something and found no way out in the last move
  BodyId body{};  // a kinematic body that stands for it in the world; moved along, and not in its way
};

struct CharacterMove {
  Vec3 velocity{};          // m/s that is asked for, against the ground; what of it is along `up` is left out
  float jump_speed = 0.0f;  // m/s along `up`, if it stands; 0: no jump
};

// A character whose feet are at a point, standing upright; it gets out of what it overlaps in its first move.
CharacterState make_character(const CharacterDef& def, DVec3 feet);

// Why a definition cannot be used; code none if it can.
Error check_character(const CharacterDef& def);

// The capsule that stands for the character at its place.
ShapePlace character_shape(const CharacterDef& def, const CharacterState& state);

// Moves the character on by `seconds`: carried by what it stands on, pushed out of what came into it, walking or falling in the
// world's gravity, sliding along what is in its way, up and down steps. Dynamic bodies in its way are pushed, the one it stands on
// is weighed down, by impulses that World::step sees next. An error if the definition or the numbers cannot be used; nothing moves then.
Error move_character(World& world, const CharacterDef& def, CharacterState& state, const CharacterMove& move,
                     float seconds);

// Crouches, or stands up (at least twice the radius): the feet stay. False, and nothing changes, if something is in the way.
bool set_character_height(const World& world, const CharacterDef& def, CharacterState& state, float height);

// ------------------------------------------------------------------------------------------------------------ dynamic

// A character that is a rigid body: pushed, carried and crushed like any other, and never falls over. `feet` on the ground.
BodyId add_character_body(World& world, const CharacterDef& def, DVec3 feet, const Filter& filter = {});

struct BodyDrive {
  float grip = 1.0f;         // its force on the ground is at most this times the force that holds it up
  float air_force = 100.0f;  // N, at most, in the air
};

// What a dynamic character stands on.
struct CharacterGround {
  GroundKind kind = GroundKind::none;
  BodyId body{};
  DVec3 point{};
  Vec3 normal{};
  Vec3 velocity{};  // m/s, of the ground at the point
};
CharacterGround find_character_ground(const World& world, const CharacterDef& def, BodyId character);

// Drives a dynamic character for the next step of `seconds` towards a velocity against the ground (call before World::step): like
// a motor whose force has the limit of friction, and pushes the ground back. Jumps if it stands and a jump is asked for.
Error drive_character_body(World& world, const CharacterDef& def, BodyId character, const CharacterMove& move,
                           float seconds, const BodyDrive& drive = {});

}  // namespace gyre::kit
