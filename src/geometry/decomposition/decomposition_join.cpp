// Joining neighbours. See decomposition.h.
#include "geometry/decomposition/decomposition.h"
#include "task/parallel.h"

namespace gyre {
namespace {

struct Pair {
  std::uint32_t a, b;
  double lack = 0.0;
  double growth = 0.0;  // hull volume that only the two together have, of their own
};

ConvexBody joined_body(const SampledSolid& solid, const ConvexBody& a, const ConvexBody& b) {
  std::vector<DVec3> points = a.vertices;
  points.insert(points.end(), b.vertices.begin(), b.vertices.end());
  return make_body(points, {255, 0.01 * solid.tolerance, 1.0e-6 * solid.model->size});
}

bool are_near(const ConvexBody& a, const ConvexBody& b, double margin) {
  return a.low.x <= b.high.x + margin && b.low.x <= a.high.x + margin && a.low.y <= b.high.y + margin &&
         b.low.y <= a.high.y + margin && a.low.z <= b.high.z + margin && b.low.z <= a.high.z + margin;
}

// What the two lack together. Of what is above `enough`, only that it is.
void judge(const SampledSolid& solid, const std::vector<ConvexBody>& pieces, double enough, Pair& pair) {
  const ConvexBody &a = pieces[pair.a], &b = pieces[pair.b];
  const ConvexBody body = joined_body(solid, a, b);
  pair.growth = max(body.volume - a.volume - b.volume, 0.0) / max(body.volume, 1.0e-300);
  pair.lack = deepest_sample(solid, body);
  if (pair.lack > enough) return;
  const OverhangSearch search{.ignore = 0.8 * solid.tolerance,
                              .stop = enough,
                              .resolution = 0.25 * solid.tolerance,
                              .points = enough > solid.tolerance ? 100 : 60000};
  pair.lack = max(pair.lack, find_overhang(*solid.field, body, search).value);
}

void judge_all(const SampledSolid& solid, TaskSystem& tasks, const std::vector<ConvexBody>& pieces, double enough,
               std::span<Pair> pairs) {
  for_blocks(tasks, int(pairs.size()), 4, [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) judge(solid, pieces, enough, pairs[std::size_t(i)]);
  });
}

// The pair to join: the one with the least growth of volume among those that lack at most `enough`.
// Of two that differ by less, the first: scaled and mirrored meshes are joined alike.
constexpr double kSame = 2.0e-3;
const Pair* best_pair(const std::vector<Pair>& pairs, double enough) {
  const Pair* best = nullptr;
  for (const Pair& pair : pairs) {
    if (pair.lack <= enough && (best == nullptr || pair.growth < best->growth - kSame)) best = &pair;
  }
  return best;
}
const Pair* min_lacking(const std::vector<Pair>& pairs) {
  const Pair* best = nullptr;
  for (const Pair& pair : pairs) {
    if (best == nullptr || pair.lack < best->lack * (1.0 - 1.0e-6)) best = &pair;
  }
  return best;
}

// Puts the union at a's place; b's place stays empty.
void join(const SampledSolid& solid, std::vector<ConvexBody>& pieces, std::uint32_t a, std::uint32_t b) {
  pieces[a] = joined_body(solid, pieces[a], pieces[b]);
  pieces[b] = {};
}

void drop_pairs_of(std::vector<Pair>& pairs, std::uint32_t a, std::uint32_t b) {
  std::size_t kept = 0;
  for (const Pair& pair : pairs) {
    const bool gone = pair.a == a || pair.b == a || pair.a == b || pair.b == b;
    if (!gone) pairs[kept++] = pair;
  }
  pairs.resize(kept);
}

class Joining {
 public:
  Joining(const SampledSolid& solid, TaskSystem& tasks, std::vector<ConvexBody>& pieces)
      : solid_(solid), tasks_(tasks), pieces_(pieces), count_(int(pieces.size())) {}

  // Pairs within `margin` of each other join until no pair lacks at most `enough`, or `least` pieces are left.
  void run(double margin, double enough, int least, bool by_lack, DecompositionProgress& progress) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = 0; a < pieces_.size(); ++a) {
      for (std::uint32_t b = a + 1; b < pieces_.size(); ++b) add_if_near(pairs, a, b, margin);
    }
    judge_all(solid_, tasks_, pieces_, enough, pairs);
    const int from = count_;
    while (count_ > least) {
      if (!progress.go_on(0.7 + 0.2 * double(from - count_) / double(from))) return;
      const Pair* const best = by_lack ? min_lacking(pairs) : best_pair(pairs, enough);
      if (best == nullptr) return;
      const std::uint32_t a = best->a, b = best->b;
      join(solid_, pieces_, a, b);
      --count_;
      drop_pairs_of(pairs, a, b);
      const std::size_t old = pairs.size();
      for (std::uint32_t other = 0; other < pieces_.size(); ++other) {
        if (other != a) add_if_near(pairs, min(a, other), max(a, other), margin);
      }
      judge_all(solid_, tasks_, pieces_, enough, std::span<Pair>(pairs).subspan(old));
    }
  }
  int count() const { return count_; }

 private:
  void add_if_near(std::vector<Pair>& pairs, std::uint32_t a, std::uint32_t b, double margin) const {
    if (pieces_[a].empty() || pieces_[b].empty()) return;
    if (are_near(pieces_[a], pieces_[b], margin)) pairs.push_back({a, b});
  }

  const SampledSolid& solid_;
  TaskSystem& tasks_;
  std::vector<ConvexBody>& pieces_;
  int count_;
};

}  // namespace

void join_pieces(const SampledSolid& solid, TaskSystem& tasks, int max_hulls, std::vector<ConvexBody>& pieces,
                 DecompositionProgress& progress) {
  Joining joining(solid, tasks, pieces);
  joining.run(solid.tolerance, solid.tolerance, 1, false, progress);
  // Too many: neighbours first, and whatever there is if they do not suffice.
  if (joining.count() > max_hulls) joining.run(solid.tolerance, 1.0e300, max_hulls, true, progress);
  if (joining.count() > max_hulls) joining.run(1.0e300, 1.0e300, max_hulls, true, progress);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].empty()) continue;
    if (kept != i) pieces[kept] = std::move(pieces[i]);
    ++kept;
  }
  pieces.resize(kept);
}

}  // namespace gyre
