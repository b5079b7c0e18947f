// Gases and liquids in scenes: what is read, what is refused and where, what is written, and going on from a final scene.
#include "scene/json_schema_check.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_schema.h"
#include "scene/scene_test_kit.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gyre::scene_fluid_test {
namespace {

using namespace scene_test;

const std::string kStart = R"({"gyre_scene": 1, "bodies": [{"name": "hull"}], )";

std::string gas_of(const std::string& entry) { return kStart + R"("gases": [)" + entry + "]}"; }
std::string gas_with(const std::string& members) {
  return gas_of(R"({"name": "air", "bounds": [[0, 0, 0], [2, 1, 1]], "cells": [4, 3, 2], )" + members + "}");
}
std::string liquid_of(const std::string& entry) { return kStart + R"("liquids": [)" + entry + "]}"; }
std::string liquid_with(const std::string& members) {
  return liquid_of(R"({"name": "sea", "bounds": [[0, 0, 0], [2, 1, 1]], "cell_size": 0.25, )" + members +
                   "}");
}

TEST(SceneFluid, RefusesBadGases) {
  const std::string at = "/gases/0";
  const Refused table[] = {
      {gas_of(R"({"bounds": [[0,0,0],[1,1,1]], "cells": [1,1,1]})"), at + "/name", "found nothing",
       "\"name\""},
      {gas_of(R"({"name": "g", "cells": [1,1,1]})"), at + "/bounds", "found nothing", "\"bounds\""},
      {gas_of(R"({"name": "g", "bounds": [[0,0,0],[1,1,1]]})"), at + "/cells", "found nothing", "\"cells\""},
      {gas_of(R"({"name": "hull", "bounds": [[0,0,0],[1,1,1]], "cells": [1,1,1]})"), at + "/name", "\"hull\"",
       "that no body"},
      {gas_of(R"({"name": "g", "bounds": [[0,2,0],[1,1,1]], "cells": [1,1,1]})"), at + "/bounds",
       "a lower corner above the upper", "[low, high]"},
      {gas_of(R"({"name": "g", "bounds": [[0,0,0],[1,0,1]], "cells": [1,1,1]})"), at + "/bounds", "no volume",
       "above the lower one"},
      {gas_of(R"({"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [0,1,1]})"), at + "/cells/0", "found 0",
       "from 1"},
      {gas_of(R"({"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [1,20000000,1]})"), at + "/cells/1",
       "found 20000000", "at most 16777216 cells"},
      {gas_of(R"({"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [300,300,300]})"), at + "/cells",
       "found 27000000 cells", "at most 16777216"},
      {gas_with(R"("density": 0)"), at + "/density", "found 0", "above 0"},
      {gas_with(R"("viscosity": -1)"), at + "/viscosity", "found -1", "from 0"},
      {gas_with(R"("vorticity": -1)"), at + "/vorticity", "found -1", "from 0"},
      {gas_with(R"("ambient_temperature": 0)"), at + "/ambient_temperature", "found 0", "above 0"},
      {gas_with(R"("advection": "upwind")"), at + "/advection", "\"upwind\"", "\"semi_lagrangian\""},
      {gas_with(R"("boundary": "free")"), at + "/boundary", "\"free\"", "\"no_slip\""},
      {gas_with(R"("boundary": 1)"), at + "/boundary", "found 1", "for each axis"},
      {gas_with(R"("boundary": {"y": "free"})"), at + "/boundary/y", "\"free\"", "\"periodic\""},
      {gas_with(R"("boundary": {"y": ["open"]})"), at + "/boundary/y", "an array of 1",
       "the lower and the upper side"},
      {gas_with(R"("boundary": {"x": ["periodic", "open"]})"), at + "/boundary/x", "one periodic side",
       "both sides"},
      {gas_with(R"("boundary": {"up": "open"})"), at + "/boundary/up", "unknown field", "perhaps"},
      {gas_with(R"("walls": {"+y": {"velocity": [1, 0, 0]}})"), at + "/walls/+y", "that is open", "no_slip"},
      {gas_with(R"("boundary": "no_slip", "walls": {"+y": {"velocity": [1, 2, 0]}})"),
       at + "/walls/+y/velocity/1", "found 2", "in its own plane"},
      {gas_with(R"("boundary": "no_slip", "walls": {"top": {}})"), at + "/walls/top", "unknown field", "+y"},
      {gas_with(R"("initial_velocity": {"type": "vortex"})"), at + "/initial_velocity/type", "\"vortex\"",
       "\"taylor_green\""},
      {gas_with(R"("initial_velocity": {"type": "taylor_green", "wave_number": [1, 0, 0]})"),
       at + "/initial_velocity/wave_number/1", "found 0", "above 0"},
      {gas_with(R"("initial_velocity": {"type": "taylor_green", "wave_number": [1, 1, 1]})"),
       at + "/initial_velocity/wave_number/2", "found 1", "in the x-y plane"},
      {gas_with(R"("emitters": [{"radius": 1}])"), at + "/emitters/0/position", "found nothing",
       "\"position\""},
      {gas_with(R"("emitters": [{"position": [0, 0, 0]}, {"position": [3, 0.5, 0.5]}])"),
       at + "/emitters/1/position", "found [3, 0.5, 0.5]", "inside the bounds, [0, 0, 0] to [2, 1, 1]"},
      {gas_with(R"("emitters": [{"position": [0, 0, 0], "radius": 0}])"), at + "/emitters/0/radius",
       "found 0", "above 0"},
      {gas_with(R"("probes": [{"name": "p", "position": [0, 0, -0.1]}])"), at + "/probes/0/position",
       "found [0, 0, -0.1]", "inside the bounds"},
      {gas_with(R"("probes": [{"position": [0, 0, 0]}])"), at + "/probes/0/name", "found nothing",
       "\"name\""},
      {gas_with(R"("probes": [{"name": "p", "position": [0, 0, 0]}, {"name": "p", "position": [0, 0, 1]}])"),
       at + "/probes/1/name", "\"p\"", "no other probe"},
      {gas_with(R"("state": {"velocity": {"x": [1, 2]}})"), at + "/state/velocity/x", "an array of 2",
       "an array of 30 numbers"},
      {gas_with(R"("state": {"velocity": {"y": []}})"), at + "/state/velocity/y", "an array of 0",
       "an array of 32"},
      {gas_with(R"("state": {"velocity": {}, "density": [1]})"), at + "/state/density", "an array of 1",
       "an array of 24 numbers, one for each cell"},
      {gas_with(R"("combustion": {"heat_capacity": 0})"), at + "/combustion/heat_capacity", "found 0",
       "above 0"},
      {gas_with(R"("combustion": {"smoke_yeild": 1})"), at + "/combustion/smoke_yeild", "unknown field",
       "smoke_yield"},
      {gas_with(R"("adaptive_domain": {"margin": 0})"), at + "/adaptive_domain/margin", "found 0", "1"},
      {gas_with(R"("adaptive_domain": {"threshold": 0})"), at + "/adaptive_domain/threshold", "found 0",
       "above 0"},
      {gas_with(R"("emitters": [{"position": [0, 0, 0], "fuel": -1}])"), at + "/emitters/0/fuel", "found -1",
       "from 0"},
      {gas_with(R"("bouyancy": 1)"), at + "/bouyancy", "unknown field", "\"buoyancy\""},
      {gas_with(R"("cell_size": 1)"), at + "/cell_size", "unknown field in a gas", "cells"},
  };
  for (const Refused& bad : table) expect_refused(bad);
}

TEST(SceneFluid, RefusesBadLiquids) {
  const std::string at = "/liquids/0";
  const Refused table[] = {
      {liquid_of(R"({"name": "l", "bounds": [[0,0,0],[1,1,1]]})"), at + "/cell_size", "found nothing",
       "\"cell_size\""},
      {liquid_of(R"({"name": "l", "bounds": [[0,0,0],[1,1,1]], "cell_size": 0})"), at + "/cell_size",
       "found 0", "above 0"},
      {liquid_of(R"({"name": "l", "bounds": [[0,0,0],[3,3,3]], "cell_size": 0.01})"), at + "/cell_size",
       "found 27000000 cells", "at most 16777216"},
      {liquid_of(R"({"name": "l", "bounds": [[0,0,0],[1e12,1e12,1e12]], "cell_size": 1e-30})"),
       at + "/cell_size", "cells", "at most 16777216"},
      {liquid_with(R"("surface_tension": -1)"), at + "/surface_tension", "found -1", "from 0"},
      {liquid_with(R"("fill": [{"box": [[0, 1, 0], [1, 0, 1]]}])"), at + "/fill/0/box",
       "a lower corner above the upper", "[low, high]"},
      {liquid_with(R"("fill": [{}])"), at + "/fill/0/box", "found nothing", "\"box\""},
      {liquid_with(R"("emitters": [{"position": [0, 0, 0], "temperature": 300}])"),
       at + "/emitters/0/temperature", "only a gas", "temperature"},
      {liquid_with(R"("initial_velocity": {"type": "taylor_green"})"), at + "/initial_velocity", "an object",
       "an array of 3 numbers"},
      {liquid_with(R"("probes": [{"name": "p", "position": [0, 1.5, 0]}])"), at + "/probes/0/position",
       "found [0, 1.5, 0]", "inside the bounds"},
      {liquid_with(R"("state": {"velocities": []})"), at + "/state/positions", "found nothing",
       "\"positions\""},
      {liquid_with(R"("state": {"positions": [[1,0.5,0.5]], "velocities": []})"), at + "/state/velocities",
       "an array of 0", "an array of 1"},
      {liquid_with(R"("state": {"positions": [[1,0.5,0.5]], "affine": [[1]]})"), at + "/state/affine/0",
       "an array of 1", "9 numbers"},
      {liquid_with(R"("buoyancy": 1)"), at + "/buoyancy", "unknown field in a liquid", "fill"},
  };
  for (const Refused& bad : table) expect_refused(bad);
}

TEST(SceneFluid, NamesAreUniqueOverAllKindsOfMatter) {
  const std::string gas = R"("gases": [{"name": "x", "bounds": [[0,0,0],[1,1,1]], "cells": [2,2,2]}])";
  const std::string liquid = R"("liquids": [{"name": "x", "bounds": [[0,0,0],[1,1,1]], "cell_size": 0.5}])";
  const std::string rope = R"("ropes": [{"name": "x", "points": [[0,0,0],[1,0,0]]}])";
  const auto pointer = [](const std::string& members) {
    const SceneResult<Scene> read = read_scene(R"({"gyre_scene": 1, )" + members + "}");
    return read ? std::string("none") : read.error().pointer;
  };
  EXPECT_EQ(pointer(gas), "none");
  EXPECT_EQ(pointer(liquid), "none");
  EXPECT_EQ(pointer(gas + ", " + liquid), "/liquids/0/name");
  EXPECT_EQ(pointer(gas + ", " + rope), "/gases/0/name");
  EXPECT_EQ(pointer(liquid + R"(, "bodies": [{"name": "x"}])"), "/liquids/0/name");
}

TEST(SceneFluid, StopsAtTheLimitOfCellsOfAllTogether) {
  ReadOptions options;
  options.limits.fluid_cells = 100;
  const std::string gas =
      R"({"gyre_scene": 1, "gases": [{"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [4,4,4]}])";
  EXPECT_TRUE(read_scene(gas + "}", options));
  const SceneResult<Scene> read = read_scene(
      gas + R"(, "liquids": [{"name": "l", "bounds": [[0,0,0],[1,1,1]], "cell_size": 0.26}]})", options);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().pointer, "/liquids/0/cell_size");
  EXPECT_NE(read.error().message.find("found 128"), std::string::npos) << read.error().message;
  EXPECT_NE(read.error().message.find("at most 100"), std::string::npos) << read.error().message;
}

TEST(SceneFluid, DefaultsAreThoseOfTheFormat) {
  const SceneResult<Scene> scene = read_scene(
      R"({"gyre_scene": 1, "gases": [{"name": "g", "bounds": [[0,0,0],[1,1,1]], "cells": [2,2,2], "emitters": [{"position": [0,0,0]}]}],
          "liquids": [{"name": "l", "bounds": [[0,0,0],[1,1,1]], "cell_size": 0.5}]})");
  ASSERT_TRUE(scene) << scene.error().text();
  const GasDef& gas = scene->gases[0].def;
  EXPECT_EQ(gas.density, 1.2f);
  EXPECT_EQ(gas.viscosity, 0.0f);
  EXPECT_EQ(gas.buoyancy, 1.0f);
  EXPECT_EQ(gas.ambient_temperature, 293.15f);
  EXPECT_EQ(gas.advection, Advection::maccormack);
  EXPECT_FALSE(gas.fields || gas.vortices);
  for (const FluidBoundary side : gas.sides) EXPECT_EQ(side, FluidBoundary::open);
  const FluidEmitter& emitter = gas.emitters[0];
  EXPECT_EQ(emitter.radius, 0.3f);
  EXPECT_EQ(emitter.density, 1.0f);
  EXPECT_EQ(emitter.temperature, 300.0f);
  EXPECT_FALSE(emitter.velocity);
  EXPECT_EQ(emitter.start, 0.0);
  EXPECT_EQ(emitter.end, 1e9);
  const LiquidDef& liquid = scene->liquids[0].def;
  EXPECT_EQ(liquid.density, 1000.0f);
  EXPECT_EQ(liquid.viscosity, 0.0f);
  EXPECT_EQ(liquid.surface_tension, 0.0f);
  EXPECT_FALSE(liquid.particles);
  for (const FluidBoundary side : liquid.sides) EXPECT_EQ(side, FluidBoundary::closed);
}

// `count` numbers from 0 up.
std::string counted_numbers(int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += (i > 0 ? "," : "") + std::to_string(i);
  return "[" + out + "]";
}

// Every member of gases.
const std::string kAllGases = kStart + R"("name": "all", "gases": [
      {"name": "a", "bounds": [[-1, 0, 0.1], [2, 1, 1]], "cells": [4, 3, 2], "density": 1.5, "viscosity": 0.25, "buoyancy": -0.5,
       "vorticity": 0.3, "combustion": {"ignition_temperature": 400.5, "burn_rate": 2, "heat_release": 1e6, "heat_capacity": 900, "smoke_yield": 0.5},
       "adaptive_domain": {"margin": 5, "threshold": 0.25},
       "ambient_temperature": 300.5, "advection": "semi_lagrangian", "color": "#102030",
       "boundary": {"x": "periodic", "y": ["closed", "no_slip"], "z": null}, "walls": {"+y": {"velocity": [1, 0, 0.5]}, "-y": null},
       "initial_velocity": [0.1, 0.2, 0.3],
       "emitters": [{"position": [0, 0.5, 0.5], "radius": 0.125, "density": 2, "temperature": 400, "fuel": 0.25, "velocity": [0, 1, 0], "start": 0.5, "end": 2},
                    {"position": [2, 1, 1], "velocity": null}],
       "probes": [{"name": "p1", "position": [-1, 0, 0.1]}, {"name": "p, 2", "position": [0.123456789012345, 0.5, 0.5]}]},
      {"name": "b", "bounds": [[0, 0, 0], [1, 1, 1]], "cells": [8, 8, 1], "boundary": "no_slip",
       "initial_velocity": {"type": "taylor_green", "amplitude": 0.5, "wave_number": [6.25, 3.125, 0]}},
      {"name": "c", "bounds": [[5, 0, 0], [6, 1, 1]], "cells": [2, 2, 2], "combustion": {}, "adaptive_domain": {}, "state": {"velocity": {"x": )" +
                              counted_numbers(12) + R"(}, "density": )" + counted_numbers(8) +
                              R"(, "pressure": null, "fuel": )" + counted_numbers(8) + "}}]}";

TEST(SceneFluid, WritesTheGasesThatItRead) {
  const SceneResult<Scene> first = read_scene(kAllGases);
  ASSERT_TRUE(first) << first.error().text();
  const std::string text = write_scene(*first);
  const SceneResult<Scene> second = read_scene(text);
  ASSERT_TRUE(second) << second.error().text() << "\n" << text;
  EXPECT_EQ(write_scene(*second), text);
  const Json schema = parse_document(scene_schema(), "schema", SceneLimits{});
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(kAllGases, "scene", SceneLimits{})), "");
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(text, "scene", SceneLimits{})), "");

  const SceneGas& a = second->gases[0];
  EXPECT_EQ(a.def.lower, (DVec3{-1, 0, 0.1}));
  EXPECT_EQ(a.def.cells, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(a.def.density, 1.5f);
  EXPECT_EQ(a.def.viscosity, 0.25f);
  EXPECT_EQ(a.def.buoyancy, -0.5f);
  EXPECT_EQ(a.def.vorticity, 0.3f);
  EXPECT_EQ(a.def.ambient_temperature, 300.5f);
  EXPECT_EQ(a.def.advection, Advection::semi_lagrangian);
  const std::array<FluidBoundary, 6> sides{FluidBoundary::periodic, FluidBoundary::periodic,
                                           FluidBoundary::closed,   FluidBoundary::no_slip,
                                           FluidBoundary::open,     FluidBoundary::open};
  EXPECT_EQ(a.def.sides, sides);
  EXPECT_EQ(a.def.wall_velocities[3], (Vec3{1, 0, 0.5f}));
  EXPECT_EQ(a.def.initial_velocity, (Vec3{0.1f, 0.2f, 0.3f}));
  ASSERT_EQ(a.def.emitters.size(), 2u);
  EXPECT_EQ(a.def.emitters[0].temperature, 400.0f);
  EXPECT_EQ(*a.def.emitters[0].velocity, (Vec3{0, 1, 0}));
  EXPECT_EQ(a.def.emitters[0].end, 2.0);
  EXPECT_FALSE(a.def.emitters[1].velocity);
  EXPECT_EQ(a.probes[1].name, "p, 2");
  EXPECT_EQ(a.probes[1].position.x, 0.123456789012345);
  EXPECT_EQ(*a.color, (SceneColor{0x10, 0x20, 0x30}));
  ASSERT_TRUE(second->gases[1].def.vortices);
  EXPECT_EQ(second->gases[1].def.vortices->wave_number, (std::array<float, 2>{6.25f, 3.125f}));
  const GasFields& fields = *second->gases[2].def.fields;
  EXPECT_EQ(fields.velocity_x[11], 11.0f);
  EXPECT_EQ(fields.velocity_y, std::vector<float>(12, 0.0f));
  EXPECT_EQ(fields.density[7], 7.0f);
  EXPECT_EQ(fields.temperature, std::vector<float>(8, 293.15f));
  EXPECT_EQ(fields.pressure, std::vector<float>(8, 0.0f));
  EXPECT_EQ(fields.fuel[7], 7.0f);
  EXPECT_EQ(a.def.emitters[0].fuel, 0.25f);
  EXPECT_EQ(a.def.combustion->ignition_temperature, 400.5f);
  EXPECT_EQ(a.def.combustion->smoke_yield, 0.5f);
  EXPECT_EQ(a.def.adaptive_domain->margin, 5);
  EXPECT_EQ(a.def.adaptive_domain->threshold, 0.25f);
  EXPECT_FALSE(second->gases[1].def.adaptive_domain);
  EXPECT_EQ(second->gases[2].def.adaptive_domain->margin, AdaptiveDomain{}.margin);
  EXPECT_EQ(second->gases[2].def.combustion->heat_release, Combustion{}.heat_release);
}

// Every member of liquids.
const std::string kAllLiquids = kStart + R"("name": "all", "liquids": [
      {"name": "a", "bounds": [[0, 0, 0], [2, 1, 1]], "cell_size": 0.25, "density": 900, "viscosity": 5, "surface_tension": 0.07,
       "fill": [{"box": [[0, 0, 0], [1, 0.5, 1]]}, {"box": [[1.5, 0, 0], [2, 0.25, 1]]}], "boundary": {"x": ["closed", "open"], "y": "no_slip"},
       "walls": {"-y": {"velocity": [0.5, 0, 0]}}, "initial_velocity": [0, 0, 0.5],
       "emitters": [{"position": [0.5, 0.75, 0.5], "radius": 0.25, "velocity": [0, -1, 0], "end": 3}],
       "probes": [{"name": "p", "position": [1, 0.25, 0.5]}], "color": "#3060a0"},
      {"name": "b", "bounds": [[5, 0, 0], [6, 1, 1]], "cell_size": 0.25,
       "state": {"positions": [[5.5, 0.1, 0.5], [5.625, 0.1, 0.123456789012345]], "velocities": [[0, 1, 0], [0, 0, 2]],
                 "affine": [[1,2,3,4,5,6,7,8,9],[0,0,0,0,0,0,0,0,0.5]], "volumes": [0.001, 0.002]}}]})";

TEST(SceneFluid, WritesTheLiquidsThatItRead) {
  const SceneResult<Scene> first = read_scene(kAllLiquids);
  ASSERT_TRUE(first) << first.error().text();
  const std::string text = write_scene(*first);
  const SceneResult<Scene> second = read_scene(text);
  ASSERT_TRUE(second) << second.error().text() << "\n" << text;
  EXPECT_EQ(write_scene(*second), text);
  const Json schema = parse_document(scene_schema(), "schema", SceneLimits{});
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(kAllLiquids, "scene", SceneLimits{})), "");
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(text, "scene", SceneLimits{})), "");

  const SceneLiquid &a = second->liquids[0], &b = second->liquids[1];
  EXPECT_EQ(a.def.upper, (DVec3{2, 1, 1}));
  EXPECT_EQ(a.def.cell_size, 0.25f);
  EXPECT_EQ(a.def.density, 900.0f);
  EXPECT_EQ(a.def.viscosity, 5.0f);
  EXPECT_EQ(a.def.surface_tension, 0.07f);
  ASSERT_EQ(a.def.fill.size(), 2u);
  EXPECT_EQ(a.def.fill[1].upper, (DVec3{2, 0.25, 1}));
  EXPECT_EQ(a.def.sides[1], FluidBoundary::open);
  EXPECT_EQ(a.def.sides[2], FluidBoundary::no_slip);
  EXPECT_EQ(a.def.sides[4], FluidBoundary::closed);
  EXPECT_EQ(a.def.wall_velocities[2], (Vec3{0.5f, 0, 0}));
  EXPECT_EQ(*a.def.emitters[0].velocity, (Vec3{0, -1, 0}));
  EXPECT_EQ(a.def.emitters[0].end, 3.0);
  ASSERT_TRUE(b.def.particles);
  EXPECT_EQ(b.def.particles->positions[1].z, 0.123456789012345);
  EXPECT_EQ(b.def.particles->velocities[1], (Vec3{0, 0, 2}));
  EXPECT_EQ(b.def.particles->affine[17], 0.5f);
  EXPECT_EQ(b.def.particles->volumes, (std::vector<float>{0.001f, 0.002f}));
}

TEST(SceneFluid, AGasBecomesWhatItSaysInTheWorld) {
  const SceneRunner runner = run(kAllGases);
  ASSERT_EQ(runner.gases().size(), 3u);
  const World& world = runner.world();
  const FluidInfo info = world.fluid_info(runner.gases()[0]);
  EXPECT_EQ(info.kind, FluidKind::gas);
  EXPECT_EQ(info.cells, (std::array<int, 3>{4, 3, 2}));
  EXPECT_EQ(info.user_data, 0u);
  EXPECT_NEAR(info.cell.x, 0.75, 1e-6);
  // Numbers 0 to 11 on faces across x: three a row, and the probe stands half a cell above the first row.
  EXPECT_NEAR(world.probe(runner.gases()[2], {5.5, 0.25, 0.25}).velocity.x, 1.0, 1e-5);
  EXPECT_NEAR(world.probe(runner.gases()[2], {5.75, 0.75, 0.75}).density, 7.0, 1e-5);
  std::vector<std::string> names;
  runner.for_each_fluid([&](const SceneFluid& fluid, FluidId) { names.push_back(fluid.name); });
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c"}));
}

// Vortices of Taylor and Green in a box whose sides they do not cross.
std::string taylor_green(double viscosity) {
  return R"({"gyre_scene": 1, "world": {"time_step": 0.01, "gravity": [0, 0, 0]}, "gases": [{"name": "air", "bounds": [[0,0,0],[1,1,0.1]], "cells": [32, 32, 1],
    "density": 2, "viscosity": )" +
         std::to_string(viscosity) +
         R"(, "boundary": "periodic", "initial_velocity": {"type": "taylor_green", "wave_number": [)" +
         std::to_string(2 * std::numbers::pi) + ", " + std::to_string(2 * std::numbers::pi) +
         R"(, 0]}, "probes": [{"name": "fast", "position": [0.25, 0, 0.05]}, {"name": "middle", "position": [0.25, 0.25, 0.05]}]}]})";
}

// u = exp(-2 nu k^2 t) sin(kx) cos(ky), the middle of a vortex is at rest, and the pressure is lowest there.
TEST(SceneFluid, ProbesOfVorticesFollowTheExactSolution) {
  const double viscosity = 0.01, nu = viscosity / 2, k = 2 * std::numbers::pi;
  SceneRunner runner = run(taylor_green(viscosity));
  const SceneGas& gas = runner.scene().gases[0];
  for (int step = 0; step <= 60; ++step) {
    const double exact = std::exp(-2 * nu * k * k * runner.time());
    const FluidProbe fast = runner.world().probe(runner.gases()[0], gas.probes[0].position);
    const FluidProbe middle = runner.world().probe(runner.gases()[0], gas.probes[1].position);
    EXPECT_NEAR(fast.velocity.x, exact, 0.01) << step;
    EXPECT_NEAR(length(middle.velocity), 0.0, 0.01) << step;
    if (step > 5) {
      EXPECT_NEAR(double(fast.pressure - middle.pressure), exact * exact, 0.06) << step;
    }
    ASSERT_TRUE(runner.step());
  }
}

// Two runs of 10 steps, the second from the final scene of the first, against one of 20.
TEST(SceneFluid, AGasGoesOnFromAFinalScene) {
  const SceneRunner whole = run(kAllGases, 20), half = run(kAllGases, 10);
  const std::string text = write_scene(half.final_scene());
  const SceneRunner rest = run(text, 10);
  ASSERT_EQ(rest.gases().size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const GasFields a = *whole.world().gas_def(whole.gases()[i]).fields,
                    b = *rest.world().gas_def(rest.gases()[i]).fields;
    float largest = 0;
    for (const auto axis : {&GasFields::velocity_x, &GasFields::velocity_y, &GasFields::velocity_z}) {
      EXPECT_EQ(a.*axis, b.*axis) << i;
      for (const float one : a.*axis) largest = max(largest, absolute(one));
    }
    EXPECT_GT(largest, 0.01f) << i;
    EXPECT_EQ(a.density, b.density) << i;
    EXPECT_EQ(a.temperature, b.temperature) << i;
    EXPECT_EQ(a.pressure, b.pressure) << i;
  }
}

TEST(SceneFluid, AFinalSceneKeepsWhatIsLeftOfEmitters) {
  const std::string text = gas_with(
      R"("emitters": [{"position": [1, 0.5, 0.5], "start": 0.5, "end": 2}, {"position": [1, 0.5, 0.5], "end": 0.1},
                      {"position": [1, 0.5, 0.5]}])");
  const SceneRunner runner = run(text, 15);
  const Scene left = runner.final_scene();
  const std::vector<FluidEmitter>& emitters = left.gases[0].def.emitters;
  ASSERT_EQ(emitters.size(), 2u);
  EXPECT_NEAR(emitters[0].start, 0.25, 1e-6);
  EXPECT_NEAR(emitters[0].end, 1.75, 1e-6);
  EXPECT_EQ(emitters[1].start, 0.0);
  EXPECT_TRUE(read_scene(write_scene(left)));
}

TEST(SceneFluid, AFluidThatIsRemovedIsLeftOutOfTheFinalScene) {
  SceneRunner runner = run(kAllGases, 1);
  ASSERT_TRUE(runner.world().remove_fluid(runner.gases()[0]));
  const Scene left = runner.final_scene();
  ASSERT_EQ(left.gases.size(), 2u);
  EXPECT_EQ(left.gases[0].name, "b");
  EXPECT_TRUE(read_scene(write_scene(left)));
}

TEST(SceneFluid, ALiquidBecomesWhatItSaysInTheWorld) {
  const SceneRunner runner = run(kAllLiquids);
  ASSERT_EQ(runner.liquids().size(), 2u);
  const World& world = runner.world();
  const FluidInfo a = world.fluid_info(runner.liquids()[0]);
  EXPECT_EQ(a.kind, FluidKind::liquid);
  EXPECT_EQ(a.cells, (std::array<int, 3>{8, 4, 4}));
  EXPECT_EQ(a.particles, 8 * (4 * 2 * 4 + 2 * 1 * 4));
  EXPECT_EQ(world.fluid_info(runner.liquids()[1]).particles, 2);
  std::vector<DVec3> positions(2);
  std::vector<Vec3> velocities(2);
  ASSERT_EQ(world.liquid_particles(runner.liquids()[1], positions, velocities), 2u);
  // A liquid keeps its particles in the order of cells.
  EXPECT_NEAR(length(positions[0] - DVec3{5.625, 0.1, 0.123456789012345}), 0.0, 1e-6);
  EXPECT_EQ(velocities[0], (Vec3{0, 0, 2}));
  EXPECT_NEAR(length(positions[1] - DVec3{5.5, 0.1, 0.5}), 0.0, 1e-6);
}

// Half a box of water, a little wider than whole cells.
const std::string kTank =
    R"({"gyre_scene": 1, "liquids": [{"name": "water", "bounds": [[0, 0, 0], [0.98, 1, 0.05]], "cell_size": 0.05,
    "fill": [{"box": [[0, 0, 0], [2, 0.5, 0.05]]}], "probes": [{"name": "deep", "position": [0.3, 0.1, 0.025]},
    {"name": "air", "position": [0.3, 0.8, 0.025]}]}]})";

TEST(SceneFluid, ProbesOfStillWaterKnowItsDepth) {
  const SceneRunner runner = run(kTank, 30);
  const SceneLiquid& water = runner.scene().liquids[0];
  const FluidProbe deep = runner.world().probe(runner.liquids()[0], water.probes[0].position);
  const FluidProbe air = runner.world().probe(runner.liquids()[0], water.probes[1].position);
  EXPECT_NEAR(deep.surface, 0.5, 0.015);
  EXPECT_NEAR(air.surface, 0.5, 0.015);
  EXPECT_NEAR(deep.pressure, 1000 * 9.81 * 0.4, 150);
  EXPECT_EQ(deep.density, 1.0f);
  EXPECT_EQ(air.density, 0.0f);
  EXPECT_LT(length(deep.velocity), 0.02f);
}

TEST(SceneFluid, ALiquidGoesOnFromAFinalScene) {
  std::string text = kTank;
  text.replace(text.find("[2, 0.5,"), 8, "[0.4, 0.9,");
  const SceneRunner whole = run(text, 20), half = run(text, 10);
  const SceneRunner rest = run(write_scene(half.final_scene()), 10);
  EXPECT_EQ(rest.world().fluid_info(rest.liquids()[0]).cells,
            whole.world().fluid_info(whole.liquids()[0]).cells);
  const auto positions = [](const SceneRunner& runner) {
    std::vector<DVec3> out(runner.world().liquid_particles(runner.liquids()[0], {}, {}));
    runner.world().liquid_particles(runner.liquids()[0], out, {});
    return out;
  };
  const std::vector<DVec3> a = positions(whole), b = positions(rest), start = positions(half);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 500u);
  double farthest = 0, moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Particles stand in the order of their cells, which a rounding may change.
    double nearest = 1e9;
    for (const DVec3 place : b) nearest = std::fmin(nearest, length(a[i] - place));
    farthest = std::fmax(farthest, nearest);
    moved = std::fmax(moved, length(a[i] - start[i]));
  }
  EXPECT_LT(farthest, 1e-3);
  EXPECT_GT(moved, 0.1);
}

// A lid drags the gas round in a closed box. At Re = 100 the slowest of the return flow on the line through the middle is -0.2109 of the lid
// at 0.4531 of the height (U. Ghia, K. Ghia, C. Shin, 1982).
TEST(SceneFluid, ALidDrivesTheGasInABox) {
  const std::string text =
      R"({"gyre_scene": 1, "world": {"time_step": 0.05, "gravity": [0, 0, 0]}, "gases": [{"name": "air", "bounds": [[0,0,0],[1,1,0.1]], "cells": [24, 24, 1],
         "density": 1, "viscosity": 0.01, "boundary": {"x": "no_slip", "y": "no_slip"}, "walls": {"+y": {"velocity": [1, 0, 0]}}}]})";
  const SceneRunner runner = run(text, 300);
  EXPECT_NEAR(runner.world().probe(runner.gases()[0], {0.5, 0.4531, 0.05}).velocity.x, -0.2109, 0.01);
  EXPECT_NEAR(runner.world().probe(runner.gases()[0], {0.8047, 0.5, 0.05}).velocity.y, -0.2453, 0.012);
}

}  // namespace
}  // namespace gyre::scene_fluid_test
