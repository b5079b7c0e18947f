// Jolt's answers to the questions of bench/queries, in a file of its own: its headers must see the processor features that its
// library was built for, and nothing of ours should.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace gyre::bench {

struct JoltBox {
  double place[3];
  float turn[4];  // x, y, z, w
};

class JoltQueries {
 public:
  // A mesh (three floats a vertex, three indices a triangle) and cubes of a metre, all of them static.
  JoltQueries(std::span<const float> vertices, std::span<const unsigned> indices,
              std::span<const JoltBox> boxes);
  ~JoltQueries();
  bool ray(const double* from, const float* way) const;
  bool ball(const double* from, const float* way, float radius) const;
  // How many bodies overlap a ball, or a cube of that half side.
  std::size_t overlaps(const double* place, float size, bool cube) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace gyre::bench
