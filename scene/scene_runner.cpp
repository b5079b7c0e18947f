// Runs a scene. See scene_runner.h.
#include "scene/scene_runner.h"

#include "scene/decomposition_split.h"
#include "scene/world_builder.h"

#include <algorithm>

namespace gyre {

SceneRunner::SceneRunner(Scene scene, World world) : scene_(std::move(scene)), world_(std::move(world)) {}

SceneResult<SceneRunner> SceneRunner::create(Scene scene, const std::string& file, int threads,
                                             int simd_width) {
  SplitOptions split;
  split.threads = threads;
  if (std::optional<SceneError> error = split_decompositions(scene, file, split)) return *std::move(error);
  const SceneWorld& settings = scene.world;
  WorldDef def;
  def.gravity = settings.gravity;
  def.threads = threads;
  def.simd_width = simd_width;
  def.stepping = stepping_of(settings);
  def.sleeping = settings.sleeping;
  def.sleep_share = settings.sleep_share;
  Result<World> world = World::create(def);
  if (!world) return SceneError{file, 0, 0, "/world", world.error().message};

  SceneRunner runner(std::move(scene), *std::move(world));
  WorldBuilder builder(runner.scene_, runner.world_, file);
  if (!builder.build()) return builder.error();
  runner.bodies_ = builder.take_bodies();
  runner.joints_ = builder.take_joints();
  runner.couplings_ = builder.take_couplings();
  runner.ropes_ = builder.take_ropes();
  runner.cloths_ = builder.take_cloths();
  runner.soft_bodies_ = builder.take_soft_bodies();
  runner.gases_ = builder.take_gases();
  runner.liquids_ = builder.take_liquids();
  runner.anchors_ = builder.take_anchors();
  runner.region_pins_ = builder.take_region_pins();
  for (std::size_t i = 0; i < runner.scene_.bodies.size(); ++i) {
    const SceneBody& body = runner.scene_.bodies[i];
    if (!body.forces.empty() && body.def.type == BodyType::dynamic) runner.forced_.push_back(i);
  }
  for (const SceneJoint& joint : runner.scene_.joints)
    runner.lengths_.push_back(runner.present_length(joint));
  return runner;
}

double SceneRunner::present_length(const SceneJoint& joint) const {
  const auto* const def = std::get_if<DistanceDef>(&joint.def);
  if (def == nullptr) return 0.0;
  DVec3 point_b;
  if (def->anchor_b) {
    point_b = *def->anchor_b;
  } else if (joint.b >= 0) {
    point_b = scene_.bodies[std::size_t(joint.b)].def.pose.position;
  }
  return length(point_b - def->anchor);
}

const SceneBody* SceneRunner::body_of(BodyId id) const {
  if (!world_.exists(id)) return nullptr;
  const std::uint64_t index = world_.user_data(id);
  if (index >= bodies_.size()) return nullptr;
  const std::size_t at = std::size_t(index);
  return bodies_[at] == id ? &scene_.bodies[at] : nullptr;
}

bool SceneRunner::step() {
  problem_.clear();
  apply_forces();
  const bool done = world_.step(float(scene_.world.time_step));
  return !find_problem() && done;
}

void SceneRunner::apply_forces() {
  // The step begins at a multiple of the time step; what is left of rounding must not move a window by a step.
  const double slack = 1.0e-4 * scene_.world.time_step;
  const double now = time() + slack;
  for (const SceneExplosion& explosion : scene_.explosions) {
    // In the first step alone what was to begin before it.
    const bool is_due =
        now >= explosion.start && (now - scene_.world.time_step < explosion.start || steps() == 0);
    if (is_due) world_.explode(explosion.def);
  }
  for (const std::size_t i : forced_) {
    const BodyId id = bodies_[i];
    if (!world_.exists(id)) continue;
    for (const SceneForce& force : scene_.bodies[i].forces) {
      if (!(now >= force.start && now < force.end)) continue;
      const Pose pose = world_.pose(id);
      Vec3 push = force.force, turn = force.torque;
      DVec3 at = force.at ? *force.at : DVec3{};
      if (force.in_body_frame) {
        push = rotate(pose.orientation, push);
        turn = rotate(pose.orientation, turn);
        if (force.at) at = pose * to_float(*force.at);
      }
      if (!(push == Vec3{})) {
        if (force.at) {
          world_.add_force_at(id, push, at);
        } else {
          world_.add_force(id, push);
        }
      }
      if (!(turn == Vec3{})) world_.add_torque(id, turn);
    }
  }
}

std::string SceneRunner::subject_of(const Problem& problem) const {
  if (const SceneBody* body = body_of(problem.body)) return "body \"" + body->name + "\": ";
  std::string subject;
  for_each_soft([&](const SceneSoft& soft, SoftId id) {
    if (id == problem.soft) subject = "\"" + soft.name + "\": ";
  });
  return subject;
}

bool SceneRunner::find_problem() {
  for (const Problem& problem : world_.problems()) {
    if (problem.code == ErrorCode::unstable) {
      if (warning_.empty()) warning_ = subject_of(problem) + problem.message;
      continue;
    }
    problem_ = subject_of(problem) + problem.message;
    return true;
  }
  const BodyColumns awake = world_.awake_bodies();
  for (std::size_t i = 0; i < awake.ids.size(); ++i) {
    if (is_finite(awake.poses[i]) && is_finite(awake.linear_velocities[i]) &&
        is_finite(awake.angular_velocities[i])) {
      continue;
    }
    const SceneBody* body = body_of(awake.ids[i]);
    problem_ = "body \"" + (body ? body->name : std::string("?")) + "\": its place or velocity is not finite";
    return true;
  }
  return find_soft_problem();
}

bool SceneRunner::find_soft_problem() {
  for_each_soft([&](const SceneSoft& soft, SoftId id) {
    const SoftVertices vertices = world_.vertices(id);
    for (std::size_t i = 0; i < vertices.size() && problem_.empty(); ++i) {
      if (is_finite(vertices.position(i)) && is_finite(vertices.velocity(i))) continue;
      problem_ = "\"" + soft.name + "\": place or velocity of vertex " + std::to_string(i) + " is not finite";
    }
  });
  return !problem_.empty();
}

SceneJoint SceneRunner::final_joint(std::size_t index) const {
  SceneJoint joint = scene_.joints[index];
  // A place or a direction of a body at the start, carried along to where the body stands now.
  const auto carried = [&](int body, DVec3 place) {
    if (body < 0) return place;
    const Pose& start = scene_.bodies[std::size_t(body)].def.pose;
    return world_.pose(bodies_[std::size_t(body)]) * inverse_times(start, place);
  };
  const auto turned = [&](int body, Vec3 direction) {
    if (body < 0) return direction;
    const Quat start = scene_.bodies[std::size_t(body)].def.pose.orientation;
    return rotate(world_.pose(bodies_[std::size_t(body)]).orientation, rotate_inverse(start, direction));
  };
  const auto carry = [&](auto& def) {
    if constexpr (requires { def.points; }) {
      const DVec3 on_b = carried(joint.b, def.anchor);
      for (Vec3& point : def.points) point = difference(carried(joint.a, def.anchor + point), on_b);
      def.anchor = on_b;
    } else {
      def.anchor = carried(joint.a, def.anchor);
    }
    if constexpr (requires { def.anchor_b; }) {
      if (def.anchor_b) def.anchor_b = carried(joint.b, *def.anchor_b);
    }
    if constexpr (requires { def.axis; }) def.axis = turned(joint.a, def.axis);
    if constexpr (requires { def.axis_b; }) {
      if (def.axis_b) def.axis_b = turned(joint.b, *def.axis_b);
    }
  };
  std::visit(carry, joint.def);
  // Zero of a hinge or slider is the pose in which it is made: the travel so far is taken off what refers to it.
  const float travelled = world_.joint_state(joints_[index]).position;
  const auto take_off = [&](auto& def) {
    if (def.limits) def.limits = Limits{def.limits->low - travelled, def.limits->high - travelled};
    if (def.motor.target_position) *def.motor.target_position -= travelled;
  };
  if (auto* const hinge = std::get_if<HingeDef>(&joint.def)) take_off(*hinge);
  if (auto* const slider = std::get_if<SliderDef>(&joint.def)) take_off(*slider);
  // A rod keeps the length it had, and a spring its rest length.
  auto* const distance = std::get_if<DistanceDef>(&joint.def);
  if (distance != nullptr && !distance->length &&
      (distance->stiffness || (!distance->min_length && !distance->max_length))) {
    distance->length = float(lengths_[index]);
  }
  return joint;
}

void SceneRunner::put_present_state(SceneBody& body, BodyId id) const {
  put_present_settings(body, id);
  body.def.pose = world_.pose(id);
  body.def.linear_velocity = world_.linear_velocity(id);
  body.def.angular_velocity = world_.angular_velocity(id);
  std::vector<SceneForce> left;
  for (SceneForce force : body.forces) {
    force.start = max(force.start - time(), min(force.start, 0.0));
    force.end -= time();
    if (force.end > 0.0) left.push_back(force);
  }
  body.forces = std::move(left);
}

// State that the program may have changed since.
void SceneRunner::put_present_settings(SceneBody& body, BodyId id) const {
  BodyDef& def = body.def;
  def.linear_damping = world_.linear_damping(id), def.angular_damping = world_.angular_damping(id);
  def.gravity_scale = world_.gravity_scale(id);
  def.sleep_speed = world_.sleep_speed(id);
  def.continuous = world_.continuous(id), def.can_sleep = world_.can_sleep(id);
  def.locked = world_.locked_axes(id);
  def.enabled = world_.enabled(id);
}

// Couplings whose joints are left. All positions are zero in the poses in which joints are made anew.
void SceneRunner::put_present_couplings(Scene& out, const std::vector<int>& places) const {
  out.couplings.clear();
  for (std::size_t i = 0; i < couplings_.size(); ++i) {
    if (!world_.exists(couplings_[i])) continue;
    SceneCoupling coupling = scene_.couplings[i];
    coupling.offset = -world_.coupling_state(couplings_[i]).error;
    for (SceneCouplingTerm& term : coupling.terms) term.joint = places[std::size_t(term.joint)];
    out.couplings.push_back(std::move(coupling));
  }
}

// The shape at rest stays; where the vertices are is the state.
void SceneRunner::put_present_state(SceneSoft& soft, SoftSettings& settings, SoftId id,
                                    const std::vector<int>& places) const {
  std::vector<SceneHold> left;
  for (SceneHold hold : soft.holds) {
    const bool is_to_body = hold.body >= 0;
    if (is_to_body) hold.body = places[std::size_t(hold.body)];
    if (!is_to_body || hold.body >= 0) left.push_back(hold);
  }
  soft.holds = std::move(left);
  std::vector<SceneHeldPoint> points;
  for (std::size_t k = 0; k < soft.points.size(); ++k) {
    const DVec3 anchor = anchors_[id.index][k];
    const int body = soft.points[k].body;
    if (body < 0) {
      points.push_back({anchor, -1});
    } else if (places[std::size_t(body)] >= 0) {
      points.push_back({world_.pose(bodies_[std::size_t(body)]) * to_float(anchor), places[std::size_t(body)]});
    }
  }
  soft.points = std::move(points);
  const SoftVertices vertices = world_.vertices(id);
  settings.positions.resize(vertices.size());
  settings.velocities.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    settings.positions[i] = vertices.position(i);
    settings.velocities[i] = vertices.velocity(i);
  }
}

void SceneRunner::put_present_softs(Scene& out, const std::vector<int>& places) const {
  const auto put = [&](auto& softs, const auto& from, const std::vector<SoftId>& ids, const auto& change) {
    softs.clear();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (!world_.exists(ids[i])) continue;
      softs.push_back(from[i]);
      put_present_state(softs.back(), softs.back().def.settings, ids[i], places);
      change(softs.back(), i);
    }
  };
  const auto keep = [](const auto&, std::size_t) {};
  put(out.ropes, scene_.ropes, ropes_, keep);
  // One that was torn is no longer of its grid or mesh.
  put(out.cloths, scene_.cloths, cloths_, [&](SceneCloth& cloth, std::size_t i) {
    ClothDef present = world_.cloth_def(cloths_[i]);
    const std::size_t before =
        cloth.def.grid ? std::size_t(cloth.def.grid->cells[0] + 1) * std::size_t(cloth.def.grid->cells[1] + 1)
                       : scene_.meshes[std::size_t(cloth.mesh)].vertices.size();
    if (present.settings.positions.size() == before) return;
    std::string name = cloth.name + " (torn)";
    while (std::any_of(out.meshes.begin(), out.meshes.end(),
                       [&](const SceneMesh& mesh) { return mesh.name == name; }))
      name += "'";
    cloth.mesh = int(out.meshes.size());
    cloth.def.grid.reset();
    cloth.def.pressure.reset();
    out.meshes.push_back({name, {}, std::move(present.vertices), std::move(present.triangles)});
  });
  // Vertices that a region pinned stay pinned by number: the region would catch what has moved into it.
  put(out.soft_bodies, scene_.soft_bodies, soft_bodies_, [&](SceneSoftBody& solid, std::size_t i) {
    solid.pinned_region.reset();
    for (const int vertex : region_pins_[i]) solid.holds.push_back({vertex, -1});
    SolidDef present = world_.solid_def(soft_bodies_[i]);
    if (present.box || present.tetrahedra.empty()) return;
    solid.def.box.reset();
    solid.def.vertices = std::move(present.vertices), solid.def.tetrahedra = std::move(present.tetrahedra);
  });
}

std::vector<FluidEmitter> SceneRunner::present_emitters(const std::vector<FluidEmitter>& emitters) const {
  std::vector<FluidEmitter> left;
  for (FluidEmitter emitter : emitters) {
    emitter.start = max(emitter.start - time(), min(emitter.start, 0.0));
    emitter.end -= time();
    if (emitter.end > 0.0) left.push_back(emitter);
  }
  return left;
}

DVec3 SceneRunner::probe_place(FluidId fluid, const SceneProbe& probe) const {
  const Pose pose = world_.fluid_info(fluid).pose;
  if (pose == Pose{}) return probe.position;
  const Quat& q = pose.orientation;
  const DVec3 u{double(q.x), double(q.y), double(q.z)}, t = 2.0 * cross(u, probe.position);
  return pose.position + probe.position + double(q.w) * t + cross(u, t);
}

namespace {

template <class Def>
void put_present_frame(const Def& present, Def& out) {
  out.pose = present.pose;
  out.linear_velocity = present.linear_velocity, out.angular_velocity = present.angular_velocity;
}

}  // namespace

// Definitions stay those of the scene. The state is where the box is, and the fields of a gas and the particles of a liquid.
void SceneRunner::put_present_fluids(Scene& out) const {
  out.gases.clear();
  for (std::size_t i = 0; i < gases_.size(); ++i) {
    if (!world_.exists(gases_[i])) continue;
    SceneGas& gas = out.gases.emplace_back(scene_.gases[i]);
    GasDef present = world_.gas_def(gases_[i]);
    gas.def.emitters = present_emitters(present.emitters);
    gas.def.fields = std::move(present.fields);
    put_present_frame(present, gas.def);
  }
  out.liquids.clear();
  for (std::size_t i = 0; i < liquids_.size(); ++i) {
    if (!world_.exists(liquids_[i])) continue;
    SceneLiquid& liquid = out.liquids.emplace_back(scene_.liquids[i]);
    LiquidDef present = world_.liquid_def(liquids_[i]);
    liquid.def.emitters = present_emitters(present.emitters);
    liquid.def.particles = std::move(present.particles);
    put_present_frame(present, liquid.def);
    // Particles may lie where the box is widened to whole cells.
    const FluidInfo info = world_.fluid_info(liquids_[i]);
    const double cell = double(liquid.def.cell_size);
    const DVec3 widened =
        info.lower + DVec3{info.cells[0] * cell, info.cells[1] * cell, info.cells[2] * cell};
    DVec3& upper = liquid.def.upper;
    upper = {max(upper.x, widened.x), max(upper.y, widened.y), max(upper.z, widened.z)};
  }
}

Scene SceneRunner::final_scene() const {
  Scene out = scene_;
  out.world.gravity = world_.gravity();
  out.world.substeps = world_.substeps();
  out.bodies.clear();
  std::vector<int> places(bodies_.size(), -1);  // of each body among those that are left
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!world_.exists(bodies_[i])) continue;
    places[i] = int(out.bodies.size());
    out.bodies.push_back(scene_.bodies[i]);
    put_present_state(out.bodies.back(), bodies_[i]);
  }
  out.joints.clear();
  std::vector<int> joint_places(joints_.size(), -1);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!world_.exists(joints_[i])) continue;
    SceneJoint joint = final_joint(i);
    if (joint.a >= 0) joint.a = places[std::size_t(joint.a)];
    if (joint.b >= 0) joint.b = places[std::size_t(joint.b)];
    joint_places[i] = int(out.joints.size());
    out.joints.push_back(std::move(joint));
  }
  put_present_couplings(out, joint_places);
  out.ignored_pairs.clear();
  for (const auto& [a, b] : scene_.ignored_pairs) {
    if (world_.pair_ignored(bodies_[std::size_t(a)], bodies_[std::size_t(b)]))
      out.ignored_pairs.push_back({places[std::size_t(a)], places[std::size_t(b)]});
  }
  put_present_softs(out, places);
  put_present_fluids(out);
  out.fields.clear();
  std::vector<FieldId> fields(world_.fields({}));
  world_.fields(fields);
  for (const FieldId id : fields) out.fields.push_back(world_.field(id));
  out.explosions.clear();
  for (SceneExplosion explosion : scene_.explosions) {
    explosion.start -= time();
    if (explosion.start > -1.0e-4 * scene_.world.time_step || steps() == 0)
      out.explosions.push_back(explosion);
  }
  for (SceneMesh& mesh : out.meshes) mesh.file.clear();
  return out;
}

}  // namespace gyre
