// The engine's own pool: threads that wait for a job and spin a little before they sleep, since the next stage of a
// step comes soon. One atomic word, the gate, holds the number of the job, whether it still admits workers, and how
// many are in it, so that a worker can never enter a job that its owner has left.
#include "task/task_system.h"

#include "base/float_mode.h"
#include "task/spin.h"

#include <atomic>
#include <cstdint>

#if GYRE_HAS_THREADS
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace gyre {

using WorkerFn = FunctionRef<void(int worker)>;

namespace {

// About 20 to 100 microseconds, as long as waking a thread takes; and almost nothing.
constexpr int kPatient = 2000;
constexpr int kImpatient = 20;

#if GYRE_HAS_THREADS
int machine_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  return cores == 0 ? 1 : static_cast<int>(cores);
}
#else
int machine_cores() { return 1; }
#endif

int clamp_workers(int count) {
  if (!GYRE_HAS_THREADS || count < 1) return 1;
  return count < TaskSystem::kMaxWorkers ? count : TaskSystem::kMaxWorkers;
}

int patience_of(int worker_count) { return worker_count <= machine_cores() ? kPatient : kImpatient; }

}  // namespace

#if GYRE_HAS_THREADS

namespace {

// A yielded core comes back at once, or later than this.
constexpr std::chrono::microseconds kCoreTaken{20};

// The gate: job number, open flag, workers inside.
constexpr std::uint64_t kJob = std::uint64_t{1} << 32;
constexpr std::uint64_t kOpen = std::uint64_t{1} << 31;
constexpr std::uint64_t kInside = kOpen - 1;

constexpr std::uint64_t job_of(std::uint64_t gate) { return gate / kJob; }

}  // namespace

struct TaskSystem::Pool {
  explicit Pool(int worker_count) : patience(patience_of(worker_count)), helpers(worker_count - 1) {
    threads.reserve(static_cast<std::size_t>(helpers));
    for (int worker = 1; worker <= helpers; ++worker) {
      threads.emplace_back([this, worker] { serve(worker); });
    }
  }

  ~Pool() {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      stopping.store(true, std::memory_order_relaxed);
      gate.fetch_add(kJob, std::memory_order_release);
    }
    wake.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  // The owner: opens a job, takes part, closes it and waits for the workers inside.
  void run(const WorkerFn& fn, bool all) {
    job = fn;
    all_needed = all;
    if (all) finished.store(0, std::memory_order_relaxed);
    bool somebody_sleeps = false;
    {
      // Under the lock, so that no worker falls asleep between its check of the gate and its wait.
      const std::lock_guard<std::mutex> lock(mutex);
      const std::uint64_t number = job_of(gate.load(std::memory_order_relaxed)) + 1;
      gate.store(number * kJob | kOpen, std::memory_order_release);
      somebody_sleeps = sleepers > 0;
    }
    if (somebody_sleeps) wake.notify_all();

    fn(0);

    Spin spin(patience);
    while (all && finished.load(std::memory_order_acquire) < helpers) spin.pause();
    gate.fetch_and(~kOpen, std::memory_order_acq_rel);
    while ((gate.load(std::memory_order_acquire) & kInside) != 0) spin.pause();
  }

  static void no_work(int) {}

  // The loop of a helper thread.
  void serve(int worker) {
    std::uint64_t seen = 0;
    for (;;) {
      seen = wait_for_job(seen);
      if (stopping.load(std::memory_order_relaxed)) return;
      if (!enter(seen)) continue;
      {
        const FloatMode mode;
        job(worker);
      }
      if (all_needed) finished.fetch_add(1, std::memory_order_release);
      gate.fetch_sub(1, std::memory_order_release);
    }
  }

  std::uint64_t wait_for_job(std::uint64_t seen) {
    Spin spin(patience);
    do {
      const std::uint64_t number = job_of(gate.load(std::memory_order_acquire));
      if (number != seen) return number;
      if (spin.patient()) spin.pause();
    } while (spin.patient() || should_stay_awake());
    std::unique_lock<std::mutex> lock(mutex);
    ++sleepers;
    std::uint64_t number = job_of(gate.load(std::memory_order_acquire));
    while (number == seen) {
      wake.wait(lock);
      number = job_of(gate.load(std::memory_order_acquire));
    }
    --sleepers;
    return number;
  }

  // True if a worker without patience stays awake: within a step, while no other thread takes the yielded core.
  bool should_stay_awake() const {
    if (!stay_awake.load(std::memory_order_relaxed)) return false;
    const auto offered = std::chrono::steady_clock::now();
    std::this_thread::yield();
    return std::chrono::steady_clock::now() - offered < kCoreTaken;
  }

  // Enters the job, unless it has been closed meanwhile.
  bool enter(std::uint64_t number) {
    std::uint64_t now = gate.load(std::memory_order_relaxed);
    while (job_of(now) == number && (now & kOpen) != 0) {
      if (gate.compare_exchange_weak(now, now + 1, std::memory_order_acquire, std::memory_order_relaxed))
        return true;
    }
    return false;
  }

  // In one cache line, since a line written by another core takes longer to arrive than much of the work takes.
  alignas(64) std::atomic<std::uint64_t> gate{0};
  WorkerFn job = no_work;                    // written before the gate opens, read inside
  bool all_needed = false;                   // of the job
  alignas(64) std::atomic<int> finished{0};  // helpers that have finished a job with all_needed
  alignas(64) std::atomic<bool> stay_awake{false};
  std::atomic<bool> stopping{false};
  const int patience;
  const int helpers;
  std::mutex mutex;
  std::condition_variable wake;
  int sleepers = 0;  // under the mutex
  std::vector<std::thread> threads;
};

#else

struct TaskSystem::Pool {
  explicit Pool(int) {}
  void run(const WorkerFn& fn, bool) { fn(0); }
};

#endif

TaskSystem::TaskSystem(int threads)
    : worker_count_(clamp_workers(threads == 0 ? machine_cores() : threads)),
      spin_patience_(patience_of(worker_count_)) {
  if (worker_count_ > 1) pool_ = std::make_unique<Pool>(worker_count_);
}

TaskSystem::TaskSystem(const HostTasks& host) : host_(host) {
  if (host_.run != nullptr) worker_count_ = clamp_workers(host_.worker_count);
  spin_patience_ = patience_of(worker_count_);
}

TaskSystem::~TaskSystem() = default;

void TaskSystem::stay_awake(bool yes) {
#if GYRE_HAS_THREADS
  if (pool_ != nullptr && spin_patience_ == kPatient) pool_->stay_awake.store(yes, std::memory_order_relaxed);
#else
  (void)yes;
#endif
}

void TaskSystem::run_workers(WorkerFn fn) { run(fn, true); }

void TaskSystem::run_claiming(WorkerFn fn) { run(fn, false); }

void TaskSystem::run(WorkerFn fn, bool all) {
  GYRE_ASSERT(!running_, "work does not start work, and one thread at a time uses a task system");
  running_ = true;
  {
    const FloatMode mode;
    if (pool_ != nullptr) {
      pool_->run(fn, all);
    } else if (worker_count_ > 1) {
      run_on_host(fn);
    } else {
      fn(0);
    }
  }
  running_ = false;
}

void TaskSystem::run_on_host(WorkerFn fn) {
  host_.run(
      host_.user, worker_count_,
      [](void* context, int index) {
        const FloatMode mode;
        (*static_cast<const WorkerFn*>(context))(index);
      },
      &fn);
}

std::byte* TaskSystem::scratch(std::size_t bytes) {
  GYRE_ASSERT(!running_, "scratch belongs to the thread that starts work, outside of it");
  if (scratch_.size() < bytes) scratch_.resize_uninitialized(bytes);
  return scratch_.data();
}

}  // namespace gyre
