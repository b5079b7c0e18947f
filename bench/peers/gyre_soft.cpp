// Soft matter in Gyre: gyre_soft SCENE FRAMES [INTEGRATOR] [SUBSTEPS] [STIFFNESS]
//
// `implicit`, 4 and 1,000 N/m if not given. STIFFNESS is that of the sheet that hangs, along edges and of shear; other scenes have the
// defaults of `ClothDef` and `RopeDef`. One thread.
#include <gyre/gyre.h>

#include <cstdio>
#include <cstdlib>

#include "bench/scenes/soft_judge.h"

using namespace gyre;
using namespace gyre::bench::soft;

namespace {

SoftIntegrator integrator_named(const std::string& name) {
  for (const SoftIntegrator i : {SoftIntegrator::implicit, SoftIntegrator::sdirk2, SoftIntegrator::visual}) {
    if (name == to_string(i)) return i;
  }
  std::fprintf(stderr, "no integrator %s\n", name.c_str());
  std::exit(2);
}

SoftId add_sheet(World& world, const std::string& scene, float stiffness, SoftIntegrator integrator) {
  const Sheet sheet = make_sheet(scene);
  const int cells = int(Sheet::kSide) - 1;
  ClothDef def{.grid = ClothGrid{{float(Sheet::kSize), float(Sheet::kSize)}, {cells, cells}},
               .pose = {{0, sheet.vertices[0].y, 0}, {}},
               .area_density = Sheet::kAreaDensity,
               .stretch_stiffness = stiffness,
               .thickness = Sheet::kThickness,
               .self_collision = !sheet.held};
  if (sheet.held) def.shear_stiffness = stiffness;
  def.settings.integrator = integrator;
  def.settings.static_friction = def.settings.dynamic_friction = kFriction;
  const SoftId cloth = world.add_cloth(def);
  if (sheet.held) {
    for (const std::uint32_t v : Sheet::kHeld) world.pin(cloth, int(v));
    return cloth;
  }
  const auto add_fixed = [&](DVec3 middle, ShapeDef shape) {
    shape.material.static_friction = shape.material.dynamic_friction = kFriction;
    world.add_body({.type = BodyType::fixed, .pose = {middle, {}}}, shape);
  };
  add_fixed({0, -1, 0}, {.geometry = Box{{20, 1, 20}}});
  add_fixed({0, Sheet::kBallHeight, 0}, {.geometry = Sphere{Sheet::kBallRadius}});
  return cloth;
}

SoftId add_beam(World& world, SoftIntegrator integrator) {
  const Beam beam = make_beam();
  SolidDef def{.model = SolidModel::corotated,
               .density = Beam::kDensity,
               .young_modulus = Beam::kYoungModulus,
               .poisson_ratio = Beam::kPoissonRatio};
  for (const DVec3& p : beam.vertices) def.vertices.push_back({float(p.x), float(p.y), float(p.z)});
  for (const Tetrahedron& t : beam.tetrahedra)
    def.tetrahedra.insert(def.tetrahedra.end(), t.begin(), t.end());
  def.settings.integrator = integrator;
  const SoftId solid = world.add_solid(def);
  for (const std::uint32_t v : beam.clamped) world.pin(solid, int(v));
  return solid;
}

SoftId add_rope(World& world, SoftIntegrator integrator) {
  RopeDef def{.points = make_rope().vertices,
              .linear_density = Rope::kLinearDensity,
              .bend_stiffness = Rope::kBendStiffness};
  def.settings.integrator = integrator;
  const SoftId rope = world.add_rope(def);
  world.pin(rope, 0);
  return rope;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  const std::string name = arguments.rest.empty() ? "implicit" : arguments.rest[0];
  const SoftIntegrator integrator = integrator_named(name);
  const int substeps = arguments.number(0, 4), stiffness = arguments.number(1, 1000);
  WorldDef def{.gravity = {0, kGravity, 0}, .threads = 1, .sleeping = false};
  def.stepping.substeps = substeps;
  Result<World> made = World::create(def);
  if (!made) {
    std::fprintf(stderr, "%s\n", made.error().message);
    return 1;
  }
  World world = *std::move(made);
  SoftId soft{};
  if (arguments.scene == "hanging" || arguments.scene == "folded")
    soft = add_sheet(world, arguments.scene, float(stiffness), integrator);
  else if (arguments.scene == "beam")
    soft = add_beam(world, integrator);
  else if (arguments.scene == "rope")
    soft = add_rope(world, integrator);
  else
    return skip("gyre", arguments.scene);
  return judge(arguments.scene, arguments.frames,
               {.engine = "gyre",
                .settings = name + ", " + count_of(substeps, "sub-step") +
                            (arguments.scene == "hanging" ? ", " + std::to_string(stiffness) + " N/m" : ""),
                .step =
                    [&] {
                      if (!world.step(kStep)) std::exit(1);
                    },
                .read =
                    [&](std::vector<DVec3>& to) {
                      const SoftVertices v = world.vertices(soft);
                      to.clear();
                      for (std::size_t i = 0; i < v.size(); ++i) to.push_back(v.position(i));
                    }});
}
