// The two tables that a simulation writes: the motion of every body and vertex, and figures of the whole world, step by step (CSV).
#pragma once

#include "output_file.h"
#include "scene/scene_runner.h"

#include <string>

namespace gyre {

// One row per body: step,time,body,p,q,v,w,awake, where p is the centre of mass; then one per vertex of ropes, cloths and soft
// bodies, NAME[i].
class TraceTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);
  OutputFile& file() { return file_; }

 private:
  bool add_vertices(const std::string& begin, const std::string& name, const SoftVertices& vertices,
                    bool is_awake);

  OutputFile file_;
  std::string row_;
};

// One row a step.
class StatsTable {
 public:
  bool open(const std::string& path);
  bool add_row(const SceneRunner& runner, double step_ms, bool count_crossings);
  OutputFile& file() { return file_; }

 private:
  OutputFile file_;
  std::string row_;
};

}  // namespace gyre
