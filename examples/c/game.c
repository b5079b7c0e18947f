/* A small game without pictures, in C: a player who walks up stairs, a lift, a crate on the mouse, a trigger, a car on hills, a bridge.

   Every step is played twice, as in a networked game: first with a guess of the player's input, then, eight steps later, rolled back and
   played again with the true input. The end has the bits of a game that knew all input in time. */
#include <gyre/c/gyre.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define STEP (1.0f / 60.0f)
#define WINDOW 8
#define STEPS 200

typedef struct Game {
  GyreWorld* world;
  GyreBodyId player, lift, crate, car;
  GyreJointId mouse;
  int entered;
} Game;

static void must(bool done) {
  if (done) return;
  fprintf(stderr, "%s\n", gyre_last_error());
  exit(1);
}

static GyreShapeDef box_shape(float x, float y, float z) {
  GyreShapeDef shape = gyre_shape_def_default();
  shape.geometry.kind = GYRE_SHAPE_KIND_BOX;
  shape.geometry.as.box = gyre_box_default();
  shape.geometry.as.box.half_extents = (GyreVec3){x, y, z};
  return shape;
}
static GyreShapeDef ball_shape(float radius) {
  GyreShapeDef shape = gyre_shape_def_default();
  shape.geometry.kind = GYRE_SHAPE_KIND_SPHERE;
  shape.geometry.as.sphere.radius = radius;
  return shape;
}

static GyreBodyId add_body(Game* game, GyreBodyType type, GyreDVec3 place, const GyreShapeDef* shape) {
  GyreBodyDef body = gyre_body_def_default();
  body.type = type;
  body.pose.position = place;
  const GyreBodyId id = gyre_world_add_body(game->world, &body, shape, 1);
  must(!GYRE_IS_NULL(id));
  return id;
}

static void add_player(Game* game) {
  GyreBodyDef body = gyre_body_def_default();
  body.pose.position.y = 0.9;
  body.can_sleep = false;
  body.has_mass = true;
  body.mass = 80.0f;
  for (int i = 0; i < 3; ++i) body.locked.angular[i] = true;
  GyreShapeDef shape = gyre_shape_def_default();
  shape.geometry.kind = GYRE_SHAPE_KIND_CAPSULE;
  shape.geometry.as.capsule = (GyreCapsule){0.3f, 0.6f};
  shape.material.static_friction = shape.material.dynamic_friction = 0.0f;
  game->player = gyre_world_add_body(game->world, &body, &shape, 1);
  must(!GYRE_IS_NULL(game->player));
}

/* Planks on hinges, with a load; a hinge breaks at 50 kN. */
static void add_bridge(Game* game, GyreDVec3 start, int planks) {
  GyreShapeDef shape = box_shape(0.24f, 0.05f, 0.8f);
  shape.density = 600.0f;
  GyreBodyId before = {0, 0, 0};
  for (int i = 0; i <= planks; ++i) {
    GyreBodyId plank = {0, 0, 0};
    if (i < planks)
      plank = add_body(game, GYRE_BODY_TYPE_DYNAMIC, (GyreDVec3){start.x + 0.5 * i + 0.25, start.y, start.z},
                       &shape);
    GyreHingeDef hinge = gyre_hinge_def_default();
    hinge.a = before;
    hinge.b = plank;
    hinge.anchor = (GyreDVec3){start.x + 0.5 * i, start.y, start.z};
    hinge.axis = (GyreVec3){0, 0, 1};
    hinge.has_break_force = true;
    hinge.break_force = 5.0e4f;
    must(!GYRE_IS_NULL(gyre_world_add_hinge_joint(game->world, &hinge)));
    before = plank;
  }
  const GyreShapeDef load = ball_shape(0.4f);
  add_body(game, GYRE_BODY_TYPE_DYNAMIC, (GyreDVec3){start.x + 2.5, start.y + 1.0, start.z}, &load);
}

/* Four driven wheels on springs, on hills. */
static void add_car(Game* game, GyreDVec3 at) {
  static float heights[20 * 40];
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 40; ++column)
      heights[row * 40 + column] = 0.25f * sinf(0.7f * (float)column) * cosf(0.5f * (float)row);
  }
  GyreHeightFieldDef field = gyre_height_field_def_default();
  field.heights = heights;
  field.heights_count = 20 * 40;
  field.columns = 40;
  field.rows = 20;
  GyreShapeDef hills = gyre_shape_def_default();
  hills.geometry.kind = GYRE_SHAPE_KIND_HEIGHT_FIELD;
  hills.geometry.as.geometry = gyre_cook_height_field(&field);
  must(hills.geometry.as.geometry != NULL);
  add_body(game, GYRE_BODY_TYPE_FIXED, (GyreDVec3){at.x + 10, 0.3, at.z}, &hills);
  gyre_geometry_destroy(hills.geometry.as.geometry); /* the world keeps the data */

  GyreShapeDef chassis = box_shape(1.2f, 0.25f, 0.6f);
  chassis.density = 400.0f;
  game->car = add_body(game, GYRE_BODY_TYPE_DYNAMIC, at, &chassis);
  GyreShapeDef tyre = ball_shape(0.35f);
  tyre.density = 300.0f;
  tyre.material.static_friction = 1.2f;
  tyre.material.dynamic_friction = 1.0f;
  for (int i = 0; i < 4; ++i) {
    const GyreDVec3 place = {at.x + (i < 2 ? -0.9 : 0.9), at.y - 0.3, at.z + (i % 2 == 0 ? -0.8 : 0.8)};
    GyreWheelDef wheel = gyre_wheel_def_default();
    wheel.a = game->car;
    wheel.b = add_body(game, GYRE_BODY_TYPE_DYNAMIC, place, &tyre);
    wheel.anchor = place;
    wheel.axis = (GyreVec3){0, 1, 0};
    wheel.has_axis_b = true;
    wheel.axis_b = (GyreVec3){0, 0, 1};
    wheel.stiffness = 3.0e4f;
    wheel.damping = 2.0e3f;
    wheel.has_limits = true;
    wheel.limits = (GyreLimits){-0.15f, 0.15f};
    wheel.motor.target_velocity = -10.0f;
    wheel.motor.max_force = 150.0f;
    must(!GYRE_IS_NULL(gyre_world_add_wheel_joint(game->world, &wheel)));
  }
}

static Game make_game(void) {
  Game game = {.world = gyre_world_create(NULL)};
  must(game.world != NULL);
  GyreShapeDef ground = gyre_shape_def_default();
  ground.geometry.kind = GYRE_SHAPE_KIND_PLANE;
  ground.geometry.as.plane = gyre_plane_default();
  add_body(&game, GYRE_BODY_TYPE_FIXED, (GyreDVec3){0, 0, 0}, &ground);
  for (int i = 0; i < 6; ++i) { /* stairs of 20 cm */
    const GyreShapeDef stair = box_shape(0.2f, 0.1f * (float)(i + 1), 1.0f);
    add_body(&game, GYRE_BODY_TYPE_FIXED, (GyreDVec3){3 + 0.4 * i, 0.1 * (i + 1), 0}, &stair);
  }
  add_player(&game);
  const GyreShapeDef plate = box_shape(1.0f, 0.1f, 1.0f), rider = box_shape(0.3f, 0.5f, 0.3f),
                     crate = box_shape(0.5f, 0.5f, 0.5f);
  game.lift = add_body(&game, GYRE_BODY_TYPE_KINEMATIC, (GyreDVec3){-3, 0.1, 3}, &plate);
  add_body(&game, GYRE_BODY_TYPE_DYNAMIC, (GyreDVec3){-3, 0.7, 3}, &rider);
  game.crate = add_body(&game, GYRE_BODY_TYPE_DYNAMIC, (GyreDVec3){0, 0.5, 4}, &crate);
  GyreMouseDef mouse = gyre_mouse_def_default();
  mouse.b = game.crate;
  mouse.anchor = (GyreDVec3){0, 1, 4};
  mouse.drive.frequency = 2.0f;
  mouse.drive.max_force = 3.0e4f;
  game.mouse = gyre_world_add_mouse_joint(game.world, &mouse);
  must(!GYRE_IS_NULL(game.mouse));
  GyreShapeDef trigger = box_shape(0.3f, 1.0f, 1.0f);
  trigger.sensor = true;
  add_body(&game, GYRE_BODY_TYPE_FIXED, (GyreDVec3){2.2, 1, 0}, &trigger);
  add_bridge(&game, (GyreDVec3){-10, 3, 0}, 10);
  add_car(&game, (GyreDVec3){0, 1.2, -20});
  return game;
}

/* One step; `walk` is the player's speed along x, m/s. */
static void step_game(Game* game, float walk) {
  GyreWorld* world = game->world;
  const GyreDVec3 place = gyre_world_pose(world, game->player).position;
  const GyreVec3 velocity = gyre_world_linear_velocity(world, game->player);
  float up = velocity.y;
  if (walk != 0.0f) {
    /* A ray in front of the feet finds the next stair; where there is one, the player steps up. */
    GyreQueryFilter filter = gyre_query_filter_default();
    filter.ignored = game->player;
    GyreCastHit hit;
    const GyreDVec3 from = {place.x + (walk > 0.0f ? 0.45 : -0.45), place.y, place.z};
    if (gyre_world_cast_ray(world, from, (GyreVec3){0, -1.2f, 0}, &filter, &hit)) {
      const double rise = hit.point.y - (place.y - 0.9);
      if (rise > 0.02 && rise < 0.3) up = 2.2f;
    }
  }
  gyre_world_set_velocity(world, game->player, (GyreVec3){walk, up, 0}, (GyreVec3){0, 0, 0});

  const double time = (double)gyre_world_step_count(world) * STEP;
  GyrePose lifted = gyre_pose_default();
  lifted.position = (GyreDVec3){-3, 1.1 - cos(time), 3};
  gyre_world_move_kinematic(world, game->lift, lifted, STEP);
  GyrePoseDrive drive = gyre_pose_drive_default();
  drive.position = (GyreVec3){(float)sin(time), 1.0f + 0.5f * (float)sin(2.0 * time), 0};
  drive.frequency = 2.0f;
  drive.max_force = 3.0e4f;
  must(gyre_world_set_drive(world, game->mouse, &drive));
  must(gyre_world_step(world, STEP));

  const GyreEvents events = gyre_world_events(world);
  for (size_t i = 0; i < events.sensors_count; ++i) game->entered += events.sensors[i].begins;
}

/* The player waits, walks, and turns round for a moment. */
static float true_input(int step) { return step < 20 ? 0.0f : step >= 60 && step < 70 ? -1.5f : 1.5f; }

static Game play_informed(void) {
  Game game = make_game();
  for (int step = 0; step < STEPS; ++step) step_game(&game, true_input(step));
  return game;
}

/* Each input is known only WINDOW steps after it was needed; until then the last known one is the guess. */
static Game play_late(void) {
  Game game = make_game();
  GyreRollback* ring = gyre_rollback_create(WINDOW + 2);
  int entered[STEPS];
  for (int step = 0; step < STEPS; ++step) {
    const int known = step > WINDOW ? step - WINDOW : 0;
    gyre_rollback_save(ring, game.world);
    entered[step] = game.entered;
    step_game(&game, true_input(known));
    const bool wrong = known > 0 && true_input(known) != true_input(known - 1);
    if (!wrong && step != STEPS - 1) continue;
    must(gyre_rollback_restore(ring, game.world, (uint64_t)known));
    game.entered = entered[known];
    for (int again = known; again <= step; ++again) {
      gyre_rollback_save(ring, game.world);
      entered[again] = game.entered;
      step_game(&game, true_input(again));
    }
  }
  gyre_rollback_destroy(ring);
  return game;
}

/* Where a picture between two steps shows a body. */
static GyreDVec3 between(GyreDVec3 before, GyreDVec3 after, double share) {
  return (GyreDVec3){before.x + share * (after.x - before.x), before.y + share * (after.y - before.y),
                     before.z + share * (after.z - before.z)};
}

int main(void) {
  Game informed = play_informed(), late = play_late();
  const uint64_t hash = gyre_world_hash(informed.world), late_hash = gyre_world_hash(late.world);
  printf("informed %016" PRIx64 "\nlate     %016" PRIx64 ", rolled back\n", hash, late_hash);
  const GyreDVec3 player = gyre_world_pose(informed.world, informed.player).position;
  const GyreDVec3 car = gyre_world_pose(informed.world, informed.car).position;
  printf(
      "the player stands at (%.2f, %.2f, %.2f), the trigger saw %d visitor(s), the car drove to x = %.1f m\n",
      player.x, player.y, player.z, informed.entered, car.x);
  step_game(&informed, 1.5f);
  const GyreDVec3 shown = between(player, gyre_world_pose(informed.world, informed.player).position, 0.25);
  printf("a picture a quarter of a step later shows the player at x = %.3f m\n", shown.x);

  const bool right = hash == late_hash && player.y > 1.5 && informed.entered >= 1 &&
                     informed.entered == late.entered && car.x > 2.0;
  gyre_world_destroy(informed.world);
  gyre_world_destroy(late.world);
  return right ? 0 : 1;
}
