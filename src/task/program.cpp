// The stage runner. The blocks of a stage are divided into one share per worker. A share is one atomic word: the number
// of its stage and its next block. A share of an earlier stage counts as not begun, and a worker that comes late to a
// stage sees by the number that the share belongs to a later one. The worker that finishes the last block of a stage
// also runs the small stages that follow and then releases the others. So a barrier waits for blocks, never for
// workers: a worker that has not woken yet, or has lost its core between blocks, delays nobody.
//
// A cache line written by another core takes longer to arrive than a small block takes to run. So the end of a stage is
// one word, which the last worker changes and waiting workers read, and each worker finds its own share in its own
// cache.
#include "task/program.h"

#include "base/float_mode.h"
#include "task/spin.h"

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace gyre {

namespace {

int claim_of(const Stage& stage) { return stage.blocks_per_claim < 1 ? 1 : stage.blocks_per_claim; }

bool is_small(const Stage& stage) { return stage.block_count <= claim_of(stage); }

void run_alone(const Stage& stage, int worker) {
  if (stage.block_count > 0) stage.kernel(stage.context, 0, stage.block_count, worker);
}

// The number of blocks to claim at once. Small blocks are alike: half of them, so that a share needs few claims and
// others can still help if its worker is delayed.
std::uint64_t blocks_at_once(const Stage& stage, std::uint64_t left) {
  const std::uint64_t claim = static_cast<std::uint64_t>(claim_of(stage));
  if (claim == 1) return 1;
  const std::uint64_t half = left / (2 * claim) * claim;
  return half > 0 ? half : left < claim ? left : claim;
}

class Runner {
 public:
  // The first and the last stage must not be small.
  Runner(std::span<const Stage> stages, const TaskSystem& tasks)
      : stages_(stages), worker_count_(tasks.worker_count()), patience_(tasks.spin_patience()) {
    for (int w = 0; w < worker_count_; ++w)
      shares_[w].next.store(pack(0, begin_of(stages_[0], w)), std::memory_order_relaxed);
    begin(0);
  }

  void work(int worker) {
    std::uint32_t index = stage_of(state_.load(std::memory_order_acquire));
    while (index < stages_.size()) {
      int done = 0;
      for (int i = 0; i < worker_count_; ++i)
        done += run_share(index, share_to_visit(worker, i, worker_count_), worker);
      if (!finish(index, done, worker)) wait_after(index);
      index = stage_of(state_.load(std::memory_order_acquire));
    }
  }

 private:
  // In a cache line of its own: the stage number in the high half, the next block in the low half.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> next;
  };

  static constexpr std::uint64_t pack(std::uint32_t stage, int blocks) {
    return std::uint64_t{stage} << 32 | static_cast<std::uint32_t>(blocks);
  }
  static constexpr std::uint32_t stage_of(std::uint64_t word) {
    return static_cast<std::uint32_t>(word >> 32);
  }

  int begin_of(const Stage& stage, int worker) const {
    if (stage.bounds != nullptr) return stage.bounds[worker];
    return share_begin(stage.block_count, worker, worker_count_);
  }

  void begin(std::uint32_t index) {
    const int blocks = index < stages_.size() ? stages_[index].block_count : 0;
    state_.store(pack(index, blocks), std::memory_order_release);
  }

  // Runs blocks of a share until none is left; returns their number.
  int run_share(std::uint32_t index, int owner, int worker) {
    const Stage& stage = stages_[index];
    const std::uint64_t first = pack(index, begin_of(stage, owner)),
                        end = pack(index, begin_of(stage, owner + 1));
    std::atomic<std::uint64_t>& next = shares_[owner].next;
    std::uint64_t now = next.load(std::memory_order_relaxed);
    int done = 0;
    for (;;) {
      const std::uint64_t from = now < first ? first : now;  // not begun
      if (from >= end) return done;
      const std::uint64_t claimed = blocks_at_once(stage, end - from);
      if (!next.compare_exchange_weak(now, from + claimed, std::memory_order_relaxed)) continue;
      const int block = static_cast<int>(from & 0xffffffff);
      stage.kernel(stage.context, block, block + static_cast<int>(claimed), worker);
      done += static_cast<int>(claimed);
      now = next.load(std::memory_order_relaxed);
    }
  }
  // Records finished blocks. True if they were the last of the stage; the small stages that follow are then done too,
  // and the next large one has begun.
  bool finish(std::uint32_t index, int done, int worker) {
    if (done == 0) return false;
    const std::uint64_t before =
        state_.fetch_sub(static_cast<std::uint64_t>(done), std::memory_order_acq_rel);
    if (before != pack(index, done)) return false;
    ++index;
    while (index < stages_.size() && is_small(stages_[index])) run_alone(stages_[index++], worker);
    begin(index);
    return true;
  }

  bool is_over(std::uint32_t index) const {
    return stage_of(state_.load(std::memory_order_acquire)) != index;
  }
  void wait_after(std::uint32_t index) const {
    for (Spin spin(patience_); !is_over(index);) spin.pause();
  }

  std::span<const Stage> stages_;
  int worker_count_;
  int patience_;
  // The current stage and the number of its unfinished blocks.
  alignas(64) std::atomic<std::uint64_t> state_{0};
  Share shares_[TaskSystem::kMaxWorkers];
};

}  // namespace

void run_program(TaskSystem& tasks, std::span<const Stage> stages) {
  const FloatMode mode;
  std::size_t first = 0;
  std::size_t last = stages.size();
  if (tasks.worker_count() == 1) {
    first = last;
  } else {
    while (first < last && is_small(stages[first])) ++first;
    while (first < last && is_small(stages[last - 1])) --last;
  }
  for (std::size_t i = 0; i < first; ++i) run_alone(stages[i], 0);
  if (first < last) {
    Runner runner(stages.subspan(first, last - first), tasks);
    tasks.run_claiming([&](int worker) { runner.work(worker); });
  }
  for (std::size_t i = last; i < stages.size(); ++i) run_alone(stages[i], 0);
}

void run_program_in_parts(TaskSystem& tasks, std::span<const Stage> stages) {
  const FloatMode mode;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    if (!stages[i].starts_work) continue;
    run_program(tasks, stages.subspan(begin, i - begin));
    run_alone(stages[i], 0);
    begin = i + 1;
  }
  run_program(tasks, stages.subspan(begin));
}

}  // namespace gyre
