// Typed, generational ids. An id is an 8-byte value; the id of zeros is null. An id that outlives its object never refers to another
// object, because the generation differs. An id of another world differs in the number of the world.
#pragma once

#include <cstdint>

namespace gyre {

template <class Tag>
struct Id {
  std::uint32_t index = 0;       // of the slot; reused after removal
  std::uint16_t generation = 0;  // of the slot's owner; 0 only in the null id
  // Number of the world in this process, 1 to 65,535. Numbers repeat after that many worlds, and an id of the world with the same number
  // is then not told apart.
  std::uint16_t world = 0;

  constexpr explicit operator bool() const { return generation != 0; }
  constexpr bool operator==(const Id&) const = default;
};

using BodyId = Id<struct BodyTag>;
using ShapeId = Id<struct ShapeTag>;
using JointId = Id<struct JointTag>;
using FieldId = Id<struct FieldTag>;
using SoftId = Id<struct SoftTag>;
using FluidId = Id<struct FluidTag>;

}  // namespace gyre
