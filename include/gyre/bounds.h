// Bounding volumes: simple shapes around points. For each kind: fit, merge, overlap, contains, and what it costs (volume and
// surface). How tight they are for a mesh is printed by `gyre info`; docs/broad_phases.md says what each is good for.
//
// Points are in metres, in any one frame, and the fitted volume is in the same frame. It contains all points: contains() is true for each
// of them. All fits refuse an empty set of points, and points that are not finite or beyond 1e9 m, with the point's number. One point, and
// points on one line or plane, are allowed unless the fit says otherwise.
#pragma once

#include <gyre/geometry.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>

namespace gyre {

// ------------------------------------------------------------------------------------------------------------ sphere

struct BoundingSphere {
  Vec3 center{};
  float radius = 0.0f;
};

// In two passes over the points. Its radius is at most about a fifth above the smallest, usually a twentieth.
// J. Ritter, "An Efficient Bounding Sphere", Graphics Gems, 1990.
Result<BoundingSphere> fit_sphere_fast(std::span<const Vec3> points);
// The smallest sphere. E. Welzl, "Smallest Enclosing Disks (Balls and Ellipsoids)", 1991; with the farthest point
// first: B. Gaertner, "Fast and Robust Smallest Enclosing Balls", 1999.
Result<BoundingSphere> fit_sphere(std::span<const Vec3> points);
// The smallest sphere around both.
BoundingSphere merge(const BoundingSphere& a, const BoundingSphere& b);
bool overlap(const BoundingSphere& a, const BoundingSphere& b);
bool contains(const BoundingSphere& sphere, Vec3 point);
double volume(const BoundingSphere& sphere);        // m^3
double surface_area(const BoundingSphere& sphere);  // m^2

// -------------------------------------------------------------------------------------------------------------- boxes

// Aabb, its merge() and its overlap() are in gyre/math.h.
Result<Aabb> fit_box(std::span<const Vec3> points);
bool contains(const Aabb& box, Vec3 point);
double volume(const Aabb& box);
double surface_area(const Aabb& box);

// A box of any orientation: center + orientation * (half_extents times -1 to 1 each).
struct OrientedBox {
  Vec3 center{};
  Vec3 half_extents{};
  Quat orientation{};
};

// Along the principal axes of the surface of the points' convex hull. S. Gottschalk, M. Lin, D. Manocha, "OBBTree: A
// Hierarchical Structure for Rapid Interference Detection", 1996. In bad cases it has several times the least volume, since a cube has
// no principal axes.
Result<OrientedBox> fit_oriented_box_fast(std::span<const Vec3> points);
// A search for the least volume. For a given axis the best box is exact (rotating calipers). The search tries the normals of the hull's
// faces, and the normals of pairs of up to 64 edge directions, the longest first. Then it rotates the best few boxes about each of their own
// axes until none gets smaller. So the volume is never above that of the smallest box with a side on a face of the hull. It is the least
// volume if a side of the smallest box contains two edges of those tried.
// J. O'Rourke, "Finding Minimal Enclosing Boxes", 1985 (sides contain edges); H. Freeman, R. Shapira, 1975 (calipers);
// C. Chang, B. Gorissen, S. Melchior, "Fast Oriented Bounding Box Optimization on the Rotation Group", 2011 (the descent).
Result<OrientedBox> fit_oriented_box(std::span<const Vec3> points);
// Around both: the smallest of the boxes along either's axes and of fit_oriented_box() of their corners.
OrientedBox merge(const OrientedBox& a, const OrientedBox& b);
// The separating axis test with its 15 axes.
bool overlap(const OrientedBox& a, const OrientedBox& b);
bool contains(const OrientedBox& box, Vec3 point);
double volume(const OrientedBox& box);
double surface_area(const OrientedBox& box);

// ------------------------------------------------------------------------------------------------------------ capsule

// All points within `radius` of the segment from a to b.
struct BoundingCapsule {
  Vec3 a{};
  Vec3 b{};
  float radius = 0.0f;
};

// For a given direction, the radius is that of the smallest circle around the points projected along it, and the ends are as close as the
// caps allow. The direction is the best of the principal axes and the longest distance between points, improved by a search in steps down
// to 1e-4 rad. It need not be the optimal one.
Result<BoundingCapsule> fit_capsule(std::span<const Vec3> points);
// Around both; the larger one itself if it contains the other.
BoundingCapsule merge(const BoundingCapsule& a, const BoundingCapsule& b);
bool overlap(const BoundingCapsule& a, const BoundingCapsule& b);
bool contains(const BoundingCapsule& capsule, Vec3 point);
double volume(const BoundingCapsule& capsule);
double surface_area(const BoundingCapsule& capsule);

// -------------------------------------------------------------------------------------------------------------- k-DOP

// The space between pairs of planes of fixed directions. J. Klosowski et al., "Efficient Collision Detection Using Bounding
// Volume Hierarchies of k-DOPs", 1998. The number counts the planes.
enum class KDopKind : std::uint8_t {
  k14,  // the axes, and the four diagonals of a cube
  k18,  // the axes, and the six diagonals of its faces
  k26,  // all of these
};
constexpr int kMaxKDopDirections = 13;

struct KDop {
  KDopKind kind = KDopKind::k14;
  // By direction (k_dop_direction): low <= dot(direction, p) <= high. Components of directions are 1, 0 and -1; not unit length.
  float low[kMaxKDopDirections] = {};
  float high[kMaxKDopDirections] = {};
};
int k_dop_directions(KDopKind kind);  // how many: half of the planes
Vec3 k_dop_direction(KDopKind kind, int index);

Result<KDop> fit_k_dop(std::span<const Vec3> points, KDopKind kind);
// The smallest k-DOP around both, which must be of one kind.
KDop merge(const KDop& a, const KDop& b);
// Returns true if no plane of their directions separates the two volumes. Volumes that overlap give true, and some that nearly do.
bool overlap(const KDop& a, const KDop& b);
bool contains(const KDop& dop, Vec3 point);
double volume(const KDop& dop);
double surface_area(const KDop& dop);

// --------------------------------------------------------------------------------------------------------------- hull

// cook_hull() of gyre/geometry.h makes the convex hull. It refuses points on one line or plane, and points may lie outside of it by a
// relative 1e-6. For cooked hulls:
Result<Geometry> merge_hulls(const Geometry& a, const Geometry& b);  // the hull of both
bool hulls_overlap(const Geometry& a, const Geometry& b);            // by the distance of GJK; in one frame
double hull_volume(const Geometry& hull);
double hull_surface_area(const Geometry& hull);

// ------------------------------------------------------------------------------------------------------------- compare

enum class BoundKind : std::uint8_t {
  sphere_fast,
  sphere,
  box,
  oriented_box_fast,
  oriented_box,
  capsule,
  k_dop_14,
  k_dop_18,
  k_dop_26,
  hull,
};
constexpr int kBoundKindCount = 10;
const char* to_string(BoundKind kind);

struct BoundCost {
  double volume = 0.0;        // m^3
  double surface_area = 0.0;  // m^2
};
// Volume and surface of a fit of this kind. The ratio of its volume to that of the bounded mesh measures how tight it is.
Result<BoundCost> bound_cost(std::span<const Vec3> points, BoundKind kind);

}  // namespace gyre
