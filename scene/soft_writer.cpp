// Ropes, cloths and soft bodies to scene files. See write_parts.h and, for the format, scene_schema_soft.h.
#include "scene/write_parts.h"

namespace gyre {
namespace {

constexpr JsonLayout kInline = JsonLayout::one_line;

void write_settings(JsonWriter& json, const SoftSettings& settings) {
  const SoftSettings standard;
  if (settings.integrator != standard.integrator) json.field("integrator", to_string(settings.integrator));
  unless_default(json, "damping", settings.damping, standard.damping);
  unless_default(json, "static_friction", settings.static_friction, standard.static_friction);
  unless_default(json, "dynamic_friction", settings.dynamic_friction, settings.static_friction);
  if (settings.positions.empty() && settings.velocities.empty()) return;
  json.key("state").begin_object();
  if (!settings.positions.empty()) write_points(json, "positions", settings.positions);
  if (!settings.velocities.empty()) write_points(json, "velocities", settings.velocities);
  json.end_object();
}

void write_holds(JsonWriter& json, const Scene& scene, const SceneSoft& soft) {
  bool any_pinned = false, any_held = !soft.points.empty();
  for (const SceneHold& hold : soft.holds) (hold.body < 0 ? any_pinned : any_held) = true;
  if (any_pinned) {
    json.key("pinned").begin_array(kInline);
    for (const SceneHold& hold : soft.holds)
      if (hold.body < 0) json.value(hold.vertex);
    json.end_array();
  }
  if (!any_held) return;
  const auto write = [&](const char* key, const auto& value, int body) {
    json.begin_object(kInline);
    json.field(key, value);
    json.field("body", body < 0 ? "world" : scene.bodies[std::size_t(body)].name);
    json.end_object();
  };
  json.key("pinned_to").begin_array(kInline);
  for (const SceneHold& hold : soft.holds)
    if (hold.body >= 0) write("vertex", hold.vertex, hold.body);
  for (const SceneHeldPoint& point : soft.points) write("point", point.place, point.body);
  json.end_array();
}

void write_pose(JsonWriter& json, const Pose& pose) {
  json.field("position", pose.position);
  unless_default(json, "orientation", pose.orientation, Quat{});
}

template <class Numbers>
void write_numbers(JsonWriter& json, const char* key, const Numbers& numbers) {
  json.key(key).begin_array(kInline);
  for (const auto number : numbers) json.value(number);
  json.end_array();
}

void write_rope(JsonWriter& json, const Scene& scene, const SceneRope& rope) {
  const RopeDef standard;
  const RopeDef& def = rope.def;
  json.begin_object();
  json.field("name", rope.name);
  json.key("points").begin_array(kInline);
  for (const DVec3& point : def.points) json.value(point);
  json.end_array();
  unless_default(json, "segments", def.segments, 0);
  json.field("radius", def.radius);
  json.field("linear_density", def.linear_density);
  json.field("links", to_string(def.links));
  unless_default(json, "stretch_stiffness", def.stretch_stiffness, standard.stretch_stiffness);
  unless_default(json, "bend_stiffness", def.bend_stiffness, standard.bend_stiffness);
  write_color(json, rope.color);
  write_holds(json, scene, rope);
  write_settings(json, def.settings);
  json.end_object();
}

void write_cloth(JsonWriter& json, const Scene& scene, const SceneCloth& cloth) {
  const ClothDef standard;
  const ClothDef& def = cloth.def;
  json.begin_object();
  json.field("name", cloth.name);
  if (def.grid) {
    json.key("grid").begin_object(kInline);
    write_numbers(json, "size", def.grid->size);
    write_numbers(json, "cells", def.grid->cells);
    json.end_object();
  } else {
    json.field("mesh", scene.meshes[std::size_t(cloth.mesh)].name);
  }
  write_pose(json, def.pose);
  json.field("links", to_string(def.links));
  json.field("area_density", def.area_density);
  json.field("stretch_stiffness", def.stretch_stiffness);
  json.field("shear_stiffness", def.shear_stiffness);
  json.field("bend_stiffness", def.bend_stiffness);
  json.field("thickness", def.thickness);
  unless_default(json, "self_collision", def.self_collision, standard.self_collision);
  if (def.pressure) json.field("pressure", *def.pressure);
  unless_default(json, "ambient_pressure", def.ambient_pressure, standard.ambient_pressure);
  if (def.pressure_law != standard.pressure_law) json.field("pressure_law", to_string(def.pressure_law));
  unless_default(json, "tear_strain", def.tear_strain, standard.tear_strain);
  write_color(json, cloth.color);
  write_holds(json, scene, cloth);
  write_settings(json, def.settings);
  json.end_object();
}

void write_tetrahedra(JsonWriter& json, const SolidDef& def) {
  write_points(json, "vertices", def.vertices);
  json.key("tetrahedra").begin_array();
  for (std::size_t i = 0; i + 3 < def.tetrahedra.size(); i += 4) {
    json.begin_array(kInline);
    for (std::size_t k = 0; k < 4; ++k) json.value(std::int64_t(def.tetrahedra[i + k]));
    json.end_array();
  }
  json.end_array();
}

void write_soft_body(JsonWriter& json, const Scene& scene, const SceneSoftBody& solid) {
  const SolidDef& def = solid.def;
  json.begin_object();
  json.field("name", solid.name);
  if (solid.mesh >= 0) {
    json.field("mesh", scene.meshes[std::size_t(solid.mesh)].name);
    json.field("resolution", solid.resolution);
  } else if (def.box) {
    json.key("box").begin_object(kInline);
    json.field("half_extents", def.box->half_extents);
    write_numbers(json, "cells", def.box->cells);
    json.end_object();
  } else {
    write_tetrahedra(json, def);
  }
  write_pose(json, def.pose);
  json.field("model", to_string(def.model));
  json.field("density", def.density);
  json.field("young_modulus", def.young_modulus);
  json.field("poisson_ratio", def.poisson_ratio);
  unless_default(json, "fracture_stress", def.fracture_stress, 0.0f);
  unless_default(json, "yield_stress", def.yield_stress, 0.0f);
  unless_default(json, "creep_time", def.creep_time, 0.0f);
  write_color(json, solid.color);
  if (solid.pinned_region) {
    json.key("pinned_region").begin_object(kInline);
    json.key("box").begin_array(kInline);
    json.value(solid.pinned_region->low);
    json.value(solid.pinned_region->high);
    json.end_array();
    json.end_object();
  }
  write_holds(json, scene, solid);
  write_settings(json, def.settings);
  json.end_object();
}

template <class Soft>
void write_each(JsonWriter& json, const Scene& scene, const char* key, const std::vector<Soft>& all,
                void (*write)(JsonWriter&, const Scene&, const Soft&)) {
  if (all.empty()) return;
  json.key(key).begin_array();
  for (const Soft& one : all) write(json, scene, one);
  json.end_array();
}

}  // namespace

void write_soft_matter(JsonWriter& json, const Scene& scene) {
  write_each(json, scene, "ropes", scene.ropes, write_rope);
  write_each(json, scene, "cloths", scene.cloths, write_cloth);
  write_each(json, scene, "soft_bodies", scene.soft_bodies, write_soft_body);
}

}  // namespace gyre
