// Kernels of the particles of a liquid: their sums on faces and centres, and their velocities and paths from faces. Each lane is a particle.
//
// A particle reaches eight faces across each axis, two in a row in each of four rows. A row gets four numbers at once: for each of its two faces the
// particle's volume there and its momentum. Particles add to the grid one after the other, so sums have one order for every W.
#pragma once

#include "fluid/kernels/gas_kernels.h"
#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

constexpr float kLargestFloat = 3.40282347e38f;  // the largest float

// W numbers of a column from `at` on, of which `count` exist; the others are zero.
template <int W>
GYRE_INLINE Wide<W> load_particles(const float* column, int at, int count) {
  if (count >= W) return Wide<W>::load_unaligned(column + at);
  alignas(64) float some[W] = {};
  for (int i = 0; i < count; ++i) some[i] = column[at + i];
  return Wide<W>::load(some);
}
template <int W>
GYRE_INLINE void store_particles(Wide<W> value, float* column, int at, int count) {
  if (count >= W) return value.store_unaligned(column + at);
  alignas(64) float some[W];
  value.store(some);
  for (int i = 0; i < count; ++i) column[at + i] = some[i];
}

// Along one axis: the point of the grid below a particle and the fraction of an edge beyond it, of faces across the axis and of centres.
template <int W>
struct ParticlePlaces {
  WideInt<W> face[3], center[3];
  Wide<W> face_fraction[3], center_fraction[3];

  GYRE_INLINE ParticlePlaces(const ParticleAxis (&axes)[3], const Wide<W> (&at)[3]) {
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      const ParticleAxis& a = axes[axis];
      const Wide<W> s = max(at[axis] * Wide<W>(a.inverse_edge), Wide<W>(float(a.first_face)));
      face[axis] = min(truncate(min(s, Wide<W>(float(a.last_face + 1)))), WideInt<W>(a.last_face));
      face_fraction[axis] = s - to_float(face[axis]);
      const Wide<W> c = clamp(s - Wide<W>(0.5f), Wide<W>(float(a.low)), Wide<W>(a.highest_center));
      const int below_zero = a.low < 0 ? a.low : 0;
      center[axis] =
          min(truncate(c - Wide<W>(float(below_zero))) + WideInt<W>(below_zero), WideInt<W>(a.last_center));
      center_fraction[axis] = c - to_float(center[axis]);
    }
  }
  // Of a component of velocity, -1: centres.
  GYRE_INLINE Wide<W> fraction(int component, int axis) const {
    return component == axis ? face_fraction[axis] : center_fraction[axis];
  }
  GYRE_INLINE void find_indices(const GridShape& shape, int component, std::int32_t (&index)[W]) const {
    const WideInt<W> x = component == 0 ? face[0] : center[0], y = component == 1 ? face[1] : center[1],
                     z = component == 2 ? face[2] : center[2];
    const WideInt<W> all =
        WideInt<W>(shape.first) + x + y * WideInt<W>(shape.pitch) + z * WideInt<W>(shape.plane);
    all.store(index);
  }
};

template <int W>
void find_particle_cells(const ParticlePass& pass, int begin, int end, std::int32_t* cell) {
  const GridShape& shape = pass.shape;
  for (int p = begin; p < end; p += W) {
    const int count = end - p < W ? end - p : W;
    WideInt<W> index[3];
    Wide<W> inside(1.0f);  // 0: it has left
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      const ParticleAxis& a = pass.axes[axis];
      const Wide<W> at = load_particles<W>(pass.position[axis], p, count);
      const Wide<W> speed = load_particles<W>(pass.motion[axis], p, count);
      const Wide<W> place = min(max(at * Wide<W>(a.inverse_edge), Wide<W>(float(a.first_face))),
                                Wide<W>(float(a.last_face + 1)));
      index[axis] = min(truncate(place), WideInt<W>(a.last_face)) - WideInt<W>(a.first_face);
      inside = keep(at >= Wide<W>(0.0f), inside);
      inside = keep(at <= Wide<W>(a.length), inside);
      inside = keep(absolute(speed) <= Wide<W>(kLargestFloat), inside);
    }
    const WideInt<W> all =
        index[0] + WideInt<W>(shape.cells[0]) * (index[1] + WideInt<W>(shape.cells[1]) * index[2]);
    alignas(64) std::int32_t some[W];
    select(inside > Wide<W>(0.0f), all, WideInt<W>(-1)).store(some);
    for (int i = 0; i < count; ++i) cell[p + i] = some[i];
  }
}

template <int W>
void add_particle_sums(const ParticlePass& pass, int begin, int end) {
  constexpr int kNumbers = 64;  // of a particle: twelve rows of faces and four of centres
  alignas(64) float numbers[W * kNumbers];
  float* record[W];
  for (int lane = 0; lane < W; ++lane) record[lane] = numbers + kNumbers * lane;
  alignas(64) std::int32_t index[4][W];
  for (int p = begin; p < end; p += W) {
    const int count = end - p < W ? end - p : W;
    Wide<W> at[3];
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) at[axis] = load_particles<W>(pass.position[axis], p, count);
    const ParticlePlaces<W> places(pass.axes, at);
    const Wide<W> volume = load_particles<W>(pass.volume, p, count), one(1.0f);
    for (int component = 0; component < 4; ++component) {
      const bool centers = component == 3;
      if (!centers && pass.sums[component] == nullptr) continue;
      places.find_indices(pass.shape, component, index[component]);
      const Wide<W> x = places.fraction(component, 0), y = places.fraction(component, 1),
                    z = places.fraction(component, 2);
      Wide<W> speed(0.0f), slope[3] = {0.0f, 0.0f, 0.0f};
      if (!centers) {
        speed = load_particles<W>(pass.motion[component], p, count);
        GYRE_UNROLL
        for (int b = 0; b < 3; ++b)
          slope[b] = load_particles<W>(pass.affine[3 * component + b], p, count) * Wide<W>(pass.axes[b].edge);
      }
      const Wide<W> left = speed - slope[0] * x, right = left + slope[0];
      GYRE_UNROLL
      for (int row = 0; row < 4; ++row) {
        const Wide<W> wy = (row & 1) != 0 ? y : one - y, wz = (row & 2) != 0 ? z : one - z;
        const Wide<W> weight = volume * (wy * wz);
        const Wide<W> w1 = weight * x, w0 = weight - w1;
        Wide<W> four[4] = {w0, w1, 0.0f, 0.0f};
        if (!centers) {
          const Wide<W> dy = (row & 1) != 0 ? one - y : -y, dz = (row & 2) != 0 ? one - z : -z;
          const Wide<W> shear = slope[1] * dy + slope[2] * dz;
          four[1] = w0 * (left + shear);
          four[2] = w1;
          four[3] = w1 * (right + shear);
        }
        scatter_columns<4, W>(record, 16 * component + 4 * row, four);
      }
    }
    const int offsets[4] = {0, pass.shape.pitch, pass.shape.plane, pass.shape.pitch + pass.shape.plane};
    for (int lane = 0; lane < count; ++lane) {
      const float* const from = record[lane];
      const auto add = [&](float* to, int row) {
        (Wide<4>::load_unaligned(to) + Wide<4>::load(from + 4 * row)).store_unaligned(to);
      };
      GYRE_UNROLL
      for (int component = 0; component < 3; ++component) {
        if (pass.sums[component] == nullptr) continue;
        GYRE_UNROLL
        for (int row = 0; row < 4; ++row)
          add(pass.sums[component] + 2 * (index[component][lane] + offsets[row]), 4 * component + row);
      }
      GYRE_UNROLL
      for (int row = 0; row < 4; ++row) add(pass.filled + index[3][lane] + offsets[row], 12 + row);
    }
  }
}

// The value of faces at W particles, and how it grows along each axis.
template <int W>
struct FaceSamples {
  Wide<W> value;
  Wide<W> slope[3];
};
template <int W, bool HasSlopes>
GYRE_INLINE FaceSamples<W> sample_faces(const ParticlePass& pass, const ParticlePlaces<W>& places,
                                        int component, const float* faces) {
  alignas(64) std::int32_t index[W];
  places.find_indices(pass.shape, component, index);
  const float* record[W];
  for (int lane = 0; lane < W; ++lane) record[lane] = faces + index[lane];
  const Wide<W> x = places.fraction(component, 0), y = places.fraction(component, 1),
                z = places.fraction(component, 2);
  const int offsets[4] = {0, pass.shape.pitch, pass.shape.plane, pass.shape.pitch + pass.shape.plane};
  Wide<W> low[4], step[4];
  GYRE_UNROLL
  for (int row = 0; row < 4; ++row) {
    Wide<W> four[4];
    gather_columns<4, W>(record, offsets[row], four);
    low[row] = four[0];
    step[row] = four[1] - four[0];
  }
  Wide<W> mean[4];
  GYRE_UNROLL
  for (int row = 0; row < 4; ++row) mean[row] = low[row] + x * step[row];
  const Wide<W> front = mean[0] + y * (mean[1] - mean[0]), back = mean[2] + y * (mean[3] - mean[2]);
  FaceSamples<W> result;
  result.value = front + z * (back - front);
  if constexpr (HasSlopes) {
    const Wide<W> d0 = step[0] + y * (step[1] - step[0]), d1 = step[2] + y * (step[3] - step[2]);
    const Wide<W> e0 = mean[1] - mean[0], e1 = mean[3] - mean[2];
    result.slope[0] = (d0 + z * (d1 - d0)) * Wide<W>(pass.axes[0].inverse_edge);
    result.slope[1] = (e0 + z * (e1 - e0)) * Wide<W>(pass.axes[1].inverse_edge);
    result.slope[2] = (back - front) * Wide<W>(pass.axes[2].inverse_edge);
  }
  return result;
}

// A coordinate moved to the nearest place within walls, or round a periodic axis.
template <int W>
GYRE_INLINE Wide<W> keep_within(const ParticleAxis& axis, Wide<W> at) {
  const Wide<W> length(axis.length);
  if (axis.wraps) {
    at = at + keep(at < Wide<W>(0.0f), length);
    at = at - keep(at >= length, length);
  }
  return clamp(at, Wide<W>(axis.lower_wall), Wide<W>(axis.upper_wall));
}

template <int W>
void move_particle_lanes(const ParticlePass& pass, int begin, int end) {
  const Wide<W> step(pass.step), half(0.5f * pass.step);
  for (int p = begin; p < end; p += W) {
    const int count = end - p < W ? end - p : W;
    Wide<W> at[3], middle[3], motion[3], to[3];
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) at[axis] = load_particles<W>(pass.position[axis], p, count);
    const ParticlePlaces<W> places(pass.axes, at);
    alignas(64) std::int32_t index[W], wet_lanes[W];
    places.find_indices(pass.shape, -1, index);
    for (int lane = 0; lane < W; ++lane) wet_lanes[lane] = pass.wet[index[lane]];
    const Mask<W> wet = WideInt<W>::load(wet_lanes) > WideInt<W>(0);
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = to[axis] = at[axis];
      if (pass.velocity[axis] == nullptr) continue;
      const FaceSamples<W> sample = sample_faces<W, true>(pass, places, axis, pass.velocity[axis]);
      middle[axis] = at[axis] + half * sample.value;
      const Wide<W> before = load_particles<W>(pass.motion[axis], p, count);
      Wide<W> taken = sample.value;
      if (pass.before[axis] != nullptr) {
        const Wide<W> old = sample_faces<W, false>(pass, places, axis, pass.before[axis]).value;
        const Wide<W> blend(pass.blend);
        taken = blend * sample.value + (Wide<W>(1.0f) - blend) * (before + (sample.value - old));
      }
      motion[axis] = select(wet, taken, before + Wide<W>(pass.fall[axis]));
      GYRE_UNROLL
      for (int b = 0; b < 3; ++b) {
        const Wide<W> slope = pass.velocity[b] == nullptr ? Wide<W>(0.0f) : keep(wet, sample.slope[b]);
        store_particles<W>(slope, pass.affine[3 * axis + b], p, count);
      }
      middle[axis] = keep_within<W>(pass.axes[axis], middle[axis]);
    }
    const ParticlePlaces<W> halfway(pass.axes, middle);
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.velocity[axis] == nullptr) continue;
      const Wide<W> carried = sample_faces<W, false>(pass, halfway, axis, pass.carrier[axis]).value;
      Wide<W> end_at = at[axis] + step * select(wet, carried, motion[axis]);
      const ParticleAxis& a = pass.axes[axis];
      if (pass.finishes) {
        // Walls take the speed into them.
        motion[axis] =
            select(end_at < Wide<W>(a.lower_wall), max(motion[axis], Wide<W>(a.lower_speed)), motion[axis]);
        motion[axis] =
            select(end_at > Wide<W>(a.upper_wall), min(motion[axis], Wide<W>(a.upper_speed)), motion[axis]);
        if (a.wraps) {
          end_at = end_at + keep(end_at < Wide<W>(0.0f), Wide<W>(a.length));
          end_at = end_at - keep(end_at >= Wide<W>(a.length), Wide<W>(a.length));
        }
        end_at = select(end_at < Wide<W>(a.lower_limit), Wide<W>(a.lower_limit), end_at);
        end_at = select(end_at > Wide<W>(a.upper_limit), Wide<W>(a.upper_limit), end_at);
      }
      store_particles<W>(motion[axis], pass.motion[axis], p, count);
      store_particles<W>(end_at, pass.to[axis], p - pass.to_begin, count);
    }
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
