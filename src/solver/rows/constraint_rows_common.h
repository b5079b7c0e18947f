// The first and the last step in making a row of a contact or joint.
#pragma once

#include "solver/rows/constraint_rows.h"

namespace gyre {

inline Row& begin_row(RowList& list) {
  list.stored[list.count] = nullptr;
  Row& row = list.rows[list.count++];
  row = {};
  return row;
}

// Completes a row whose J is known. The velocity of a body that rows do not move becomes part of the target.
// `still`: rows in displacements, where such a body has none.
inline void end_row(Row& row, std::int32_t body_a, std::int32_t body_b, const RowFrame& frame,
                    bool still = false) {
  const auto set_body = [&](std::int32_t body, std::int32_t& index, DVec3 linear, DVec3 angular) {
    index = body == kNoBody ? kNoRowBody : frame.body_index[body];
    if (index != kNoRowBody || body == kNoBody || still) return;
    const BodyMotion& motion = frame.motion[body];
    row.target_speed -=
        dot(linear, DVec3(motion.linear_velocity)) + dot(angular, DVec3(motion.angular_velocity));
  };
  set_body(body_a, row.body_a, row.linear_a, row.angular_a);
  set_body(body_b, row.body_b, row.linear_b, row.angular_b);
  finish_row(row, frame.bodies);
}

}  // namespace gyre
