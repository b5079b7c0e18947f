// The motion of bodies within the pressure equation.
#include "fluid/solver/body_coupling.h"

#include "fluid/solver/pressure_matrix.h"

namespace gyre {

namespace {

float component_of(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// A symmetric positive matrix of six rows in place to its inverse. Rows without a positive pivot become zero.
void invert_masses(double (&m)[6][6]) {
  double work[6][12] = {};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) work[i][j] = m[i][j];
    work[i][6 + i] = 1.0;
  }
  bool dead[6] = {};
  for (int i = 0; i < 6; ++i) {
    const double pivot = work[i][i];
    if (!(pivot > 0.0)) {
      dead[i] = true;
      continue;
    }
    for (int j = 0; j < 12; ++j) work[i][j] /= pivot;
    for (int row = 0; row < 6; ++row) {
      if (row == i) continue;
      const double factor = work[row][i];
      if (factor == 0.0) continue;
      for (int j = 0; j < 12; ++j) work[row][j] -= factor * work[i][j];
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m[i][j] = dead[i] || dead[j] ? 0.0 : work[i][6 + j];
}

// The force along the axis of a face with its moment: parts of six that are not zero.
struct FaceRow {
  int axis;
  const float* moment;
  double times(const double (&motion)[6]) const {
    return motion[axis] +
           (double(moment[0]) * motion[3] + double(moment[1]) * motion[4] + double(moment[2]) * motion[5]);
  }
  void add_to(double (&sum)[6], double amount) const {
    sum[axis] += amount;
    for (int i = 0; i < 3; ++i) sum[3 + i] += amount * double(moment[i]);
  }
};
FaceRow row_of(const CutFace& face) { return {face.axis, face.moment}; }

void multiply_motion(const double (&m)[6][6], const double (&v)[6], double (&out)[6]) {
  for (int i = 0; i < 6; ++i) {
    double sum = 0.0;
    for (int j = 0; j < 6; ++j) sum += m[i][j] * v[j];
    out[i] = sum;
  }
}

// J^T x of one solid.
void gather_pushes(const BodyCoupling& coupling, const SolidMotion& solid, const float* x, double (&sum)[6]) {
  for (double& one : sum) one = 0.0;
  for (int i = solid.begin; i < solid.end; ++i) {
    const CutFace& face = coupling.faces[i];
    const double upper = face.upper >= 0 ? double(x[face.upper]) : 0.0;
    const double lower = face.lower >= 0 ? double(x[face.lower]) : 0.0;
    row_of(face).add_to(sum, double(face.share) * (upper - lower));
  }
  if (solid.beside == 0) return;
  double mean = 0.0;
  for (int i = solid.begin; i < solid.end; ++i) {
    const CutFace& face = coupling.faces[i];
    if (face.upper >= 0) mean += double(x[face.upper]);
    if (face.lower >= 0) mean += double(x[face.lower]);
  }
  mean /= double(solid.beside);
  for (int i = 0; i < 6; ++i) sum[i] += mean * solid.seal[i];
}

// q of the cells around += what a motion brings by the sealed sides.
void scatter_seal(const BodyCoupling& coupling, const SolidMotion& solid, const double (&motion)[6],
                  float* q) {
  if (solid.beside == 0) return;
  double change = 0.0;
  for (int i = 0; i < 6; ++i) change += motion[i] * solid.seal[i];
  const auto each = float(change / double(solid.beside));
  for (int i = solid.begin; i < solid.end; ++i) {
    const CutFace& face = coupling.faces[i];
    if (face.upper >= 0) q[face.upper] += each;
    if (face.lower >= 0) q[face.lower] += each;
  }
}

// The push of a pressure of 1 everywhere on bodies that move, with the sign turned.
void find_seals(BodyCoupling& coupling) {
  constexpr double kNone = 1.0e-9;  // of the sum of all magnitudes
  for (SolidMotion& solid : coupling.solids) {
    if (!solid.moves) continue;
    double sum[6] = {}, all[6] = {};
    int beside = 0;
    for (int i = solid.begin; i < solid.end; ++i) {
      const CutFace& face = coupling.faces[i];
      const int ends = (face.upper >= 0 ? 1 : 0) - (face.lower >= 0 ? 1 : 0);
      beside += (face.upper >= 0 ? 1 : 0) + (face.lower >= 0 ? 1 : 0);
      if (ends == 0) continue;
      double row[6] = {};
      row_of(face).add_to(row, double(face.share) * double(ends));
      for (int n = 0; n < 6; ++n) sum[n] -= row[n], all[n] += row[n] > 0.0 ? row[n] : -row[n];
    }
    for (int n = 0; n < 6; ++n) {
      if (!(sum[n] > kNone * all[n] || sum[n] < -kNone * all[n])) continue;
      solid.seal[n] = sum[n];
      solid.beside = beside;
    }
  }
}

// How far the surface of the solid is from a centre, in edges: where distances to either side of the face change their sign, or as far as the
// distance says.
float layer_depth(float here, float beyond, float edge) {
  const float depth = beyond < 0.0f && here > 0.0f ? here / (here - beyond) : here / edge;
  return depth > 0.0f ? depth < 1.0f ? depth : 1.0f : 0.0f;
}

// body mass times a motion
void body_momentum(const SolidMotion& solid, const double (&motion)[6], double (&out)[6]) {
  for (int i = 0; i < 3; ++i) {
    out[i] = solid.mass * motion[i];
    out[3 + i] = 0.0;
    for (int j = 0; j < 3; ++j) out[3 + i] += solid.inertia[i][j] * motion[3 + j];
  }
}

Sym3 safe_inverse(Sym3 m) {
  // An axis about which a body cannot turn has no inverse: a millionth of the others stands for it.
  const float more = 1.0e-6f * (m.xx + m.yy + m.zz);
  m.xx += more, m.yy += more, m.zz += more;
  return inverse(m);
}

// Where a body lies flush on a wall or on another solid, liquid gets between the two from the side: the pressure there is that at the rim, the
// nearest cell of the layer that has an equation, and what the body leaves is filled from that cell. Without this a body on the ground
// would be held down by all that is above it.
class SealedFaces {
 public:
  SealedFaces(const CouplingGrid& grid, const BodyCoupling& coupling, Array<CutFace>& found)
      : grid_(grid), shape_(grid.shape), coupling_(coupling), found_(found) {}

  void find(int axis) {
    const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
    for (int n = 0; n < shape_.cells[c]; ++n) {
      for (int m = 0; m < shape_.cells[b]; ++m) {
        for (int l = 0; l < shape_.cells[axis]; ++l) {
          int at[3];
          at[axis] = l, at[b] = m, at[c] = n;
          const int label = body_at(at);
          if (label < 0) continue;
          if (is_sealed(axis, at, -1, label)) add(axis, at, -1, label);
          if (is_sealed(axis, at, 1, label)) add(axis, at, 1, label);
        }
      }
    }
  }

 private:
  int index(const int (&at)[3]) const { return shape_.at(at[0], at[1], at[2]); }
  bool has(const int (&at)[3], int axis) const { return at[axis] >= 0 && at[axis] < shape_.cells[axis]; }
  // The label of the body that moves and fills this cell, -1: none.
  int body_at(const int (&at)[3]) const {
    const int i = index(at), label = grid_.solids.nearest[i];
    const bool inside = grid_.solids.distance[i] < 0.0f && !(grid_.active[i] > 0.0f);
    return inside && label >= 0 && label < int(coupling_.solids.size()) && coupling_.solids[label].moves
               ? label
               : -1;
  }
  // A closed wall, or another solid, is next to it.
  bool is_sealed(int axis, const int (&at)[3], int side, int label) const {
    int next[3] = {at[0], at[1], at[2]};
    next[axis] += side;
    if (!has(next, axis)) return !grid_.box.open(2 * axis + (side > 0 ? 1 : 0)) && !grid_.box.periodic(axis);
    const int i = index(next);
    return grid_.solids.distance[i] < 0.0f && !(grid_.active[i] > 0.0f) && grid_.solids.nearest[i] != label;
  }
  // The nearest cell with an equation in the layer; false if there is none, or if air is nearer.
  bool find_rim(int axis, const int (&at)[3], int (&rim)[3]) const {
    int most = 0;
    for (int other = 0; other < 3; ++other)
      if (other != axis && shape_.cells[other] > most) most = shape_.cells[other];
    for (int away = 1; away < most; ++away) {
      bool air = false;
      for (int other = 0; other < 3; ++other) {
        if (other == axis || grid_.box.flat(other)) continue;
        for (int side = -1; side <= 1; side += 2) {
          for (int i = 0; i < 3; ++i) rim[i] = at[i];
          rim[other] += side * away;
          if (!has(rim, other)) continue;
          if (grid_.active[index(rim)] > 0.0f) return true;
          air = air || !(grid_.solids.distance[index(rim)] < 0.0f);
        }
      }
      if (air) return false;
    }
    return false;
  }
  void add(int axis, const int (&at)[3], int side, int label) {
    int rim[3];
    if (!find_rim(axis, at, rim)) return;
    int beyond[3] = {rim[0], rim[1], rim[2]};
    beyond[axis] -= side;
    // From the centres of the layer and of the next one to the face, in a straight line.
    const bool two = has(beyond, axis) && grid_.active[index(beyond)] > 0.0f;
    add_part(axis, at, side, label, index(rim), two ? 1.5f : 1.0f);
    if (two) add_part(axis, at, side, label, index(beyond), -0.5f);
  }
  void add_part(int axis, const int (&at)[3], int side, int label, int cell, float weight) {
    const float edges[3] = {grid_.box.cell.x, grid_.box.cell.y, grid_.box.cell.z};
    const SolidMotion& solid = coupling_.solids[label];
    CutFace face;
    face.face = index(at) + (side > 0 ? shape_.stride(axis) : 0);
    (side < 0 ? face.lower : face.upper) = cell;
    face.axis = std::int16_t(axis), face.label = std::int16_t(label);
    face.share = weight / edges[axis];
    double point[3];
    for (int i = 0; i < 3; ++i)
      point[i] = nearest_image(
          grid_.box, i,
          (at[i] + grid_.first[i] + (i == axis ? (side > 0 ? 1.0 : 0.0) : 0.5)) * double(edges[i]) -
              solid.center[i]);
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    face.moment[next] = float(point[last]);
    face.moment[last] = float(-point[next]);
    found_.push_back(face);
  }

  const CouplingGrid& grid_;
  const GridShape& shape_;
  const BodyCoupling& coupling_;
  Array<CutFace>& found_;
};

// By label, in the order found.
void sort_by_label(const Array<CutFace>& found, BodyCoupling& coupling) {
  for (SolidMotion& solid : coupling.solids) solid.begin = solid.end = 0;
  for (const CutFace& face : found) ++coupling.solids[face.label].end;
  int begin = 0;
  for (SolidMotion& solid : coupling.solids) {
    const int count = solid.end;
    solid.begin = solid.end = begin;
    begin += count;
  }
  coupling.faces.resize(found.size());
  for (const CutFace& face : found) coupling.faces[coupling.solids[face.label].end++] = face;
}

}  // namespace

double BodyCoupling::add_product(const float* p, float* q) const {
  double product = 0.0;
  for (const SolidMotion& solid : solids) {
    if (!solid.moves) continue;
    double sum[6], moved[6];
    gather_pushes(*this, solid, p, sum);
    multiply_motion(solid.inverse, sum, moved);
    for (int i = 0; i < 6; ++i) {
      moved[i] *= scale;
      product += sum[i] * moved[i];
    }
    for (int i = solid.begin; i < solid.end; ++i) {
      const CutFace& face = faces[i];
      const auto change = float(double(face.share) * row_of(face).times(moved));
      if (face.upper >= 0) q[face.upper] += change;
      if (face.lower >= 0) q[face.lower] -= change;
    }
    scatter_seal(*this, solid, moved, q);
  }
  return product;
}

void add_sealed_inflow(const BodyCoupling& coupling, float* inflow) {
  for (const SolidMotion& solid : coupling.solids)
    if (solid.moves) scatter_seal(coupling, solid, solid.motion, inflow);
}

float BodyCoupling::velocity_of(const CutFace& face) const {
  const SolidMotion& solid = solids[face.label];
  return solid.has_body ? float(row_of(face).times(solid.motion)) : face.told;
}

void begin_motions(const GasBox& box, std::span<const FluidBody> bodies, int labels, BodyCoupling& coupling) {
  coupling.solids.clear(), coupling.faces.clear();
  coupling.any_moves = false;
  for (int label = 0; label < labels; ++label) {
    SolidMotion solid;
    if (std::size_t(label) < bodies.size()) {
      const FluidBody& body = bodies[std::size_t(label)];
      solid.has_body = true;
      solid.moves = body.inverse_mass > 0.0f;
      solid.volume = double(body.volume);
      const DVec3 center = body.center - box.corner;
      solid.center[0] = center.x, solid.center[1] = center.y, solid.center[2] = center.z;
      for (int axis = 0; axis < 3; ++axis) {
        solid.motion[axis] = double(component_of(body.velocity, axis));
        solid.motion[3 + axis] = double(component_of(body.angular_velocity, axis));
      }
      if (solid.moves) {
        solid.mass = 1.0 / double(body.inverse_mass);
        const Sym3 m = safe_inverse(body.inverse_inertia);
        const float rows[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) solid.inertia[i][j] = double(rows[i][j]);
        coupling.any_moves = true;
      }
    }
    coupling.solids.push_back(solid);
  }
}

void find_cut_faces(const CouplingGrid& grid, bool layers, BodyCoupling& coupling) {
  const GridShape& shape = grid.shape;
  const GasSolids& solids = grid.solids;
  const float edges[3] = {grid.box.cell.x, grid.box.cell.y, grid.box.cell.z};
  const double volume = double(edges[0]) * double(edges[1]) * double(edges[2]);
  coupling.scale = double(grid.density) * volume;
  coupling.faces.clear();
  const bool has_distance = layers && !solids.distance.empty();
  const int labels = int(coupling.solids.size());
  Array<CutFace> found;
  for (SolidMotion& solid : coupling.solids)
    for (double& one : solid.displaced) one = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.box.flat(axis)) continue;
    const int step = shape.stride(axis);
    for (int k = 0; k < shape.cells[2]; ++k) {
      for (int j = 0; j < shape.cells[1]; ++j) {
        const int c = shape.row(j, k);
        for (int i = 0; i < shape.cells[0]; ++i) {
          const int at = axis == 0 ? i : axis == 1 ? j : k;
          const int f = c + i;
          int label = solids.label[axis][f];
          if (!solids.nearest.empty())
            label =
                solids.distance[f] < solids.distance[f - step] ? solids.nearest[f] : solids.nearest[f - step];
          if (at == 0 || label < 0 || label >= labels || !(grid.open[axis][f] < 1.0f)) continue;
          const float closed = 1.0f - grid.open[axis][f];
          coupling.solids[label].displaced[axis] += double(closed) * volume;
          CutFace face;
          face.face = f;
          face.lower = grid.active[f - step] > 0.0f ? f - step : -1;
          face.upper = grid.active[f] > 0.0f ? f : -1;
          if (face.lower < 0 && face.upper < 0) continue;
          face.axis = std::int16_t(axis);
          face.label = std::int16_t(label);
          face.share = closed / edges[axis];
          face.told = solids.velocity[axis][f];
          if (layers && !(grid.open[axis][f] > 0.0f)) {
            float depth = 0.0f;
            for (const int side : {face.lower, face.upper}) {
              if (side < 0) continue;
              const int other = side == f ? f - step : f;
              depth += has_distance ? layer_depth(solids.distance[side], solids.distance[other], edges[axis])
                                    : 0.5f;
            }
            face.layer = float(coupling.scale) * depth;
          }
          const SolidMotion& solid = coupling.solids[label];
          const int index[3] = {i, j, k};
          double point[3];
          for (int n = 0; n < 3; ++n)
            point[n] = nearest_image(
                grid.box, n,
                (index[n] + grid.first[n] + (axis == n ? 0.0 : 0.5)) * double(edges[n]) - solid.center[n]);
          const int next = (axis + 1) % 3, last = (axis + 2) % 3;
          face.moment[axis] = 0.0f;
          face.moment[next] = float(point[last]);
          face.moment[last] = float(-point[next]);
          found.push_back(face);
        }
      }
    }
  }
  if (has_distance && coupling.any_moves) {
    SealedFaces sealed(grid, coupling, found);
    for (int axis = 0; axis < 3; ++axis)
      if (!grid.box.flat(axis)) sealed.find(axis);
  }
  sort_by_label(found, coupling);
  if (!layers) find_seals(coupling);
  // Corners count for too much: without this a body as heavy as the fluid would rise.
  for (CutFace& face : coupling.faces) {
    const SolidMotion& solid = coupling.solids[face.label];
    const double displaced = solid.displaced[face.axis];
    if (displaced > 0.9 * solid.volume && displaced < 1.1 * solid.volume)
      face.share *= float(solid.volume / displaced);
  }
}

void predict_motions(std::span<const FluidBody> bodies, float step, const float* const (&velocity)[3],
                     BodyCoupling& coupling) {
  for (std::size_t label = 0; label < coupling.solids.size(); ++label) {
    SolidMotion& solid = coupling.solids[label];
    for (double& one : solid.push) one = 0.0;
    if (!solid.has_body) continue;
    const FluidBody& body = bodies[label];
    for (int axis = 0; axis < 3; ++axis) {
      solid.motion[axis] += double(step) * double(component_of(body.acceleration, axis));
      solid.motion[3 + axis] += double(step) * double(component_of(body.angular_acceleration, axis));
    }
    for (int i = 0; i < 6; ++i) solid.before[i] = solid.motion[i];
    if (!solid.moves) continue;
    double momentum[6];
    body_momentum(solid, solid.motion, momentum);
    double(&mass)[6][6] = solid.inverse;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j)
        mass[i][j] = i < 3 && i == j ? solid.mass : i >= 3 && j >= 3 ? solid.inertia[i - 3][j - 3] : 0.0;
    }
    for (int f = solid.begin; f < solid.end; ++f) {
      const CutFace& face = coupling.faces[f];
      if (!(face.layer > 0.0f)) continue;
      double row[6] = {};
      row_of(face).add_to(row, 1.0);
      const double layer = double(face.layer);
      row_of(face).add_to(momentum, layer * double(velocity[face.axis][face.face]));
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) mass[i][j] += layer * row[i] * row[j];
    }
    invert_masses(solid.inverse);
    multiply_motion(solid.inverse, momentum, solid.motion);
  }
}

void push_bodies(const float* x, BodyCoupling& coupling) {
  for (SolidMotion& solid : coupling.solids) {
    double sum[6], moved[6];
    gather_pushes(coupling, solid, x, sum);
    for (double& one : sum) one *= -coupling.scale;
    if (solid.moves) {
      multiply_motion(solid.inverse, sum, moved);
      for (int i = 0; i < 6; ++i) solid.motion[i] += moved[i];
    } else {
      for (int i = 0; i < 6; ++i) solid.push[i] += sum[i];
    }
  }
}

void add_body_impulses(const float* const (&velocity)[3], const BodyCoupling& coupling,
                       std::span<GasImpulse> impulses, bool told) {
  for (std::size_t label = 0; label < coupling.solids.size() && label < impulses.size(); ++label) {
    const SolidMotion& solid = coupling.solids[label];
    if (!solid.moves && !told) continue;
    double impulse[6];
    if (solid.moves) {
      double change[6];
      for (int i = 0; i < 6; ++i) change[i] = solid.motion[i] - solid.before[i];
      body_momentum(solid, change, impulse);
    } else {
      for (int i = 0; i < 6; ++i) impulse[i] = solid.push[i];
      for (int f = solid.begin; f < solid.end; ++f) {
        const CutFace& face = coupling.faces[f];
        const double change = double(velocity[face.axis][face.face]) - double(coupling.velocity_of(face));
        row_of(face).add_to(impulse, double(face.layer) * change);
      }
    }
    const DVec3 linear{impulse[0], impulse[1], impulse[2]};
    impulses[label].linear += linear;
    impulses[label].angular += DVec3{impulse[3], impulse[4], impulse[5]} +
                               cross(DVec3{solid.center[0], solid.center[1], solid.center[2]}, linear);
  }
}

}  // namespace gyre
