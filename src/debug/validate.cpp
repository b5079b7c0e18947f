// validate: state validation as the public header offers it.
#include "world/validate_state.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

Error validate(const World& world) {
  if (state_of(world).stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  return validate_state(state_of(world));
}

}  // namespace gyre
