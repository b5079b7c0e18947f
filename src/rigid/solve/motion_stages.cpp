#include "rigid/solve/motion_stages.h"

#include "task/parallel.h"

namespace gyre {

namespace {

constexpr int kMotionsPerClaim = 4;
constexpr int kFastSpinningPerClaim = 8;

// Bodies [begin, end) of a list in blocks of `size`.
template <class T>
std::span<T> block_of(std::span<T> list, int begin, int end, int size) {
  const std::size_t first = std::size_t(begin) * std::size_t(size);
  return list.subspan(first, min(std::size_t(end) * std::size_t(size), list.size()) - first);
}

// Calls run(first, last, whether they are watched) for blocks [begin, end) of bodies.
template <class Run>
void part_watched(const BatchContext& s, int begin, int end, Run&& run) {
  const int middle = max(begin, min(end, s.recorded_blocks));
  if (begin < middle) run(begin, middle, true);
  if (middle < end) run(middle, end, false);
}

const BatchContext& solve_of(void* context) { return *static_cast<const BatchContext*>(context); }

void integrate_free_bodies_stage(void* context, int begin, int end, int) {
  const BatchContext& s = solve_of(context);
  integrate_free_bodies(s.w.bodies, block_of(s.free_bodies, begin, end, kBodiesPerBlock), s.motions,
                        s.kernels.rotation);
}
void rotate_exactly_stage(void* context, int begin, int end, int) {
  const BatchContext& s = solve_of(context);
  rotate_exactly(s.w.bodies, block_of(s.fast_spinning, begin, end, kFastSpinningPerClaim), s.h,
                 s.kernels.rotation);
}
void apply_rotations_stage(void* context, int begin, int end, int) {
  const BatchContext& s = solve_of(context);
  apply_rotations(s.w.bodies, block_of(s.moved, begin, end, kBodiesPerBlock),
                  block_of(s.pushes, begin, end, kBodiesPerBlock), s.kernels.rotation);
}

}  // namespace

void prepare_motion(const BatchContext& s, int begin, int end) {
  s.kernels.motion.prepare(s.motion_blocks, begin, end, s.moved.data(), int(s.moved.size()),
                           s.contact_bodies.inertia);
}
void predict_motion(const BatchContext& s, int begin, int end, bool warm, const LaneVelocities& lanes) {
  part_watched(s, begin, end, [&](int first, int last, bool watched) {
    if (lanes.is_set())
      return s.kernels.motion.integrate_velocities_in_lanes(s.motion_blocks, first, last, lanes,
                                                            warm && watched, watched);
    s.kernels.motion.integrate_velocities(s.motion_blocks, first, last, s.contact_bodies.motion,
                                          warm && watched, watched);
  });
}
void record_velocities(const BatchContext& s, int begin, int end, const LaneVelocities& lanes) {
  const int last = min(end, s.recorded_blocks);
  if (begin >= last) return;
  if (lanes.is_set()) return s.kernels.motion.record_velocities_in_lanes(s.motion_blocks, begin, last, lanes);
  s.kernels.motion.record_velocities(s.motion_blocks, begin, last, s.contact_bodies.motion);
}
void record_velocity_change(const BatchContext& s, int begin, int end, const LaneVelocities& lanes) {
  const int last = min(end, s.recorded_blocks);
  if (begin >= last) return;
  if (lanes.is_set())
    return s.kernels.motion.record_velocity_change_in_lanes(s.motion_blocks, begin, last,
                                                            s.contact_bodies.motion, lanes);
  s.kernels.motion.record_velocity_change(s.motion_blocks, begin, last, s.contact_bodies.motion);
}
void advance_motion(const BatchContext& s, int begin, int end, bool noted, const LaneVelocities& lanes) {
  BodyStore& bodies = s.w.bodies;
  const MotionArrays arrays{bodies.motion.data(), bodies.inertia.data(), bodies.orientations.data()};
  part_watched(s, begin, end, [&](int first, int last, bool watched) {
    if (lanes.is_set())
      return s.kernels.motion.integrate_positions_in_lanes(s.motion_blocks, first, last, arrays, lanes, s.h);
    s.kernels.motion.integrate_positions(s.motion_blocks, first, last, arrays, s.h, watched && !noted);
  });
}
bool has_fast_spinning(const BatchContext& s, int begin, int end) {
  return !s.fast_spinning.empty() &&
         s.fast_spinning_starts[std::size_t(begin)] != s.fast_spinning_starts[std::size_t(end)];
}
void rotate_fast_spinning(const BatchContext& s, int begin, int end) {
  if (!has_fast_spinning(s, begin, end)) return;
  const std::uint32_t first = s.fast_spinning_starts[std::size_t(begin)],
                      last = s.fast_spinning_starts[std::size_t(end)];
  rotate_exactly(s.w.bodies, s.fast_spinning.subspan(first, last - first), s.h, s.kernels.rotation);
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
  const BatchContext& s = solve_of(context);
  s.kernels.motion.warm_start(s.motion_blocks, begin, end, s.contact_bodies.motion);
}
void record_velocities_stage(void* context, int begin, int end, int) {
  record_velocities(solve_of(context), begin, end);
}
void record_velocity_change_stage(void* context, int begin, int end, int) {
  record_velocity_change(solve_of(context), begin, end);
}
void advance_stage(void* context, int begin, int end, int) {
  advance_motion(solve_of(context), begin, end, false);
}
void advance_recorded_stage(void* context, int begin, int end, int) {
  advance_motion(solve_of(context), begin, end, true);
}
void begin_projection_stage(void* context, int begin, int end, int) {
  const BatchContext& s = solve_of(context);
  s.kernels.motion.begin_projection(s.motion_blocks, begin, end, s.contact_bodies.motion);
}
void end_projection_stage(void* context, int begin, int end, int) {
  const BatchContext& s = solve_of(context);
  s.kernels.motion.end_projection(s.motion_blocks, begin, end, s.contact_bodies.motion, s.pushes.data());
}

void add_motion(ProgramWriter& program, BatchContext& solve, void (*kernel)(void*, int, int, int),
                int blocks) {
  const int all = count_blocks(int(solve.moved.size()), solve.kernels.width);
  program.add(kernel, &solve, blocks, kMotionsPerClaim, blocks == all ? solve.moved_bounds : nullptr);
}
void add_free_bodies(ProgramWriter& program, BatchContext& solve) {
  program.add(integrate_free_bodies_stage, &solve,
              count_blocks(int(solve.free_bodies.size()), kBodiesPerBlock));
}
void add_exact_rotation(ProgramWriter& program, BatchContext& solve) {
  program.add(rotate_exactly_stage, &solve,
              count_blocks(int(solve.fast_spinning.size()), kFastSpinningPerClaim));
}
void add_apply_rotations(ProgramWriter& program, BatchContext& solve) {
  program.add(apply_rotations_stage, &solve, count_blocks(int(solve.moved.size()), kBodiesPerBlock));
}

}  // namespace gyre
