// Loads files of every format in C: the readers of ../import.h make the text of a scene, which libgyre opens.
//
// In: a path and options. Out: a scene of libgyre. The two libraries share only the functions of C, so a scene is handed over as text.
#include "formats/import.h"
#include "scene/scene_writer.h"

#include <gyre/c/load.h>

#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string>

namespace gyre {
namespace {

// The last answers of a thread.
struct Answers {
  std::string text, notes, error;
};
Answers& answers() {
  static thread_local Answers own;
  return own;
}

// False, with the reason, if the options are of a newer header or were not filled.
bool take_options(const GyreLoadOptions* in, ImportOptions& out, std::string& error) {
  if (in == nullptr) return true;
  if (in->size < sizeof(std::uint32_t) || in->size > sizeof(GyreLoadOptions)) {
    error = "GyreLoadOptions: size is " + std::to_string(in->size) + ", expected 4 to " +
            std::to_string(sizeof(GyreLoadOptions)) + ": begin with gyre_load_options_default()";
    return false;
  }
  GyreLoadOptions given = gyre_load_options_default();
  std::memcpy(&given, in, in->size);
  if (given.package_count > 0 && given.packages == nullptr) {
    error = "GyreLoadOptions: packages is NULL, but package_count is not 0";
    return false;
  }
  out.strict = given.strict;
  out.free_base = given.free_base;
  out.keep_fixed = given.keep_fixed;
  out.self_collision = given.self_collision;
  out.decompose = given.decompose;
  for (std::size_t i = 0; i < given.package_count; ++i) {
    if (given.packages[i] != nullptr) out.packages.emplace_back(given.packages[i]);
  }
  return true;
}

// Fills text and notes, or the error.
bool load(const char* path, const GyreLoadOptions* options, Answers& out) {
  out.text.clear();
  out.notes.clear();
  ImportOptions import;
  if (!take_options(options, import, out.error)) return false;
  if (path == nullptr || *path == '\0') {
    out.error = "the path is NULL or empty";
    return false;
  }
  const SceneResult<Scene> scene = open_scene(path, import);
  if (!scene) {
    out.error = scene.error().text();
    return false;
  }
  for (const std::string& note : scene->notes) out.notes += note + "\n";
  out.text = write_scene(*scene, {.inline_meshes = true});
  return true;
}

// The same where memory may end.
bool try_load(const char* path, const GyreLoadOptions* options) {
  Answers& out = answers();
  try {
    return load(path, options, out);
  } catch (const std::exception& error) {
    out.error = error.what();
  }
  return false;
}

}  // namespace
}  // namespace gyre

extern "C" {

GyreLoadOptions gyre_load_options_default(void) noexcept {
  GyreLoadOptions out = {};
  out.size = sizeof out;
  return out;
}

GyreScene* gyre_load_scene(const char* path, const GyreLoadOptions* options, int32_t threads,
                           int32_t simd_width) noexcept {
  if (!gyre::try_load(path, options)) return nullptr;
  gyre::Answers& out = gyre::answers();
  GyreScene* const scene = gyre_scene_read(out.text.data(), out.text.size(), threads, simd_width);
  if (scene == nullptr) out.error = gyre_last_error();
  out.text = {};
  return scene;
}

const char* gyre_load_text(const char* path, const GyreLoadOptions* options, size_t* text_count) noexcept {
  const bool loaded = gyre::try_load(path, options);
  const std::string& text = gyre::answers().text;
  if (text_count != nullptr) *text_count = loaded ? text.size() : 0;
  return loaded ? text.c_str() : nullptr;
}

const char* gyre_load_notes(void) noexcept { return gyre::answers().notes.c_str(); }
const char* gyre_load_error(void) noexcept { return gyre::answers().error.c_str(); }

}  // extern "C"
