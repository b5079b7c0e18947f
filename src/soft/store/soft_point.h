// Points of elements: the mean of the corners of a triangle of a cloth or a tetrahedron of a solid, by weight.
//
// Elements are numbered in the order of the definition where something may be torn, and else as they are stored; neither order changes while the entry lives.
#pragma once

#include "soft/store/soft_store.h"

#include <gyre/math.h>
#include <gyre/soft.h>

#include <cstdint>
#include <span>

namespace gyre {

// The corners of an element as it is now: three or four. None: there is no such element, as of a rope.
struct ElementCorners {
  std::uint32_t corner[4] = {};
  int count = 0;

  bool has(std::uint32_t particle) const {
    for (int k = 0; k < count; ++k)
      if (corner[k] == particle) return true;
    return false;
  }
};
std::uint32_t element_count(const SoftEntry& entry);
ElementCorners corners_of(const SoftEntry& entry, std::uint32_t element);

DVec3 place_of(const SoftEntry& entry, const SoftPointAttachment& point);

// The element with all vertices of a point that have a weight, and the weights in the order of its corners. False: there is none.
bool find_element(const SoftEntry& entry, const SoftPoint& point, SoftPointAttachment& out);
// The point of all elements that is nearest; without vertices where there are no elements.
SoftPoint find_nearest_point(const SoftEntry& entry, DVec3 place);

}  // namespace gyre
