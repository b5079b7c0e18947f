// Disjoint sets (union-find), each named by its lowest member (B. A. Galler, M. J. Fischer, "An improved equivalence
// algorithm", Comm. ACM 7, 1964).
#pragma once

#include <cstdint>
#include <span>

namespace gyre {

struct DisjointSets {
  std::span<std::uint32_t> parents;

  explicit DisjointSets(std::span<std::uint32_t> room) : parents(room) {
    for (std::uint32_t i = 0; i < parents.size(); ++i) parents[i] = i;
  }

  std::uint32_t of(std::uint32_t i) const {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) const {
    a = of(a), b = of(b);
    if (a < b)
      parents[b] = a;
    else
      parents[a] = b;
  }
};

}  // namespace gyre
