// The readers of robots in XML. Both add to the scene of the import; refusals are thrown as SceneError.
#pragma once

#include "formats/xml_element.h"

namespace gyre {

void read_urdf(Import& import, const XmlElement& robot);
void read_mjcf(Import& import, tinyxml2::XMLDocument& document);

}  // namespace gyre
