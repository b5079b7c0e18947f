// Groups of soft and rigid bodies that the rows of a coupled solve connect (soft/solver/coupled_solve.h). Each settles by itself, or gives in.
#pragma once

#include "base/arena/arena.h"
#include "soft/solver/coupled_row.h"

#include <cstdint>
#include <span>

namespace gyre {

struct CoupledGroup {
  bool yields = false;      // there is a rigid body among them
  bool is_settled = false;  // its misses do not fall any more
  bool gave_in = false;     // its rows are dampers now
  double missed = 0.0,
         missed_before = 0.0;  // m/s: what rows missed at the end of this stage and of the last one
};

// Sets the groups, each in the place of its least body, rigid ones behind the `bodies` soft ones; and that of each row. `body_of(at)` is the soft body of a vertex of a row.
template <class BodyOf>
void find_groups(std::span<const CoupledRow> rows, std::size_t bodies, BodyOf&& body_of, Arena& arena,
                 std::span<CoupledGroup> groups, std::span<std::uint32_t> group_of) {
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> root = arena.make<std::uint32_t>(groups.size());
  for (std::uint32_t i = 0; i < std::uint32_t(root.size()); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto rigid_of = [&](const CoupledRow& row) {
    return std::uint32_t(bodies) + std::uint32_t(row.body);
  };
  const auto first_of = [&](const CoupledRow& row) {
    return row.vertices > 0 ? std::uint32_t(body_of(row.at[0])) : rigid_of(row);
  };
  for (const CoupledRow& row : rows) {
    const auto join = [&](std::uint32_t other) {
      const std::uint32_t a = find(first_of(row)), b = find(other);
      root[max(a, b)] = min(a, b);
    };
    for (int k = 1; k < row.vertices; ++k) join(std::uint32_t(body_of(row.at[k])));
    if (row.body >= 0) join(rigid_of(row));
  }
  for (CoupledGroup& group : groups) group = {};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const bool is_held = rows[r].vertices == 0 && rows[r].body < 0;  // it does nothing
    group_of[r] = is_held ? 0u : find(first_of(rows[r]));
    if (rows[r].body >= 0) groups[group_of[r]].yields = true;
  }
}

}  // namespace gyre
