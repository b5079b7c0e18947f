// Shapes as bytes. Simple shapes are written where they stand; cooked geometry is written once into a table and named by
// its content hash. What is read back is bit for bit what was cooked: hulls come with all their columns, meshes with their
// triangles (the tree and the surroundings of triangles are built anew from them), height fields are cooked again.
#pragma once

#include "base/container/flat_map.h"
#include "io/codec/bytes.h"

#include <gyre/geometry.h>
#include <gyre/result.h>

#include <vector>

namespace gyre {

// Cooked geometry by content hash.
class GeometryTable {
 public:
  // False if it was there already.
  bool add(const Geometry& geometry);
  // Adds what `shape` refers to, if it is cooked; true if that is new.
  bool add(const AnyShape& shape);
  // Null if it is not there.
  const Geometry* find(std::uint64_t content_hash) const;
  const std::vector<Geometry>& items() const { return items_; }

 private:
  std::vector<Geometry> items_;
  FlatMap<std::uint32_t> index_of_;
};

inline void put_vector(ByteWriter& out, Vec3 v) { out.put(v.x), out.put(v.y), out.put(v.z); }

// One cooked hull, mesh or height field.
void write_geometry(ByteWriter& out, const Geometry& geometry);
// `known` may hold it already: then it is shared instead of built. The error says what is wrong with the bytes.
Result<Geometry> read_geometry(ByteReader& in, const GeometryTable& known);

// A count and all items, and back; items that were not in the table are added.
void write_geometry_table(ByteWriter& out, const GeometryTable& table);
Error read_geometry_table(ByteReader& in, GeometryTable& table);

// Any shape; cooked ones by their content hash.
void write_shape(ByteWriter& out, const AnyShape& shape);
// Fails the reader if the kind does not exist or the cooked geometry is not in the table.
AnyShape read_shape(ByteReader& in, const GeometryTable& table);

}  // namespace gyre
