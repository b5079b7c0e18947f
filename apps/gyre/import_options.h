// Options of every command that opens a scene: how files of other programs (URDF, MJCF, glTF) become one.
#pragma once

#include "formats/import.h"

namespace CLI {
class App;
}

namespace gyre {

void add_import_options(CLI::App& command, ImportOptions& options);

}  // namespace gyre
