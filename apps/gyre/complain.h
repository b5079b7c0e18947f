// One line on stderr and the exit status that goes with it.
#pragma once

#include "exit_code.h"

#include <cstdio>
#include <string>

namespace gyre {

inline int complain(const std::string& message, int code = kExitInvalid) {
  std::fprintf(stderr, "gyre: %s\n", message.c_str());
  return code;
}

}  // namespace gyre
