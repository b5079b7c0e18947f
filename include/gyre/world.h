// class World: add, remove, change, step, read in bulk. One thread at a time may change or step a world; any number may
// read it while nobody does. Everything read as a span is valid until the next change or step.
//
// A wrong call (stale id, not finite, out of range) changes nothing, returns a null id or false, and is one entry in
// problems(). Every change is one command inside, so a recording cannot miss one.
#pragma once

#include <gyre/defs.h>
#include <gyre/events.h>
#include <gyre/fields.h>
#include <gyre/ids.h>
#include <gyre/joints.h>
#include <gyre/math.h>
#include <gyre/queries.h>
#include <gyre/result.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace gyre {

struct WorldState;  // src/world

// All bodies of one kind of set as parallel arrays; element i of each belongs to ids[i]. In order of id index.
struct BodyColumns {
  std::span<const BodyId> ids{};
  std::span<const Pose> poses{};              // world_from_body, of the origins
  std::span<const Vec3> linear_velocities{};  // of the centres of mass
  std::span<const Vec3> angular_velocities{};
};

// One contact point, for reading (positions in the world, impulses of the last step).
struct ContactPoint {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  DVec3 position{};
  Vec3 normal{};             // unit, from a to b
  Vec3 tangent_1{}, tangent_2{};  // unit: with the normal, the contact basis
  float separation = 0;    // m; negative: overlap
  float normal_impulse = 0;  // N s, summed over the step
  Vec3 friction_impulse{};   // N s on b, summed over the step; of the whole manifold, at its first point (zero at the others)
  Vec3 relative_velocity{};  // m/s, of b against a at the point, rotation included
  std::int32_t triangle = -1;  // of a mesh or height field, numbered as in CastHit: the deepest of those with this normal
};

struct JointReading {
  Vec3 force{};   // N on b, world frame, mean over the last step
  Vec3 torque{};  // N m on b about the anchor, world frame
  // Of what the joint leaves free. Hinge, cone (twist), universal (about axis), wheel (spin), gear and rack_and_pinion (a's
  // turning): rad, continuous beyond +-pi. Slider, path: m along it. Distance, pulley: m, the length. six_dof: linear_x.
  float position = 0;
  float velocity = 0;  // hinge, slider, distance; others: see joint_axis_reading()
};

// One of a joint's axes (JointAxis).
struct JointAxisReading {
  float position = 0;  // m or rad, continuous beyond +-pi
  float velocity = 0;  // m/s or rad/s, of b against a
  float force = 0;     // N or N m along it by limits, motor, spring and friction together, mean over the last step
};

// Whether the integrator can follow the springs that are forces (Stepping::springs): the fastest oscillation of all of them together,
// and the longest time that a body may move in one go. A sub-step is two of these.
struct SpringStability {
  int springs = 0;         // that are forces, of bodies that are awake
  double frequency = 0;    // Hz, undamped
  double damping_ratio = 0;
  double critical_step = 0;  // s; infinity if there are no such springs; 0 if the integrator gains energy at any step
  JointId joint{};         // the spring that takes the largest part
};

struct WorldCounts {
  int bodies = 0, awake_bodies = 0, shapes = 0, joints = 0;
  int pairs = 0;           // of overlapping fat boxes
  int touching = 0;        // pairs with a contact point that bears load or overlaps
  int contact_points = 0;
  int colors = 0;
};

// What the solvers sequential_impulses and lcp left in the last step; all zero with soft_step.
struct SolverReading {
  // N s, or N m s for rows that turn: by how much an impulse of any row misses what is complementary to its speed, the largest of
  // all rows and sub-steps (the residual of the natural map; docs/numerics.md).
  double residual = 0;
  int islands = 0;         // that were solved
  int direct_islands = 0;  // of these, by a direct method
  int largest_rows = 0;    // of the largest island
  int sweeps = 0;          // the most that an island took
};

struct Energy {
  double kinetic = 0;    // J
  double potential = 0;  // J, in gravity, zero at the world's origin
  double elastic = 0;    // J, in spring joints
};

struct Momentum {
  DVec3 linear{};   // kg m/s
  DVec3 angular{};  // kg m^2/s, about the world's origin
};

class World {
 public:
  // Refuses a def out of range with the field's name.
  static Result<World> create(const WorldDef& def = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // ------------------------------------------------------------------------------------------------ add and remove
  BodyId add_body(const BodyDef& body, const ShapeDef& shape);
  BodyId add_body(const BodyDef& body, std::span<const ShapeDef> shapes = {});
  bool remove_body(BodyId body);  // its shapes and joints too
  ShapeId add_shape(BodyId body, const ShapeDef& shape);  // mass is found anew unless the def overrode it
  bool remove_shape(ShapeId shape);
  JointId add_joint(const JointDef& joint);  // any of joints.h: add_joint(HingeDef{.a = ..., .b = ..., .anchor = ..., .axis = ...})
  bool remove_joint(JointId joint);
  FieldId add_field(const FieldDef& field);  // wakes everything, as every change of fields does
  bool remove_field(FieldId field);

  // --------------------------------------------------------------------------------------------------------- change
  bool set_pose(BodyId body, const Pose& pose);  // teleports: velocity is kept, contacts are found anew
  bool set_velocity(BodyId body, Vec3 linear, Vec3 angular);
  // The kinematic body reaches `pose` at the end of a step of `seconds`, and pushes what is in its way.
  bool move_kinematic(BodyId body, const Pose& pose, float seconds);
  bool set_type(BodyId body, BodyType type);
  bool set_gravity(Vec3 gravity);
  bool set_gravity_scale(BodyId body, float scale);
  bool set_damping(BodyId body, float linear, float angular);
  bool set_material(ShapeId shape, const Material& material);
  bool set_material_pair(const MaterialPair& pair);
  bool set_surface_rule(const SurfaceRule& rule);  // replaces the rule of the same id; wakes everything
  bool set_field(FieldId field, const FieldDef& def);
  bool set_filter(ShapeId shape, const Filter& filter);
  bool set_motor(JointId joint, const Motor& motor);
  // Replaces all that acts on one axis: limits, motor, spring, friction. six_dof: any; hinge, universal and cone (twist): angular_x;
  // universal: angular_z too; slider and path: linear_x; wheel: linear_x (suspension), angular_x (steering), angular_z (spin). Only
  // axes of a six_dof and steering can be locked: where they are then.
  bool set_joint_axis(JointId joint, JointAxis axis, const JointAxisDef& def);
  bool set_drive(JointId joint, const PoseDrive& drive);  // motor, mouse, cone
  // A joint that is not enabled does nothing, but keeps its bodies from colliding as before.
  bool set_joint_enabled(JointId joint, bool enabled);
  bool set_sleeping(bool enabled);
  bool set_awake(BodyId body, bool awake);  // false puts the body's whole island to sleep
  bool set_substeps(int substeps);
  // As in Stepping; a motion goes on from its present places and velocities.
  bool set_integrator(IntegratorKind integrator);
  bool set_springs(SpringKind springs);
  bool set_time_stepping(TimeStepping time, float tolerance = 1.0e-5f, int max_impacts = 128);
  bool set_solver(SolverKind solver, const SolverOptions& options = {});  // from the next step on; as WorldDef::stepping
  bool set_combine_rules(CombineRule friction, CombineRule restitution);  // of all contacts; wakes everything

  // How the world is computed, not what happens in it: never changes a bit, so neither recordings nor snapshots know it.
  // False and a problem if out of range, during a step, or (threads) if the host's own tasks are used.
  bool set_threads(int threads);  // as WorldDef::threads
  bool set_broad_phase(BroadPhaseKind kind);

  // Forces act during the next step and add up (D'Alembert); torques t = (p - COM) x f too. World frame.
  bool add_force(BodyId body, Vec3 force);                    // N, at the centre of mass
  bool add_force_at(BodyId body, Vec3 force, DVec3 point);    // N, at a world point
  bool add_torque(BodyId body, Vec3 torque);                  // N m
  // Impulses change the velocity at once.
  bool add_impulse(BodyId body, Vec3 impulse);                // N s, at the centre of mass
  bool add_impulse_at(BodyId body, Vec3 impulse, DVec3 point);
  bool add_angular_impulse(BodyId body, Vec3 impulse);        // N m s

  // Pushes every dynamic body that it reaches, at once; see ExplosionDef. Bodies in its way are those of now.
  bool explode(const ExplosionDef& explosion);

  // Moves the world on. `seconds` above 0 and at most 1; false and a problem otherwise.
  bool step(float seconds);

  // ----------------------------------------------------------------------------------------------------------- read
  bool exists(BodyId body) const;
  bool exists(ShapeId shape) const;
  bool exists(JointId joint) const;
  bool exists(FieldId field) const;
  // Of a stale id: the zero value.
  Pose pose(BodyId body) const;
  DVec3 center_of_mass(BodyId body) const;  // world
  Vec3 linear_velocity(BodyId body) const;
  Vec3 angular_velocity(BodyId body) const;
  Vec3 velocity_at(BodyId body, DVec3 point) const;  // of the body's material at a world point
  BodyType type(BodyId body) const;
  bool is_awake(BodyId body) const;
  std::uint64_t user_data(BodyId body) const;
  MassProperties mass_properties(BodyId body) const;  // body frame; mass 0 unless dynamic
  std::span<const ShapeId> shapes(BodyId body) const;
  BodyId body_of(ShapeId shape) const;
  const AnyShape* geometry(ShapeId shape) const;
  Transform local_transform(ShapeId shape) const;
  Material material(ShapeId shape) const;
  JointReading joint_reading(JointId joint) const;
  // As it acts: directions of length 1, the density that holds.
  FieldDef field(FieldId field) const;
  // Copies up to out.size() fields, by index; returns how many there are.
  std::size_t fields(std::span<FieldId> out) const;
  // Zero for axes that the joint's kind holds. Hinge: angular_x; slider, distance, path, pulley: linear_x; gear: angular_x (a) and
  // angular_y (b).
  JointAxisReading joint_axis_reading(JointId joint, JointAxis axis) const;
  bool joint_enabled(JointId joint) const;

  BodyColumns bodies() const;        // every body
  BodyColumns awake_bodies() const;  // those that moved or could have
  // Copies up to out.size() contact points in a fixed order; returns how many there are.
  std::size_t contacts(std::span<ContactPoint> out) const;

  // ---------------------------------------------------------------------------------------------------------- queries
  // See queries.h. None of them changes anything; any number of threads may ask at once while nobody changes or steps the
  // world. Functions that fill `out` return how many answers there are; where that is more than fit, the first are kept.

  std::optional<CastHit> cast_ray(DVec3 origin, Vec3 way, const QueryFilter& filter = {}) const;  // the nearest hit
  bool ray_hits(DVec3 origin, Vec3 way, const QueryFilter& filter = {}) const;                    // whether there is any
  // The first hit of every shape that the ray meets, by fraction.
  std::size_t cast_ray_all(DVec3 origin, Vec3 way, std::span<CastHit> out, const QueryFilter& filter = {}) const;

  std::optional<CastHit> cast_shape(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  bool shape_hits(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  std::size_t cast_shape_all(const ShapeCast& cast, std::span<CastHit> out, const QueryFilter& filter = {}) const;

  bool overlaps(const ShapePlace& place, const QueryFilter& filter = {}) const;
  // Every shape that the given one overlaps or touches, by index.
  std::size_t find_overlaps(const ShapePlace& place, std::span<Overlap> out, const QueryFilter& filter = {}) const;

  // The nearest point of any shape within `max_distance` (m, at least 0), and all shapes within it by distance.
  std::optional<ClosestPoint> closest_point(const ShapePlace& place, double max_distance,
                                            const QueryFilter& filter = {}) const;
  bool any_within(const ShapePlace& place, double max_distance, const QueryFilter& filter = {}) const;
  std::size_t find_closest(const ShapePlace& place, double max_distance, std::span<ClosestPoint> out,
                           const QueryFilter& filter = {}) const;
  // Every contact in which the shape overlaps another, deepest first: one of each convex shape or plane, up to eight of a
  // mesh or height field, whose inner edges give none.
  std::size_t find_penetrations(const ShapePlace& place, std::span<Penetration> out, const QueryFilter& filter = {}) const;
  // The first of them. Whether there is any, or a touch: overlaps.
  std::optional<Penetration> deepest_penetration(const ShapePlace& place, const QueryFilter& filter = {}) const;

  // Many at once, over the world's threads: out[i] answers question i, and is empty (no body) where nothing is met. An error
  // names the first question that cannot be asked, or spans of different length; then nothing is asked at all. One batch at
  // a time uses the threads; a batch asked meanwhile by another thread is answered by that thread alone.
  Error cast_rays(std::span<const Ray> rays, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  Error cast_shapes(std::span<const ShapeCast> casts, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  Error closest_points(std::span<const ShapePlace> places, double max_distance, std::span<ClosestPoint> out,
                       const QueryFilter& filter = {}) const;
  Error deepest_penetrations(std::span<const ShapePlace> places, std::span<Penetration> out,
                             const QueryFilter& filter = {}) const;
  // counts[i]: how many shapes place i overlaps.
  Error count_overlaps(std::span<const ShapePlace> places, std::span<std::uint32_t> counts,
                       const QueryFilter& filter = {}) const;
  // out[i]: 1 if question i meets, overlaps or is near anything, or else 0.
  Error rays_hit(std::span<const Ray> rays, std::span<std::uint8_t> out, const QueryFilter& filter = {}) const;
  Error shapes_hit(std::span<const ShapeCast> casts, std::span<std::uint8_t> out, const QueryFilter& filter = {}) const;
  Error places_overlap(std::span<const ShapePlace> places, std::span<std::uint8_t> out,
                       const QueryFilter& filter = {}) const;
  Error places_near(std::span<const ShapePlace> places, double max_distance, std::span<std::uint8_t> out,
                    const QueryFilter& filter = {}) const;
  // All answers of each question, in the order of the single question. The room is shared out alike: of out.size() = n * room
  // answers those of question i begin at out[i * room]. counts[i] is how many there are; where they are more than `room`, the
  // first are kept.
  Error cast_rays_all(std::span<const Ray> rays, std::span<CastHit> out, std::span<std::uint32_t> counts,
                      const QueryFilter& filter = {}) const;
  Error cast_shapes_all(std::span<const ShapeCast> casts, std::span<CastHit> out, std::span<std::uint32_t> counts,
                        const QueryFilter& filter = {}) const;
  Error find_overlaps_all(std::span<const ShapePlace> places, std::span<Overlap> out, std::span<std::uint32_t> counts,
                          const QueryFilter& filter = {}) const;
  Error find_closest_all(std::span<const ShapePlace> places, double max_distance, std::span<ClosestPoint> out,
                         std::span<std::uint32_t> counts, const QueryFilter& filter = {}) const;
  Error find_penetrations_all(std::span<const ShapePlace> places, std::span<Penetration> out,
                              std::span<std::uint32_t> counts, const QueryFilter& filter = {}) const;

  // ---------------------------------------------------------------------------------------------------- the last step
  const Events& events() const;  // of the last step
  // Copies up to out.size() pairs that touched in the last step and in the one before, in a fixed order; returns how many
  // there are. Pairs that sleep count as touching.
  std::size_t persisting(std::span<ContactPersist> out) const;
  std::span<const Problem> problems() const;  // since the last step began, the step included
  WorldCounts counts() const;
  StepReport step_report() const;            // how the last step was cut
  SpringStability spring_stability() const;  // of now; where a step is longer than the critical one, problems() says so too
  SolverReading solver_reading() const;
  double time() const;           // s
  std::uint64_t step_count() const;
  Vec3 gravity() const;
  int substeps() const;
  // A definition with every setting as it is now: what a new world is made of that shall be like this one.
  WorldDef def() const;
  Energy energy() const;
  Momentum momentum() const;
  float max_penetration() const;  // m, deepest contact point of the last step; 0 if none overlaps
  // 64-bit hash of the whole simulation state: the same for every thread count, SIMD width, compiler and platform.
  std::uint64_t hash() const;

  // The world's inside, for src/io and src/debug.
  WorldState& state() { return *state_; }
  const WorldState& state() const { return *state_; }
  explicit World(std::unique_ptr<WorldState> state);

 private:
  std::unique_ptr<WorldState> state_;
};

}  // namespace gyre
