#include "rigid/solve/motion_stages.h"

namespace gyre {

namespace {

// Returns the bodies of blocks [begin, end) of a list, with `size` in each block.
template <class T>
std::span<T> block_of(std::span<T> list, int begin, int end, int size) {
  const std::size_t first = std::size_t(begin) * std::size_t(size);
  return list.subspan(first, min(std::size_t(end) * std::size_t(size), list.size()) - first);
}

// Calls run(first, last, is_measured) for blocks [begin, end) of bodies.
template <class Run>
void part_measured(const BodyMotionSolve& s, int begin, int end, Run&& run) {
  const int middle = max(begin, min(end, s.measured_blocks));
  if (begin < middle) run(begin, middle, true);
  if (middle < end) run(middle, end, false);
}

void apply_forces(const BodyMotionSolve& s, int begin, int end, bool with_warm_start) {
  part_measured(s, begin, end, [&](int first, int last, bool measured) {
    s.kernels.motion.integrate_velocities(s.blocks, first, last, s.arrays.motion, with_warm_start && measured, measured);
  });
}
void integrate(const BodyMotionSolve& s, int begin, int end, bool adds_contact_change) {
  part_measured(s, begin, end, [&](int first, int last, bool measured) {
    s.kernels.motion.integrate_positions(s.blocks, first, last, s.arrays, s.motions.substep,
                             measured && adds_contact_change);
  });
}

}  // namespace

void prepare_bodies(const BodyMotionSolve& s, int begin, int end) {
  s.kernels.motion.prepare(s.blocks, begin, end, s.moved.data(), int(s.moved.size()), s.arrays.inertia);
}
void apply_forces(const BodyMotionSolve& s, int begin, int end) { apply_forces(s, begin, end, false); }
void apply_forces_and_warm_start(const BodyMotionSolve& s, int begin, int end) {
  apply_forces(s, begin, end, true);
}
void warm_start_bodies(const BodyMotionSolve& s, int begin, int end) {
  s.kernels.motion.warm_start(s.blocks, begin, end, s.arrays.motion);
}
void start_contact_change(const BodyMotionSolve& s, int begin, int end) {
  const int last = min(end, s.measured_blocks);
  if (begin < last) s.kernels.motion.start_contact_change(s.blocks, begin, last, s.arrays.motion);
}
void add_contact_change(const BodyMotionSolve& s, int begin, int end) {
  const int last = min(end, s.measured_blocks);
  if (begin < last) s.kernels.motion.add_contact_change(s.blocks, begin, last, s.arrays.motion);
}
void integrate_positions(const BodyMotionSolve& s, int begin, int end) { integrate(s, begin, end, false); }
void add_contact_change_and_integrate(const BodyMotionSolve& s, int begin, int end) {
  integrate(s, begin, end, true);
}

void apply_forces_and_warm_start_in_lanes(const BodyMotionSolve& s, int begin, int end,
                                          const LaneVelocities& lanes) {
  part_measured(s, begin, end, [&](int first, int last, bool measured) {
    s.kernels.motion.integrate_velocities_in_lanes(s.blocks, first, last, lanes, measured, measured);
  });
}
void start_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end,
                                   const LaneVelocities& lanes) {
  const int last = min(end, s.measured_blocks);
  if (begin < last) s.kernels.motion.start_contact_change_in_lanes(s.blocks, begin, last, lanes);
}
void add_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes) {
  const int last = min(end, s.measured_blocks);
  if (begin < last)
    s.kernels.motion.add_contact_change_in_lanes(s.blocks, begin, last, s.arrays.motion, lanes);
}
void integrate_positions_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes) {
  s.kernels.motion.integrate_positions_in_lanes(s.blocks, begin, end, s.arrays, lanes, s.motions.substep);
}

bool has_fast_spinning(const BodyMotionSolve& s, int begin, int end) {
  return !s.fast_spinning.empty() &&
         s.fast_spinning_starts[std::size_t(begin)] != s.fast_spinning_starts[std::size_t(end)];
}
void integrate_fast_spinning_of_blocks(const BodyMotionSolve& s, int begin, int end) {
  if (!has_fast_spinning(s, begin, end)) return;
  const std::uint32_t first = s.fast_spinning_starts[std::size_t(begin)],
                      last = s.fast_spinning_starts[std::size_t(end)];
  rotate_exactly(s.w.bodies, s.fast_spinning.subspan(first, last - first), s.motions.substep,
                 s.kernels.rotation);
}
void integrate_fast_spinning(const BodyMotionSolve& s, int begin, int end) {
  rotate_exactly(s.w.bodies, block_of(s.fast_spinning, begin, end, kFastSpinningPerBlock), s.motions.substep,
                 s.kernels.rotation);
}

void begin_projection(const BodyMotionSolve& s, int begin, int end) {
  s.kernels.motion.begin_projection(s.blocks, begin, end, s.arrays.motion);
}
void end_projection(const BodyMotionSolve& s, int begin, int end) {
  s.kernels.motion.end_projection(s.blocks, begin, end, s.arrays.motion, s.pushes.data());
}

void move_free_bodies(const BodyMotionSolve& s, int begin, int end) {
  integrate_free_bodies(s.w.bodies, block_of(s.free_bodies, begin, end, kBodiesPerBlock), s.motions,
                        s.kernels.rotation);
}
void finish_orientations(const BodyMotionSolve& s, int begin, int end) {
  apply_rotations(s.w.bodies, block_of(s.moved, begin, end, kBodiesPerBlock),
                  block_of(s.pushes, begin, end, kBodiesPerBlock), s.kernels.rotation);
}

}  // namespace gyre
