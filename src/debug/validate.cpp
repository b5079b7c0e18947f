// validate: state validation as the public header offers it.
#include "world/validate_state.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

Error validate(const World& world) {
  if (world.state().stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  return validate_state(world.state());
}

}  // namespace gyre
