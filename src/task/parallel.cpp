// Each worker has the same share of the blocks in every loop: it finds the data of its last loop over bodies or
// contacts in its own cache, and its counter of blocks seldom leaves its core. A worker that is done takes blocks from
// the shares of others. See parallel.h.
#include "task/parallel.h"

#include <atomic>

namespace gyre {

void run_blocks(TaskSystem& tasks, int blocks, FunctionRef<void(int block, int worker)> run_block) {
  // Unsigned, since each worker overshoots the end once.
  struct alignas(64) Share {
    std::atomic<std::uint32_t> next;
    std::uint32_t end;
  };
  const int workers = tasks.worker_count();
  Share shares[TaskSystem::kMaxWorkers];
  for (int worker = 0; worker < workers; ++worker) {
    const auto begin = static_cast<std::uint32_t>(share_begin(blocks, worker, workers));
    shares[worker].next.store(begin, std::memory_order_relaxed);
    shares[worker].end = static_cast<std::uint32_t>(share_begin(blocks, worker + 1, workers));
  }
  tasks.run_claiming([&](int worker) {
    for (int i = 0; i < workers; ++i) {
      Share& share = shares[share_to_visit(worker, i, workers)];
      // Read before it is written: shares of others are mostly done.
      while (share.next.load(std::memory_order_relaxed) < share.end) {
        const std::uint32_t block = share.next.fetch_add(1, std::memory_order_relaxed);
        if (block >= share.end) break;
        run_block(static_cast<int>(block), worker);
      }
    }
  });
}

}  // namespace gyre
