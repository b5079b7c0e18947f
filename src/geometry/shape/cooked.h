// What a Geometry points to: one cooked hull, mesh or height field, immutable once it is shared.
//
// In: filled by cook_hull, cook_mesh and cook_height_field, each in the file of its kind. Out: the one pointer that `kind`
// names is set, the other two are empty.
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
  std::uint64_t content_hash = 0;  // of everything that was cooked; equal data, equal hash, on every platform
  std::unique_ptr<Hull> hull;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<HeightField> field;

  // In cooked.cpp, where the three types are complete.
  CookedGeometry();
  ~CookedGeometry();
  CookedGeometry(const CookedGeometry&) = delete;
  CookedGeometry& operator=(const CookedGeometry&) = delete;
};

}  // namespace gyre
