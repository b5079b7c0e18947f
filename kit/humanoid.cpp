// Defines a person of 16 bones, in a T pose with the palms forward: y up, z forward, x to the left.
//
// Masses and lengths: P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29 (1996), table 4, men
// (73.0 kg, 1.741 m). Limits: C. C. Norkin, D. J. White, "Measurement of Joint Motion", table of the American Academy of Orthopaedic
// Surgeons; each of the two back joints has half of the back's range. Shoulders: docs/ragdolls.md.
#include <gyre/kit/ragdoll.h>

namespace gyre::kit {

namespace {

constexpr float kDegree = kPi / 180.0f;

Limits degrees(float low, float high) { return {low * kDegree, high * kDegree}; }

ShapeDef along(const AnyShape& shape, Vec3 middle, Vec3 y) {
  ShapeDef def;
  def.geometry = shape;
  def.local = {middle, from_directions({0, 1, 0}, y)};
  return def;
}
// Returns a capsule from the bone's origin over a length.
ShapeDef limb(Vec3 direction, float length, float radius) {
  return along(Capsule{radius, 0.5f * length - radius}, 0.5f * length * direction, direction);
}
ShapeDef block(Vec3 half, Vec3 middle, float rounding) {
  return along(Box{half, rounding}, middle, {0, 1, 0});
}

class Builder {
 public:
  Builder(float height, float mass) : size_(height / 1.741f), mass_(mass), strength_(size_ * mass / 73.0f) {}

  int add(const char* name, int parent, Vec3 at, ShapeDef shape, float share, BoneJoint joint = {}) {
    BoneDef bone;
    bone.name = name;
    bone.parent = parent;
    bone.rest.position = size_ * at;
    shape.local.position *= size_;
    scale(shape.geometry);
    bone.shapes = {shape};
    bone.mass = share * mass_;
    // The dry friction of a joint is small beside the torque of its muscles.
    joint.max_torque *= strength_;
    joint.friction = 0.005f * joint.max_torque;
    bone.joint = joint;
    def_.bones.push_back(bone);
    return int(def_.bones.size()) - 1;
  }

  RagdollDef take() { return std::move(def_); }

 private:
  void scale(AnyShape& shape) const {
    if (Capsule* const capsule = std::get_if<Capsule>(&shape)) {
      capsule->radius *= size_;
      capsule->half_height *= size_;
    } else if (Box* const box = std::get_if<Box>(&shape)) {
      box->half_extents *= size_;
      box->rounding *= size_;
    }
  }

  float size_, mass_, strength_;
  RagdollDef def_;
};

BoneJoint cone(Vec3 axis, Vec3 across, Limits twist, Limits swing_y, Limits swing_z, float torque) {
  return {BoneJointKind::cone, axis, across, twist, swing_y, swing_z, 0.0f, torque};
}
BoneJoint hinge(Vec3 axis, Limits turn, float torque) {
  return {BoneJointKind::hinge, axis, {0, 0, 1}, turn, {}, {}, 0.0f, torque};
}

// swing_z bends the arm forward, swing_y to the side.
void add_arm(Builder& b, int chest, float side) {
  const bool left = side > 0.0f;
  const Vec3 out{side, 0, 0}, across{0, -side, 0};
  const auto sided = [&](float low, float high) { return left ? degrees(low, high) : degrees(-high, -low); };
  const int upper = b.add(left ? "left upper arm" : "right upper arm", chest, {0.19f * side, 0.16f, 0},
                          limb(out, 0.2817f, 0.045f), 0.0271f,
                          cone(out, across, sided(-90, 70), degrees(-100, 100), degrees(-55, 145), 80));
  const int fore = b.add(left ? "left forearm" : "right forearm", upper, {0.2817f * side, 0, 0},
                         limb(out, 0.2689f, 0.038f), 0.0162f, hinge(across, degrees(0, 145), 60));
  b.add(left ? "left hand" : "right hand", fore, {0.2689f * side, 0, 0},
        block({0.094f, 0.04f, 0.018f}, {0.094f * side, 0, 0}, 0.015f), 0.0061f,
        cone(out, across, degrees(-80, 80), sided(-30, 20), degrees(-70, 80), 12));
}

void add_leg(Builder& b, int pelvis, float side) {
  const bool left = side > 0.0f;
  const Vec3 down{0, -1, 0}, across{-1, 0, 0};
  const auto sided = [&](float low, float high) { return left ? degrees(low, high) : degrees(-high, -low); };
  const int thigh =
      b.add(left ? "left thigh" : "right thigh", pelvis, {0.085f * side, 0, 0}, limb(down, 0.4222f, 0.07f),
            0.1416f, cone(down, across, degrees(-45, 45), sided(-25, 45), degrees(-25, 120), 200));
  const int shank = b.add(left ? "left shank" : "right shank", thigh, {0, -0.4222f, 0},
                          limb(down, 0.434f, 0.05f), 0.0433f, hinge({1, 0, 0}, degrees(0, 135), 180));
  b.add(left ? "left foot" : "right foot", shank, {0, -0.434f, 0},
        block({0.045f, 0.034f, 0.129f}, {0, -0.034f, 0.07f}, 0.015f), 0.0137f,
        cone(down, across, degrees(-15, 15), sided(-35, 15), degrees(-50, 20), 150));
}

}  // namespace

RagdollDef make_humanoid(float height, float mass) {
  if (!(height >= 0.1f && height <= 10.0f) || !(mass > 0.0f && mass <= 1.0e6f)) return {};
  Builder b(height, mass);
  const Vec3 up{0, 1, 0}, across{1, 0, 0};
  const int pelvis =
      b.add("pelvis", -1, {0, 0.9242f, 0}, block({0.155f, 0.085f, 0.1f}, {0, 0.05f, 0}, 0.05f), 0.1117f);
  const int abdomen =
      b.add("abdomen", pelvis, {0, 0.1457f, 0}, block({0.14f, 0.108f, 0.09f}, {0, 0.108f, 0}, 0.05f), 0.1633f,
            cone(up, across, degrees(-22.5f, 22.5f), degrees(-17.5f, 17.5f), degrees(-12.5f, 40), 250));
  const int chest = b.add(
      "chest", abdomen, {0, 0.2155f, 0}, block({0.165f, 0.121f, 0.105f}, {0, 0.121f, 0}, 0.06f), 0.1596f,
      cone(up, across, degrees(-22.5f, 22.5f), degrees(-17.5f, 17.5f), degrees(-12.5f, 40), 200));
  b.add("head", chest, {0, 0.2421f, 0}, along(Capsule{0.085f, 0.022f}, {0, 0.107f, 0.01f}, up), 0.0694f,
        cone(up, across, degrees(-60, 60), degrees(-45, 45), degrees(-45, 45), 40));
  for (const float side : {1.0f, -1.0f}) add_arm(b, chest, side);
  for (const float side : {1.0f, -1.0f}) add_leg(b, pelvis, side);
  return b.take();
}

}  // namespace gyre::kit
