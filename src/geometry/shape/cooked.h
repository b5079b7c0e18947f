// The data that a Geometry points to: one cooked hull, mesh or height field, immutable once it is shared.
//
// cook_hull, cook_mesh and cook_height_field fill it. The pointer that `kind` names is set; the other two are null.
#pragma once

#include <gyre/geometry.h>

#include <cstdint>
#include <memory>

namespace gyre {

struct Hull;
struct Mesh;
struct HeightField;

struct CookedGeometry {
  ShapeKind kind = ShapeKind::hull;  // hull, mesh or height_field
  // of everything that was cooked; equal data has equal hashes on every platform
  std::uint64_t content_hash = 0;
  std::unique_ptr<Hull> hull;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<HeightField> field;

  // Defined in cooked.cpp, which has the complete types.
  CookedGeometry();
  ~CookedGeometry();
  CookedGeometry(const CookedGeometry&) = delete;
  CookedGeometry& operator=(const CookedGeometry&) = delete;
};

}  // namespace gyre
