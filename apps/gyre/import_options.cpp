// Options for files of other programs. See import_options.h.
#include "import_options.h"

#include "option_checks.h"

#include <CLI/CLI.hpp>

namespace gyre {

void add_import_options(CLI::App& command, ImportOptions& options) {
  const std::string group = "URDF, MJCF and glTF";
  take_one_of(command
                  .add_option_function<std::string>(
                      "--base", [&options](const std::string& word) { options.free_base = word == "free"; },
                      "URDF: whether the root link is fixed to the world (the default) or free")
                  ->type_name("fixed|free")
                  ->group(group),
              {"fixed", "free"});
  command
      .add_option("--package", options.packages,
                  "A further folder that meshes may be read from; with NAME= the folder of package://NAME. "
                  "May be given several times")
      ->type_name("[NAME=]FOLDER")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_flag("--keep-fixed", options.keep_fixed,
                "Keep fixed joints instead of making one body of the two links")
      ->group(group);
  command
      .add_flag("--self-collision", options.self_collision,
                "URDF: links collide with each other, neighbours excepted")
      ->group(group);
  command
      .add_flag("--decompose", options.decompose,
                "Moving concave meshes become several convex hulls instead of one")
      ->group(group);
  command.add_flag("--strict", options.strict, "Refuse a file with anything that would not be simulated")
      ->group(group);
}

}  // namespace gyre
