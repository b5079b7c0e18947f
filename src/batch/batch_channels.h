// Readings, actions and draws of one world of a batch.
//
// In: a world, and ids of the world that the batch was made of; the world's number replaces that of the ids. Out: numbers of a row, or
// commands of the world.
#pragma once

#include <gyre/batch.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// The number that a world puts into its ids.
inline BodyId with_number(BodyId id, std::uint16_t world) {
  id.world = world;
  return id;
}
inline JointId with_number(JointId id, std::uint16_t world) {
  id.world = world;
  return id;
}

bool is_of_joint(const BatchReading& reading);
bool is_of_joint(const BatchAction& action);
int width_of(const BatchReading& reading);
int width_of(const BatchAction& action);
Error check_reading(const BatchReading& reading, std::size_t index, const World& world, std::uint16_t number);
Error check_action(const BatchAction& action, std::size_t index, const World& world, std::uint16_t number);
Error check_draw(const BatchDraw& draw, std::size_t index, const World& world, std::uint16_t number);

// Writes the numbers of a reading and returns the place behind them. `seconds` is the length of the last step. `points` is memory.
float* read_channel(const World& world, std::uint16_t number, const BatchReading& reading, float seconds,
                    std::vector<ContactPoint>& points, float* out);
// Forces act for one step, so they are applied before each; other actions before the first only. False if the world refused.
bool apply_action(World& world, std::uint16_t number, const BatchAction& action, const float* values,
                  bool first);

// The values of a draw: a function of its arguments alone.
Vec3 draw_values(const BatchDraw& draw, std::uint64_t seed, std::size_t world, std::uint64_t run,
                 std::size_t index);
bool apply_draw(World& world, std::uint16_t number, const BatchDraw& draw, Vec3 values);

}  // namespace gyre
