// The colours of a scene: what its fields say, and a choice where they say nothing, so that every picture of a scene shows
// the same body in the same colour.
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <string>

namespace gyre {

// "#rrggbb", in lower case.
std::string color_text(SceneColor color);

// Colour number `index` of a cycle in which neighbours are easy to tell apart; light grey for what never moves.
SceneColor automatic_color(BodyType type, std::size_t index);
// Of planes.
constexpr SceneColor kGroundColor{214, 216, 220};

// The first of these that is given: the shape's, the body's, its material's; else the automatic one.
SceneColor resolved_color(const Scene& scene, std::size_t body, std::size_t shape);
// Of rope, cloth or soft body number `index` of the scene: the colour that is given, else the automatic one.
SceneColor resolved_soft_color(const Scene& scene, SoftKind kind, std::size_t index);
// Of a fluid: the colour that is given, else that of pale smoke or of water.
SceneColor resolved_fluid_color(const SceneFluid& fluid, FluidKind kind);
constexpr SceneColor kSmokeColor{226, 224, 218}, kWaterColor{62, 134, 176};

}  // namespace gyre
