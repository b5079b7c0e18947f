// Parts of a solid while it is cut up: what lies within a convex cell. A part is held by the surface that lies in the cell,
// clipped exactly, and by the cell's own corners that lie inside the solid. The hull of both is the hull of the part, so the
// sides that cuts leave need no triangles, and the surface may be open or cross itself.
//
// In: a Model and its field. Out: parts with their hulls, and how far each is from convex.
#pragma once

#include "geometry/decomposition/convex_body.h"
#include "geometry/decomposition/decomposition_model.h"
#include "geometry/decomposition/surface_field.h"

#include <utility>
#include <vector>

namespace gyre {

// A place on the surface with the solid on one side only: samples within the solid (where surfaces cross) are left out.
struct SurfaceSample {
  DVec3 point;
  std::uint32_t group = 0;
};

// What all work on one mesh shares. Lengths in the model's coordinates.
struct SampledSolid {
  const Model* model = nullptr;
  const SurfaceField* field = nullptr;
  std::vector<SurfaceSample> samples;
  double spacing = 0.0;    // between samples
  double tolerance = 0.0;  // what a part may lack to be convex
};

struct CellEdge {
  DVec3 from, to;
};

// By how much places that should be in one plane miss it: coordinates are about one, and were floats.
constexpr double kFloatNoise = 3.0e-7;
// Corners of a cell may lie on the surface: whether the solid is there is asked a little inward of them.
constexpr double kInward = 1.0e-5;

struct Part {
  std::vector<HalfSpace> cell;
  std::vector<CellEdge> edges;  // of the cell
  DVec3 center;                 // of its corners
  std::vector<DVec3> vertices;  // of the surface; behind them the cell's corners inside the solid
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> samples;
  ConvexBody body;
  double overhang = 0.0;  // how far the hull reaches from the solid, as far as was searched
  double depth = 0.0;     // how deep the surface lies below the hull
  bool stuck = false;     // no plane cuts it

  double lack() const { return max(overhang, depth); }
};

// One part for each group, each within the whole box.
std::vector<Part> make_parts(const SampledSolid& solid);
// What lies below the plane, and what lies above. Only cut: without hulls, which finish_part() makes.
std::pair<Part, Part> cut_part(const SampledSolid& solid, const Part& part, const HalfSpace& plane);
// Corners, hull, overhang and depth. The hull is empty if the part is flat.
void finish_part(const SampledSolid& solid, Part& part);

// How deep any of the samples (or any at all) lies below the hull; at least 0.
double deepest_sample(const SampledSolid& solid, const ConvexBody& body, std::span<const std::uint32_t> samples);
double deepest_sample(const SampledSolid& solid, const ConvexBody& body);

struct OverhangSearch {
  double ignore = 0.0;      // nothing below this is looked for
  double stop = 1.0e300;    // as soon as something is above this, it is enough
  double resolution = 0.0;  // triangles smaller than this are not subdivided
  int points = 60000;       // to look at, at most
};
struct Overhang {
  double value = 0.0;  // found
  double bound = 0.0;  // the true value is not above this (unless the search stopped early)
};
// How far the body's surface reaches from the solid: subdivides where distances leave it open.
Overhang find_overhang(const SurfaceField& field, const ConvexBody& body, const OverhangSearch& search);

}  // namespace gyre
