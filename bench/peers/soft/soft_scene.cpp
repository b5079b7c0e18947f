#include "bench/peers/soft/soft_scene.h"

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
constexpr double kFar = 1.0e3;   // m: what is further away has exploded

struct Figure {
  const char* name;
  double value;
};

struct Strain {
  double mean = 0.0, largest = 0.0;  // of edges: length over rest length, less 1
};
Strain strain_of(const std::vector<DVec3>& now, const std::vector<Pair>& edges, double rest) {
  Strain strain;
  for (const Pair& edge : edges) {
    const double s = std::fabs(length(now[edge[1]] - now[edge[0]]) / rest - 1.0);
    strain.mean += s / double(edges.size());
    strain.largest = std::max(strain.largest, s);
  }
  return strain;
}

// Counts crossings of a sheet by putting it into a cloth of Gyre of the same cells.
class CrossingCounter {
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

// Measures what a scene is judged by. `observe` sees the vertices after every step, `timed` from the end of the warm-up on.
class Judge {
 public:
  explicit Judge(const std::string& scene) : scene_(scene) {
    if (scene == "hanging" || scene == "folded") {
      const Sheet sheet = make_sheet(scene);
      edges_ = sheet.edges;
      rest_ = Sheet::kSpacing;
    } else if (scene == "beam") {
      beam_ = make_beam();
      start_ = tip_height(beam_.vertices);
    } else {
      for (std::uint32_t i = 0; i + 1 < Rope::kVertices; ++i) edges_.push_back({i, i + 1});
      rest_ = Rope::kLength / double(edges_.size());
    }
  }

  void observe(const std::vector<DVec3>& now, int frame, bool timed) {
    if (scene_ == "beam") {
      observe_beam(now, timed);
      return;
    }
    if (!timed) return;
    const Strain strain = strain_of(now, edges_, rest_);
    mean_ += strain.mean, largest_ += strain.largest, ++frames_;
    if (scene_ == "folded" && frame % kCountEvery == 0)
      crossings_ = std::max(crossings_, counter_.count(now));
  }

  std::vector<Figure> figures() const {
    const double share = 100.0 / std::max(1, frames_);
    if (scene_ == "beam")
      return {{"tip, mm", 500.0 * (2.0 * start_ - lowest_ - highest_)},
              {"period, s", period()},
              {"inverted", double(inverted_)}};
    std::vector<Figure> found{{"mean strain, %", share * mean_}, {"largest strain, %", share * largest_}};
    if (scene_ == "folded") found.insert(found.begin(), {"crossings", crossings_});
    return found;
  }

 private:
  double tip_height(const std::vector<DVec3>& now) const {
    double sum = 0.0;
    for (const std::uint32_t v : beam_.tip) sum += now[v].y;
    return sum / double(beam_.tip.size());
  }
  void observe_beam(const std::vector<DVec3>& now, bool timed) {
    heights_.push_back(tip_height(now));
    if (!timed) return;
    lowest_ = std::min(lowest_, heights_.back()), highest_ = std::max(highest_, heights_.back());
    int inverted = 0;
    for (const Tetrahedron& t : beam_.tetrahedra) inverted += six_volumes(now, t) <= 0.0;
    inverted_ = std::max(inverted_, inverted);
  }
  // Twice the time of the first lowest point, where a parabola through three steps has its vertex: the beam starts at rest, straight.
  double period() const {
    for (std::size_t i = 1; i + 1 < heights_.size(); ++i) {
      const double before = heights_[i - 1], at = heights_[i], after = heights_[i + 1];
      if (at <= before && at < after)
        return 2.0 * double(kStep) * (double(i + 1) + 0.5 * (before - after) / (before - 2.0 * at + after));
    }
    return NAN;
  }

  std::string scene_;
  std::vector<Pair> edges_;
  double rest_ = 1.0;  // m
  double mean_ = 0.0, largest_ = 0.0, crossings_ = 0.0;
  int frames_ = 0;
  CrossingCounter counter_;
  Beam beam_;
  double start_ = 0.0, lowest_ = 1.0e9, highest_ = -1.0e9;  // m
  int inverted_ = 0;
  std::vector<double> heights_;  // m, after each step
};

bool is_finite(const std::vector<DVec3>& now) {
  return std::all_of(now.begin(), now.end(),
                     [](const DVec3& p) { return length(p) < kFar; });  // false for what is no number
}

}  // namespace

Sheet make_sheet(const std::string& scene) {
  Sheet sheet;
  sheet.held = scene == "hanging";
  const double height = sheet.held ? 0.0 : 0.9;
  constexpr std::uint32_t n = Sheet::kSide;
  const auto cells_beside = [](std::uint32_t i) { return i == 0 || i == n - 1 ? 1 : 2; };
  const double quarter = double(Sheet::kAreaDensity) * Sheet::kSpacing * Sheet::kSpacing / 4.0;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t at = i + j * n;
      sheet.vertices.push_back({i * Sheet::kSpacing - 1.0, height, j * Sheet::kSpacing - 1.0});
      sheet.masses.push_back(float(quarter * cells_beside(i) * cells_beside(j)));
      if (i + 1 < n) sheet.edges.push_back({at, at + 1});
      if (j + 1 < n) sheet.edges.push_back({at, at + n});
      if (i + 1 == n || j + 1 == n) continue;
      sheet.diagonals.push_back({at, at + n + 1});
      sheet.diagonals.push_back({at + 1, at + n});
      for (const std::uint32_t v : {at, at + n, at + 1, at + 1, at + n, at + n + 1})
        sheet.triangles.push_back(v);
    }
  }
  return sheet;
}

double six_volumes(const std::vector<DVec3>& p, const Tetrahedron& t) {
  return dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), p[t[3]] - p[t[0]]);
}

Beam make_beam() {
  Beam beam;
  constexpr std::uint32_t cells[3] = {30, 8, 7};
  constexpr double size = 1.0 / 30.0;  // m, of a cell
  constexpr std::uint32_t stride[3] = {1, cells[0] + 1, (cells[0] + 1) * (cells[1] + 1)};
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i) {
        if (i == 0) beam.clamped.push_back(std::uint32_t(beam.vertices.size()));
        if (i == cells[0]) beam.tip.push_back(std::uint32_t(beam.vertices.size()));
        beam.vertices.push_back({i * size, j * size, k * size});
      }
    }
  }
  // Six tetrahedra around the diagonal of each cell, one for each order of the axes.
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (std::uint32_t k = 0; k < cells[2]; ++k) {
    for (std::uint32_t j = 0; j < cells[1]; ++j) {
      for (std::uint32_t i = 0; i < cells[0]; ++i) {
        const std::uint32_t corner = i * stride[0] + j * stride[1] + k * stride[2];
        for (const auto& order : orders) {
          Tetrahedron t{corner};
          for (int a = 0; a < 3; ++a) t[a + 1] = t[a] + stride[order[a]];
          if (six_volumes(beam.vertices, t) < 0.0) std::swap(t[2], t[3]);
          beam.tetrahedra.push_back(t);
        }
      }
    }
  }
  beam.masses.assign(beam.vertices.size(), 0.0f);
  for (const Tetrahedron& t : beam.tetrahedra) {
    for (const std::uint32_t v : t)
      beam.masses[v] += float(double(Beam::kDensity) * six_volumes(beam.vertices, t) / 24.0);
  }
  return beam;
}

Rope make_rope() {
  Rope rope;
  const double spacing = Rope::kLength / (Rope::kVertices - 1);
  for (std::uint32_t i = 0; i < Rope::kVertices; ++i) {
    const bool end = i == 0 || i + 1 == Rope::kVertices;
    rope.vertices.push_back({i * spacing, 0.0, 0.0});
    rope.masses.push_back(float(double(Rope::kLinearDensity) * spacing * (end ? 0.5 : 1.0)));
  }
  return rope;
}

int judge(const std::string& scene, int frames, const Subject& subject) {
  Judge judge(scene);
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
    if (!is_finite(now)) {
      exploded = frame;
      break;
    }
    judge.observe(now, frame, timed);
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
  for (const Figure& figure : judge.figures()) {
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
