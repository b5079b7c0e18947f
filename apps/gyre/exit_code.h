// What the program's exit status says.
#pragma once

namespace gyre {

constexpr int kExitGood = 0;
constexpr int kExitFailed = 1;  // validate: a measured number is not what it must be
constexpr int kExitUsage = 2;   // wrong options or arguments
constexpr int kExitInvalid =
    3;  // a scene or file cannot be read or is invalid, or an output cannot be written
constexpr int kExitNotFinite = 4;      // the simulation stopped being finite
constexpr int kExitInterrupted = 130;  // Ctrl-C

}  // namespace gyre
