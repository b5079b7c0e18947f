// Helpers of the tests of contacts of soft surfaces: sheets, and soft bodies that step by themselves and touch each other alone.
#pragma once

#include "soft/contact/surface_contacts.h"
#include "soft/contact/surface_crossings.h"
#include "soft/elements/cloth.h"
#include "soft/elements/solid.h"
#include "soft/solver/coupled_solve.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/soft_test_kit.h"

#include <cmath>

namespace gyre::surface_test {

using soft_test::Bench;

// The triangles of a grid of cells, as grid_cloth() numbers its particles.
inline Array<std::uint32_t> grid_triangles(int columns, int rows) {
  Array<std::uint32_t> out;
  const auto at = [&](int i, int j) { return std::uint32_t(i + j * (columns + 1)); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t quad[6] = {at(i, j),     at(i, j + 1), at(i + 1, j),
                                     at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)};
      out.append(quad);
    }
  }
  return out;
}

inline Array<DVec3> places_of(const SoftBody& body) {
  Array<DVec3> out;
  for (int i = 0; i < body.particles.count; ++i) out.push_back(body.particles.place(i));
  return out;
}

struct Surfaces {
  Array<SoftSurface> surfaces;
  Array<PlacedSurface> placed;
  Array<DVec3> positions;

  void add(std::span<const DVec3> places, std::span<const std::uint32_t> triangles, float radius) {
    surfaces.push_back(make_surface(places, triangles, radius));
    const std::uint32_t first = std::uint32_t(positions.size());
    positions.append(places);
    placed.push_back({nullptr, first});
    for (std::size_t i = 0; i < placed.size(); ++i) placed[i].surface = &surfaces[i];
  }
};

// A random sheet: a grid whose vertices are moved about, far enough to cross itself.
template <class Random>
Array<DVec3> crumpled(int cells, double scatter, double lift, Random& random) {
  Array<DVec3> out;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      out.push_back({double(i) / cells + random.between(-scatter, scatter), random.between(-lift, lift),
                     double(j) / cells + random.between(-scatter, scatter)});
    }
  }
  return out;
}

// Soft bodies in half steps, with contacts of their surfaces and nothing else.
struct SoftScene {
  Bench bench;
  Arena contact_arena;
  Array<SoftBody> bodies;
  Surfaces all;
  SurfaceContacts contacts;
  ImplicitSettings implicit;
  SurfaceContactSettings settings;
  BoundReport report;

  SoftScene(float step, Vec3 gravity) {
    implicit.step = settings.step = step;
    implicit.gravity = gravity;
  }
  void add(SoftBody body, std::span<const std::uint32_t> triangles, float radius) {
    const Array<DVec3> places = places_of(body);
    all.add(places, triangles, radius);
    bodies.push_back(std::move(body));
  }
  void add_sheet(float size, int cells, Pose pose, const ClothMaterial& material, float radius) {
    add(grid_cloth({size, size}, {cells, cells}, pose, material), grid_triangles(cells, cells), radius);
  }

  void step() {
    bench.arena.reset();
    contact_arena.reset();
    Array<ImplicitStep> steps;
    if (contacts.totals.size() != all.positions.size()) contacts.clear(all.positions.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      SoftBody& body = bodies[k];
      Particles& p = body.particles;
      for (int i = 0; i < p.count; ++i) {
        const Vec3 force = (1.0f / implicit.step) * contacts.totals[all.placed[k].first + std::size_t(i)];
        p.fx[i] = force.x, p.fy[i] = force.y, p.fz[i] = force.z;
      }
      steps.push_back(begin_implicit(body, implicit, bench.kernels, bench.arena, bench.tasks));
    }
    const std::size_t count = all.positions.size();
    Array<Vec3> velocities;
    Array<float> inverse_mass;
    Array<Sym3> blocks;
    Array<DVec3> targets;
    velocities.assign(count, Vec3{}), inverse_mass.assign(count, 0.0f), blocks.assign(count, Sym3{});
    targets.assign(count, DVec3{});
    Array<CoupledBody> coupled;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Particles& p = bodies[k].particles;
      const std::uint32_t first = all.placed[k].first;
      coupled.push_back({&bodies[k], &steps[k], {}, first});
      for (int i = 0; i < p.count; ++i) {
        const std::size_t v = first + std::size_t(i);
        all.positions[v] = p.place(i);
        velocities[v] = p.velocity(i);
        inverse_mass[v] = p.loose[i] / p.mass[i];
        blocks[v] = gyre::inverse_mass(steps[k], i);
      }
    }
    const SurfaceVertices vertices{all.positions, velocities, inverse_mass, blocks};
    find_surface_contacts(all.placed, vertices, settings, contact_arena, bench.tasks, contacts);
    make_coupling_rows(vertices, settings, contacts);
    Array<Vec3> change;
    change.resize(count);
    const CoupledVertices solved{blocks, velocities, contacts.owed, change};
    solve_coupled(coupled, {}, contacts.rows, solved,
                  {.rest_speed = 0.03f * settings.step * settings.gravity}, bench.kernels, contact_arena,
                  bench.tasks);
    take_impulses(inverse_mass, contacts);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      Particles& p = bodies[k].particles;
      for (int i = 0; i < p.count; ++i) {
        const std::size_t v = all.placed[k].first + std::size_t(i);
        velocities[v] = p.velocity(i) + change[v];
        p.set_velocity(i, velocities[v]);
      }
    }
    push_surfaces(vertices, settings, contact_arena, contacts);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      Particles& p = bodies[k].particles;
      finish_implicit(bodies[k], steps[k], bench.kernels, bench.tasks);
      for (int i = 0; i < p.count; ++i) targets[all.placed[k].first + std::size_t(i)] = p.place(i);
    }
    report = move_surfaces(all.placed, vertices, targets, settings, contact_arena, bench.tasks, contacts);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      Particles& p = bodies[k].particles;
      for (int i = 0; i < p.count; ++i) p.set_place(i, all.positions[all.placed[k].first + std::size_t(i)]);
    }
  }

  long crossings() { return count_crossings(all.placed, all.positions, contact_arena); }
  double energy() const {
    double sum = 0.0;
    for (const SoftBody& body : bodies) {
      sum += elastic_energy(body) + soft_test::kinetic_energy(body);
      for (int i = 0; i < body.particles.count; ++i) {
        sum -= double(body.particles.mass[i]) * dot(DVec3(implicit.gravity), body.particles.place(i));
      }
    }
    return sum;
  }
};

}  // namespace gyre::surface_test
