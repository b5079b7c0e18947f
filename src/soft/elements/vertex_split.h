// Splits vertices of triangles or tetrahedra, along edges or faces.
//
// In: corners of elements, 3 or 4 each, and for a vertex the side of a plane on which each element around it lies. Out: corners in which elements that
// no longer hang together at the vertex have vertices of their own. Elements hang together if they have an edge (a face) at the vertex in common and
// lie on one side. The group of the first element keeps the vertex; the others get new numbers, in the order of their first elements. Elements keep
// their numbers.
#pragma once

#include "base/container/array.h"

#include <cstdint>
#include <span>

namespace gyre {

class VertexSplitter {
 public:
  // `corners` is changed by split(). `vertices`: how many there are.
  VertexSplitter(std::span<std::uint32_t> corners, int arity, std::uint32_t vertices);

  // The elements around a vertex, ascending.
  std::span<const std::uint32_t> around(std::uint32_t vertex);
  // `beyond[i]`: the side of around(vertex)[i]. Appends the new vertices to `made`.
  void split(std::uint32_t vertex, std::span<const std::uint8_t> beyond, Array<std::uint32_t>& made);
  // Takes back all splits since there were `vertices` vertices.
  void undo(std::uint32_t vertices);
  // The vertex that it was at the beginning.
  std::uint32_t source(std::uint32_t vertex) const { return source_[vertex]; }
  std::uint32_t vertices() const { return std::uint32_t(source_.size()); }

 private:
  bool hang_together(std::uint32_t a, std::uint32_t b, std::uint32_t vertex) const;

  std::span<std::uint32_t> corners_;
  std::uint32_t arity_;
  Array<std::uint32_t> begin_, elements_;  // around each vertex, as they were
  Array<std::uint32_t> source_;            // the vertex that it was then
  Array<std::uint32_t> listed_, waiting_;
  Array<std::int32_t> group_;
  struct Change {
    std::uint32_t place = 0;   // in the corners
    std::uint32_t before = 0;  // the vertex that was there
  };
  Array<Change> changes_;
};

}  // namespace gyre
