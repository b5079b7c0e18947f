// The kernels of the implicit step of a soft body, one table for each kind of processor. A kernel works on a range of slices
// (soft/body/sliced_rows.h); ranges may be done by several workers at once, since each writes only its own rows. Every width gives the same bits.
//
// The kernels solve for d = v' - v, the change of velocity in the sub-step (soft/solver/implicit_step.h):
//
//   A d = b,  A = M + sum of the elements' matrices, scaled.
#pragma once

#include "soft/body/element_blocks.h"

#include <gyre/math.h>

namespace gyre {

// Three rows of numbers: a vector for each particle.
struct VectorRows {
  float* x = nullptr;
  float* y = nullptr;
  float* z = nullptr;
};

// The pattern of a matrix without its values. No slices: there is no such matrix.
struct RowPattern {
  const std::int32_t* slot_begin = nullptr;
  const RowSlot* slots = nullptr;
  const std::int32_t* columns = nullptr;
};

// The kernels of one sub-step of one body read and write these arrays.
struct SoftPass {
  int slices = 0;
  // Springs, and bending where it has the same places: B = a 1 + n n^T, four numbers a place, those of 16 places one after the other (n.x of
  // all, n.y, n.z, a).
  RowPattern springs;
  const float* rest_length = nullptr;
  const float* stiffness = nullptr;
  const float* spring_bend = nullptr;
  float* spring_blocks = nullptr;
  // Bending of other pairs: B = c 1.
  RowPattern bend;
  const float* bend_stiffness = nullptr;
  // Continua: B of nine numbers a place, column after column. Their elements add to `corner_force`, four numbers a particle, and
  // `edge_blocks`; both begin at zero.
  RowPattern full;
  float* full_blocks = nullptr;
  const TetBlock* tetrahedra = nullptr;
  const CellBlock* cells = nullptr;
  const TriangleBlock* triangles = nullptr;
  const std::int32_t* edge_of_place = nullptr;
  ElementMaterial material;
  float* corner_force = nullptr;
  float* edge_blocks = nullptr;

  double* x = nullptr;
  double* y = nullptr;
  double* z = nullptr;
  VectorRows velocity, outside;  // outside: forces
  const float* mass = nullptr;
  const float* loose = nullptr;

  VectorRows force;         // of the elements
  float* diagonal[6] = {};  // sum of a row's B, scaled: xx, yy, zz, xy, xz, yz
  float* inverse[6] = {};   // of the block of A on the diagonal; zero where held
  VectorRows change;        // d
  VectorRows residual;      // b - A d
  VectorRows direction;     // p
  VectorRows product;       // A p, then the preconditioned residual

  // Enclosed gas: adds volume_scale g g^T to the matrix, three numbers of g a row. The solver has it beside the kernels.
  const Vec3* volume_gradient = nullptr;
  float volume_scale = 0.0f;

  float step = 0.0f;             // s
  float material_scale = 0.0f;   // s^2: of what depends on the rate of strain and on strain
  float geometric_scale = 0.0f;  // s^2: of what tension does to its own direction
  float velocity_scale = 1.0f;   // how much of A - M the velocity at the start asks for
  float move_scale = 1.0f;       // particles move by step (v + move_scale d), v at the start
  float damping = 0.0f;          // s: for find_forces; the other kernels have it in the scales
  Vec3 gravity{};
};

struct SoftKernels {
  int width;
  // Blocks of tetrahedra: their forces and stiffness; their forces alone.
  void (*add_tetrahedra)(const SoftPass& pass, int block_begin, int block_end);
  void (*add_tetrahedra_forces)(const SoftPass& pass, int block_begin, int block_end);
  // The same of cells.
  void (*add_cells)(const SoftPass& pass, int block_begin, int block_end);
  void (*add_cells_forces)(const SoftPass& pass, int block_begin, int block_end);
  // The same of triangles.
  void (*add_triangles)(const SoftPass& pass, int block_begin, int block_end);
  void (*add_triangles_forces)(const SoftPass& pass, int block_begin, int block_end);
  // Forces, rows of the matrix and diagonals from what the elements of continua have added up; the forces alone.
  void (*fill_rows)(const SoftPass& pass, int slice_begin, int slice_end);
  void (*fill_forces)(const SoftPass& pass, int slice_begin, int slice_end);
  // Forces, blocks of springs and diagonals at the present places, added to those of continua if there are any.
  void (*linearize)(const SoftPass& pass, int slice_begin, int slice_end);
  // Forces alone, with those of damping.
  void (*find_forces)(const SoftPass& pass, int slice_begin, int slice_end);
  // product = d + velocity_scale v
  void (*start)(const SoftPass& pass, int slice_begin, int slice_end);
  // inverse, residual and the first direction, of d and of `product` as start() left it; the sum of residual times preconditioned residual.
  double (*begin)(const SoftPass& pass, int slice_begin, int slice_end);
  // The first direction, of a residual that is there, and the sum of both.
  double (*precondition)(const SoftPass& pass, int slice_begin, int slice_end);
  // The sum of p times the residual.
  double (*match)(const SoftPass& pass, int slice_begin, int slice_end);
  // product = A p; the sum of p times it.
  double (*apply)(const SoftPass& pass, int slice_begin, int slice_end);
  // d += alpha p, residual -= alpha A p; product becomes the preconditioned residual; the sum of the residual times that.
  double (*advance)(const SoftPass& pass, float alpha, int slice_begin, int slice_end);
  // p = preconditioned residual + beta p
  void (*turn)(const SoftPass& pass, float beta, int slice_begin, int slice_end);
  // x += step (v + (move_scale - 1) d), with v the velocities at the end
  void (*finish)(const SoftPass& pass, int slice_begin, int slice_end);
};

// The kernels for this many lanes, 0: as many as suit this machine.
const SoftKernels& select_soft_kernels(int width);

}  // namespace gyre
