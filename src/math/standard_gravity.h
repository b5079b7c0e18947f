// The gravity by which speeds and weights are judged where no world tells its own.
#pragma once

namespace gyre {

constexpr double kEarthGravity = 9.81;  // m/s^2

}  // namespace gyre
