#include "solver/articulation/ball_joint_transfer.h"

#include "solver/joint/pose_drive.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::size_t kLocalA = offsetof(LaneBall, local_a) / sizeof(float);
constexpr std::size_t kLocalB = offsetof(LaneBall, local_b) / sizeof(float);
constexpr std::size_t kOffset = offsetof(LaneBall, offset) / sizeof(float);
constexpr std::size_t kImpulse = offsetof(LaneBall, impulse) / sizeof(float);
constexpr std::size_t kTotal = offsetof(LaneBall, total) / sizeof(float);

std::size_t block_offset(const BallKernels& kernels, int block) {
  return std::size_t(block) * kernels.block_bytes;
}

void set_bodies(const BallKernels& kernels, void* blocks, int block, int lane, const LaneBallBodies& bodies) {
  const std::int32_t records[] = {bodies.read_a, bodies.read_b, bodies.write_a, bodies.write_b,
                                  bodies.inertia};
  std::byte* const first = static_cast<std::byte*>(blocks) + block_offset(kernels, block);
  for (int i = 0; i < 5; ++i) {
    const std::size_t at = std::size_t(i * kernels.width + lane) * sizeof(std::int32_t);
    std::memcpy(first + at, &records[i], sizeof(std::int32_t));
  }
}

// True if anything acts beside the joint's equations.
bool acts(const JointDetail& detail) {
  for (const JointAxisRecord& axis : detail.axes) {
    if (axis.motion != AxisMotion::locked && is_active(axis)) return true;
  }
  return has_drive(detail);
}

bool is_movable(const BodyInertia& inertia) {
  return inertia.inverse_mass > 0.0f || inertia.inverse != Sym3{};
}

}  // namespace

bool fits_ball_lane(const JointRecord& joint, const JointDetail* detail) {
  return joint.kind == JointKind::ball && joint.angular_impulse == Vec3{} &&
         (detail == nullptr || !acts(*detail));
}

void clear_balls(const BallKernels& kernels, void* blocks, int block) {
  std::memset(static_cast<std::byte*>(blocks) + block_offset(kernels, block), 0, kernels.block_bytes);
  for (int lane = 0; lane < kernels.width; ++lane) set_bodies(kernels, blocks, block, lane, {});
}

void begin_ball(const BallKernels& kernels, void* blocks, int block, int lane, const JointRecord& joint,
                Vec3 offset, float warm_scale, bool inertia_rotates, const BodyInertia* inertia) {
  const auto writes = [&](std::int32_t body) {
    return body != kNoBody && is_movable(inertia[body]) ? body : kNoBody;
  };
  set_bodies(kernels, blocks, block, lane,
             {joint.body_a, joint.body_b, writes(joint.body_a), writes(joint.body_b),
              inertia_rotates ? kInertiaRotates : kInertiaConstant});
  std::byte* const first =
      static_cast<std::byte*>(blocks) + block_offset(kernels, block) + kernels.first_float;
  float* const to = reinterpret_cast<float*>(first) + lane;
  const auto put = [&](std::size_t i, Vec3 v) {
    const std::size_t width = std::size_t(kernels.width);
    to[i * width] = v.x, to[(i + 1) * width] = v.y, to[(i + 2) * width] = v.z;
  };
  // Fields that are left out are prepared before they are read.
  put(kLocalA, joint.local_anchor_a);
  put(kLocalB, joint.local_anchor_b);
  put(kOffset, offset);
  put(kImpulse, warm_scale * joint.linear_impulse);
  put(kTotal, {});
}

void finish_ball(const BallKernels& kernels, const void* blocks, int block, int lane, JointRecord& joint) {
  const std::byte* const first =
      static_cast<const std::byte*>(blocks) + block_offset(kernels, block) + kernels.first_float;
  const float* const from = reinterpret_cast<const float*>(first) + lane;
  const auto vector_at = [&](std::size_t i) {
    const std::size_t width = std::size_t(kernels.width);
    return Vec3{from[i * width], from[(i + 1) * width], from[(i + 2) * width]};
  };
  joint.linear_impulse = vector_at(kImpulse);
  joint.total_linear = vector_at(kTotal);
  joint.total_angular = {};
}

}  // namespace gyre
