// Gases and liquids as they are seen. See fluid_sight.h.
#include "render/fluid_sight.h"

#include "scene/scene_color.h"

#include <algorithm>

namespace gyre {
namespace {

// What 255 stands for.
struct VoxelScales {
  float smoke = 0.0f;    // kg/m^3
  float ambient = 0.0f;  // K
  float heat = 0.0f;     // K above it
};

// Nothing in a gas is thicker or hotter than what it began with and what its emitters give, but for what burns.
VoxelScales scales_of(const GasDef& gas) {
  constexpr float kRounding = 1e-3f;  // K
  VoxelScales out;
  out.ambient = gas.ambient_temperature;
  float hottest = out.ambient;
  for (const FluidEmitter& emitter : gas.emitters) {
    const float fuel = gas.combustion ? emitter.fuel : 0.0f;
    const Combustion burning = gas.combustion.value_or(Combustion{});
    out.smoke = max(out.smoke, emitter.density + burning.smoke_yield * fuel);
    hottest = max(hottest,
                  emitter.temperature + burning.heat_release * fuel / (gas.density * burning.heat_capacity));
  }
  if (gas.fields) {
    for (const float density : gas.fields->density) out.smoke = max(out.smoke, density);
    for (const float temperature : gas.fields->temperature) hottest = max(hottest, temperature);
  }
  if (hottest - out.ambient > kRounding) out.heat = hottest - out.ambient;
  return out;
}

std::vector<float> read_field(const World& world, FluidId id, FluidField field) {
  std::vector<float> out(world.fluid_field(id, field, {}));
  world.fluid_field(id, field, out);
  return out;
}

void put_field(const std::vector<float>& field, float zero, float full, std::uint8_t Voxel::*part,
               std::vector<Voxel>& voxels) {
  for (std::size_t i = 0; i < min(field.size(), voxels.size()); ++i) {
    voxels[i].*part = std::uint8_t(255.0f * std::clamp((field[i] - zero) / full, 0.0f, 1.0f) + 0.5f);
  }
}

void look_at_gas(const World& world, FluidId id, const VoxelScales& scales, SeenFluid& out) {
  out.smoky = scales.smoke > 0.0f || scales.heat > 0.0f;
  out.voxels.resize(std::size_t(out.cells[0]) * std::size_t(out.cells[1]) * std::size_t(out.cells[2]));
  if (scales.smoke > 0.0f)
    put_field(read_field(world, id, FluidField::smoke), 0.0f, scales.smoke, &Voxel::smoke, out.voxels);
  if (scales.heat > 0.0f) {
    put_field(read_field(world, id, FluidField::temperature), scales.ambient, scales.heat, &Voxel::heat,
              out.voxels);
  }
  if (out.smoky || out.flat_axis() < 0) return;
  const std::vector<float> speeds = read_field(world, id, FluidField::speed);
  float fastest = 1e-6f;
  for (const float speed : speeds) fastest = max(fastest, speed);
  put_field(speeds, 0.0f, fastest, &Voxel::speed, out.voxels);
}

DVec3 place_of(const Pose& pose, DVec3 in_box) {
  const Quat& q = pose.orientation;
  const DVec3 u{double(q.x), double(q.y), double(q.z)}, t = 2.0 * cross(u, in_box);
  return pose.position + in_box + double(q.w) * t + cross(u, t);
}

// A box that is turned, in an upright one around it, whose cells have what is at their centres.
void set_upright(const Pose& pose, SeenFluid& out) {
  const DVec3 size = out.upper() - out.lower;
  DVec3 low{}, high{};
  for (int corner = 0; corner < 8; ++corner) {
    const DVec3 at =
        place_of(pose, out.lower + DVec3{(corner & 1) != 0 ? size.x : 0.0, (corner & 2) != 0 ? size.y : 0.0,
                                         (corner & 4) != 0 ? size.z : 0.0});
    if (corner == 0) low = high = at;
    low = {min(low.x, at.x), min(low.y, at.y), min(low.z, at.z)};
    high = {max(high.x, at.x), max(high.y, at.y), max(high.z, at.z)};
  }
  const SeenFluid from = out;
  const float edge = min(from.cell.x, min(from.cell.y, from.cell.z));
  const double extent[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
  for (std::size_t axis = 0; axis < 3; ++axis) out.cells[axis] = 1 + int(extent[axis] / double(edge));
  out.lower = low;
  out.cell = {float(extent[0]) / float(out.cells[0]), float(extent[1]) / float(out.cells[1]),
              float(extent[2]) / float(out.cells[2])};
  if (from.voxels.empty()) return;
  out.voxels.assign(std::size_t(out.cells[0]) * std::size_t(out.cells[1]) * std::size_t(out.cells[2]),
                    Voxel{});
  const Quat back = conjugate(pose.orientation);
  std::size_t n = 0;
  for (int k = 0; k < out.cells[2]; ++k) {
    for (int j = 0; j < out.cells[1]; ++j) {
      for (int i = 0; i < out.cells[0]; ++i, ++n) {
        const DVec3 at =
            low + multiply_each(out.cell, Vec3{float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f});
        const Vec3 local = difference(place_of({{}, back}, at - pose.position), from.lower);
        const float along[3] = {local.x / from.cell.x, local.y / from.cell.y, local.z / from.cell.z};
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis)
          inside = inside && along[axis] >= 0.0f && along[axis] < float(from.cells[std::size_t(axis)]);
        if (!inside) continue;
        out.voxels[n] =
            from.voxels[std::size_t(along[0]) +
                        std::size_t(from.cells[0]) *
                            (std::size_t(along[1]) + std::size_t(from.cells[1]) * std::size_t(along[2]))];
      }
    }
  }
}

void look_at_liquid(const World& world, FluidId id, SeenFluid& out) {
  const FluidSurfaceSize size = world.liquid_surface(id, {}, {});
  out.vertices.resize(size.vertices);
  out.indices.resize(size.indices);
  world.liquid_surface(id, out.vertices, out.indices);
}

}  // namespace

int SeenFluid::flat_axis() const {
  for (int axis = 0; axis < 3; ++axis)
    if (cells[std::size_t(axis)] == 1) return axis;
  return -1;
}

// Fluids of a scene carry their number among their kind as user data.
std::vector<SeenFluid> look_at_fluids(const World& world, const Scene* scene) {
  std::vector<FluidId> ids(world.fluids({}));
  world.fluids(ids);
  std::vector<SeenFluid> out;
  for (const FluidId id : ids) {
    const FluidInfo info = world.fluid_info(id);
    const auto index = std::size_t(info.user_data);
    SeenFluid& seen = out.emplace_back();
    seen.kind = info.kind;
    seen.cells = info.cells;
    seen.lower = info.lower;
    seen.cell = info.cell;
    if (info.kind == FluidKind::gas) {
      const bool known = scene && index < scene->gases.size();
      seen.color = known ? resolved_fluid_color(scene->gases[index], info.kind) : kSmokeColor;
      look_at_gas(world, id, scales_of(known ? scene->gases[index].def : world.gas_def(id)), seen);
    } else {
      const bool known = scene && index < scene->liquids.size();
      seen.color = known ? resolved_fluid_color(scene->liquids[index], info.kind) : kWaterColor;
      look_at_liquid(world, id, seen);
    }
    if (info.pose == Pose{}) continue;
    if (seen.kind == FluidKind::gas && seen.flat_axis() >= 0)
      seen.pose = info.pose;
    else
      set_upright(info.pose, seen);
  }
  return out;
}

}  // namespace gyre
