// Flat arrays for <gyre/debug.h>: vectors and quaternions as runs of floats.
#pragma once

#include <gyre/math.h>

#include <cstddef>
#include <vector>

namespace gyre {

inline void append(std::vector<float>& out, Vec3 v) {
  out.push_back(v.x);
  out.push_back(v.y);
  out.push_back(v.z);
}
inline void append(std::vector<float>& out, Quat q) {
  out.push_back(q.x);
  out.push_back(q.y);
  out.push_back(q.z);
  out.push_back(q.w);
}
// Row i of a table of three columns.
inline Vec3 vector_at(const std::vector<float>& from, std::size_t i) {
  return {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
}
inline Quat quaternion_at(const std::vector<float>& from, std::size_t i) {
  return {from[4 * i], from[4 * i + 1], from[4 * i + 2], from[4 * i + 3]};
}

// Empties the arrays.
template <class... Arrays>
void clear_all(Arrays&... arrays) {
  (arrays.clear(), ...);
}

}  // namespace gyre
