// Elements that were left out, by name and reason, with their number.
#pragma once

#include <map>
#include <string>

namespace gyre {

class Findings {
 public:
  void left_out(const std::string& what) { ++counts_[what]; }
  bool empty() const { return counts_.empty(); }
  // "<gazebo> (2), mimic of a slider (1)"
  std::string text() const;

 private:
  std::map<std::string, int> counts_;
};

}  // namespace gyre
