// Projects a group with joints of any kind: each segment takes the motion nearest to the bodies' own, by
// mass, that satisfies equations and limits. Newton's method on the rows of the joints, whose impulses are
// displacements here (the projection of SHAKE, with limits: J.-P. Ryckaert, G. Ciccotti, H. Berendsen, 1977).
#pragma once

#include "rigid/continuous/ccd_projection_path.h"

namespace gyre {

// If there is nothing to solve, or too much, bodies stay. Returns whether they moved.
bool project_by_rows(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                     bool stop_at_impact, Arena& arena);

}  // namespace gyre
