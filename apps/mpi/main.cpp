// gyre-mpi: studies, and one world, over the ranks of MPI. Results go to stdout of rank 0; the exit status is that of gyre.
#include "exit_code.h"
#include "mpi/mpi_cases.h"
#include "mpi/mpi_simulate.h"

#include <mpi.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

namespace {

int run_sweep(const gyre::SweepOptions& options, int rank) {
  if (rank > 0) {
    gyre::serve_cases(options);
    return gyre::kExitGood;
  }
  gyre::RankedCases runner;
  const int code = gyre::sweep(options, runner);
  if (!runner.has_run()) gyre::release_ranks();
  return code;
}

int run(int argc, char** argv, int rank) {
  CLI::App app("Gyre over many machines, by MPI: mpirun -n 8 gyre-mpi ...", "gyre-mpi");
  app.set_version_flag("--version", "gyre-mpi " GYRE_VERSION_STRING, "Print the version and exit");
  app.require_subcommand(1);
  int code = gyre::kExitGood;
  gyre::SweepOptions sweep;
  CLI::App* const sweep_command =
      app.add_subcommand("sweep", "Run the cases of a study, a case a rank at a time");
  gyre::add_sweep_options(*sweep_command, sweep);
  gyre::RankedOptions simulate;
  CLI::App* const simulate_command =
      app.add_subcommand("simulate", "Run one scene, its space divided among the ranks");
  gyre::add_ranked_options(*simulate_command, simulate);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return rank == 0 ? app.exit(request) : 0;
  } catch (const CLI::ParseError& error) {
    if (rank == 0) std::fprintf(stderr, "gyre-mpi: %s (--help shows what there is)\n", error.what());
    return gyre::kExitUsage;
  }
  if (sweep_command->parsed()) code = run_sweep(sweep, rank);
  if (simulate_command->parsed()) code = gyre::simulate_ranked(simulate);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  int code = gyre::kExitInvalid;
  try {
    code = run(argc, argv, rank);
  } catch (const std::exception& error) {
    // Other ranks wait for this one, so all of them end.
    std::fprintf(stderr, "gyre-mpi: rank %d: %s\n", rank, error.what());
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  std::fflush(stdout);
  MPI_Finalize();
  return code;
}
