// Cutting in rounds. See decomposition.h.
#include "base/container/sort.h"
#include "geometry/decomposition/decomposition.h"
#include "geometry/decomposition/decomposition_cut.h"
#include "task/parallel.h"

namespace gyre {
namespace {

// Which parts are cut in this round: all that lack something, or, when too many hulls would come of it, those that lack most.
std::vector<std::size_t> choose_parts(const SampledSolid& solid, const std::vector<Part>& parts, int limit) {
  struct Lack {
    double amount;
    std::size_t part;
  };
  std::vector<Lack> lacking;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].stuck && parts[i].lack() > solid.tolerance) lacking.push_back({parts[i].lack(), i});
  }
  std::vector<Lack> scratch(lacking.size());
  merge_sort(std::span<Lack>(lacking), std::span<Lack>(scratch),
             [](const Lack& a, const Lack& b) { return a.amount > b.amount; });
  const std::size_t room = std::size_t(max(limit - int(parts.size()), 0));
  if (lacking.size() > room) lacking.resize(room);
  std::vector<std::size_t> chosen;
  for (const Lack& lack : lacking) chosen.push_back(lack.part);
  return chosen;
}

struct Trial {
  std::size_t part;
  CutFamily family;
  Cut best;
};

// The best cut of each chosen part.
std::vector<Cut> find_cuts(const SampledSolid& solid, TaskSystem& tasks, const std::vector<Part>& parts,
                           std::span<const std::size_t> chosen) {
  std::vector<std::vector<CutFamily>> families(chosen.size());
  for_blocks(tasks, int(chosen.size()), 1, [&](int i, int, int) {
    families[std::size_t(i)] = find_families(solid, parts[chosen[std::size_t(i)]]);
  });
  std::vector<Trial> trials;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (CutFamily& family : families[i]) trials.push_back({i, std::move(family), {}});
  }
  for_blocks(tasks, int(trials.size()), 1, [&](int i, int, int) {
    Trial& trial = trials[std::size_t(i)];
    trial.best = best_of_family(solid, parts[chosen[trial.part]], trial.family);
  });
  std::vector<Cut> cuts(chosen.size());
  for (const Trial& trial : trials) {
    if (clearly_better(trial.best, cuts[trial.part])) cuts[trial.part] = trial.best;
  }
  return cuts;
}

double share_done(const SampledSolid& solid, const std::vector<Part>& parts) {
  std::size_t done = 0, all = 1;
  for (const Part& part : parts) {
    all += part.samples.size();
    if (part.stuck || part.lack() <= solid.tolerance) done += part.samples.size();
  }
  return double(done) / double(all);
}

}  // namespace

std::vector<ConvexBody> cut_up(const SampledSolid& solid, TaskSystem& tasks, int limit,
                               DecompositionProgress& progress) {
  std::vector<Part> parts = make_parts(solid);
  for_blocks(tasks, int(parts.size()), 1,
             [&](int i, int, int) { finish_part(solid, parts[std::size_t(i)]); });
  for (;;) {
    const std::vector<std::size_t> chosen = choose_parts(solid, parts, limit);
    if (chosen.empty() || !progress.go_on(0.1 + 0.6 * share_done(solid, parts))) break;
    const std::vector<Cut> cuts = find_cuts(solid, tasks, parts, chosen);
    if (!progress.go_on(0.1 + 0.6 * share_done(solid, parts))) break;
    std::vector<std::pair<Part, Part>> halves(chosen.size());
    for_blocks(tasks, int(chosen.size()), 1, [&](int i, int, int) {
      const Cut& cut = cuts[std::size_t(i)];
      if (cut.cost > 1.0e299) return;
      auto& [low, high] = halves[std::size_t(i)];
      std::tie(low, high) = cut_part(solid, parts[chosen[std::size_t(i)]], cut.plane);
      finish_part(solid, low);
      finish_part(solid, high);
    });
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      auto& [low, high] = halves[i];
      Part& old = parts[chosen[i]];
      if (low.body.empty() || high.body.empty()) {
        old.stuck = true;
        continue;
      }
      old = std::move(low);
      parts.push_back(std::move(high));
    }
  }
  std::vector<ConvexBody> pieces;
  for (Part& part : parts) {
    if (!part.body.empty()) pieces.push_back(std::move(part.body));
  }
  return pieces;
}

}  // namespace gyre
