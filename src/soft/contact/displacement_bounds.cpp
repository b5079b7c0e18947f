#include "soft/contact/displacement_bounds.h"

#include "geometry/distance/closest.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr double kSafe = 1.0 - 0x1p-20;  // more than any rounding here takes
constexpr int kBlockPairs = 1024;        // that one worker takes at a time
constexpr int kAdvances = 6;             // in which the room that others have left is given anew

// Features that fly together do not move for bounds. This takes from the moves of the vertices that pairs connect, or a stiff piece, their mean. Where a pair has no room, its vertices
// would else be held back against all others. Sets the mean of each vertex.
void take_means(std::span<const SurfacePair> pairs, std::span<const std::uint32_t> stiff,
                std::span<DVec3> moves, std::span<DVec3> means, Arena& arena) {
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> root = arena.make<std::uint32_t>(moves.size()),
                                 first = arena.make<std::uint32_t>(moves.size());
  for (std::uint32_t v = 0; v < std::uint32_t(root.size()); ++v) root[v] = v, first[v] = kNoStiffPiece;
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    root[max(a, b)] = min(a, b);
  };
  for (const SurfacePair& pair : pairs)
    for (int k = 1; k < 4; ++k) join(pair.vertex[0], pair.vertex[k]);
  for (std::uint32_t v = 0; v < std::uint32_t(stiff.size()); ++v) {
    if (stiff[v] == kNoStiffPiece) continue;
    if (first[stiff[v]] == kNoStiffPiece) first[stiff[v]] = v;
    join(first[stiff[v]], v);
  }
  const std::span<double> count = arena.make<double>(moves.size());
  for (std::size_t v = 0; v < moves.size(); ++v) means[v] = {}, count[v] = 0.0;
  for (std::uint32_t v = 0; v < std::uint32_t(moves.size()); ++v) {
    const std::uint32_t group = find(v);
    means[group] += moves[v], count[group] += 1.0;
  }
  // The least vertex of a group comes first.
  for (std::uint32_t v = 0; v < std::uint32_t(moves.size()); ++v) {
    means[v] = root[v] == v ? means[v] / count[v] : means[find(v)];
    moves[v] = moves[v] - means[v];
  }
}

// How far each vertex of a pair may go towards the other feature, m.
struct PairRoom {
  double room[4];
};

// How far vertex k is from the plane of its own feature, and the gap of the planes.
struct PairPlanes {
  double behind[4];
  double gap;
};

PairPlanes planes_of(const SurfacePair& pair, DVec3 normal, std::span<const DVec3> positions) {
  const DVec3 origin = positions[pair.vertex[0]];
  double along[4];
  for (int k = 0; k < 4; ++k) along[k] = dot(normal, positions[pair.vertex[k]] - origin);
  double low = along[0], high = along[pair.on_a];
  for (int k = 1; k < pair.on_a; ++k) low = min(low, along[k]);
  for (int k = pair.on_a + 1; k < 4; ++k) high = max(high, along[k]);
  PairPlanes planes;
  planes.gap = low - high;
  for (int k = 0; k < 4; ++k) planes.behind[k] = k < pair.on_a ? along[k] - low : high - along[k];
  return planes;
}

// How far vertex k moves towards the other feature.
double approach_of(const SurfacePair& pair, DVec3 normal, int k, std::span<const DVec3> moves) {
  const double along = dot(normal, moves[pair.vertex[k]]);
  return k < pair.on_a ? -along : along;
}

// From the closest point of B to that of A.
DVec3 apart_of(const SurfacePair& pair, const DVec3 (&at)[4]) {
  if (pair.on_a == 1) return -closest_on_triangle({}, at[1] - at[0], at[2] - at[0], at[3] - at[0]).point;
  const SegmentPair closest = closest_of_segments({}, at[1] - at[0], at[2] - at[0], at[3] - at[0]);
  return closest.on_a - closest.on_b;
}

class MoveBounds {
 public:
  MoveBounds(std::span<const SurfacePair> pairs, std::span<const DVec3> positions,
             std::span<const std::uint8_t> held, std::span<const std::uint32_t> stiff, double least_gap,
             Arena& arena, TaskSystem& tasks)
      : tasks_(tasks),
        pairs_(pairs),
        start_(positions),
        held_(held),
        stiff_(stiff),
        piece_shares_(arena.make<double>(stiff.empty() ? 0 : positions.size())),
        at_(arena.make<DVec3>(positions.size())),
        moves_(arena.make<DVec3>(positions.size())),
        shares_(arena.make<double>(positions.size())),
        rooms_(arena.make<PairRoom>(pairs.size())),
        normals_(arena.make<DVec3>(pairs.size())),
        least_(arena.make<double>(pairs.size())) {
    for (std::size_t v = 0; v < positions.size(); ++v) at_[v] = positions[v];
    crossed_ = count_pairs([&](std::size_t i) {
      normals_[i] = pairs[i].normal;
      const double gap = planes_of(pairs[i], normals_[i], at_).gap;
      least_[i] = min(gap, least_gap * double(pairs[i].thickness));
      return !(gap > 0.0);
    });
  }

  // Goes from the present places as far toward `goals` as the rooms of the present gaps let it, and adds that to `moves`. False if there is no more
  // to go.
  bool advance(std::span<const DVec3> goals, std::span<const float> limits, int passes,
               std::span<DVec3> moves, BoundReport& report) {
    for (std::size_t v = 0; v < moves.size(); ++v) moves_[v] = goals[v] - moves[v];
    report.forced += count_pairs([&](std::size_t i) { return give_room(i); });
    for (int pass = 0; pass < passes; ++pass) turn();
    shorten();
    bool any = false, all = true;
    for (std::size_t v = 0; v < moves.size(); ++v) {
      const bool there = moves_[v] == goals[v] - moves[v];
      const DVec3 sum = there ? goals[v] : moves[v] + moves_[v];
      all &= there;
      if (!limits.empty() && held_[v] == 0 && length(sum) > double(limits[v])) continue;
      any |= !(moves_[v] == DVec3{});
      at_[v] += moves_[v];
      moves[v] = sum;
    }
    return any && !all;
  }
  long crossed() const { return crossed_; }

 private:
  // Calls fn(pair) for each pair, by all workers; returns for how many it is true.
  template <class Fn>
  long count_pairs(Fn&& fn) {
    return reduce_blocks(
        tasks_, int(pairs_.size()), kBlockPairs, 0L,
        [&](int begin, int end, int) {
          long count = 0;
          for (int i = begin; i < end; ++i) count += fn(std::size_t(i));
          return count;
        },
        [](long a, long b) { return a + b; });
  }

  // Turns moves that go too far along the plane.
  void turn() {
    for_each_bound([&](std::uint32_t v, DVec3 toward, double approach, double room) {
      if (!is_of_stiff_piece(v)) moves_[v] += -(approach - room) * toward;
    });
  }

  // Shortens moves that still go too far. The share of a vertex is the least of all its bounds'.
  void shorten() {
    for (double& share : shares_) share = 1.0;
    for_each_bound([&](std::uint32_t v, DVec3, double approach, double room) {
      shares_[v] = min(shares_[v], kSafe * room / approach);
    });
    for (double& share : piece_shares_) share = 1.0;
    for (std::size_t v = 0; v < shares_.size(); ++v)
      if (is_of_stiff_piece(v)) piece_shares_[stiff_[v]] = min(piece_shares_[stiff_[v]], shares_[v]);
    for (std::size_t v = 0; v < shares_.size(); ++v) {
      if (is_of_stiff_piece(v)) shares_[v] = piece_shares_[stiff_[v]];
      if (shares_[v] < 1.0) moves_[v] = shares_[v] * moves_[v];
    }
  }

  bool is_of_stiff_piece(std::size_t vertex) const {
    return !stiff_.empty() && stiff_[vertex] != kNoStiffPiece;
  }

  // The gap that the planes with this normal would have after the moves.
  double gap_after(const SurfacePair& pair, DVec3 normal, const PairPlanes& planes) const {
    double need[2] = {-1.0e300, -1.0e300};
    for (int k = 0; k < 4; ++k) {
      double& most = need[k < pair.on_a ? 0 : 1];
      most = max(most, approach_of(pair, normal, k, moves_) - planes.behind[k]);
    }
    return planes.gap - need[0] - need[1];
  }
  // Turns the planes of a pair that would not have its moves to such that would: where edges that touch near their ends turn about
  // each other, planes that stay as they are hold back the far ends.
  void turn_planes(std::size_t number) {
    const SurfacePair& pair = pairs_[number];
    const double least = least_[number];
    if (!(least > 0.0) || gap_after(pair, normals_[number], planes_of(pair, normals_[number], at_)) > least)
      return;
    DVec3 end[4];
    for (int k = 0; k < 4; ++k) end[k] = at_[pair.vertex[k]] + moves_[pair.vertex[k]];
    const DVec3 apart = apart_of(pair, end), before = normals_[number];
    const double far = length(apart);
    if (!(far > 0.0)) return;
    const DVec3 there = apart / far;
    double best = 0.0;
    for (const DVec3 sum : {there, before + there}) {
      const double size = length(sum);
      if (!(size > 0.0)) continue;
      const DVec3 normal = sum / size;
      const PairPlanes planes = planes_of(pair, normal, at_);
      if (!(planes.gap >= least && planes_of(pair, normal, start_).gap >= least &&
            gap_after(pair, normal, planes) > best))
        continue;
      best = gap_after(pair, normal, planes);
      normals_[number] = normal;
    }
  }

  // Sets the rooms of a pair. True if its held vertices take more than there is.
  bool give_room(std::size_t number) {
    const SurfacePair& pair = pairs_[number];
    turn_planes(number);
    const DVec3 normal = normals_[number];
    const PairPlanes planes = planes_of(pair, normal, at_);
    double free = planes.gap - least_[number];
    // The room that each feature asks for, and the room that its held vertices take.
    double asked[2] = {}, taken[2] = {};
    for (int k = 0; k < 4; ++k) {
      const int side = k < pair.on_a ? 0 : 1;
      const double need = approach_of(pair, normal, k, moves_) - planes.behind[k];
      asked[side] = max(asked[side], need);
      if (held_[pair.vertex[k]] != 0) taken[side] = max(taken[side], need);
    }
    free = max(0.0, kSafe * free);
    double room[2] = {taken[0], taken[1]};
    bool forced = false;
    free -= taken[0] + taken[1];
    if (free < 0.0) {
      // Held vertices may use the least gap too.
      forced = taken[0] + taken[1] >= planes.gap;
    } else {
      const double more[2] = {asked[0] - taken[0], asked[1] - taken[1]};
      const double sum = more[0] + more[1];
      for (int side = 0; side < 2; ++side)
        room[side] += sum > free ? free * (more[side] / sum) : more[side] + 0.5 * (free - sum);
    }
    for (int k = 0; k < 4; ++k) rooms_[number].room[k] = room[k < pair.on_a ? 0 : 1] + planes.behind[k];
    return forced;
  }

  template <class Visit>
  void for_each_bound(Visit&& visit) {
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const SurfacePair& pair = pairs_[i];
      for (int k = 0; k < 4; ++k) {
        const std::uint32_t v = pair.vertex[k];
        if (held_[v] != 0) continue;
        const double approach = approach_of(pair, normals_[i], k, moves_);
        if (approach > rooms_[i].room[k])
          visit(v, k < pair.on_a ? -normals_[i] : normals_[i], approach, rooms_[i].room[k]);
      }
    }
  }

  TaskSystem& tasks_;
  std::span<const SurfacePair> pairs_;
  std::span<const DVec3> start_;
  std::span<const std::uint8_t> held_;
  std::span<const std::uint32_t> stiff_;
  std::span<double> piece_shares_;
  std::span<DVec3> at_, moves_;  // where vertices are, and how they would go on
  std::span<double> shares_;
  std::span<PairRoom> rooms_;
  std::span<DVec3> normals_;  // by pair, of its planes
  std::span<double> least_;   // by pair, m: gap of the planes that stays
  long crossed_ = 0;
};

}  // namespace

BoundReport bound_moves(std::span<const SurfacePair> pairs, std::span<const DVec3> positions,
                        std::span<const float> limits, std::span<const std::uint8_t> held,
                        std::span<const std::uint32_t> stiff, const BoundSettings& settings,
                        std::span<DVec3> moves, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  BoundReport report;
  const std::span<DVec3> asked = arena.make<DVec3>(moves.size());
  for (std::size_t v = 0; v < moves.size(); ++v) {
    asked[v] = moves[v];
    if (limits.empty() || held[v] != 0) continue;
    const double far = length(moves[v]), limit = kSafe * double(limits[v]);
    if (far > limit) moves[v] = (limit / far) * moves[v];
  }
  const std::span<DVec3> goals = arena.make<DVec3>(moves.size()), means = arena.make<DVec3>(moves.size()),
                         whole = arena.make<DVec3>(moves.size());
  for (std::size_t v = 0; v < moves.size(); ++v) goals[v] = whole[v] = moves[v], means[v] = {};
  if (limits.empty()) take_means(pairs, stiff, goals, means, arena);
  for (DVec3& move : moves) move = {};
  MoveBounds bounds(pairs, positions, held, stiff, settings.least_gap, arena, tasks);
  report.crossed = bounds.crossed();
  for (int n = 0; n < kAdvances; ++n) {
    if (!bounds.advance(goals, limits, settings.passes, moves, report)) break;
  }
  for (std::size_t v = 0; v < moves.size(); ++v)
    moves[v] = held[v] != 0 || moves[v] == goals[v] ? whole[v] : moves[v] + means[v];
  for (std::size_t v = 0; v < moves.size(); ++v) report.shortened += !(moves[v] == asked[v]);
  return report;
}

}  // namespace gyre
