#include "bench/scenes/soft_judge.h"

#include <gyre/gyre.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "bench/scenes/clock.h"

namespace gyre::bench::soft {

namespace {

constexpr int kWarmUp = 60;      // steps: a second, in which sheets fall and beams reach their first extreme
constexpr int kCountEvery = 20;  // steps between counts of crossings, which take longer than a step
constexpr double kFar = 1.0e3;   // m: a vertex further away has exploded

bool is_near(const std::vector<DVec3>& now) {
  return std::all_of(now.begin(), now.end(),
                     [](const DVec3& p) { return length(p) < kFar; });  // false for what is no number
}

}  // namespace

// Counts crossings of a sheet by putting it into a cloth of Gyre of the same cells.
class SoftJudge::CrossingCounter {
 public:
  CrossingCounter() : world_(*World::create({.threads = 1})) {
    const int cells = int(Sheet::kSide) - 1;
    cloth_ =
        world_.add_cloth({.grid = ClothGrid{{float(Sheet::kSize), float(Sheet::kSize)}, {cells, cells}}});
  }
  double count(const std::vector<DVec3>& vertices) {
    if (!world_.set_vertices(cloth_, vertices, {})) std::exit(1);
    return double(world_.cloth_crossings());
  }

 private:
  World world_;
  SoftId cloth_{};
};

SoftJudge::SoftJudge(const std::string& scene) : scene_(scene) {
  if (scene == "beam") {
    beam_ = make_beam();
    start_ = tip_height(beam_.vertices);
  } else if (scene == "rope") {
    for (std::uint32_t i = 0; i + 1 < Rope::kVertices; ++i) edges_.push_back({i, i + 1});
    rest_ = Rope::kLength / double(edges_.size());
  } else {
    edges_ = make_sheet(scene).edges;
    rest_ = Sheet::kSpacing;
  }
  if (scene == "folded") counter_ = std::make_unique<CrossingCounter>();
}
SoftJudge::~SoftJudge() = default;

void SoftJudge::observe(const std::vector<DVec3>& now, bool timed) {
  if (scene_ == "beam") return observe_beam(now, timed);
  if (!timed) return;
  double sum = 0.0, largest = 0.0;
  for (const Pair& edge : edges_) {
    const double strain = std::fabs(length(now[edge[1]] - now[edge[0]]) / rest_ - 1.0);
    sum += strain;
    largest = std::max(largest, strain);
  }
  mean_ += sum / double(edges_.size());
  largest_ += largest;
  if (counter_ && steps_ % kCountEvery == 0) crossings_ = std::max(crossings_, counter_->count(now));
  ++steps_;
}

std::vector<SoftFigure> SoftJudge::figures() const {
  if (scene_ == "beam")
    return {{"tip, mm", 1.0e3 * (start_ - 0.5 * (lowest_ + highest_))},
            {"period, s", period()},
            {"inverted", double(inverted_)}};
  const double percent = 100.0 / std::max(1, steps_);
  std::vector<SoftFigure> found;
  if (counter_) found.push_back({"crossings", crossings_});
  found.push_back({"mean strain, %", percent * mean_});
  found.push_back({"largest strain, %", percent * largest_});
  return found;
}

double SoftJudge::tip_height(const std::vector<DVec3>& now) const {
  double sum = 0.0;
  for (const std::uint32_t v : beam_.tip) sum += now[v].y;
  return sum / double(beam_.tip.size());
}
void SoftJudge::observe_beam(const std::vector<DVec3>& now, bool timed) {
  heights_.push_back(tip_height(now));
  if (!timed) return;
  lowest_ = std::min(lowest_, heights_.back());
  highest_ = std::max(highest_, heights_.back());
  int inverted = 0;
  for (const Tetrahedron& t : beam_.tetrahedra) inverted += six_volumes(now, t) <= 0.0;
  inverted_ = std::max(inverted_, inverted);
}
// The beam starts straight and at rest, so it is lowest for the first time after half a period, where a parabola through three steps is.
double SoftJudge::period() const {
  for (std::size_t i = 1; i + 1 < heights_.size(); ++i) {
    const double before = heights_[i - 1], at = heights_[i], after = heights_[i + 1];
    if (at > before || at >= after) continue;
    return 2.0 * double(kStep) * (double(i + 1) + 0.5 * (before - after) / (before - 2.0 * at + after));
  }
  return NAN;
}

int judge(const std::string& scene, int frames, const Subject& subject) {
  SoftJudge judge(scene);
  std::vector<double> ms;
  std::vector<DVec3> now;
  int exploded = 0;
  for (int frame = 1; frame <= kWarmUp + frames; ++frame) {
    const double begin = cpu_ms();
    subject.step();
    const double taken = cpu_ms() - begin;
    const bool timed = frame > kWarmUp;
    if (timed) ms.push_back(taken);
    subject.read(now);
    if (!is_near(now)) {
      exploded = frame;
      break;
    }
    judge.observe(now, timed);
  }
  std::printf(R"({"engine": "%s", "scene": "%s", "settings": "%s", )", subject.engine.c_str(), scene.c_str(),
              subject.settings.c_str());
  if (exploded != 0) {
    std::printf(R"("exploded": %d})"
                "\n",
                exploded);
    return 0;
  }
  std::printf(R"("ms": %.5g, "p99": %.5g, "largest": %.5g, "figures": {)", quantile(ms, 0.5),
              quantile(ms, 0.99), quantile(ms, 1.0));
  const char* separator = "";
  for (const SoftFigure& figure : judge.figures()) {
    if (std::isfinite(figure.value))
      std::printf(R"(%s"%s": %.6g)", separator, figure.name, figure.value);
    else
      std::printf(R"(%s"%s": null)", separator, figure.name);
    separator = ", ";
  }
  std::printf("}}\n");
  return 0;
}

int Arguments::number(std::size_t i, int otherwise) const {
  for (const std::string& one : rest) {
    if (one.find_first_not_of("0123456789") == std::string::npos && i-- == 0) return std::atoi(one.c_str());
  }
  return otherwise;
}
bool Arguments::has(const std::string& word) const {
  return std::find(rest.begin(), rest.end(), word) != rest.end();
}
Arguments read_arguments(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "%s SCENE FRAMES [settings]; SCENE: hanging, folded, beam, rope\n", argv[0]);
    std::exit(2);
  }
  return {argv[1], std::atoi(argv[2]), {argv + 3, argv + argc}};
}
std::string count_of(int number, const std::string& thing) {
  return std::to_string(number) + " " + thing + (number == 1 ? "" : "s");
}
int skip(const std::string& engine, const std::string& scene) {
  std::fprintf(stderr, "%s has no scene %s\n", engine.c_str(), scene.c_str());
  return 1;
}

}  // namespace gyre::bench::soft
