// Writes a scene file of people who fall down stairs. It shows how ragdolls of the kit become bodies and joints of a scene.
//
//   ragdoll_scene [COUNT] > FILE.gyre.json
#include <gyre/gyre.h>
#include <gyre/kit/ragdoll.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace gyre;

namespace {

constexpr int kStairs = 16;
constexpr double kRise = 0.18, kRun = 0.28, kHalfWidth = 2.6, kTop = kStairs * kRise;
const char* const kColors[] = {"#b9674c", "#cf9a62", "#8d99a8", "#6f7b8b", "#9db98b", "#c67d5c"};

// Rounded to a hundredth of a millimetre, and never -0.
double rounded(double v) { return std::round(v * 1e5) / 1e5 + 0.0; }

void write(const char* key, DVec3 v) {
  std::printf("\"%s\": [%g, %g, %g]", key, rounded(v.x), rounded(v.y), rounded(v.z));
}
void write(const char* key, Vec3 v) { write(key, DVec3(v)); }
void write(const char* key, Quat q) {
  std::printf("\"%s\": [%.7g, %.7g, %.7g, %.7g]", key, double(q.x), double(q.y), double(q.z), double(q.w));
}
void write(const char* key, const Limits& limits) {
  const double half = 0.5 * double(limits.high - limits.low);
  std::printf("\"%s\": [%g, %g]", key, -rounded(half), rounded(half));
}

void write_block(const char* name, DVec3 low, DVec3 high) {
  std::printf("    {\"name\": \"%s\", \"type\": \"static\", \"color\": \"#9aa7a0\", ", name);
  write("position", 0.5 * (low + high));
  std::printf(", \"shapes\": [{\"type\": \"box\", ");
  write("half_extents", 0.5 * (high - low));
  std::printf("}]},\n");
}

void write_stairs() {
  write_block("ground", {-6, -1, -8}, {20, 0, 8});
  write_block("landing", {-4, 0, -kHalfWidth}, {0, kTop, kHalfWidth});
  for (int i = 1; i < kStairs; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "stair %d", i);
    write_block(name, {(i - 1) * kRun, 0, -kHalfWidth}, {i * kRun, kTop - i * kRise, kHalfWidth});
  }
}

void write_shape(const ShapeDef& shape) {
  if (const Capsule* const capsule = std::get_if<Capsule>(&shape.geometry)) {
    std::printf("{\"type\": \"capsule\", \"radius\": %g, \"half_height\": %g",
                rounded(double(capsule->radius)), rounded(double(capsule->half_height)));
  } else if (const Box* const box = std::get_if<Box>(&shape.geometry)) {
    std::printf("{\"type\": \"box\", \"rounding\": %g, ", rounded(double(box->rounding)));
    write("half_extents", box->half_extents);
  }
  std::printf(", ");
  write("position", shape.local.position);
  std::printf(", ");
  write("orientation", shape.local.orientation);
  std::printf("}");
}

void write_bones(const kit::RagdollDef& def, const kit::RagdollPose& pose, int number, bool last) {
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    const kit::BoneDef& bone = def.bones[i];
    const Pose at = pose.world_from_model * pose.bones[i];
    std::printf("    {\"name\": \"%s %d\", \"color\": \"%s\", \"mass\": %.5g, \"angular_damping\": %g, ",
                bone.name.c_str(), number, kColors[std::size_t(number) % std::size(kColors)],
                double(*bone.mass), double(def.angular_damping));
    if (bone.inertia) {
      const Sym3 s = *bone.inertia;
      std::printf("\"inertia\": [%.5g, %.5g, %.5g, %.5g, %.5g, %.5g], ", double(s.xx), double(s.yy),
                  double(s.zz), double(s.xy), double(s.xz), double(s.yz));
    }
    write("position", at.position);
    std::printf(", ");
    write("orientation", at.orientation);
    std::printf(", \"linear_velocity\": [2, 0, 0], \"shapes\": [");
    for (const ShapeDef& shape : bone.shapes) write_shape(shape);
    std::printf("]}%s\n", last && i + 1 == def.bones.size() ? "" : ",");
  }
}

// The zero of a joint in a scene is the initial pose, so every joint of the people starts in the middle of its limits.
void write_joints(const kit::RagdollDef& def, const kit::RagdollPose& pose, int number, bool last) {
  for (std::size_t i = 1; i < def.bones.size(); ++i) {
    const kit::BoneDef& bone = def.bones[i];
    const kit::BoneJoint& joint = bone.joint;
    const Pose at = pose.world_from_model * pose.bones[i];
    const bool cone = joint.kind == kit::BoneJointKind::cone;
    std::printf("    {\"type\": \"%s\", \"a\": \"%s %d\", \"b\": \"%s %d\", ", cone ? "cone" : "hinge",
                def.bones[std::size_t(bone.parent)].name.c_str(), number, bone.name.c_str(), number);
    write("anchor", at.position);
    std::printf(", ");
    write("axis", rotate(at.orientation, joint.axis));
    std::printf(", ");
    if (cone) {
      write("axis_b", rotate(at.orientation, joint.across));
      const auto half = [](const Limits& l) { return rounded(0.5 * double(l.high - l.low)); };
      std::printf(", \"swing\": [%g, %g], ", half(joint.swing_y), half(joint.swing_z));
    }
    write("limits", joint.twist);
    std::printf(", \"friction\": %.4g}%s\n", double(joint.friction),
                last && i + 1 == def.bones.size() ? "" : ",");
  }
}

}  // namespace

int main(int count, char** words) {
  const int people = count > 1 ? std::atoi(words[1]) : 12;
  if (people < 1 || people > 1000) {
    std::fprintf(stderr, "ragdoll_scene: the number of people must be 1 to 1000\n");
    return 2;
  }
  const kit::RagdollDef def = *kit::stabilized(kit::make_humanoid());
  std::vector<kit::RagdollPose> poses;
  for (int i = 0; i < people; ++i) {
    // Two abreast, each pair above the last, each person rotated differently about the pelvis.
    const Quat turn =
        from_axis_angle({0, 1, 0}, 2.4f * float(i)) * from_axis_angle({1, 0, 0}, 0.9f * float(i % 7) - 2.7f);
    const int row = i / 2;
    const Pose pelvis{{-0.8 + 0.8 * (row % 3), kTop + 1.2 + 1.9 * row, i % 2 == 0 ? -1.2 : 1.2}, turn};
    poses.push_back(kit::middle_pose(def, pelvis * Transform{-1.0f * def.bones[0].rest.position, {}}));
  }
  std::printf(
      "{\n  \"gyre_scene\": 1,\n  \"name\": \"people fall down stairs\",\n"
      "  \"view\": {\"eye\": [9, 5.2, 9.5], \"target\": [1.8, 1.6, 0], \"field_of_view\": 0.6},\n  "
      "\"bodies\": [\n");
  write_stairs();
  for (int i = 0; i < people; ++i) write_bones(def, poses[std::size_t(i)], i + 1, i + 1 == people);
  std::printf("  ],\n  \"joints\": [\n");
  for (int i = 0; i < people; ++i) write_joints(def, poses[std::size_t(i)], i + 1, i + 1 == people);
  std::printf("  ]\n}\n");
  return 0;
}
