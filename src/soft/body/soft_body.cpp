#include "soft/body/soft_body.h"

namespace gyre {

namespace {

// N/kg: EA by the mass of a rope that keeps its length but is held at several vertices, about that of steel. These may be further apart
// than it is long, and bodies between them must not be pulled by the rounding of its length.
constexpr double kHeldRodStiffness = 1.0e7;

}  // namespace

double SoftBody::rope_stiffness() const {
  if (chain.stretch_stiffness > 0.0 || held.size() < 2) return chain.stretch_stiffness;
  double mass = 0.0;
  for (int i = 0; i < particles.count; ++i) mass += double(particles.mass[i]);
  return kHeldRodStiffness * mass;
}

void Particles::resize(int particles) {
  count = particles;
  const std::size_t rows = std::size_t(padded_rows(particles));
  for (Array<double>* const column : {&x, &y, &z}) column->resize(rows);
  for (Array<float>* const column : {&vx, &vy, &vz, &fx, &fy, &fz, &mass, &loose}) column->resize(rows);
  for (int i = 0; i < particles; ++i) loose[i] = 1.0f;
}

void add_quadratic(Array<MatrixEntry>& entries, std::span<const std::uint32_t> particles,
                   std::span<const double> signs, double weight) {
  for (std::size_t a = 0; a < particles.size(); ++a) {
    for (std::size_t b = 0; b < particles.size(); ++b) {
      entries.push_back({particles[a], particles[b], weight * signs[a] * signs[b]});
    }
  }
}

void set_springs(SoftBody& body, std::span<const Spring> springs) {
  // Springs of the same two particles act as one with the sum of their stiffness and the mean of their lengths, weighted by it.
  Array<MatrixEntry> stiffness, tension;
  for (const Spring& spring : springs) {
    const double k = double(spring.stiffness), pull = k * double(spring.rest_length);
    stiffness.push_back({spring.a, spring.b, k});
    stiffness.push_back({spring.b, spring.a, k});
    tension.push_back({spring.a, spring.b, pull});
    tension.push_back({spring.b, spring.a, pull});
  }
  merge_entries(stiffness);
  merge_entries(tension);
  Array<std::int32_t> place;
  SpringRows& rows = body.springs;
  rows.rows = slice_rows(list_neighbours(stiffness, body.particles.count), place);
  rows.rest_length.assign(rows.rows.places(), 0.0f);
  rows.stiffness.assign(rows.rows.places(), 0.0f);
  rows.bend.assign(rows.rows.places(), 0.0f);
  for (std::size_t k = 0; k < place.size(); ++k) {
    rows.stiffness[place[k]] = float(stiffness[k].value);
    rows.rest_length[place[k]] =
        stiffness[k].value > 0.0 ? float(tension[k].value / stiffness[k].value) : 0.0f;
  }
}

void set_bending(SoftBody& body, Array<MatrixEntry>& entries) {
  merge_entries(entries);
  // A product with the matrix reads each neighbour once where springs and bending share a place.
  std::size_t kept = 0;
  for (const MatrixEntry& entry : entries) {
    const int place = find_place(body.springs.rows, entry.row, entry.column);
    if (place >= 0) body.springs.bend[place] = float(-entry.value);
    if (place < 0) entries[kept++] = entry;
  }
  entries.resize(kept);
  Array<std::int32_t> place;
  BendRows& rows = body.bend;
  rows.rows = slice_rows(list_neighbours(entries, body.particles.count), place);
  rows.stiffness.assign(rows.rows.places(), 0.0f);
  for (std::size_t k = 0; k < place.size(); ++k) rows.stiffness[place[k]] = float(-entries[k].value);
}

void hold(SoftBody& body, int particle, DVec3 place) {
  body.particles.loose[particle] = 0.0f;
  for (HeldParticle& one : body.held) {
    if (one.particle == particle) {
      one.place = place;
      return;
    }
  }
  body.held.push_back({particle, place});
}

void let_go(SoftBody& body, int particle) {
  body.particles.loose[particle] = 1.0f;
  for (std::size_t k = 0; k < body.held.size(); ++k) {
    if (body.held[k].particle == particle) {
      body.held.erase_at(k);
      return;
    }
  }
}

}  // namespace gyre
