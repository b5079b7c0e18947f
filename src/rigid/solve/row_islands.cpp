#include "rigid/solve/row_islands.h"

#include "base/arena/bucketed_lists.h"
#include "math/block_lu.h"
#include "solver/rows/constraint_rows.h"

namespace gyre {

namespace {

// Sets of bodies; the root of a set is its lowest.
class BodySets {
 public:
  BodySets(std::size_t bodies, Arena& arena) : parents_(arena.make<std::uint32_t>(bodies)) {
    for (std::uint32_t i = 0; i < bodies; ++i) parents_[i] = i;
  }
  std::uint32_t root(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a < b) parents_[b] = a;
    if (b < a) parents_[a] = b;
  }

 private:
  std::span<std::uint32_t> parents_;
};

std::uint32_t active(const RigidWorld& w, std::int32_t body) {
  return body != kNoBody && is_active(w, std::uint32_t(body)) ? std::uint32_t(body) : kNoIndex;
}

struct Ends {
  std::uint32_t a, b;
  std::uint32_t any() const { return a != kNoIndex ? a : b; }
};
Ends ends_of(const RigidWorld& w, const ContactConstraint& c) {
  return {active(w, c.body_a), active(w, c.body_b)};
}
Ends ends_of(const RigidWorld& w, const JointRecord& j) { return {active(w, j.body_a), active(w, j.body_b)}; }

DirectSize size_of(const RigidWorld& w, const BatchScratch& scratch, const SolveBatch& batch,
                   std::span<const JointConstraint> work, const RowIsland& island) {
  DirectSize size;
  for (const std::uint32_t i : island.constraints) {
    const std::size_t rows = std::size_t(count_contact_rows(scratch.constraints[i]));
    size.rows += rows;
    size.cones += (rows + 1) / 2;
  }
  for (const std::uint32_t i : island.joints) {
    const std::uint32_t slot = batch.joints[i];
    const std::size_t rows =
        std::size_t(count_joint_rows(w.joints.records[slot], detail_of(w.joints, slot), work[i]));
    size.rows += rows;
    size.equations += rows;
  }
  return size;
}

}  // namespace

RowIslands find_row_islands(const RigidWorld& w, const BatchScratch& scratch, const SolveBatch& batch,
                            std::span<const JointConstraint> work, Arena& arena) {
  const std::size_t bodies = w.bodies.motion.size();
  const std::span<std::int32_t> place = arena.make<std::int32_t>(bodies);
  const std::span<std::uint32_t> island_of = arena.make<std::uint32_t>(bodies);
  for (std::size_t i = 0; i < bodies; ++i) place[i] = kNoRowBody, island_of[i] = kNoIndex;
  BodySets sets(bodies, arena);
  const auto join = [&](Ends ends) {
    if (ends.a != kNoIndex) place[ends.a] = 0;
    if (ends.b != kNoIndex) place[ends.b] = 0;
    if (ends.a != kNoIndex && ends.b != kNoIndex) sets.unite(ends.a, ends.b);
  };
  for (const ContactConstraint& constraint : scratch.constraints) join(ends_of(w, constraint));
  for (const std::uint32_t slot : batch.joints) join(ends_of(w, w.joints.records[slot]));
  std::uint32_t count = 0;
  for (const std::uint32_t body : batch.bodies) {
    if (place[body] == kNoRowBody) continue;
    const std::uint32_t root = sets.root(body);
    island_of[body] = root == body ? count++ : island_of[root];
  }
  BucketedLists own(count, arena), contacts(count, arena), joints(count, arena);
  for (const std::uint32_t body : batch.bodies)
    if (place[body] != kNoRowBody) own.count(island_of[body]);
  for (const ContactConstraint& constraint : scratch.constraints)
    contacts.count(island_of[ends_of(w, constraint).any()]);
  for (const std::uint32_t slot : batch.joints)
    joints.count(island_of[ends_of(w, w.joints.records[slot]).any()]);
  own.make_room(arena), contacts.make_room(arena), joints.make_room(arena);
  for (const std::uint32_t body : batch.bodies)
    if (place[body] != kNoRowBody) own.add(island_of[body], body);
  for (std::uint32_t i = 0; i < scratch.constraints.size(); ++i)
    contacts.add(island_of[ends_of(w, scratch.constraints[i]).any()], i);
  for (std::uint32_t i = 0; i < batch.joints.size(); ++i)
    joints.add(island_of[ends_of(w, w.joints.records[batch.joints[i]]).any()], i);
  RowIslands islands{arena.make<RowIsland>(count), place};
  for (std::uint32_t i = 0; i < count; ++i) {
    RowIsland& island = islands.islands[i];
    island = {own.of(i), contacts.of(i), joints.of(i), {}, {}};
    island.size = size_of(w, scratch, batch, work, island);
    for (std::size_t n = 0; n < island.bodies.size(); ++n) place[island.bodies[n]] = std::int32_t(n);
  }
  return islands;
}

void plan_row_islands(const RigidWorld& w, const BatchScratch& scratch, const SolveBatch& batch,
                      std::uint64_t max_work, Arena& arena, RowIslands& islands) {
  for (RowIsland& island : islands.islands) {
    const std::span<std::uint8_t> sizes = arena.make<std::uint8_t>(island.bodies.size());
    for (std::uint8_t& size : sizes) size = kLuBlock;
    const std::span<BlockEdge> edges =
        arena.make<BlockEdge>(island.constraints.size() + island.joints.size());
    std::size_t count = 0;
    const auto add = [&](Ends ends) {
      if (ends.a == kNoIndex || ends.b == kNoIndex || ends.a == ends.b) return;
      edges[count++] = {std::uint32_t(islands.place[ends.a]), std::uint32_t(islands.place[ends.b])};
    };
    for (const std::uint32_t i : island.constraints) add(ends_of(w, scratch.constraints[i]));
    for (const std::uint32_t i : island.joints) add(ends_of(w, w.joints.records[batch.joints[i]]));
    plan_blocks(sizes, edges.first(count), max_work, arena, island.plan);
  }
}

}  // namespace gyre
