// One world over the ranks of MPI.
//
// A unit is a body, or bodies that joints connect: it is never divided. One rank owns a unit and moves it. Ranks near it follow it: they have its
// bodies, with shapes, masses and contacts of their own, and take over the owner's motion after every exchange. So each rank solves the contacts
// of its units with all that touches them, and with a layer of bodies beyond (an overlapping Schwarz method: H. A. Schwarz, 1870). Fixed and
// kinematic bodies are in every rank.
#pragma once

#include "mpi/space_blocks.h"
#include "mpi/transport.h"
#include "scene/scene_runner.h"

#include <gyre/replica.h>

#include <string>
#include <vector>

namespace gyre {

struct RankedFigures {
  double cpu_seconds = 0;      // of this rank, in steps and bookkeeping, without waiting
  std::uint64_t followed = 0;  // units, summed over steps
  std::uint64_t migrations = 0;
};

class RankedWorld {
 public:
  // `whole` and `own` are two runners of the same scene. The width of the layer is in diameters of ordinary bodies.
  RankedWorld(Transport& transport, SceneRunner whole, SceneRunner own, double halo, bool exchange_steps);
  // The reason why a scene cannot be divided; empty if it can.
  static std::string find_obstacle(const Scene& scene);

  void step();
  void rebalance();
  // The state of all ranks as a scene: text on rank 0, empty on others.
  std::string gather_scene();

  const RankedFigures& figures() const { return figures_; }
  std::uint64_t steps() const { return steps_; }
  struct Quality {
    double kinetic = 0;          // J, of translation
    DVec3 momentum{};            // kg m/s
    DVec3 center{};              // m, of all mass
    double deepest_overlap = 0;  // m
    double awake = 0, bodies = 0;
  };
  Quality quality();  // of the whole world, on every rank

 private:
  enum class Role : std::uint8_t { absent, followed, owned };
  struct Unit {
    std::vector<std::uint32_t> bodies;  // of the scene
    std::vector<std::uint32_t> joints;
    std::vector<int> followers;  // ranks; of an owned unit
    Role role = Role::absent;
    int owner = 0;
    bool seen = false;  // a followed unit: its owner sent it
    bool owner_awake = true;
    float still_time = 0;  // s
  };

  void find_units();
  void add_unit(std::uint32_t unit, const ReplicaMotion* motions);
  void remove_unit(std::uint32_t unit);
  // Writes the motion of a unit; `own`: the receiver owns it from now on.
  void put_unit(Packet& to, std::uint32_t unit, bool own);
  // Reads a record and applies it.
  void take_unit(Packet& from, int sender);
  void take_all(std::vector<Packet>& in);
  void refresh_followed();
  void update_roles();
  void migrate();
  bool is_awake(const Unit& unit) const;
  void set_awake(const Unit& unit, bool awake);
  void count_still_time();
  void fall_asleep_together();
  void join_touching(std::vector<std::uint32_t>& parent);
  World& world() { return own_.world(); }

  Transport& transport_;
  SceneRunner whole_;  // the scene as it began: what bodies are made of, and where states are gathered
  SceneRunner own_;    // bodies that this rank owns or follows
  SpaceBlocks blocks_;
  double halo_ = 0;  // m
  int parts_ = 1;    // exchanges in a step
  std::vector<Unit> units_;
  std::vector<std::uint32_t> unit_of_;  // by body; kNoUnit: fixed or kinematic
  std::vector<BodyId> local_;           // by body; null: not here
  std::vector<std::uint32_t> here_;     // units with a role, ascending
  std::vector<Packet> out_;
  std::vector<ContactPair> pairs_;
  std::uint64_t steps_ = 0;
  RankedFigures figures_;
};

}  // namespace gyre
