// Every worker runs once, results are visible afterwards, and a host's pool is used as its contract says.
#include "task/task_system.h"

#include "task/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <chrono>
#include <thread>
#include <vector>

namespace gyre::task_system_test {
namespace {

TEST(TaskSystem, OneWorkerIsTheCaller) {
  TaskSystem tasks;
  EXPECT_EQ(tasks.worker_count(), 1);
  const std::thread::id caller = std::this_thread::get_id();
  int calls = 0;
  tasks.run_workers([&](int worker) {
    EXPECT_EQ(worker, 0);
    EXPECT_EQ(std::this_thread::get_id(), caller);
    ++calls;
  });
  EXPECT_EQ(calls, 1);
}

TEST(TaskSystem, CountsWorkers) {
  EXPECT_EQ(TaskSystem(3).worker_count(), 3);
  EXPECT_EQ(TaskSystem(-5).worker_count(), 1);
  EXPECT_EQ(TaskSystem(1000000).worker_count(), TaskSystem::kMaxWorkers);
  EXPECT_GE(TaskSystem(0).worker_count(), 1);
}

TEST(TaskSystem, EveryWorkerOnce) {
  for (int count = 1; count <= 16; ++count) {
    TaskSystem tasks(count);
    // Plain ints: the thread sanitizer sees whether the end of a job orders the workers' writes.
    std::vector<int> calls(static_cast<std::size_t>(count));
    for (int job = 1; job <= 100; ++job) {
      tasks.run_workers([&](int worker) { ++calls[static_cast<std::size_t>(worker)]; });
      for (const int value : calls) ASSERT_EQ(value, job);
    }
  }
}

TEST(TaskSystem, WorkersMeetInPairs) {
  TaskSystem tasks(4);
  for (int job = 0; job < 200; ++job) {
    std::atomic<int> inside{0};
    tasks.run_workers([&](int) {
      inside.fetch_add(1);
      while (inside.load() < 4) std::this_thread::yield();
    });
    ASSERT_EQ(inside.load(), 4) << "an own pool runs them at the same time";
  }
}

TEST(TaskSystem, ClaimingNeedsOnlyTheCaller) {
  TaskSystem tasks(8);
  for (int job = 0; job < 2000; ++job) {
    std::atomic<int> next{0};
    std::vector<int> done(10);
    tasks.run_claiming([&](int) {
      for (int i = next.fetch_add(1); i < 10; i = next.fetch_add(1)) done[static_cast<std::size_t>(i)] = 1;
    });
    for (const int value : done) ASSERT_EQ(value, 1);
  }
}

TEST(TaskSystem, SleepsAndWakes) {
  TaskSystem tasks(3);
  for (int job = 0; job < 5; ++job) {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    std::atomic<int> calls{0};
    tasks.run_workers([&](int) { calls.fetch_add(1); });
    EXPECT_EQ(calls.load(), 3);
  }
}

TEST(TaskSystem, ComesAndGoes) {
  for (int i = 0; i < 50; ++i) {
    TaskSystem tasks(5);
    if (i % 2 == 0) continue;
    int sum = 0;
    tasks.run_workers([&](int worker) {
      if (worker == 0) ++sum;
    });
    ASSERT_EQ(sum, 1);
  }
}

// By arithmetic: fegetround() asks the x87 unit on x86, which is unused here.
bool rounds_to_nearest() {
  volatile float one = 1.0f, three = 3.0f;
  volatile float third = one / three, minus_third = -one / three;
  return third == 0x1.555556p-2f && minus_third == -0x1.555556p-2f;
}

TEST(TaskSystem, WorkersComputeInFloatMode) {
  ASSERT_TRUE(rounds_to_nearest());
  if (std::fesetround(FE_DOWNWARD) != 0) GTEST_SKIP() << "one rounding only";
  const bool before = rounds_to_nearest();
  // Made after the mode changed, so that its threads inherit the wrong mode.
  TaskSystem tasks(4);
  int wrong = 0;
  std::atomic<int> wrong_workers{0};
  tasks.run_workers([&](int) { wrong_workers += rounds_to_nearest() ? 0 : 1; });
  for_blocks(tasks, 1, 1, [&](int, int, int) { wrong += rounds_to_nearest() ? 0 : 1; });
  const bool after = rounds_to_nearest();
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(wrong_workers.load(), 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_FALSE(before);
  EXPECT_FALSE(after) << "the host's mode comes back";
}

// A host that runs tasks one after the other, the last one first: the worst case of the contract.
struct BackwardHost {
  int jobs = 0;
  HostTasks door(int workers) {
    return {.run =
                [](void* user, int count, void (*task)(void*, int), void* context) {
                  ++static_cast<BackwardHost*>(user)->jobs;
                  for (int i = count - 1; i >= 0; --i) task(context, i);
                },
            .worker_count = workers,
            .user = this};
  }
};

TEST(TaskSystem, HostRunsEveryIndex) {
  BackwardHost host;
  TaskSystem tasks(host.door(6));
  EXPECT_EQ(tasks.worker_count(), 6);
  std::vector<int> order;
  tasks.run_workers([&](int worker) { order.push_back(worker); });
  EXPECT_EQ(order, (std::vector<int>{5, 4, 3, 2, 1, 0}));
  EXPECT_EQ(host.jobs, 1);
}

TEST(TaskSystem, HostWithThreads) {
  const HostTasks host{.run =
                           [](void*, int count, void (*task)(void*, int), void* context) {
                             std::vector<std::thread> threads;
                             for (int i = 0; i < count; ++i) threads.emplace_back([=] { task(context, i); });
                             for (std::thread& thread : threads) thread.join();
                           },
                       .worker_count = 4};
  TaskSystem tasks(host);
  for (int job = 0; job < 20; ++job) {
    std::vector<int> squares(1000);
    for_blocks(tasks, 1000, 7, [&](int begin, int end, int) {
      for (int i = begin; i < end; ++i) squares[static_cast<std::size_t>(i)] = i * i;
    });
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(squares[static_cast<std::size_t>(i)], i * i);
  }
}

TEST(TaskSystem, HostWithoutRunIsOneWorker) {
  TaskSystem tasks(HostTasks{.worker_count = 8});
  EXPECT_EQ(tasks.worker_count(), 1);
  int calls = 0;
  tasks.run_workers([&](int) { ++calls; });
  EXPECT_EQ(calls, 1);
}

TEST(TaskSystem, ScratchIsKept) {
  TaskSystem tasks;
  std::byte* const first = tasks.scratch(1000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(first) % 64, 0u);
  EXPECT_EQ(tasks.scratch(500), first);
}

TEST(TaskSystem, BusyWorkersTakeJobsThatComeAfterPauses) {
  for (const int workers : {2, 64}) {
    TaskSystem tasks(workers);
    std::atomic<int> calls{0};
    for (int step = 0; step < 3; ++step) {
      const TaskSystem::Busy busy(tasks);
      for (int job = 0; job < 3; ++job) {
        tasks.run_workers([&](int) { ++calls; });
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // beyond a worker's patience
      }
    }
    tasks.run_workers([&](int) { ++calls; });
    EXPECT_EQ(calls, 10 * workers);
  }
}

}  // namespace
}  // namespace gyre::task_system_test
