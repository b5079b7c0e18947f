/* Creates a world with a floor and lets a box fall on it. With the path of a scene, runs that for a second, too.

   cc -std=c11 falling_box.c $(pkg-config --cflags --libs gyre-c) -o falling_box */
#include <gyre/c/gyre.h>

#include <inttypes.h>
#include <stdio.h>

static int run_scene(const char* path) {
  GyreScene* scene = gyre_scene_load(path, 1, 0);
  if (scene == NULL) {
    fprintf(stderr, "%s\n", gyre_last_error());
    return 1;
  }
  const int steps = (int)(1.0 / gyre_scene_time_step(scene) + 0.5);
  for (int i = 0; i < steps; ++i) gyre_scene_step(scene);
  printf("%s after 1 s: %016" PRIx64 "\n", gyre_scene_name(scene), gyre_world_hash(gyre_scene_world(scene)));
  gyre_scene_destroy(scene);
  return 0;
}

int main(int count, char** arguments) {
  GyreWorld* world = gyre_world_create(NULL);
  if (world == NULL) {
    fprintf(stderr, "%s\n", gyre_last_error());
    return 1;
  }

  GyreBodyDef ground = gyre_body_def_default();
  ground.type = GYRE_BODY_TYPE_FIXED;
  GyreShapeDef floor = gyre_shape_def_default();
  floor.geometry.kind = GYRE_SHAPE_KIND_PLANE;
  floor.geometry.as.plane = gyre_plane_default();
  gyre_world_add_body(world, &ground, &floor, 1);

  GyreBodyDef body = gyre_body_def_default();
  body.pose.position.y = 5.0;
  GyreShapeDef shape = gyre_shape_def_default();
  shape.geometry.kind = GYRE_SHAPE_KIND_BOX;
  shape.geometry.as.box = gyre_box_default();
  const GyreBodyId box = gyre_world_add_body(world, &body, &shape, 1);

  for (int i = 0; i < 120; ++i) gyre_world_step(world, 1.0f / 60.0f);
  const GyrePose pose = gyre_world_pose(world, box);
  printf("the box rests at a height of %.2f m\n", pose.position.y);
  gyre_world_destroy(world);

  if (!(pose.position.y > 0.49 && pose.position.y < 0.51)) return 1;
  return count > 1 ? run_scene(arguments[1]) : 0;
}
