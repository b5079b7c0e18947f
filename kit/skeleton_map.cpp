// Maps ragdoll poses to skeletons in one pass from the root. Joints with a bone follow the bone, others follow their parent by their local
// pose. A chain of joints between two bones is fitted to its end once the pass reaches the lower bone.
#include <gyre/kit/skeleton_map.h>

namespace gyre::kit {

namespace {

template <class... Values>
Error refuse(const char* format, Values... values) {
  return make_error(ErrorCode::invalid_argument, format, values...);
}

Error check_skeleton(const Skeleton& skeleton) {
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const SkeletonJoint& joint = skeleton.joints[i];
    if (joint.parent < -1 || joint.parent >= int(i))
      return refuse("skeleton: joint '%s' (%d) has parent %d; parents stand before their children",
                    joint.name.c_str(), int(i), joint.parent);
    const Quat q = joint.rest.orientation;
    if (!is_finite(joint.rest) || !(absolute(dot(q, q) - 1.0f) < 1.0e-3f))
      return refuse("skeleton: the rest pose of joint '%s' must be finite, its orientation of length 1",
                    joint.name.c_str());
  }
  return {};
}

Error pair_up(const RagdollDef& def, const Skeleton& skeleton, std::span<const MappedBone> pairs,
              std::vector<int>& joint_of_bone) {
  const int bones = int(def.bones.size()), joints = int(skeleton.joints.size());
  joint_of_bone.assign(def.bones.size(), -1);
  for (const MappedBone& pair : pairs) {
    if (pair.bone < 0 || pair.bone >= bones || pair.joint < 0 || pair.joint >= joints)
      return refuse("skeleton map: the pair of bone %d and joint %d; there are %d bones and %d joints",
                    pair.bone, pair.joint, bones, joints);
    if (joint_of_bone[std::size_t(pair.bone)] >= 0)
      return refuse("skeleton map: bone '%s' is in two pairs",
                    def.bones[std::size_t(pair.bone)].name.c_str());
    joint_of_bone[std::size_t(pair.bone)] = pair.joint;
  }
  for (int bone = 0; bone < bones; ++bone) {
    int& joint = joint_of_bone[std::size_t(bone)];
    const std::string_view name = def.bones[std::size_t(bone)].name;
    for (int i = 0; i < joints && pairs.empty() && joint < 0; ++i) {
      if (std::string_view(skeleton.joints[std::size_t(i)].name) == name) joint = i;
    }
    if (joint < 0) return refuse("skeleton map: no joint for bone '%s'", name.data());
  }
  return {};
}

// Checks that the next bone above a bone's joint is the bone's parent.
Error check_order(const RagdollDef& def, const Skeleton& skeleton, const SkeletonMap& map) {
  for (std::size_t bone = 0; bone < def.bones.size(); ++bone) {
    int joint = map.joint_of_bone[bone];
    if (map.joints[std::size_t(joint)].bone != int(bone))
      return refuse("skeleton map: joint '%s' goes with two bones",
                    skeleton.joints[std::size_t(joint)].name.c_str());
    do {
      joint = skeleton.joints[std::size_t(joint)].parent;
    } while (joint >= 0 && map.joints[std::size_t(joint)].bone < 0);
    const int above = joint < 0 ? -1 : map.joints[std::size_t(joint)].bone;
    if (above != def.bones[bone].parent)
      return refuse("skeleton map: the next bone above the joint of '%s' is not its parent bone",
                    def.bones[bone].name.c_str());
  }
  return {};
}

// Finds the chains: joints without a bone between a joint with a bone and the next one below.
void find_chains(const Skeleton& skeleton, SkeletonMap& map) {
  for (std::size_t i = 0; i < map.joints.size(); ++i) {
    if (map.joints[i].bone < 0) continue;
    int count = 0, top = -1;
    for (int j = skeleton.joints[i].parent; j >= 0; j = skeleton.joints[std::size_t(j)].parent) {
      const SkeletonMap::Rule& rule = map.joints[std::size_t(j)];
      // If two chains branch, the first has their common joints.
      if (rule.bone >= 0 || rule.end >= 0) {
        top = j;
        break;
      }
      ++count;
    }
    if (top < 0 || map.joints[std::size_t(top)].bone < 0) continue;
    int j = skeleton.joints[i].parent, first = j;
    for (int k = count; k > 0; --k, j = skeleton.joints[std::size_t(j)].parent) {
      map.joints[std::size_t(j)].end = int(i);
      map.joints[std::size_t(j)].share = float(k) / float(count + 1);
      first = j;
    }
    for (int k = skeleton.joints[i].parent; k != top; k = skeleton.joints[std::size_t(k)].parent)
      map.joints[std::size_t(k)].first = first;
  }
}

Transform unit(Transform t) {
  t.orientation = normalized(t.orientation);
  return t;
}

// Fits the joints of a chain, which have the animation's poses, to its end: they shall lead to `wanted` instead of `led`.
void fit_chain(const SkeletonMap& map, int end, int last, const Transform& led, const Transform& wanted,
               std::span<Transform> model) {
  const Vec3 origin = model[std::size_t(map.joints[std::size_t(last)].first)].position;
  const Vec3 from = led.position - origin, to = wanted.position - origin;
  const float way = length(from);
  const bool has_way = way > 1.0e-6f && length(to) > 1.0e-6f;
  const Quat swing = has_way ? from_directions(normalized(from), normalized(to)) : Quat{};
  const float stretch = has_way ? length(to) / way : 1.0f;
  const Vec3 twist = to_rotation_vector(wanted.orientation * conjugate(swing * led.orientation));
  for (int j = last; j >= 0 && map.joints[std::size_t(j)].end == end; j = map.joints[std::size_t(j)].parent) {
    Transform& joint = model[std::size_t(j)];
    joint.position = origin + stretch * rotate(swing, joint.position - origin);
    joint.orientation = normalized(from_rotation_vector(map.joints[std::size_t(j)].share * twist) * swing *
                                   joint.orientation);
  }
}

}  // namespace

Result<SkeletonMap> make_skeleton_map(const RagdollDef& def, const Skeleton& skeleton,
                                      std::span<const MappedBone> pairs) {
  if (const Error e = check_ragdoll(def)) return e;
  if (const Error e = check_skeleton(skeleton)) return e;
  SkeletonMap map;
  if (const Error e = pair_up(def, skeleton, pairs, map.joint_of_bone)) return e;
  const std::size_t count = skeleton.joints.size();
  map.joints.resize(count);
  std::vector<Transform> local(count), model(count);
  for (std::size_t i = 0; i < count; ++i) {
    map.joints[i].parent = skeleton.joints[i].parent;
    local[i] = skeleton.joints[i].rest;
  }
  local_to_model(skeleton, local, model);
  const RagdollPose rest = rest_pose(def);
  for (std::size_t bone = 0; bone < def.bones.size(); ++bone) {
    const std::size_t joint = std::size_t(map.joint_of_bone[bone]);
    map.joints[joint].bone = int(bone);
    map.joint_from_bone.push_back(unit(inverse_times(model[joint], rest.bones[bone])));
  }
  if (const Error e = check_order(def, skeleton, map)) return e;
  find_chains(skeleton, map);
  return map;
}

void local_to_model(const Skeleton& skeleton, std::span<const Transform> local, std::span<Transform> model) {
  for (std::size_t i = 0; i < skeleton.joints.size() && i < local.size() && i < model.size(); ++i) {
    const int parent = skeleton.joints[i].parent;
    model[i] = parent < 0 ? local[i] : unit(model[std::size_t(parent)] * local[i]);
  }
}

void model_to_local(const Skeleton& skeleton, std::span<const Transform> model, std::span<Transform> local) {
  for (std::size_t i = 0; i < skeleton.joints.size() && i < local.size() && i < model.size(); ++i) {
    const int parent = skeleton.joints[i].parent;
    local[i] = parent < 0 ? model[i] : unit(inverse_times(model[std::size_t(parent)], model[i]));
  }
}

bool ragdoll_from_skeleton(const SkeletonMap& map, std::span<const Transform> model,
                           std::span<Transform> bones) {
  if (model.size() != map.joints.size() || bones.size() != map.joint_of_bone.size()) return false;
  for (std::size_t bone = 0; bone < bones.size(); ++bone)
    bones[bone] = unit(model[std::size_t(map.joint_of_bone[bone])] * map.joint_from_bone[bone]);
  return true;
}

bool skeleton_from_ragdoll(const SkeletonMap& map, std::span<const Transform> bones,
                           std::span<const Transform> local, std::span<Transform> model) {
  const std::size_t count = map.joints.size();
  if (local.size() != count || model.size() != count || bones.size() != map.joint_of_bone.size())
    return false;
  for (std::size_t i = 0; i < count; ++i) {
    const SkeletonMap::Rule& rule = map.joints[i];
    const Transform led = rule.parent < 0 ? local[i] : unit(model[std::size_t(rule.parent)] * local[i]);
    model[i] = led;
    if (rule.bone < 0) continue;
    const std::size_t bone = std::size_t(rule.bone);
    model[i] = unit(bones[bone] * inverse(map.joint_from_bone[bone]));
    if (rule.parent >= 0 && map.joints[std::size_t(rule.parent)].end == int(i))
      fit_chain(map, int(i), rule.parent, led, model[i], model);
  }
  // Joints below a chain were placed before it was fitted, and are placed again.
  for (std::size_t i = 0; i < count; ++i) {
    const SkeletonMap::Rule& rule = map.joints[i];
    if (rule.bone < 0 && rule.end < 0 && rule.parent >= 0)
      model[i] = unit(model[std::size_t(rule.parent)] * local[i]);
  }
  return true;
}

}  // namespace gyre::kit
