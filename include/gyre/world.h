// class World: add, remove, change, step, read in bulk. One thread at a time may change or step a world. Any number of threads may
// read it and query it while nobody changes it. Every span that a World returns is valid until the next change or step.
//
// Refused calls: a call with a stale id, a number that is not finite or a value out of range changes nothing, returns false or a null
// id, and adds one entry to problems(). The returned value is enough to know whether a call was carried out; problems() says why one
// was not. A caller that checks every returned value need not read problems(), except for what a step itself reports there (bodies
// that stopped being finite, springs that the step cannot follow). A caller that ignores returned values finds every refusal there.
//
// Every change is one command inside the world, so a recording cannot miss one.
#pragma once

#include <gyre/coupling.h>
#include <gyre/defs.h>
#include <gyre/events.h>
#include <gyre/fields.h>
#include <gyre/fluid.h>
#include <gyre/ids.h>
#include <gyre/joints.h>
#include <gyre/math.h>
#include <gyre/queries.h>
#include <gyre/result.h>
#include <gyre/soft.h>
#include <gyre/stepping.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace gyre {

struct WorldState;  // src/world

// Bodies as parallel arrays: element i of each array belongs to ids[i]. In order of id index.
struct BodyColumns {
  std::span<const BodyId> ids{};
  std::span<const Pose> poses{};              // world_from_body, of the origins
  std::span<const Vec3> linear_velocities{};  // of the centres of mass
  std::span<const Vec3> angular_velocities{};
};

// One contact point of the last step, in the world frame.
struct ContactPoint {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  DVec3 position{};
  Vec3 normal{};             // unit, from a to b
  Vec3 tangent_1{}, tangent_2{};  // unit: with the normal, the contact basis
  float separation = 0;    // m; negative: overlap
  float normal_impulse = 0;  // N s, summed over the step
  Vec3 friction_impulse{};   // N s on b, summed over the step; of the whole manifold, at its first point (zero at the others)
  Vec3 relative_velocity{};  // m/s, of b relative to a at the point, rotation included
  std::int32_t triangle = -1;  // of a mesh or height field, numbered as in CastHit: the deepest of the triangles with this normal
};

// The kind of a joint, what it connects, and when it breaks.
struct JointInfo {
  JointKind kind = JointKind::ball;
  BodyId a{}, b{};                  // null = the world
  DVec3 anchor_a{}, anchor_b{};     // m, world, at the present poses; equal but for errors, and for kinds with two points
  float break_force = 0;            // N; 0 = unbreakable
  float break_torque = 0;           // N m; 0 = unbreakable
  bool collide_connected = false;
  bool enabled = true;
};

// The state of a joint.
struct JointState {
  Vec3 force{};   // N on b, world frame, mean over the last step
  Vec3 torque{};  // N m on b about the anchor, world frame
  // The position along the joint's free axis. Hinge, cone (twist), universal (about axis), wheel (spin), gear and rack_and_pinion (a's
  // turning): rad, continuous beyond +-pi. Slider, path: m along it. Distance, pulley: m, the length. six_dof: linear_x.
  float position = 0;
  float velocity = 0;  // hinge, slider, distance; others: see joint_axis_state()
};

// The state of one axis of a joint (JointAxis).
struct JointAxisState {
  float position = 0;  // m or rad, continuous beyond +-pi
  float velocity = 0;  // m/s or rad/s, of b relative to a
  float force = 0;     // N or N m along it by limits, motor, spring and friction together, mean over the last step
  float motor = 0;     // N or N m by the motor alone, in the last sub-step; at most Motor::max_force
};

// Tells whether the integrator can follow explicit springs (SpringKind::explicit_force). The figures are those of the fastest mode of all of
// them together. The critical step bounds half a sub-step, since bodies move twice in each.
struct SpringStability {
  int springs = 0;         // explicit springs of awake bodies
  double frequency = 0;    // Hz, undamped
  double damping_ratio = 0;
  double critical_step = 0;  // s; infinity if there are no such springs; 0 if the integrator gains energy at any step
  JointId joint{};         // the spring with the largest share of the mode
};

// How much there is in the world.
struct WorldStats {
  int bodies = 0, awake_bodies = 0, shapes = 0, joints = 0;
  int pairs = 0;           // of shapes whose fat boxes overlap
  int touching = 0;        // pairs with a contact point that bears load or overlaps
  int contact_points = 0;
  int colors = 0;          // of the constraint graph
  int softs = 0, soft_vertices = 0;  // ropes, cloths and solids
  int fluids = 0, liquid_particles = 0;  // gases and liquids
};

// How well the solvers sequential_impulses and lcp solved the last step; all zero with soft_step.
struct SolverStats {
  // N s, or N m s for angular rows: the residual of the natural map, largest over all rows and sub-steps. It measures by how much an
  // impulse misses complementarity with its row's velocity (docs/numerics.md).
  double residual = 0;
  int islands = 0;         // solved islands
  int direct_islands = 0;  // of these, solved by a direct method
  int largest_rows = 0;    // rows of the largest island
  int sweeps = 0;          // largest number of sweeps over an island
};

struct Energy {
  double kinetic = 0;    // J
  double potential = 0;  // J, in gravity, zero at the world's origin
  double elastic = 0;    // J, in spring joints
  double soft_elastic = 0;  // J, in ropes, cloths and solids
};

struct Momentum {
  DVec3 linear{};   // kg m/s
  DVec3 angular{};  // kg m^2/s, about the world's origin
};

// Mass properties that replace those of the shapes. What is left out follows from the shapes and their densities.
struct MassDef {
  std::optional<float> mass{};           // kg; scales the shapes' inertia unless inertia is given too
  std::optional<Vec3> center_of_mass{};  // m, body frame
  std::optional<Sym3> inertia{};         // kg m^2, about the centre of mass, body axes
};

class World {
 public:
  // Refuses a definition out of range; the error names the field.
  static Result<World> create(const WorldDef& def = {});
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  // ------------------------------------------------------------------------------------------------ add and remove
  BodyId add_body(const BodyDef& body, const ShapeDef& shape);
  BodyId add_body(const BodyDef& body, std::span<const ShapeDef> shapes = {});
  bool remove_body(BodyId body);  // with its shapes and joints
  ShapeId add_shape(BodyId body, const ShapeDef& shape);  // mass is computed anew unless BodyDef overrode it
  bool remove_shape(ShapeId shape);
  JointId add_joint(const JointDef& joint);  // any of joints.h: add_joint(HingeDef{.a = ..., .b = ..., .anchor = ..., .axis = ...})
  bool remove_joint(JointId joint);  // with its couplings
  // A linear equation between axes of joints (coupling.h). A mechanism with couplings has at most 256 axes.
  CouplingId add_coupling(const CouplingDef& coupling);
  bool remove_coupling(CouplingId coupling);
  FieldId add_field(const FieldDef& field);  // wakes every body, as every change of fields does
  bool remove_field(FieldId field);
  SoftId add_rope(const RopeDef& rope);
  SoftId add_cloth(const ClothDef& cloth);
  SoftId add_solid(const SolidDef& solid);
  bool remove_soft(SoftId soft);
  FluidId add_gas(const GasDef& gas);
  FluidId add_liquid(const LiquidDef& liquid);
  bool remove_fluid(FluidId fluid);

  // --------------------------------------------------------------------------------------------------------- change
  bool set_pose(BodyId body, const Pose& pose);  // teleports: keeps the velocity, drops the contacts
  bool set_velocity(BodyId body, Vec3 linear, Vec3 angular);
  // Sets the velocity with which the kinematic body reaches `pose` at the end of a step of `seconds`. It pushes bodies in its path.
  bool move_kinematic(BodyId body, const Pose& pose, float seconds);
  // Many of them, for moving platforms and animated scenes: poses[i] is that of bodies[i]. False if any is refused or the spans differ in
  // length; the others are carried out.
  bool move_kinematics(std::span<const BodyId> bodies, std::span<const Pose> poses, float seconds);
  bool set_type(BodyId body, BodyType type);
  // Replaces BodyDef::mass, center_of_mass and inertia. The origin of the body stays where it is.
  bool set_mass(BodyId body, const MassDef& mass);
  bool set_locked_axes(BodyId body, const LockedAxes& locked);
  // False takes the body out of the simulation: its contacts end with their events, no query or sensor finds it, its joints idle, and
  // forces and impulses on it are ignored. It counts neither in energy() nor in momentum(). True puts it back with the pose and the velocity
  // that it had or that were set meanwhile. Vertices of soft matter that are attached to it stay where it is.
  bool set_enabled(BodyId body, bool enabled);
  bool set_continuous(BodyId body, bool continuous);  // BodyDef::continuous
  bool set_can_sleep(BodyId body, bool can_sleep);    // BodyDef::can_sleep; false wakes it
  bool set_user_data(BodyId body, std::uint64_t user_data);
  // Two bodies that ignore each other have no contacts, as two that a joint connects. It does not matter which is a. The table forgets a body
  // that is removed. Sensors of one do not see the other; queries find both as before.
  bool set_pair_ignored(BodyId a, BodyId b, bool ignored);
  bool set_gravity(Vec3 gravity);
  bool set_gravity_scale(BodyId body, float scale);
  bool set_damping(BodyId body, float linear, float angular);
  bool set_material(ShapeId shape, const Material& material);
  bool set_material_pair(const MaterialPair& pair);
  bool set_surface_rule(const SurfaceRule& rule);  // replaces the rule of the same id; wakes every body
  bool set_field(FieldId field, const FieldDef& def);
  bool set_filter(ShapeId shape, const Filter& filter);
  bool set_density(ShapeId shape, float density);  // ShapeDef::density; the mass of the body is computed anew
  bool set_sensor(ShapeId shape, bool sensor);     // likewise, since sensors have no mass
  // Another form, or another place in the body. Contacts begin anew, and the mass of the body is computed anew.
  bool set_geometry(ShapeId shape, const AnyShape& geometry);
  bool set_local_transform(ShapeId shape, const Transform& local);
  bool set_user_data(ShapeId shape, std::uint64_t user_data);
  bool set_motor(JointId joint, const Motor& motor);
  // Replaces all that acts on one axis: limits, motor, spring, friction. six_dof: any; hinge, universal and cone (twist): angular_x;
  // universal: angular_z too; slider and path: linear_x; wheel: linear_x (suspension), angular_x (steering), angular_z (spin). Only
  // axes of a six_dof and steering can be locked: where they are then.
  bool set_joint_axis(JointId joint, JointAxis axis, const JointAxisDef& def);
  bool set_drive(JointId joint, const PoseDrive& drive);  // motor, mouse, cone
  bool set_break_load(JointId joint, float force, float torque);  // N and N m at which it breaks; 0 = unbreakable
  // A joint that is not enabled does nothing, but keeps its bodies from colliding as before.
  bool set_joint_enabled(JointId joint, bool enabled);
  bool set_sleeping(bool enabled);
  bool set_sleep_share(float share);               // WorldDef::sleep_share
  bool set_sleep_speed(BodyId body, float speed);  // BodyDef::sleep_speed
  bool set_awake(BodyId body, bool awake);  // false puts the body's whole island to sleep
  bool set_substeps(int substeps);
  // The settings of Stepping (stepping.h); they hold from the next step on. Poses and velocities stay as they are.
  bool set_integrator(IntegratorKind integrator);
  bool set_springs(SpringKind springs);
  bool set_time_stepping(TimeStepping time, float tolerance = 1.0e-5f, int max_impacts = 128);
  bool set_solver(SolverKind solver, const SolverOptions& options = {});
  bool set_combine_rules(CombineRule friction, CombineRule restitution);  // of all contacts; wakes every body

  // How the world is computed. These settings never change a bit of the result, so recordings and snapshots do not contain them.
  // Refused during a step; set_threads also if the host's own tasks are used.
  bool set_threads(int threads);  // as WorldDef::threads
  bool set_broad_phase(BroadPhaseKind kind);

  // Forces and torques add up and act during the next step. World frame.
  bool add_force(BodyId body, Vec3 force);                    // N, at the centre of mass
  bool add_force_at(BodyId body, Vec3 force, DVec3 point);    // N, at a world point: with the torque (point - centre) x force
  bool add_torque(BodyId body, Vec3 torque);                  // N m
  // N or N m along one axis of a joint, on b and opposite on a, as a motor of that force would act: for controllers that compute torques. The
  // axes are those that set_joint_axis() takes; a joint that is not enabled or has no such axis refuses.
  bool add_joint_load(JointId joint, JointAxis axis, float load);
  // Impulses change the velocity at once.
  bool add_impulse(BodyId body, Vec3 impulse);                // N s, at the centre of mass
  bool add_impulse_at(BodyId body, Vec3 impulse, DVec3 point);
  bool add_angular_impulse(BodyId body, Vec3 impulse);        // N m s

  // Soft matter (soft.h). The vertex keeps its present place in the frame of the body, and turns freely there; it follows a moving body within
  // the step. It no longer collides with that body, nor do its neighbours
  // as far as they are inside it now. A second call replaces the first.
  bool attach(SoftId soft, int vertex, BodyId body);
  bool pin(SoftId soft, int vertex);      // to the world: it stays where it is
  bool release(SoftId soft, int vertex);  // from a body or the world; true if it was free already
  // The same of a point between vertices of a cloth or solid, which turns freely about it: a ball joint between the point and the body. Both ways: the body hangs on the point, too.
  // A point stays with its element where something tears. There may be several of one element. Ropes and what is visual are held at vertices: they refuse.
  bool attach_point(SoftId soft, const SoftPoint& point, BodyId body);
  bool pin_point(SoftId soft, const SoftPoint& point);
  bool release_points(SoftId soft, BodyId body);  // all that this body holds, or the world if it is null; true also if there are none
  // Positions (m) and velocities (m/s) of all vertices at once; either may be empty and stays then. Attached vertices stay attached, where
  // they are put.
  bool set_vertices(SoftId soft, std::span<const DVec3> positions, std::span<const Vec3> velocities);
  // Keeps every vertex near an animated target, as a coat near a body: within distances[i] (m; below 0: free) of targets[i] (m), and in front of the plane that
  // lies backstops[i] (m) behind the target, seen along normals[i]. Normals and backstops may be empty. Called before each step in which
  // the targets move; the limits stay until the next call, and empty targets end them. docs/soft.md: Skinning
  bool set_vertex_limits(SoftId soft, std::span<const DVec3> targets, std::span<const float> distances, std::span<const Vec3> normals,
                         std::span<const float> backstops);

  // Fluids (fluid.h). Replaces all emitters.
  bool set_emitters(FluidId fluid, std::span<const FluidEmitter> emitters);
  // Moves the box with all that is in it: velocities relative to the box stay.
  bool set_fluid_pose(FluidId fluid, const Pose& pose);
  // The box moves with this velocity from now on (m/s of the origin of its axes, rad/s, in the world). The fluid keeps its velocity in the
  // world until walls push it.
  bool set_fluid_velocity(FluidId fluid, Vec3 linear, Vec3 angular);

  // Gives an impulse at once to every dynamic body within range; see ExplosionDef.
  bool explode(const ExplosionDef& explosion);

  // Advances the world by `seconds`: above 0 and at most 1, otherwise it is refused.
  bool step(float seconds);

  // ----------------------------------------------------------------------------------------------------------- read
  bool exists(BodyId body) const;
  bool exists(ShapeId shape) const;
  bool exists(JointId joint) const;
  bool exists(CouplingId coupling) const;
  bool exists(FieldId field) const;
  bool exists(SoftId soft) const;
  bool exists(FluidId fluid) const;
  // Each returns the zero value for a stale id.
  Pose pose(BodyId body) const;
  DVec3 center_of_mass(BodyId body) const;  // world
  Vec3 linear_velocity(BodyId body) const;
  Vec3 angular_velocity(BodyId body) const;
  Vec3 velocity_at(BodyId body, DVec3 point) const;  // m/s, of the body's material at a world point
  BodyType type(BodyId body) const;
  bool is_awake(BodyId body) const;
  float sleep_speed(BodyId body) const;  // m/s, as it was set: 0 = by sleep_share()
  std::uint64_t user_data(BodyId body) const;
  float linear_damping(BodyId body) const;   // 1/s, as it was set
  float angular_damping(BodyId body) const;  // 1/s
  float gravity_scale(BodyId body) const;
  bool continuous(BodyId body) const;  // BodyDef::continuous
  bool can_sleep(BodyId body) const;   // BodyDef::can_sleep
  bool enabled(BodyId body) const;     // by set_enabled()
  LockedAxes locked_axes(BodyId body) const;
  // Copies up to out.size() joints of the body, in order of index; returns how many there are.
  std::size_t joints(BodyId body, std::span<JointId> out) const;
  bool pair_ignored(BodyId a, BodyId b) const;  // by set_pair_ignored()
  MassProperties mass_properties(BodyId body) const;  // body frame; mass 0 unless dynamic
  std::span<const ShapeId> shapes(BodyId body) const;
  BodyId body_of(ShapeId shape) const;
  const AnyShape* geometry(ShapeId shape) const;
  Transform local_transform(ShapeId shape) const;
  Material material(ShapeId shape) const;
  Filter filter(ShapeId shape) const;
  bool is_sensor(ShapeId shape) const;
  float density(ShapeId shape) const;  // kg/m^3, as it was set
  std::uint64_t user_data(ShapeId shape) const;
  JointInfo joint_info(JointId joint) const;
  JointState joint_state(JointId joint) const;
  // Copies up to out.size() ids, in order of index; returns how many couplings there are.
  std::size_t couplings(std::span<CouplingId> out) const;
  CouplingDef coupling(CouplingId coupling) const;
  CouplingState coupling_state(CouplingId coupling) const;
  // The definition in force: directions have length 1, an optional density has its default.
  FieldDef field(FieldId field) const;
  // Copies up to out.size() ids, in order of index; returns how many fields there are.
  std::size_t fields(std::span<FieldId> out) const;
  // Zero for axes that this kind of joint constrains. Hinge: angular_x; slider, distance, path, pulley: linear_x; gear: angular_x (a) and
  // angular_y (b).
  JointAxisState joint_axis_state(JointId joint, JointAxis axis) const;
  bool joint_enabled(JointId joint) const;
  // The limits, motors and springs of an axis as they are in force; the zero value for axes that set_joint_axis() does not take. Then the
  // values that set_motor() and set_drive() set.
  JointAxisDef joint_axis_def(JointId joint, JointAxis axis) const;
  Motor motor(JointId joint) const;
  PoseDrive drive(JointId joint) const;
  // Rows of the tables of materials; with ids 0 if there is no such row. The order of a and b does not matter.
  MaterialPair material_pair(std::uint16_t a, std::uint16_t b) const;
  SurfaceRule surface_rule(std::uint16_t id) const;
  // Ropes, cloths and solids. Copies up to out.size() ids, in order of index; returns how many there are.
  std::size_t softs(std::span<SoftId> out) const;
  SoftInfo soft_info(SoftId soft) const;
  SoftVertices vertices(SoftId soft) const;
  // The surface: three vertices each, counter-clockwise seen from outside (of a cloth: from one side). None of a rope.
  std::span<const std::uint32_t> soft_triangles(SoftId soft) const;
  // The point of a cloth or solid that is nearest to a place, m in the world: inside a solid the place itself. Its weights are zero of a rope.
  SoftPoint nearest_soft_point(SoftId soft, DVec3 place) const;
  // The elements of a solid as it is now, also of one made from a box or a surface. Copies up to out.size() numbers, four vertices a
  // tetrahedron; returns how many numbers there are, 0 for ropes and cloths. At rest each tetrahedron has a positive volume.
  std::size_t solid_tetrahedra(SoftId solid, std::span<std::uint32_t> out) const;
  // The stress in these elements, Pa, in their order: that of von Mises, sqrt(3/2 s:s) with s the deviator of the stress of the corotated law. It is what
  // SolidDef::yield_stress is compared with, for small strain; turning and even pressure leave it at zero. Copies up to out.size() numbers; returns how many there are, one a
  // tetrahedron. Source: R. von Mises, 1913.
  std::size_t solid_stress(SoftId solid, std::span<float> out) const;
  // The strain in the elements: of segments of a rope from its start on, triangles in the order of soft_triangles, tetrahedra in that of solid_tetrahedra. It is stretch less 1, so 0.01 where an element is 1 %
  // longer than at rest and -0.01 where it is shorter; of the principal strains of a triangle or tetrahedron the one of largest size. What has flowed is at rest. Copies up to
  // out.size() numbers; returns how many there are. Source: A. J. C. B. de Saint-Venant, 1855 (principal strains).
  std::size_t soft_strain(SoftId soft, std::span<float> out) const;
  // The surface that a solid was made of (SolidDef::surface), carried along by its tetrahedra: for pictures. Copies up to out.size() places of
  // its vertices, in the order of the definition; returns how many there are, 0 without such a surface.
  std::size_t soft_surface(SoftId soft, std::span<DVec3> out) const;
  // A definition with which a cloth or solid goes on as it is: its vertices are in it and, if it was torn, its elements. What a solid has flowed is not.
  ClothDef cloth_def(SoftId cloth) const;
  SolidDef solid_def(SoftId solid) const;
  std::span<const std::uint32_t> soft_surface_triangles(SoftId soft) const;  // counter-clockwise seen from outside
  // Gases and liquids. Copies up to out.size() ids, in order of index; returns how many there are.
  std::size_t fluids(std::span<FluidId> out) const;
  FluidInfo fluid_info(FluidId fluid) const;
  // Zero for bodies that are not dynamic, and before the first step.
  FluidLoad fluid_load(BodyId body) const;
  // Points outside the box read the nearest point inside.
  FluidProbe probe(FluidId fluid, DVec3 point) const;
  // The velocity (m/s) at many points; as many are read as both spans have room for.
  void sample_velocity(FluidId fluid, std::span<const DVec3> points, std::span<Vec3> out) const;
  // A field of cell centres, x fastest, then y, then z: kg/m^3, K, Pa or m/s. Copies up to out.size() numbers; returns how many there are.
  std::size_t fluid_field(FluidId fluid, FluidField field, std::span<float> out) const;
  // The particles of a liquid, m and m/s. Copies up to the room of each span; returns how many there are.
  std::size_t liquid_particles(FluidId fluid, std::span<DVec3> positions, std::span<Vec3> velocities) const;
  // The surface of a liquid as triangles, counter-clockwise seen from outside, made anew at each call. Copies up to the room of each span.
  FluidSurfaceSize liquid_surface(FluidId fluid, std::span<Vec3> vertices, std::span<std::uint32_t> indices) const;
  // A definition with which the fluid goes on as it is: its fields or particles are in it.
  GasDef gas_def(FluidId fluid) const;
  LiquidDef liquid_def(FluidId fluid) const;
  // Pairs of an edge and a triangle without a common vertex that intersect, of one or of two cloths or solids: exact, for tests, and slow.
  std::size_t cloth_crossings() const;

  // Copied at most once after a change, by the first thread that asks; both stay valid side by side until the next change or step.
  BodyColumns bodies() const;        // every body
  BodyColumns awake_bodies() const;  // awake dynamic and kinematic bodies
  // Copies up to out.size() contact points in a fixed order; returns how many there are.
  std::size_t contacts(std::span<ContactPoint> out) const;
  // The same of one body or shape: found by an index, so that a game may ask for each of its characters.
  std::size_t body_contacts(BodyId body, std::span<ContactPoint> out) const;
  std::size_t shape_contacts(ShapeId shape, std::span<ContactPoint> out) const;
  WorldBounds body_bounds(BodyId body) const;
  WorldBounds shape_bounds(ShapeId shape) const;

  // ---------------------------------------------------------------------------------------------------------- queries
  // See queries.h. Each question has a form that returns the nearest answer (cast_ray), one that says whether there is any
  // (cast_ray_any), one that fills `out` with all answers in order (cast_ray_all), and a batch of each (cast_ray_batch, ...).
  //
  // Queries change nothing. Any number of threads may ask at once while nobody changes or steps the world. Functions that fill `out`
  // return how many answers there are; if they are more than out.size(), the first ones are kept.

  std::optional<CastHit> cast_ray(DVec3 origin, Vec3 translation, const QueryFilter& filter = {}) const;
  bool cast_ray_any(DVec3 origin, Vec3 translation, const QueryFilter& filter = {}) const;
  // The nearest hit on the shapes of one body, sensors included.
  std::optional<CastHit> cast_ray_body(BodyId body, DVec3 origin, Vec3 translation) const;
  // The first hit of every shape that the ray meets, by fraction.
  std::size_t cast_ray_all(DVec3 origin, Vec3 translation, std::span<CastHit> out, const QueryFilter& filter = {}) const;

  std::optional<CastHit> cast_shape(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  bool cast_shape_any(const ShapeCast& cast, const QueryFilter& filter = {}) const;
  std::size_t cast_shape_all(const ShapeCast& cast, std::span<CastHit> out, const QueryFilter& filter = {}) const;

  // Shapes that the given shape overlaps or touches; all of them by index. An overlap has no nearest form.
  bool overlap_any(const ShapePose& shape, const QueryFilter& filter = {}) const;
  std::size_t overlap_all(const ShapePose& shape, std::span<Overlap> out, const QueryFilter& filter = {}) const;

  // The closest point of any shape within `max_distance` (m, at least 0); of all shapes within it, by distance.
  std::optional<ClosestPoint> closest_point(const ShapePose& shape, double max_distance,
                                            const QueryFilter& filter = {}) const;
  bool closest_point_any(const ShapePose& shape, double max_distance, const QueryFilter& filter = {}) const;
  std::size_t closest_point_all(const ShapePose& shape, double max_distance, std::span<ClosestPoint> out,
                                const QueryFilter& filter = {}) const;

  // The deepest contact in which the given shape overlaps another. All contacts, deepest first: one for each convex shape or plane, up
  // to eight for each mesh or height field, without contacts at their inner edges. Whether there is any is overlap_any.
  std::optional<Penetration> penetration(const ShapePose& shape, const QueryFilter& filter = {}) const;
  std::size_t penetration_all(const ShapePose& shape, std::span<Penetration> out, const QueryFilter& filter = {}) const;

  // The shapes that are inside a sensor now: all that overlap or touch it, of bodies of any type, asleep or not, and that its filter
  // admits; in order of index. Copies up to out.size(); returns how many there are, 0 if the shape is not a sensor.
  std::size_t sensor_visitors(ShapeId sensor, std::span<ShapeId> out) const;

  // Batches: many questions at once over the world's threads. An error names the first question that cannot be asked, or spans of
  // different length; nothing is asked then. One batch at a time uses the threads; a batch that another thread asks meanwhile is
  // answered by that thread alone.

  // out[i] answers question i; it has no body if there is no answer.
  Error cast_ray_batch(std::span<const Ray> rays, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  Error cast_shape_batch(std::span<const ShapeCast> casts, std::span<CastHit> out, const QueryFilter& filter = {}) const;
  Error closest_point_batch(std::span<const ShapePose> shapes, double max_distance, std::span<ClosestPoint> out,
                            const QueryFilter& filter = {}) const;
  Error penetration_batch(std::span<const ShapePose> shapes, std::span<Penetration> out,
                          const QueryFilter& filter = {}) const;
  // out[i] is 1 if question i has any answer, otherwise 0.
  Error cast_ray_any_batch(std::span<const Ray> rays, std::span<std::uint8_t> out, const QueryFilter& filter = {}) const;
  Error cast_shape_any_batch(std::span<const ShapeCast> casts, std::span<std::uint8_t> out,
                             const QueryFilter& filter = {}) const;
  Error overlap_any_batch(std::span<const ShapePose> shapes, std::span<std::uint8_t> out,
                          const QueryFilter& filter = {}) const;
  Error closest_point_any_batch(std::span<const ShapePose> shapes, double max_distance, std::span<std::uint8_t> out,
                                const QueryFilter& filter = {}) const;
  // All answers of each question, in the order of the single question. Every question has the same room: with out.size() = n * room,
  // the answers of question i begin at out[i * room]. counts[i] is how many answers there are; if they are more than `room`, the first
  // ones are kept.
  Error cast_ray_all_batch(std::span<const Ray> rays, std::span<CastHit> out, std::span<std::uint32_t> counts,
                           const QueryFilter& filter = {}) const;
  Error cast_shape_all_batch(std::span<const ShapeCast> casts, std::span<CastHit> out, std::span<std::uint32_t> counts,
                             const QueryFilter& filter = {}) const;
  Error overlap_all_batch(std::span<const ShapePose> shapes, std::span<Overlap> out, std::span<std::uint32_t> counts,
                          const QueryFilter& filter = {}) const;
  Error closest_point_all_batch(std::span<const ShapePose> shapes, double max_distance, std::span<ClosestPoint> out,
                                std::span<std::uint32_t> counts, const QueryFilter& filter = {}) const;
  Error penetration_all_batch(std::span<const ShapePose> shapes, std::span<Penetration> out,
                              std::span<std::uint32_t> counts, const QueryFilter& filter = {}) const;
  // counts[i] is how many shapes the given shape i overlaps.
  Error overlap_count_batch(std::span<const ShapePose> shapes, std::span<std::uint32_t> counts,
                            const QueryFilter& filter = {}) const;

  // ---------------------------------------------------------------------------------------------------- the last step
  const Events& events() const;
  // Copies up to out.size() pairs of shapes that touched in the last step and in the one before, in a fixed order; returns how many
  // there are. Sleeping pairs count as touching.
  std::size_t contact_pairs(std::span<ContactPair> out) const;
  // Refused calls and reports of the step, since the last step began. At most 256 are kept.
  std::span<const Problem> problems() const;
  // Sees every problem, beyond the 256 that are kept too. It is no part of the state: snapshots and clones do not have it.
  void set_problem_hook(const ProblemHook& hook);
  WorldStats stats() const;
  StepStats step_stats() const;
  SpringStability spring_stability() const;  // of the present state
  SolverStats solver_stats() const;
  double time() const;           // s
  std::uint64_t step_count() const;
  Vec3 gravity() const;
  int substeps() const;
  float sleep_share() const;
  // The current settings as a WorldDef, to create a world like this one.
  WorldDef def() const;
  Energy energy() const;
  Momentum momentum() const;
  float max_penetration() const;  // m, of the deepest contact point of the last step; 0 if none overlaps
  // Hash of the whole simulation state. It is the same for every thread count, SIMD width, compiler and platform.
  std::uint64_t hash() const;

 private:
  friend struct WorldAccess;  // the engine's own parts: src/world/world_access.h
  explicit World(std::unique_ptr<WorldState> state);

  std::unique_ptr<WorldState> state_;
};

}  // namespace gyre
