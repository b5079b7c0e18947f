// The reader of glTF files in the browser, a module of its own: glTF bytes to the text of a scene file.
#include "formats/import.h"
#include "scene/scene_writer.h"
#include "web/bindings/stream.h"

#include <emscripten.h>

#include <string>
#include <utility>
#include <vector>

using namespace gyre;
using namespace gyre::web;

extern "C" {

// Arguments: the bytes of the file, its name, the options strict and decompose, and the files that it may name: how many, then name and
// bytes of each. The answer: the text of a scene with its meshes in it, and notes of what is not simulated.
EMSCRIPTEN_KEEPALIVE int gyre_import_gltf() {
  Call call(nullptr);
  Answer answer(nullptr, 0);
  std::string_view bytes, file;
  get(call, bytes);
  get(call, file);
  ImportOptions options;
  options.open_files = false;
  get(call, options.strict);
  get(call, options.decompose);
  for (double files = call.next(); files > 0.0; --files) {
    std::string_view name, content;
    get(call, name);
    get(call, content);
    options.files.emplace(std::string(name), std::string(content));
  }
  const SceneResult<Scene> scene = import_scene(bytes, FileFormat::gltf, std::string(file), options);
  if (!scene) return answer.checked(make_error(ErrorCode::invalid_data, "%s", scene.error().text().c_str()));
  const std::string text = write_scene(*scene, {.inline_meshes = true});
  const std::byte* const begin = reinterpret_cast<const std::byte*>(text.data());
  answer.bytes(std::vector<std::byte>(begin, begin + text.size()));
  static std::vector<std::string> notes;  // as long as JavaScript reads them
  notes = scene->notes;
  put_list(answer, std::span<const std::string>(notes),
           [&](const std::string& note) { put_text(answer, std::string_view(note)); });
  return answer.done();
}

}  // extern "C"
