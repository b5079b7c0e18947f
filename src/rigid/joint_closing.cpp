// A fast body that a sweep takes back leaves its joints open by what it lost, up to the way of a whole step; taken back by speeds,
// that would show for some steps and throw what hangs there about. So what hangs together is led from where all of it was when the
// first body was stopped (joints hold there: all have gone the same part of their way) along the rest of its way, in a few parts. Of
// all motions that keep to the equations and limits of the joints, each part takes the one nearest to the bodies' own, by mass:
// Newton's method on the rows of the joints, whose impulses are displacements here (the projection of SHAKE, with limits: J.-P.
// Ryckaert, G. Ciccotti, H. Berendsen, 1977). Stopped bodies weigh more meanwhile, and are held where that is not enough, or they
// could be moved through what stopped them. What another goes into by that, its contacts take back.
#include "rigid/joint_closing.h"

#include "collision/continuous.h"
#include "math/rotation.h"
#include "rigid/joint_works.h"
#include "solver/body_newton.h"
#include "solver/constraint_rows.h"
#include "solver/solve_sweeps.h"

namespace gyre {

namespace {

constexpr float kPlay = 0.25f;           // of the size of a stopped body: its core stays where it was held
constexpr float kStoppedShare = 0.01f;   // of its inverse mass, with which it is moved
constexpr std::size_t kMostJoints = 48;  // around each stopped body; those of the body itself always
constexpr int kParts = 2;                // of the rest of the way
constexpr float kShortTurn = 0.2f;       // rad: where nothing turns further, one is enough
constexpr int kCorrections = 4;          // at the end of each
constexpr double kOpen = 3.0e-4;         // m or rad: less is left to the next step
constexpr double kClosed = 1.0e-3;       // m or rad: more, and it is no way to go
constexpr int kNewtonSteps = 20;
constexpr double kNewtonShare = 1.0e-4;  // of the largest impulse that closes one row alone
constexpr std::uint64_t kMostFactorWork = 20'000'000;
constexpr std::uint32_t kNone = 0xffffffffu;

bool is_moved(const RigidWorld& w, std::uint32_t body) {
  return is_movable(w.bodies.flags[body]) && w.bodies.flags[body].awake != 0;
}

// Whether its equations and limits are about where two bodies are, and not only about how far they have turned or run.
bool is_closed(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  const JointDetail* const detail = detail_of(w.joints, joint);
  return (detail == nullptr || !detail->disabled) && kind != JointKind::gear &&
         kind != JointKind::rack_and_pinion && kind != JointKind::pulley && kind != JointKind::mouse &&
         kind != JointKind::motor;
}

// A body of a group that hangs together.
struct Member {
  std::uint32_t body = 0;
  std::uint32_t stopped = kNone;  // place in the list of those that were
  bool held = false;              // stopped, and not to be moved any more
  bool moves = false;             // all of its joints are in the group; others go where they go anyway
  Vec3 start_moved;               // where the first of the group was stopped
  Quat start_orientation;
  Vec3 rest_moved, rest_turned;  // from there to where it is
};

// Where a body is.
struct Place {
  Vec3 moved;
  Quat orientation;
};

class Closing {
 public:
  Closing(RigidWorld& w, std::span<const StoppedBody> stopped, bool stays, Array<std::uint32_t>& moved,
          Arena& arena)
      : w_(w),
        stopped_(stopped),
        stays_(stays),
        moved_(moved),
        arena_(arena),
        place_(arena.make<std::uint32_t>(w.bodies.motion.size())),
        stopped_place_(arena.make<std::uint32_t>(w.bodies.motion.size())),
        is_done_(arena.make<std::uint8_t>(w.joints.records.size())) {
    for (std::uint32_t& place : place_) place = kNone;
    for (std::uint32_t& place : stopped_place_) place = kNone;
    for (std::uint8_t& done : is_done_) done = 0;
    for (std::uint32_t k = 0; k < stopped.size(); ++k) stopped_place_[stopped[k].body] = k;
  }

  void close_around(std::uint32_t body) {
    if (is_closed_already(body)) return;
    const ArenaScope scope(arena_);
    gather(body);
    if (joints_.empty() || !make_rows_room()) return forget();
    find_ways();
    follow();
    write();
    forget();
  }

 private:
  bool is_closed_already(std::uint32_t body) const {
    for (const std::uint32_t slot : w_.bodies.joints[body])
      if (is_closed(w_, slot) && is_done_[slot] == 0) return false;
    return true;
  }

  // ------------------------------------------------------------------------------------------------------ who hangs together

  std::uint32_t place_of(std::int32_t body) {
    std::uint32_t& place = place_[std::size_t(body)];
    if (place == kNone) {
      place = std::uint32_t(member_count_);
      members_[member_count_] = {};
      members_[member_count_].body = std::uint32_t(body);
      members_[member_count_++].stopped = stopped_place_[std::size_t(body)];
    }
    return place;
  }

  // Body by body, nearest first, each with all of its joints.
  void gather(std::uint32_t first) {
    const std::size_t most = max(kMostJoints, std::size_t(w_.bodies.joints[first].size()));
    joints_ = arena_.make<std::uint32_t>(most);
    members_ = arena_.make<Member>(most + 1);
    member_count_ = 0;
    std::size_t count = 0;
    place_of(std::int32_t(first));
    for (std::size_t next = 0; next < member_count_; ++next) {
      const std::uint32_t body = members_[next].body;
      if (!is_moved(w_, body)) continue;
      std::size_t fresh = 0;
      for (const std::uint32_t slot : w_.bodies.joints[body]) fresh += is_fresh(slot, count) ? 1 : 0;
      if (count + fresh > most) continue;
      members_[next].moves = true;
      for (const std::uint32_t slot : w_.bodies.joints[body]) {
        if (!is_fresh(slot, count)) continue;
        joints_[count++] = slot;
        const JointRecord& joint = w_.joints.records[slot];
        for (const std::int32_t end : {joint.body_a, joint.body_b})
          if (end != kNoBody) place_of(end);
      }
    }
    joints_ = joints_.first(count);
    members_ = members_.first(member_count_);
    for (const std::uint32_t slot : joints_) is_done_[slot] = 1;
  }
  bool is_fresh(std::uint32_t slot, std::size_t count) const {
    if (!is_closed(w_, slot)) return false;
    for (std::size_t i = 0; i < count; ++i)
      if (joints_[i] == slot) return false;
    return true;
  }
  void forget() {
    for (const Member& member : members_) place_[member.body] = kNone;
  }

  // The joints of the group by themselves, between bodies by their place in it: of what acts there only equations and limits.
  void copy_joints() {
    records_ = arena_.make<JointRecord>(joints_.size());
    details_ = arena_.make<JointDetail>(joints_.size());
    works_ = arena_.make<JointWork>(joints_.size());
    offsets_ = arena_.make<JointPlaces>(joints_.size());
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      JointRecord& joint = records_[i] = w_.joints.records[joints_[i]];
      offsets_[i] = joint_places(w_, joints_[i]);
      if (joint.body_a != kNoBody) joint.body_a = std::int32_t(place_[std::size_t(joint.body_a)]);
      if (joint.body_b != kNoBody) joint.body_b = std::int32_t(place_[std::size_t(joint.body_b)]);
      joint.motor_force = joint.stiffness = joint.damping = 0.0f;
      forget_impulses(joint);
      JointDetail* detail = nullptr;
      std::span<const PathPoint> path;
      if (const JointDetail* const own = detail_of(w_.joints, joints_[i])) {
        detail = &details_[i];
        *detail = *own;
        path = path_of(w_.joints, *own);
        forget_impulses(*detail);
        detail->drive.max_force = detail->drive.max_torque = detail->friction = 0.0f;
        for (JointAxisRecord& axis : detail->axes)
          axis.motor_force = axis.stiffness = axis.damping = axis.friction = 0.0f;
      }
      begin_joint(joint, detail, path, works_[i], 1.0f, arena_);
    }
  }

  // False if there is nothing to solve, or too much.
  bool make_rows_room() {
    copy_joints();
    const std::size_t count = members_.size();
    motion_ = arena_.make<BodyMotion>(count);
    inertia_ = arena_.make<BodyInertia>(count);
    for (BodyInertia& inertia : inertia_) inertia = {};  // of those that do not move it stays so
    before_ = arena_.make<Place>(count);
    orientations_ = arena_.make<Quat>(count);
    row_place_ = arena_.make<std::int32_t>(count);
    std::size_t movers = 0, rows = 0;
    for (std::size_t i = 0; i < count; ++i)
      row_place_[i] = members_[i].moves ? std::int32_t(movers++) : kNoRowBody;
    row_bodies_ = arena_.make<RowBody>(movers);
    const std::span<std::uint8_t> sizes = arena_.make<std::uint8_t>(movers);
    for (std::uint8_t& size : sizes) size = kLuBlock;
    const std::span<BlockEdge> edges = arena_.make<BlockEdge>(joints_.size());
    std::size_t edge_count = 0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const JointRecord& joint = records_[i];
      rows += std::size_t(count_joint_rows(joint, works_[i].detail, works_[i]));
      if (joint.body_a == kNoBody || joint.body_b == kNoBody || joint.body_a == joint.body_b) continue;
      const std::int32_t a = row_place_[std::size_t(joint.body_a)], b = row_place_[std::size_t(joint.body_b)];
      if (a != kNoRowBody && b != kNoRowBody) edges[edge_count++] = {std::uint32_t(a), std::uint32_t(b)};
    }
    if (rows == 0 || movers == 0) return false;
    if (!plan_blocks(sizes, edges.first(edge_count), kMostFactorWork, arena_, plan_)) return false;
    rows_ = arena_.make<Row>(rows);
    kept_ = arena_.make<float*>(rows);
    impulses_ = arena_.make<double>(rows);
    numbers_ = arena_.make<double>(body_newton_room(rows, plan_));
    return true;
  }

  // -------------------------------------------------------------------------------------------------------- where they go

  // All begin where the first was stopped.
  void find_ways() {
    float first = 1.0f;
    for (const Member& member : members_)
      if (member.stopped != kNone) first = min(first, stopped_[member.stopped].fraction);
    for (Member& member : members_) {
      const BodyMotion& motion = w_.bodies.motion[member.body];
      // What does not move may still hold the way of an earlier step.
      const BodyFlags& flags = w_.bodies.flags[member.body];
      const bool goes = flags.type != BodyType::fixed && flags.awake != 0 && flags.frozen == 0;
      const bool was_stopped = member.stopped != kNone;
      const Vec3 moved = was_stopped ? stopped_[member.stopped].moved : goes ? motion.moved : Vec3{};
      const Vec3 turned = was_stopped ? stopped_[member.stopped].turned : goes ? motion.turned : Vec3{};
      const Quat end = w_.bodies.orientations[member.body];
      member.start_moved = first * moved;
      member.start_orientation =
          normalized(from_rotation_vector(first * turned) * w_.bodies.places[member.body].orientation);
      member.rest_moved = (goes ? motion.moved : Vec3{}) - member.start_moved;
      member.rest_turned = to_rotation_vector(end * conjugate(member.start_orientation));
    }
  }

  // Part by part, as far as the joints can be closed without moving stopped bodies further than they may be: those that were are held,
  // and where that is no way either, all stay where the last part left them.
  void follow() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      motion_[i] = {};
      motion_[i].moved = members_[i].start_moved;
      orientations_[i] = members_[i].start_orientation;
      members_[i].held = false;
    }
    // What was off as the step began is no fault of the way.
    const double least = max(kClosed, 1.1 * correct());
    keep();
    const int parts = count_parts();
    for (int part = 0; part < parts && !stays_;) {
      move(1.0f / float(parts), 0.0);
      const double open = correct();
      const bool more_held = hold_those_moved_far(float(part + 1) / float(parts));
      if (!more_held && open < least) {
        keep();
        ++part;
        continue;
      }
      put_back();
      if (!more_held) return;
    }
  }
  int count_parts() const {
    float most = 0.0f;
    for (const Member& member : members_) most = max(most, length_squared(member.rest_turned));
    return most < kShortTurn * kShortTurn ? 1 : kParts;
  }
  double correct() {
    double open = move(0.0f, kOpen);
    for (int k = 1; k < kCorrections && !(open < kOpen); ++k) open = move(0.0f, kOpen);
    return open;
  }
  void keep() {
    for (std::size_t i = 0; i < members_.size(); ++i) before_[i] = {motion_[i].moved, orientations_[i]};
  }
  void put_back() {
    for (std::size_t i = 0; i < members_.size(); ++i)
      motion_[i].moved = before_[i].moved, orientations_[i] = before_[i].orientation;
  }

  // One part: a displacement is what a second would make of the velocities. Returns how far the joints were off; nothing moves where that
  // is less than `least`.
  double move(float share, double least) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      motion_[i].linear_velocity = share * members_[i].rest_moved;
      motion_[i].angular_velocity = share * members_[i].rest_turned;
    }
    constexpr JointSettings settings{1.0f, {1.0f, 1.0f, 0.0f}, false};
    set_bodies();
    const JointBodies bodies{motion_.data(), inertia_.data(), orientations_.data()};
    const RowFrame frame{row_bodies_, row_place_.data(), motion_.data(), 1.0};
    RowList list{rows_.data(), kept_.data(), 0};
    double open = 0.0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      place_joint(records_[i], works_[i], offsets_[i], bodies, settings);
      bend_joint(records_[i], works_[i], bodies, settings);
      add_joint_rows(records_[i], works_[i], settings, frame, list);
    }
    const std::span<Row> rows = rows_.first(std::size_t(list.count));
    double most = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].impulse = 0.0;
      impulses_[i] = 0.0;
      const double off = row_speed(rows[i], row_bodies_) - rows[i].wanted;
      const double wrong = rows[i].limits.low < 0.0 ? std::abs(off) : max(-off, 0.0);
      open = max(open, wrong);
      if (rows[i].diagonal > 0.0) most = max(most, wrong / rows[i].diagonal);
    }
    if (open < least) return open;
    if (most > 0.0) {
      const FrictionSet none;
      solve_body_newton({rows, row_bodies_, &none, &plan_}, kNewtonShare * most, kNewtonSteps, impulses_,
                        NumberRoom(numbers_));
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = impulses_[i];
      warm_start_rows(rows, row_bodies_);
    }
    advance();
    return open;
  }

  void set_bodies() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Member& member = members_[i];
      if (!member.moves) continue;
      inertia_[i] =
          world_inertia(w_.bodies.masses[member.body], w_.bodies.flags[member.body], orientations_[i]);
      const float share = member.held ? 0.0f : member.stopped != kNone ? kStoppedShare : 1.0f;
      inertia_[i].inverse_mass *= share;
      inertia_[i].inverse = share * inertia_[i].inverse;
      RowBody& body = row_bodies_[std::size_t(row_place_[i])];
      body = make_row_body(inertia_[i], w_.bodies.flags[member.body].locked_linear);
      body.linear = DVec3(motion_[i].linear_velocity), body.angular = DVec3(motion_[i].angular_velocity);
    }
  }
  void advance() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      BodyMotion& motion = motion_[i];
      if (row_place_[i] != kNoRowBody) {
        const RowBody& body = row_bodies_[std::size_t(row_place_[i])];
        motion.linear_velocity = to_float(body.linear);
        motion.angular_velocity = to_float(body.angular);
      }
      motion.moved += motion.linear_velocity;
      orientations_[i] = normalized(from_rotation_vector(motion.angular_velocity) * orientations_[i]);
    }
  }

  // Holds stopped bodies that were moved further than they may be. Returns whether there are more of these than before.
  bool hold_those_moved_far(float share) {
    bool any = false;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      Member& member = members_[i];
      if (member.stopped == kNone || !member.moves || member.held) continue;
      const Vec3 way = motion_[i].moved - (member.start_moved + share * member.rest_moved);
      const Quat planned = from_rotation_vector(share * member.rest_turned) * member.start_orientation;
      const Vec3 turn = to_rotation_vector(orientations_[i] * conjugate(planned));
      const BodyMass& mass = w_.bodies.masses[member.body];
      member.held = length(way) + length(turn) * mass.reach > kPlay * mass.size;
      any = any || member.held;
    }
    return any;
  }

  void write() {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Member& member = members_[i];
      if (!member.moves) continue;
      const std::uint32_t body = member.body;
      BodyMotion& motion = w_.bodies.motion[body];
      const BodyMass& mass = w_.bodies.masses[body];
      const Vec3 way = motion_[i].moved - motion.moved;
      const Vec3 turn = to_rotation_vector(orientations_[i] * conjugate(w_.bodies.orientations[body]));
      if (is_fast(way, turn, mass.reach, mass.size)) moved_.push_back(body);
      motion.moved = motion_[i].moved + Vec3{};
      motion.turned =
          to_rotation_vector(orientations_[i] * conjugate(w_.bodies.places[body].orientation)) + Vec3{};
      w_.bodies.orientations[body] = orientations_[i];
      w_.bodies.inertia[body] = world_inertia(mass, w_.bodies.flags[body], orientations_[i]);
    }
  }

  RigidWorld& w_;
  std::span<const StoppedBody> stopped_;
  bool stays_;
  Array<std::uint32_t>& moved_;
  Arena& arena_;
  std::span<std::uint32_t> place_;          // by body: among the group's
  std::span<std::uint32_t> stopped_place_;  // by body: among those that were stopped
  std::span<std::uint8_t> is_done_;         // by joint
  // Of the group.
  std::span<std::uint32_t> joints_;
  std::span<Member> members_;
  std::size_t member_count_ = 0;
  std::span<JointRecord> records_;
  std::span<JointDetail> details_;
  std::span<JointWork> works_;
  std::span<JointPlaces> offsets_;
  std::span<BodyMotion> motion_;
  std::span<BodyInertia> inertia_;
  std::span<Place> before_;
  std::span<Quat> orientations_;
  std::span<std::int32_t> row_place_;
  std::span<RowBody> row_bodies_;
  BlockPlan plan_;
  std::span<Row> rows_;
  std::span<float*> kept_;
  std::span<double> impulses_, numbers_;
};

}  // namespace

bool holds_point(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  const JointDetail* const detail = detail_of(w.joints, joint);
  return (detail == nullptr || !detail->disabled) &&
         (kind == JointKind::ball || kind == JointKind::hinge || kind == JointKind::fixed ||
          kind == JointKind::cone || kind == JointKind::universal);
}

void close_joints(RigidWorld& w, std::span<const StoppedBody> stopped, bool stays,
                  Array<std::uint32_t>& moved, Arena& arena) {
  Closing closing(w, stopped, stays, moved, arena);
  for (const StoppedBody& one : stopped) closing.close_around(one.body);
}

}  // namespace gyre
