// A person stands by the motors of the joints, is hit, goes limp, falls and comes to rest.
#include <gyre/gyre.h>
#include <gyre/kit/ragdoll.h>

#include <cstdio>

using namespace gyre;

int main() {
  World world = *World::create({});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});

  const kit::RagdollDef person = *kit::stabilized(kit::make_humanoid(1.75f, 70.0f));
  const kit::RagdollPose standing = kit::rest_pose(person);
  kit::Ragdoll ragdoll = *kit::add_ragdoll(world, person, standing);

  const float step = 1.0f / 60.0f;
  const BodyId chest = ragdoll.bones[std::size_t(kit::find_bone(person, "chest"))].body;
  for (int i = 0; i < 600; ++i) {
    kit::BoneDrive drive;
    if (i < 60) drive.key = {.strength = 1, .frequency = 4};  // keyed to the pose
    if (i < 120) drive.motor.strength = 1;                    // then motors alone, from 2 s no drive
    if (i == 60) world.add_impulse(chest, {0, 0, -60});
    if (const Error e = kit::drive_ragdoll(world, person, ragdoll, standing, {&drive, 1}, step);
        e.code != ErrorCode::none) {
      std::printf("%s\n", e.message);
      return 1;
    }
    world.step(step);
    if (i % 60 != 59) continue;
    const kit::RagdollPose now = kit::read_ragdoll(world, person, ragdoll);
    float beyond = 0;
    for (int bone = 0; bone < int(person.bones.size()); ++bone)
      beyond = max(beyond, kit::beyond_limits(person, now, bone));
    std::printf(
        "%2.0f s  chest at %.2f m  knee bent by %3.0f degrees  %.1f degrees beyond limits  %d bodies awake\n",
        world.time(), world.pose(chest).position.y,
        double(57.2958f * kit::bone_turn(person, now, kit::find_bone(person, "left shank")).x),
        double(57.2958f * beyond), world.counts().awake_bodies);
  }
  return world.pose(chest).position.y < 0.5 && world.counts().awake_bodies == 0 ? 0 : 1;
}
