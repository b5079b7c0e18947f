// Making and destroying cooked data, the one place that knows all three kinds.
#include "geometry/cooked.h"

#include "geometry/height_field.h"
#include "geometry/hull.h"
#include "geometry/mesh.h"

namespace gyre {

CookedGeometry::CookedGeometry() = default;
CookedGeometry::~CookedGeometry() = default;

}  // namespace gyre
