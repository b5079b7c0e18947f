// An MJCF document made plain: included files in place, the attributes of default classes on every element that they apply to.
#pragma once

#include "formats/xml_element.h"

#include <map>
#include <string>

namespace gyre {

// Included files may bring a worldbody of their own; all become one.
void include_files(Import& import, tinyxml2::XMLDocument& document);
void apply_defaults(const Import& import, tinyxml2::XMLDocument& document);

}  // namespace gyre
