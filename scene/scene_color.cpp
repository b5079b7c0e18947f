// The colours of a scene. See scene_color.h.
#include "scene/scene_color.h"

namespace gyre {

std::string color_text(SceneColor color) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out = "#";
  for (const std::uint8_t part : {color.red, color.green, color.blue}) {
    out += kDigits[part >> 4];
    out += kDigits[part & 15];
  }
  return out;
}

SceneColor automatic_color(BodyType type, std::size_t index) {
  // Of about the same lightness, and so that neighbours differ in hue.
  constexpr SceneColor kCycle[] = {{217, 95, 67},   {63, 135, 191}, {235, 178, 74},  {96, 165, 105},
                                   {142, 108, 184}, {64, 166, 168}, {214, 122, 158}, {166, 152, 88}};
  if (type == BodyType::fixed) return {200, 200, 204};
  return kCycle[index % (sizeof kCycle / sizeof kCycle[0])];
}

SceneColor resolved_color(const Scene& scene, std::size_t body, std::size_t shape) {
  const SceneBody& owner = scene.bodies[body];
  const SceneShape& part = owner.shapes[shape];
  if (part.color) return *part.color;
  if (owner.color) return *owner.color;
  if (part.material >= 0 && scene.materials[std::size_t(part.material)].color) {
    return *scene.materials[std::size_t(part.material)].color;
  }
  if (std::holds_alternative<Plane>(part.geometry)) return kGroundColor;
  return automatic_color(owner.def.type, body);
}

SceneColor resolved_soft_color(const Scene& scene, SoftKind kind, std::size_t index) {
  // All of them go on in the cycle where the bodies end.
  std::size_t place = scene.bodies.size() + index;
  std::optional<SceneColor> given;
  switch (kind) {
    case SoftKind::rope:
      given = scene.ropes[index].color;
      break;
    case SoftKind::cloth:
      given = scene.cloths[index].color;
      place += scene.ropes.size();
      break;
    case SoftKind::solid:
      given = scene.soft_bodies[index].color;
      place += scene.ropes.size() + scene.cloths.size();
      break;
  }
  return given.value_or(automatic_color(BodyType::dynamic, place));
}

SceneColor resolved_fluid_color(const SceneFluid& fluid, FluidKind kind) {
  return fluid.color.value_or(kind == FluidKind::gas ? kSmokeColor : kWaterColor);
}

}  // namespace gyre
