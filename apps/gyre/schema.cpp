// gyre schema: prints the JSON Schema of a scene.
#include "commands.h"
#include "scene/scene_schema.h"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace gyre {

void add_schema(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of a scene");
  command->callback([] {
    const std::string text = scene_schema();
    std::fwrite(text.data(), 1, text.size(), stdout);
  });
}

}  // namespace gyre
