// Geoms of MJCF to shapes, and what a compiler section says about numbers.
#pragma once

#include "formats/xml_element.h"

#include <map>
#include <optional>
#include <string>

namespace gyre {

struct MjcfCompiler {
  bool degrees = true;
  bool auto_limits = true;
  std::string euler = "xyz";
  std::string mesh_folder;
  std::string inertia_from_geom = "auto";

  double angle(double value) const { return degrees ? value * kPiDouble / 180.0 : value; }
};

struct MjcfAssets {
  std::map<std::string, XmlElement> meshes;
  std::map<std::string, SceneColor> colors;  // of materials
};

struct MjcfGeom {
  std::optional<SceneShape> shape{};  // none: only to be seen, or left out
  std::optional<MassProperties> mass{};
  std::uint32_t contype = 1, conaffinity = 1;
};

Transform mjcf_frame(const XmlElement& element, const MjcfCompiler& compiler);
MjcfGeom read_geom(Import& import, const XmlElement& geom, const MjcfCompiler& compiler,
                   const MjcfAssets& assets, bool needs_mass);

}  // namespace gyre
