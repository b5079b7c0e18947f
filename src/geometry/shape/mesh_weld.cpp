// Welds in two rounds: equal coordinates by sorted hashes, close ones through a grid of cells four tolerances wide.
// Only representatives are tested in a cell, and they are a tolerance apart, so the time is linear for any input.
#include "geometry/shape/mesh_weld.h"

#include "base/container/sort.h"
#include "base/hash.h"

#include <cstring>

namespace gyre {
namespace {

constexpr float kRelativeTolerance = 1.0e-6f;  // of the mesh's size: nearer vertices are one

struct SortedKeys {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> vertices;

  void sort() {
    std::vector<std::uint64_t> scratch_keys(keys.size());
    std::vector<std::uint32_t> scratch(keys.size());
    radix_sort_pairs(keys, vertices, scratch_keys, scratch);
  }

  // The first index whose key is not below `key`.
  std::size_t find(std::uint64_t key) const {
    std::size_t low = 0, high = keys.size();
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (keys[middle] < key) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
};

std::uint64_t hash_position(Vec3 p) {
  // Adding zero makes -0 and 0 equal.
  const float coordinates[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
  return hash_bytes(coordinates, sizeof coordinates);
}

// Equal coordinates: representative[i] is the lowest vertex at the same position.
std::vector<std::uint32_t> weld_equal(std::span<const Vec3> vertices) {
  const std::size_t count = vertices.size();
  SortedKeys sorted;
  sorted.keys.resize(count);
  sorted.vertices.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    sorted.keys[i] = hash_position(vertices[i]);
    sorted.vertices[i] = std::uint32_t(i);
  }
  sorted.sort();
  std::vector<std::uint32_t> representative(count);
  for (std::size_t begin = 0; begin < count;) {
    const std::uint32_t leader = sorted.vertices[begin];
    std::size_t end = begin;
    for (; end < count && sorted.keys[end] == sorted.keys[begin]; ++end) {
      const std::uint32_t vertex = sorted.vertices[end];
      // Two positions with one hash stay apart.
      representative[vertex] = vertices[vertex] == vertices[leader] ? leader : vertex;
    }
    begin = end;
  }
  return representative;
}

class CloseWelder {
 public:
  CloseWelder(std::span<const Vec3> vertices, const std::vector<std::uint32_t>& equal) : vertices_(vertices) {
    Aabb box{vertices[0], vertices[0]};
    for (const Vec3 v : vertices) box = merge(box, {v, v});
    low_ = box.low;
    tolerance_ = kRelativeTolerance * largest(box.high - box.low);
    if (!(tolerance_ > 0.0f)) return;
    inverse_cell_ = 1.0 / (4.0 * double(tolerance_));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (equal[i] != i) continue;
      sorted_.keys.push_back(cell_of(vertices[i], 0, 0, 0));
      sorted_.vertices.push_back(std::uint32_t(i));
    }
    sorted_.sort();
    leaders_.resize(sorted_.keys.size());
    leader_count_.resize(sorted_.keys.size());
  }

  // Sets `near[i]` to the lowest vertex that represents vertex i. Vertex i must represent itself in `equal`.
  void weld(const std::vector<std::uint32_t>& equal, const std::vector<std::uint8_t>& pinned,
            std::vector<std::uint32_t>& near) {
    near = equal;
    if (!(tolerance_ > 0.0f)) return;
    for (std::uint32_t& count : leader_count_) count = 0;
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
      if (equal[i] != i) {
        near[i] = near[equal[i]];
        continue;
      }
      const std::uint32_t found = pinned[i] != 0 ? i : find_leader(i);
      near[i] = found;
      if (found != i) continue;
      const std::size_t run = sorted_.find(cell_of(vertices_[i], 0, 0, 0));
      leaders_[run + leader_count_[run]++] = i;
    }
  }

 private:
  std::uint64_t cell_of(Vec3 p, int dx, int dy, int dz) const {
    const auto index = [&](float value, float low, int step) {
      const double offset = double(value) - double(low) + double(step) * double(tolerance_);
      return std::uint64_t(max(offset, 0.0) * inverse_cell_);
    };
    return index(p.x, low_.x, dx) << 42 | index(p.y, low_.y, dy) << 21 | index(p.z, low_.z, dz);
  }

  // The lowest leader within the tolerance of vertex i, or i.
  std::uint32_t find_leader(std::uint32_t i) const {
    const Vec3 p = vertices_[i];
    std::uint32_t found = i;
    std::uint64_t tested[8];
    int tested_count = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const std::uint64_t cell = cell_of(p, corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      bool repeated = false;
      for (int k = 0; k < tested_count; ++k) repeated = repeated || tested[k] == cell;
      if (repeated) continue;
      tested[tested_count++] = cell;
      const std::size_t run = sorted_.find(cell);
      if (run == sorted_.keys.size() || sorted_.keys[run] != cell) continue;
      for (std::uint32_t k = 0; k < leader_count_[run]; ++k) {
        const std::uint32_t leader = leaders_[run + k];
        if (leader < found && largest(absolute(vertices_[leader] - p)) <= tolerance_) found = leader;
      }
    }
    return found;
  }

  std::span<const Vec3> vertices_;
  Vec3 low_;
  float tolerance_ = 0.0f;
  double inverse_cell_ = 0.0;
  SortedKeys sorted_;
  std::vector<std::uint32_t> leaders_;       // those of each cell at the start of its run in `sorted_`
  std::vector<std::uint32_t> leader_count_;  // by the start of the run
};

// Pins the corners of triangles that would lose an edge. Returns true if there are any.
bool mark_collapsed(std::span<const std::uint32_t> indices, const std::vector<std::uint32_t>& equal,
                    const std::vector<std::uint32_t>& near, std::vector<std::uint8_t>& pinned) {
  bool any = false;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
      if (equal[a] == equal[b] || near[a] != near[b]) continue;
      pinned[equal[a]] = pinned[equal[b]] = 1;
      any = true;
    }
  }
  return any;
}

}  // namespace

std::vector<std::uint32_t> weld_vertices(std::span<const Vec3> vertices,
                                         std::span<const std::uint32_t> indices) {
  if (vertices.empty()) return {};
  const std::vector<std::uint32_t> equal = weld_equal(vertices);
  CloseWelder welder(vertices, equal);
  std::vector<std::uint8_t> pinned(vertices.size(), 0);
  std::vector<std::uint32_t> near;
  // Pinned vertices may attract others, so several rounds may be needed. After that, close vertices stay apart.
  for (int round = 0; round < 4; ++round) {
    welder.weld(equal, pinned, near);
    if (!mark_collapsed(indices, equal, near, pinned)) return near;
  }
  return equal;
}

}  // namespace gyre
