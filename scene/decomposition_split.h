// Concave meshes of a scene to convex hulls: each shape that is a convex decomposition becomes one shape for each of its hulls.
//
// In: a scene as it was read. Out: the same with hulls, or where and why a mesh could not be decomposed. Hulls are looked for in
// a store first and put there afterwards; what the store does with bytes is its own affair.
#pragma once

#include "scene/scene.h"
#include "scene/scene_error.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gyre {

// Bytes by key: a folder, a database, memory. What it gives back is checked; anything wrong is as good as nothing.
class DecompositionStore {
 public:
  virtual ~DecompositionStore() = default;
  virtual bool load(std::uint64_t key, std::vector<std::byte>& bytes) = 0;
  virtual void save(std::uint64_t key, std::span<const std::byte> bytes) = 0;
};

struct SplitOptions {
  DecompositionStore* store = nullptr;
  int threads = 1;
  // As in DecompositionDef; for each mesh anew.
  bool (*progress)(void* user, float done) = nullptr;
  void* user = nullptr;
};

// Decomposes, or takes from the store. `cached` says which.
Result<Decomposition> decompose_stored(DecompositionDef def, const SplitOptions& options,
                                       bool* cached = nullptr);

// Shapes that are split already stay as they are. Meshes that are no closed solids leave a note in the scene.
std::optional<SceneError> split_decompositions(Scene& scene, const std::string& file,
                                               const SplitOptions& options = {});

// What there is to say of a mesh that is not a closed solid, or of hulls that are not as close as was asked for; empty if nothing.
std::string describe_findings(const DecompositionStats& report);

}  // namespace gyre
