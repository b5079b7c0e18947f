// The kernels of gases, one table for each kind of processor: transport of fields, and the stencils and transfers of the pressure equation.
// A kernel works on a range of rows of cells, numbered row = j + k * rows along y; several workers may do several ranges at once, since each
// writes only its own rows. Every width gives the same bits.
//
// The pressure equation is the sum of a (x_i - x_n) over the six faces of a cell, plus g x_i, = b_i; a is 0 where a face is closed. Arrays of cell
// centres have zeros beyond the last cell of a row, and ghosts as fluid/grid/gas_grid.h says.
#pragma once

#include "fluid/grid/grid_shape.h"

#include <cstdint>

namespace gyre {

// A row of cells. plain: coefficients are the same along it but at its ends; empty: no cell has an equation.
enum class PressureRow : std::uint8_t { mixed, plain, empty };

// One level of the pressure equation.
struct PressureLevel {
  GridShape shape;
  const float* face[3] = {};                // a, 1/m^2
  const float* inverse_diagonal = nullptr;  // 0: no equation here
  const float* transfer = nullptr;          // scales what goes to the next coarser level, and comes from it
  const float* ground = nullptr;            // g, 1/m^2: the surface of a liquid; null: 0
  const PressureRow* rows = nullptr;
  bool halved[3] = {};  // axes along which the next coarser level has half the cells
};

// A field that moves with the gas: each point gets the value that was `back` cells before it.
struct TransportPass {
  GridShape shape;
  int points[3] = {};  // along each axis; one more than cells across the faces' own
  int average =
      0;  // displacements are the mean of this point's and of that `average` before it: the stride of the faces' axis, or 0
  float low[3] = {};  // sample points are clamped to these, in cells
  float high[3] = {};
  float period[3] = {};       // 0: not periodic
  const float* back[3] = {};  // in cells; null: 0
  const float* ahead[3] = {};
  float* field = nullptr;  // before and after
  float* moved = nullptr;  // by the first order scheme
  float* lower = nullptr;  // the bounds of what may come there
  float* upper = nullptr;
};

// The displacements of cell centres by the midpoint rule: back, and ahead.
struct TracePass {
  GridShape shape;
  float low[3] = {}, high[3] = {}, period[3] = {};
  const float* velocity[3] = {};  // at centres, in cells per step; null: 0
  float* back[3] = {};
  float* ahead[3] = {};
};

// Rows of points that the kernels below work on: cells, or the faces across an axis.
struct FieldRows {
  GridShape shape;
  int points[3] = {};
};
// Velocities of centres to vorticity, and that to the force of confinement.
struct VortexPass {
  GridShape shape;
  float half_inverse[3] = {};  // 1/m: half of one over the edge of a cell; 0: flat
  float* center[3] = {};       // velocity in, force out
  float* vorticity[3] = {};
  float* size = nullptr;  // of the vorticity
  float strength = 0.0f;  // m
};

// Particles of a liquid along one axis; cells and places are counted from the lower corner of the liquid's box, of which the grid may hold a part. Beyond the last centre before a wall there is a mirror image.
struct ParticleAxis {
  float inverse_edge = 0.0f, edge = 0.0f;  // of a cell
  int first_face = 0, last_face = 0;       // the first of the grid and the last one with a face above it
  int low = 0, last_center = 0;            // the first and the last centre with one above it
  float highest_center = 0.0f;
  bool wraps = false;
  float length = 0.0f;                           // m, of the box
  float lower_wall = 0.0f, upper_wall = 0.0f;    // m: paths stay between
  float lower_limit = 0.0f, upper_limit = 0.0f;  // m: and so do particles; beyond the box at open sides
  float lower_speed = 0.0f, upper_speed = 0.0f;  // m/s: bounds of the speed of a particle that a wall stops
};
struct ParticlePass {
  GridShape shape;  // of the grid; `first` is where the first cell of the box would lie
  ParticleAxis axes[3];
  const float* position[3] = {};
  float* motion[3] = {};
  float* affine[9] = {};
  const float* volume = nullptr;
  // Sums: pairs of volume and momentum on faces, null: the axis is flat; volume at centres.
  float* sums[3] = {};
  float* filled = nullptr;
  // Motion: velocity on faces, null: the axis is flat, and what carries particles; before: null if particles take the whole velocity.
  const float* velocity[3] = {};
  const float* carrier[3] = {};
  const float* before[3] = {};
  const std::uint8_t* wet = nullptr;  // of centres: liquid among this and the seven above along the axes
  float* to[3] = {};                  // new positions, of particle to_begin on
  int to_begin = 0;
  float step = 0.0f, blend = 1.0f;
  float fall[3] = {};     // m/s: of particles away from liquid
  bool finishes = false;  // keeps them within walls; else the caller does
};

struct GasKernels {
  int width;
  // y = A x; the sum of x times y.
  double (*apply)(const PressureLevel& level, const float* x, float* y, int row_begin, int row_end);
  // y = transfer (b - A x)
  void (*residual)(const PressureLevel& level, const float* b, const float* x, float* y, int row_begin,
                   int row_end);
  // out = x + inertia (x - before) + gain (b - A x) / diagonal, which may be stored in place of `before`; no `before` means 0. The
  // sum of out times b.
  double (*smooth)(const PressureLevel& level, const float* b, const float* x, const float* before,
                   float inertia, float gain, float* out, int row_begin, int row_end);
  // out = gain b / diagonal
  void (*scale)(const PressureLevel& level, const float* b, float gain, float* out, int row_begin,
                int row_end);
  // Rows of the coarser level: b there = what the eight or fewer cells around give, `fine` being scaled by transfer.
  void (*restrict_rows)(const PressureLevel& fine_level, const GridShape& coarse, const float* fine, float* b,
                        int row_begin, int row_end);
  // x += transfer times the coarser level's x, linearly between its cells.
  void (*prolong)(const PressureLevel& fine_level, const GridShape& coarse, const float* coarse_x, float* x,
                  int row_begin, int row_end);
  // x += alpha p, r -= alpha q; the largest |r|.
  float (*advance)(const PressureLevel& level, float alpha, const float* p, const float* q, float* x,
                   float* r, int row_begin, int row_end);
  // p = z + beta p
  void (*update_direction)(const PressureLevel& level, float beta, const float* z, float* p, int row_begin,
                           int row_end);

  // velocity -= scale (field - field at -stride) on faces that have a coefficient.
  void (*subtract_gradient)(const FieldRows& rows, const float* face, const float* field, int stride,
                            float scale, float* velocity, int row_begin, int row_end);
  // velocity += constant + scale (field + field at -stride), likewise.
  void (*add_mean)(const FieldRows& rows, const float* face, const float* field, int stride, float constant,
                   float scale, float* velocity, int row_begin, int row_end);
  // to = scale (from + from at stride)
  void (*find_mean)(const FieldRows& rows, const float* from, int stride, float scale, float* to,
                    int row_begin, int row_end);
  // to = the sum over the axes of scale (velocity - velocity at stride), where a cell has an equation, else 0.
  void (*find_inflow)(const PressureLevel& level, const float* const (&velocity)[3], const float (&scale)[3],
                      float* to, int row_begin, int row_end);
  // The same of what passes through the open fraction of faces; empty rows become 0.
  void (*find_open_inflow)(const PressureLevel& level, const float* const (&open)[3],
                           const float* const (&velocity)[3], const float (&scale)[3], float* to,
                           int row_begin, int row_end);
  // field -= scale weight (x - x at -stride) at `count` faces.
  void (*subtract_weighted)(const float* weight, const float* x, int stride, float scale, float* field,
                            int count);
  // The cells of particles [begin, end) in the order of rows, -1: it has left, or its velocity is not finite.
  void (*find_cells)(const ParticlePass& pass, int begin, int end, std::int32_t* cell);
  // Adds the sums of particles [begin, end) of a row of cells to the grid.
  void (*add_particles)(const ParticlePass& pass, int begin, int end);
  // Velocity, slopes and new positions of particles.
  void (*move_particles)(const ParticlePass& pass, int begin, int end);
  // The largest magnitude.
  float (*largest)(const FieldRows& rows, const float* field, int row_begin, int row_end);
  void (*find_vorticity)(const VortexPass& pass, int row_begin, int row_end);
  void (*find_confinement)(const VortexPass& pass, int row_begin, int row_end);

  void (*trace)(const TracePass& pass, int row_begin, int row_end);
  // moved, lower and upper; rows are of `points`.
  void (*move)(const TransportPass& pass, int row_begin, int row_end);
  // field, corrected by half of what tracing back to the start again misses, within the bounds.
  void (*correct)(const TransportPass& pass, int row_begin, int row_end);
  // field becomes the correction, lower the fraction of it that the bounds allow.
  void (*find_correction)(const TransportPass& pass, int row_begin, int row_end);
  // field = moved + the correction times the smallest fraction of a cell and its six neighbours.
  void (*add_correction)(const TransportPass& pass, int row_begin, int row_end);
};

// The kernels for this many lanes, 0: as many as suit this machine.
const GasKernels& select_gas_kernels(int width);

}  // namespace gyre
