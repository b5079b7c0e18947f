// Runs a table of stages by all workers. A stage is a kernel over a number of blocks; the next stage starts when every
// block of the one before is done. Workers are woken once for the whole table and wait between stages by spinning,
// since one sub-step has dozens of stages of some ten microseconds each and waking a thread takes as long.
//
// A kernel may write only what belongs to its blocks, so which worker takes which block cannot show in a result.
#pragma once

#include "task/task_system.h"

#include <span>

namespace gyre {

struct Stage {
  // Does the blocks in [block_begin, block_end). Every block of [0, block_count) is done once.
  void (*kernel)(void* context, int block_begin, int block_end, int worker) = nullptr;
  void* context = nullptr;
  int block_count = 0;
  // What is not more than one claim runs on one worker without waking others. 1: blocks may differ much, and each is taken by
  // itself. More: they are alike and small, and a worker takes several claims at once.
  int blocks_per_claim = 1;
  // The first block of each worker's share, ascending from 0, and then block_count. Not set: the shares are equal. Whoever works on
  // the same things in one stage after the other finds them in its cache, so shares that cut where few things are shared are
  // faster than equal ones.
  const int* bounds = nullptr;
};

// Each worker starts with its own share of a stage's blocks and then takes from the others'. With one worker this is a plain loop,
// one kernel call a stage. Nothing is allocated, and no worker is waited for that has not come.
void run_program(TaskSystem& tasks, std::span<const Stage> stages);

}  // namespace gyre
