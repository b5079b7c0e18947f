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

SceneColor resolved_color(const Scene& scene, SoftKind kind, std::size_t index) {
  const SceneSoft* soft = nullptr;
  std::size_t before = 0;  // of other kinds
  if (kind == SoftKind::rope) {
    if (index < scene.ropes.size()) soft = &scene.ropes[index];
  } else if (kind == SoftKind::cloth) {
    before = scene.ropes.size();
    if (index < scene.cloths.size()) soft = &scene.cloths[index];
  } else {
    before = scene.ropes.size() + scene.cloths.size();
    if (index < scene.soft_bodies.size()) soft = &scene.soft_bodies[index];
  }
  if (soft == nullptr) return automatic_color(BodyType::fixed, 0);
  return soft->color ? *soft->color : automatic_color(BodyType::dynamic, before + index);
}

}  // namespace gyre
