// Construction and destruction of cooked data. Only this file needs the complete types of all three kinds.
#include "geometry/shape/cooked.h"

#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"

namespace gyre {

CookedGeometry::CookedGeometry() = default;
CookedGeometry::~CookedGeometry() = default;

}  // namespace gyre
