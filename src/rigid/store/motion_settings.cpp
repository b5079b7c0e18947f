#include "rigid/store/motion_settings.h"

namespace gyre {

const char* to_string(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::semi_implicit_euler:
      return "semi_implicit_euler";
    case IntegratorKind::explicit_euler:
      return "explicit_euler";
    case IntegratorKind::rk4:
      return "rk4";
    case IntegratorKind::verlet:
      return "verlet";
  }
  return "";
}

const char* to_string(SpringKind kind) { return kind == SpringKind::implicit ? "implicit" : "explicit"; }

const char* to_string(TimeStepping stepping) {
  switch (stepping) {
    case TimeStepping::fixed:
      return "fixed";
    case TimeStepping::adaptive:
      return "adaptive";
    case TimeStepping::error_controlled:
      return "error_controlled";
  }
  return "";
}

}  // namespace gyre
