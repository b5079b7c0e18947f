// Kernels of transport, one template for every width: MacCormack's scheme with a limiter (A. Selle, R. Fedkiw, B. Kim, Y. Liu, J. Rossignac,
// "An Unconditionally Stable MacCormack Method", 2008).
//
// What the bounds cut off in one cell has come from its neighbours: the correction moves matter between cells. So for fields whose sum counts,
// neighbours of a cell that is cut short are cut short as well (after S. Zalesak, "Fully Multidimensional Flux-Corrected Transport
// Algorithms for Fluids", 1979). A sharp edge would otherwise move at half its speed.
//
// Neighbours in a row mostly move by the same whole number of cells, so the eight corners around their spots are eight rows of numbers.
// Where they do not, each distinct offset is read for all lanes and used by its own: the same operations in each lane, so the same bits.
#pragma once

#include "fluid/kernels/grid_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Where the spots of W neighbours lie: the place of the lower corner less the lane, and the parts of a cell beyond it.
template <int W>
struct SpotLanes {
  WideInt<W> base;
  Wide<W> part[3];
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

// Limits of spots, of a TransportPass or a TracePass.
template <int W, class Pass>
GYRE_INLINE SpotLanes<W> locate(const Pass& pass, const Wide<W> (&spot)[3]) {
  SpotLanes<W> result;
  result.base = WideInt<W>(pass.shape.first) - lane_indices<W>();
  const int stride[3] = {1, pass.shape.pitch, pass.shape.plane};
  GYRE_UNROLL
  for (int axis = 0; axis < 3; ++axis) {
    Wide<W> at = spot[axis];
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
    result.part[axis] = at - to_float(cell);
    result.base = result.base + cell * WideInt<W>(stride[axis]);
  }
  return result;
}

template <int W>
GYRE_INLINE Wide<W> between(Wide<W> a, Wide<W> b, Wide<W> part) {
  return a + part * (b - a);
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
  GYRE_INLINE Wide<W> at(const SpotLanes<W>& spot) const {
    const Wide<W> low =
        between<W>(between<W>(v[0], v[1], spot.part[0]), between<W>(v[2], v[3], spot.part[0]), spot.part[1]);
    const Wide<W> high =
        between<W>(between<W>(v[4], v[5], spot.part[0]), between<W>(v[6], v[7], spot.part[0]), spot.part[1]);
    return between<W>(low, high, spot.part[2]);
  }
  GYRE_INLINE Wide<W> least() const {
    return min(min(min(v[0], v[1]), min(v[2], v[3])), min(min(v[4], v[5]), min(v[6], v[7])));
  }
  GYRE_INLINE Wide<W> most() const {
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

// The displacement of W places of a field.
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
      for (int way = 0; way < 2; ++way) {
        const Wide<W> half(way == 0 ? -0.5f : 0.5f);
        Wide<W> middle[3];
        GYRE_UNROLL
        for (int axis = 0; axis < 3; ++axis) middle[axis] = here[axis] + half * velocity[axis];
        const SpotLanes<W> spot = locate<W>(pass, middle);
        Wide<W> moved[3] = {0.0f, 0.0f, 0.0f};
        for_offsets<W>(spot.base, [&](int offset, Mask<W> same, bool all) {
          GYRE_UNROLL
          for (int axis = 0; axis < 3; ++axis) {
            if (pass.velocity[axis] == nullptr) continue;
            const Wide<W> value = CornerLanes<W>(pass.shape, pass.velocity[axis] + offset).at(spot);
            moved[axis] = all ? value : select(same, value, moved[axis]);
          }
        });
        float* const* const to = way == 0 ? pass.back : pass.ahead;
        GYRE_UNROLL
        for (int axis = 0; axis < 3; ++axis) {
          if (to[axis] != nullptr) lanes.keep_real(moved[axis]).store(to[axis] + c + i);
        }
      }
    });
  });
}

template <int W>
GYRE_INLINE SpotLanes<W> find_spot(const TransportPass& pass, const float* const (&way)[3], float sign, int c,
                                   int i, int j, int k, Wide<W> lane) {
  const Wide<W> here[3] = {Wide<W>(float(i)) + lane, float(j), float(k)};
  Wide<W> spot[3];
  GYRE_UNROLL
  for (int axis = 0; axis < 3; ++axis)
    spot[axis] = here[axis] + Wide<W>(sign) * displacement<W>(way[axis], pass.average, c + i);
  return locate<W>(pass, spot);
}

template <int W>
void move_cells(const TransportPass& pass, int row_begin, int row_end) {
  const Wide<W> lane = lane_numbers<W>();
  for_rows(pass.shape, pass.places[1], row_begin, row_end, [&](int c, int j, int k, int) {
    for_lanes<W>(pass.places[0], [&](int i, auto lanes) {
      const SpotLanes<W> spot = find_spot<W>(pass, pass.back, -1.0f, c, i, j, k, lane);
      Wide<W> value(0.0f), least(0.0f), most(0.0f);
      for_offsets<W>(spot.base, [&](int offset, Mask<W> same, bool all) {
        const CornerLanes<W> corners(pass.shape, pass.field + offset);
        value = all ? corners.at(spot) : select(same, corners.at(spot), value);
        least = all ? corners.least() : select(same, corners.least(), least);
        most = all ? corners.most() : select(same, corners.most(), most);
      });
      lanes.keep_real(value).store(pass.moved + c + i);
      lanes.keep_real(least).store(pass.lower + c + i);
      lanes.keep_real(most).store(pass.upper + c + i);
    });
  });
}

template <int W, bool SharesOnly>
void correct_cells(const TransportPass& pass, int row_begin, int row_end) {
  const Wide<W> lane = lane_numbers<W>();
  for_rows(pass.shape, pass.places[1], row_begin, row_end, [&](int c, int j, int k, int) {
    for_lanes<W>(pass.places[0], [&](int i, auto lanes) {
      const SpotLanes<W> spot = find_spot<W>(pass, pass.ahead, 1.0f, c, i, j, k, lane);
      Wide<W> again(0.0f);
      for_offsets<W>(spot.base, [&](int offset, Mask<W> same, bool all) {
        const Wide<W> value = CornerLanes<W>(pass.shape, pass.moved + offset).at(spot);
        again = all ? value : select(same, value, again);
      });
      const Wide<W> missing = Wide<W>(0.5f) * (Wide<W>::load(pass.field + c + i) - again);
      const Wide<W> moved = Wide<W>::load(pass.moved + c + i);
      const Wide<W> least = Wide<W>::load(pass.lower + c + i), most = Wide<W>::load(pass.upper + c + i);
      if constexpr (SharesOnly) {
        const Wide<W> room = select(missing > 0.0f, most - moved, least - moved);
        const Wide<W> share = select(absolute(missing) > absolute(room), room / missing, Wide<W>(1.0f));
        lanes.keep_real(missing).store(pass.field + c + i);
        lanes.keep_real(share).store(pass.lower + c + i);
      } else {
        lanes.keep_real(clamp(moved + missing, least, most)).store(pass.field + c + i);
      }
    });
  });
}

template <int W>
void add_missing_cells(const TransportPass& pass, int row_begin, int row_end) {
  const int pitch = pass.shape.pitch, plane = pass.shape.plane;
  for_rows(pass.shape, pass.places[1], row_begin, row_end, [&](int c, int, int, int) {
    for_lanes<W>(pass.places[0], [&](int i, auto lanes) {
      const float* const share = pass.lower + c + i;
      const auto at = [&](int offset) { return Wide<W>::load_unaligned(share + offset); };
      const Wide<W> along_x = min(at(-1), at(1)), along_y = min(at(-pitch), at(pitch)),
                    along_z = min(at(-plane), at(plane));
      const Wide<W> least = min(min(at(0), along_x), min(along_y, along_z));
      const Wide<W> moved = Wide<W>::load(pass.moved + c + i), missing = Wide<W>::load(pass.field + c + i);
      lanes.keep_real(moved + least * missing).store(pass.field + c + i);
    });
  });
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
