// Space in cubic cells, in the order of a space-filling curve; each rank owns a run of cells.
//
// The curve is that of G. Morton, 1966: the bits of the three coordinates of a cell in turn.
#pragma once

#include <gyre/math.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace gyre {

class SpaceBlocks {
 public:
  SpaceBlocks() = default;
  SpaceBlocks(double cell, int ranks) : cell_(cell), begins_(std::size_t(ranks), 0) {}

  double cell() const { return cell_; }
  std::uint64_t key_of(DVec3 p) const { return key(coordinate(p.x), coordinate(p.y), coordinate(p.z)); }
  int owner_of_key(std::uint64_t key) const;
  int owner_of(DVec3 p) const { return owner_of_key(key_of(p)); }
  // Calls fn(rank) for the owner of each cell that the cube around p reaches; a rank may come more than once.
  template <class Fn>
  void for_each_owner(DVec3 p, double reach, Fn&& fn) const {
    for (std::int64_t x = coordinate(p.x - reach); x <= coordinate(p.x + reach); ++x) {
      for (std::int64_t y = coordinate(p.y - reach); y <= coordinate(p.y + reach); ++y) {
        for (std::int64_t z = coordinate(p.z - reach); z <= coordinate(p.z + reach); ++z)
          fn(owner_of_key(key(x, y, z)));
      }
    }
  }
  // Divides the curve into runs of equal weight, as nearly as whole cells allow.
  void divide(const std::map<std::uint64_t, double>& weights);
  const std::vector<std::uint64_t>& begins() const { return begins_; }
  void set_begins(const std::vector<std::uint64_t>& begins) { begins_ = begins; }

 private:
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z);
  std::int64_t coordinate(double x) const;

  double cell_ = 1.0;                  // m
  std::vector<std::uint64_t> begins_;  // by rank: the key of the first cell; the first is 0, ascending
};

}  // namespace gyre
