// Making and destroying cooked data, the one place that knows all three kinds.
#include "geometry/shape/cooked.h"

#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"

namespace gyre {

CookedGeometry::CookedGeometry() = default;
CookedGeometry::~CookedGeometry() = default;

}  // namespace gyre
