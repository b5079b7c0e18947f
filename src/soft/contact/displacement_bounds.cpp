#include "soft/contact/displacement_bounds.h"

#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr double kSafe = 1.0 - 0x1p-20;  // more than any rounding here takes
constexpr int kBlockPairs = 1024;        // that one worker takes at a time
constexpr int kAdvances = 6;             // in which the room that others have left is given anew

// How far each vertex of a pair may go towards the other feature, m.
struct PairRoom {
  double room[4];
};

// How far vertex k is from the plane of its own feature, and the gap of the planes.
struct PairPlanes {
  double behind[4];
  double gap;
};

PairPlanes planes_of(const SurfacePair& pair, std::span<const DVec3> positions) {
  const DVec3 origin = positions[pair.vertex[0]];
  double along[4];
  for (int k = 0; k < 4; ++k) along[k] = dot(pair.normal, positions[pair.vertex[k]] - origin);
  double low = along[0], high = along[pair.on_a];
  for (int k = 1; k < pair.on_a; ++k) low = min(low, along[k]);
  for (int k = pair.on_a + 1; k < 4; ++k) high = max(high, along[k]);
  PairPlanes planes;
  planes.gap = low - high;
  for (int k = 0; k < 4; ++k) planes.behind[k] = k < pair.on_a ? along[k] - low : high - along[k];
  return planes;
}

// How far vertex k moves towards the other feature.
double approach_of(const SurfacePair& pair, int k, std::span<const DVec3> moves) {
  const double along = dot(pair.normal, moves[pair.vertex[k]]);
  return k < pair.on_a ? -along : along;
}

class MoveBounds {
 public:
  MoveBounds(std::span<const SurfacePair> pairs, std::span<const DVec3> positions,
             std::span<const std::uint8_t> held, std::span<const std::uint32_t> stiff, double least_gap,
             Arena& arena, TaskSystem& tasks)
      : tasks_(tasks),
        pairs_(pairs),
        held_(held),
        stiff_(stiff),
        piece_shares_(arena.make<double>(stiff.empty() ? 0 : positions.size())),
        at_(arena.make<DVec3>(positions.size())),
        moves_(arena.make<DVec3>(positions.size())),
        shares_(arena.make<double>(positions.size())),
        rooms_(arena.make<PairRoom>(pairs.size())),
        least_(arena.make<double>(pairs.size())) {
    for (std::size_t v = 0; v < positions.size(); ++v) at_[v] = positions[v];
    crossed_ = count_pairs([&](std::size_t i) {
      const double gap = planes_of(pairs[i], at_).gap;
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

  // Sets the rooms of a pair. True if its held vertices take more than there is.
  bool give_room(std::size_t number) {
    const SurfacePair& pair = pairs_[number];
    const PairPlanes planes = planes_of(pair, at_);
    double free = planes.gap - least_[number];
    // The room that each feature asks for, and the room that its held vertices take.
    double asked[2] = {}, taken[2] = {};
    for (int k = 0; k < 4; ++k) {
      const int side = k < pair.on_a ? 0 : 1;
      const double need = approach_of(pair, k, moves_) - planes.behind[k];
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
        const double approach = approach_of(pair, k, moves_);
        if (approach > rooms_[i].room[k])
          visit(v, k < pair.on_a ? -pair.normal : pair.normal, approach, rooms_[i].room[k]);
      }
    }
  }

  TaskSystem& tasks_;
  std::span<const SurfacePair> pairs_;
  std::span<const std::uint8_t> held_;
  std::span<const std::uint32_t> stiff_;
  std::span<double> piece_shares_;
  std::span<DVec3> at_, moves_;  // where vertices are, and how they would go on
  std::span<double> shares_;
  std::span<PairRoom> rooms_;
  std::span<double> least_;  // by pair, m: gap of the planes that stays
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
  const std::span<DVec3> goals = arena.make<DVec3>(moves.size());
  for (std::size_t v = 0; v < moves.size(); ++v) {
    goals[v] = moves[v];
    moves[v] = {};
  }
  MoveBounds bounds(pairs, positions, held, stiff, settings.least_gap, arena, tasks);
  report.crossed = bounds.crossed();
  for (int n = 0; n < kAdvances; ++n) {
    if (!bounds.advance(goals, limits, settings.passes, moves, report)) break;
  }
  for (std::size_t v = 0; v < moves.size(); ++v) report.shortened += !(moves[v] == asked[v]);
  return report;
}

}  // namespace gyre
