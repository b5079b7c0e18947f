#include "rigid/solve/held_bodies.h"

#include "base/container/disjoint_sets.h"
#include "rigid/solve/actuated_rows.h"

namespace gyre {

namespace {

// Facts about a body, as bits.
enum Mark : std::uint8_t {
  kJointed = 1,
  kMachine = 2,  // of the lowest body of a set: one of its joints does work
  kTouched = 4,
  kTouchedTwice = 8,
  kPressed = 16,  // by a machine
  kHeld = kTouchedTwice | kPressed,
};

class HeldBodyFinder {
 public:
  HeldBodyFinder(std::span<const std::uint32_t> local_index, std::size_t bodies, Arena& arena)
      : local_index_(local_index),
        machines_(arena.make<std::uint32_t>(bodies)),
        marks_(arena.make<std::uint8_t>(bodies)) {
    for (std::uint8_t& mark : marks_) mark = 0;
  }

  void connect(std::span<const JointEdge> joints) {
    for (const JointEdge& joint : joints) {
      if (joint.equations == 0) continue;  // ropes and springs
      for_moving(joint, [&](std::uint32_t body) { marks_[local_index_[body]] |= kJointed; });
      if (joint.body_a != kNoBody && joint.body_b != kNoBody)
        machines_.unite(local_index_[std::size_t(joint.body_a)], local_index_[std::size_t(joint.body_b)]);
    }
    machines_.flatten();
  }
  void mark_machine(const JointEdge& joint) {
    for_moving(joint, [&](std::uint32_t body) { marks_[machines_.parents[local_index_[body]]] |= kMachine; });
  }
  void touch(std::uint32_t body, std::uint32_t other) {
    if (body == ColoringPair::kNone || (marks_[body] & kJointed) != 0) return;
    marks_[body] |= (marks_[body] & kTouched) != 0 ? kTouchedTwice : kTouched;
    if (is_machine(other)) marks_[body] |= kPressed;
  }

  bool is_machine(std::uint32_t body) const {
    return body != ColoringPair::kNone && (marks_[machines_.parents[body]] & kMachine) != 0;
  }
  bool is_held(std::uint32_t body) const {
    return body != ColoringPair::kNone && (marks_[body] & kHeld) == kHeld;
  }

 private:
  std::span<const std::uint32_t> local_index_;
  DisjointSets machines_;
  std::span<std::uint8_t> marks_;
};

}  // namespace

HeldBodies find_held_bodies(const RigidWorld& w, const SolveBatch& batch,
                            std::span<const std::uint32_t> local_index, std::span<const JointEdge> joints,
                            std::span<const ColoringPair> pairs, Arena& arena) {
  const auto does_work = [&](std::size_t i) {
    const std::uint32_t slot = batch.joints[i];
    return can_do_work(w.joints.records[slot], detail_of(w.joints, slot));
  };
  std::size_t first = 0;
  while (first < joints.size() && !does_work(first)) ++first;
  if (first == joints.size() || pairs.empty()) return {};
  HeldBodyFinder bodies(local_index, batch.bodies.size(), arena);
  bodies.connect(joints);
  for (std::size_t i = first; i < joints.size(); ++i)
    if (does_work(i)) bodies.mark_machine(joints[i]);
  for (const ColoringPair& pair : pairs) bodies.touch(pair.a, pair.b), bodies.touch(pair.b, pair.a);
  const std::span<std::uint8_t> contacts = arena.make<std::uint8_t>(pairs.size()),
                                pressing = arena.make<std::uint8_t>(batch.bodies.size());
  for (std::uint8_t& body : pressing) body = 0;
  bool is_any = false;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    contacts[i] = bodies.is_held(a) || bodies.is_held(b) ? 1 : 0;
    if (contacts[i] == 0) continue;
    is_any = true;
    if (bodies.is_machine(a)) pressing[a] = 1;
    if (bodies.is_machine(b)) pressing[b] = 1;
  }
  return is_any ? HeldBodies{contacts, pressing} : HeldBodies{};
}

}  // namespace gyre
