#include "rigid/solve/joint_stages.h"

#include "solver/articulation/ball_joint_transfer.h"

namespace gyre {

namespace {

// Calls fn(index in the batch's list) for the joints of some blocks of a group.
template <class Fn>
void for_members(const JointGroup& g, int begin, int end, Fn&& fn) {
  const JointSolve& s = *g.solve;
  const std::uint32_t last = min(std::uint32_t(end * kJointsPerBlock), g.count);
  for (std::uint32_t n = std::uint32_t(begin * kJointsPerBlock); n < last; ++n)
    fn(s.lists.swept[s.order[g.first + n]]);
}
// Calls fn(record, work, places) for the same joints.
template <class Fn>
void for_joints(const JointGroup& g, int begin, int end, Fn&& fn) {
  const JointSolve& s = *g.solve;
  for_members(g, begin, end, [&](std::uint32_t i) {
    fn(s.w.joints.records[s.batch.joints[i]], s.works.work[i], s.works.places[i]);
  });
}
// The blocks of a group whose joints are solved in lanes.
struct Balls {
  const BallKernels& kernels;
  void* blocks;
  BallArrays arrays;
  BallSettings settings;
  int begin, end;
};
Balls balls_of(const JointGroup& g, int begin, int end) {
  const JointSolve& s = *g.solve;
  const Softness& softness = s.settings.softness;
  const int width = s.kernels.width, joints = min(end * kJointsPerBlock, int(g.count));
  return {s.kernels.balls,
          s.balls,
          {s.bodies.motion, s.bodies.inertia, s.bodies.orientation},
          {s.settings.substep, softness.bias_rate, softness.mass_scale, softness.impulse_scale},
          g.ball_block + begin * kJointsPerBlock / width,
          g.ball_block + count_blocks(joints, width)};
}
// Records of joints are large and ordered by slot, not by colour. They are fetched ahead, while others are in use.
constexpr int kJointsAhead = 6;
void fetch_ahead(const JointRecord& joint) {
  __builtin_prefetch(&joint);
  __builtin_prefetch(&joint.linear_impulse);
  __builtin_prefetch(&joint.total_linear);
}
// Calls fn(block, lane, slot) for the joints of a group in lanes.
template <class Fn>
void for_balls(const JointGroup& g, int begin, int end, Fn&& fn) {
  const JointSolve& s = *g.solve;
  const int width = s.kernels.width, last = min(end * kJointsPerBlock, int(g.count));
  const auto slot_of = [&](int n) {
    return s.batch.joints[s.lists.swept[s.order[g.first + std::uint32_t(n)]]];
  };
  for (int n = begin * kJointsPerBlock; n < last; ++n) {
    if (n + kJointsAhead < last) fetch_ahead(s.w.joints.records[slot_of(n + kJointsAhead)]);
    fn(g.ball_block + n / width, n % width, slot_of(n));
  }
}

}  // namespace

void begin_ball_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block < 0) return;
  const Balls balls = balls_of(g, begin, end);
  // Lanes without a joint stay cleared and connect no bodies.
  if (int(g.count) % balls.kernels.width != 0) clear_balls(balls.kernels, balls.blocks, balls.end - 1);
  const JointSolve& s = *g.solve;
  const float warm_scale = s.all_iterative ? s.lane_start.warm_scale : 1.0f;
  const auto turns = [&](std::int32_t body) {
    return body != kNoBody &&
           inertia_rotates(s.w.bodies.masses[std::size_t(body)], s.w.bodies.flags[std::size_t(body)]);
  };
  for_balls(g, begin, end, [&](int block, int lane, std::uint32_t slot) {
    const JointRecord& joint = s.w.joints.records[slot];
    begin_ball(balls.kernels, balls.blocks, block, lane, joint, joint_offset(s.w, joint), warm_scale,
               turns(joint.body_a) || turns(joint.body_b), balls.arrays.inertia);
  });
  balls.kernels.locate(balls.blocks, balls.begin, balls.end, balls.arrays);
}
void finish_ball_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block < 0) return;
  const Balls balls = balls_of(g, begin, end);
  for_balls(g, begin, end, [&](int block, int lane, std::uint32_t slot) {
    finish_ball(balls.kernels, balls.blocks, block, lane, g.solve->w.joints.records[slot]);
  });
}
void prepare_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.prepare(balls.blocks, balls.begin, balls.end, balls.arrays);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets& places) {
    prepare_joint(joint, work, places, g.solve->bodies, g.solve->settings);
  });
}
void compute_second_order_bias(const JointGroup& g, int begin, int end) {
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.update_bias(balls.blocks, balls.begin, balls.end, balls.settings);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    update_joint_bias(joint, work, g.solve->bodies, g.solve->settings);
  });
}
void warm_start_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.warm_start(balls.blocks, balls.begin, balls.end);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    warm_start_joint(joint, work, g.solve->bodies);
  });
}
void solve_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.solve(balls.blocks, balls.begin, balls.end, balls.settings);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    solve_joint(joint, work, g.solve->bodies, g.solve->settings, true);
  });
}
void prepare_other_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block < 0) prepare_joints(g, begin, end);
}
void relax_joints(const JointGroup& g, int begin, int end) {
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    balls.kernels.prepare(balls.blocks, balls.begin, balls.end, balls.arrays);
    return balls.kernels.relax(balls.blocks, balls.begin, balls.end);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    solve_joint(joint, work, g.solve->bodies, g.solve->settings, false);
    accumulate_joint_impulses(joint, work, g.solve->bodies);
  });
}

void begin_simd_articulations(const JointSolve& s, int begin, int end) {
  begin_bundles(s.bundles, begin, end, s.w, s.lane_start);
}
void finish_simd_articulations(const JointSolve& s, int begin, int end) {
  finish_bundles(s.bundles, begin, end, s.w);
}

}  // namespace gyre
