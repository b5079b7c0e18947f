// Bytes between ranks. See transport.h. Counts first, then a message to each rank that gets anything.
#include "mpi/transport.h"

#include <mpi.h>

#include <utility>

namespace gyre {

namespace {
constexpr int kPacketTag = 7;
}

Transport::Transport() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  in_.resize(std::size_t(size_));
  counts_out_.resize(std::size_t(size_));
  counts_in_.resize(std::size_t(size_));
}

std::vector<Packet>& Transport::exchange(std::vector<Packet>& out) {
  for (std::size_t r = 0; r < out.size(); ++r) counts_out_[r] = int(out[r].bytes().size());
  MPI_Alltoall(counts_out_.data(), 1, MPI_INT, counts_in_.data(), 1, MPI_INT, MPI_COMM_WORLD);
  std::vector<MPI_Request> requests;
  for (std::size_t r = 0; r < out.size(); ++r) {
    in_[r].clear();
    if (int(r) == rank_) {
      std::swap(in_[r].bytes(), out[r].bytes());
      continue;
    }
    in_[r].bytes().resize(std::size_t(counts_in_[r]));
    if (counts_in_[r] == 0) continue;
    MPI_Irecv(in_[r].bytes().data(), counts_in_[r], MPI_BYTE, int(r), kPacketTag, MPI_COMM_WORLD,
              &requests.emplace_back());
  }
  for (std::size_t r = 0; r < out.size(); ++r) {
    if (int(r) == rank_ || counts_out_[r] == 0) continue;
    MPI_Isend(out[r].bytes().data(), counts_out_[r], MPI_BYTE, int(r), kPacketTag, MPI_COMM_WORLD,
              &requests.emplace_back());
    bytes_sent_ += std::uint64_t(counts_out_[r]);
    ++messages_sent_;
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (Packet& packet : out) packet.clear();
  return in_;
}

double Transport::sum(double value) const {
  double out = 0;
  MPI_Allreduce(&value, &out, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return out;
}
double Transport::max(double value) const {
  double out = 0;
  MPI_Allreduce(&value, &out, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return out;
}

}  // namespace gyre
