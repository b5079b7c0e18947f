// For tests that try many kinds of joints alike: the fields of all kinds side by side, and the definition that a user would write.
#pragma once

#include "world/flat_joint.h"

namespace gyre::laws {

// A definition of the kind `flat` names, with those of its fields that the kind has.
inline JointDef definition_of(const FlatJoint& flat) {
  JointDef def = default_joint(flat.kind);
  const auto take = [](auto& to, const auto& from) {
    if constexpr (std::is_same_v<decltype(to), float&> && !std::is_same_v<decltype(from), const float&>) {
      to = from.value_or(0.0f);
    } else {
      to = from;
    }
  };
  std::visit([&](auto& d) { for_each_field(d, flat, take); }, def);
  return def;
}

}  // namespace gyre::laws
