// Stages run in order and each block once, with more workers than cores, with a host that runs tasks one after the
// other, and with plain memory between stages, so that the thread sanitizer can judge the barrier.
#include "task/program.h"

#include "base/memory/memory.h"
#include "task/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <random>
#include <thread>
#include <vector>

namespace gyre::program_test {
namespace {

// Each stage computes values from neighbours' values of the stage before. Any block too early, too late, twice or never
// changes the end, and every element is read by other workers than wrote it.
struct Wave {
  std::vector<std::uint32_t> from, to;
  std::uint32_t salt = 0;
  int items_per_block = 0;
};

void spread(void* context, int block_begin, int block_end, int) {
  Wave& wave = *static_cast<Wave*>(context);
  const std::size_t n = wave.from.size();
  const std::size_t first = static_cast<std::size_t>(block_begin * wave.items_per_block);
  const std::size_t last = std::min(n, static_cast<std::size_t>(block_end * wave.items_per_block));
  for (std::size_t i = first; i < last; ++i) {
    wave.to[i] = wave.from[(i + 1) % n] * 31 + wave.from[(i + n / 2) % n] + wave.salt;
  }
}

void turn(void* context, int, int, int) {
  Wave& wave = *static_cast<Wave*>(context);
  wave.from.swap(wave.to);
  ++wave.salt;
}

std::vector<std::uint32_t> run_wave(TaskSystem& tasks, int items, int per_block, int per_claim, int rounds,
                                    const int* bounds = nullptr) {
  Wave wave;
  wave.items_per_block = per_block;
  for (int i = 0; i < items; ++i) wave.from.push_back(static_cast<std::uint32_t>(i));
  wave.to.resize(wave.from.size());
  std::vector<Stage> stages;
  for (int round = 0; round < rounds; ++round) {
    stages.push_back({spread, &wave, (items + per_block - 1) / per_block, per_claim, bounds});
    stages.push_back({turn, &wave, 1});
  }
  run_program(tasks, stages);
  return wave.from;
}

TEST(Program, SameResultForAnyWorkers) {
  TaskSystem one(1);
  const struct {
    int items, per_block, per_claim;
  } shapes[] = {{1000, 16, 1}, {1000, 16, 4}, {37, 1, 1}, {5, 1, 1}, {64, 16, 3}};
  for (const auto& shape : shapes) {
    const auto expected = run_wave(one, shape.items, shape.per_block, shape.per_claim, 60);
    for (int workers = 2; workers <= 16; ++workers) {
      TaskSystem tasks(workers);
      for (int repeat = 0; repeat < 3; ++repeat) {
        ASSERT_EQ(run_wave(tasks, shape.items, shape.per_block, shape.per_claim, 60), expected)
            << workers << " workers, " << shape.items << " items";
      }
    }
  }
}

TEST(Program, SameResultForAnyShares) {
  std::mt19937 random(5);
  TaskSystem one(1);
  const auto expected = run_wave(one, 400, 3, 2, 40);
  const int blocks = 134;
  for (int workers = 2; workers <= 5; ++workers) {
    TaskSystem tasks(workers);
    for (int repeat = 0; repeat < 10; ++repeat) {
      std::vector<int> bounds{0, blocks};
      // Also shares without a block.
      while (int(bounds.size()) <= workers)
        bounds.push_back(repeat == 0 ? blocks : int(random() % (blocks + 1)));
      std::sort(bounds.begin(), bounds.end());
      ASSERT_EQ(run_wave(tasks, 400, 3, 2, 40, bounds.data()), expected)
          << workers << " workers, repeat " << repeat;
    }
  }
}

// A host that calls its workers one after the other shows the blocks with which each begins: its own share first, then
// the others'.
TEST(Program, SharesBeginWhereTheirBoundsSay) {
  const HostTasks host{
      .run = [](void*, int, void (*task)(void*, int), void* context) { task(context, 1), task(context, 0); },
      .worker_count = 2};
  TaskSystem tasks(host);
  std::vector<int> begun;
  const int bounds[] = {0, 90, 100};
  const Stage stages[] = {{[](void* context, int begin, int, int worker) {
                             EXPECT_EQ(worker, 1) << "it was there first and alone";
                             static_cast<std::vector<int>*>(context)->push_back(begin);
                           },
                           &begun, 100, 1, bounds}};
  run_program(tasks, stages);
  ASSERT_EQ(begun.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(begun[std::size_t(i)], i < 10 ? 90 + i : i - 10);
}

TEST(Program, HostThatRunsOneAfterTheOther) {
  const HostTasks host{.run =
                           [](void*, int count, void (*task)(void*, int), void* context) {
                             for (int i = count - 1; i >= 0; --i) task(context, i);
                           },
                       .worker_count = 8};
  TaskSystem one(1), hosted(host);
  EXPECT_EQ(run_wave(hosted, 500, 8, 2, 40), run_wave(one, 500, 8, 2, 40));
}

TEST(Program, HostWithFewerThreadsThanWorkers) {
  const HostTasks host{.run =
                           [](void*, int count, void (*task)(void*, int), void* context) {
                             std::thread second([=] {
                               for (int i = 1; i < count; i += 2) task(context, i);
                             });
                             for (int i = 0; i < count; i += 2) task(context, i);
                             second.join();
                           },
                       .worker_count = 7};
  TaskSystem one(1), hosted(host);
  for (int repeat = 0; repeat < 20; ++repeat) {
    ASSERT_EQ(run_wave(hosted, 500, 8, 1, 30), run_wave(one, 500, 8, 1, 30));
  }
}

// Counts calls per block, and records the order of stages.
struct Ledger {
  std::vector<int> blocks;
  Ledger* before = nullptr;
  int problems = 0;
  int calls = 0;
  int worker = -1;
};

void count_blocks_done(void* context, int begin, int end, int) {
  Ledger& ledger = *static_cast<Ledger*>(context);
  for (int i = begin; i < end; ++i) ++ledger.blocks[static_cast<std::size_t>(i)];
}

void look_back(void* context, int begin, int end, int worker) {
  Ledger& ledger = *static_cast<Ledger*>(context);
  ++ledger.calls;
  ledger.worker = worker;
  ledger.problems += begin != 0 || end != static_cast<int>(ledger.blocks.size());
  if (ledger.before == nullptr) return;
  for (const int done : ledger.before->blocks) ledger.problems += done != 1;
}

TEST(Program, RandomTablesRunEachBlockOnceInOrder) {
  std::mt19937 random(4);
  for (int round = 0; round < 60; ++round) {
    TaskSystem tasks(1 + static_cast<int>(random() % 6));
    for (int table = 0; table < 5; ++table) {
      const std::size_t stage_count = random() % 12;
      std::vector<Ledger> ledgers(2 * stage_count);
      std::vector<Stage> stages;
      for (std::size_t s = 0; s < stage_count; ++s) {
        Ledger& work = ledgers[2 * s];
        Ledger& check = ledgers[2 * s + 1];
        const int blocks =
            random() % 3 == 0 ? static_cast<int>(random() % 3) : static_cast<int>(random() % 200);
        work.blocks.resize(static_cast<std::size_t>(blocks));
        check.blocks.resize(1 + random() % 4);
        check.before = &work;
        stages.push_back({count_blocks_done, &work, blocks, static_cast<int>(random() % 9)});
        // Several blocks in one claim are one call on one worker.
        stages.push_back({look_back, &check, static_cast<int>(check.blocks.size()), 4});
      }
      run_program(tasks, stages);
      for (const Ledger& ledger : ledgers) {
        ASSERT_EQ(ledger.problems, 0);
        if (ledger.before == nullptr) {
          for (const int done : ledger.blocks) ASSERT_EQ(done, 1);
        } else {
          ASSERT_EQ(ledger.calls, 1);
        }
      }
    }
  }
}

TEST(Program, SmallStagesStayWithTheCaller) {
  int jobs = 0;
  const HostTasks host{.run =
                           [](void* user, int count, void (*task)(void*, int), void* context) {
                             ++*static_cast<int*>(user);
                             for (int i = 0; i < count; ++i) task(context, i);
                           },
                       .worker_count = 4,
                       .user = &jobs};
  TaskSystem tasks(host);
  Ledger single;
  single.blocks.resize(1);
  Ledger many;
  many.blocks.resize(50);
  run_program(tasks, std::vector<Stage>{{look_back, &single, 1}, {count_blocks_done, &many, 50, 50}});
  EXPECT_EQ(jobs, 0) << "nobody is woken for two calls";
  EXPECT_EQ(single.worker, 0);
  run_program(tasks, std::vector<Stage>{
                         {look_back, &single, 1}, {count_blocks_done, &many, 50}, {look_back, &single, 1}});
  EXPECT_EQ(jobs, 1) << "woken once for the whole table";
  EXPECT_EQ(single.calls, 3);
  run_program(tasks, {});
  run_program(tasks, std::vector<Stage>{{look_back, &single, 0}});
  EXPECT_EQ(single.calls, 3) << "no block, no call";
}

TEST(Program, OneWorkerMakesOneCallAStage) {
  TaskSystem tasks(1);
  Ledger ledger;
  ledger.blocks.resize(100);
  run_program(tasks, std::vector<Stage>{{look_back, &ledger, 100, 1}});
  EXPECT_EQ(ledger.calls, 1);
  EXPECT_EQ(ledger.problems, 0);
}

void add_time(void* context, int begin, int end, int) {
  for (int i = begin; i < end; ++i) {
    // One block is much longer than the others: other workers must take the rest of its share.
    if (i == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    static_cast<std::atomic<int>*>(context)->fetch_add(1);
  }
}

TEST(Program, SharesAreStolen) {
  TaskSystem tasks(2);
  std::atomic<int> done{0};
  std::vector<Stage> stages(10, Stage{add_time, &done, 100, 1});
  run_program(tasks, stages);
  EXPECT_EQ(done.load(), 1000);
}

void check_rounding(void* context, int, int, int) {
  volatile float one = 1.0f, three = 3.0f;
  volatile float third = one / three;
  if (third != 0x1.555556p-2f) static_cast<std::atomic<int>*>(context)->fetch_add(1);
}

TEST(Program, ComputesInFloatMode) {
  if (std::fesetround(FE_DOWNWARD) != 0) GTEST_SKIP() << "one rounding only";
  std::atomic<int> wrong{0};
  for (const int workers : {1, 3}) {
    TaskSystem tasks(workers);
    run_program(tasks, std::vector<Stage>{{check_rounding, &wrong, 1}, {check_rounding, &wrong, 100}});
  }
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(wrong.load(), 0);
}

// Stages that start loops, between stages that all workers run.
struct Mixed {
  TaskSystem& tasks;
  std::vector<int> counts;
  std::atomic<int> inside{0};
};
void run_loop(void* context, int, int, int) {
  Mixed& mixed = *static_cast<Mixed*>(context);
  EXPECT_EQ(mixed.inside.load(), 0) << "no worker is in the list";
  for_blocks(mixed.tasks, 100, 1, [&](int begin, int, int) { ++mixed.counts[std::size_t(begin)]; });
}
void run_shared(void* context, int begin, int end, int) {
  Mixed& mixed = *static_cast<Mixed*>(context);
  ++mixed.inside;
  for (int i = begin; i < end; ++i) mixed.counts[std::size_t(i)] *= 3;
  --mixed.inside;
}

TEST(Program, StagesMayStartWorkInAProgramInParts) {
  const HostTasks host{.run =
                           [](void*, int count, void (*task)(void*, int), void* context) {
                             for (int i = count - 1; i >= 0; --i) task(context, i);
                           },
                       .worker_count = 8};
  TaskSystem one(1), three(3), sixteen(16), hosted(host);
  for (TaskSystem* tasks : {&one, &three, &sixteen, &hosted}) {
    Mixed mixed{*tasks, std::vector<int>(100)};
    std::vector<Stage> stages;
    Stage loop{run_loop, &mixed, 1};
    loop.starts_work = true;
    for (int round = 0; round < 6; ++round) {
      stages.push_back({run_shared, &mixed, 100, 2});
      stages.push_back(loop);
      stages.push_back(loop);
      stages.push_back({run_shared, &mixed, 100});
    }
    run_program_in_parts(*tasks, stages);
    int expected = 0;
    for (int round = 0; round < 6; ++round) expected = 3 * (3 * expected + 2);
    for (const int count : mixed.counts) ASSERT_EQ(count, expected) << tasks->worker_count() << " workers";
  }
}

TEST(Program, DoesNotAllocate) {
  TaskSystem tasks(3);
  Ledger ledger;
  ledger.blocks.resize(64);
  const std::vector<Stage> stages(20, Stage{count_blocks_done, &ledger, 64, 1});
  run_program(tasks, stages);
  const std::uint64_t before = allocation_count();
  run_program(tasks, stages);
  EXPECT_EQ(allocation_count(), before);
  for (const int done : ledger.blocks) EXPECT_EQ(done, 40);
}

TEST(Program, ManyShortProgramsWithMoreWorkersThanCores) {
  TaskSystem tasks(16);
  for (int round = 0; round < 150; ++round) {
    Ledger ledger;
    ledger.blocks.resize(40);
    const std::vector<Stage> stages(8, Stage{count_blocks_done, &ledger, 40, 1});
    run_program(tasks, stages);
    for (const int done : ledger.blocks) ASSERT_EQ(done, 8);
  }
}

}  // namespace
}  // namespace gyre::program_test
