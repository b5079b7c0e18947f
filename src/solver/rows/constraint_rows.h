// Contacts and joints as scalar rows (solver/rows/row.h), and the rows' impulses back to where contacts and joints keep theirs.
//
// A contact has for each point the two tangents, limited together by the friction set, and then the normal: taken one after the
// other, that points keep apart has the last word. Then the twist of the whole contact and its two rolling rows, limited by its load,
// where its surface has these frictions. A gap of s may close within the sub-step: the normal asks for -s / h at least.
// Overlap asks for nothing here: it is pushed apart when the step is over, without momentum.
//
// A joint has its equations, and for each axis on which something acts a row for each of stops, motor, friction and spring.
// Springs that a sub-step resolves are forces (kick and drift keep their energy); stiffer ones are soft rows. Limits of drives to a
// pose and of friction against all turning hold for each of the world's axes by itself.
//
// In: ContactConstraint, or JointRecord with JointConstraint as placed and bent in the sub-step. Out: rows; then velocities' impulses.
#pragma once

#include "solver/contact/contact_block.h"
#include "solver/joint/joint.h"
#include "solver/rows/row.h"

namespace gyre {

// An island's bodies while its rows are made.
struct RowFrame {
  std::span<RowBody> bodies;            // with the velocities that the rows find
  const std::int32_t* body_index = nullptr;  // by motion record: among `bodies`; kNoRowBody if no row moves it
  const BodyMotion* motion = nullptr;
  double substep = 0.0;
};

// A body at rest. `locked_linear`: bits 0 to 2: not moved along the world's x, y, z.
inline RowBody make_row_body(const BodyInertia& inertia, std::uint8_t locked_linear) {
  const double w = double(inertia.inverse_mass);
  const Sym3& m = inertia.inverse;
  return {{},
          {},
          {(locked_linear & 1) != 0 ? 0.0 : w, (locked_linear & 2) != 0 ? 0.0 : w,
           (locked_linear & 4) != 0 ? 0.0 : w},
          {double(m.xx), double(m.yy), double(m.zz), double(m.xy), double(m.xz), double(m.yz)}};
}

// Rows of an island, and where the impulse of each is kept (null where several rows share what keeps them).
struct RowList {
  Row* rows = nullptr;
  float** stored = nullptr;
  int count = 0;
};

int count_contact_rows(const ContactConstraint& constraint);
// `warm`: by how much impulses that were kept are scaled.
void add_contact_rows(const ContactConstraint& constraint, const RowFrame& frame, float warm, RowList& list);
// `rows`: those that the contact added.
void store_contact_impulses(const ContactConstraint& constraint, const FrictionSet& set,
                           std::span<const Row> rows);
// Rows of the normals alone, in displacements: how far a step pushes what overlaps. Returns whether anything does.
bool add_overlap_rows(const ContactConstraint& constraint, const RowFrame& frame, float step, RowList& list);

int count_joint_rows(const JointRecord& joint, const JointDetail* detail, const JointConstraint& work);
// Springs that are forces push the bodies of the frame at once.
void add_joint_rows(JointRecord& joint, JointConstraint& work, const JointSettings& settings,
                    const RowFrame& frame, RowList& list);
void store_joint_impulses(JointRecord& joint, JointConstraint& work, std::span<const Row> rows,
                         std::span<float* const> stored);
// The equations alone, asking for nothing: what is pushed apart stays joined.
void add_joint_equations(JointRecord& joint, JointConstraint& work, const RowFrame& frame, RowList& list);

}  // namespace gyre
