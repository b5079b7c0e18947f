// The tables that a simulation writes, step by step (CSV): the motion of every body and vertex, forces of joints, contact points, figures of
// the whole world, fluids at probes, and events.
#pragma once

#include "output_file.h"
#include "scene/scene_runner.h"

#include <string>
#include <vector>

namespace gyre {

// A table on its way to a file.
class CsvTable {
 public:
  OutputFile& file() { return file_; }

 protected:
  OutputFile file_;
  std::string row_;
};

// One row per body: step,time,body,p,q,v,w,awake, where p is the centre of mass; then one per vertex of ropes, cloths and soft
// bodies, NAME[i]; then, if asked for, one per particle of liquids.
class TraceTable : public CsvTable {
 public:
  // `only`: names of bodies and soft matter; empty: all.
  bool open(const std::string& path, const std::vector<std::string>& only, bool with_liquids);
  bool add_rows(const SceneRunner& runner);

 private:
  bool add_vertices(const std::string& begin, const std::string& name, const SoftVertices& vertices,
                    bool is_awake);
  bool has(const std::string& name) const;
  bool add_particles(const std::string& begin, const std::string& name, const World& world, FluidId id);

  bool with_liquids_ = false;
  std::vector<std::string> only_;
  std::vector<DVec3> positions_;
  std::vector<Vec3> velocities_;
};

// One row per joint that is there: the mean force (N) and torque (N m) on body b over the last step, position and velocity along its axis.
class JointForceTable : public CsvTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);
};

// One row per contact point: forces (N) are means over the last step, friction on body b; the friction of a whole manifold stands at its
// first point.
class ContactPointTable : public CsvTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);

 private:
  std::vector<ContactPoint> points_;
};

// One row per probe of gases and liquids.
class ProbeTable : public CsvTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);
};

// One row per event of a step: what happened, and to whom.
class EventTable {
 public:
  bool open(const std::string& path);
  bool add_rows(const SceneRunner& runner);
  OutputFile& file() { return file_; }

 private:
  OutputFile file_;
  std::string row_;
};

// One row a step.
class StatsTable : public CsvTable {
 public:
  bool open(const std::string& path);
  bool add_row(const SceneRunner& runner, double step_ms, bool count_crossings);
};

}  // namespace gyre
