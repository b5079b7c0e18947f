#include "dynamics/program_builder.h"

#include "rigid/solve/energy_limiter.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Upper bounds for the lines that stand once in the program, and for those of a half-step beside a line for each colour.
constexpr std::size_t kLinesOnce = 24, kLinesPerHalfStep = 60;

}  // namespace

ProgramBuilder::ProgramBuilder(BatchContext& batch, int half_steps, Arena& arena)
    : batch_(batch),
      bodies_(count_blocks(int(batch.motion.moved.size()), batch.kernels.width)),
      fast_spinning_(count_blocks(int(batch.motion.fast_spinning.size()), kFastSpinningPerBlock)),
      orientations_(count_blocks(int(batch.motion.moved.size()), kBodiesPerBlock)),
      free_bodies_(count_blocks(int(batch.motion.free_bodies.size()), kBodiesPerBlock)),
      fields_(batch.motion.fields.blocks()),
      impacts_(batch.scratch.contacts.impacts.empty() ? 0 : 1),
      trees_(int(batch.contacts.forest.trees.size())),
      structures_(batch.contacts.structures.empty() ? 0 : 1),
      joint_slices_(batch.joints.groups.empty() ? 0 : kJointSlices),
      articulations_(int(batch.joints.articulations.scalar.size())),
      simd_articulations_(int(batch.joints.bundles.bundles.size())),
      joint_islands_(int(batch.joints.islands.size())),
      stiffened_(batch.joints.stiffened.empty() ? 0 : 1),
      row_islands_(batch.rows == nullptr ? 0 : int(batch.rows->islands.islands.size())),
      is_fused_(batch.is_fused()) {
  for (const ContactGroup& group : batch.contact_groups) contact_blocks_ += int(group.count);
  std::size_t held = 0;
  for (const ContactGroup& group : batch.contact_groups) held += group.held ? 1 : 0;
  const std::size_t joints = batch.joints.groups.size(), contacts = batch.contact_groups.size();
  room_ = arena.make<Stage>(kLinesOnce + 2 * contacts +
                            std::size_t(half_steps) *
                                (kLinesPerHalfStep + 3 * joints + 2 * contacts + kHeldIterations * held));
}

}  // namespace gyre
