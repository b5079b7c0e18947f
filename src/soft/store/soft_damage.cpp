#include "soft/store/soft_damage.h"

#include "base/container/sort.h"
#include "math/dense.h"
#include "soft/body/element_stress.h"
#include "soft/contact/surface_crossings.h"
#include "soft/elements/crack_gap.h"
#include "soft/elements/solid.h"
#include "soft/elements/vertex_split.h"
#include "soft/store/soft_builder.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kMaxSplits = 64;   // of vertices in one step, those of their neighbours apart
constexpr float kMaxGap = 0.2f;  // of the mean edge: more is not made by moving vertices
constexpr int kHalvings = 4;     // of the moves of parts that would cross others
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
double determinant(const double (&m)[9]) {
  return dot(cross(DVec3{m[0], m[1], m[2]}, DVec3{m[3], m[4], m[5]}), DVec3{m[6], m[7], m[8]});
}

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

void find_stressed_vertices(const SoftEntry& entry, TaskSystem& tasks, Array<Excess>& out) {
  const double limit = double(std::get<SolidDef>(*entry.def).fracture_stress);
  const Array<std::uint32_t>& corners = entry.damage.corners;
  const int count = int(corners.size() / 4);
  Array<ElementStress> elements, vertices;
  elements.resize(std::size_t(count));
  for_blocks(tasks, count, kTetsAtOnce, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t) elements[t] = stress_of(entry.body, std::size_t(t));
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
    if (arity_ == 4) list_around_roots();
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
    if (arity_ == 3) {
      move_apart(recede_in_plane());
    } else {
      move_apart(follow_rest());
    }
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
    for_each_corner(around.view(), [&](std::uint32_t neighbour) {
      if (splitter_.source(neighbour) == vertex) return;
      Array<std::uint8_t> same;
      same.resize(splitter_.around(neighbour).size());
      splitter_.split(neighbour, same.view(), made_);
    });
    if (arity_ == 4 && !have_room(around.view(), first)) return false;
    for_each_corner(around.view(), [&](std::uint32_t one) { busy_[splitter_.source(one)] = 1; });
    return true;
  }

  void list_around_roots() {
    whole_ = whole_places(entry_), roots_ = entry_.damage.roots;
    parts_.assign(count_, 0u), around_begin_.assign(count_ + 1, 0u);
    for (const std::uint32_t root : roots_) ++parts_[root];
    for (const std::uint32_t corner : corners_) ++around_begin_[roots_[corner] + 1];
    for (std::uint32_t v = 0; v < count_; ++v) around_begin_[v + 1] += around_begin_[v];
    around_.resize(corners_.size());
    Array<std::uint32_t> next = around_begin_;
    for (std::size_t k = 0; k < corners_.size(); ++k)
      around_[next[roots_[corners_[k]]]++] = std::uint32_t(k) / 4;
    for (std::size_t k = 0; k < corners_.size(); k += 4)
      element_volume_.push_back(measure_of(whole_.view(), corners_.data() + k, 4));
  }

  // Takes the splits since made_[first] back if parts of a vertex around them would grip each other (crack_gap.h).
  bool have_room(std::span<const std::uint32_t> elements, std::size_t first) {
    for (std::size_t i = first; i < made_.size(); ++i) {
      roots_.push_back(roots_[splitter_.source(made_[i])]);
      ++parts_[roots_.back()];
    }
    volumes_.resize(roots_.size()), moves_.resize(roots_.size());
    bool fits = true;
    for_each_corner(elements, [&](std::uint32_t one) { fits = fits && has_room(roots_[one]); });
    if (fits) return true;
    for (std::size_t i = first; i < made_.size(); ++i) --parts_[roots_[made_[i]]];
    roots_.resize(made_[first]);
    splitter_.undo(made_[first]);
    made_.resize(first);
    return false;
  }

  // Calls visit(vertex) for all corners of elements, as they are now.
  template <class Visit>
  void for_each_corner(std::span<const std::uint32_t> elements, Visit&& visit) const {
    for (const std::uint32_t element : elements) {
      for (int k = 0; k < arity_; ++k) visit(corners_[element * std::uint32_t(arity_) + std::uint32_t(k)]);
    }
  }
  // False if the parts of a vertex of the definition would grip each other.
  bool has_room(std::uint32_t root) {
    if (parts_[root] < 2) return true;
    near_.clear();
    for (std::uint32_t k = around_begin_[root]; k < around_begin_[root + 1]; ++k) {
      const std::uint32_t* const corner = corners_.data() + 4 * around_[k];
      for (int n = 0; n < 4; ++n) {
        near_.push_back(corner[n]);
        volumes_[corner[n]] = 0.0, moves_[corner[n]] = {};
      }
    }
    for (std::size_t k = 0; k < near_.size(); ++k) {
      const std::uint32_t element = around_[around_begin_[root] + std::uint32_t(k) / 4];
      volumes_[near_[k]] += element_volume_[element];
    }
    list_crack_faces(near_.view(), roots_.view(), whole_.view(), faces_);
    std::size_t begin = 0, end = 0;
    while (begin < faces_.size() && faces_[begin].root != root) ++begin;
    for (end = begin; end < faces_.size() && faces_[end].root == root; ++end) {
    }
    return separate_parts(faces_.view().subspan(begin, end - begin), volumes_.view(),
                          {moves_.data(), moves_.size()});
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
    SoftBody next = build_elements(entry_);
    next.held = entry_.body.held;
    entry_.body = std::move(next);
    build_surface(entry_);
    Particles& p = entry_.body.particles;
    for (int i = 0; i < p.count; ++i) {
      const int from = int(splitter_.source(std::uint32_t(i)));
      p.set_place(i, before.place(from));
      p.set_velocity(i, before.velocity(from));
      p.mass[i] = entry_.damage.mass[i];
      p.loose[i] = std::uint32_t(i) < count_ ? before.loose[i] : 1.0f;
    }
  }

  // Parts of a vertex of a cloth recede towards the triangles around them.
  Array<DVec3> recede_in_plane() const {
    const Particles& p = entry_.body.particles;
    Array<DVec3> way;
    way.resize(std::size_t(p.count));
    for (std::size_t first = 0; first < corners_.size(); first += 3) {
      const std::uint32_t* const corner = corners_.data() + first;
      const DVec3 middle = middle_of(p, corner, 3);
      for (int k = 0; k < 3; ++k) way[corner[k]] += middle - p.place(int(corner[k]));
    }
    const double gap = double(min(2.0f * entry_.radius, kMaxGap * entry_.size));
    for (DVec3& one : way) {
      const double size = length(one);
      one = size > 0.0 ? (0.5 * gap / size) * one : DVec3{};
    }
    return way;
  }

  // Parts of a vertex of a solid go where their places at rest have gone, as the elements around them are deformed.
  Array<DVec3> follow_rest() const {
    const Particles& p = entry_.body.particles;
    const Array<DVec3> rest = rest_places(entry_);
    Array<DVec3> way;
    Array<double> whole;
    way.resize(std::size_t(p.count)), whole.resize(std::size_t(p.count));
    for (std::size_t first = 0; first < corners_.size(); first += 4) {
      const std::uint32_t* const corner = corners_.data() + first;
      const auto before = [&](int k) { return rest_[splitter_.source(corner[k])]; };
      double edges[9], inverse[9];
      for (int k = 0; k < 3; ++k) {
        const DVec3 edge = before(k + 1) - before(0);
        edges[3 * k] = edge.x, edges[3 * k + 1] = edge.y, edges[3 * k + 2] = edge.z;
      }
      if (!invert_3x3(edges, inverse)) continue;
      const double volume = absolute(determinant(edges));
      for (int k = 0; k < 4; ++k) {
        const DVec3 moved = rest[corner[k]] - before(k);
        DVec3 sum{};
        for (int n = 0; n < 3; ++n) {
          const double part = inverse[n] * moved.x + inverse[3 + n] * moved.y + inverse[6 + n] * moved.z;
          sum += part * (p.place(int(corner[n + 1])) - p.place(int(corner[0])));
        }
        way[corner[k]] += volume * sum, whole[corner[k]] += volume;
      }
    }
    for (std::size_t v = 0; v < way.size(); ++v)
      if (whole[v] > 0.0) way[v] = (1.0 / whole[v]) * way[v];
    return way;
  }

  // Takes the mean from the moves of the parts of each vertex that was split, so that their centre of mass stays; of one that is held, the move of the
  // part that stays held.
  void take_means(Array<DVec3>& way) const {
    const Particles& p = entry_.body.particles;
    Array<DVec3> moment;
    Array<double> mass;
    moment.resize(count_), mass.resize(count_);
    Array<std::uint8_t> parted;
    parted.resize(count_);
    for (const std::uint32_t one : made_) parted[splitter_.source(one)] = 1;
    for (std::uint32_t v = 0; v < way.size(); ++v) {
      const std::uint32_t source = splitter_.source(v);
      const double weight = p.loose[source] != 0.0f ? double(p.mass[v]) : v == source ? 1.0 : 0.0;
      moment[source] += weight * way[v], mass[source] += weight;
    }
    for (std::uint32_t v = 0; v < way.size(); ++v) {
      const std::uint32_t source = splitter_.source(v);
      way[v] = parted[source] != 0 ? way[v] - (1.0 / mass[source]) * moment[source] : DVec3{};
    }
  }

  // Moves the parts. Where they would cross others, moves are halved: the rest is done by the stress of the room that is missing.
  void move_apart(Array<DVec3> way) {
    take_means(way);
    Particles& p = entry_.body.particles;
    Array<DVec3> places;
    for (int v = 0; v < p.count; ++v) places.push_back(p.place(v));
    const PlacedSurface placed{entry_.contact_surface.get(), 0};
    Array<DVec3> ends;
    Array<EdgeCrossing> crossings;
    Arena arena;
    for (int round = 0;; ++round) {
      ends = places;
      for (std::size_t v = 0; v < ends.size(); ++v) ends[v] += way[v];
      if (round == kHalvings || arity_ == 3) break;
      list_passing_edges({&placed, 1}, ends.view(), arena, crossings);
      if (crossings.empty()) break;
      Array<std::uint8_t> halved;
      halved.resize(count_);
      for (const EdgeCrossing& one : crossings) {
        const SurfaceEdge& edge = placed.surface->edges[one.edge];
        const SoftTriangle& triangle = placed.surface->triangles[one.triangle];
        for (const std::uint32_t v :
             {edge.a, edge.b, triangle.corner[0], triangle.corner[1], triangle.corner[2]})
          halved[splitter_.source(v)] = 1;
      }
      for (std::uint32_t v = 0; v < way.size(); ++v)
        if (halved[splitter_.source(v)] != 0) way[v] = 0.5 * way[v];
    }
    for (int v = 0; v < p.count; ++v) p.set_place(v, ends[std::size_t(v)]);
  }

  SoftEntry& entry_;
  std::span<const DVec3> rest_;  // by particle
  int arity_;
  std::uint32_t count_;
  Array<std::uint32_t> corners_;
  VertexSplitter splitter_;
  Array<std::uint8_t> busy_;
  Array<std::uint32_t> made_;
  // Of a solid: where particles were at rest before anything broke, the volumes of elements, the vertex of the definition that each vertex was, into how
  // many each of those is split, and the elements around each of those.
  Array<DVec3> whole_;
  Array<double> element_volume_;
  Array<std::uint32_t> roots_, parts_, around_begin_, around_;
  // Of has_room().
  Array<std::uint32_t> near_;
  Array<double> volumes_;
  Array<DVec3> moves_;
  Array<CrackFace> faces_;
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
    entry.body = build_elements(entry);
    for (std::size_t i = 0; i < count; ++i) entry.body.particles.mass[i] = damage.mass[i];
    build_surface(entry);
  }
  if (!damage.flow.empty()) renew_flow(entry);
  return true;
}

void tear_soft(SoftEntry& entry, TaskSystem& tasks, Array<SoftSplit>& out) {
  if (entry.damage.empty() || !breaks(entry)) return;
  Array<Excess> excesses, scratch;
  Array<DVec3> rest;
  if (entry.kind == SoftKind::cloth) {
    rest = rest_places(entry);
    find_strained_edges(entry, rest.view(), excesses);
  } else {
    find_stressed_vertices(entry, tasks, excesses);
  }
  if (excesses.empty()) return;
  if (rest.empty()) rest = rest_places(entry);
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
