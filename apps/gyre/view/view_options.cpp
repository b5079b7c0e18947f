// gyre view: its options. See view.h.
#include "view/view.h"

#include "commands.h"
#include "import_options.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace gyre {

void add_view(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "view", "Show a scene or a recording in the browser, from a server on this machine only");
  const auto options = std::make_shared<ViewOptions>();
  command
      ->add_option(
          "FILE", options->file,
          "The scene (*.gyre.json), robot, glTF file or recording (*.gyrec), - for standard input; without it, the scenes that come with the viewer")
      ->type_name("");
  command
      ->add_option("--port", options->port,
                   "Port; 0 for any that is free. Without it 8642, or any if that is taken")
      ->type_name("N")
      ->check([](const std::string& text) {
        int port = -1;
        const bool good = CLI::detail::lexical_cast(text, port) && port >= 0 && port <= 65535;
        return good ? std::string() : "found " + text + ", expected an integer from 0 to 65535";
      });
  add_import_options(*command, options->import);
  command->add_flag("--no-open", options->no_open, "Print the address and open nothing");
  command
      ->add_option("--viewer", options->viewer, "Folder of the built viewer (also the variable GYRE_VIEWER)")
      ->type_name("FOLDER");
  command->callback([options, &exit_code] { exit_code = view(*options); });
}

}  // namespace gyre
