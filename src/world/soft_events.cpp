#include "world/soft_events.h"

#include "base/container/sort.h"
#include "dynamics/soft/soft_solve.h"
#include "task/parallel.h"
#include "world/soft_commands.h"
#include "world/world_state.h"

namespace gyre {

namespace {

constexpr int kBlocksAtOnce = 64;

bool touches(const SoftContact& contact) { return contact.gap <= 0.0f || contact.impulse != Vec3{}; }

// The shapes that an entry touches, ascending. `mark` is 0 for every shape, before and after.
void find_touching(const SoftEntry& entry, Array<std::uint8_t>& mark, Array<SoftTouch>& out) {
  out.clear();
  for_each_contact(entry, [&](const SoftContact& contact) {
    if (!touches(contact) || mark[contact.shape] != 0) return;
    mark[contact.shape] = 1;
    out.push_back({contact.shape, contact.particle});
  });
  for (const SoftTouch& one : out) mark[one.shape] = 0;
  Array<SoftTouch> scratch;
  scratch.resize(out.size());
  merge_sort(out.view(), scratch.view(),
             [](const SoftTouch& a, const SoftTouch& b) { return a.shape < b.shape; });
}

bool is_inverted(const Particles& p, const TetBlock& block, int lane) {
  if (block.volume[lane] == 0.0f) return false;
  const auto rest = [&](int c) {
    return DVec3{double(block.gradient[3 * c][lane]), double(block.gradient[3 * c + 1][lane]),
                 double(block.gradient[3 * c + 2][lane])};
  };
  const DVec3 origin = p.place(block.corner[0][lane]);
  const auto edge = [&](int c) { return p.place(block.corner[c][lane]) - origin; };
  // The product of both determinants is that of the deformation gradient.
  return dot(edge(1), cross(edge(2), edge(3))) * dot(rest(0), cross(rest(1), rest(2))) < 0.0;
}

void find_inverted(const SoftEntry& entry, TaskSystem& tasks, Array<std::uint8_t>& out) {
  const Array<TetBlock>& blocks = entry.body.continuum.tetrahedra;
  out.resize(kTetLanes * blocks.size());
  for_blocks(tasks, int(blocks.size()), kBlocksAtOnce, [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      for (int lane = 0; lane < kTetLanes; ++lane)
        out[kTetLanes * i + lane] = is_inverted(entry.body.particles, blocks[i], lane);
    }
  });
}

void report_touches(WorldState& s, std::uint32_t slot, std::span<const SoftTouch> before,
                    std::span<const SoftTouch> after) {
  const RigidWorld& w = s.rigid;
  std::size_t a = 0, b = 0;
  while (a < before.size() || b < after.size()) {
    if (b == after.size() || (a < before.size() && before[a].shape < after[b].shape)) {
      s.soft.events.ends.push_back({soft_id(s, slot), shape_id(w, before[a++].shape)});
    } else if (a == before.size() || after[b].shape < before[a].shape) {
      const SoftTouch& one = after[b++];
      s.soft.events.begins.push_back({soft_id(s, slot), shape_id(w, one.shape),
                                      body_id(w, w.shapes.bodies[one.shape]), int(one.particle)});
    } else {
      ++a, ++b;
    }
  }
}

void report_inverted(WorldState& s, std::uint32_t slot, std::span<const std::uint8_t> before,
                     std::span<const std::uint8_t> after) {
  const SoftEntry& entry = s.soft.entries[slot];
  for (std::size_t t = 0; t < after.size(); ++t) {
    if (after[t] == 0 || before[t] != 0) continue;
    SoftInverted out{soft_id(s, slot), int(t), {}};
    for (std::size_t k = 0; k < 4; ++k)
      out.vertices[k] =
          std::uint32_t(entry.body.continuum.tetrahedra[t / kTetLanes].corner[k][t % kTetLanes]);
    s.soft.events.inverted.push_back(out);
  }
}

}  // namespace

void note_soft_before(WorldState& s) {
  if (s.soft.empty()) return;
  s.soft_touch_mark.resize(s.rigid.shapes.ids.capacity());
  s.soft.for_each([&](SoftEntry& entry) {
    SoftReported& reported = entry.reported;
    reported.was_awake = entry.is_awake();
    if (reported.known) return;
    find_touching(entry, s.soft_touch_mark, reported.touching);
    find_inverted(entry, *s.tasks, reported.inverted);
    reported.known = true;
  });
}

void damage_soft(WorldState& s, float seconds) {
  for (std::uint32_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    SoftEntry& entry = s.soft.entries[slot];
    if (entry.def == nullptr || entry.damage.empty() || !entry.is_awake()) continue;
    hold_attached(s.rigid, entry);
    flow_soft(entry, seconds, *s.tasks);
    s.soft_splits.clear();
    tear_soft(entry, *s.tasks, s.soft_splits);
    for (const SoftSplit& one : s.soft_splits)
      s.soft.events.torn.push_back({soft_id(s, slot), int(one.vertex), int(one.made)});
  }
}

void report_soft_events(WorldState& s) {
  for (std::uint32_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    SoftEntry& entry = s.soft.entries[slot];
    if (entry.def == nullptr || (!entry.is_awake() && !entry.reported.was_awake)) continue;
    find_touching(entry, s.soft_touch_mark, s.soft_touching);
    report_touches(s, slot, entry.reported.touching, s.soft_touching);
    std::swap(entry.reported.touching, s.soft_touching);
    if (entry.body.continuum.tetrahedra.empty()) continue;
    find_inverted(entry, *s.tasks, s.soft_inverted);
    report_inverted(s, slot, entry.reported.inverted, s.soft_inverted);
    std::swap(entry.reported.inverted, s.soft_inverted);
  }
  std::swap(s.published_soft_events, s.soft.events);
  s.soft.events.clear();
}

void end_soft_touches(WorldState& s, std::uint32_t slot) {
  s.soft_touch_mark.resize(s.rigid.shapes.ids.capacity());
  find_touching(s.soft.entries[slot], s.soft_touch_mark, s.soft_touching);
  report_touches(s, slot, s.soft_touching, {});
  s.soft.entries[slot].reported.known = false;
}

void drop_soft_contacts(WorldState& s, std::uint32_t shape) {
  for (std::uint32_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    SoftEntry& entry = s.soft.entries[slot];
    if (entry.def == nullptr) continue;
    bool touched = false;
    for (std::size_t k = entry.contacts.size(); k-- > 0;) {
      if (entry.contacts[k].shape != shape) continue;
      touched = touched || touches(entry.contacts[k]);
      entry.contacts.erase_at(k);
      wake(entry);
      entry.reported.known = false;
    }
    for (std::size_t k = entry.faces.size(); k-- > 0;) {
      if (entry.faces[k].at.shape != shape) continue;
      touched = touched || touches(entry.faces[k].at);
      entry.faces.erase_at(k);
      wake(entry);
      entry.reported.known = false;
    }
    if (touched) s.soft.events.ends.push_back({soft_id(s, slot), shape_id(s.rigid, shape)});
  }
}

}  // namespace gyre
