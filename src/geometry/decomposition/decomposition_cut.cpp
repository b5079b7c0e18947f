// Families of planes, and their cost by slabs. See decomposition_cut.h.
#include "geometry/decomposition/decomposition_cut.h"

#include "base/container/sort.h"
#include "math/dense.h"

namespace gyre {
namespace {

constexpr int kPlanesAcross = 9;      // evenly between the ends of a part, in each direction
constexpr double kBalance = 0.03;     // cost of one hull that is all of the part's
constexpr double kCutLength = 0.02;   // cost of a cut as long as the part's girth
constexpr double kAlongSides = 0.15;  // gain of a cut along all that is concave
constexpr std::size_t kSides = 8;     // flat concave sides that give planes
constexpr double kSameWay = 0.996;    // directions within 5 degrees are one
constexpr int kRoughVertices = 255;   // of the hulls by which cuts are judged

// ------------------------------------------------------------------------------------------------------- directions

struct FlatSide {
  HalfSpace plane;
  double weight = 0.0;
  double share = 0.0;  // of the weight of all that is concave
};

struct Deep {
  HalfSpace plane;
  double weight = 0.0;
};

// To ten bits: what is the same but for rounding keeps its order when it is sorted.
double roughly(double value) {
  constexpr std::uint64_t kHalf = std::uint64_t(1) << 41;
  return __builtin_bit_cast(double, (__builtin_bit_cast(std::uint64_t, value) + kHalf) & ~(2 * kHalf - 1));
}

// The largest flat sides that lie below the hull, the heaviest (area times depth) first.
std::vector<FlatSide> find_sides(const SampledSolid& solid, const Part& part) {
  std::vector<Deep> deep;
  for (std::size_t i = 0; i < part.indices.size(); i += 3) {
    const DVec3 a = part.vertices[part.indices[i]], b = part.vertices[part.indices[i + 1]],
                c = part.vertices[part.indices[i + 2]];
    const DVec3 normal = cross(b - a, c - a);
    const double area = length(normal);
    if (!(area > 1.0e-12)) continue;
    const DVec3 middle = (a + b + c) / 3.0;
    const double depth = depth_below(part.body, middle);
    if (depth < 0.25 * solid.tolerance) continue;
    const DVec3 n = normal / area;
    deep.push_back({{n, dot(n, middle)}, roughly(area * depth)});
  }
  std::vector<Deep> scratch(deep.size());
  merge_sort(std::span<Deep>(deep), std::span<Deep>(scratch),
             [](const Deep& a, const Deep& b) { return a.weight > b.weight; });
  constexpr std::size_t kLooked = 1024, kKept = 64;
  std::vector<FlatSide> sides;
  for (std::size_t i = 0; i < deep.size() && i < kLooked; ++i) {
    FlatSide* found = nullptr;
    for (FlatSide& side : sides) {
      const double same = dot(side.plane.normal, deep[i].plane.normal);
      const double offset = same > 0.0 ? deep[i].plane.offset : -deep[i].plane.offset;
      if (absolute(same) > 0.9999 && absolute(side.plane.offset - offset) < 0.1 * solid.tolerance)
        found = &side;
    }
    if (found != nullptr) {
      found->weight += deep[i].weight;
    } else if (sides.size() < kKept) {
      sides.push_back({deep[i].plane, deep[i].weight, 0.0});
    }
  }
  double all = 1.0e-300;
  for (const Deep& one : deep) all += one.weight;
  for (FlatSide& side : sides) {
    side.weight = roughly(side.weight);
    side.share = side.weight / all;
  }
  std::vector<FlatSide> spare(sides.size());
  merge_sort(std::span<FlatSide>(sides), std::span<FlatSide>(spare),
             [](const FlatSide& a, const FlatSide& b) { return a.weight > b.weight; });
  if (sides.size() > kSides) sides.resize(kSides);
  return sides;
}

// The axes along which the part's surface spreads least and most.
void principal_directions(const Part& part, DVec3 (&axes)[3]) {
  double area = 0.0;
  DVec3 first;
  double m[6] = {};
  const auto each = [&](auto&& fn) {
    for (std::size_t i = 0; i < part.indices.size(); i += 3) {
      const DVec3 a = part.vertices[part.indices[i]], b = part.vertices[part.indices[i + 1]],
                  c = part.vertices[part.indices[i + 2]];
      fn(length(cross(b - a, c - a)), (a + b + c) / 3.0);
    }
  };
  each([&](double weight, DVec3 p) {
    area += weight;
    first += weight * p;
  });
  const DVec3 middle = area > 0.0 ? first / area : first;
  each([&](double weight, DVec3 at) {
    const DVec3 p = at - middle;
    const double products[6] = {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.x * p.z, p.y * p.z};
    for (int i = 0; i < 6; ++i) m[i] += weight * products[i];
  });
  double moments[3], columns[9];
  symmetric_eigen(m, moments, columns);
  for (int i = 0; i < 3; ++i) axes[i] = {columns[3 * i], columns[3 * i + 1], columns[3 * i + 2]};
}

CutFamily spread(const Part& part, DVec3 direction) {
  CutFamily family{direction, {}, 0.0};
  double low = 1.0e300, high = -1.0e300;
  for (const DVec3& p : part.body.vertices) {
    low = min(low, dot(direction, p));
    high = max(high, dot(direction, p));
  }
  for (int i = 1; i <= kPlanesAcross; ++i)
    family.offsets.push_back(low + (high - low) * double(i) / double(kPlanesAcross + 1));
  return family;
}

// ------------------------------------------------------------------------------------------------------------ costs

class FamilyCosts {
 public:
  FamilyCosts(const SampledSolid& solid, const Part& part, const CutFamily& family)
      : solid_(solid), part_(part), family_(family), count_(family.offsets.size()) {}
  Cut best();

 private:
  std::size_t slab_of(double height) const {
    std::size_t slab = 0;
    while (slab < count_ && height > family_.offsets[slab]) ++slab;
    return slab;
  }
  void sort_points();
  void cross_surface();
  void cross_cell();
  // The volumes below (or above) each plane.
  std::vector<double> sweep(bool from_low) const;
  ConvexBody rough(std::span<const DVec3> points) const {
    return make_body(points, {kRoughVertices, 1.0e-3 * solid_.tolerance, 1.0e-6});
  }

  const SampledSolid& solid_;
  const Part& part_;
  const CutFamily& family_;
  std::size_t count_;
  std::vector<double> heights_;
  std::vector<std::vector<DVec3>> slabs_;   // points between planes
  std::vector<std::vector<DVec3>> planes_;  // where the surface and the cell's edges cross each plane
  // Vertices that lie in a plane: all, and those from which a triangle goes down or up.
  std::vector<std::vector<DVec3>> in_plane_, going_down_, going_up_;
  std::vector<double> lengths_;  // of the surface's cut by each plane
};

void FamilyCosts::sort_points() {
  heights_.resize(part_.vertices.size());
  slabs_.assign(count_ + 1, {});
  in_plane_.assign(count_, {});
  for (std::size_t i = 0; i < heights_.size(); ++i) {
    heights_[i] = dot(family_.direction, part_.vertices[i]);
    const std::size_t slab = slab_of(heights_[i] - kFloatNoise);
    if (slab < count_ && heights_[i] >= family_.offsets[slab] - kFloatNoise) {
      heights_[i] = family_.offsets[slab];
      in_plane_[slab].push_back(part_.vertices[i]);
    } else {
      slabs_[slab].push_back(part_.vertices[i]);
    }
  }
}

void FamilyCosts::cross_surface() {
  planes_.assign(count_, {});
  going_down_.assign(count_, {});
  going_up_.assign(count_, {});
  lengths_.assign(count_, 0.0);
  for (std::size_t i = 0; i < part_.indices.size(); i += 3) {
    const std::uint32_t* const v = part_.indices.data() + i;
    const double h[3] = {heights_[v[0]], heights_[v[1]], heights_[v[2]]};
    const double low = min(h[0], min(h[1], h[2])), high = max(h[0], max(h[1], h[2]));
    for (std::size_t k = slab_of(low); k < count_ && family_.offsets[k] <= high; ++k) {
      const double offset = family_.offsets[k];
      for (int e = 0; e < 3; ++e) {
        if (h[e] != offset) continue;
        if (low < offset) going_down_[k].push_back(part_.vertices[v[e]]);
        if (high > offset) going_up_[k].push_back(part_.vertices[v[e]]);
      }
      if (!(low < offset && offset < high)) continue;
      DVec3 ends[3];
      int found = 0;
      for (int e = 0; e < 3; ++e) {
        const int f = (e + 1) % 3;
        if ((h[e] <= offset) == (h[f] <= offset)) continue;
        const DVec3 from = part_.vertices[v[e]], to = part_.vertices[v[f]];
        ends[found++] = from + (offset - h[e]) / (h[f] - h[e]) * (to - from);
      }
      if (found != 2) continue;
      planes_[k].push_back(ends[0]);
      planes_[k].push_back(ends[1]);
      lengths_[k] += length(ends[1] - ends[0]);
    }
  }
}

void FamilyCosts::cross_cell() {
  for (const CellEdge& edge : part_.edges) {
    const double from = dot(family_.direction, edge.from), to = dot(family_.direction, edge.to);
    for (std::size_t k = 0; k < count_; ++k) {
      const double offset = family_.offsets[k];
      if ((from <= offset) == (to <= offset)) continue;
      const DVec3 p = edge.from + (offset - from) / (to - from) * (edge.to - edge.from);
      // Only within the part's own box; beyond it nothing of the part is.
      const DVec3 low = p - part_.body.low, high = part_.body.high - p;
      if (min(min(low.x, low.y), min(low.z, min(high.x, min(high.y, high.z)))) < -1.0e-9) continue;
      if (solid_.field->inside(p + kInward * (part_.center - p))) planes_[k].push_back(p);
    }
  }
}

std::vector<double> FamilyCosts::sweep(bool from_low) const {
  std::vector<double> volumes(count_, 0.0);
  std::vector<DVec3> points;
  for (std::size_t step = 0; step < count_; ++step) {
    const std::size_t k = from_low ? step : count_ - 1 - step;
    const std::vector<DVec3>& slab = slabs_[from_low ? k : k + 1];
    points.insert(points.end(), slab.begin(), slab.end());
    const std::size_t so_far = points.size();
    const std::vector<DVec3>& touching = from_low ? going_down_[k] : going_up_[k];
    points.insert(points.end(), planes_[k].begin(), planes_[k].end());
    points.insert(points.end(), touching.begin(), touching.end());
    ConvexBody body = rough(points);
    volumes[k] = body.volume;
    if (body.empty()) {
      points.resize(so_far);
    } else {
      // What the hull has is enough for all that follow; points of this plane among it do no harm, they are inside of those.
      points = std::move(body.vertices);
    }
    points.insert(points.end(), in_plane_[k].begin(), in_plane_[k].end());
  }
  return volumes;
}

Cut FamilyCosts::best() {
  sort_points();
  cross_surface();
  cross_cell();
  const std::vector<double> below = sweep(true), above = sweep(false);
  const double whole = max(part_.body.volume, 1.0e-300);
  const DVec3 size = part_.body.high - part_.body.low;
  const double girth = 2.0 * (size.x + size.y + size.z);
  double low = 1.0e300, high = -1.0e300;
  for (const DVec3& p : part_.body.vertices) {
    low = min(low, dot(family_.direction, p));
    high = max(high, dot(family_.direction, p));
  }
  const double thin = 0.05 * solid_.tolerance;
  Cut best;
  for (std::size_t k = 0; k < count_; ++k) {
    const double offset = family_.offsets[k];
    Cut cut;
    cut.plane = {family_.direction, offset};
    // A plane that leaves next to nothing on one side is no cut.
    if (!(below[k] > 0.0) || !(above[k] > 0.0) || offset - low < thin || high - offset < thin) continue;
    cut.cost = (below[k] + above[k]) / whole + kBalance * absolute(below[k] - above[k]) / whole +
               kCutLength * lengths_[k] / girth - family_.gain;
    if (clearly_better(cut, best)) best = cut;
  }
  return best;
}

}  // namespace

std::vector<CutFamily> find_families(const SampledSolid& solid, const Part& part) {
  std::vector<CutFamily> families;
  const auto known = [&](DVec3 direction) {
    for (const CutFamily& family : families) {
      if (absolute(dot(family.direction, direction)) > kSameWay) return true;
    }
    return false;
  };
  const std::vector<FlatSide> sides = find_sides(solid, part);
  std::vector<CutFamily> single;
  // First, so that they win where others are as good.
  for (const FlatSide& side : sides)
    single.push_back({side.plane.normal, {side.plane.offset}, kAlongSides * side.share});
  DVec3 principal[3];
  principal_directions(part, principal);
  const DVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr std::size_t kTurned = 3;
  for (std::size_t i = 0; i < sides.size() && i < kTurned; ++i) {
    if (!known(sides[i].plane.normal)) families.push_back(spread(part, sides[i].plane.normal));
  }
  for (const DVec3& axis : axes) {
    if (!known(axis)) families.push_back(spread(part, axis));
  }
  for (const DVec3& axis : principal) {
    if (!known(axis)) families.push_back(spread(part, axis));
  }
  single.insert(single.end(), families.begin(), families.end());
  return single;
}

Cut best_of_family(const SampledSolid& solid, const Part& part, const CutFamily& family) {
  return FamilyCosts(solid, part, family).best();
}

bool clearly_better(const Cut& a, const Cut& b) {
  // Far above rounding: scaled and mirrored meshes are cut alike.
  constexpr double kRounding = 2.0e-3;
  return a.cost < b.cost - kRounding;
}

}  // namespace gyre
