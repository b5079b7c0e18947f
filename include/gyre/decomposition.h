// Convex decomposition: approximates a concave triangle mesh by a few convex hulls, so that a moving body can have its shape.
//
// Planes cut the mesh where a cut reduces the hulls of the parts most, until every part is nearly convex. Then neighbours are merged
// as long as their common hull is nearly convex. "Nearly" is a distance: a hull extends at most `concavity` times the size of the mesh
// beyond the solid, and no open surface lies deeper than that below a hull. So wider or deeper holes, slots and cavities stay open.
// Hulls consist of the mesh's own vertices and of exact cuts through its triangles. Nothing is rounded to voxels, so flat sides and sharp
// edges are preserved.
//
// The same mesh and settings give the same bits on every platform and for any number of threads.
//
// X. Wei, M. Liu, Z. Ling, H. Su, "Approximate Convex Decomposition for 3D Meshes with Collision-Aware Concavity and Tree
// Search", 2022 (CoACD: distances, not volumes, say what is concave; joining after cutting); K. Mamou, E. Lengyel, A. Peters,
// "Volumetric Hierarchical Approximate Convex Decomposition", 2016 (V-HACD); J.-M. Lien, N. Amato, "Approximate Convex
// Decomposition of Polyhedra", 2007 (depth below the hull as concavity, cuts at notches).
#pragma once

#include <gyre/geometry.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// The meaning of the triangles.
enum class SurfaceMeaning : std::uint8_t {
  automatic,  // solid if the surface bounds a solid except for small holes, otherwise shell
  solid,      // the boundary of a solid; the winding number closes holes (inside = above 0.4)
  shell,      // a sheet of thickness `shell_thickness`, the surface in its middle
};
constexpr int kSurfaceMeaningCount = 3;
const char* to_string(SurfaceMeaning meaning);

struct DecompositionDef {
  std::span<const Vec3> vertices{};          // m
  std::span<const std::uint32_t> indices{};  // three a triangle, counter-clockwise seen from outside
  // The allowed concavity of a part, relative to the size (diameter of the smallest sphere around the mesh): 0.001 to 1. Half of it
  // needs two to four times as many hulls for a round mesh, and no more for a mesh of boxes.
  float concavity = 0.02f;
  int max_hulls = 32;           // 1 to 1024; DecompositionStats says what was reached if they do not suffice
  int max_hull_vertices = 128;  // 8 to 255; few hulls need as many
  SurfaceMeaning meaning = SurfaceMeaning::automatic;
  float shell_thickness = 0.0f;  // m; 0 = half of `concavity` times the size
  int threads = 1;  // workers, this thread included; 0 = as many as the machine has; never changes a bit
  // Called now and then in the thread that called decompose(), with the progress from 0 to 1, which never falls. False cancels the work.
  bool (*progress)(void* user, float done) = nullptr;
  void* user = nullptr;
};

// Defects of the mesh; all zero for a closed surface with consistent winding. No defect is refused.
struct MeshFindings {
  std::uint32_t open_edges = 0;     // edges with a triangle on one side only
  std::uint32_t non_manifold_edges = 0;   // edges of more than two triangles
  std::uint32_t flipped_triangles = 0;    // wound against their neighbours or inside out; their winding was reversed
  std::uint32_t degenerate_triangles = 0;  // without area, nor a neighbour to join; left out
  float openness = 0.0f;  // share of the surface near which inside and outside cannot be told apart, 0 to 1
  bool shell = false;     // the triangles are a sheet, see SurfaceMeaning
};

// Quality of the decomposition, measured on the resulting hulls.
struct DecompositionStats {
  MeshFindings mesh{};
  float size = 0.0f;             // m, diameter of the smallest sphere around the mesh
  float shell_thickness = 0.0f;  // m; 0 = no shell
  // m, the largest distance of a hull from the solid, found by subdividing the hulls' surfaces. overhang_bound is an upper bound of it.
  float overhang = 0.0f;
  float overhang_bound = 0.0f;
  float depth = 0.0f;      // m, the largest depth of open surface below a hull: slots, holes, cavities that were filled
  float uncovered = 0.0f;  // m, the largest distance of surface outside all hulls
  float sample_spacing = 0.0f;  // m, between the surface points at which depth and uncovered were measured
  double solid_volume = 0.0;    // m^3; exact if the mesh is closed and no parts overlap, else as below
  // m^3, of all hulls together, overlaps counted once; by 10,946 lines through the solid, within about 0.1 %
  double hull_volume = 0.0;
  double excess_volume = 0.0;   // m^3, in hulls and not in the solid
  double missing_volume = 0.0;  // m^3, in the solid and in no hull
  bool within_concavity = true;  // false: max_hulls was too small for `concavity`, or a part could not be cut further
};

struct Decomposition {
  std::vector<Geometry> hulls;
  DecompositionStats stats{};
};

// Decomposes the mesh. Refuses indices out of range, vertices that are not finite (with their number), meshes without area or smaller
// than 1e-6 m, and settings out of range. Error code `cancelled` if `progress` returned false.
Result<Decomposition> decompose(const DecompositionDef& def);

// A hash of the mesh, the settings (without threads and progress) and the version of the method, as the key of a cached result. Equal
// keys have equal results.
std::uint64_t decomposition_key(const DecompositionDef& def);

// A decomposition as bytes for a cache, and back. Bytes that are cut short, damaged, of another key or of another version are refused;
// decompose again then. The loaded hulls are equal to the saved ones, bit for bit.
std::vector<std::byte> save_decomposition(const Decomposition& decomposition, std::uint64_t key);
Result<Decomposition> load_decomposition(std::span<const std::byte> bytes, std::uint64_t key);

}  // namespace gyre
