// Gases and liquids of a scene in a world that has its bodies. See world_builder.h.
#include "scene/fluid_words.h"
#include "scene/world_builder.h"

#include <string_view>

namespace gyre {
namespace {

// Members of the engine's definitions, and their pointers in the format below an entry.
constexpr std::pair<std::string_view, const char*> kPlaces[] = {
    {"lower", "/bounds/0"},
    {"upper", "/bounds/1"},
    {"pose/position", "/position"},
    {"pose/orientation", "/orientation"},
    {"linear_velocity", "/linear_velocity"},
    {"angular_velocity", "/angular_velocity"},
    {"cells", "/cells"},
    {"cell_size", "/cell_size"},
    {"density", "/density"},
    {"viscosity", "/viscosity"},
    {"buoyancy", "/buoyancy"},
    {"vorticity", "/vorticity"},
    {"ambient_temperature", "/ambient_temperature"},
    {"advection", "/advection"},
    {"surface_tension", "/surface_tension"},
    {"side", "/boundary"},
    {"sides", "/boundary"},
    {"initial_velocity", "/initial_velocity"},
    {"vortices", "/initial_velocity"},
    {"fields", "/state"},
    {"fields/velocity_x", "/state/velocity/x"},
    {"fields/velocity_y", "/state/velocity/y"},
    {"fields/velocity_z", "/state/velocity/z"},
    {"fields/density", "/state/density"},
    {"fields/temperature", "/state/temperature"},
    {"fields/pressure", "/state/pressure"},
    {"fields/fuel", "/state/fuel"},
    {"combustion", "/combustion"},
    {"combustion/ignition_temperature", "/combustion/ignition_temperature"},
    {"combustion/burn_rate", "/combustion/burn_rate"},
    {"combustion/heat_release", "/combustion/heat_release"},
    {"combustion/heat_capacity", "/combustion/heat_capacity"},
    {"combustion/smoke_yield", "/combustion/smoke_yield"},
    {"adaptive_domain/margin", "/adaptive_domain/margin"},
    {"adaptive_domain/threshold", "/adaptive_domain/threshold"},
    {"particles", "/state"},
};

// "fill[2].lower is ..." as "fill/2/lower".
std::string path_of(std::string_view message) {
  std::string path;
  for (const char c : message.substr(0, message.find_first_of(" :"))) {
    if (c == '.' || c == '[') {
      path += '/';
    } else if (c != ']') {
      path += c;
    }
  }
  return path;
}

// The pointer to the member that a message of the engine begins with, below an entry; empty if it is none of the format.
std::string fluid_member_pointer(std::string_view message) {
  const std::string path = path_of(message);
  for (const auto& [engine, format] : kPlaces) {
    if (path == engine) return format;
  }
  const auto begins_with = [&](std::string_view start) { return path.compare(0, start.size(), start) == 0; };
  if (begins_with("wall_velocities/") && path.size() == 17 && path[16] >= '0' && path[16] <= '5')
    return std::string("/walls/") + kSideKeys[path[16] - '0'] + "/velocity";
  if (begins_with("particles/")) return "/state/" + path.substr(10);
  if (begins_with("emitters/")) return "/" + path;
  if (begins_with("fill/")) return "/" + path.substr(0, path.find('/', 5));  // corners of a box have no names
  return path == "fill" ? "/fill" : "";
}

}  // namespace

bool WorldBuilder::add_fluids() {
  const auto add = [&](const char* section, std::size_t index, const SceneFluid& fluid, FluidId id) {
    if (id) return true;
    const std::string why = last_refusal();
    return fail(std::string("/") + section + "/" + std::to_string(index) + fluid_member_pointer(why),
                "\"" + fluid.name + "\": " + why);
  };
  for (std::size_t i = 0; i < scene_.gases.size(); ++i) {
    GasDef def = scene_.gases[i].def;
    def.user_data = i;
    gases_.push_back(world_.add_gas(def));
    if (!add("gases", i, scene_.gases[i], gases_.back())) return false;
  }
  for (std::size_t i = 0; i < scene_.liquids.size(); ++i) {
    LiquidDef def = scene_.liquids[i].def;
    def.user_data = i;
    liquids_.push_back(world_.add_liquid(def));
    if (!add("liquids", i, scene_.liquids[i], liquids_.back())) return false;
  }
  return true;
}

}  // namespace gyre
