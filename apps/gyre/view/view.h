// gyre view: its options, and one session of serving the viewer.
#pragma once

#include "formats/import.h"
#include <optional>
#include <string>

namespace gyre {

struct ViewOptions {
  std::string file;         // a scene or a recording; empty: the viewer's own list of scenes
  ImportOptions import;     // of a file of another program
  std::string viewer;       // folder of the built viewer; empty: where it is found
  std::optional<int> port;  // none: the usual one, or a free one if that is taken
  bool no_open = false;
};

// Serves until Ctrl-C; the exit status.
int view(const ViewOptions& options);

}  // namespace gyre
