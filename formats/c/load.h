// Loads files of other programs in C: URDF and MJCF (robots), glTF with physics, and scene files, by the library libgyre-formats.
//
//   cc -std=c11 program.c $(pkg-config --cflags --libs gyre-formats)
//
// docs/formats.md says what is read. No function throws.
#ifndef GYRE_C_LOAD_H
#define GYRE_C_LOAD_H

#include <gyre/c/gyre.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Fill it by gyre_load_options_default(), then change fields. */
typedef struct GyreLoadOptions {
  uint32_t size;
  bool strict;         /* refuse a file with anything that would be left out */
  bool free_base;      /* URDF: the root link moves freely; otherwise the root is static */
  bool keep_fixed;     /* fixed joints stay joints; otherwise they make one body of two links */
  bool self_collision; /* URDF: links of the robot collide with each other, neighbours excepted */
  bool decompose; /* concave meshes of moving bodies become several hulls; otherwise each becomes one hull */
  /* Folders that may be read beside the folder of the file. NAME=FOLDER is the folder of the package NAME. */
  const char* const* packages;
  size_t package_count;
} GyreLoadOptions;

GYRE_C_API GyreLoadOptions gyre_load_options_default(void) GYRE_C_NOEXCEPT;

/* A file of any format as a scene in its world, to be freed by gyre_scene_destroy(). NULL options are the defaults; threads and simd_width
   as in GyreWorldDef. NULL if the file is refused. */
GYRE_C_API GyreScene* gyre_load_scene(const char* path, const GyreLoadOptions* options, int32_t threads,
                                      int32_t simd_width) GYRE_C_NOEXCEPT;
/* The same as the text of a scene file with the meshes in it; NUL-terminated, valid until this thread calls it again. NULL if refused. */
GYRE_C_API const char* gyre_load_text(const char* path, const GyreLoadOptions* options,
                                      size_t* text_count) GYRE_C_NOEXCEPT;

/* Elements of the last file of this thread that are not simulated, a line for each kind of note; empty if there are none. Never NULL. */
GYRE_C_API const char* gyre_load_notes(void) GYRE_C_NOEXCEPT;
/* Why the last refused call of this library on this thread was refused. Never NULL. */
GYRE_C_API const char* gyre_load_error(void) GYRE_C_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
