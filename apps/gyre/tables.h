// The tables that a simulation writes, step by step (CSV): the motion of every body and vertex, figures of the whole world, and fluids at
// probes.
#pragma once

#include "output_file.h"
#include "scene/scene_runner.h"

#include <string>
#include <vector>

namespace gyre {

// One row per body: step,time,body,p,q,v,w,awake, where p is the centre of mass; then one per vertex of ropes, cloths and soft
// bodies, NAME[i]; then, if asked for, one per particle of liquids.
class TraceTable {
 public:
  bool open(const std::string& path, bool with_liquids);
  bool add_rows(const SceneRunner& runner);
  OutputFile& file() { return file_; }

 private:
  bool add_vertices(const std::string& begin, const std::string& name, const SoftVertices& vertices,
                    bool is_awake);
  bool add_particles(const std::string& begin, const std::string& name, const World& world, FluidId id);

  OutputFile file_;
  std::string row_;
  bool with_liquids_ = false;
  std::vector<DVec3> positions_;
  std::vector<Vec3> velocities_;
};

// One row per probe of gases and liquids.
class ProbeTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);
  OutputFile& file() { return file_; }

 private:
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
