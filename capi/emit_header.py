"""Writes the C header."""

import re
import textwrap

from c_model import LEFT_OUT, VECTORS, snake

HEAD = """/* The C interface of Gyre, a physics engine. Made by capi/generate.py from the C++ headers; not to be edited.

   Names are those of C++: World::add_body is gyre_world_add_body, BodyDef is GyreBodyDef, BodyType::fixed is GYRE_BODY_TYPE_FIXED. So are
   the comments. SI units.

   Handles. GyreWorld and its like are made by a ..._create, ..._open, cook or load function, which returns NULL if it refuses, and freed by
   ..._destroy. A handle that a getter returns (gyre_replay_world) belongs to the object that it was asked of.

   Definitions. A struct that begins with `size` is a definition. Fill it by its ..._init function, or take ..._default(), then change
   fields. NULL in place of a definition means all defaults. A member `has_x` tells if `x` is given.

   Errors. A refused call changes nothing and returns NULL, false, an id of zeros, or an error code; gyre_last_error() has the reason. No
   function throws.

   Arrays are a pointer and a count. Arrays in answers are valid until the next change or step of the world, and until the thread calls
   the same function again. A function that fills `out` returns how many elements there are, also if they are more than `out_count`.

   docs/c.md is the guide. */
#ifndef GYRE_C_GYRE_H
#define GYRE_C_GYRE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define GYRE_C_API
#else
#define GYRE_C_API __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
#define GYRE_C_NOEXCEPT noexcept
extern "C" {
#else
#define GYRE_C_NOEXCEPT
#endif

"""

BY_HAND = """/* ----------------------------------------------------------------------------------------- errors, versions, memory */

/* Why the last refused call of this thread was refused. Never NULL. */
GYRE_C_API const char* gyre_last_error(void) GYRE_C_NOEXCEPT;
GYRE_C_API GyreErrorCode gyre_last_error_code(void) GYRE_C_NOEXCEPT;
/* The version of the library, as "0.1.0". */
GYRE_C_API const char* gyre_version(void) GYRE_C_NOEXCEPT;
/* True if the id refers to no object. */
#define GYRE_IS_NULL(id) ((id).generation == 0)
#define GYRE_SAME_ID(left, right) \\
  ((left).index == (right).index && (left).generation == (right).generation && (left).world == (right).world)

/* ------------------------------------------------------------------------------------------------------- recordings */

/* Takes bytes of a recording; false stops it. */
typedef bool (*GyreWriteFunction)(void* user, const uint8_t* bytes, size_t count);
/* Records the world from its present state until the recorder is finished or destroyed. A recorder ends with its world, too. */
GYRE_C_API GyreRecorder* gyre_recorder_create(GyreWorld* world, GyreWriteFunction write, void* user,
                                              const GyreRecordOptions* options) GYRE_C_NOEXCEPT;

/* ----------------------------------------------------------------------------------------------------------- scenes */

/* A scene file in a world, with its names and timed forces (docs/scenes). */
typedef struct GyreScene GyreScene;
/* Loads the scene of a file; meshes are looked for beside it. threads and simd_width as in GyreWorldDef. */
GYRE_C_API GyreScene* gyre_scene_load(const char* path, int32_t threads, int32_t simd_width) GYRE_C_NOEXCEPT;
/* The same for the text of a scene. */
GYRE_C_API GyreScene* gyre_scene_read(const char* text, size_t text_count, int32_t threads, int32_t simd_width) GYRE_C_NOEXCEPT;
GYRE_C_API void gyre_scene_destroy(GyreScene* scene) GYRE_C_NOEXCEPT;
/* The world of the scene; it belongs to the scene. */
GYRE_C_API GyreWorld* gyre_scene_world(GyreScene* scene) GYRE_C_NOEXCEPT;
GYRE_C_API const char* gyre_scene_name(const GyreScene* scene) GYRE_C_NOEXCEPT;
GYRE_C_API double gyre_scene_time_step(const GyreScene* scene) GYRE_C_NOEXCEPT; /* s */
/* Applies the forces of this moment and steps the world by the scene's time step. */
GYRE_C_API bool gyre_scene_step(GyreScene* scene) GYRE_C_NOEXCEPT;
/* Bodies, joints, ropes, cloths, soft bodies, gases and liquids in the order of the file, those that were removed included. */
GYRE_C_API const GyreBodyId* gyre_scene_bodies(const GyreScene* scene, size_t* count) GYRE_C_NOEXCEPT;
GYRE_C_API const GyreJointId* gyre_scene_joints(const GyreScene* scene, size_t* count) GYRE_C_NOEXCEPT;
GYRE_C_API const GyreSoftId* gyre_scene_softs(const GyreScene* scene, size_t* count) GYRE_C_NOEXCEPT;
GYRE_C_API const GyreFluidId* gyre_scene_fluids(const GyreScene* scene, size_t* count) GYRE_C_NOEXCEPT;
/* The name of the one at `index`, empty if it has none or there is no such index. */
GYRE_C_API const char* gyre_scene_body_name(const GyreScene* scene, size_t index) GYRE_C_NOEXCEPT;
GYRE_C_API const char* gyre_scene_joint_name(const GyreScene* scene, size_t index) GYRE_C_NOEXCEPT;
GYRE_C_API const char* gyre_scene_soft_name(const GyreScene* scene, size_t index) GYRE_C_NOEXCEPT;
GYRE_C_API const char* gyre_scene_fluid_name(const GyreScene* scene, size_t index) GYRE_C_NOEXCEPT;
/* The body or joint of this name; the null id if there is none. */
GYRE_C_API GyreBodyId gyre_scene_body(const GyreScene* scene, const char* name) GYRE_C_NOEXCEPT;
GYRE_C_API GyreJointId gyre_scene_joint(const GyreScene* scene, const char* name) GYRE_C_NOEXCEPT;
/* The scene as it stands now, as the text of a scene file; NUL-terminated. */
GYRE_C_API const char* gyre_scene_write(const GyreScene* scene, size_t* count) GYRE_C_NOEXCEPT;

/* ---------------------------------------------------------------------------------------------------------- batches */

/* Many copies of one world that are stepped over all cores, with one array for all observations and one for all actions. Results do not
   depend on the number of threads: world i has the bits of a world that is stepped alone. */
typedef struct GyreBatch GyreBatch;

typedef uint8_t GyreReading;
enum {
  GYRE_READING_POSITION = 0,         /* m, of the body's origin, world: 3 numbers */
  GYRE_READING_ORIENTATION = 1,      /* x y z w: 4 numbers */
  GYRE_READING_LINEAR_VELOCITY = 2,  /* m/s, of the centre of mass, world: 3 numbers */
  GYRE_READING_ANGULAR_VELOCITY = 3, /* rad/s, world: 3 numbers */
  GYRE_READING_JOINT_POSITION = 4,   /* m or rad, of an axis of a joint */
  GYRE_READING_JOINT_VELOCITY = 5,   /* m/s or rad/s */
  GYRE_READING_JOINT_FORCE = 6,      /* N or N m, by limits, motor, spring and friction together */
  GYRE_READING_TOUCHING = 7          /* N, the sum of normal forces on a body, mean over the last step */
};
typedef uint8_t GyreAction;
enum {
  GYRE_ACTION_FORCE = 0,           /* N, on the centre of mass, world: 3 numbers */
  GYRE_ACTION_TORQUE = 1,          /* N m, world: 3 numbers */
  GYRE_ACTION_MOTOR_VELOCITY = 2,  /* m/s or rad/s, target of the motor of a joint */
  GYRE_ACTION_MOTOR_POSITION = 3,  /* m or rad */
  GYRE_ACTION_MOTOR_FORCE = 4,     /* N or N m, constant through the steps */
  GYRE_ACTION_VELOCITY = 5         /* m/s, of a body: 3 numbers */
};
/* One reading or action. Vectors take as many numbers in the rows of observations and actions as `components` has bits. */
typedef struct GyreChannel {
  uint8_t what;       /* GyreReading or GyreAction */
  uint8_t components; /* of vectors: 1 is x, 2 is y, 4 is z, 8 is w, and their sums; 0 means all */
  GyreJointAxis axis; /* of joints, see gyre_world_joint_axis_state */
  GyreBodyId body;    /* of the world that the batch was made of */
  GyreJointId joint;
  float max_force;    /* N or N m, of motor velocities and positions */
  float frequency;    /* Hz, of motor positions; 0: as stiff as the step allows */
  float damping_ratio;
} GyreChannel;

typedef uint8_t GyreDraw;
enum {
  GYRE_DRAW_POSITION = 0,         /* m, added to that of the start, world */
  GYRE_DRAW_LINEAR_VELOCITY = 1,  /* m/s, added */
  GYRE_DRAW_ANGULAR_VELOCITY = 2, /* rad/s, added */
  GYRE_DRAW_GRAVITY = 3,          /* m/s^2, added to that of the world; no body */
  GYRE_DRAW_GRAVITY_SCALE = 4,    /* a factor in x */
  GYRE_DRAW_FRICTION = 5,         /* a factor in x, for all shapes of the body */
  GYRE_DRAW_RESTITUTION = 6       /* 0 to 1 in x, of all shapes of the body */
};
/* A parameter that each world draws anew when it begins: evenly between low and high, component by component. */
typedef struct GyreBatchDraw {
  uint8_t what;    /* GyreDraw */
  GyreBodyId body; /* of the world that the batch was made of */
  GyreVec3 low, high;
} GyreBatchDraw;

/* `worlds` copies of a world as it is; threads 0: as many as the machine has. The copies share cooked geometry. */
GYRE_C_API GyreBatch* gyre_batch_create(const GyreWorld* world, int32_t worlds, int32_t threads) GYRE_C_NOEXCEPT;
GYRE_C_API void gyre_batch_destroy(GyreBatch* batch) GYRE_C_NOEXCEPT;
/* The readings and actions of every row. Refuses channels of bodies and joints that the world has not. */
GYRE_C_API bool gyre_batch_set_observations(GyreBatch* batch, const GyreChannel* channels, size_t count) GYRE_C_NOEXCEPT;
GYRE_C_API bool gyre_batch_set_actions(GyreBatch* batch, const GyreChannel* channels, size_t count) GYRE_C_NOEXCEPT;
/* The parameters that worlds draw, at most 64, and resets every world. A draw is a function of seed, world, number of the reset and place in
   the list. */
GYRE_C_API bool gyre_batch_set_draws(GyreBatch* batch, const GyreBatchDraw* draws, size_t count, uint64_t seed) GYRE_C_NOEXCEPT;
GYRE_C_API size_t gyre_batch_size(const GyreBatch* batch) GYRE_C_NOEXCEPT;
GYRE_C_API size_t gyre_batch_body_count(const GyreBatch* batch) GYRE_C_NOEXCEPT; /* bodies of the world that the batch was made of */
GYRE_C_API size_t gyre_batch_observation_width(const GyreBatch* batch) GYRE_C_NOEXCEPT; /* numbers a row */
GYRE_C_API size_t gyre_batch_action_width(const GyreBatch* batch) GYRE_C_NOEXCEPT;
/* Applies a row of actions to each world (NULL: none), steps it `steps` times by `seconds`, and reads a row of observations (NULL: none).
   Forces act in each of the steps. */
GYRE_C_API bool gyre_batch_step(GyreBatch* batch, const float* actions, float* observations, int32_t steps, float seconds) GYRE_C_NOEXCEPT;
/* Sets the worlds whose byte is not 0 back to the start; NULL: all. */
GYRE_C_API bool gyre_batch_reset(GyreBatch* batch, const uint8_t* which) GYRE_C_NOEXCEPT;
GYRE_C_API void gyre_batch_observe(GyreBatch* batch, float* observations) GYRE_C_NOEXCEPT;
/* All bodies that the first world had, in the order of gyre_world_bodies, world after world; a NULL column is left out. Bodies that a world
   has no more are zero. */
GYRE_C_API bool gyre_batch_columns(const GyreBatch* batch, GyrePose* poses, GyreVec3* linear_velocities,
                                   GyreVec3* angular_velocities) GYRE_C_NOEXCEPT;
/* The hash of each world: that of a world that was stepped alone. */
GYRE_C_API void gyre_batch_hashes(const GyreBatch* batch, uint64_t* out) GYRE_C_NOEXCEPT;
/* The values of a draw in the present run of a world. */
GYRE_C_API GyreVec3 gyre_batch_drawn(const GyreBatch* batch, size_t index, size_t draw) GYRE_C_NOEXCEPT;
/* One of the worlds, to be read and changed between two steps; it belongs to the batch. Its ids are those of the first world but for the
   number of the world, which gyre_batch_body and gyre_batch_joint put in. */
GYRE_C_API GyreWorld* gyre_batch_world(GyreBatch* batch, size_t index) GYRE_C_NOEXCEPT;
GYRE_C_API GyreBodyId gyre_batch_body(const GyreBatch* batch, size_t index, GyreBodyId body) GYRE_C_NOEXCEPT;
GYRE_C_API GyreJointId gyre_batch_joint(const GyreBatch* batch, size_t index, GyreJointId joint) GYRE_C_NOEXCEPT;

"""

TAIL = """#ifdef __cplusplus
}
#endif

#endif
"""


def comment(text, indent=""):
    if not text:
        return ""
    lines = text.replace("*/", "* /").replace("/*", "/ *").split("\n")
    return "\n".join(f"{indent}{'/* ' if i == 0 else '   '}{line}".rstrip() for i, line in enumerate(lines)) + " */\n"


def trailing(text):
    return f" /* {' '.join(text.replace('*/', '* /').split())} */" if text else ""


class HeaderWriter:
    def __init__(self, model):
        self.model = model

    def write(self):
        m = self.model
        parts = [HEAD, self.handles(), self.vectors()]
        parts += [self.enum(enum) for enum in m.api.enums.values()]
        parts += [self.constants()]
        for name in m.structs:
            parts.append(self.struct(name))
            if name == self.last_of_shapes():
                parts.append(self.any_shape())
        parts.append(BY_HAND)
        parts += [self.default(name) for name in m.structs if name in m.definitions]
        parts.append("/* Other structs with the default of every field. */\n")
        parts += [f"GYRE_C_API Gyre{name} gyre_{snake(name)}_default(void) GYRE_C_NOEXCEPT;\n" for name in m.with_default()]
        parts += [self.destroy(name) for name in self.handle_names()]
        parts += [self.function(call) for call in m.calls]
        parts.append(TAIL)
        return "".join(parts)

    def handle_names(self):
        return [name for name in self.model.api.classes if name not in LEFT_OUT]

    def handles(self):
        docs = self.model.api.classes
        lines = [comment(docs[name].doc) + f"typedef struct Gyre{name} Gyre{name};\n" for name in self.handle_names()]
        for name in self.model.ids:
            lines.append(f"typedef struct Gyre{name} {{\n  uint32_t index;\n  uint16_t generation; /* 0 only in the null id */\n"
                         f"  uint16_t world;\n}} Gyre{name};\n")
        return "".join(lines) + "\n"

    @staticmethod
    def vectors():
        return "".join(f"typedef struct Gyre{name} {{\n  {kind} {', '.join(fields.split())};\n}} Gyre{name};\n"
                       for name, (kind, fields) in VECTORS.items()) + "\n"

    @staticmethod
    def enum(enum):
        prefix = "GYRE_" + snake(enum.name).upper()
        lines = [comment(enum.doc), f"typedef uint8_t Gyre{enum.name};\nenum {{\n"]
        for i, (name, number, doc) in enumerate(enum.values):
            lines.append(f"  {prefix}_{name.upper()} = {number}{',' if i + 1 < len(enum.values) else ''}{trailing(doc)}\n")
        return "".join(lines) + "};\n\n"

    def constants(self):
        lines = []
        for name, (literal, doc) in self.model.api.constants.items():
            value = self.model.constant(name)
            suffix = "f" if literal.endswith("f") and isinstance(value, float) else "u" if isinstance(value, int) and value > 2**31 - 1 else ""
            lines.append(f"#define GYRE_{snake(name).upper()} {value}{suffix}{trailing(doc)}\n")
        return "".join(lines) + "\n"

    def struct(self, name):
        lines = [comment(self.model.api.structs[name].doc), f"typedef struct Gyre{name} {{\n"]
        for kind, member, doc in self.model.c_fields(name):
            space = "" if kind.endswith("*") and False else " "
            if len(doc) > 90 or "\n" in doc:
                lines.append(comment(textwrap.fill(" ".join(doc.split()), 120), "  ") + f"  {kind}{space}{member};\n")
            else:
                lines.append(f"  {kind}{space}{member};{trailing(doc)}\n")
        return "".join(lines) + f"}} Gyre{name};\n\n"

    def last_of_shapes(self):
        parts = self.model.variant_parts("AnyShape")
        return max((p for p in parts if p in self.model.structs), key=self.model.structs.index)

    def any_shape(self):
        lines = ["/* Any shape: `kind` tells which member counts. A hull, mesh or height field has `geometry`, which must live until the call\n"
                 "   returns. In an answer `geometry` is a handle of its own, to be freed by gyre_geometry_destroy. */\n"
                 "typedef struct GyreAnyShape {\n  GyreShapeKind kind;\n  union {\n"]
        for part in self.model.variant_parts("AnyShape"):
            lines.append(f"    {self.model.c_type(part)} {snake(part)};\n")
        return "".join(lines) + "  } as;\n} GyreAnyShape;\n\n"

    @staticmethod
    def default(name):
        low = snake(name)
        return (f"/* Fills a {name} with the default of every field: size is sizeof *out. */\n"
                f"GYRE_C_API void gyre_{low}_init(Gyre{name}* out, size_t size) GYRE_C_NOEXCEPT;\n"
                f"static inline Gyre{name} gyre_{low}_default(void) {{\n  Gyre{name} out;\n  gyre_{low}_init(&out, sizeof out);\n"
                "  return out;\n}\n")

    @staticmethod
    def destroy(name):
        return f"GYRE_C_API void gyre_{snake(name)}_destroy(Gyre{name}* {snake(name)}) GYRE_C_NOEXCEPT; /* NULL is allowed */\n"

    # ------------------------------------------------------------------------------------------------- functions

    def signature(self, call):
        m = self.model
        parameters = []
        if call.owner and call.source.name != call.owner:
            const = "const " if call.source.const or (call.handle_first and "const " + call.owner in call.source.line) else ""
            parameters.append(f"{const}Gyre{call.owner}* {snake(call.owner)}")
        for p in call.parameters:
            parameters += self.parameter(p)
        kind = m.c_type(call.kind) if call.kind and call.kind != "string_view" else ""
        answer = call.answer
        result = {"void": "void", "error": "GyreErrorCode", "text": "const char*", "borrowed": f"Gyre{call.kind}*", "made": f"Gyre{call.kind}*",
                  "checked": "bool", "maybe": "bool", "definition": "void", "shape": "bool"}.get(answer, kind)
        if answer == "rows":
            result = f"const {kind}*"
        if answer == "rows" or (answer == "text" and call.kind == "string_view"):
            parameters.append("size_t* count")
        if answer in ("checked", "maybe", "definition", "shape"):
            parameters.append(f"{kind}* result")
        return f"{result} {call.name}({', '.join(parameters) or 'void'}) GYRE_C_NOEXCEPT"

    def parameter(self, p):
        m = self.model
        kind = m.c_type(p.kind) if p.role not in ("text", "left", "table") else ""
        return {
            "value": lambda: [f"{kind} {p.name}"],
            "definition": lambda: [f"const {kind}* {p.name}"],
            "shape": lambda: [f"const {kind}* {p.name}"],
            "handle": lambda: [f"{'const ' if p.kind == 'Geometry' else ''}{kind}* {p.name}"],
            "geometry": lambda: [f"const {kind} {p.name}"],
            "rows": lambda: [f"const {kind}* {p.name}", f"size_t {p.name}_count"],
            "fill": lambda: [f"{kind}* {p.name}", f"size_t {p.name}_count"],
            "text": lambda: [f"const char* {p.name}", f"size_t {p.name}_count"],
            "out": lambda: [f"{kind}* {p.name}"],
            "table": lambda: [],
            "left": lambda: [],
        }[p.role]()

    def function(self, call):
        doc = call.source.doc
        return comment(doc) + f"GYRE_C_API {self.signature(call)};\n"
