// See decomposition_folder.h.
#include "scene/decomposition_folder.h"

#include "scene/mesh_file.h"
#include "scene/scene_reader.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace gyre {

std::string default_decomposition_folder() {
  if (const char* const own = std::getenv("GYRE_CACHE")) return own;
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/gyre";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && home[0] != '\0') return std::string(home) + "/.cache/gyre";
  return {};
}

std::string DecompositionFolder::path_of(std::uint64_t key) const {
  char name[32];
  std::snprintf(name, sizeof name, "%016llx.hulls", static_cast<unsigned long long>(key));
  return folder_ + "/" + name;
}

bool DecompositionFolder::load(std::uint64_t key, std::vector<std::byte>& bytes) {
  if (folder_.empty()) return false;
  std::string text;
  SceneLimits limits;
  if (!read_whole_file(path_of(key), limits, text).empty()) return false;
  bytes.resize(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return true;
}

void DecompositionFolder::save(std::uint64_t key, std::span<const std::byte> bytes) {
  if (folder_.empty()) return;
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(folder_, error);
  // Names that no other thread or process gives at the same time.
  static std::atomic<unsigned> count{0};
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  const std::string whole = path_of(key);
  const std::string part =
      whole + "." + std::to_string(now) + "." + std::to_string(count.fetch_add(1)) + ".part";
  std::FILE* const file = std::fopen(part.c_str(), "wbx");
  if (file == nullptr) {
    failed_ = true;
    return;
  }
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const bool closed = std::fclose(file) == 0;
  if (written && closed) fs::rename(part, whole, error);
  if (!written || !closed || error) {
    failed_ = true;
    fs::remove(part, error);
  }
}

SceneResult<Scene> load_split_scene(const std::string& path, SplitOptions options,
                                    const std::string& folder) {
  SceneResult<Scene> scene = load_scene(path);
  if (!scene) return scene;
  DecompositionFolder store(folder);
  options.store = &store;
  if (std::optional<SceneError> error = split_decompositions(*scene, path, options)) return *std::move(error);
  return scene;
}

}  // namespace gyre
