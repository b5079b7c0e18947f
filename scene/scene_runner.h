// Runs a scene: makes a world of it, applies its timed forces, knows the names behind the ids, and can write the present
// state down as a scene again.
#pragma once

#include "scene/scene.h"
#include "scene/scene_error.h"

#include <gyre/world.h>

#include <span>
#include <string>
#include <vector>

namespace gyre {

class SceneRunner {
 public:
  // `file` is named in errors. Whatever the engine refuses is an error that names the place in the scene.
  static SceneResult<SceneRunner> create(Scene scene, const std::string& file, int threads = 1,
                                         int simd_width = 0);

  // Applies the forces of this moment and moves the world on by the scene's time step. False when the state is no longer
  // finite: then problem() says what happened, and to whom.
  bool step();
  const std::string& problem() const { return problem_; }
  // The first warning of the run: motion goes on, but is not what it should be. Empty: none yet.
  const std::string& warning() const { return warning_; }

  World& world() { return world_; }
  const World& world() const { return world_; }
  const Scene& scene() const { return scene_; }
  // The world's own count, so that both follow when a snapshot is restored.
  std::uint64_t steps() const { return world_.step_count(); }
  double time() const { return double(steps()) * scene_.world.time_step; }  // s

  // In the order of the scene.
  std::span<const BodyId> bodies() const { return bodies_; }
  std::span<const JointId> joints() const { return joints_; }
  std::span<const CouplingId> couplings() const { return couplings_; }
  std::span<const SoftId> ropes() const { return ropes_; }
  std::span<const SoftId> cloths() const { return cloths_; }
  std::span<const SoftId> soft_bodies() const { return soft_bodies_; }
  // Calls visit(soft, id) for each rope, cloth and soft body that is left, in this order.
  template <class Visit>
  void for_each_soft(Visit visit) const {
    const auto each = [&](const auto& softs, const std::vector<SoftId>& ids) {
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (world_.exists(ids[i])) visit(static_cast<const SceneSoft&>(softs[i]), ids[i]);
      }
    };
    each(scene_.ropes, ropes_);
    each(scene_.cloths, cloths_);
    each(scene_.soft_bodies, soft_bodies_);
  }
  std::span<const FluidId> gases() const { return gases_; }
  std::span<const FluidId> liquids() const { return liquids_; }
  // Calls visit(fluid, id) for each gas and liquid that is left, in this order.
  template <class Visit>
  void for_each_fluid(Visit visit) const {
    const auto each = [&](const auto& fluids, const std::vector<FluidId>& ids) {
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (world_.exists(ids[i])) visit(static_cast<const SceneFluid&>(fluids[i]), ids[i]);
      }
    };
    each(scene_.gases, gases_);
    each(scene_.liquids, liquids_);
  }
  // Where a probe is now, m, in the world.
  DVec3 probe_place(FluidId fluid, const SceneProbe& probe) const;
  // Null for the world or a body that is not of this scene.
  const SceneBody* body_of(BodyId id) const;

  // The scene as it stands now, to be simulated on: poses, velocities, the vertices of soft matter, the fields
  // and particles of fluids, what is left of the forces, emitters and joints, gravity and sub-steps. What was removed is left out.
  // Meshes stand in it, so that it can lie in another folder.
  Scene final_scene() const;

 private:
  SceneRunner(Scene scene, World world);
  void apply_forces();
  // Name of what a problem is about, as a beginning of its message.
  std::string subject_of(const Problem& problem) const;
  bool find_problem();
  bool find_soft_problem();
  void put_present_settings(SceneBody& body, BodyId id) const;
  void put_present_couplings(Scene& out, const std::vector<int>& places) const;
  void put_present_state(SceneSoft& soft, SoftSettings& settings, SoftId id,
                         const std::vector<int>& places) const;
  void put_present_softs(Scene& out, const std::vector<int>& places) const;
  std::vector<FluidEmitter> present_emitters(const std::vector<FluidEmitter>& emitters) const;
  void put_present_fluids(Scene& out) const;
  double present_length(const SceneJoint& joint) const;
  SceneJoint final_joint(std::size_t index) const;
  void put_present_state(SceneBody& body, BodyId id) const;

  Scene scene_;
  World world_;
  std::vector<BodyId> bodies_;
  std::vector<JointId> joints_;
  std::vector<CouplingId> couplings_;
  std::vector<SoftId> ropes_, cloths_, soft_bodies_;
  std::vector<FluidId> gases_, liquids_;
  std::vector<std::vector<DVec3>> anchors_;  // by index of the id: of held points, m, in the frame of what holds them
  std::vector<std::vector<int>> region_pins_;  // of each soft body: vertices that its region alone pins
  std::vector<std::size_t> forced_;  // bodies with forces
  std::vector<double> lengths_;      // of distance joints at the start
  std::string problem_;
  std::string warning_;
};

}  // namespace gyre
