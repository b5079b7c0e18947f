// Typed, generational ids. An id is an 8-byte value; all-zero is null. An id that outlives its object never refers to
// another one: the generation differs, and so does the world's number for an id of another world.
#pragma once

#include <cstdint>

namespace gyre {

template <class Tag>
struct Id {
  std::uint32_t index = 0;       // which slot; reused after removal
  std::uint16_t generation = 0;  // which owner of the slot; 0 only in the null id
  std::uint16_t world = 0;       // which world of this process

  constexpr explicit operator bool() const { return generation != 0; }
  constexpr bool operator==(const Id&) const = default;
};

using BodyId = Id<struct BodyTag>;
using ShapeId = Id<struct ShapeTag>;
using JointId = Id<struct JointTag>;

}  // namespace gyre
