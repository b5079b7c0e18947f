// Cases over ranks. See mpi_cases.h.
//
// A rank sends its line (empty at first) and gets the next number or kNoCase. MPI is used by the main thread of a rank only; rank 0 runs its
// own cases in a second thread.
#include "mpi/mpi_cases.h"

#include <mpi.h>

#include <chrono>
#include <thread>

namespace gyre {
namespace {

constexpr int kLineTag = 1, kNumberTag = 2;
constexpr std::uint64_t kNoCase = ~std::uint64_t(0);

int rank_count() {
  int count = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

struct Message {
  int from = 0;
  std::uint64_t number = 0;
  std::string line;
};

// The next line of a rank; false if there is none yet.
bool receive_line(Message& out) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, kLineTag, MPI_COMM_WORLD, &there, &status);
  if (there == 0) return false;
  int bytes = 0;
  MPI_Get_count(&status, MPI_CHAR, &bytes);
  out.from = status.MPI_SOURCE;
  std::string text(std::size_t(bytes), '\0');
  MPI_Recv(text.data(), bytes, MPI_CHAR, out.from, kLineTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  const std::size_t space = text.find(' ');
  out.number = std::stoull(text.substr(0, space));
  out.line = text.substr(space + 1);
  return true;
}

void send_number(std::uint64_t number, int to) {
  MPI_Send(&number, 1, MPI_UINT64_T, to, kNumberTag, MPI_COMM_WORLD);
}

}  // namespace

void RankedCases::run(const Study& study, CaseQueue& queue) {
  has_run_ = true;
  std::thread own([&] {
    while (const std::optional<std::uint64_t> number = queue.next())
      queue.done(*number, run_case(study, *number));
  });
  for (int waiting = rank_count() - 1; waiting > 0;) {
    Message message;
    if (!receive_line(message)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    if (message.number != kNoCase) queue.done(message.number, message.line);
    const std::optional<std::uint64_t> number = queue.next();
    send_number(number.value_or(kNoCase), message.from);
    if (!number) --waiting;
  }
  own.join();
}

void serve_cases(const SweepOptions& options) {
  const SceneResult<Study> study = load_study(options.study);
  std::uint64_t number = kNoCase;
  std::string line;
  for (;;) {
    const std::string text = std::to_string(number) + " " + line;
    MPI_Send(text.data(), int(text.size()), MPI_CHAR, 0, kLineTag, MPI_COMM_WORLD);
    // A blocking receive of MPI takes a whole core while it waits.
    MPI_Request request;
    MPI_Irecv(&number, 1, MPI_UINT64_T, 0, kNumberTag, MPI_COMM_WORLD, &request);
    for (int done = 0; done == 0;) {
      MPI_Test(&request, &done, MPI_STATUS_IGNORE);
      if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (number == kNoCase) return;
    // Rank 0 has read the study; a rank that cannot is a machine without the file.
    line = study ? run_case(*study, number) : Json{{"case", number}, {"error", study.error().text()}}.dump();
  }
}

void release_ranks() {
  for (int waiting = rank_count() - 1; waiting > 0;) {
    Message message;
    if (!receive_line(message)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    send_number(kNoCase, message.from);
    --waiting;
  }
}

}  // namespace gyre
