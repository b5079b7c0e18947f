// Kernels of transport, one template for every width: MacCormack's scheme with a limiter (A. Selle, R. Fedkiw, B. Kim, Y. Liu, J. Rossignac,
// "An Unconditionally Stable MacCormack Method", 2008).
//
// Matter that the bounds cut off in one cell has come from its neighbours: the correction moves matter between cells. So for fields whose sum counts,
// neighbours of a cell that is cut short are cut short as well (after S. Zalesak, "Fully Multidimensional Flux-Corrected Transport
// Algorithms for Fluids", 1979). A sharp edge would otherwise move at half its speed.
//
// Neighbours in a row mostly move by the same whole number of cells, so the eight corners around their sample are eight rows of numbers.
// Where they do not, each distinct offset is read for all lanes and used by its own: the same operations in each lane, so the same bits.
#pragma once

#include "fluid/kernels/grid_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Where the sample points of W neighbours lie: the index of the lower corner less the lane, and the fractions of a cell beyond it.
template <int W>
struct SampleLanes {
  WideInt<W> base;
  Wide<W> fraction[3];
};

template <int W>
GYRE_INLINE Wide<W> lane_numbers() {
  alignas(64) float lane[W];
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) lane[i] = float(i);
  return Wide<W>::load(lane);
}
template <int W>
GYRE_INLINE WideInt<W> lane_indices() {
  alignas(64) std::int32_t lane[W];
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) lane[i] = i;
  return WideInt<W>::load(lane);
}

// Limits of sample, of a TransportPass or a TracePass.
template <int W, class Pass>
GYRE_INLINE SampleLanes<W> locate(const Pass& pass, const Wide<W> (&sample)[3]) {
  SampleLanes<W> result;
  result.base = WideInt<W>(pass.shape.first) - lane_indices<W>();
  const int stride[3] = {1, pass.shape.pitch, pass.shape.plane};
  GYRE_UNROLL
  for (int axis = 0; axis < 3; ++axis) {
    Wide<W> at = sample[axis];
    const Wide<W> low(pass.low[axis]), high(pass.high[axis]);
    if (pass.period[axis] > 0.0f) {
      const Wide<W> period(pass.period[axis]);
      at = at + keep(at < low, period);
      at = at - keep(at >= low + period, period);
    }
    at = clamp(at, low, high);
    const WideInt<W> last(std::int32_t(pass.high[axis]) - 1), from(std::int32_t(pass.low[axis]));
    WideInt<W> cell = truncate(at - low) + from;
    if (pass.high[axis] > pass.low[axis]) cell = min(cell, last);
    result.fraction[axis] = at - to_float(cell);
    result.base = result.base + cell * WideInt<W>(stride[axis]);
  }
  return result;
}

template <int W>
GYRE_INLINE Wide<W> between(Wide<W> a, Wide<W> b, Wide<W> fraction) {
  return a + fraction * (b - a);
}

template <int W>
struct CornerLanes {
  Wide<W> v[8];
  GYRE_INLINE CornerLanes(const GridShape& shape, const float* from) {
    GYRE_UNROLL
    for (int corner = 0; corner < 8; ++corner) {
      const int offset = (corner & 1) + (corner >> 1 & 1) * shape.pitch + (corner >> 2) * shape.plane;
      v[corner] = Wide<W>::load_unaligned(from + offset);
    }
  }
  GYRE_INLINE Wide<W> at(const SampleLanes<W>& sample) const {
    const Wide<W> low = between<W>(between<W>(v[0], v[1], sample.fraction[0]),
                                   between<W>(v[2], v[3], sample.fraction[0]), sample.fraction[1]);
    const Wide<W> high = between<W>(between<W>(v[4], v[5], sample.fraction[0]),
                                    between<W>(v[6], v[7], sample.fraction[0]), sample.fraction[1]);
    return between<W>(low, high, sample.fraction[2]);
  }
  GYRE_INLINE Wide<W> lowest() const {
    return min(min(min(v[0], v[1]), min(v[2], v[3])), min(min(v[4], v[5]), min(v[6], v[7])));
  }
  GYRE_INLINE Wide<W> highest() const {
    return max(max(max(v[0], v[1]), max(v[2], v[3])), max(max(v[4], v[5]), max(v[6], v[7])));
  }
};

// Calls fn(offset, lanes) for each distinct offset, with the lanes that have it; the first call is with all lanes, so that fn may begin
// with it: later calls take over theirs.
template <int W, class Fn>
GYRE_INLINE void for_offsets(WideInt<W> base, Fn&& fn) {
  const int first = base[0];
  fn(first, Mask<W>(), true);
  if constexpr (W > 1) {
    std::uint32_t left = ~to_bits(base == WideInt<W>(first)) & ((1u << W) - 1u);
    while (left != 0u) {
      const int offset = base[__builtin_ctz(left)];
      const Mask<W> same = base == WideInt<W>(offset);
      fn(offset, same, false);
      left &= ~to_bits(same);
    }
  }
}

// The displacement of W points of a field.
template <int W>
GYRE_INLINE Wide<W> displacement(const float* rows, int average, int at) {
  if (rows == nullptr) return 0.0f;
  const Wide<W> here = Wide<W>::load_unaligned(rows + at);
  if (average == 0) return here;
  return Wide<W>(0.5f) * (Wide<W>::load_unaligned(rows + at - average) + here);
}

template <int W>
void trace_cells(const TracePass& pass, int row_begin, int row_end) {
  const Wide<W> lane = lane_numbers<W>();
  for_rows(pass.shape, pass.shape.cells[1], row_begin, row_end, [&](int c, int j, int k, int) {
    for_lanes<W>(pass.shape.cells[0], [&](int i, auto lanes) {
      const Wide<W> here[3] = {Wide<W>(float(i)) + lane, float(j), float(k)};
      Wide<W> velocity[3];
      GYRE_UNROLL
      for (int axis = 0; axis < 3; ++axis) velocity[axis] = displacement<W>(pass.velocity[axis], 0, c + i);
      for (int direction = 0; direction < 2; ++direction) {
        const Wide<W> half(direction == 0 ? -0.5f : 0.5f);
        Wide<W> middle[3];
        GYRE_UNROLL
        for (int axis = 0; axis < 3; ++axis) middle[axis] = here[axis] + half * velocity[axis];
        const SampleLanes<W> sample = locate<W>(pass, middle);
        Wide<W> moved[3] = {0.0f, 0.0f, 0.0f};
        for_offsets<W>(sample.base, [&](int offset, Mask<W> same, bool all) {
          GYRE_UNROLL
          for (int axis = 0; axis < 3; ++axis) {
            if (pass.velocity[axis] == nullptr) continue;
            const Wide<W> value = CornerLanes<W>(pass.shape, pass.velocity[axis] + offset).at(sample);
            moved[axis] = all ? value : select(same, value, moved[axis]);
          }
        });
        float* const* const to = direction == 0 ? pass.back : pass.ahead;
        GYRE_UNROLL
        for (int axis = 0; axis < 3; ++axis) {
          if (to[axis] != nullptr) lanes.keep_real(moved[axis]).store(to[axis] + c + i);
        }
      }
    });
  });
}

template <int W>
GYRE_INLINE SampleLanes<W> find_sample(const TransportPass& pass, const float* const (&direction)[3],
                                       float sign, int c, int i, int j, int k, Wide<W> lane) {
  const Wide<W> here[3] = {Wide<W>(float(i)) + lane, float(j), float(k)};
  Wide<W> sample[3];
  GYRE_UNROLL
  for (int axis = 0; axis < 3; ++axis)
    sample[axis] = here[axis] + Wide<W>(sign) * displacement<W>(direction[axis], pass.average, c + i);
  return locate<W>(pass, sample);
}

template <int W>
void move_cells(const TransportPass& pass, int row_begin, int row_end) {
  const Wide<W> lane = lane_numbers<W>();
  for_rows(pass.shape, pass.points[1], row_begin, row_end, [&](int c, int j, int k, int) {
    for_lanes<W>(pass.points[0], [&](int i, auto lanes) {
      const SampleLanes<W> sample = find_sample<W>(pass, pass.back, -1.0f, c, i, j, k, lane);
      Wide<W> value(0.0f), low(0.0f), high(0.0f);
      for_offsets<W>(sample.base, [&](int offset, Mask<W> same, bool all) {
        const CornerLanes<W> corners(pass.shape, pass.field + offset);
        value = all ? corners.at(sample) : select(same, corners.at(sample), value);
        low = all ? corners.lowest() : select(same, corners.lowest(), low);
        high = all ? corners.highest() : select(same, corners.highest(), high);
      });
      lanes.keep_real(value).store(pass.moved + c + i);
      lanes.keep_real(low).store(pass.lower + c + i);
      lanes.keep_real(high).store(pass.upper + c + i);
    });
  });
}

template <int W, bool SharesOnly>
void correct_cells(const TransportPass& pass, int row_begin, int row_end) {
  const Wide<W> lane = lane_numbers<W>();
  for_rows(pass.shape, pass.points[1], row_begin, row_end, [&](int c, int j, int k, int) {
    for_lanes<W>(pass.points[0], [&](int i, auto lanes) {
      const SampleLanes<W> sample = find_sample<W>(pass, pass.ahead, 1.0f, c, i, j, k, lane);
      Wide<W> again(0.0f);
      for_offsets<W>(sample.base, [&](int offset, Mask<W> same, bool all) {
        const Wide<W> value = CornerLanes<W>(pass.shape, pass.moved + offset).at(sample);
        again = all ? value : select(same, value, again);
      });
      const Wide<W> correction = Wide<W>(0.5f) * (Wide<W>::load(pass.field + c + i) - again);
      const Wide<W> moved = Wide<W>::load(pass.moved + c + i);
      const Wide<W> low = Wide<W>::load(pass.lower + c + i), high = Wide<W>::load(pass.upper + c + i);
      if constexpr (SharesOnly) {
        const Wide<W> room = select(correction > 0.0f, high - moved, low - moved);
        const Wide<W> share = select(absolute(correction) > absolute(room), room / correction, Wide<W>(1.0f));
        lanes.keep_real(correction).store(pass.field + c + i);
        lanes.keep_real(share).store(pass.lower + c + i);
      } else {
        lanes.keep_real(clamp(moved + correction, low, high)).store(pass.field + c + i);
      }
    });
  });
}

template <int W>
void add_correction_cells(const TransportPass& pass, int row_begin, int row_end) {
  const int pitch = pass.shape.pitch, plane = pass.shape.plane;
  for_rows(pass.shape, pass.points[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(pass.points[0], [&](int i, auto lanes) {
      const float* const share = pass.lower + c + i;
      const auto at = [&](int offset) { return Wide<W>::load_unaligned(share + offset); };
      const Wide<W> along_x = min(at(-1), at(1)), along_y = min(at(-pitch), at(pitch)),
                    along_z = min(at(-plane), at(plane));
      const Wide<W> lowest = min(min(at(0), along_x), min(along_y, along_z));
      const Wide<W> moved = Wide<W>::load(pass.moved + c + i), correction = Wide<W>::load(pass.field + c + i);
      lanes.keep_real(moved + lowest * correction).store(pass.field + c + i);
    });
  });
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
