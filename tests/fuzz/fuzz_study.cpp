// Studies of `gyre sweep` against any bytes: what is read has cases, and each of them gives one line of JSON. No file is opened.
#include "sweep/study.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

constexpr const char* kScene =
    R"({"gyre_scene": 1, "world": {"time_step": 0.01}, "materials": {"wood": {"static_friction": 0.5}},
  "bodies": [{"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
    {"name": "crate", "position": [0, 1, 0], "mass": 2, "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5], "material": "wood"}]}],
  "joints": [{"name": "pivot", "type": "hinge", "body_b": "crate", "position": [0, 2, 0], "axis": [0, 0, 1]}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const gyre::SceneResult<gyre::Study> read =
      gyre::read_study(text, "study.json", [](const std::string&) { return std::string(kScene); });
  if (!read) {
    if (read.error().text().find('\n') != std::string::npos) std::abort();
    return 0;
  }
  gyre::Study study = *read;
  study.scene_folder = "/nonexistent";
  study.duration.reset();
  study.steps = 3;
  const std::uint64_t count = study.case_count();
  if (count == 0 || count > 10'000'000) std::abort();
  for (const std::uint64_t number : {std::uint64_t(0), count - 1}) {
    const std::string line = gyre::run_case(study, number);
    const gyre::Json json = gyre::Json::parse(line, nullptr, false);
    if (!json.is_object() || json.contains("error") == json.contains("readings")) std::abort();
  }
  return 0;
}
