// Everything to draw at one moment: all shapes, links, ropes, cloths, solids and fluids as coloured triangles and smoke, placed relative to an origin near
// the subject.
#pragma once

#include "render/camera.h"
#include "formats/shape_mesh.h"
#include "render/sight.h"
#include "render/smoke.h"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gyre {

// How a vertex is painted.
enum class Paint : std::uint8_t {
  matter,   // shaded, casts shadows
  ground,   // a plane of the world: with a grid, fading into the background
  floor,    // put under a scene that has no plane: without a grid
  sheet,    // one side of a cloth: as matter, but dull, and not to be seen from behind
  picture,  // shown as it is, whatever the light
  water,    // the surface of a liquid: more or less to be seen through, the less the flatter it is looked at
};

struct DrawVertex {
  Vec3 position;
  Vec3 normal;
  std::uint8_t color[3];  // sRGB
  Paint paint;
};

struct DrawList {
  std::vector<DrawVertex> vertices;
  // Three a triangle. Only what is solid casts a shadow. `glass` is what can be seen through; `shadowless` are pictures and water.
  std::vector<std::uint32_t> solid, glass, ground, shadowless;
  std::vector<SmokeVolume> smoke;
};

// What the picture is of, which decides how fine shapes are and how far the ground reaches.
struct Subject {
  DVec3 origin;                 // everything is placed relative to it
  float radius = 1.0f;          // m
  std::optional<double> floor;  // height of a floor where the world has no plane
  float rod_radius = 0.01f;     // m, of ropes and rods
};

// One shape of a body, by its place among the body's shapes.
using ShapeKey = std::pair<std::uint64_t, std::size_t>;
inline ShapeKey shape_key(BodyId body, std::size_t shape) {
  return {std::uint64_t(body.index) << 32 | body.generation, shape};
}

class DrawListMaker {
 public:
  // Shapes to be drawn as glass beside sensors.
  void set_glass(std::set<ShapeKey> glass) { glass_ = std::move(glass); }
  // Between which numbers readings are coloured.
  void set_range(const ReadingRange& range) { range_ = range; }
  DrawList make(const Sight& sight, const Camera& camera, const Subject& subject);

 private:
  const ShapeMesh& mesh_of(const AnyShape& shape, int segments);
  void add_shape(const SeenShape& shape, const Pose& pose, bool glass, const Camera& camera, DVec3 origin,
                 DrawList& list);

  std::set<ShapeKey> glass_;
  ReadingRange range_;
  std::map<std::string, ShapeMesh> meshes_;
};

}  // namespace gyre
