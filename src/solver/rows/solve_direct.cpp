#include "solver/rows/solve_direct.h"

#include "math/dense.h"
#include "solver/rows/lcp_dantzig.h"
#include "solver/rows/lcp_lemke.h"
#include "solver/rows/solve_newton.h"

namespace gyre {

namespace {

// Share by which diagonals are raised for pivoting, so that redundant rows have one solution. Newton's method
// removes its effect.
constexpr double kRegularization = 1.0e-9;
constexpr double kTieBreak = 1.0e-10;
constexpr int kDantzigRounds = 20;
constexpr int kRoundSteps = 8, kPolishSteps = 30;

// A variable of a method in terms of the rows of the problem: it adds its value times these factors to x_row
// and, for a cone, to x_(row + 1).
struct Segment {
  int row = 0;
  double first = 1.0, second = 0.0;
};

double segment_speed(const DenseProblem& p, const Segment& segment, int column) {
  double k = segment.first * p.at(segment.row, column);
  if (segment.second != 0.0) k += segment.second * p.at(segment.row + 1, column);
  return k;
}
double segment_coupling(const DenseProblem& p, const Segment& a, const Segment& b) {
  double k = b.first * segment_speed(p, a, b.row);
  if (b.second != 0.0) k += b.second * segment_speed(p, a, b.row + 1);
  return k;
}
double segment_q(const DenseProblem& p, const Segment& segment) {
  double q = segment.first * p.q[std::size_t(segment.row)];
  if (segment.second != 0.0) q += segment.second * p.q[std::size_t(segment.row) + 1];
  return q;
}

double load_in(const RowLimits& limits, std::span<const double> x) {
  return load_of(limits, [&](int j) { return x[std::size_t(j)]; });
}

// Calls fn(segment) for each variable of a row. A polygon is the sum of one segment for each pair of its
// sides.
template <class Fn>
void for_each_segment(const RowLimits& limits, int row, const FrictionSet& polygon, Fn&& fn) {
  if (limits.kind == RowKind::cone_second) return;
  if (limits.kind != RowKind::cone) return fn(Segment{row});
  for (int k = 0; 2 * k < polygon.sides; ++k) fn(Segment{row, -polygon.side[k][1], polygon.side[k][0]});
}
std::size_t count_segments(std::span<const RowLimits> limits, const FrictionSet& polygon) {
  std::size_t count = 0;
  for (const RowLimits& l : limits)
    count += l.kind == RowKind::cone          ? std::size_t(polygon.sides / 2)
             : l.kind == RowKind::cone_second ? 0
                                              : 1;
  return count;
}

// Doubles, so that one room holds all numbers.
struct SegmentList {
  std::span<double> rows, first, second;
  std::size_t count = 0;

  SegmentList(std::size_t capacity, NumberRoom& room)
      : rows(room.take(capacity)), first(room.take(capacity)), second(room.take(capacity)) {}
  void add(const Segment& segment) {
    rows[count] = double(segment.row), first[count] = segment.first, second[count] = segment.second;
    ++count;
  }
  Segment at(std::size_t i) const { return {int(rows[i]), first[i], second[i]}; }
};

// ------------------------------------------------------------------------------------------------------------ Dantzig

void run_dantzig(const DenseProblem& p, const FrictionSet& polygon, double tolerance, std::span<double> x,
                 NumberRoom room, DirectResult& result) {
  const std::size_t count = count_segments(p.limits, polygon);
  SegmentList segments(count, room);
  for (int i = 0; i < p.size; ++i)
    for_each_segment(p.limits[std::size_t(i)], i, polygon,
                     [&](const Segment& segment) { segments.add(segment); });
  const std::span<double> a = room.take(count * count), q = room.take(count);
  for (std::size_t i = 0; i < count; ++i) {
    q[i] = segment_q(p, segments.at(i));
    for (std::size_t j = 0; j < count; ++j)
      a[i * count + j] = segment_coupling(p, segments.at(i), segments.at(j));
  }
  Dantzig dantzig(a, q, kRegularization, room);
  const std::span<double> best = room.take(std::size_t(p.size));
  for (int round = 0; round < kDantzigRounds; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      const RowLimits& limits = p.limits[std::size_t(segments.at(i).row)];
      double high = limits.high, low = limits.low;
      if (limits.kind != RowKind::box) {
        high = limits.friction * load_in(limits, x);
        if (limits.kind == RowKind::cone) high *= polygon.half_side;
        low = -high;
      }
      dantzig.set_limits(int(i), low, high);
    }
    const int before = dantzig.pivots();
    const bool found = dantzig.solve(0.01 * tolerance, 20 * int(count) + 50);
    result.pivots += dantzig.pivots() - before;
    ++result.rounds;
    if (!found) return;
    for (double& value : x) value = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Segment segment = segments.at(i);
      x[std::size_t(segment.row)] += segment.first * dantzig.x(int(i));
      if (segment.second != 0.0) x[std::size_t(segment.row) + 1] += segment.second * dantzig.x(int(i));
    }
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = x[i];
    const NewtonResult polished = solve_newton(p, tolerance, kRoundSteps, best, room);
    result.newton_steps += polished.steps;
    result.residual = polished.residual;
    if (polished.residual > tolerance) continue;
    for (std::size_t i = 0; i < best.size(); ++i) x[i] = best[i];
    return;
  }
  for (std::size_t i = 0; i < best.size(); ++i) x[i] = best[i];
}

// -------------------------------------------------------------------------------------------------------------- Lemke

// Number of variables of a row: those of its impulse, and a multiplier if they have a common bound.
int count_corners(const RowLimits& l, const FrictionSet& polygon) {
  if (l.kind == RowKind::cone) return polygon.sides;
  if (l.kind == RowKind::load) return 2;
  return l.kind == RowKind::cone_second || is_equation(l) ? 0 : 1;
}
bool has_multiplier(const RowLimits& l) {
  return l.kind == RowKind::cone || l.kind == RowKind::load ||
         (l.kind == RowKind::box && l.low > -kNoLimit && l.high < kNoLimit);
}
std::size_t count_lemke(std::span<const RowLimits> limits, const FrictionSet& polygon,
                        std::size_t& equations) {
  std::size_t count = 0;
  equations = 0;
  for (const RowLimits& l : limits) {
    count += std::size_t(count_corners(l, polygon)) + (has_multiplier(l) ? 1 : 0);
    equations += is_equation(l) ? 1 : 0;
  }
  return count;
}

// The problem without its equations, in variables that are not negative.
struct LemkeProblem {
  SegmentList segments;  // a multiplier has zero in both
  std::span<double> m, q, shift, groups;
  std::size_t count = 0;

  LemkeProblem(std::size_t size, std::size_t rows, NumberRoom& room)
      : segments(size, room),
        m(room.take(size * size)),
        q(room.take(size)),
        shift(room.take(rows)),
        groups(room.take(rows)) {}
};

void list_lemke(const DenseProblem& p, const FrictionSet& polygon, LemkeProblem& lemke) {
  for (int i = 0; i < p.size; ++i) {
    const RowLimits& l = p.limits[std::size_t(i)];
    lemke.shift[std::size_t(i)] = 0.0;
    lemke.groups[std::size_t(i)] = double(lemke.segments.count);
    if (l.kind == RowKind::cone) {
      for (int k = 0; k < polygon.sides; ++k)
        lemke.segments.add({i, polygon.corner[k][0], polygon.corner[k][1]});
    } else if (l.kind == RowKind::load) {
      lemke.segments.add({i, 1.0});
      lemke.segments.add({i, -1.0});
    } else if (l.kind == RowKind::box && !is_equation(l)) {
      const bool from_low = l.low > -kNoLimit;
      lemke.shift[std::size_t(i)] = from_low ? l.low : l.high;
      lemke.segments.add({i, from_low ? 1.0 : -1.0});
    }
    if (has_multiplier(l)) lemke.segments.add({i, 0.0});
  }
}

// The equations of the problem: their part of the matrix `a`, factored.
class Equations {
 public:
  static std::size_t room_for(std::size_t count) { return count * count + 2 * count; }

  Equations(const DenseProblem& p, std::size_t count, std::span<const double> a, NumberRoom& room)
      : p_(p),
        a_(a),
        count_(count),
        own_(room.take(count * count)),
        column_(room.take(count)),
        at_(room.take(count)) {
    std::size_t e = 0;
    for (std::size_t i = 0; i < p.limits.size(); ++i) {
      if (is_equation(p.limits[i])) at_[e++] = double(i);
    }
    for (std::size_t i = 0; i < e; ++i)
      for (std::size_t j = 0; j < e; ++j) own_[i * e + j] = a[row_of(i) * size() + row_of(j)];
    factor_ldlt(own_, int(e));
  }

  // Eliminates the equations from the matrix `a` and the right side of the other rows.
  void eliminate(std::span<double> a, std::span<double> q) {
    const std::size_t n = size();
    for (std::size_t j = 0; j <= n; ++j) {
      if (j < n && is_equation(p_.limits[j])) continue;
      for (std::size_t i = 0; i < count_; ++i) column_[i] = j < n ? a[row_of(i) * n + j] : q[row_of(i)];
      solve_ldlt(own_, int(count_), column_);
      for (std::size_t i = 0; i < n; ++i) {
        if (is_equation(p_.limits[i])) continue;
        double sum = 0.0;
        for (std::size_t k = 0; k < count_; ++k) sum += a[i * n + row_of(k)] * column_[k];
        (j < n ? a[i * n + j] : q[i]) -= sum;
      }
    }
  }
  // Computes the impulses of the equations from those of the other rows.
  void fill(std::span<const double> q, std::span<double> x) {
    for (std::size_t i = 0; i < count_; ++i) {
      double sum = -q[row_of(i)];
      for (std::size_t j = 0; j < size(); ++j) {
        if (!is_equation(p_.limits[j])) sum -= a_[row_of(i) * size() + j] * x[j];
      }
      column_[i] = sum;
    }
    solve_ldlt(own_, int(count_), column_);
    for (std::size_t i = 0; i < count_; ++i) x[row_of(i)] = column_[i];
  }

 private:
  std::size_t size() const { return p_.limits.size(); }
  std::size_t row_of(std::size_t i) const { return std::size_t(at_[i]); }

  const DenseProblem& p_;
  std::span<const double> a_;
  std::size_t count_;
  std::span<double> own_, column_, at_;
};

// `compliance`: share by which the diagonal is raised.
void run_lemke(const DenseProblem& p, const FrictionSet& polygon, double compliance, double tolerance,
               std::span<double> x, NumberRoom room, DirectResult& result) {
  const std::size_t n = std::size_t(p.size);
  std::size_t equations = 0;
  const std::size_t size = count_lemke(p.limits, polygon, equations);
  LemkeProblem lemke(size, n, room);
  list_lemke(p, polygon, lemke);
  const std::span<double> a = room.take(n * n), q = room.take(n), z = room.take(size);
  for (std::size_t i = 0; i < n * n; ++i) a[i] = p.a[i];
  for (std::size_t i = 0; i < n; ++i) {
    a[i * n + i] *= 1.0 + compliance;
    q[i] = p.q[i];
    for (std::size_t j = 0; j < n; ++j) q[i] += a[i * n + j] * lemke.shift[j];
  }
  Equations joined(p, equations, a, room);
  joined.eliminate(a, q);
  const DenseProblem reduced{p.size, a, q, p.limits, p.friction};
  for (std::size_t i = 0; i < size; ++i) {
    const Segment own = lemke.segments.at(i);
    const RowLimits& l = p.limits[std::size_t(own.row)];
    const bool is_multiplier = own.first == 0.0 && own.second == 0.0;
    lemke.q[i] = is_multiplier ? (l.kind == RowKind::box ? l.high - l.low : 0.0) : segment_q(reduced, own);
    for (std::size_t j = 0; j < size; ++j) {
      const Segment other = lemke.segments.at(j);
      double& m = lemke.m[i * size + j];
      const bool other_multiplies = other.first == 0.0 && other.second == 0.0;
      m = is_multiplier || other_multiplies ? 0.0 : segment_coupling(reduced, own, other);
      if (own.row == other.row && is_multiplier != other_multiplies) m = is_multiplier ? -1.0 : 1.0;
    }
    if (!is_multiplier || l.kind == RowKind::box) continue;
    for (std::int32_t k = 0; k < l.load_count; ++k)
      lemke.m[i * size + std::size_t(lemke.groups[std::size_t(l.load_first + k)])] = l.friction;
  }
  const LemkeResult found = solve_lemke(lemke.m, lemke.q, kTieBreak, 40 * int(size) + 100, z, room);
  result.pivots += found.pivots;
  for (std::size_t i = 0; i < n; ++i) x[i] = lemke.shift[i];
  for (std::size_t i = 0; i < size; ++i) {
    const Segment segment = lemke.segments.at(i);
    x[std::size_t(segment.row)] += segment.first * z[i];
    if (segment.second != 0.0) x[std::size_t(segment.row) + 1] += segment.second * z[i];
  }
  joined.fill(p.q, x);
  const NewtonResult polished = solve_newton(p, tolerance, kPolishSteps, x, room);
  result.newton_steps += polished.steps;
  result.residual = polished.residual;
}

}  // namespace

DirectSize count_direct(std::span<const RowLimits> limits) {
  DirectSize size;
  size.rows = limits.size();
  for (const RowLimits& l : limits) {
    size.equations += is_equation(l) ? 1 : 0;
    size.cones += l.kind == RowKind::cone ? 1 : 0;
  }
  return size;
}

std::size_t direct_room(const DirectSize& size, const FrictionSet& set, DirectMethod method) {
  const std::size_t n = size.rows, sides = std::size_t(set.sides);
  std::size_t numbers = newton_room(n);
  if (method == DirectMethod::dantzig) {
    const std::size_t segments = n + size.cones * (sides / 2);
    numbers = max(numbers, 3 * segments + segments * segments + segments + Dantzig::room_for(segments) + n +
                               newton_room(n));
  }
  if (method == DirectMethod::lemke) {
    // Rows with a limit on either side have at most three variables.
    const std::size_t z = 3 * n + size.cones * (sides + 1);
    const std::size_t own = 3 * z + z * z + z + 2 * n + n * n + n + z + Equations::room_for(size.equations);
    numbers = max(numbers, own + lemke_room(z) + newton_room(n));
  }
  return numbers;
}

DirectResult solve_direct(const DenseProblem& problem, const FrictionSet& polygon, DirectMethod method,
                          double tolerance, std::span<double> x, NumberRoom room) {
  DirectResult result;
  if (method == DirectMethod::dantzig) {
    run_dantzig(problem, polygon, tolerance, x, room, result);
  } else {
    // More compliance separates rows so redundant that pivots are rounding.
    for (const double compliance : {kRegularization, 100.0 * kRegularization, 10000.0 * kRegularization}) {
      run_lemke(problem, polygon, compliance, tolerance, x, room, result);
      if (result.residual <= tolerance) break;
    }
  }
  result.is_solved = result.residual <= tolerance;
  return result;
}

}  // namespace gyre
