// The states of a run as VTK files, which ParaView opens: .vtp of surfaces, lines and particles, .vtu of tetrahedra, .vti of gases, and a .pvd
// that lists the files of all times.
//
// In: a scene that runs. Out: the names and bytes of files that belong in one folder.
#pragma once

#include "scene/scene_runner.h"

#include <string>
#include <vector>

namespace gyre {

struct VtkFile {
  std::string name;
  std::string bytes;
};

class VtkSeries {
 public:
  // The files of the present state.
  std::vector<VtkFile> add_state(const SceneRunner& runner);
  // The list of all files so far; its name is that of `name` with .pvd.
  VtkFile collection(const std::string& name) const;

 private:
  void add(std::vector<VtkFile>& files, const SceneRunner& runner, const std::string& part,
           const char* ending, std::string bytes);

  struct Entry {
    double time;
    std::string part, file;
  };
  std::vector<Entry> entries_;
  std::vector<std::string> parts_;  // in the order of their first file
};

}  // namespace gyre
