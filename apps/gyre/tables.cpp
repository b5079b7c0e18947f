// The tables that a simulation writes. See tables.h.
#include "tables.h"

#include "csv_row.h"
#include "fluid_figures.h"

#include <algorithm>

namespace gyre {
bool TraceTable::open(const std::string& path, const std::vector<std::string>& only, bool with_liquids) {
  only_ = only;
  with_liquids_ = with_liquids;
  return file_.open(path) && file_.write("step,time,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz,awake\n");
}

// A vertex does not turn.
bool TraceTable::add_vertices(const std::string& begin, const std::string& name, const SoftVertices& vertices,
                              bool is_awake) {
  const char* const end = is_awake ? ",0,0,0,1\n" : ",0,0,0,0\n";
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    row_ = begin;
    add_text(row_, name + "[" + std::to_string(i) + "]");
    add_vector(row_, vertices.position(i));
    row_ += ",0,0,0,1";
    add_vector(row_, vertices.velocity(i));
    row_ += end;
    if (!file_.write(row_)) return false;
  }
  return true;
}

// Their number changes where a liquid leaves the box or comes from an emitter.
bool TraceTable::add_particles(const std::string& begin, const std::string& name, const World& world,
                               FluidId id) {
  const std::size_t count = world.liquid_particles(id, {}, {});
  positions_.resize(count);
  velocities_.resize(count);
  world.liquid_particles(id, positions_, velocities_);
  for (std::size_t i = 0; i < count; ++i) {
    row_ = begin;
    add_text(row_, name + "[" + std::to_string(i) + "]");
    add_vector(row_, positions_[i]);
    row_ += ",0,0,0,1";
    add_vector(row_, velocities_[i]);
    row_ += ",0,0,0,1\n";
    if (!file_.write(row_)) return false;
  }
  return true;
}

bool TraceTable::has(const std::string& name) const {
  return only_.empty() || std::find(only_.begin(), only_.end(), name) != only_.end();
}

bool TraceTable::add_rows(const SceneRunner& runner) {
  const World& world = runner.world();
  std::string begin = std::to_string(runner.steps());
  add_number(begin, runner.time());
  for (std::size_t i = 0; i < runner.bodies().size(); ++i) {
    if (!has(runner.scene().bodies[i].name)) continue;
    const BodyId id = runner.bodies()[i];
    const Quat q = world.pose(id).orientation;
    row_ = begin;
    add_text(row_, runner.scene().bodies[i].name);
    add_vector(row_, world.center_of_mass(id));
    for (const float part : {q.x, q.y, q.z, q.w}) add_number(row_, double(part));
    add_vector(row_, world.linear_velocity(id));
    add_vector(row_, world.angular_velocity(id));
    row_ += world.is_awake(id) ? ",1\n" : ",0\n";
    if (!file_.write(row_)) return false;
  }
  bool written = true;
  runner.for_each_soft([&](const SceneSoft& soft, SoftId id) {
    if (!has(soft.name)) return;
    written = written && add_vertices(begin, soft.name, world.vertices(id), world.soft_info(id).awake);
  });
  if (!with_liquids_) return written;
  runner.for_each_fluid([&](const SceneFluid& fluid, FluidId id) {
    const bool is_liquid = world.fluid_info(id).kind == FluidKind::liquid;
    written = written && (!is_liquid || !has(fluid.name) || add_particles(begin, fluid.name, world, id));
  });
  return written;
}

namespace {

// The name of a body of the scene; "world" for the world, "?" for a body that is gone.
std::string name_of(const SceneRunner& runner, BodyId id) {
  if (!id) return "world";
  const SceneBody* const body = runner.body_of(id);
  return body != nullptr ? body->name : "?";
}

}  // namespace

bool JointForceTable::open(const std::string& path) {
  return file_.open(path) &&
         file_.write("step,time,joint,kind,body_a,body_b,fx,fy,fz,tx,ty,tz,position,velocity\n");
}

bool JointForceTable::add_rows(const SceneRunner& runner) {
  std::string begin = std::to_string(runner.steps());
  add_number(begin, runner.time());
  const World& world = runner.world();
  for (std::size_t i = 0; i < runner.joints().size(); ++i) {
    const JointId id = runner.joints()[i];
    if (!world.exists(id)) continue;  // it broke
    const SceneJoint& joint = runner.scene().joints[i];
    const JointInfo info = world.joint_info(id);
    const JointState state = world.joint_state(id);
    row_ = begin;
    add_text(row_, joint.name.empty() ? "joint " + std::to_string(i) : joint.name);
    add_text(row_, to_string(info.kind));
    add_text(row_, name_of(runner, info.a));
    add_text(row_, name_of(runner, info.b));
    add_vector(row_, state.force);
    add_vector(row_, state.torque);
    add_number(row_, double(state.position));
    add_number(row_, double(state.velocity));
    row_ += '\n';
    if (!file_.write(row_)) return false;
  }
  return true;
}

bool ContactPointTable::open(const std::string& path) {
  return file_.open(path) &&
         file_.write("step,time,body_a,body_b,px,py,pz,nx,ny,nz,separation,normal_force,fx,fy,fz,vx,vy,vz\n");
}

bool ContactPointTable::add_rows(const SceneRunner& runner) {
  std::string begin = std::to_string(runner.steps());
  add_number(begin, runner.time());
  const World& world = runner.world();
  points_.resize(world.contacts({}));
  world.contacts(points_);
  const double rate = 1.0 / runner.scene().world.time_step;
  for (const ContactPoint& point : points_) {
    row_ = begin;
    add_text(row_, name_of(runner, point.body_a));
    add_text(row_, name_of(runner, point.body_b));
    add_vector(row_, point.position);
    add_vector(row_, point.normal);
    add_number(row_, double(point.separation));
    add_number(row_, double(point.normal_impulse) * rate);
    for (int axis = 0; axis < 3; ++axis) add_number(row_, double(point.friction_impulse[axis]) * rate);
    add_vector(row_, point.relative_velocity);
    row_ += '\n';
    if (!file_.write(row_)) return false;
  }
  return true;
}

bool ProbeTable::open(const std::string& path) {
  return file_.open(path) &&
         file_.write("step,time,domain,probe,vx,vy,vz,pressure,density,temperature,surface\n");
}

bool ProbeTable::add_rows(const SceneRunner& runner) {
  std::string begin = std::to_string(runner.steps());
  add_number(begin, runner.time());
  bool written = true;
  runner.for_each_fluid([&](const SceneFluid& fluid, FluidId id) {
    for (const SceneProbe& probe : fluid.probes) {
      if (!written) return;
      const FluidProbe found = runner.world().probe(id, runner.probe_place(id, probe));
      row_ = begin;
      add_text(row_, fluid.name);
      add_text(row_, probe.name);
      add_vector(row_, found.velocity);
      for (const float number : {found.pressure, found.density, found.temperature, found.surface})
        add_number(row_, double(number));
      row_ += '\n';
      written = file_.write(row_);
    }
  });
  return written;
}

namespace {

std::string name_of(const SceneRunner& runner, ShapeId id) {
  return name_of(runner, runner.world().body_of(id));
}
std::string name_of(const SceneRunner& runner, SoftId id) {
  std::string name = "?";
  runner.for_each_soft([&](const SceneSoft& soft, SoftId one) {
    if (one == id) name = soft.name;
  });
  return name;
}
std::string name_of(const SceneRunner& runner, FluidId id) {
  std::string name = "?";
  runner.for_each_fluid([&](const SceneFluid& fluid, FluidId one) {
    if (one == id) name = fluid.name;
  });
  return name;
}
std::string name_of(const SceneRunner& runner, JointId id) {
  for (std::size_t i = 0; i < runner.joints().size(); ++i) {
    if (runner.joints()[i] != id) continue;
    const std::string& name = runner.scene().joints[i].name;
    return name.empty() ? "joint " + std::to_string(i) : name;
  }
  return "?";
}

}  // namespace

bool EventTable::open(const std::string& path) {
  return file_.open(path) && file_.write("step,time,event,first,second,value\n");
}

bool EventTable::add_rows(const SceneRunner& runner) {
  std::string begin = std::to_string(runner.steps());
  add_number(begin, runner.time());
  const Events& events = runner.world().events();
  row_.clear();
  const auto add = [&](const char* what, const std::string& first, const std::string& second, double value) {
    row_ += begin;
    add_text(row_, what);
    add_text(row_, first);
    add_text(row_, second);
    add_number(row_, value);
    row_ += '\n';
  };
  const auto name = [&](auto id) { return name_of(runner, id); };
  for (const ContactBegin& one : events.begins) add("contact_begin", name(one.body_a), name(one.body_b), 0.0);
  for (const ContactEnd& one : events.ends) add("contact_end", name(one.shape_a), name(one.shape_b), 0.0);
  for (const ContactHit& one : events.hits)
    add("hit", name(one.body_a), name(one.body_b), double(one.approach_speed));
  for (const SensorTouch& one : events.sensors)
    add(one.begins ? "sensor_enter" : "sensor_leave", name(one.visitor), name(one.sensor), 0.0);
  for (const JointBroken& one : events.broken) add("joint_break", name(one.joint), "", double(one.force));
  for (const SleepChange& one : events.sleep_changes)
    add(one.asleep ? "sleep" : "wake", name(one.body), "", 0.0);
  for (const SoftContactBegin& one : events.soft_begins)
    add("soft_contact_begin", name(one.soft), name(one.body), one.vertex);
  for (const SoftContactEnd& one : events.soft_ends)
    add("soft_contact_end", name(one.soft), name(one.shape), 0.0);
  for (const SoftInverted& one : events.inverted) add("inverted", name(one.soft), "", one.tetrahedron);
  for (const SoftTorn& one : events.torn) add("torn", name(one.soft), "", one.vertex);
  for (const FluidTouch& one : events.fluid_touches) {
    add(one.begins ? "fluid_enter" : "fluid_leave", one.soft ? name(one.soft) : name(one.body),
        name(one.fluid), one.vertex);
  }
  return row_.empty() || file_.write(row_);
}

bool StatsTable::open(const std::string& path) {
  return file_.open(path) &&
         file_.write(
             "step,time,step_ms,bodies,awake,pairs,contacts,max_penetration,kinetic_energy,potential_energy,"
             "elastic_energy,px,py,pz,lx,ly,lz,soft_elastic_energy,crossings,liquid_volume,liquid_particles,"
             "smoke_mass,max_divergence,pressure_residual\n");
}

bool StatsTable::add_row(const SceneRunner& runner, double step_ms, bool count_crossings) {
  const World& world = runner.world();
  const WorldStats counts = world.stats();
  const Energy energy = world.energy();
  const Momentum momentum = world.momentum();
  row_ = std::to_string(runner.steps());
  add_number(row_, runner.time());
  add_number(row_, step_ms);
  add_count(row_, counts.bodies);
  add_count(row_, counts.awake_bodies);
  add_count(row_, counts.pairs);
  add_count(row_, counts.contact_points);
  add_number(row_, double(world.max_penetration()));
  add_number(row_, energy.kinetic);
  add_number(row_, energy.potential);
  add_number(row_, energy.elastic);
  add_vector(row_, momentum.linear);
  add_vector(row_, momentum.angular);
  add_number(row_, energy.soft_elastic);
  add_count(row_, count_crossings ? static_cast<long long>(world.cloth_crossings()) : 0);
  const FluidFigures fluids = fluid_figures(runner);
  add_number(row_, fluids.liquid_volume);
  add_count(row_, fluids.liquid_particles);
  add_number(row_, fluids.smoke_mass);
  add_number(row_, fluids.divergence);
  add_number(row_, fluids.residual);
  row_ += '\n';
  return file_.write(row_);
}

}  // namespace gyre
