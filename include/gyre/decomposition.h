// Convex decomposition: a concave triangle mesh as a few convex hulls, so that a moving body can have its shape.
//
// The mesh is cut by planes where that takes most away from the hulls of the parts, until every part is nearly convex; then
// neighbours are joined again as long as their common hull is nearly convex, too. "Nearly" is a distance: a hull reaches
// at most `concavity` times the size of the mesh beyond the solid, and no open surface lies deeper than that below a hull, so
// holes, slots and cavities that are wider or deeper stay open. Hulls are made of the mesh's own vertices and of exact cuts
// through its triangles: nothing is rounded to voxels, and flat sides and sharp edges stay what they are.
//
// Same mesh and settings, same bits: on every platform, for any number of threads.
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

// What the triangles mean.
enum class SurfaceMeaning : std::uint8_t {
  automatic,  // solid if the surface bounds one but for small holes, else shell
  solid,      // the border of a solid; holes are closed as the winding number sees it (inside = above 0.4)
  shell,      // a sheet of thickness `shell_thickness`, the surface in its middle
};
constexpr int kSurfaceMeaningCount = 3;
const char* to_string(SurfaceMeaning meaning);

struct DecompositionDef {
  std::span<const Vec3> vertices{};          // m
  std::span<const std::uint32_t> indices{};  // three a triangle, counter-clockwise seen from outside
  // What a part may lack to be convex, as a part of the size (diameter of the smallest sphere around the mesh): 0.001 to 1.
  // Halving it makes two to four times as many hulls of a round thing, and not one more of what is made of boxes.
  float concavity = 0.02f;
  int max_hulls = 32;           // 1 to 1024; when they do not suffice, the report says what was reached
  int max_hull_vertices = 128;  // 8 to 255; few hulls need as many
  SurfaceMeaning meaning = SurfaceMeaning::automatic;
  float shell_thickness = 0.0f;  // m; 0 = half of `concavity` times the size
  int threads = 1;  // workers, this thread included; 0 = as many as the machine has; never changes a bit
  // Called now and then, in the thread that called decompose(), with what is done, 0 to 1, never falling. False stops the work.
  bool (*progress)(void* user, float done) = nullptr;
  void* user = nullptr;
};

// What was found in the mesh, all zeros for a closed surface wound alike. None of it is refused; each changes what
// "solid" means as described.
struct MeshFindings {
  std::uint32_t open_edges = 0;     // edges with a triangle on one side only
  std::uint32_t crowded_edges = 0;  // edges of more than two triangles
  std::uint32_t turned_triangles =
      0;  // wound against their neighbours, or a whole surface that was inside out
  std::uint32_t left_out_triangles = 0;  // without area
  float openness = 0.0f;  // part of the surface near which inside and outside run into each other, 0 to 1
  bool shell = false;     // the triangles were taken for a sheet, see SurfaceMeaning
};

// What the hulls are like, measured on what is handed out.
struct DecompositionReport {
  MeshFindings mesh{};
  float size = 0.0f;             // m, diameter of the smallest sphere around the mesh
  float shell_thickness = 0.0f;  // m; 0 = no shell
  // The farthest that a hull reaches from the solid (m): found by subdividing the hulls' surfaces, true within
  // overhang_bound, above which it cannot be.
  float overhang = 0.0f;
  float overhang_bound = 0.0f;
  float depth =
      0.0f;  // m, the deepest that open surface lies below a hull's: slots, holes, cavities that were filled
  float uncovered = 0.0f;       // m, the farthest that surface lies outside of all hulls
  float sample_spacing = 0.0f;  // m, between the points of the surface at which the last two were measured
  double solid_volume = 0.0;    // m^3; volumes by some 10,000 lines through the solid, within about 0.1 %
  double hull_volume = 0.0;     // m^3, of all hulls together, overlaps counted once
  double excess_volume = 0.0;   // m^3, in hulls and not in the solid
  double missing_volume = 0.0;  // m^3, in the solid and in no hull
  bool within_concavity =
      true;  // false: max_hulls was too small for `concavity`, or a part could not be cut on
};

struct Decomposition {
  std::vector<Geometry> hulls;
  DecompositionReport report{};
};

// Cuts the mesh into hulls. Refuses indices out of range, vertices that are not finite (with their number), meshes without
// area or of less than 1e-6 m, and settings out of range. Error code `cancelled` when `progress` said so.
Result<Decomposition> decompose(const DecompositionDef& def);

// A hash of the mesh, the settings that matter (not threads and progress) and the version of the method: the name under which a
// result can be kept. Equal keys, equal results.
std::uint64_t decomposition_key(const DecompositionDef& def);

// A decomposition as bytes, to be kept under its key, and back. Bytes that are cut short, damaged, of another key or of another
// version are refused: then decompose anew. What is loaded has the same hulls, bit for bit.
std::vector<std::byte> save_decomposition(const Decomposition& decomposition, std::uint64_t key);
Result<Decomposition> load_decomposition(std::span<const std::byte> bytes, std::uint64_t key);

}  // namespace gyre
