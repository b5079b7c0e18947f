// Leads a group along whatever its joints are: of all motions that keep to their equations and limits each part takes the one nearest
// to the bodies' own, by mass. Newton's method on the rows of the joints, whose impulses are displacements here (the projection of
// SHAKE, with limits: J.-P. Ryckaert, G. Ciccotti, H. Berendsen, 1977).
#pragma once

#include "rigid/continuous/ccd_projection_path.h"

namespace gyre {

// Where there is nothing to solve, or too much, bodies stay where they are. Returns whether they moved.
bool project_by_rows(const RigidWorld& w, const ProjectionGroup& group, const ProjectionBodies& bodies,
                    bool stop_at_impact, Arena& arena);

}  // namespace gyre
