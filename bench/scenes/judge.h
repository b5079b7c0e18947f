// How well a scene was simulated, from the poses of its bodies alone: the same figures for every engine.
#pragma once

#include <set>
#include <utility>
#include <vector>

#include "bench/scenes/judge_geometry.h"
#include "bench/scenes/scene.h"

namespace gyre::bench {

// What an engine says of one body.
struct BodyState {
  Pose pose;
  V3 velocity, spin;  // m/s of the origin, rad/s
  bool asleep = false;
};

struct Quality {
  double pen_max = 0, pen_p99 = 0, pen_mean = 0;  // m
  long near = 0, touching = 0,
       deep = 0;  // pairs closer than 2 cm, overlapping, overlapping by more than 5 cm
  double speed_max = 0, speed_mean = 0, spin_max = 0, energy = 0;
  double drift_max = 0, drift_mean = 0, sink_max = 0;
  double joint_max = 0, joint_mean = 0;  // m between the two anchors
  double limit_max = 0, limit_mean = 0;  // degrees beyond a limit, or between hinge axes
  double stretch = 0;                    // chain: total opening of the joints, % of its length
  double extension = 0;                  // chain: distance root to end over rest length - 1, %
  double height_mean = 0;                // of the centres of moving bodies
  long lost = 0, asleep = 0, fallen = 0;
  bool finite = true;
};

class Judge {
 public:
  explicit Judge(const Scene& scene);
  Quality look(const std::vector<BodyState>& bodies) const;

 private:
  // A joint's anchors and axes in its bodies' frames, and how b stood to a.
  struct JointPlace {
    V3 anchor_a, anchor_b, axis_a, axis_b;
    Quat start;
  };

  void look_at_bodies(const std::vector<BodyState>& bodies, Quality& q) const;
  void look_at_joints(const std::vector<BodyState>& bodies, Quality& q) const;
  void look_at_overlaps(const std::vector<BodyState>& bodies, Quality& q) const;
  bool is_lost(const Body& body, V3 place) const;
  void find_overlap(const Core& a, const Core& b, std::vector<double>& depths) const;
  void find_overlap(const Mesh& mesh, const Core& core, std::vector<double>& depths) const;

  const Scene& scene_;
  std::vector<JointPlace> joints_;
  std::set<std::pair<int, int>> jointed_;
  V3 low_{1e9, 1e9, 1e9}, high_{-1e9, -1e9, -1e9};  // of what moves, at the start
};

}  // namespace gyre::bench
