// TaskSystem: the workers of a world. They are an own pool of threads, which sleep between steps, or the host
// application's pool through its HostTasks; with one worker everything is a plain call. With an own pool the calling
// thread is worker 0. The assignment of work never shows in a result: see parallel.h and program.h.
//
// Each worker computes in FloatMode. On a platform without threads there is one worker.
#pragma once

#include "base/container/array.h"
#include "base/function_ref.h"

#include <gyre/defs.h>

#include <cstddef>
#include <memory>

namespace gyre {

class TaskSystem {
 public:
  // The largest number of workers, for arrays with one element each.
  static constexpr int kMaxWorkers = 64;

  // `threads` workers, the caller included, up to kMaxWorkers; 0 = as many as the machine has cores.
  explicit TaskSystem(int threads = 1);
  // The host's pool; one worker if it has no `run`.
  explicit TaskSystem(const HostTasks& host);
  ~TaskSystem();
  TaskSystem(const TaskSystem&) = delete;
  TaskSystem& operator=(const TaskSystem&) = delete;

  int worker_count() const { return worker_count_; }

  // Pauses that a waiting worker makes before it yields its core: few if workers outnumber cores.
  int spin_patience() const { return spin_patience_; }

  // Calls fn(worker) once for each worker in [0, worker_count()) and returns when all are done. They may run at the same
  // time or one after the other (a host's pool may have fewer threads), so none may wait for another.
  void run_workers(FunctionRef<void(int worker)> fn);

  // For an fn that takes work from a shared list until none is left: calls it as worker 0, and as other workers while
  // that call lasts. It does not wait for workers that wake too late. Returns when all calls are done.
  void run_claiming(FunctionRef<void(int worker)> fn);

  // Memory for partial results of a loop: at least `bytes`, aligned to 64, valid until the next call. For the thread
  // that starts work, outside of it.
  std::byte* scratch(std::size_t bytes);

  // While an object lives, workers that have come once wait for more work without sleep, since waking one takes as long
  // as many stages of a step. If workers outnumber cores, they sleep as usual.
  class Busy {
   public:
    explicit Busy(TaskSystem& tasks) : tasks_(tasks) { tasks_.stay_awake(true); }
    ~Busy() { tasks_.stay_awake(false); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    TaskSystem& tasks_;
  };

 private:
  struct Pool;

  void stay_awake(bool yes);
  void run(FunctionRef<void(int worker)> fn, bool all);
  void run_on_host(FunctionRef<void(int worker)> fn);

  int worker_count_ = 1;
  int spin_patience_ = 0;
  bool running_ = false;
  HostTasks host_;
  std::unique_ptr<Pool> pool_;  // none with one worker or a host
  Array<std::byte> scratch_;
};

// The begin of a worker's share of `count` items, if shares are equal; for the worker after the last it is `count`.
constexpr int share_begin(int count, int worker, int workers) {
  return static_cast<int>(static_cast<long long>(count) * worker / workers);
}
// The share that a worker takes from after `visited` others: first its own, then those of the workers after it.
constexpr int share_to_visit(int worker, int visited, int workers) {
  return worker + visited < workers ? worker + visited : worker + visited - workers;
}

}  // namespace gyre
