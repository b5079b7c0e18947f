// A first look at all that will be in a movie, before any of it is drawn: where everything is over time. From that follow the
// camera that has it all in the picture, the size of the subject, and which walls would hide it.
#pragma once

#include "render/camera.h"
#include "render/draw_list.h"
#include "render/player.h"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace gyre {

// Which moments of the player make the frames: frame i is at start + i * interval.
struct FramePlan {
  double start = 0;     // s
  double interval = 0;  // s
  std::uint64_t count = 1;
};

// How somebody wants to look, where he said so.
struct CameraWish {
  std::optional<DVec3> eye, target;
  std::optional<float> field_of_view;  // rad
  float azimuth = 0.6f;                // rad, from +z towards +x: from where to look if there is no eye
  float elevation = 0.4f;              // rad above the horizon
  bool given_direction = false;        // the two above are wishes, not defaults
  float zoom = 1.0f;                   // above 1: nearer
};

class Survey {
 public:
  // Plays all frames of the plan from the player's present moment, and shortens the plan where it ends before.
  Survey(Player& player, FramePlan& plan);

  // The camera for pictures of that size: what was wished, what the scene says, and else one that has all that moves in the picture.
  Camera camera(const CameraWish& wish, int width, int height) const;
  // What the picture is of, for this camera.
  Subject subject(const Camera& camera) const;
  // Shapes that never move and hide much of what does.
  std::set<ShapeKey> hiding(const Camera& camera) const;
  // The range of what was read of soft matter.
  ReadingRange readings() const { return readings_.range(); }

 private:
  struct Ball {
    DVec3 center;
    float radius;
  };
  struct Wall {
    ShapeKey key;
    Pose pose;
    Aabb box;    // in the shape's frame
    bool solid;  // neither a mesh nor a height field, which are grounds rather than walls
  };
  void look_at_still(const Sight& sight);
  void look_at_moving(const Sight& sight);
  void look_at_soft(const SeenSoft& soft, std::span<const DVec3> vertices);
  void look_at_fluid(const SeenFluid& fluid);
  void thin_out();
  std::vector<Ball> important() const;

  std::vector<Ball> moving_;  // all bodies that move and ends of soft matter, at up to kMaxMoments moments
  std::vector<std::size_t> ends_;  // of each moment, in moving_
  std::uint64_t every_ = 1;        // each so-manieth frame is kept
  std::vector<Ball> still_;
  RangeFinder readings_;
  std::vector<Wall> walls_;
  std::optional<SceneView> view_;
  bool has_plane_ = false;
  bool has_weight_ = false;
  double lowest_still_ = 0, lowest_ = 0;  // m, along y
};

}  // namespace gyre
