// Chooses the plane of a node of the BSP tree. See broadphase_bsp.h.
#include "collision/broadphase/broadphase_bsp.h"

#include "collision/broadphase/split_tree_build.h"

namespace gyre {
namespace {

constexpr std::size_t kPlaneSample = 24;
// The cost of a box that the plane cuts, relative to one on the larger side.
constexpr float kCutCost = 1.5f;
constexpr float kNoCost = 1.0e9f;

void insert_sorted(float* values, std::size_t count, float value) {
  std::size_t k = count;
  for (; k > 0 && value < values[k - 1]; --k) values[k] = values[k - 1];
  values[k] = value;
}

struct Choice {
  Split split;
  float cost;
};

// The best plane across one direction: just beyond the end of a sample box.
void choose_along(int direction, std::span<const BoxEntry> sample, Choice& best) {
  float lows[kPlaneSample], highs[kPlaneSample];
  for (std::size_t i = 0; i < sample.size(); ++i) {
    insert_sorted(lows, i, SplitDirections::low(sample[i].box, direction));
    insert_sorted(highs, i, SplitDirections::high(sample[i].box, direction));
  }
  std::size_t started = 0;
  for (std::size_t i = 0; i + 1 < sample.size(); ++i) {
    // Half-way to the next start if that lies ahead; the plane then touches neither box.
    while (started < sample.size() && lows[started] <= highs[i]) ++started;
    if (started == sample.size()) break;
    const float next = min(lows[started], highs[i + 1]);
    const float value = highs[i] + 0.5f * (next - highs[i]);
    if (!(value > highs[i])) continue;
    const auto behind = float(i + 1), before = float(sample.size() - started);
    const float cut = float(sample.size()) - behind - before;
    const float cost = max(behind, before) + kCutCost * cut;
    if (cost < best.cost) best = {{std::uint8_t(direction), value}, cost};
  }
}

}  // namespace

bool BspSplitter::choose_split(std::span<BoxEntry> entries, Split& split) {
  BoxEntry sample[kPlaneSample];
  const std::size_t stride = (entries.size() + kPlaneSample - 1) / kPlaneSample;
  std::size_t count = 0;
  for (std::size_t i = 0; i < entries.size(); i += stride) sample[count++] = entries[i];
  Choice best{{}, kNoCost};
  for (int direction = 0; direction < kDirections; ++direction) {
    choose_along(direction, {sample, count}, best);
  }
  split = best.split;
  return best.cost < kNoCost;
}

template class SplitTree<BspSplitter>;

}  // namespace gyre
