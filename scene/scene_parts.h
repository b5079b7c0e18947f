// Parts of the scene reader: each reads one section. Refusals are thrown as SceneError.
#pragma once

#include "scene/scene.h"
#include "scene/scene_fields.h"
#include "scene/scene_reader.h"

#include <map>
#include <string>

namespace gyre {

// Names to indices, of one kind of thing.
using NameTable = std::map<std::string, int, std::less<>>;

struct SceneReading {
  const ReadOptions& options;
  Scene scene;
  NameTable materials, meshes, bodies, joints;
  std::size_t shape_count = 0;
  NameTable matter = {};  // names of all that is not a body: ropes, cloths, soft bodies, gases, liquids
  std::size_t soft_vertices = 0;
  std::size_t fluid_cells = 0;
};

// The index behind a name; `what` names the kind: "a material".
int find_name(const NameTable& table, const Field& field, const char* what);

void read_mesh(SceneReading& reading, const Field& field, const std::string& name);
void read_shape(SceneReading& reading, const Field& field, SceneBody& body);
void read_body(SceneReading& reading, const Field& field);
void read_joint(SceneReading& reading, const Field& field);
void read_coupling(SceneReading& reading, const Field& field);
void read_field(SceneReading& reading, const Field& field);
void read_rope(SceneReading& reading, const Field& field);
void read_cloth(SceneReading& reading, const Field& field);
void read_soft_body(SceneReading& reading, const Field& field);
void read_gas(SceneReading& reading, const Field& field);
void read_liquid(SceneReading& reading, const Field& field);

// Two corners of a box in the world, the lower one first.
FieldBounds read_bounds(const Field& field);
// A name that no body and nothing else of the scene has.
std::string read_unique_name(SceneReading& reading, const Field& field);

// The surface values that stand both in a material and in place on a shape.
struct SurfaceFields {
  std::optional<float> density, static_friction, dynamic_friction, restitution, rolling_friction,
      spinning_friction;
};
SurfaceFields read_surface(Members& members);

}  // namespace gyre
