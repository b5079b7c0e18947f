// The stage runner. The blocks of a stage are cut into one share per worker. A share is one atomic word: the stage it
// belongs to and the next block of it; what is left of an earlier stage is a share that nobody has begun, and a worker that comes
// late to a stage sees by the number that the share is not for it any more. Whoever finishes the last block of a stage does the
// small stages that follow alone and lets the others go on. A barrier therefore waits for blocks, never for workers: one
// that was not woken yet, or has lost its core between blocks, holds up nobody.
//
// A line that another core wrote takes longer to come than a small block takes to do. So a stage's end is one word, which who comes last
// changes and who waits sees, and a share's own worker finds it in its own cache.
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

// How many blocks are taken at once of so many. Small ones are alike: half of them, so that a share is taken in few goes and
// there is still something left for others if its worker is held up.
std::uint64_t blocks_at_once(const Stage& stage, std::uint64_t left) {
  const std::uint64_t claim = static_cast<std::uint64_t>(claim_of(stage));
  if (claim == 1) return 1;
  const std::uint64_t half = left / (2 * claim) * claim;
  return half > 0 ? half : left < claim ? left : claim;
}

class Runner {
 public:
  // The first and the last stage are not small.
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
  // On a cache line of its own: stage number in the high half, next block in the low one.
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

  // Takes blocks of a share until there are none; the number taken.
  int run_share(std::uint32_t index, int owner, int worker) {
    const Stage& stage = stages_[index];
    const std::uint64_t first = pack(index, begin_of(stage, owner)),
                        end = pack(index, begin_of(stage, owner + 1));
    std::atomic<std::uint64_t>& next = shares_[owner].next;
    std::uint64_t now = next.load(std::memory_order_relaxed);
    int done = 0;
    for (;;) {
      const std::uint64_t from = now < first ? first : now;  // nobody has begun it
      if (from >= end) return done;
      const std::uint64_t claimed = blocks_at_once(stage, end - from);
      if (!next.compare_exchange_weak(now, from + claimed, std::memory_order_relaxed)) continue;
      const int block = static_cast<int>(from & 0xffffffff);
      stage.kernel(stage.context, block, block + static_cast<int>(claimed), worker);
      done += static_cast<int>(claimed);
      now = next.load(std::memory_order_relaxed);
    }
  }
  // So many blocks are done. Whether they were the last: then the small stages that follow are, too, and the next large one has begun.
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
  // The stage that is being done, and its blocks that are not done.
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

}  // namespace gyre
