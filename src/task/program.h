// Runs a list of stages on all workers. A stage is a kernel over a number of blocks; the next stage starts when every
// block of the one before is done. Workers are woken once for the whole list and spin between stages, since a sub-step
// has dozens of stages of about ten microseconds each, and waking a thread takes as long.
//
// A kernel may write only data of its blocks, so the assignment of blocks to workers never shows in a result.
#pragma once

#include "task/task_system.h"

#include <span>

namespace gyre {

struct Stage {
  // Runs the blocks in [block_begin, block_end). Every block of [0, block_count) runs once.
  void (*kernel)(void* context, int block_begin, int block_end, int worker) = nullptr;
  void* context = nullptr;
  int block_count = 0;
  // A stage with no more blocks than one claim runs on one worker without waking others. 1: blocks may differ much and
  // are claimed one by one. More: they are alike and small, and a worker makes several claims at once.
  int blocks_per_claim = 1;
  // The first block of each worker's share, ascending from 0, and then block_count. If null, the shares are equal. A
  // worker that handles the same data in each stage finds it in its cache, so shares cut where few data are shared are
  // faster than equal ones.
  const int* bounds = nullptr;
  // True if the kernel starts work on the task system itself, for example loops of parallel.h. Only run_program_in_parts runs such stages.
  bool starts_work = false;
};

// Each worker starts with its own share of a stage's blocks and then takes from the others' shares. With one worker
// this is a plain loop, with one kernel call a stage. Nothing is allocated, and no late worker is waited for.
void run_program(TaskSystem& tasks, std::span<const Stage> stages);

// The same for a list with stages that start work. The calling thread runs each of these while no other worker is in the list, and the stages
// between two of them are a program.
void run_program_in_parts(TaskSystem& tasks, std::span<const Stage> stages);

}  // namespace gyre
