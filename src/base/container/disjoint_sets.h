// Disjoint sets (union-find), each named by its lowest member (B. A. Galler, M. J. Fischer, "An improved equivalence
// algorithm", Comm. ACM 7, 1964).
#pragma once

#include <cstdint>
#include <span>

namespace gyre {

struct DisjointSets {
  static constexpr std::uint32_t kNoSet = 0xffffffffu;

  std::span<std::uint32_t> parents;

  DisjointSets() = default;
  // Each is a set of its own.
  explicit DisjointSets(std::span<std::uint32_t> room) : parents(room) {
    for (std::uint32_t i = 0; i < parents.size(); ++i) parents[i] = i;
  }
  // These are; the others are in no set, and stay so.
  DisjointSets(std::span<std::uint32_t> room, std::span<const std::uint32_t> members) : parents(room) {
    for (std::uint32_t& parent : parents) parent = kNoSet;
    for (const std::uint32_t i : members) parents[i] = i;
  }

  bool has(std::uint32_t i) const { return parents[i] != kNoSet; }
  std::uint32_t of(std::uint32_t i) const {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) const {
    // Most are in one set by the time they are asked.
    if (parents[a] == parents[b]) return;
    a = of(a), b = of(b);
    if (a < b)
      parents[b] = a;
    else
      parents[a] = b;
  }
  // From here on until more are united, parents[i] is of(i): of these, ascending, or of all. (Who is lower has its set by then.)
  void flatten(std::span<const std::uint32_t> members) const {
    for (const std::uint32_t i : members) parents[i] = parents[parents[i]];
  }
  void flatten() const {
    for (std::uint32_t& parent : parents) parent = parents[parent];
  }
};

}  // namespace gyre
