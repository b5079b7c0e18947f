// Decides by the root element. See xml_robots.h.
#include "formats/xml_robots.h"

#include <tinyxml2.h>

namespace gyre {

void read_urdf_or_mjcf(Import& import) {
  tinyxml2::XMLDocument document;
  parse_xml(import, import.bytes, import.file, document);
  const XmlElement root(document.RootElement(), import);
  if (root.name() == "robot") return read_urdf(import, root);
  if (root.name() == "mujoco") return read_mjcf(import, document);
  root.fail("expected <robot> (URDF) or <mujoco> (MJCF) as the root");
}

}  // namespace gyre
