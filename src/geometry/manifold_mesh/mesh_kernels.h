// Kernels that test triangles of a surface side by side against one convex shape in local form (local_convex.h). A
// processor with eight lanes needs half of the instructions for most meshes.
//
// In: triangles by number, columns of the shape. Out: which triangles have boxes near the shape; and of up to eight
// triangles their local form, which of them the shape may touch, and which are certainly too far away.
//
// A triangle is excluded if the shape lies behind its plane or too far before it, if the triangle lies too far before
// one of the shape's faces, or if mesh_apart_lanes.h separates the two.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// The core of a convex shape in the form that kernels read. A curved core has no columns.
struct ConvexColumns {
  enum class Core : std::uint8_t { ball, segment, box, polyhedron, curved };
  Core core;
  int vertex_count, face_count;
  const float *x, *y, *z;
  const float *nx, *ny, *nz, *offset;  // of the planes of the faces
  Vec3 axes[3];                        // axes of the shape's own frame
  Aabb local_box;                      // of the surface, in that frame
  Vec3 half;                           // of the core of a box
  Vec3 center;                         // a point well inside the shape
  float radius, size;
};

// Triangles whose corners three indices name.
struct TriangleColumns {
  const Vec3* vertices;
  const std::uint32_t* indices;
  const Vec3* normals;
  bool double_sided;
};

// A triangle counts if its box overlaps `outer`, and also overlaps `inner` or may be within `max_distance` of the
// shape. `position` is the origin of the shape.
struct NearBoxes {
  Aabb outer, inner;
  Vec3 position;
  float max_distance;
};

// LocalTriangle and LocalConvex::Extent (mesh_axis.h, local_convex.h) side by side. Not cleared: elements after the
// last triangle are never read, nor edges if no triangle may be touched.
struct TriangleBatch {
  static constexpr int kCount = 8;
  typedef float Column[kCount];
  struct Columns {
    Column x, y, z;
    Vec3 operator[](int i) const { return {x[i], y[i], z[i]}; }
  };

  unsigned touchable;  // bits of the triangles that are not excluded
  unsigned apart;      // bits of the triangles that are too far away for their closest points too
  unsigned flipped;    // bits of the triangles that are seen from behind
  Column low, high;    // extent of the core along the normal; of a curved core an input
  Column slack;
  Columns corner[3], normal;
  Columns along[3], outward[3];
  Column length[3];
};

struct MeshKernels {
  // Of up to 32 triangles: bits of those that count.
  std::uint32_t (*find_near)(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
                             const ConvexColumns& convex, const NearBoxes& boxes);
  // Of up to TriangleBatch::kCount triangles.
  void (*load)(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
               const ConvexColumns& convex, Vec3 position, float max_separation, TriangleBatch& out);
};

// The fastest kernels on this machine.
const MeshKernels& select_mesh_kernels();

}  // namespace gyre
