#include "rigid/solve/motion_stages.h"

#include "task/parallel.h"

namespace gyre {

namespace {

constexpr int kMotionsPerClaim = 4;
constexpr int kSpinnersPerClaim = 8;

// Bodies [begin, end) of a list in blocks of `size`.
template <class T>
std::span<T> block_of(std::span<T> list, int begin, int end, int size) {
  const std::size_t first = std::size_t(begin) * std::size_t(size);
  return list.subspan(first, min(std::size_t(end) * std::size_t(size), list.size()) - first);
}

// Calls run(first, last, whether they are watched) for blocks [begin, end) of bodies.
template <class Run>
void part_watched(const Solve& s, int begin, int end, Run&& run) {
  const int middle = max(begin, min(end, s.watched_blocks));
  if (begin < middle) run(begin, middle, true);
  if (middle < end) run(middle, end, false);
}

const Solve& solve_of(void* context) { return *static_cast<const Solve*>(context); }

void fly_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  fly(s.w.bodies, block_of(s.flying, begin, end, kBodiesPerBlock), s.motions, s.kernels.turns);
}
void turn_alone_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  turn_alone(s.w.bodies, block_of(s.spinners, begin, end, kSpinnersPerClaim), s.h, s.kernels.turns);
}
void finish_turns_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  finish_turns(s.w.bodies, block_of(s.moved, begin, end, kBodiesPerBlock),
               block_of(s.pushes, begin, end, kBodiesPerBlock), s.kernels.turns);
}

}  // namespace

void prepare_motion(const Solve& s, int begin, int end) {
  s.kernels.motion.prepare(s.motion_blocks, begin, end, s.moved.data(), int(s.moved.size()),
                           s.contact_bodies.inertia);
}
void predict_motion(const Solve& s, int begin, int end, bool warm, const LaneVelocities& lanes) {
  part_watched(s, begin, end, [&](int first, int last, bool watched) {
    if (lanes.is_given())
      return s.kernels.motion.predict_in_lanes(s.motion_blocks, first, last, lanes, warm && watched, watched);
    s.kernels.motion.predict(s.motion_blocks, first, last, s.contact_bodies.motion, warm && watched, watched);
  });
}
void watch_motion(const Solve& s, int begin, int end, const LaneVelocities& lanes) {
  const int last = min(end, s.watched_blocks);
  if (begin >= last) return;
  if (lanes.is_given()) return s.kernels.motion.watch_in_lanes(s.motion_blocks, begin, last, lanes);
  s.kernels.motion.watch(s.motion_blocks, begin, last, s.contact_bodies.motion);
}
void note_motion(const Solve& s, int begin, int end, const LaneVelocities& lanes) {
  const int last = min(end, s.watched_blocks);
  if (begin >= last) return;
  if (lanes.is_given())
    return s.kernels.motion.note_in_lanes(s.motion_blocks, begin, last, s.contact_bodies.motion, lanes);
  s.kernels.motion.note(s.motion_blocks, begin, last, s.contact_bodies.motion);
}
void advance_motion(const Solve& s, int begin, int end, bool noted, const LaneVelocities& lanes) {
  BodyStore& bodies = s.w.bodies;
  const MotionArrays arrays{bodies.motion.data(), bodies.inertia.data(), bodies.orientations.data()};
  part_watched(s, begin, end, [&](int first, int last, bool watched) {
    if (lanes.is_given())
      return s.kernels.motion.advance_in_lanes(s.motion_blocks, first, last, arrays, lanes, s.h);
    s.kernels.motion.advance(s.motion_blocks, first, last, arrays, s.h, watched && !noted);
  });
}
bool has_spinners(const Solve& s, int begin, int end) {
  return !s.spinners.empty() && s.spinner_starts[std::size_t(begin)] != s.spinner_starts[std::size_t(end)];
}
void turn_spinners(const Solve& s, int begin, int end) {
  if (!has_spinners(s, begin, end)) return;
  const std::uint32_t first = s.spinner_starts[std::size_t(begin)], last = s.spinner_starts[std::size_t(end)];
  turn_alone(s.w.bodies, s.spinners.subspan(first, last - first), s.h, s.kernels.turns);
}

void prepare_motion_stage(void* context, int begin, int end, int) {
  prepare_motion(solve_of(context), begin, end);
}
void predict_stage(void* context, int begin, int end, int) {
  predict_motion(solve_of(context), begin, end, false);
}
void predict_warm_stage(void* context, int begin, int end, int) {
  predict_motion(solve_of(context), begin, end, true);
}
void warm_motion_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  s.kernels.motion.warm(s.motion_blocks, begin, end, s.contact_bodies.motion);
}
void watch_motion_stage(void* context, int begin, int end, int) {
  watch_motion(solve_of(context), begin, end);
}
void note_motion_stage(void* context, int begin, int end, int) { note_motion(solve_of(context), begin, end); }
void advance_stage(void* context, int begin, int end, int) {
  advance_motion(solve_of(context), begin, end, false);
}
void advance_noted_stage(void* context, int begin, int end, int) {
  advance_motion(solve_of(context), begin, end, true);
}
void begin_projection_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  s.kernels.motion.begin_projection(s.motion_blocks, begin, end, s.contact_bodies.motion);
}
void end_projection_stage(void* context, int begin, int end, int) {
  const Solve& s = solve_of(context);
  s.kernels.motion.end_projection(s.motion_blocks, begin, end, s.contact_bodies.motion, s.pushes.data());
}

void add_motion(ProgramWriter& program, Solve& solve, void (*kernel)(void*, int, int, int), int blocks) {
  const int all = count_blocks(int(solve.moved.size()), solve.kernels.width);
  program.add(kernel, &solve, blocks, kMotionsPerClaim, blocks == all ? solve.moved_bounds : nullptr);
}
void add_flying(ProgramWriter& program, Solve& solve) {
  program.add(fly_stage, &solve, count_blocks(int(solve.flying.size()), kBodiesPerBlock));
}
void add_turn_alone(ProgramWriter& program, Solve& solve) {
  program.add(turn_alone_stage, &solve, count_blocks(int(solve.spinners.size()), kSpinnersPerClaim));
}
void add_finish_turns(ProgramWriter& program, Solve& solve) {
  program.add(finish_turns_stage, &solve, count_blocks(int(solve.moved.size()), kBodiesPerBlock));
}

}  // namespace gyre
