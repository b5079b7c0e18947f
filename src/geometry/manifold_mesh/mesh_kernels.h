// Triangles of a surface looked at side by side, beside one convex shape that is placed (local_convex.h): a kernel, since a
// processor with eight lanes does most looks at a mesh by half of the instructions.
//
// In: triangles by number, columns of the shape. Out: which of them have boxes near the shape; and of up to eight triangles how
// they lie seen from the shape, which of them it may touch, and which are certainly out of its reach.
//
// Left out is what has all of the shape behind its plane or farther before it than asked, what lies farther before one of the
// shape's faces, and what mesh_apart_lanes.h knows to be apart.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// What kernels read of a placed shape's core; of a curved one there are no columns.
struct ConvexColumns {
  enum class Core : std::uint8_t { ball, segment, box, polyhedron, curved };
  Core core;
  int vertex_count, face_count;
  const float *x, *y, *z;
  const float *nx, *ny, *nz, *offset;  // of the faces' planes
  Vec3 axes[3];                        // of the shape's own frame
  Aabb local_box;                      // of the surface, in that frame
  Vec3 half;                           // of a box's core
  Vec3 center;                         // a point well inside
  float radius, size;
};

// Triangles of which three indices name the corners.
struct TriangleColumns {
  const Vec3* vertices;
  const std::uint32_t* indices;
  const Vec3* normals;
  bool double_sided;
};

// Which boxes count: those that overlap `outer` and either overlap `inner` or may be touched within `reach`. `position` is the place
// of the shape's origin.
struct NearBoxes {
  Aabb outer, inner;
  Vec3 position;
  float reach;
};

// As LocalTriangle and LocalConvex::Extent (mesh_axis.h, local_convex.h), side by side. Not cleared: what is behind the last triangle
// is never read, nor edges where none may be touched.
struct TriangleBatch {
  static constexpr int kCount = 8;
  typedef float Column[kCount];
  struct Columns {
    Column x, y, z;
    Vec3 operator[](int i) const { return {x[i], y[i], z[i]}; }
  };

  unsigned touchable;  // bits of the triangles that are not left out
  unsigned
      apart;  // bits of those that are out of reach of the nearest points too, whatever lies before or behind
  unsigned turned;   // bits of those that are seen from behind
  Column low, high;  // the core's extent along the normal; of a curved core it must be known before
  Column slack;
  Columns corner[3], normal;
  Columns along[3], outward[3];
  Column length[3];
};

struct MeshKernels {
  // Of up to 32 triangles: bits of those whose boxes count.
  std::uint32_t (*find_near)(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
                             const ConvexColumns& convex, const NearBoxes& boxes);
  // Of up to TriangleBatch::kCount.
  void (*place)(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
                const ConvexColumns& convex, Vec3 position, float max_separation, TriangleBatch& out);
};

// Those that this machine runs best.
const MeshKernels& select_mesh_kernels();

}  // namespace gyre
