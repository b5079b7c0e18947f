// The stage runner. The blocks of a stage are cut into one share per worker. A share is one atomic word: the stage it
// belongs to and the next claim of it; a worker that comes late to a stage sees by the stage number that the share is
// not for it any more. Whoever finishes the last block of a stage does the small stages that follow alone, deals the
// shares of the next large one, and lets the others go on. A barrier therefore waits for blocks, never for workers: one
// that was not woken yet, or has lost its core between blocks, holds up nobody.
#include "task/program.h"

#include "base/float_mode.h"
#include "task/spin.h"

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace gyre {

namespace {

int claim_count(const Stage& stage) {
  const int per_claim = stage.blocks_per_claim < 1 ? 1 : stage.blocks_per_claim;
  return stage.block_count / per_claim + (stage.block_count % per_claim != 0 ? 1 : 0);
}

bool is_small(const Stage& stage) { return claim_count(stage) <= 1; }

void run_alone(const Stage& stage, int worker) {
  if (stage.block_count > 0) stage.kernel(stage.context, 0, stage.block_count, worker);
}

void run_claims_of(const Stage& stage, int first, int count, int worker) {
  const int per_claim = stage.blocks_per_claim < 1 ? 1 : stage.blocks_per_claim;
  const int begin = first * per_claim;
  const int left = stage.block_count - begin;
  stage.kernel(stage.context, begin, begin + (left < count * per_claim ? left : count * per_claim), worker);
}

// How many claims are taken at once of so many. Small blocks are alike: half of them, so that a share is taken in few goes and
// there is still something left for others if its worker is held up.
std::uint64_t claims_at_once(const Stage& stage, std::uint64_t left) {
  return stage.blocks_per_claim > 1 && left > 1 ? left / 2 : 1;
}

class Runner {
 public:
  // The first and the last stage are not small.
  Runner(std::span<const Stage> stages, const TaskSystem& tasks)
      : stages_(stages), worker_count_(tasks.worker_count()), patience_(tasks.spin_patience()) {
    deal(0);
    current_.store(0, std::memory_order_relaxed);
  }

  void work(int worker) {
    std::uint32_t index = current_.load(std::memory_order_acquire);
    while (index < stages_.size()) {
      const int done = run_claims(index, worker);
      const bool last = done > 0 && left_.fetch_sub(done, std::memory_order_acq_rel) == done;
      index = last ? advance(index, worker) : wait_after(index);
    }
  }

 private:
  // A share on a cache line of its own: stage number in the high half, next claim in the low one.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> next;
  };

  static constexpr std::uint64_t pack(std::uint32_t stage, int claim) {
    return std::uint64_t{stage} << 32 | static_cast<std::uint32_t>(claim);
  }

  int share_begin(int claims, int worker) const {
    return static_cast<int>(std::int64_t{claims} * worker / worker_count_);
  }

  // Makes a stage ready for claims. Workers still looking through the shares of the one before see a number that is not
  // theirs, and take none until current_ says so.
  void deal(std::uint32_t index) {
    const int claims = claim_count(stages_[index]);
    left_.store(claims, std::memory_order_relaxed);
    for (int w = 0; w < worker_count_; ++w) {
      shares_[w].next.store(pack(index, share_begin(claims, w)), std::memory_order_relaxed);
    }
  }

  // Takes claims until there are none, from the own share on; the number taken.
  int run_claims(std::uint32_t index, int worker) {
    const Stage& stage = stages_[index];
    const int claims = claim_count(stage);
    int done = 0;
    for (int i = 0; i < worker_count_; ++i) {
      const int owner = worker + i < worker_count_ ? worker + i : worker + i - worker_count_;
      std::atomic<std::uint64_t>& next = shares_[owner].next;
      const std::uint64_t end = pack(index, share_begin(claims, owner + 1));
      std::uint64_t now = next.load(std::memory_order_relaxed);
      while (now >> 32 == index && now < end) {
        const std::uint64_t taken = claims_at_once(stage, end - now);
        if (!next.compare_exchange_weak(now, now + taken, std::memory_order_relaxed)) continue;
        run_claims_of(stage, static_cast<int>(now & 0xffffffff), static_cast<int>(taken), worker);
        done += static_cast<int>(taken);
        now = next.load(std::memory_order_relaxed);
      }
    }
    return done;
  }

  // After the last block of a stage: on to the next that is worth sharing.
  std::uint32_t advance(std::uint32_t index, int worker) {
    ++index;
    while (index < stages_.size() && is_small(stages_[index])) run_alone(stages_[index++], worker);
    if (index < stages_.size()) deal(index);
    current_.store(index, std::memory_order_release);
    return index;
  }

  std::uint32_t wait_after(std::uint32_t index) const {
    Spin spin(patience_);
    for (;;) {
      const std::uint32_t now = current_.load(std::memory_order_acquire);
      if (now != index) return now;
      spin.pause();
    }
  }

  std::span<const Stage> stages_;
  int worker_count_;
  int patience_;
  alignas(64) std::atomic<std::uint32_t> current_{0};  // the stage that is being done
  alignas(64) std::atomic<int> left_{0};               // its claims that are not done
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
