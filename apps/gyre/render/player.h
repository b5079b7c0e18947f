// What moves in a picture: a scene that is simulated or a recording that is played, as one thing. Time begins at 0 and only goes
// on; rewind() begins anew.
#pragma once

#include "scene/scene.h"

#include <gyre/replay.h>
#include <gyre/world.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gyre {

// A joint of the scene that can be seen: its ends in the frames of the bodies (world: no body).
struct SeenJoint {
  BodyId a, b;
  JointId id;  // null in a recording, which does not tell when a joint breaks
  Vec3 point_a, point_b;
  DVec3 place_a, place_b;  // the ends at the start
  const SceneJoint* joint = nullptr;
};

class Player {
 public:
  virtual ~Player() = default;

  virtual const World& world() const = 0;
  // The scene that tells colours, sensors and joints; null for a recording without one.
  virtual const Scene* scene() const = 0;
  // The bodies of that scene, in its order.
  virtual std::span<const BodyId> bodies() const = 0;
  virtual bool is_recording() const = 0;
  virtual double time() const = 0;  // s since the beginning
  // False at the end of a recording, and when the state is no longer finite.
  virtual bool step() = 0;
  virtual bool rewind(std::string& error) = 0;

  // What went wrong in step(); empty if nothing did.
  const std::string& problem() const { return problem_; }
  // What the user should know beside that; empty if nothing.
  const std::string& note() const { return note_; }

  // Steps until `seconds` is reached, at most half a step before or after it; false if the end came first.
  bool advance_to(double seconds);
  std::vector<SeenJoint> joints() const;

 protected:
  virtual std::span<const JointId> joint_ids() const { return {}; }
  std::string problem_, note_;
  double last_step_ = 0;  // s
};

// Opens a scene file or a recording; `look` names a scene file that says how a recording looks (may be empty). Null and an
// error if that fails.
std::unique_ptr<Player> open_player(const std::string& path, const std::string& look, int threads,
                                    std::string& error);

}  // namespace gyre
