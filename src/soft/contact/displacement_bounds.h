// Bounds on moves: shortens the moves of vertices so that no two features of soft surfaces cross on the way, and none comes nearer than
// a share of its thickness.
//
// In: pairs from find_surface_pairs(), and the moves of the vertices. Out: moves that are bounded. Where pairs were found for moves up to
// limits about no move at all, these limits; where they were found for a plan, none: the caller sees how far moves end from it.
//
// Proof. Let n be the normal of a pair, a the least n.x over the vertices of its feature A and b the greatest over those of B; g = a - b. If g > 0, n
// separates the features: n.p >= a for every point p of A, since p is a mean of its vertices, and n.p <= b on B. Each pair is given two numbers r, s >= 0
// with r + s <= max(0, g - least gap). Moves m are made such that each vertex x of A has n.(x + m) >= a - r, and each of B
// n.(x + m) <= b + s. The set of such m is convex and contains 0, so it also contains t m for every t in [0, 1]: all along the straight way from
// x to x + m the features are apart by g - r - s, at least the smaller of g and the least gap. Pairs that
// were not found stay apart by their least gap (surface_pairs.h). Two surfaces that do not
// cross can begin to do so only where such a pair (a vertex and a triangle, or two edges, without a common vertex) comes to distance 0. Hence no
// crossing comes into being, but for vertices that are told where to go and leave others no room.
//
// Rooms are not negative, so a pair without room would hold its vertices back against all others. Moves are therefore counted from the mean of those that pairs connect, which
// moves both planes of each of these pairs alike.
//
// Moves advance several times, each from where the last one led, with the room that is left there: a layer goes on into the room that the next one has
// left. The planes of a pair then stand elsewhere at the end than at the start; in between they move straight, and so do the vertices, so that what
// holds at both ends holds all along.
//
// Nothing here depends on the closest points being exact: a and b are taken from the vertices, whatever the normal. So the planes of a pair may turn where they would not have
// its moves, to such that would: edges that touch near their ends turn about each other, and planes that stay as they are hold back the far ends. They
// must also stand between the features at the start, since the whole move is straight.
//
// Sources: A. Chen, J. Hsu et al., "Offset Geometric Contact", 2025 (bounds from the nearest feature); D. Baraff, "Fast Contact Force Computation for
// Nonpenetrating Rigid Bodies", 1994 (separating planes from the last step).
#pragma once

#include "base/arena/arena.h"
#include "soft/contact/surface_pairs.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// Of a vertex whose moves are cut for themselves.
constexpr std::uint32_t kNoStiffPiece = 0xffffffffu;

struct BoundSettings {
  double least_gap = 0.2;  // of the thickness of a pair: features come no nearer
  int passes = 2;  // in which moves are turned along the planes; what then is still too far is shortened
};

struct BoundReport {
  long shortened = 0;  // vertices that do not move as they would
  long forced = 0;     // pairs in which vertices that are held take more room than there is
  long crossed = 0;    // pairs that no plane separates: they cross or touch
};

// `stiff`: by vertex, the number of its stiff piece, or kNoStiffPiece; none: there are no such pieces. The moves of a stiff piece are shortened by one share, so that
// bounds do not stretch it.
// `limits`: by vertex, m: how far it may go; none: as far as the pairs allow. `held`: by vertex, 1 if it goes where it is told, whatever the bounds.
BoundReport bound_moves(std::span<const SurfacePair> pairs, std::span<const DVec3> positions,
                        std::span<const float> limits, std::span<const std::uint8_t> held,
                        std::span<const std::uint32_t> stiff, const BoundSettings& settings,
                        std::span<DVec3> moves, Arena& arena, TaskSystem& tasks);

}  // namespace gyre
