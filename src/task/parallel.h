// Parallel loops in blocks. A block is a fixed number of items, so its result does not depend on the number of workers;
// it writes only its own results, so their order does not matter either. Blocks are claimed one by one from a shared
// counter. Once warm, nothing here allocates.
#pragma once

#include "base/check.h"
#include "base/float_mode.h"
#include "base/function_ref.h"
#include "task/task_system.h"

#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

namespace gyre {

// Calls run_block(block, worker) for every block in [0, blocks).
void run_blocks(TaskSystem& tasks, int blocks, FunctionRef<void(int block, int worker)> run_block);

constexpr int count_blocks(int count, int block_size) {
  return count / block_size + (count % block_size != 0 ? 1 : 0);
}

// Calls fn(int begin, int end, int worker) for every block of [0, count). With one worker or one block the calls are
// serial, in ascending order.
template <class Fn>
void for_blocks(TaskSystem& tasks, int count, int block_size, Fn&& fn) {
  GYRE_ASSERT(count >= 0 && block_size > 0, "blocks have a positive size");
  const int blocks = count_blocks(count, block_size);
  const auto run_block = [&](int block, int worker) {
    const int begin = block * block_size;
    fn(begin, count - begin < block_size ? count : begin + block_size, worker);
  };
  if (blocks == 0) return;
  if (blocks == 1 || tasks.worker_count() == 1) {
    const FloatMode mode;
    for (int block = 0; block < blocks; ++block) run_block(block, 0);
    return;
  }
  run_blocks(tasks, blocks, run_block);
}

// Runs independent pieces of work in parallel. At most one of them may use data of the thread that starts work. With
// one worker they run one after the other.
template <class... Pieces>
void run_parallel(TaskSystem& tasks, Pieces&&... pieces) {
  for_blocks(tasks, static_cast<int>(sizeof...(pieces)), 1, [&](int index, int, int) {
    int piece = 0;
    ((piece++ == index ? pieces() : void()), ...);
  });
}

// Combines map(int begin, int end, int worker) of every block into one value: combine(...combine(init, first)...,
// last), always in block order, so that sums of floats have the same bits. T is plain data.
template <class T, class Map, class Combine>
T reduce_blocks(TaskSystem& tasks, int count, int block_size, T init, Map&& map, Combine&& combine) {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kMemoryAlign,
                "partial results are plain data");
  const int blocks = count_blocks(count, block_size);
  if (blocks <= 1 || tasks.worker_count() == 1) {
    for_blocks(tasks, count, block_size, [&](int begin, int end, int worker) {
      init = combine(init, static_cast<T>(map(begin, end, worker)));
    });
    return init;
  }
  T* const partial = reinterpret_cast<T*>(tasks.scratch(static_cast<std::size_t>(blocks) * sizeof(T)));
  for_blocks(tasks, count, block_size, [&](int begin, int end, int worker) {
    new (partial + begin / block_size) T(map(begin, end, worker));
  });
  for (int block = 0; block < blocks; ++block) init = combine(init, partial[block]);
  return init;
}

}  // namespace gyre
