// Common parts of the checks of user input.
#pragma once

#include <gyre/result.h>

namespace gyre {

constexpr double kMaxPosition = 1.0e12;  // m; positions beyond this are refused

inline Error refuse(const char* words) { return make_error(ErrorCode::invalid_argument, "%s", words); }
template <class... Args>
Error refuse(const char* format, Args... args) {
  return make_error(ErrorCode::invalid_argument, format, args...);
}

}  // namespace gyre
