// A fast body that a sweep takes back leaves its joints open by what it lost, up to the way of a whole step; taken back by speeds,
// that would show for some steps and throw what hangs there about. So the joints around it are closed at once, by places alone:
// Gauss-Seidel over the points of the nearest joints, each moved as an impulse at the joint would move them (F. Jourdan, P. Alart,
// M. Jean, "A Gauss-Seidel like algorithm to solve frictional contact problems", 1998, section on gaps; in games "non-linear
// Gauss-Seidel"). Who was stopped stays but for a little, or it could be moved through what stopped it. What another goes into by that, its contacts take back.
#include "rigid/joint_closing.h"

#include "math/rotation.h"

namespace gyre {

namespace {

constexpr float kOpen = 1.0e-3f;         // m: less is left to the next step
constexpr float kFree = 1.0e30f;         // m
constexpr float kPlay = 0.25f;           // of the size of a stopped body: its core stays where it was held
constexpr float kStoppedShare = 0.1f;    // of its inverse mass, with which it is moved
constexpr std::size_t kMostJoints = 48;  // around each stopped body
constexpr int kSweeps = 24;

// One end of a joint as the step will leave it.
struct End {
  std::int32_t body = kNoBody;
  DVec3 point;
  Vec3 arm;
  float inverse_mass = 0.0f;
  Sym3 inverse_inertia;
};

class Closing {
 public:
  Closing(RigidWorld& w, std::span<const std::uint32_t> stopped, Arena& arena)
      : w_(w),
        joints_(arena.make<std::uint32_t>(kMostJoints)),
        play_(arena.make<float>(w.bodies.motion.size())) {
    for (float& play : play_) play = kFree;
    for (const std::uint32_t body : stopped) play_[body] = kPlay * w.bodies.masses[body].size;
  }

  // The joints of a body and of what hangs on it, nearest first.
  void gather(std::uint32_t body) {
    count_ = 0;
    add_joints_of(body);
    for (std::size_t next = 0; next < count_; ++next) {
      const JointRecord& joint = w_.joints.records[joints_[next]];
      for (const std::int32_t end : {joint.body_a, joint.body_b}) {
        if (end != kNoBody && may_move(std::uint32_t(end))) add_joints_of(std::uint32_t(end));
      }
    }
  }

  void close() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      float most = 0.0f;
      for (std::size_t i = 0; i < count_; ++i) most = max(most, close(w_.joints.records[joints_[i]]));
      if (most < kOpen) return;
    }
  }

 private:
  bool may_move(std::uint32_t body) const {
    return is_movable(w_.bodies.flags[body]) && w_.bodies.flags[body].awake != 0;
  }

  void add_joints_of(std::uint32_t body) {
    for (const std::uint32_t slot : w_.bodies.joints[body]) {
      if (count_ == kMostJoints || !closes_joint(w_, slot)) continue;
      bool known = false;
      for (std::size_t i = 0; i < count_; ++i) known = known || joints_[i] == slot;
      if (!known) joints_[count_++] = slot;
    }
  }

  End end_of(std::int32_t body, Vec3 anchor, DVec3 world_anchor) const {
    if (body == kNoBody) return {kNoBody, world_anchor, {}, 0.0f, {}};
    const std::uint32_t i = std::uint32_t(body);
    const BodyMotion& motion = w_.bodies.motion[i];
    End end;
    end.body = body;
    end.arm = rotate(w_.bodies.orientations[i], anchor);
    end.point = w_.bodies.places[i].center + DVec3(motion.moved) + end.arm;
    if (!may_move(i) || !(play_[i] > 0.0f)) return end;
    const float share = play_[i] == kFree ? 1.0f : kStoppedShare;
    end.inverse_mass = share * motion.inverse_mass;
    end.inverse_inertia = share * w_.bodies.inertia[i].inverse;
    return end;
  }

  void move(const End& end, Vec3 push) {
    if (end.body == kNoBody || !(end.inverse_mass > 0.0f)) return;
    const std::uint32_t i = std::uint32_t(end.body);
    Vec3 way = end.inverse_mass * push, turn = end.inverse_inertia * cross(end.arm, push);
    if (play_[i] != kFree) {
      const float far = length(way) + length(turn) * w_.bodies.masses[i].reach;
      const float part = far > play_[i] ? play_[i] / far : 1.0f;
      way *= part;
      turn *= part;
      play_[i] -= part * far;
    }
    w_.bodies.motion[i].moved += way;
    if (turn == Vec3{}) return;
    w_.bodies.orientations[i] = normalized(from_rotation_vector(turn) * w_.bodies.orientations[i]);
    w_.bodies.inertia[i] = world_inertia(w_.bodies.masses[i], w_.bodies.flags[i], w_.bodies.orientations[i]);
  }

  // How far the joint was open.
  float close(const JointRecord& joint) {
    const End a = end_of(joint.body_a, joint.local_anchor_a, joint.world_anchor_a);
    const End b = end_of(joint.body_b, joint.local_anchor_b, joint.world_anchor_b);
    const Vec3 gap = difference(b.point, a.point);
    const float open = length(gap);
    if (!(open > 0.1f * kOpen)) return open;
    if (!(a.inverse_mass + b.inverse_mass > 0.0f)) return 0.0f;
    Sym3 k{a.inverse_mass + b.inverse_mass,
           a.inverse_mass + b.inverse_mass,
           a.inverse_mass + b.inverse_mass,
           0,
           0,
           0};
    for (const End* const end : {&a, &b}) {
      const Mat3 lever = skew(end->arm);
      k = k + to_symmetric(lever * (to_matrix(end->inverse_inertia) * transpose(lever)));
    }
    const Vec3 push = inverse(k) * gap;
    move(a, push);
    move(b, -push);
    return open;
  }

  RigidWorld& w_;
  std::span<std::uint32_t> joints_;
  std::span<float> play_;  // m, by body: how far it may still be moved
  std::size_t count_ = 0;
};

}  // namespace

bool closes_joint(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  const JointDetail* const detail = detail_of(w.joints, joint);
  return (detail == nullptr || !detail->disabled) &&
         (kind == JointKind::ball || kind == JointKind::hinge || kind == JointKind::fixed ||
          kind == JointKind::cone || kind == JointKind::universal);
}

void close_joints(RigidWorld& w, std::span<const std::uint32_t> stopped, Arena& arena) {
  Closing closing(w, stopped, arena);
  for (const std::uint32_t body : stopped) {
    closing.gather(body);
    closing.close();
  }
}

}  // namespace gyre
