#include "soft/body/soft_energy.h"

#include "math/dense.h"
#include "soft/body/deformation.h"
#include "soft/body/enclosed_gas.h"

#include <cmath>

namespace gyre {

namespace {

// Calls what(place, distance of the two particles) for each place of the pattern that has two.
template <class What>
void each_pair(const Particles& particles, const SlicedRows& rows, What&& what) {
  if (rows.places() == 0) return;
  for (int slice = 0; slice < rows.slices(); ++slice) {
    for (int slot = rows.slot_begin[slice]; slot < rows.slot_begin[slice + 1]; ++slot) {
      const RowSlot one = rows.slots[slot];
      for (int lane = 0; lane < kSliceRows; ++lane) {
        const int row = slice * kSliceRows + lane;
        const int column = one.columns < 0 ? row + one.offset : rows.columns[one.columns + lane];
        what(slot * kSliceRows + lane, length(particles.place(column) - particles.place(row)));
      }
    }
  }
}

// Invariants of a deformation gradient by columns: |F|^2, det F, and the sum of its singular values, of which the least has the sign of
// det F.
struct Invariants {
  double square, determinant, stretch;
};

Invariants invariants(const DVec3 (&f)[3]) {
  Invariants out{};
  out.determinant = dot(f[0], cross(f[1], f[2]));
  const double gram[6] = {dot(f[0], f[0]), dot(f[1], f[1]), dot(f[2], f[2]),
                          dot(f[0], f[1]), dot(f[0], f[2]), dot(f[1], f[2])};
  out.square = gram[0] + gram[1] + gram[2];
  double moments[3], axes[9];
  symmetric_eigen(gram, moments, axes);
  for (int k = 0; k < 3; ++k) {
    const double sigma = std::sqrt(max(moments[k], 0.0));
    out.stretch += k == 0 && out.determinant < 0.0 ? -sigma : sigma;
  }
  return out;
}

double density(const Continuum& continuum, const DVec3 (&f)[3]) {
  const double mu = double(continuum.material.mu), lambda = double(continuum.material.lambda);
  if (continuum.material.model == ElementModel::linear) {
    const double trace = f[0].x + f[1].y + f[2].z - 3.0;
    const double xy = 0.5 * (f[1].x + f[0].y), xz = 0.5 * (f[2].x + f[0].z), yz = 0.5 * (f[2].y + f[1].z);
    const double strain = square(f[0].x - 1.0) + square(f[1].y - 1.0) + square(f[2].z - 1.0) +
                          2.0 * (xy * xy + xz * xz + yz * yz);
    return mu * strain + 0.5 * lambda * trace * trace;
  }
  const Invariants of = invariants(f);
  if (continuum.material.model == ElementModel::corotated) {
    return mu * (of.square - 2.0 * of.stretch + 3.0) + 0.5 * lambda * square(of.stretch - 3.0);
  }
  const double bulk = lambda + mu, excess = of.determinant - (1.0 + mu / bulk);
  // mu / 2 times the integral of min(2 I, 1) over I.
  const double spread = of.square < 0.5 ? of.square * of.square : of.square - 0.25;
  return 0.5 * mu * (spread - 2.75) + 0.5 * bulk * (excess * excess - square(mu / bulk));
}

template <class Block>
double elements_energy(const Particles& particles, const Continuum& continuum, const Array<Block>& blocks) {
  double sum = 0.0;
  for (const Block& block : blocks) {
    for (int lane = 0; lane < kTetLanes; ++lane) {
      if (block.stiffness[lane] == 0.0f) continue;
      DVec3 f[3];
      find_deformation(particles, block, lane, f);
      sum += double(block.volume[lane]) * density(continuum, f);
    }
  }
  return sum;
}

// Of the differences between tetrahedra of a cell, and of those that are pressed below kMinPartVolume.
double parts_energy(const SoftBody& body) {
  const Continuum& continuum = body.continuum;
  double spread = 0.0, pressed = 0.0;
  for (int cell = 0; cell < continuum.cell_count(); ++cell) {
    DVec3 mean[3];
    find_mean_deformation(body, cell, mean);
    for (std::int32_t k = continuum.cell_begin[cell]; k < continuum.cell_begin[cell + 1]; ++k) {
      const TetBlock& block = continuum.tetrahedra[continuum.cell_parts[k] / kTetLanes];
      const int lane = continuum.cell_parts[k] % kTetLanes;
      const double volume = double(block.volume[lane]);
      DVec3 f[3];
      find_deformation(body.particles, block, lane, f);
      for (int c = 0; c < 3; ++c) spread += volume * length_squared(f[c] - mean[c]);
      pressed += volume * square(min(dot(f[0], cross(f[1], f[2])) - double(kMinPartVolume), 0.0));
    }
  }
  return double(continuum.material.mu) * (kSpreadShare * spread + 0.5 * double(kGuardStiffness) * pressed);
}

double membrane_energy(const Particles& particles, const Continuum& continuum) {
  double sum = 0.0;
  for (const TriangleBlock& block : continuum.triangles) {
    for (int lane = 0; lane < kTetLanes; ++lane) {
      const DVec3 origin = particles.place(block.corner[0][lane]);
      const DVec3 first = particles.place(block.corner[1][lane]) - origin,
                  second = particles.place(block.corner[2][lane]) - origin;
      const auto rest = [&](int k) { return double(block.inverse[k][lane]); };
      const DVec3 f1 = rest(0) * first + rest(1) * second, f2 = rest(2) * first + rest(3) * second;
      const double e11 = 0.5 * (dot(f1, f1) - 1.0), e22 = 0.5 * (dot(f2, f2) - 1.0), e12 = 0.5 * dot(f1, f2);
      sum += double(block.area[lane]) * (0.5 * double(continuum.material.stretch) * (e11 * e11 + e22 * e22) +
                                         double(continuum.material.contraction) * e11 * e22 +
                                         2.0 * double(continuum.material.shear) * e12 * e12);
    }
  }
  return sum;
}

}  // namespace

double elastic_energy(const SoftBody& body) {
  double twice = 0.0;  // each pair stands in two rows
  const Chain& chain = body.chain;
  const double stiffness = body.rope_stiffness();
  for (std::size_t k = 0; k < chain.rest_length.size(); ++k) {
    const double rest = chain.rest_length[k];
    const double span = length(body.particles.place(int(k) + 1) - body.particles.place(int(k)));
    twice += stiffness / rest * square(span - rest);
  }
  if (chain.rest_length.empty())
    each_pair(body.particles, body.springs.rows, [&](int place, double span) {
      twice += 0.5 * double(body.springs.stiffness[place]) *
               square(span - double(body.springs.rest_length[place]));
    });
  each_pair(body.particles, body.springs.rows,
            [&](int place, double span) { twice += 0.5 * double(body.springs.bend[place]) * square(span); });
  each_pair(body.particles, body.bend.rows, [&](int place, double span) {
    twice += 0.5 * double(body.bend.stiffness[place]) * square(span);
  });
  const bool has_gas = !body.gas.triangles.empty();
  return 0.5 * twice + elements_energy(body.particles, body.continuum, body.continuum.tetrahedra) +
         elements_energy(body.particles, body.continuum, body.continuum.cells) + parts_energy(body) +
         membrane_energy(body.particles, body.continuum) +
         (has_gas ? gas_energy(body.gas, enclosed_volume(body.particles, body.gas.triangles)) : 0.0);
}

}  // namespace gyre
