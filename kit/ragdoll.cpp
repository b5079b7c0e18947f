// Adds ragdolls to a world: checks, bodies, joints, and pairs of bones that do not collide.
//
// A joint's zero is the pose in which it is made. So bodies are made at the middle of all limits, joined, and then moved to their start.
#include "kit/ragdoll_frames.h"

namespace gyre::kit {

namespace {

template <class... Values>
Error refuse(const char* format, Values... values) {
  return make_error(ErrorCode::invalid_argument, format, values...);
}

bool is_unit(Quat q) { return is_finite(q) && absolute(dot(q, q) - 1.0f) < 1.0e-3f; }
bool is_range(const Limits& l, float most) {
  return is_finite(l.low) && is_finite(l.high) && l.low <= l.high && 0.5f * (l.high - l.low) <= most;
}

Error check_joint(const char* name, const BoneJoint& joint) {
  constexpr float kMost = kPi + 1.0e-4f;
  if (joint.kind > BoneJointKind::fixed)
    return refuse("ragdoll: the joint of bone '%s' is of kind %d; there is no such", name, int(joint.kind));
  if (!is_finite(joint.axis) || !(length(joint.axis) > 1.0e-6f) || !is_finite(joint.across))
    return refuse("ragdoll: bone '%s': joint.axis and joint.across must be finite, joint.axis not zero",
                  name);
  if (joint.kind == BoneJointKind::cone &&
      !(length(cross(normalized(joint.axis), normalized(joint.across))) > 0.01f)) {
    return refuse("ragdoll: bone '%s': joint.across is along joint.axis; it must be across", name);
  }
  const struct {
    const char* field;
    const Limits& limits;
    bool used;
  } all[] = {{"twist", joint.twist, is_limited(joint)},
             {"swing_y", joint.swing_y, joint.kind == BoneJointKind::cone},
             {"swing_z", joint.swing_z, joint.kind == BoneJointKind::cone}};
  for (const auto& l : all) {
    if (l.used && !is_range(l.limits, kMost)) {
      return refuse(
          "ragdoll: bone '%s': joint.%s is %g to %g; low must not be above high, nor a whole turn below it",
          name, l.field, double(l.limits.low), double(l.limits.high));
    }
  }
  if (!(joint.friction >= 0.0f && joint.friction <= 1.0e9f) ||
      !(joint.max_torque >= 0.0f && joint.max_torque <= 1.0e9f)) {
    return refuse(
        "ragdoll: bone '%s': joint.friction and joint.max_torque must be 0 to 1e9 N m; they are %g and %g",
        name, double(joint.friction), double(joint.max_torque));
  }
  return {};
}

Error check_mass(const char* name, const BoneDef& bone) {
  if (bone.shapes.empty() && !(bone.mass && bone.inertia)) {
    return refuse("ragdoll: bone '%s' has no shapes; give it one, or mass and inertia", name);
  }
  if (bone.mass && !(*bone.mass > 0.0f && *bone.mass <= 1.0e9f))
    return refuse("ragdoll: bone '%s': mass is %g; it must be above 0 and at most 1e9 kg", name,
                  double(*bone.mass));
  if (bone.inertia) {
    const Error e = check_inertia(*bone.inertia);
    if (e) return refuse("ragdoll: bone '%s': %s", name, e.message);
  }
  for (const ShapeDef& shape : bone.shapes) {
    if (!is_finite(shape.local.position) || !is_unit(shape.local.orientation) || !(shape.density >= 0.0f))
      return refuse("ragdoll: bone '%s': a shape's place must be finite and its density 0 or more", name);
    const Result<MassProperties> mass = mass_properties(shape.geometry, 1.0f);
    if (!mass) return refuse("ragdoll: bone '%s': %s", name, mass.error().message);
  }
  const float mass = bone_mass(bone).mass;
  if (!(mass > 0.0f))
    return refuse("ragdoll: bone '%s' weighs %g kg; give a shape density, or the bone mass", name,
                  double(mass));
  return {};
}

Error check_bone(const RagdollDef& def, std::size_t i) {
  const BoneDef& bone = def.bones[i];
  const char* const name = bone.name.c_str();
  if (std::string_view(bone.name).empty()) return refuse("ragdoll: bone %d has no name", int(i));
  if (find_bone(def, bone.name) != int(i))
    return refuse("ragdoll: bones %d and %d are both called '%s'", find_bone(def, bone.name), int(i), name);
  if (i == 0 && bone.parent != -1)
    return refuse("ragdoll: bone '%s' is the first and has parent %d; the first is the root, with parent -1",
                  name, bone.parent);
  if (i > 0 && (bone.parent < 0 || std::size_t(bone.parent) >= i))
    return refuse("ragdoll: bone '%s' (%d) has parent %d; parents stand before their children", name, int(i),
                  bone.parent);
  if (!is_finite(bone.rest.position) || !is_unit(bone.rest.orientation))
    return refuse("ragdoll: bone '%s': rest must be finite, its orientation of length 1", name);
  const Error e = check_mass(name, bone);
  return e || i == 0 ? e : check_joint(name, bone.joint);
}

// ------------------------------------------------------------------------------------------------------------------ adding

BodyDef body_of(const RagdollDef& def, const BoneDef& bone, const Pose& place) {
  BodyDef body;
  body.pose = place;
  body.mass = bone.mass;
  body.inertia = bone.inertia;
  body.linear_damping = def.linear_damping;
  body.angular_damping = def.angular_damping;
  return body;
}

JointDef joint_of(const BoneDef& bone, BodyId parent, BodyId body, const Pose& place) {
  const BoneJoint& j = bone.joint;
  const Mat3 frame = to_matrix(place.orientation * joint_frame(j));
  const auto half = [](const Limits& l) { return min(0.5f * (l.high - l.low), kPi); };
  switch (j.kind) {
    case BoneJointKind::hinge:
      return HingeDef{.a = parent,
                      .b = body,
                      .anchor = place.position,
                      .axis = frame.x,
                      .limits = Limits{-half(j.twist), half(j.twist)},
                      .friction = j.friction};
    case BoneJointKind::fixed:
      return FixedDef{.a = parent, .b = body, .anchor = place.position};
    case BoneJointKind::cone:
    case BoneJointKind::ball:
      break;
  }
  ConeDef cone{.a = parent, .b = body, .anchor = place.position, .axis = frame.x, .axis_b = frame.z};
  cone.friction = j.friction;
  if (j.kind == BoneJointKind::cone) {
    cone.limits = Limits{-half(j.twist), half(j.twist)};
    cone.swing_y = half(j.swing_y);
    cone.swing_z = half(j.swing_z);
  }
  return cone;
}

// Finds the pairs that overlap in the rest pose, by queries in a world of their own.
std::vector<RagdollDef::Pair> rest_overlaps(const RagdollDef& def) {
  std::vector<RagdollDef::Pair> pairs;
  Result<World> made = World::create({});
  if (!made) return pairs;
  World& world = *made;
  const RagdollPose rest = rest_pose(def);
  std::vector<Overlap> found(16 * def.bones.size());
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    const Pose pose{DVec3(rest.bones[i].position), rest.bones[i].orientation};
    for (const ShapeDef& shape : def.bones[i].shapes) {
      const std::size_t count = world.overlap_all({shape.geometry, pose * shape.local}, found);
      for (std::size_t k = 0; k < min(count, found.size()); ++k)
        pairs.push_back({int(world.user_data(found[k].body)), int(i)});
    }
    world.add_body({.type = BodyType::fixed, .pose = pose, .user_data = i}, def.bones[i].shapes);
  }
  return pairs;
}

// False for shapes of one negative group, which never collide.
bool may_touch(const BoneDef& a, const BoneDef& b) {
  for (const ShapeDef& of_a : a.shapes) {
    for (const ShapeDef& of_b : b.shapes) {
      if (of_a.filter.group != of_b.filter.group || of_a.filter.group >= 0) return true;
    }
  }
  return false;
}

// Lists the pairs that shall not collide and that no joint keeps from it.
std::vector<RagdollDef::Pair> pairs_apart(const RagdollDef& def) {
  std::vector<RagdollDef::Pair> all = def.filtered_pairs, kept;
  if (def.skip_rest_overlaps) {
    const std::vector<RagdollDef::Pair> overlaps = rest_overlaps(def);
    all.insert(all.end(), overlaps.begin(), overlaps.end());
  }
  const int count = int(def.bones.size());
  for (int b = 0; b < count && def.neighbours > 1; ++b) {
    for (int a = 0; a < b; ++a) {
      if (joints_between(def, a, b) <= def.neighbours) all.push_back({a, b});
    }
  }
  std::vector<bool> seen(std::size_t(count) * std::size_t(count), false);
  for (const RagdollDef::Pair& p : all) {
    const int a = min(p.a, p.b), b = max(p.a, p.b);
    const std::size_t at = std::size_t(a) * std::size_t(count) + std::size_t(b);
    const BoneDef& bone = def.bones[std::size_t(b)];
    if (a == b || seen[at] || bone.parent == a) continue;
    seen[at] = true;
    if (may_touch(def.bones[std::size_t(a)], bone)) kept.push_back({a, b});
  }
  return kept;
}

// Computes for each joint the inertia of all bones that hang on it, over the effective inertia of its two bodies: about a hinge's axis,
// else as the mean of all directions.
void find_motor_shares(const RagdollDef& def, Ragdoll& ragdoll) {
  const RagdollPose rest = rest_pose(def);
  const std::size_t count = def.bones.size();
  std::vector<MassProperties> mass(count), hanging;
  for (std::size_t i = 0; i < count; ++i) mass[i] = bone_mass(def.bones[i]);
  std::vector<bool> hangs(count);
  for (std::size_t i = 1; i < count; ++i) {
    const BoneDef& bone = def.bones[i];
    hanging.clear();
    hangs.assign(count, false);
    for (std::size_t k = i; k < count; ++k) {
      hangs[k] = k == i || (def.bones[k].parent >= 0 && hangs[std::size_t(def.bones[k].parent)]);
      if (hangs[k]) hanging.push_back(transformed(mass[k], inverse_times(rest.bones[i], rest.bones[k])));
    }
    const MassProperties all = combined(hanging);
    const auto& parent = mass[std::size_t(bone.parent)];
    const Sym3 of_parent =
        transformed(parent, inverse_times(rest.bones[i], rest.bones[std::size_t(bone.parent)])).inertia;
    const Sym3 pair = inverse(inverse(of_parent) + inverse(mass[i].inertia));  // about their own centres
    const Vec3 axis = normalized(bone.joint.axis), c = all.center;
    const auto about = [&](const Sym3& s) { return dot(axis, s * axis); };
    const float trace = all.inertia.xx + all.inertia.yy + all.inertia.zz + 2.0f * all.mass * dot(c, c);
    const bool hinge = bone.joint.kind == BoneJointKind::hinge;
    const float whole = hinge ? about(all.inertia) + all.mass * (dot(c, c) - square(dot(axis, c))) : trace;
    const auto of = [&](const Sym3& s) { return hinge ? 1.0f / about(inverse(s)) : s.xx + s.yy + s.zz; };
    ragdoll.bones[i].motor_share = whole / of(pair);
    ragdoll.bones[i].motor_share_held = whole / of(mass[i].inertia);
  }
}

}  // namespace

MassProperties bone_mass(const BoneDef& bone) {
  std::vector<MassProperties> parts;
  for (const ShapeDef& shape : bone.shapes) {
    if (!(shape.density > 0.0f)) continue;
    if (const Result<MassProperties> part = mass_properties(shape.geometry, shape.density))
      parts.push_back(transformed(*part, shape.local));
  }
  MassProperties all = combined(parts);
  if (bone.mass) {
    if (all.mass > 0.0f) all.inertia = (*bone.mass / all.mass) * all.inertia;
    all.mass = *bone.mass;
  }
  if (bone.inertia) all.inertia = *bone.inertia;
  return all;
}

Error check_ragdoll(const RagdollDef& def) {
  const std::size_t count = def.bones.size();
  if (count < 1 || count > std::size_t(RagdollDef::kMaxBones))
    return refuse("ragdoll: it has %d bones; 1 to %d are allowed", int(count), RagdollDef::kMaxBones);
  for (std::size_t i = 0; i < count; ++i) {
    const Error e = check_bone(def, i);
    if (e) return e;
  }
  if (def.neighbours < 1) return refuse("ragdoll: neighbours is %d; it must be at least 1", def.neighbours);
  for (const RagdollDef::Pair& p : def.filtered_pairs) {
    if (p.a < 0 || p.b < 0 || std::size_t(p.a) >= count || std::size_t(p.b) >= count || p.a == p.b)
      return refuse("ragdoll: filtered_pairs holds the pair %d, %d; both must be bones, and not the same", p.a, p.b);
  }
  if (!(def.linear_damping >= 0.0f && def.angular_damping >= 0.0f) ||
      !is_finite(def.linear_damping + def.angular_damping))
    return refuse("ragdoll: its dampings must be 0 or more; they are %g and %g", double(def.linear_damping),
                  double(def.angular_damping));
  return {};
}

Result<Ragdoll> add_ragdoll(World& world, const RagdollDef& def, const RagdollPose& start) {
  if (const Error e = check_ragdoll(def)) return e;
  const std::size_t count = def.bones.size();
  if (start.bones.size() != count || !is_finite(start.world_from_model))
    return refuse("ragdoll: its start has %d bones, the definition %d; and its place must be finite",
                  int(start.bones.size()), int(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_finite(start.bones[i].position) || !is_unit(start.bones[i].orientation))
      return refuse("ragdoll: the start of bone '%s' must be finite, its orientation of length 1",
                    def.bones[i].name.c_str());
  }
  Ragdoll ragdoll;
  ragdoll.bones.resize(count);
  const RagdollPose middle = middle_pose(def, start.world_from_model);
  const auto place = [&](std::size_t i) { return middle.world_from_model * middle.bones[i]; };
  for (std::size_t i = 0; i < count; ++i) {
    const BoneDef& bone = def.bones[i];
    RagdollBone& b = ragdoll.bones[i];
    b.body = world.add_body(body_of(def, bone, place(i)), bone.shapes);
    if (b.body && bone.parent >= 0)
      b.joint =
          world.add_joint(joint_of(bone, ragdoll.bones[std::size_t(bone.parent)].body, b.body, place(i)));
    if (b.body && (bone.parent < 0 || b.joint)) continue;
    const Error why = refuse("ragdoll: bone '%s' was refused: %s", bone.name.c_str(),
                             world.problems().empty() ? "" : world.problems().back().message);
    remove_ragdoll(world, ragdoll);
    return why;
  }
  for (const RagdollDef::Pair& p : pairs_apart(def)) {
    // This joint only keeps the two bones from colliding.
    const BallDef joint{.a = ragdoll.bones[std::size_t(p.a)].body,
                        .b = ragdoll.bones[std::size_t(p.b)].body,
                        .anchor = place(std::size_t(p.b)).position};
    world.set_joint_enabled(world.add_joint(joint), false);
  }
  find_motor_shares(def, ragdoll);
  std::vector<Pose> at(count);
  for (std::size_t i = 0; i < count; ++i) {
    at[i] = start.world_from_model * start.bones[i];
    at[i].orientation = normalized(at[i].orientation);
    const int parent = def.bones[i].parent;
    if (parent >= 0) at[i].position = at[std::size_t(parent)] * def.bones[i].rest.position;
    world.set_pose(ragdoll.bones[i].body, at[i]);
    ragdoll.bones[i].target = ragdoll.bones[i].previous_target = at[i];
  }
  return ragdoll;
}

void remove_ragdoll(World& world, Ragdoll& ragdoll) {
  for (const RagdollBone& bone : ragdoll.bones) {
    if (world.exists(bone.body)) world.remove_body(bone.body);
  }
  ragdoll = {};
}

RagdollPose read_ragdoll(const World& world, const RagdollDef& def, const Ragdoll& ragdoll) {
  RagdollPose pose;
  if (ragdoll.bones.size() != def.bones.size() || def.bones.empty()) return pose;
  pose.world_from_model = world.pose(ragdoll.bones[0].body) * inverse(def.bones[0].rest);
  pose.world_from_model.orientation = normalized(pose.world_from_model.orientation);
  pose.bones.reserve(def.bones.size());
  for (const RagdollBone& bone : ragdoll.bones) {
    pose.bones.push_back(inverse_times(pose.world_from_model, world.pose(bone.body)));
    pose.bones.back().orientation = normalized(pose.bones.back().orientation);
  }
  return pose;
}

}  // namespace gyre::kit
