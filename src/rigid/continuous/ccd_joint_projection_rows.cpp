#include "rigid/continuous/ccd_joint_projection_rows.h"

#include "rigid/continuous/ccd_joint_constraints.h"
#include "solver/rows/body_newton.h"
#include "solver/rows/constraint_rows.h"
#include "solver/rows/gauss_seidel.h"

namespace gyre {

namespace {

constexpr int kNewtonSteps = 20;
constexpr double kNewtonShare = 1.0e-4;  // of the largest impulse that closes one row alone
constexpr std::uint64_t kMaxProjectionWork = 20'000'000;

class RowProjection {
 public:
  RowProjection(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                Arena& arena)
      : w_(w),
        group_(group),
        bodies_(bodies),
        joints_(copy_projection_joints(w, group.joints, arena)),
        body_indices_(arena.make<std::int32_t>(w.bodies.motion.size())) {
    std::int32_t movers = 0;
    for (const ProjectionMember& member : group.members)
      body_indices_[member.body] = member.moves ? movers++ : kNoRowBody;
    row_bodies_ = arena.make<RowBody>(std::size_t(movers));
  }

  // False if there is nothing to solve, or too much.
  bool make_room(Arena& arena) {
    const std::span<std::uint8_t> sizes = arena.make<std::uint8_t>(row_bodies_.size());
    for (std::uint8_t& size : sizes) size = kLuBlock;
    const std::span<BlockEdge> edges = arena.make<BlockEdge>(joints_.records.size());
    std::size_t edge_count = 0, rows = 0;
    const auto index_of = [&](std::int32_t body) {
      return body == kNoBody ? kNoRowBody : body_indices_[std::size_t(body)];
    };
    for (std::size_t i = 0; i < joints_.records.size(); ++i) {
      const JointRecord& joint = joints_.records[i];
      rows += std::size_t(
          count_joint_rows(joint, joints_.constraints.work[i].detail, joints_.constraints.work[i]));
      const std::int32_t a = index_of(joint.body_a), b = index_of(joint.body_b);
      if (a != kNoRowBody && b != kNoRowBody && a != b)
        edges[edge_count++] = {std::uint32_t(a), std::uint32_t(b)};
    }
    if (rows == 0 || row_bodies_.empty()) return false;
    if (!plan_blocks(sizes, edges.first(edge_count), kMaxProjectionWork, arena, plan_)) return false;
    rows_ = arena.make<Row>(rows);
    stored_ = arena.make<float*>(rows);
    impulses_ = arena.make<double>(rows);
    numbers_ = arena.make<double>(body_newton_room(rows, plan_));
    return true;
  }

  // The largest error of the joints at the present poses, with bodies at rest.
  float find_error() {
    double largest = 0.0;
    for (const Row& row : make_rows()) largest = max(largest, missing(row));
    return float(largest * double(kProjectionStep));
  }

  void solve() {
    const std::span<Row> rows = make_rows();
    double largest = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      impulses_[i] = rows[i].impulse = 0.0;
      if (rows[i].diagonal > 0.0) largest = max(largest, missing(rows[i]) / rows[i].diagonal);
    }
    if (!(largest > 0.0)) return;
    const FrictionSet none;
    solve_body_newton({rows, row_bodies_, &none, &plan_}, kNewtonShare * largest, kNewtonSteps, impulses_,
                      NumberRoom(numbers_));
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = impulses_[i];
    warm_start_rows(rows, row_bodies_);
    for (const ProjectionMember& member : group_.members) {
      if (!member.moves) continue;
      const RowBody& body = row_bodies_[std::size_t(body_indices_[member.body])];
      bodies_.motion[member.body].linear_velocity = to_float(body.linear);
      bodies_.motion[member.body].angular_velocity = to_float(body.angular);
    }
  }

 private:
  double missing(const Row& row) const {
    const double off = row_speed(row, row_bodies_) - row.target_speed;
    return row.limits.low < 0.0 ? std::abs(off) : max(-off, 0.0);
  }

  std::span<Row> make_rows() {
    for (const ProjectionMember& member : group_.members) {
      if (!member.moves) continue;
      RowBody& body = row_bodies_[std::size_t(body_indices_[member.body])];
      const BodyMotion& motion = bodies_.motion[member.body];
      body = make_row_body(bodies_.inertia[member.body], w_.bodies.flags[member.body].locked_linear);
      body.linear = DVec3(motion.linear_velocity), body.angular = DVec3(motion.angular_velocity);
    }
    const JointBodies bodies{bodies_.motion.data(), bodies_.inertia.data(), bodies_.orientations.data()};
    const RowFrame frame{row_bodies_, body_indices_.data(), bodies_.motion.data(), double(kProjectionStep)};
    RowList list{rows_.data(), stored_.data(), 0};
    for (std::size_t i = 0; i < joints_.records.size(); ++i) {
      JointConstraint& work = joints_.constraints.work[i];
      prepare_joint(joints_.records[i], work, joints_.constraints.places[i], bodies, kProjectionSettings);
      update_joint_bias(joints_.records[i], work, bodies, kProjectionSettings);
      add_joint_rows(joints_.records[i], work, kProjectionSettings, frame, list);
    }
    return rows_.first(std::size_t(list.count));
  }

  const RigidWorld& w_;
  const ProjectionGroup& group_;
  ProjectionBodies bodies_;
  ProjectionJoints joints_;
  std::span<std::int32_t> body_indices_;  // by body: index among the bodies of the rows
  std::span<RowBody> row_bodies_;
  BlockPlan plan_;
  std::span<Row> rows_;
  std::span<float*> stored_;
  std::span<double> impulses_, numbers_;
};

}  // namespace

bool project_by_rows(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                     bool stop_at_impact, Arena& arena) {
  const ArenaScope scope(arena);
  RowProjection rows(w, group, bodies, arena);
  if (!rows.make_room(arena)) return false;
  ProjectionPath path(w, group, bodies, stop_at_impact);
  for (;;) {
    switch (path.next(rows.find_error())) {
      case ProjectionPath::Next::done:
        return true;
      case ProjectionPath::Next::measure:
        continue;
      case ProjectionPath::Next::solve:
        break;
    }
    rows.solve();
    path.advance();
  }
}

}  // namespace gyre
