// Shapes. Simple ones are plain values; hulls, meshes and height fields are cooked once into shared, immutable data.
// Lengths are in metres, in the frame of the shape (ShapeDef::local gives its pose on a body).
#pragma once

#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <memory>
#include <span>
#include <variant>

namespace gyre {

enum class ShapeKind : std::uint8_t { sphere, box, capsule, cylinder, cone, hull, plane, mesh, height_field };
constexpr int kShapeKindCount = 9;
const char* to_string(ShapeKind kind);

// A ball around the origin.
struct Sphere {
  float radius = 0.5f;
};

// A box around the origin. `rounding` rounds edges and corners with that radius, inside the given extents.
struct Box {
  Vec3 half_extents{0.5f, 0.5f, 0.5f};
  float rounding = 0.0f;
};

// All points within `radius` of the segment from (0, -half_height, 0) to (0, half_height, 0).
struct Capsule {
  float radius = 0.3f;
  float half_height = 0.5f;  // without the caps
};

// A solid cylinder about local y.
struct Cylinder {
  float radius = 0.5f;
  float half_height = 0.5f;
};

// A solid cone about local y: apex at +half_height, base at -half_height.
struct Cone {
  float radius = 0.5f;
  float half_height = 0.5f;
};

// The half-space on and below the plane {p : dot(normal, p) = offset}. Only for fixed and kinematic bodies.
struct Plane {
  Vec3 normal{0, 1, 0};  // any length but zero
  float offset = 0.0f;
};

struct CookedGeometry;

// A cooked hull, mesh or height field. It is immutable and shared: a copy copies a pointer.
class Geometry {
 public:
  Geometry() = default;
  explicit Geometry(std::shared_ptr<const CookedGeometry> data) : data_(std::move(data)) {}
  explicit operator bool() const { return data_ != nullptr; }
  ShapeKind kind() const;
  // A hash of the cooked data; equal data have equal hashes on every platform.
  std::uint64_t content_hash() const;
  const CookedGeometry* data() const { return data_.get(); }
  const std::shared_ptr<const CookedGeometry>& shared() const { return data_; }

 private:
  std::shared_ptr<const CookedGeometry> data_;
};

// Any shape.
using AnyShape = std::variant<Sphere, Box, Capsule, Cylinder, Cone, Plane, Geometry>;

// The convex hull of at least four points that span a volume; at most 255 vertices remain (fewest that keep the shape
// within a relative 1e-6). Refuses non-finite, too few, collinear and coplanar points with the reason.
// C. Barber, D. Dobkin, H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996.
Result<Geometry> cook_hull(std::span<const Vec3> points);

// The vertices and faces of a cooked hull: faces are loops of vertex indices, counter-clockwise seen from outside;
// face i uses face_indices[face_offsets[i]] up to face_indices[face_offsets[i + 1]] (exclusive).
struct HullView {
  std::span<const Vec3> vertices{};
  std::span<const std::uint32_t> face_offsets{};  // number of faces + 1
  std::span<const std::uint8_t> face_indices{};
};
HullView view_hull(const Geometry& hull);

struct MeshDef {
  std::span<const Vec3> vertices{};
  std::span<const std::uint32_t> indices{};  // three a triangle, counter-clockwise seen from the solid side's outside
  bool double_sided = false;               // the back of the triangles collides too
  // Empty, or one number a triangle: SurfaceRule::id of its material; 0 = the material of the shape.
  std::span<const std::uint16_t> materials{};
};
// A triangle mesh for fixed and kinematic bodies. Triangles without area are left out; indices out of range and non-finite vertices are
// refused with the number of the triangle or vertex. Edges within a flat or concave region are marked as internal, so that sliding bodies
// have no ghost collisions with them.
Result<Geometry> cook_mesh(const MeshDef& def);
struct MeshView {
  std::span<const Vec3> vertices{};
  std::span<const std::uint32_t> indices{};
};
MeshView view_mesh(const Geometry& mesh);

struct HeightFieldDef {
  // heights[row * columns + column], in metres along y; a NaN makes a hole: every cell that uses it is open.
  // The sample (column, row) lies at x = (column - (columns - 1) / 2) * spacing, z = (row - (rows - 1) / 2) * spacing.
  std::span<const float> heights{};
  std::uint32_t columns = 0;  // samples along x, at least 2
  std::uint32_t rows = 0;     // samples along z, at least 2
  float spacing = 1.0f;       // m
};
// A grid of heights for fixed and kinematic bodies; each cell is two triangles, solid below. Infinite heights are refused.
Result<Geometry> cook_height_field(const HeightFieldDef& def);
struct HeightFieldView {
  std::span<const float> heights{};
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  float spacing = 0.0f;
};
HeightFieldView view_height_field(const Geometry& field);

// ---------------------------------------------------------------------------------------------------- mass properties

// Mass (kg), centre of mass (m) and inertia tensor about the centre of mass (kg m^2), in the frame of the shape or body.
struct MassProperties {
  float mass = 0.0f;
  Vec3 center{};
  Sym3 inertia{};
};

// Mass properties of a solid of uniform density (kg/m^3), closed forms; hulls and closed meshes by exact integrals
// (B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996). Planes, height fields and
// meshes with an open or inconsistently wound edge are refused with the edge.
Result<MassProperties> mass_properties(const AnyShape& shape, float density);
MassProperties hollow_sphere_mass(float radius, float density_per_area);            // thin shell, kg/m^2
MassProperties ellipsoid_mass(Vec3 semi_axes, float density);
MassProperties tetrahedron_mass(Vec3 a, Vec3 b, Vec3 c, Vec3 d, float density);
// Exact volume integrals over a closed triangle mesh; the error names the first open or inconsistent edge.
Result<MassProperties> mesh_mass(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices, float density);
// An estimate that counts voxels (`resolution` along the longest side) by ray parity: a cross-check of the exact integrals, and the method
// for meshes with holes. The relative error is about 1/resolution.
Result<MassProperties> voxel_mass(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices, float density,
                                  int resolution = 64);

// The same body seen from another frame: p -> t * p.
MassProperties transformed(const MassProperties& mass, const Transform& t);
// The sum of rigidly joined parts about their common centre of mass, by the parallel-axis theorem (Huygens-Steiner).
MassProperties combined(std::span<const MassProperties> parts);

// Principal moments (kg m^2, ascending) and the orientation of the principal axes: inertia = R diag(moments) R^T.
struct PrincipalAxes {
  Vec3 moments{};
  Quat orientation{};
};
PrincipalAxes principal_axes(const Sym3& inertia);
// Checks that a body can have this inertia tensor: its principal moments are positive and none is above the sum of the other two (within
// a relative 1e-4). The error names the axis.
Error check_inertia(const Sym3& inertia);

}  // namespace gyre
