// Words of the format for axes and sides of the box of a fluid.
#pragma once

namespace gyre {

inline constexpr const char* kAxisKeys[3] = {"x", "y", "z"};
inline constexpr const char* kSideKeys[6] = {"-x", "+x", "-y", "+y", "-z", "+z"};

}  // namespace gyre
