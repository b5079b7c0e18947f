// Meshes of any kind to hulls: refused, or hulls within what was asked for, the same for any threads, that come back from the bytes
// that keep them; and those bytes, damaged, are refused.
#include "edits.h"

#include <gyre/decomposition.h>

#include <cmath>
#include <cstdlib>

namespace {

using namespace gyre;

// A few vertices, many of them on a coarse grid or at each other's places, and any triangles; few of them, for sixty that cross
// each other at will take up to 17 s under sanitizers.
struct Soup {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
};
Soup read_soup(fuzz::Input& input) {
  Soup soup;
  const std::size_t count = 3 + input.below(20);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t kind = input.byte();
    const auto number = [&] {
      const std::uint8_t b = input.byte();
      if (kind % 16 == 15) return __builtin_bit_cast(float, input.word());  // anything, not a number too
      if (kind % 4 == 0) return float(b % 5) - 2.0f;
      return (float(b) - 128.0f) / 64.0f * (kind % 16 == 14 ? 1e6f : 1.0f);
    };
    Vec3 v{number(), 0, 0};
    v.y = number(), v.z = number();
    if (kind % 16 == 13 && !soup.vertices.empty()) v = soup.vertices[input.below(soup.vertices.size())];
    soup.vertices.push_back(v);
  }
  const std::size_t triangles = input.below(24);
  for (std::size_t i = 0; i < 3 * triangles; ++i) {
    const std::uint8_t b = input.byte();
    soup.indices.push_back(b == 255 ? input.word() : std::uint32_t(b % count));
  }
  return soup;
}

void check(bool holds) {
  if (!holds) std::abort();
}

void try_mesh(fuzz::Input& input) {
  DecompositionDef def;
  def.meaning = SurfaceMeaning(input.byte() % kSurfaceMeaningCount);
  def.concavity = 0.05f + 0.05f * float(input.byte() % 8);
  def.max_hulls = 1 + input.byte() % 12;
  def.max_hull_vertices = 8 + input.byte() % 40;
  const Soup soup = read_soup(input);
  def.vertices = soup.vertices;
  def.indices = soup.indices;
  const Result<Decomposition> made = decompose(def);
  def.threads = 3;
  const Result<Decomposition> again = decompose(def);
  check(bool(made) == bool(again));
  if (!made) return;
  check(!made->hulls.empty() && made->hulls.size() <= std::size_t(def.max_hulls));
  check(made->hulls.size() == again->hulls.size());
  for (std::size_t i = 0; i < made->hulls.size(); ++i) {
    check(made->hulls[i].content_hash() == again->hulls[i].content_hash());
    const HullView hull = view_hull(made->hulls[i]);
    check(hull.vertices.size() <= std::size_t(def.max_hull_vertices));
    for (const Vec3& v : hull.vertices) check(is_finite(v));
  }
  const DecompositionStats& r = made->stats;
  check(is_finite(r.overhang) && is_finite(r.depth) && is_finite(r.uncovered));
  check(std::isfinite(r.solid_volume) && std::isfinite(r.hull_volume) && std::isfinite(r.excess_volume));
  check(r.overhang >= 0.0f && r.depth >= 0.0f && r.hull_volume > 0.0);
  const std::uint64_t key = decomposition_key(def);
  std::vector<std::byte> bytes = save_decomposition(*made, key);
  const Result<Decomposition> loaded = load_decomposition(bytes, key);
  check(bool(loaded) && loaded->hulls.size() == made->hulls.size());
  check(!load_decomposition(bytes, key + 1));
  if (input.empty()) return;
  const std::vector<std::byte> damaged = fuzz::edited(bytes, input);
  if (damaged != bytes) check(!load_decomposition(damaged, key));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  try_mesh(input);
  return 0;
}
