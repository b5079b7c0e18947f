/* Loads a scene, a robot in URDF, one in MJCF and a glTF file; each has the hash that libgyre gives to its scene file. The folder of the
   scenes is the argument. */
#include <gyre/c/load.h>

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static int failed = 0;

static void expect(bool holds, const char* what, const char* file) {
  if (holds) return;
  fprintf(stderr, "%s: %s (%s)\n", file, what, gyre_load_error());
  failed = 1;
}

static uint64_t hash_after_a_second(GyreScene* scene) {
  for (int i = 0; i < 60; ++i) gyre_scene_step(scene);
  return gyre_world_hash(gyre_scene_world(scene));
}

static void check_file(const char* folder, const char* file) {
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", folder, file);
  GyreLoadOptions options = gyre_load_options_default();
  options.free_base = true;
  GyreScene* const scene = gyre_load_scene(path, &options, 1, 0);
  expect(scene != NULL, "is not loaded", file);
  if (scene == NULL) return;
  size_t bodies = 0, count = 0;
  gyre_scene_bodies(scene, &bodies);
  expect(bodies > 0, "has no body", file);
  const char* const text = gyre_load_text(path, &options, &count);
  expect(text != NULL && strlen(text) == count, "has no text of a scene", file);
  GyreScene* const again = text != NULL ? gyre_scene_read(text, count, 1, 0) : NULL;
  expect(again != NULL && hash_after_a_second(scene) == hash_after_a_second(again), "moves unlike its scene file", file);
  gyre_scene_destroy(again);
  gyre_scene_destroy(scene);
}

int main(int argument_count, char** arguments) {
  if (argument_count < 3) return 2;
  const char* const folder = arguments[1];
  check_file(folder, "newtons_cradle.gyre.json");
  check_file(folder, "formats/playground.gltf");
  if (strcmp(arguments[2], "xml") == 0) {
    check_file(folder, "formats/pendulum.urdf");
    check_file(folder, "formats/hopper.xml");
  }

  expect(gyre_load_scene("no/such/robot.urdf", NULL, 1, 0) == NULL, "was loaded", "no/such/robot.urdf");
  expect(strstr(gyre_load_error(), "robot.urdf") != NULL, "the error does not name the file", "no/such/robot.urdf");
  expect(gyre_load_scene(NULL, NULL, 1, 0) == NULL && gyre_load_error()[0] != '\0', "a missing path is not refused", "NULL");
  GyreLoadOptions cleared;
  memset(&cleared, 0, sizeof cleared);
  expect(gyre_load_text("any.gltf", &cleared, NULL) == NULL && strstr(gyre_load_error(), "size is 0") != NULL,
         "cleared options are not refused", "any.gltf");
  return failed;
}
