#include "soft/solver/soft_pass.h"

#include "task/parallel.h"

namespace gyre {

VectorRows make_vectors(Arena& arena, std::size_t rows) {
  return {arena.make<float>(rows).data(), arena.make<float>(rows).data(), arena.make<float>(rows).data()};
}

namespace {

// No slots: no such matrix.
RowPattern pattern_of(const SlicedRows& rows) {
  return {rows.slots.empty() ? nullptr : rows.slot_begin.data(), rows.slots.data(), rows.columns.data()};
}

}  // namespace

SoftPass begin_pass(SoftBody& body, Arena& arena) {
  SoftPass pass;
  Particles& particles = body.particles;
  pass.springs = pattern_of(body.springs.rows);
  pass.rest_length = body.springs.rest_length.data();
  pass.stiffness = body.springs.stiffness.data();
  pass.spring_bend = body.springs.bend.data();
  pass.bend = pattern_of(body.bend.rows);
  pass.bend_stiffness = body.bend.stiffness.data();
  pass.x = particles.x.data(), pass.y = particles.y.data(), pass.z = particles.z.data();
  pass.velocity = {particles.vx.data(), particles.vy.data(), particles.vz.data()};
  pass.outside = {particles.fx.data(), particles.fy.data(), particles.fz.data()};
  pass.slices = padded_rows(particles.count) / kSliceRows;
  pass.mass = particles.mass.data();
  pass.loose = particles.loose.data();
  if (!body.continuum.empty()) {
    const Continuum& continuum = body.continuum;
    pass.full = pattern_of(continuum.rows);
    pass.tetrahedra = continuum.tetrahedra.data();
    pass.cells = continuum.cells.data();
    pass.triangles = continuum.triangles.data();
    pass.edge_of_place = continuum.edge_of_place.data();
    pass.material = continuum.material;
    pass.corner_force = arena.make<float>(4 * particles.x.size()).data();
  }
  pass.force = make_vectors(arena, std::size_t(padded_rows(particles.count)));
  return pass;
}

namespace {

constexpr int kBlockRows = 1024;  // of what is only made zero

void clear(float* numbers, std::size_t count, TaskSystem& tasks) {
  for_blocks(tasks, int(count / 4), kBlockRows, [&](int begin, int end, int) {
    for (int i = 4 * begin; i < 4 * end; ++i) numbers[i] = 0.0f;
  });
}

// The elements of a colour share no particle, so their chunks may be worked on at once. (All that have the last colour there is may share
// some.)
void add_elements(const SoftPass& pass, const ColoredChunks& colored, int blocks,
                  void (*kernel)(const SoftPass&, int, int), TaskSystem& tasks) {
  for (int color = 0; color + 1 < int(colored.begin.size()); ++color) {
    const int first = colored.begin[color], count = colored.begin[color + 1] - first;
    for_blocks(tasks, count, color == kLastChunkColor ? count : 1, [&](int begin, int end, int) {
      for (int k = begin; k < end; ++k) {
        const int block = colored.chunks[first + k] * kChunkBlocks;
        kernel(pass, block, block + kChunkBlocks < blocks ? block + kChunkBlocks : blocks);
      }
    });
  }
}

template <class Kernel>
void each_slice(const SoftPass& pass, Kernel kernel, TaskSystem& tasks) {
  for_blocks(tasks, pass.slices, kBlockSlices, [&](int begin, int end, int) { kernel(pass, begin, end); });
}

}  // namespace

void find_forces(const SoftPass& pass, const SoftBody& body, const SoftKernels& kernels, TaskSystem& tasks) {
  if (!body.continuum.empty()) {
    clear(pass.corner_force, 4 * kSliceRows * std::size_t(pass.slices), tasks);
    const Continuum& continuum = body.continuum;
    add_elements(pass, continuum.tetrahedron_chunks, int(continuum.tetrahedra.size()),
                 kernels.add_tetrahedra_forces, tasks);
    add_elements(pass, continuum.cell_chunks, int(continuum.cells.size()), kernels.add_cells_forces, tasks);
    add_elements(pass, continuum.triangle_chunks, int(continuum.triangles.size()),
                 kernels.add_triangles_forces, tasks);
    each_slice(pass, kernels.fill_forces, tasks);
  }
  each_slice(pass, kernels.find_forces, tasks);
}

void linearize(const SoftPass& pass, const SoftBody& body, const SoftKernels& kernels, TaskSystem& tasks) {
  if (!body.continuum.empty()) {
    clear(pass.corner_force, 4 * kSliceRows * std::size_t(pass.slices), tasks);
    clear(pass.edge_blocks, kEdgeFloats * (std::size_t(body.continuum.edges) + 1), tasks);
    const Continuum& continuum = body.continuum;
    add_elements(pass, continuum.tetrahedron_chunks, int(continuum.tetrahedra.size()), kernels.add_tetrahedra,
                 tasks);
    add_elements(pass, continuum.cell_chunks, int(continuum.cells.size()), kernels.add_cells, tasks);
    add_elements(pass, continuum.triangle_chunks, int(continuum.triangles.size()), kernels.add_triangles,
                 tasks);
    each_slice(pass, kernels.fill_rows, tasks);
  }
  each_slice(pass, kernels.linearize, tasks);
}

void place_held(SoftBody& body) {
  for (const HeldParticle& one : body.held) body.particles.set_place(one.particle, one.place);
}

}  // namespace gyre
