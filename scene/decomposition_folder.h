// A folder that keeps convex decompositions from one run to the next: one file each, named by its key, which covers the mesh, the
// settings and the version of the method, so that nothing in it can be out of date. The folder may be deleted at any time.
#pragma once

#include "scene/decomposition_split.h"
#include "scene/scene_limits.h"

#include <string>

namespace gyre {

// $GYRE_CACHE; else $XDG_CACHE_HOME/gyre; else $HOME/.cache/gyre. Empty (nothing is kept) if there is none of them, or if
// GYRE_CACHE is set to nothing.
std::string default_decomposition_folder();

class DecompositionFolder : public DecompositionStore {
 public:
  // Made when something is saved. Empty: nothing is kept.
  explicit DecompositionFolder(std::string folder) : folder_(std::move(folder)) {}

  bool load(std::uint64_t key, std::vector<std::byte>& bytes) override;
  // A file appears whole or not at all, whoever else writes it. What cannot be written is not kept: see failed().
  void save(std::uint64_t key, std::span<const std::byte> bytes) override;
  bool failed() const { return failed_; }
  std::string path_of(std::uint64_t key) const;

 private:
  std::string folder_;
  bool failed_ = false;
};

// load_scene() and split_decompositions() with the folder.
SceneResult<Scene> load_split_scene(const std::string& path, SplitOptions options = {},
                                    const std::string& folder = default_decomposition_folder());

}  // namespace gyre
