// Runs one case of a study. See study.h.
#include "sweep/study.h"

#include "scene/decomposition_split.h"
#include "scene/number_text.h"
#include "scene/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gyre {
namespace {

struct CaseFailure {
  std::string message;
};

// A reading while its case runs.
class Gauge {
 public:
  Gauge(const StudyReading& reading, const SceneRunner& runner) : reading_(reading) {
    if (reading.object.empty()) return;
    const Scene& scene = runner.scene();
    const bool of_joint = reading.quantity.rfind("joint_", 0) == 0 || reading.quantity == "broken";
    for (std::size_t i = 0; !of_joint && i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].name == reading.object) body_ = runner.bodies()[i];
    }
    for (std::size_t i = 0; of_joint && i < scene.joints.size(); ++i) {
      if (scene.joints[i].name == reading.object) joint_ = runner.joints()[i];
    }
    if (of_joint ? !joint_ : !body_)
      throw CaseFailure{"reading '" + reading.name + "': the scene has no " + (of_joint ? "joint" : "body") +
                        " '" + reading.object + "'"};
  }

  void sample(const SceneRunner& runner) {
    const double value = reading_.object.empty() ? world_value(runner.world())
                         : body_                 ? body_value(runner.world())
                                                 : joint_value(runner.world());
    last_ = value;
    most_ = std::max(most_, value);
    least_ = std::min(least_, value);
    sum_ += value;
    ++samples_;
    if (std::isnan(first_) && value > reading_.threshold) first_ = runner.time();
  }
  // NaN stands for nothing: a threshold that was not reached.
  double result() const {
    switch (reading_.take) {
      case Take::end:
        return last_;
      case Take::maximum:
        return most_;
      case Take::minimum:
        return least_;
      case Take::mean:
        return sum_ / double(samples_);
      case Take::first_above:
        return first_;
      case Take::count:
        break;
    }
    return sum_;
  }

 private:
  double body_value(const World& world) const {
    const std::string& what = reading_.quantity;
    const DVec3 p = world.pose(body_).position;
    const Vec3 v = world.linear_velocity(body_), w = world.angular_velocity(body_);
    if (what == "position_x") return p.x;
    if (what == "position_y") return p.y;
    if (what == "position_z") return p.z;
    if (what == "velocity_x") return double(v.x);
    if (what == "velocity_y") return double(v.y);
    if (what == "velocity_z") return double(v.z);
    if (what == "speed") return double(length(v));
    if (what == "angular_speed") return double(length(w));
    if (what == "awake") return world.is_awake(body_) ? 1 : 0;
    double out = 0;
    if (what == "touches") {
      for (const ContactBegin& begin : world.events().begins)
        out += begin.body_a == body_ || begin.body_b == body_;
      return out;
    }
    for (const ContactHit& hit : world.events().hits) {
      if (hit.body_a == body_ || hit.body_b == body_)
        out = std::max(out, double(what == "impact_speed" ? hit.approach_speed : hit.impulse));
    }
    return out;
  }
  double joint_value(const World& world) const {
    const std::string& what = reading_.quantity;
    if (what == "broken") return world.exists(joint_) ? 0 : 1;
    const JointState state = world.joint_state(joint_);
    if (what == "joint_position") return double(state.position);
    if (what == "joint_velocity") return double(state.velocity);
    return double(length(what == "joint_force" ? state.force : state.torque));
  }
  double world_value(const World& world) const {
    const std::string& what = reading_.quantity;
    if (what == "max_penetration") return double(world.max_penetration());
    if (what == "awake_bodies") return world.stats().awake_bodies;
    if (what == "contact_points") return world.stats().contact_points;
    if (what == "hits") return double(world.events().hits.size());
    if (what == "broken_joints") return double(world.events().broken.size());
    const Energy energy = world.energy();
    return what == "kinetic_energy"
               ? energy.kinetic
               : energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
  }

  const StudyReading& reading_;
  BodyId body_{};
  JointId joint_{};
  double last_ = 0, sum_ = 0;
  double most_ = -std::numeric_limits<double>::infinity(), least_ = std::numeric_limits<double>::infinity();
  double first_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t samples_ = 0;
};

SceneRunner make_runner(const Study& study, const std::vector<Json>& values) {
  Json scene = study.scene;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const std::string& pointer : study.parameters[i].pointers) {
      const Json::json_pointer place(pointer);
      Json& parent = scene.at(place.parent_pointer());
      if (!parent.is_object() && !scene.contains(place))
        throw CaseFailure{"the scene has no place " + pointer};
      scene[place] = values[i];
    }
  }
  ReadOptions options;
  options.file = study.scene_path;
  options.mesh_files = true;
  options.folder = study.scene_folder;
  SceneResult<Scene> made = read_scene(scene.dump(), options);
  if (!made) throw CaseFailure{made.error().text()};
  if (const std::optional<SceneError> error = split_decompositions(*made, study.scene_path))
    throw CaseFailure{error->text()};
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(made), study.scene_path);
  if (!runner) throw CaseFailure{runner.error().text()};
  return *std::move(runner);
}

void run_steps(const Study& study, SceneRunner& runner, std::vector<Gauge>& gauges) {
  const double time_step = runner.scene().world.time_step;
  // A duration that was rounded to a few digits must not cost one step more.
  const std::uint64_t steps =
      study.steps ? *study.steps : std::uint64_t(std::ceil(*study.duration / time_step * (1 - 1e-9) - 1e-6));
  const auto sample = [&] {
    for (Gauge& gauge : gauges) gauge.sample(runner);
  };
  if (steps == 0) sample();
  for (std::uint64_t i = 0; i < steps; ++i) {
    if (!runner.step())
      throw CaseFailure{"no longer finite in step " + std::to_string(i + 1) + ": " + runner.problem()};
    sample();
  }
}

}  // namespace

std::string run_case(const Study& study, std::uint64_t number) {
  Json line;
  line["case"] = number;
  line["study"] = study.fingerprint;
  const std::vector<Json> values = study.values_of(number);
  line["parameters"] = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) line["parameters"][study.parameters[i].name] = values[i];
  try {
    SceneRunner runner = make_runner(study, values);
    std::vector<Gauge> gauges;
    for (const StudyReading& reading : study.readings) gauges.emplace_back(reading, runner);
    run_steps(study, runner, gauges);
    Json readings = Json::object();
    for (std::size_t i = 0; i < gauges.size(); ++i) {
      const double value = gauges[i].result();
      readings[study.readings[i].name] = std::isfinite(value) ? Json(value) : Json();
    }
    line["readings"] = readings;
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(runner.world().hash()));
    line["hash"] = hash;
  } catch (const CaseFailure& failure) {
    line["error"] = failure.message;
  } catch (const std::exception& error) {
    line["error"] = error.what();
  }
  return line.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gyre
