// Cutting parts and measuring them. See decomposition_part.h.
#include "geometry/decomposition/decomposition_part.h"

#include "base/container/flat_map.h"

namespace gyre {
namespace {

// Nearer to a plane than this is on it.
constexpr double kOnPlane = kFloatNoise;
constexpr std::uint32_t kUnset = 0xffffffffu;

// The edges of the polytope that the cell's planes bound.
std::vector<CellEdge> find_cell_edges(std::span<const HalfSpace> cell) {
  std::vector<CellEdge> edges;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    for (std::size_t j = i + 1; j < cell.size(); ++j) {
      const DVec3 way = cross(cell[i].normal, cell[j].normal);
      const double square = length_squared(way);
      if (!(square > 1.0e-12)) continue;
      // The point of both planes nearest to the origin.
      const DVec3 base =
          (cell[i].offset * cross(cell[j].normal, way) + cell[j].offset * cross(way, cell[i].normal)) /
          square;
      double low = -1.0e300, high = 1.0e300;
      for (std::size_t k = 0; k < cell.size() && low < high; ++k) {
        if (k == i || k == j) continue;
        const double slope = dot(cell[k].normal, way), room = cell[k].offset - dot(cell[k].normal, base);
        if (absolute(slope) < 1.0e-12) {
          if (room < -kOnPlane) low = high;
        } else if (slope > 0.0) {
          high = min(high, room / slope);
        } else {
          low = max(low, room / slope);
        }
      }
      if (low < high && high - low < 1.0e6) edges.push_back({base + low * way, base + high * way});
    }
  }
  return edges;
}

// One side of a cut while it is made.
class Side {
 public:
  Side(const Part& from, std::span<const double> heights, double sign)
      : from_(from), heights_(heights), sign_(sign), number_(from.vertices.size(), kUnset) {}

  // The part of the triangle on this side; `i` is where its indices begin.
  void clip(std::size_t i) {
    std::uint32_t polygon[4];
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = from_.indices[i + k], next = from_.indices[i + (k + 1) % 3];
      const double here = sign_ * heights_[v], there = sign_ * heights_[next];
      if (here <= 0.0) polygon[count++] = keep(v);
      if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0)) polygon[count++] = crossing(v, next);
    }
    for (std::size_t k = 2; k < count; ++k) {
      for (const std::uint32_t v : {polygon[0], polygon[k - 1], polygon[k]}) out.indices.push_back(v);
    }
  }

  Part out;

 private:
  std::uint32_t add(DVec3 p) {
    out.vertices.push_back(p);
    return std::uint32_t(out.vertices.size() - 1);
  }
  std::uint32_t keep(std::uint32_t v) {
    if (number_[v] == kUnset) number_[v] = add(from_.vertices[v]);
    return number_[v];
  }
  // Computed from the lower vertex on, so that both sides and both triangles get the same point.
  std::uint32_t crossing(std::uint32_t v, std::uint32_t w) {
    const std::uint32_t a = min(v, w), b = max(v, w);
    std::uint32_t& slot = crossings_.find_or_insert(std::uint64_t(a) << 32 | b, kUnset);
    if (slot == kUnset) {
      const double t = heights_[a] / (heights_[a] - heights_[b]);
      slot = add(from_.vertices[a] + t * (from_.vertices[b] - from_.vertices[a]));
    }
    return slot;
  }

  const Part& from_;
  std::span<const double> heights_;
  double sign_;
  std::vector<std::uint32_t> number_;
  FlatMap<std::uint32_t> crossings_;
};

struct Facet {
  DVec3 a, b, c;
  // A place near it that is known to be `known_depth` deep inside (or that far outside, below 0).
  DVec3 place;
  double known_depth = 0.0;
};

// The depth of `p`, or something below `known` if it is not above that.
double depth_beyond(const ConvexBody& body, DVec3 p, double known) {
  double here = 1.0e300;
  for (std::size_t k = 0; k < body.planes.size() && here > known; ++k)
    here = min(here, body.planes[k].offset - dot(body.planes[k].normal, p));
  return here;
}

// How far from the solid some places within the body are: there may be a hollow that all of its surface is beside.
double emptiest_place(const SurfaceField& field, const ConvexBody& body, double ignore) {
  DVec3 middle;
  for (const DVec3& v : body.vertices) middle += v / double(body.vertices.size());
  double most = 0.0;
  const auto look = [&](DVec3 p) {
    const double away = field.distance(p, 4.0);
    if (away > max(most, ignore) && !field.inside(p)) most = away;
  };
  look(middle);
  const std::size_t stride = body.vertices.size() / 24 + 1;
  for (std::size_t i = 0; i < body.vertices.size(); i += stride) look(0.5 * (middle + body.vertices[i]));
  return most;
}

}  // namespace

std::vector<Part> make_parts(const SampledSolid& solid) {
  const Model& model = *solid.model;
  std::vector<Part> parts(model.group_count);
  // A box well outside of everything: its corners are never inside.
  constexpr double kLow = -0.5, kHigh = 2.0;
  const HalfSpace box[6] = {{{1, 0, 0}, kHigh},  {{-1, 0, 0}, -kLow}, {{0, 1, 0}, kHigh},
                            {{0, -1, 0}, -kLow}, {{0, 0, 1}, kHigh},  {{0, 0, -1}, -kLow}};
  std::vector<std::uint32_t> number(model.vertices.size(), kUnset), owner(model.vertices.size(), kUnset);
  for (std::uint32_t g = 0; g < model.group_count; ++g) parts[g].cell.assign(box, box + 6);
  for (std::size_t i = 0; i < model.indices.size(); ++i) {
    const std::uint32_t v = model.indices[i], g = model.group[i / 3];
    Part& part = parts[g];
    if (owner[v] != g) {
      owner[v] = g;
      number[v] = std::uint32_t(part.vertices.size());
      part.vertices.push_back(model.vertices[v]);
    }
    part.indices.push_back(number[v]);
  }
  for (std::uint32_t i = 0; i < solid.samples.size(); ++i) parts[solid.samples[i].group].samples.push_back(i);
  return parts;
}

std::pair<Part, Part> cut_part(const SampledSolid& solid, const Part& part, const HalfSpace& plane) {
  std::vector<double> heights(part.vertices.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double height = dot(plane.normal, part.vertices[i]) - plane.offset;
    heights[i] = absolute(height) < kOnPlane ? 0.0 : height;
  }
  Side low(part, heights, 1.0), high(part, heights, -1.0);
  for (std::size_t i = 0; i < part.indices.size(); i += 3) {
    const std::uint32_t* const v = part.indices.data() + i;
    const double least = min(heights[v[0]], min(heights[v[1]], heights[v[2]]));
    const double most = max(heights[v[0]], max(heights[v[1]], heights[v[2]]));
    if (least == 0.0 && most == 0.0) {
      // In the plane: a border of what lies behind it.
      const DVec3 a = part.vertices[v[0]];
      const DVec3 normal = cross(part.vertices[v[1]] - a, part.vertices[v[2]] - a);
      (dot(normal, plane.normal) > 0.0 ? low : high).clip(i);
      continue;
    }
    if (least < 0.0) low.clip(i);
    if (most > 0.0) high.clip(i);
  }
  low.out.cell = high.out.cell = part.cell;
  low.out.cell.push_back(plane);
  high.out.cell.push_back({-plane.normal, -plane.offset});
  for (const std::uint32_t i : part.samples) {
    const double height = dot(plane.normal, solid.samples[i].point) - plane.offset;
    if (height < kOnPlane) low.out.samples.push_back(i);
    if (height > -kOnPlane) high.out.samples.push_back(i);
  }
  return {std::move(low.out), std::move(high.out)};
}

void finish_part(const SampledSolid& solid, Part& part) {
  part.edges = find_cell_edges(part.cell);
  std::vector<DVec3> corners;
  for (const CellEdge& edge : part.edges) {
    for (const DVec3 corner : {edge.from, edge.to}) {
      bool known = false;
      for (const DVec3& other : corners) known = known || length_squared(other - corner) < 1.0e-16;
      if (!known) corners.push_back(corner);
    }
  }
  for (const DVec3& corner : corners) part.center += corner / double(corners.size());
  for (const DVec3& corner : corners) {
    const double outside = max(max(-corner.x, corner.x - 1.0),
                               max(max(-corner.y, corner.y - 1.0), max(-corner.z, corner.z - 1.0)));
    if (outside < 0.25 && solid.field->inside(corner + kInward * (part.center - corner)))
      part.vertices.push_back(corner);
  }
  part.body = make_body(part.vertices, {255, 0.01 * solid.tolerance, 1.0e-6 * solid.model->size});
  if (part.body.empty()) return;
  part.depth = deepest_sample(solid, part.body, part.samples);
  const double limit = solid.tolerance;
  if (part.depth > limit) return;  // it will be cut anyway
  part.overhang = find_overhang(*solid.field, part.body,
                                {.ignore = 0.8 * limit, .stop = limit, .resolution = 0.25 * limit})
                      .value;
}

double deepest_sample(const SampledSolid& solid, const ConvexBody& body, std::span<const std::uint32_t> samples) {
  double depth = 0.0;
  for (const std::uint32_t i : samples) depth = max(depth, depth_beyond(body, solid.samples[i].point, depth));
  return depth;
}

double deepest_sample(const SampledSolid& solid, const ConvexBody& body) {
  double depth = 0.0;
  for (const SurfaceSample& sample : solid.samples) {
    const DVec3 p = sample.point;
    if (p.x < body.low.x || p.y < body.low.y || p.z < body.low.z || p.x > body.high.x || p.y > body.high.y ||
        p.z > body.high.z)
      continue;
    depth = max(depth, depth_beyond(body, p, depth));
  }
  return depth;
}

Overhang find_overhang(const SurfaceField& field, const ConvexBody& body, const OverhangSearch& search) {
  Overhang out{0.0, 0.0};
  std::vector<Facet> facets;
  for (const GridTriangle& t : body.triangles) {
    facets.push_back({body.vertices[std::size_t(t.vertices[0])],
                      body.vertices[std::size_t(t.vertices[1])],
                      body.vertices[std::size_t(t.vertices[2])],
                      {},
                      0.0});
  }
  out.value = emptiest_place(field, body, search.ignore);
  if (out.value > search.stop) return {out.value, 1.0e300};
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const auto [a, b, c, place, known_depth] = facets[i];
    const DVec3 middle = (a + b + c) / 3.0;
    const double reach = std::sqrt(
        max(length_squared(a - middle), max(length_squared(b - middle), length_squared(c - middle))));
    const double away = field.distance(middle, 4.0);
    // The distance changes by no more than one goes.
    const double known = max(out.value, search.ignore);
    if (away + reach <= known) {
      out.bound = max(out.bound, away + reach);
      continue;
    }
    // No surface lies between two places that are nearer to each other than to the surface.
    const bool same_side = length(middle - place) < absolute(known_depth);
    const bool inside = same_side ? known_depth > 0.0 : field.inside(middle);
    const double height = inside ? -away : away;
    out.value = max(out.value, height);
    if (out.value > search.stop) return {out.value, 1.0e300};
    if (height + reach <= known || reach <= search.resolution || i >= std::size_t(search.points)) {
      out.bound = max(out.bound, height + reach);
      continue;
    }
    // In two at the middle of the longest side, so that slivers get shorter and not thinner.
    const double sides[3] = {length_squared(b - a), length_squared(c - b), length_squared(a - c)};
    const DVec3 corners[3] = {a, b, c};
    const int longest =
        sides[0] >= sides[1] ? (sides[0] >= sides[2] ? 0 : 2) : (sides[1] >= sides[2] ? 1 : 2);
    const DVec3 from = corners[longest], to = corners[(longest + 1) % 3], tip = corners[(longest + 2) % 3];
    facets.push_back({from, 0.5 * (from + to), tip, middle, -height});
    facets.push_back({0.5 * (from + to), to, tip, middle, -height});
  }
  out.bound = max(out.bound, out.value);
  return out;
}

}  // namespace gyre
