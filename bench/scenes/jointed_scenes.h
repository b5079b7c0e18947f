// Scenes of joints.
#pragma once

#include "bench/scenes/scene.h"

namespace gyre::bench {

Scene ragdolls();
Scene joint_grid();
// 100 capsules and a ball of 100 times a link's mass; hanging at rest or let go from the horizontal.
Scene chain(bool swing);

}  // namespace gyre::bench
