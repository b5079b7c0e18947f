// The judge of soft matter in any engine. A driver builds a scene of soft_scene.h in its engine and hands over two functions: one that steps,
// one that reads vertices. The judge takes the processor time of each step and measures the vertices outside that time, so that time and
// error come from one run.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/scenes/soft_scene.h"

namespace gyre::bench::soft {

struct SoftFigure {
  const char* name;
  double value;
};

// Measures what a scene is judged by:
//   sheets and ropes: strain (length over rest length, less 1) of edges, mean and largest, each averaged over the timed steps
//   folded: also pairs of an edge and a triangle that cross, the most in any 20th step
//   beam: the middle of the swing of its tip below its start; twice the time to its first lowest point; most tetrahedra turned inside out
class SoftJudge {
 public:
  explicit SoftJudge(const std::string& scene);
  ~SoftJudge();

  // `now` holds the vertices after a step; every step is told, from the first on.
  void observe(const std::vector<DVec3>& now, bool timed);
  std::vector<SoftFigure> figures() const;

 private:
  class CrossingCounter;

  double tip_height(const std::vector<DVec3>& now) const;
  void observe_beam(const std::vector<DVec3>& now, bool timed);
  double period() const;

  std::string scene_;
  std::vector<Pair> edges_;
  double rest_ = 1.0;  // m
  double mean_ = 0.0, largest_ = 0.0, crossings_ = 0.0;
  int steps_ = 0;  // timed ones
  std::unique_ptr<CrossingCounter> counter_;
  Beam beam_;
  double start_ = 0.0, lowest_ = 1.0e9, highest_ = -1.0e9;  // m, of the tip
  int inverted_ = 0;
  std::vector<double> heights_;  // m, of the tip, after each step
};

struct Subject {
  std::string engine, settings;
  std::function<void()> step;                     // by kStep
  std::function<void(std::vector<DVec3>&)> read;  // all vertices, in the order of the scene
};

// Runs 60 steps and then `frames` timed ones; prints a line of JSON. Returns what main returns.
int judge(const std::string& scene, int frames, const Subject& subject);

// The arguments of every driver: SCENE FRAMES, then its own words and numbers.
struct Arguments {
  std::string scene;
  int frames = 0;
  std::vector<std::string> rest;

  int number(std::size_t i,
             int otherwise) const;  // the number of this index; words between numbers do not count
  bool has(const std::string& word) const;
};
Arguments read_arguments(int argc, char** argv);
// "1 sub-step", "4 sub-steps".
std::string count_of(int number, const std::string& thing);
// Says that the engine does not have the scene; returns what main returns.
int skip(const std::string& engine, const std::string& scene);

}  // namespace gyre::bench::soft
