// Soft matter in the core of the library PositionBasedDynamics: pbd_soft SCENE FRAMES [SUBSTEPS] [ITERATIONS] [STIFFNESS] [UNIT]
//
// 5 sub-steps of one iteration if not given: its defaults. Its constraints are called group by group, as its own loop over a step does, without
// the virtual calls around them: its layer of models wants two more libraries. STIFFNESS of the sheet that hangs, N/m: 1,000 if not given.
// UNIT, in mm: 1000 if not given. Its elements drop corrections below 1e-6 in the units of its caller: in metres a beam of cells of 3 cm hardly
// feels its own stress, in centimetres (10) it does. The core has no contacts.
#include "bench/scenes/soft_judge.h"

#include <cmath>

#include <PositionBasedDynamics/PositionBasedDynamics.h>
#include <PositionBasedDynamics/TimeIntegration.h>
#include <PositionBasedDynamics/XPBD.h>

namespace {

using namespace gyre::bench::soft;
using PBD::PositionBasedDynamics;
using PBD::TimeIntegration;
using PBD::XPBD;

struct Particles {
  std::vector<Vector3r> at, before, velocity;
  std::vector<Real> mass, inverse_mass;  // both 0 if held

  Particles(const std::vector<gyre::DVec3>& vertices, const std::vector<float>& masses, Real scale) {
    for (const gyre::DVec3& p : vertices) at.push_back(scale * Vector3r(Real(p.x), Real(p.y), Real(p.z)));
    before = at;
    velocity.assign(at.size(), Vector3r::Zero());
    mass = masses;
    for (const float m : masses) inverse_mass.push_back(1 / m);
  }
  void hold(std::uint32_t v) { mass[v] = inverse_mass[v] = 0; }
};

struct Spring {
  Pair ends;
  Real rest, multiplier;
};
struct Element {
  Tetrahedron corners;
  Real volume, multiplier;
  Matrix3r inverse_rest;
};

struct Model {
  Particles particles;
  Real stiffness;  // N/m, of springs; 0: rigid
  std::vector<Spring> springs;
  std::vector<Element> elements;
  Real young_modulus = 0;

  Model(const std::vector<gyre::DVec3>& vertices, const std::vector<float>& masses, Real scale,
        Real stiffness_of_springs)
      : particles(vertices, masses, scale), stiffness(stiffness_of_springs) {}

  void add_springs(const std::vector<Pair>& pairs) {
    for (const Pair& pair : in_groups(pairs, particles.at.size()))
      springs.push_back({pair, (particles.at[pair[1]] - particles.at[pair[0]]).norm(), 0});
  }
  void solve(Spring& spring, Real h) {
    const auto [a, b] = spring.ends;
    Vector3r da, db;
    auto& [at, before, velocity, mass, w] = particles;
    if (!XPBD::solve_DistanceConstraint(at[a], w[a], at[b], w[b], spring.rest, stiffness, h,
                                        spring.multiplier, da, db))
      return;
    if (w[a] != 0) at[a] += da;
    if (w[b] != 0) at[b] += db;
  }
  void solve(Element& element, Real h) {
    const auto [a, b, c, d] = element.corners;
    auto& [at, before, velocity, mass, w] = particles;
    // Inversion is handled below a fifth of the volume, as in the library's own constraint.
    const Real volume = (at[b] - at[a]).cross(at[c] - at[a]).dot(at[d] - at[a]) / 6;
    const bool handle = volume < Real(0.2) * element.volume;
    Vector3r move[4];
    if (!XPBD::solve_FEMTetraConstraint(at[a], w[a], at[b], w[b], at[c], w[c], at[d], w[d], element.volume,
                                        element.inverse_rest, young_modulus, Beam::kPoissonRatio, handle, h,
                                        element.multiplier, move[0], move[1], move[2], move[3]))
      return;
    for (int i = 0; i < 4; ++i) {
      if (w[element.corners[i]] != 0) at[element.corners[i]] += move[i];
    }
  }
  void step(int substeps, int iterations, Real gravity) {
    const Real h = kStep / Real(substeps);
    const Vector3r acceleration(0, gravity, 0);
    auto& [at, before, velocity, mass, w] = particles;
    for (int s = 0; s < substeps; ++s) {
      for (std::size_t i = 0; i < at.size(); ++i) {
        before[i] = at[i];
        TimeIntegration::semiImplicitEuler(h, mass[i], at[i], velocity[i], acceleration);
      }
      for (Spring& spring : springs) spring.multiplier = 0;
      for (Element& element : elements) element.multiplier = 0;
      for (int k = 0; k < iterations; ++k) {
        for (Spring& spring : springs) solve(spring, h);
        for (Element& element : elements) solve(element, h);
      }
      for (std::size_t i = 0; i < at.size(); ++i)
        TimeIntegration::velocityUpdateFirstOrder(h, mass[i], at[i], before[i], velocity[i]);
    }
  }
};

Model make_hanging(Real stiffness) {
  const Sheet sheet = make_sheet("hanging");
  Model model(sheet.vertices, sheet.masses, 1, stiffness);
  for (const std::uint32_t v : Sheet::kHeld) model.particles.hold(v);
  std::vector<Pair> pairs = sheet.edges;
  pairs.insert(pairs.end(), sheet.diagonals.begin(), sheet.diagonals.end());
  model.add_springs(pairs);
  return model;
}
Model make_beam_model(Real scale) {
  const Beam beam = make_beam();
  Model model(beam.vertices, beam.masses, scale, 0);
  for (const std::uint32_t v : beam.clamped) model.particles.hold(v);
  for (const Tetrahedron& t : in_groups(beam.tetrahedra, beam.vertices.size())) {
    Element element{t, 0, 0, Matrix3r::Zero()};
    const auto& at = model.particles.at;
    PositionBasedDynamics::init_FEMTetraConstraint(at[t[0]], at[t[1]], at[t[2]], at[t[3]], element.volume,
                                                   element.inverse_rest);
    model.elements.push_back(element);
  }
  model.young_modulus = Beam::kYoungModulus / scale;  // kg / (unit s^2)
  return model;
}
Model make_rope_model() {
  const Rope rope = make_rope();
  Model model(rope.vertices, rope.masses, 1, 0);
  model.particles.hold(0);
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i + 1 < Rope::kVertices; ++i) pairs.push_back({i, i + 1});
  model.add_springs(pairs);
  return model;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = read_arguments(argc, argv);
  const std::string& scene = arguments.scene;
  const int substeps = arguments.number(0, 5), iterations = arguments.number(1, 1);
  const int stiffness = arguments.number(2, 1000), unit = arguments.number(3, 1000);
  const Real scale = 1000 / Real(unit);
  if (scene != "hanging" && scene != "beam" && scene != "rope") return skip("pbd", scene);
  Model model = scene == "hanging" ? make_hanging(Real(stiffness))
                : scene == "beam"  ? make_beam_model(scale)
                                   : make_rope_model();
  std::string settings = count_of(substeps, "sub-step") + " of " + count_of(iterations, "iteration");
  if (scene == "hanging") settings += ", " + std::to_string(stiffness) + " N/m";
  if (scene == "beam") settings += ", unit " + std::to_string(unit) + " mm";
  const Real gravity = scene == "beam" ? scale * kGravity : kGravity;
  return judge(scene, arguments.frames,
               {.engine = "pbd",
                .settings = settings,
                .step = [&] { model.step(substeps, iterations, gravity); },
                .read =
                    [&](std::vector<gyre::DVec3>& to) {
                      const double back = scene == "beam" ? 1.0 / double(scale) : 1.0;
                      to.clear();
                      for (const Vector3r& p : model.particles.at)
                        to.push_back({back * double(p.x()), back * double(p.y()), back * double(p.z())});
                    }});
}
