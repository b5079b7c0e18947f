// A convex polyhedron as columns for wide search: vertices as three padded float arrays, faces as planes with loops of
// vertex indices, and each edge once with its two faces.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <vector>

namespace gyre {

struct HullPlane {
  Vec3 normal;   // unit, outward
  float offset;  // dot(normal, p) = offset on the face
};

struct HullEdge {
  std::uint8_t from, to;     // vertices, in the loop order of face `left`
  std::uint8_t left, right;  // the two faces
  Vec3 direction{};          // from `from` to `to`
};

static_assert(sizeof(HullPlane) == 16 && sizeof(HullEdge) == 16, "records that are read as four numbers");

// The limits of a hull: all indices but edge indices fit in a byte.
constexpr int kMaxHullVertices = 255;
constexpr int kMaxHullFaces = 255;
constexpr int kMaxHullEdges = 510;

struct Hull {
  // x, y and z of all vertices, each padded to a multiple of kPad with copies of the last vertex.
  static constexpr int kPad = 8;
  std::vector<float> x, y, z;
  std::vector<Vec3> vertices;  // the same vertices as vectors, unpadded
  std::vector<HullPlane> planes;
  std::vector<std::uint32_t> face_offsets;  // faces + 1, into face_vertices
  std::vector<std::uint8_t> face_vertices;  // loops, counter-clockwise seen from outside
  std::vector<HullEdge> edges;
  // The edges at each vertex: a bit for each edge, in edge_words() words per vertex.
  std::vector<std::uint64_t> edges_of;
  Aabb box;
  Vec3 centroid;              // of the volume
  float inner_radius = 0.0f;  // smallest distance from the centroid to a face plane

  int vertex_count() const { return int(vertices.size()); }
  int face_count() const { return int(planes.size()); }
  int edge_words() const { return int(edges.size() + 63) / 64; }
};

// Fills the columns, the box, the directions of edges and `edges_of`, from the vertices and the ends of the edges.
void complete_hull(Hull& hull);

// The vertex farthest along `direction` (the lowest index among equals).
int support_vertex(const Hull& hull, Vec3 direction);
// The face whose outward normal is closest to `direction` (the lowest index among equals).
int support_face(const Hull& hull, Vec3 direction);

}  // namespace gyre
