// The commands of the program, one file each. Every function adds one to the command line; when it is chosen it runs at
// the end of parsing and leaves its exit status in `exit_code`.
#pragma once

namespace CLI {
class App;
}

namespace gyre {

void add_simulate(CLI::App& app, int& exit_code);
void add_decompose(CLI::App& app, int& exit_code);
void add_convert(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_validate(CLI::App& app, int& exit_code);
void add_sweep(CLI::App& app, int& exit_code);
void add_schema(CLI::App& app, int& exit_code);

}  // namespace gyre
