#include "soft/store/soft_damage.h"

#include "base/container/sort.h"
#include "math/dense.h"
#include "soft/elements/solid.h"
#include "soft/elements/vertex_split.h"
#include "soft/store/soft_builder.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kMaxSplits = 64;  // of vertices in one step, those of their neighbours apart
constexpr float kSolidGap =
    0.04f;  // of the mean edge: what new faces of a solid are apart, twice what surfaces keep
constexpr float kMaxGap = 0.2f;  // of the mean edge: more is not made by moving vertices
constexpr int kTetsAtOnce = 256;

struct Excess {
  double amount = 0.0;
  std::uint32_t vertex[2] = {};  // ends of an edge; of a solid one vertex twice
  DVec3 normal{};                // unit, along the tension
};

int arity_of(const SoftEntry& entry) { return entry.kind == SoftKind::cloth ? 3 : 4; }
bool breaks(const SoftEntry& entry) {
  if (const ClothDef* const cloth = std::get_if<ClothDef>(entry.def.get())) return cloth->tear_strain > 0.0f;
  const SolidDef* const solid = std::get_if<SolidDef>(entry.def.get());
  return solid != nullptr && solid->fracture_stress > 0.0f;
}

DVec3 middle_of(const Particles& p, const std::uint32_t* corner, int arity) {
  DVec3 sum{};
  for (int k = 0; k < arity; ++k) sum += p.place(int(corner[k])) - p.place(int(corner[0]));
  return p.place(int(corner[0])) + (1.0 / arity) * sum;
}

// Twice the area, or six times the volume, at `places`.
double measure_of(std::span<const DVec3> places, const std::uint32_t* corner, int arity) {
  const DVec3 a = places[corner[0]], b = places[corner[1]] - a, c = places[corner[2]] - a;
  return arity == 3 ? length(cross(b, c)) : absolute(dot(cross(b, c), places[corner[3]] - a));
}

// -------------------------------------------------------------------------------------------------------------- excess

void find_strained_edges(const SoftEntry& entry, std::span<const DVec3> rest, Array<Excess>& out) {
  const double limit = double(std::get<ClothDef>(*entry.def).tear_strain);
  const Array<std::uint32_t>& corners = entry.damage.corners;
  const Particles& p = entry.body.particles;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::uint32_t a = corners[k], b = corners[k % 3 == 2 ? k - 2 : k + 1];
    const double before = length(rest[b] - rest[a]);
    const DVec3 way = p.place(int(b)) - p.place(int(a));
    const double now = length(way), strain = now / before - 1.0;
    if (!(strain > limit)) continue;
    const bool ordered = a < b;
    out.push_back({strain, {ordered ? a : b, ordered ? b : a}, (ordered ? 1.0 : -1.0) / now * way});
  }
}

// Adds the volume and the stress times volume of a tetrahedron (xx, yy, zz, xy, xz, yz), by the corotated law.
struct ElementStress {
  double volume = 0.0;
  double stress[6] = {};
};

void deformation_of(const Particles& p, const TetBlock& block, int lane, DVec3 (&f)[3]) {
  const DVec3 origin = p.place(block.corner[0][lane]);
  DVec3 edge[3];
  for (int c = 0; c < 3; ++c) edge[c] = p.place(block.corner[c + 1][lane]) - origin;
  for (int c = 0; c < 3; ++c) {
    f[c] = {};
    for (int k = 0; k < 3; ++k) f[c] += double(block.inverse[3 * c + k][lane]) * edge[k];
  }
}

ElementStress stress_of(const SoftBody& body, const TetBlock& block, int lane) {
  DVec3 f[3];
  deformation_of(body.particles, block, lane, f);
  double left[6] = {}, moments[3], axes[9];
  for (const DVec3& c : f) {
    left[0] += c.x * c.x, left[1] += c.y * c.y, left[2] += c.z * c.z;
    left[3] += c.x * c.y, left[4] += c.x * c.z, left[5] += c.y * c.z;
  }
  symmetric_eigen(left, moments, axes);
  const double mu = double(body.continuum.material.mu), lambda = double(body.continuum.material.lambda);
  double strain[3], trace = 0.0;
  for (int k = 0; k < 3; ++k) trace += strain[k] = std::sqrt(max(moments[k], 0.0)) - 1.0;
  ElementStress out;
  out.volume = double(block.volume[lane]);
  for (int k = 0; k < 3; ++k) {
    const double pull = out.volume * (2.0 * mu * strain[k] + lambda * trace);
    const double x = axes[3 * k], y = axes[3 * k + 1], z = axes[3 * k + 2];
    const double parts[6] = {x * x, y * y, z * z, x * y, x * z, y * z};
    for (int i = 0; i < 6; ++i) out.stress[i] += pull * parts[i];
  }
  return out;
}

void find_stressed_vertices(const SoftEntry& entry, TaskSystem& tasks, Array<Excess>& out) {
  const double limit = double(std::get<SolidDef>(*entry.def).fracture_stress);
  const Array<std::uint32_t>& corners = entry.damage.corners;
  const int count = int(corners.size() / 4);
  Array<ElementStress> elements, vertices;
  elements.resize(std::size_t(count));
  for_blocks(tasks, count, kTetsAtOnce, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t)
      elements[t] = stress_of(entry.body, entry.body.continuum.tetrahedra[t / kTetLanes], t % kTetLanes);
  });
  vertices.resize(std::size_t(entry.body.particles.count));
  for (std::size_t k = 0; k < corners.size(); ++k) {
    ElementStress& sum = vertices[corners[k]];
    sum.volume += elements[k / 4].volume;
    for (int i = 0; i < 6; ++i) sum.stress[i] += elements[k / 4].stress[i];
  }
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    double moments[3], axes[9];
    const ElementStress& one = vertices[v];
    const double most = limit * one.volume;
    // No eigenvalue exceeds the norm.
    double square = 0.0;
    for (int i = 0; i < 6; ++i) square += (i < 3 ? 1.0 : 2.0) * one.stress[i] * one.stress[i];
    if (!(square > most * most)) continue;
    symmetric_eigen(one.stress, moments, axes);
    if (moments[2] > most) out.push_back({moments[2] / one.volume, {v, v}, {axes[6], axes[7], axes[8]}});
  }
}

// ---------------------------------------------------------------------------------------------------------------- tears

class Tear {
 public:
  Tear(SoftEntry& entry, std::span<const DVec3> rest)
      : entry_(entry),
        rest_(rest),
        arity_(arity_of(entry)),
        count_(std::uint32_t(entry.body.particles.count)),
        corners_(entry.damage.corners),
        splitter_(corners_.view(), arity_, count_) {
    busy_.resize(count_);
  }

  void run(std::span<const Excess> excesses) {
    int splits = 0;
    for (const Excess& one : excesses) {
      if (splits == kMaxSplits || splitter_.vertices() >= std::uint32_t(kMaxSoftVertices)) break;
      const int ends = one.vertex[0] == one.vertex[1] ? 1 : 2;
      for (int k = 0; k < ends; ++k) {
        if (!split(one.vertex[k], one.normal)) continue;
        ++splits;
        break;
      }
    }
  }

  bool any() const { return !made_.empty(); }

  void finish(Array<SoftSplit>& out) {
    SoftDamage& damage = entry_.damage;
    const Array<double> weight = find_weights();
    Particles before = entry_.body.particles;
    for (const std::uint32_t one : made_) {
      const std::uint32_t source = splitter_.source(one);
      out.push_back({source, one});
      damage.roots.push_back(damage.roots[source]);
      damage.mass.push_back(0.0f);
    }
    share_masses(weight);
    damage.corners = corners_;
    rebuild(before);
    move_apart();
  }

 private:
  bool split(std::uint32_t vertex, DVec3 normal) {
    if (busy_[vertex] != 0) return false;
    Array<std::uint32_t> around;
    around.assign(splitter_.around(vertex));
    const Particles& p = entry_.body.particles;
    Array<std::uint8_t> beyond;
    std::size_t far_side = 0;
    for (const std::uint32_t element : around) {
      const DVec3 middle =
          middle_of(p, entry_.damage.corners.data() + element * std::uint32_t(arity_), arity_);
      beyond.push_back(dot(middle - p.place(int(vertex)), normal) > 0.0 ? 1 : 0);
      far_side += beyond.back();
    }
    if (far_side == 0 || far_side == around.size()) return false;
    const std::size_t first = made_.size();
    splitter_.split(vertex, beyond.view(), made_);
    if (made_.size() == first) return false;
    // A neighbour by which alone parts still hang together lets them go.
    for (const std::uint32_t element : around) {
      for (int k = 0; k < arity_; ++k) {
        const std::uint32_t neighbour = corners_[element * std::uint32_t(arity_) + std::uint32_t(k)];
        const std::uint32_t source = splitter_.source(neighbour);
        busy_[source] = 1;
        if (source == vertex) continue;
        Array<std::uint8_t> same;
        same.resize(splitter_.around(neighbour).size());
        splitter_.split(neighbour, same.view(), made_);
      }
    }
    return true;
  }

  // Of each vertex, by the elements that it has now; only of those that were split.
  Array<double> find_weights() const {
    Array<double> weight;
    weight.resize(splitter_.vertices());
    for (std::size_t first = 0; first < corners_.size(); first += std::size_t(arity_)) {
      const double share = measure_of(rest_, entry_.damage.corners.data() + first, arity_);
      for (int k = 0; k < arity_; ++k) weight[corners_[first + std::size_t(k)]] += share;
    }
    return weight;
  }

  // A sum of floats that have the last digit of the whole, or a higher one, is exact.
  void share_masses(const Array<double>& weight) {
    Array<float>& mass = entry_.damage.mass;
    Array<double> whole_weight;
    whole_weight.resize(count_);
    Array<float> whole;
    whole.assign(mass.view().first(count_));
    for (std::uint32_t v = 0; v < splitter_.vertices(); ++v) whole_weight[splitter_.source(v)] += weight[v];
    for (const std::uint32_t one : made_) {
      const std::uint32_t source = splitter_.source(one);
      const float wanted = float(double(whole[source]) * weight[one] / whole_weight[source]);
      const float raised = whole[source] + wanted;
      mass[one] = raised - whole[source];
      mass[source] -= mass[one];
    }
  }

  // The surface is that of the places at rest, as after a snapshot is loaded.
  void rebuild(const Particles& before) {
    SoftBody next = build_elements(*entry_.def, entry_.damage.corners, entry_.damage.roots);
    next.held = entry_.body.held;
    entry_.body = std::move(next);
    build_surface(entry_, entry_.damage.corners);
    Particles& p = entry_.body.particles;
    for (int i = 0; i < p.count; ++i) {
      const int from = int(splitter_.source(std::uint32_t(i)));
      p.set_place(i, before.place(from));
      p.set_velocity(i, before.velocity(from));
      p.mass[i] = entry_.damage.mass[i];
      p.loose[i] = std::uint32_t(i) < count_ ? before.loose[i] : 1.0f;
    }
  }

  // Parts of a vertex move towards the elements around them, about the centre of mass of all; one that is held stays.
  void move_apart() {
    Particles& p = entry_.body.particles;
    Array<DVec3> way;
    way.resize(std::size_t(p.count));
    for (std::size_t first = 0; first < corners_.size(); first += std::size_t(arity_)) {
      const std::uint32_t* const corner = corners_.data() + first;
      const DVec3 middle = middle_of(p, corner, arity_);
      for (int k = 0; k < arity_; ++k) way[corner[k]] += middle - p.place(int(corner[k]));
    }
    const float size = entry_.size;
    const float gap =
        min(entry_.kind == SoftKind::solid ? kSolidGap * size : 2.0f * entry_.radius, kMaxGap * size);
    Array<DVec3> moment;
    Array<double> mass;
    moment.resize(count_), mass.resize(count_);
    const auto move_of = [&](std::uint32_t v) {
      const double size_of_way = length(way[v]);
      return size_of_way > 0.0 ? (0.5 * double(gap) / size_of_way) * way[v] : DVec3{};
    };
    Array<std::uint8_t> parted;
    parted.resize(count_);
    for (const std::uint32_t one : made_) parted[splitter_.source(one)] = 1;
    for (std::uint32_t v = 0; v < std::uint32_t(p.count); ++v) {
      const std::uint32_t source = splitter_.source(v);
      if (parted[source] == 0 || p.loose[source] == 0.0f) continue;
      moment[source] += double(p.mass[v]) * move_of(v), mass[source] += double(p.mass[v]);
    }
    for (std::uint32_t v = 0; v < std::uint32_t(p.count); ++v) {
      const std::uint32_t source = splitter_.source(v);
      if (parted[source] == 0 || p.loose[v] == 0.0f) continue;
      const DVec3 mean = mass[source] > 0.0 ? (1.0 / mass[source]) * moment[source] : DVec3{};
      p.set_place(int(v), p.place(int(v)) + move_of(v) - mean);
    }
  }

  SoftEntry& entry_;
  std::span<const DVec3> rest_;  // by particle
  int arity_;
  std::uint32_t count_;
  Array<std::uint32_t> corners_;
  VertexSplitter splitter_;
  Array<std::uint8_t> busy_;
  Array<std::uint32_t> made_;
};

}  // namespace

void begin_damage(SoftEntry& entry) {
  SoftDamage& damage = entry.damage;
  const SolidDef* const solid = std::get_if<SolidDef>(entry.def.get());
  const bool flows = solid != nullptr && solid->yield_stress > 0.0f;
  if (!breaks(entry) && !flows) return;
  const Particles& p = entry.body.particles;
  for (int i = 0; i < p.count; ++i)
    damage.roots.push_back(std::uint32_t(i)), damage.mass.push_back(p.mass[i]);
  if (entry.kind == SoftKind::cloth) {
    damage.corners = entry.triangles;
  } else if (solid->box) {
    const int cells[3] = {solid->box->cells[0], solid->box->cells[1], solid->box->cells[2]};
    damage.corners = box_tetrahedra(cells);
  } else {
    damage.corners.assign(solid->tetrahedra);
  }
  if (flows) begin_flow(entry);
}

bool rebuild_damaged(SoftEntry& entry) {
  SoftDamage& damage = entry.damage;
  if (damage.empty()) return true;
  SoftEntry whole;
  whole.def = entry.def, whole.kind = entry.kind, whole.triangles = entry.triangles;
  const std::size_t before = std::size_t(entry.body.particles.count), count = damage.roots.size();
  if (count < before || count > std::size_t(kMaxSoftVertices) || damage.mass.size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (damage.roots[i] >= before || (i < before && damage.roots[i] != i) || !(damage.mass[i] > 0.0f) ||
        !is_finite(damage.mass[i]))
      return false;
  }
  whole.body.particles.count = entry.body.particles.count,
  whole.body.particles.mass = entry.body.particles.mass;
  whole.body.continuum.tetrahedra = entry.body.continuum.tetrahedra;
  begin_damage(whole);
  if (damage.corners.size() != whole.damage.corners.size() || damage.flow.size() != whole.damage.flow.size())
    return false;
  Array<std::uint8_t> used;
  used.resize(count);
  for (std::size_t k = 0; k < damage.corners.size(); ++k) {
    if (damage.corners[k] >= count || damage.roots[damage.corners[k]] != whole.damage.corners[k])
      return false;
    used[damage.corners[k]] = 1;
  }
  for (const std::uint8_t one : used) {
    if (one == 0 && !damage.corners.empty()) return false;
  }
  for (const float one : damage.flow) {
    if (!is_finite(one)) return false;
  }
  if (count > before) {
    entry.body = build_elements(*entry.def, damage.corners, damage.roots);
    for (std::size_t i = 0; i < count; ++i) entry.body.particles.mass[i] = damage.mass[i];
    build_surface(entry, damage.corners);
  }
  if (!damage.flow.empty()) renew_flow(entry);
  return true;
}

void tear_soft(SoftEntry& entry, TaskSystem& tasks, Array<SoftSplit>& out) {
  if (entry.damage.empty() || !breaks(entry)) return;
  Array<Excess> excesses, scratch;
  Array<DVec3> rest;
  if (entry.kind == SoftKind::cloth) {
    rest = rest_places(*entry.def, entry.damage.roots);
    find_strained_edges(entry, rest.view(), excesses);
  } else {
    find_stressed_vertices(entry, tasks, excesses);
  }
  if (excesses.empty()) return;
  if (rest.empty()) rest = rest_places(*entry.def, entry.damage.roots);
  scratch.resize(excesses.size());
  merge_sort(excesses.view(), scratch.view(),
             [](const Excess& a, const Excess& b) { return a.amount > b.amount; });
  Tear tear(entry, rest.view());
  tear.run(excesses.view());
  if (!tear.any()) return;
  tear.finish(out);
  if (!entry.damage.flow.empty()) renew_flow(entry);
  wake(entry);
}

}  // namespace gyre
