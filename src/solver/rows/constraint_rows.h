// Converts contacts and joints to scalar rows (solver/rows/row.h), and stores the impulses of the rows back
// in contacts and joints.
//
// A contact has two tangent rows for each point, bounded together by the friction set, and then the normal
// rows. In this order non-penetration has the last word. Surfaces with spinning or rolling friction add a
// twist row and two rolling rows, bounded by the load. A gap of s may close within the sub-step: the normal
// speed is at least -s / h. Penetration adds no bias here; pushout removes it after the step, without
// momentum.
//
// A joint has its equations, and for each active axis a row for each limit, motor, friction and spring.
// Springs that a sub-step resolves are forces (semi-implicit Euler keeps their energy); stiffer ones are soft
// rows. The bounds of pose drives and of friction against all rotation hold for each world axis separately.
//
// In: ContactConstraint, or JointRecord with its prepared JointConstraint. Out: rows, then impulses.
#pragma once

#include "solver/contact/contact_block.h"
#include "solver/joint/joint.h"
#include "solver/rows/row.h"

namespace gyre {

// The bodies of an island while its rows are made.
struct RowFrame {
  std::span<RowBody> bodies;                 // with the velocities along which rows are evaluated
  const std::int32_t* body_index = nullptr;  // by motion record: index in `bodies`; kNoRowBody if no row
                                             // moves it
  const BodyMotion* motion = nullptr;
  double substep = 0.0;
};

// A body at rest. `locked_linear`: bits 0 to 2 lock the world's x, y, z.
inline RowBody make_row_body(const BodyInertia& inertia, std::uint8_t locked_linear) {
  const double w = double(inertia.inverse_mass);
  const Sym3& m = inertia.inverse;
  return {{},
          {},
          {(locked_linear & 1) != 0 ? 0.0 : w, (locked_linear & 2) != 0 ? 0.0 : w,
           (locked_linear & 4) != 0 ? 0.0 : w},
          {double(m.xx), double(m.yy), double(m.zz), double(m.xy), double(m.xz), double(m.yz)}};
}

// Rows of an island, and where the impulse of each is stored (null where several rows share one store).
struct RowList {
  Row* rows = nullptr;
  float** stored = nullptr;
  int count = 0;
};

int count_contact_rows(const ContactConstraint& constraint);
// `warm`: scale of the accumulated impulses.
void add_contact_rows(const ContactConstraint& constraint, const RowFrame& frame, float warm, RowList& list);
// `rows`: those of this contact.
void store_contact_impulses(const ContactConstraint& constraint, const FrictionSet& set,
                            std::span<const Row> rows);
// Adds normal rows in displacements: the pushout of the penetration in a step. Returns true if anything
// penetrates.
bool add_overlap_rows(const ContactConstraint& constraint, const RowFrame& frame, float step, RowList& list);

int count_joint_rows(const JointRecord& joint, const JointDetail* detail, const JointConstraint& work);
// Springs that are forces change the velocities of the frame at once.
void add_joint_rows(JointRecord& joint, JointConstraint& work, const JointSettings& settings,
                    const RowFrame& frame, RowList& list);
void store_joint_impulses(JointRecord& joint, JointConstraint& work, std::span<const Row> rows,
                          std::span<float* const> stored);
// Adds the equations without bias, so that pushout does not open joints.
void add_joint_equations(JointRecord& joint, JointConstraint& work, const RowFrame& frame, RowList& list);

}  // namespace gyre
