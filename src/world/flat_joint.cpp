#include "world/flat_joint.h"

namespace gyre {

namespace {

template <class T>
void set_field(T& to, const T& from) {
  to = from;
}
// Zero stiffness or damping means none. The check refuses other values out of range, NaN among them.
void set_field(std::optional<float>& to, float from) {
  if (from != 0.0f) to = from;
}

template <std::size_t n = 0>
JointDef make_default(std::size_t index) {
  if constexpr (n + 1 < std::variant_size_v<JointDef>) {
    if (index != n) return make_default<n + 1>(index);
  }
  return JointDef(std::in_place_index<n>);
}

}  // namespace

FlatJoint flatten(const JointDef& def) {
  FlatJoint flat;
  flat.kind = kind_of(def);
  std::visit([&](const auto& d) { for_each_field(d, flat, [](const auto& from, auto& to) { set_field(to, from); }); }, def);
  return flat;
}

JointDef default_joint(JointKind kind) { return make_default(std::size_t(kind)); }

}  // namespace gyre
