// Shapes as bytes. Simple shapes are written in place; cooked geometry is written once to a table and named by its
// content hash. The geometry read back equals the cooked one bit for bit: hulls are stored with all columns, meshes
// with their triangles (tree and neighbours are built again), height fields are cooked again.
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
  // False if it was in the table already.
  bool add(const Geometry& geometry);
  // Adds the cooked geometry of `shape`, if it has any. True if it is new.
  bool add(const AnyShape& shape);
  // Null if it is missing.
  const Geometry* find(std::uint64_t content_hash) const;
  const std::vector<Geometry>& items() const { return items_; }

 private:
  std::vector<Geometry> items_;
  FlatMap<std::uint32_t> index_of_;
};

inline void put_vector(ByteWriter& out, Vec3 v) { out.put(v.x), out.put(v.y), out.put(v.z); }

// Writes one cooked hull, mesh or height field.
void write_geometry(ByteWriter& out, const Geometry& geometry);
// Geometry that is in `known` is shared instead of built. The error describes the fault in the bytes.
Result<Geometry> read_geometry(ByteReader& in, const GeometryTable& known);

// A count and all items. Items that are missing in the table are added when read.
void write_geometry_table(ByteWriter& out, const GeometryTable& table);
Error read_geometry_table(ByteReader& in, GeometryTable& table);

// Any shape; cooked ones by their content hash.
void write_shape(ByteWriter& out, const AnyShape& shape);
// The reader fails if the kind does not exist or the cooked geometry is missing in the table.
AnyShape read_shape(ByteReader& in, const GeometryTable& table);

}  // namespace gyre
