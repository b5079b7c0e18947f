// Ropes, cloths and solids within the sub-steps of a batch: their own step, and the rows that couple them with bodies and with each other.
//
// A row is a vertex against a point of a body: an attachment, or a contact with friction; or a point of an element, the mean of its corners: attached, or in contact.
//
// Contacts of cloths and solids, and attachments of their points, are solved in one system with the stiffness of soft bodies and the inertia of rigid ones, and with those among themselves
// (dynamics/soft/soft_surfaces.h).
//
// An attachment of a vertex, and a contact of a rope that bore load in the last sub-step, lets its vertex carry inertia of the body: K^-1 / n, with K the compliance of the point and n
// the number of rows that grip the body; of a fixed body kGripShare times its own mass. A contact that sticks does so in all directions, one that slides
// along its normal. The vertex and this part move as one through the whole solve, so a rope between heavy bodies, or over a pulley with loads
// of a thousand times its mass, knows what it is held by. The body then gets the momentum that its part has gained, and the difference
// that is left is the start of the next sub-step. A contact that pulls opens, and one that sticks beyond its cone slides: then the sub-step is solved
// anew, kGripPasses times at most. Contacts of ropes are solved further in rounds (dynamics/soft/soft_rounds.h).
//
// Soft matter moves once in a whole sub-step, bodies in each of its half-steps. A vertex gets the impulse of a row at once; a body gets an
// equal part of it in each half-step: the first when the row is solved, the others as the change by contacts, which starts the solve of
// every half-step anew. So both get the same momentum.
//
// The impulses of a sub-step are the start of the next: they act on vertices as forces from outside, so that they spread through the
// whole body exactly, and on bodies as the change by contacts does.
//
// In: contacts and attachments of a step, bodies, particles. Out: velocities of both, and impulses.
#pragma once

#include "base/arena/arena.h"
#include "dynamics/soft/soft_surfaces.h"
#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"
#include "soft/solver/soft_step.h"
#include "task/task_system.h"

#include <memory>
#include <vector>

namespace gyre {

enum class SoftRowKind : std::uint8_t { attachment, point, contact, face };

// A row of three.
struct SoftRow {
  std::uint32_t member = 0;  // index in SoftSolve::members
  std::uint32_t particle = 0;
  std::int32_t body = -1;     // -1: it does not move
  std::int32_t touched = -1;  // index of the body in SoftScratch::touched
  std::uint32_t source = 0;   // index among the entry's attachments, points, contacts or faces
  SoftRowKind kind = SoftRowKind::attachment;
  // A point, or a contact of anything but an exact rope: it is solved with the stiffness of all that it touches, and carries nothing.
  bool coupled = false;
  bool pushes = true;  // false: the body does not feel it, since the member is visual
  // Of a point or a face: the other corners, and the weights of all; the point of the row is their mean. The vertices carry nothing.
  int corners = 1;
  std::uint32_t others[3] = {};
  float weight[4] = {1.0f, 0.0f, 0.0f, 0.0f};
  SoftGrip grip = SoftGrip::open;
  std::int32_t carried = -1;  // index in SoftScratch::carried
  float static_friction = 0.0f, dynamic_friction = 0.0f;
  Vec3 normal{};            // contacts: out of the body, now
  Vec3 arm{};               // from the body's centre of mass, now
  Vec3 bias{};              // m/s, added to the relative velocity: what is wanted is that both cancel
  Sym3 body_compliance{};   // 1/kg
  Sym3 particle_inverse{};  // 1/kg, of the vertex alone
  Sym3 compliance{};        // 1/kg, of both
  Vec3 impulse{};           // N s on the vertex
  float correction = 0.0f;  // 1/s: the rate at which an error of place is removed
  Vec3 error{};             // m/s: relative velocity and bias when the round began
  Vec3 step{};              // N s: the change of impulse that is tried
  Vec3 carried_step{};      // N s: on the vertex, by what it carries

  bool is_contact() const { return kind == SoftRowKind::contact || kind == SoftRowKind::face; }
};

// Memory of one body of soft matter, which lasts; its arena is used within a half-step.
struct SoftWork {
  Arena arena;
  TaskSystem serial;  // of one worker, for a member that one worker steps
  Arena::Mark mark{};
  SoftStep step;
  SoftBody before;                            // what a sub-step that is solved anew begins with
  Array<Vec3> impulses, change;               // by particle
  std::uint32_t first_row = 0, last_row = 0;  // in SoftScratch::rows
  Array<Vec3> field_forces;   // N, by particle, of a visual entry: those of the whole step; else none
  std::uint32_t carried = 0;  // rows that carry, from first_row on in SoftScratch::carried
};

// A change of velocity of a body, m/s and rad/s.
struct VelocityChange {
  Vec3 linear{}, angular{};
};

struct SoftScratch {
  std::vector<std::unique_ptr<SoftWork>> works;  // by slot
  Array<std::uint32_t> shapes_near;
  Array<std::uint32_t> touched;  // bodies that move and are touched or held by soft matter, ascending
  Array<std::uint32_t> slots;    // of all there are
  Array<SoftRow> rows;
  Array<CarriedInertia> carried;  // room for one of each row, member by member
  Array<std::uint32_t> grips;     // rows that grip each touched body
  Array<double> loads;            // kg, of each touched body: the other bodies that bear on it
  // Of touched bodies: the change by the impulses that are tried; what the other half-steps of the sub-step are to bring.
  Array<VelocityChange> changes, pending;
  SoftSurfaces surfaces;
};

// The context of the stages below.
struct SoftSolve {
  RigidWorld* w = nullptr;
  SoftStore* store = nullptr;
  const FluidStore* fluids = nullptr;
  SoftScratch* scratch = nullptr;
  const SoftKernels* kernels = nullptr;
  std::span<const std::uint32_t> members{};  // slots; empty: the batch has no soft matter
  float h = 0.0f;                            // s, of a sub-step of soft matter
  int parts = 1;                             // half-steps of bodies in it
  float warm_scale = 0.0f;                   // of the impulses of the last step
  // The workers of the world. Only the calling thread is in a stage, so the stage may start loops on them.
  TaskSystem* tasks = nullptr;
  double time = 0.0;  // s, when the step began
};

// Holds the vertices that are attached to what does not yield now, and lets the others go. The solve does so, too; what comes before it in a step
// must not depend on whether the state was loaded.
void hold_attached(const RigidWorld& w, SoftEntry& entry);
// Before batches are found: lists slots and touched bodies, and marks these as constrained.
void gather_soft(RigidWorld& w, SoftStore& store, SoftScratch& scratch, Arena& arena);
// Makes the rows of a step; holds vertices that are attached to what does not yield.
void make_soft_rows(SoftSolve& s);

// The momentum that vertices get by what they carry, at their present velocities. To be found again by whoever changes these.
void find_carried_steps(SoftSolve& s, std::uint32_t member);

// Stages of all soft matter. Each has one block and shares its loops among the workers.
// Bodies have turned since they were given the impulses of the last half-step, which they get again: their moments follow. Without this a heavy body on a rope gains energy
// from its swing about the end of the rope.
void turn_soft_rows(SoftSolve& s, int begin, int end);
void begin_soft_members(SoftSolve& s, int begin, int end);
// The impulses of the last half-step on bodies.
void warm_start_soft_rows(SoftSolve& s, int begin, int end);
void solve_soft_rows(SoftSolve& s, int begin, int end);
void finish_soft_members(SoftSolve& s, int begin, int end);

// Returns the impulses to contacts and attachments.
void keep_soft_rows(SoftSolve& s);

}  // namespace gyre
