// Parts of a solid during the cuts: each is the solid within a convex cell. A part consists of the surface inside the
// cell, clipped exactly, and the corners of the cell inside the solid. The hull of both is the hull of the part, so the
// cut faces need no triangles, and the surface may be open or intersect itself.
//
// In: a Model and its field. Out: parts with their hulls, and how far each is from convex.
#pragma once

#include "geometry/decomposition/convex_body.h"
#include "geometry/decomposition/decomposition_model.h"
#include "geometry/decomposition/surface_field.h"

#include <utility>
#include <vector>

namespace gyre {

// A point of the surface with the solid on one side only. Samples inside the solid (at intersecting surfaces) are
// dropped.
struct SurfaceSample {
  DVec3 point;
  std::uint32_t group = 0;
};

// Data that all work on one mesh shares. Lengths are in the model's coordinates.
struct SampledSolid {
  const Model* model = nullptr;
  const SurfaceField* field = nullptr;
  std::vector<SurfaceSample> samples;
  double openness = 0.0;  // the fraction of the surface near which inside and outside cannot be told apart
  bool covered_once =
      false;               // the surface is closed and borders the solid everywhere: no part overlaps another
  double spacing = 0.0;    // between samples
  double tolerance = 0.0;  // how much a part may lack to count as convex
};

struct CellEdge {
  DVec3 from, to;
};

// Error of points that should lie in one plane: coordinates are about one, and were floats.
constexpr double kFloatNoise = 3.0e-7;
// Corners of a cell may lie on the surface, so the solid is tested slightly inward of them.
constexpr double kInward = 1.0e-5;

struct Part {
  std::vector<HalfSpace> cell;
  std::vector<CellEdge> edges;  // of the cell
  DVec3 center;                 // of its corners
  std::vector<DVec3> vertices;  // of the surface; behind them the corners of the cell inside the solid
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> samples;
  ConvexBody body;
  double overhang = 0.0;  // how far the hull extends beyond the solid, as far as was searched
  double depth = 0.0;     // how deep the surface is below the hull
  bool stuck = false;     // no plane cuts it

  double lack() const { return max(overhang, depth); }
};

// One part for each group, each within the whole box.
std::vector<Part> make_parts(const SampledSolid& solid);
// The parts below and above the plane, without hulls, which finish_part() makes.
std::pair<Part, Part> cut_part(const SampledSolid& solid, const Part& part, const HalfSpace& plane);
// Computes corners, hull, overhang and depth. The hull is empty if the part is flat.
void finish_part(const SampledSolid& solid, Part& part);

// The largest depth of the samples (given, or all) below the hull; at least 0.
double deepest_sample(const SampledSolid& solid, const ConvexBody& body,
                      std::span<const std::uint32_t> samples);
double deepest_sample(const SampledSolid& solid, const ConvexBody& body);

struct OverhangSearch {
  double ignore = 0.0;      // smaller values are not searched
  double enough = 1.0e300;  // the search stops above this value
  double resolution = 0.0;  // triangles smaller than this are not subdivided
  int points = 60000;       // maximum number of tests
};
struct Overhang {
  double value = 0.0;  // the largest value found
  double bound = 0.0;  // upper bound of the true value (unless the search stopped early)
};
// How far the body's surface extends beyond the solid. Subdivides facets whose distances do not decide it.
Overhang find_overhang(const SurfaceField& field, const ConvexBody& body, const OverhangSearch& search);

}  // namespace gyre
