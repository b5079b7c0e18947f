#include "soft/solver/visual_step.h"

#include "soft/solver/soft_pass.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kMaxColors = 64;
constexpr float kTetherSlack = 1.01f;  // links give a little

void make_links(SoftBody& body) {
  const SlicedRows& rows = body.springs.rows;
  Array<VisualLink> found;
  for (int slice = 0; slice < rows.slices(); ++slice) {
    for (int lane = 0; lane < kSliceRows; ++lane) {
      const std::int32_t row = slice * kSliceRows + lane;
      for (std::int32_t s = rows.slot_begin[slice]; s < rows.slot_begin[slice + 1]; ++s) {
        const std::size_t place = std::size_t(s) * kSliceRows + std::size_t(lane);
        const RowSlot slot = rows.slots[s];
        const std::int32_t other = slot.columns < 0 ? row + slot.offset : rows.columns[slot.columns + lane];
        if (row >= other || !(body.springs.stiffness[place] > 0.0f)) continue;
        found.push_back({std::uint32_t(row), std::uint32_t(other), body.springs.rest_length[place],
                         1.0f / body.springs.stiffness[place]});
      }
    }
  }
  // Each link takes the first colour that neither of its particles has. The last colour may have several of a particle.
  Array<std::uint64_t> used;
  used.assign(std::size_t(body.particles.count), std::uint64_t(0));
  Array<std::uint8_t> color;
  int colors = 0;
  for (const VisualLink& link : found) {
    const std::uint64_t free = ~(used[link.a] | used[link.b]);
    int c = 0;
    while (c + 1 < kMaxColors && (free >> c & 1u) == 0) ++c;
    used[link.a] |= std::uint64_t(1) << c, used[link.b] |= std::uint64_t(1) << c;
    color.push_back(std::uint8_t(c));
    colors = c + 1 > colors ? c + 1 : colors;
  }
  VisualLinks& out = body.visual;
  out = {};
  out.links.reserve(found.size());
  for (int c = 0; c < colors; ++c) {
    for (std::size_t k = 0; k < found.size(); ++k)
      if (color[k] == c) out.links.push_back(found[k]);
  }
  out.made = true;
}

bool has_tethers(const SoftBody& body) {
  const VisualLinks& visual = body.visual;
  if (visual.held.size() != body.held.size()) return false;
  for (std::size_t k = 0; k < body.held.size(); ++k)
    if (visual.held[k] != std::uint32_t(body.held[k].particle)) return false;
  return true;
}

// The shortest ways along links from held particles, by relaxation until nothing changes.
void make_tethers(SoftBody& body) {
  VisualLinks& visual = body.visual;
  const std::size_t count = std::size_t(body.particles.count);
  Array<float> far;
  Array<std::uint32_t> from;
  far.assign(count, -1.0f), from.assign(count, std::uint32_t(0));
  visual.held.clear(), visual.tethers.clear();
  for (const HeldParticle& one : body.held) {
    visual.held.push_back(std::uint32_t(one.particle));
    far[one.particle] = 0.0f, from[one.particle] = std::uint32_t(one.particle);
  }
  const auto relax = [&](std::uint32_t a, std::uint32_t b, float rest) {
    if (far[a] < 0.0f || (far[b] >= 0.0f && far[b] <= far[a] + rest)) return false;
    far[b] = far[a] + rest, from[b] = from[a];
    return true;
  };
  for (bool any = !body.held.empty(); any;) {
    any = false;
    for (const VisualLink& link : visual.links) {
      any |= relax(link.a, link.b, link.rest_length);
      any |= relax(link.b, link.a, link.rest_length);
    }
  }
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i)
    if (far[i] > 0.0f) visual.tethers.push_back({i, from[i], kTetherSlack * far[i]});
}

struct Node {
  Vec3 place{};  // m, from the first particle
  float inverse_mass = 0.0f;
};

void sweep_links(const VisualLinks& visual, float step, std::span<Node> nodes) {
  const float rate = 1.0f / (step * step);
  for (const VisualLink& link : visual.links) {
    Node &a = nodes[link.a], &b = nodes[link.b];
    const Vec3 edge = b.place - a.place;
    const float span = length(edge), weight = a.inverse_mass + b.inverse_mass + rate * link.compliance;
    if (!(span > 0.0f) || !(weight > 0.0f)) continue;
    const Vec3 pull = ((span - link.rest_length) / (weight * span)) * edge;
    a.place += a.inverse_mass * pull, b.place -= b.inverse_mass * pull;
  }
}

void pull_tethers(const VisualLinks& visual, std::span<Node> nodes) {
  for (const Tether& one : visual.tethers) {
    Node& node = nodes[one.particle];
    const Vec3 held = nodes[one.held].place, way = node.place - held;
    const float far = length(way);
    if (far > one.length) node.place = held + (one.length / far) * way;
  }
}

}  // namespace

void step_visual(SoftBody& body, float step, Vec3 gravity, Arena& arena) {
  const ArenaScope scope(arena);
  if (!body.visual.made) make_links(body);
  if (!has_tethers(body)) make_tethers(body);
  Particles& p = body.particles;
  const std::span<Node> nodes = arena.make<Node>(std::size_t(p.count));
  const DVec3 origin = p.place(0);
  for (int i = 0; i < p.count; ++i) {
    const float loose = p.loose[i], share = loose / p.mass[i];
    const Vec3 pull = loose * gravity + share * Vec3{p.fx[i], p.fy[i], p.fz[i]};
    nodes[std::size_t(i)] = {to_float(p.place(i) - origin) + step * (loose * p.velocity(i) + step * pull),
                             share};
  }
  for (const HeldParticle& one : body.held)
    nodes[std::size_t(one.particle)].place = to_float(one.place - origin);
  sweep_links(body.visual, step, nodes);
  pull_tethers(body.visual, nodes);
  const float rate = 1.0f / step;
  for (int i = 0; i < p.count; ++i) {
    const Vec3 way = nodes[std::size_t(i)].place - to_float(p.place(i) - origin);
    p.set_velocity(i, rate * way);
    p.set_place(i, p.place(i) + DVec3(way));
  }
  place_held(body);
}

}  // namespace gyre
