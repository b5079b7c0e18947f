// Smoke as a volume in pictures. See smoke.h.
#include "render/smoke.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

Vec3 corner_of(const Aabb& box, int corner) {
  return {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
          corner & 4 ? box.high.z : box.low.z};
}

// Where the edges of a box cut the plane that lies `away` along `forward`, in their order around it. At most six.
std::vector<Vec3> cut_box(const Aabb& box, Vec3 eye, Vec3 forward, float away) {
  std::vector<Vec3> cuts;
  for (int corner = 0; corner < 8; ++corner) {
    for (int bit = 1; bit < 8; bit *= 2) {
      if ((corner & bit) != 0) continue;
      const Vec3 a = corner_of(box, corner), b = corner_of(box, corner | bit);
      const float from = dot(forward, a - eye) - away, to = dot(forward, b - eye) - away;
      if ((from > 0.0f) != (to > 0.0f)) cuts.push_back(lerp(a, b, from / (from - to)));
    }
  }
  if (cuts.size() < 3) return {};
  Vec3 middle{};
  for (const Vec3 cut : cuts) middle = middle + (1.0f / float(cuts.size())) * cut;
  const Vec3 side = any_perpendicular(forward), other = cross(forward, side);
  const auto angle = [&](Vec3 cut) { return gyre::atan2(dot(other, cut - middle), dot(side, cut - middle)); };
  std::sort(cuts.begin(), cuts.end(), [&](Vec3 a, Vec3 b) { return angle(a) < angle(b); });
  return cuts;
}

}  // namespace

void light_smoke(SmokeVolume& volume, Vec3 sun) {
  const Vec3 size = volume.box.high - volume.box.low;
  float crossings[3], rate = 0.0f;  // 1/m: how many sides of cells a ray crosses
  std::size_t stride[3];
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int cells = volume.cells[std::size_t(axis)];
    crossings[axis] = cells > 1 ? std::abs(sun[axis]) * float(cells) / size[axis] : 0.0f;
    rate += crossings[axis];
    stride[axis] = count;
    count *= std::size_t(cells);
  }
  if (!(rate > 0.0f)) return;
  std::array<float, 256> passes;
  for (std::size_t i = 0; i < passes.size(); ++i)
    passes[i] = std::exp(-volume.extinction * float(i) / 255.0f / rate);
  std::vector<float> left(count);  // light that leaves a cell
  for (std::size_t step = 0; step < count; ++step) {
    float arrives = 0.0f;
    std::size_t at = 0, rest = step;
    bool inner[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto cells = std::size_t(volume.cells[std::size_t(axis)]);
      const std::size_t from_sun = rest % cells;
      rest /= cells;
      inner[axis] = from_sun > 0;
      at += stride[axis] * (sun[axis] > 0.0f ? cells - 1 - from_sun : from_sun);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t before = sun[axis] > 0.0f ? at + stride[axis] : at - stride[axis];
      arrives += crossings[axis] / rate * (inner[axis] ? left[before] : 1.0f);
    }
    left[at] = arrives * passes[volume.voxels[at].smoke];
    volume.voxels[at].light = std::uint8_t(255.0f * std::clamp(arrives, 0.0f, 1.0f) + 0.5f);
  }
}

SmokeSlices cut_smoke(const Aabb& box, Vec3 eye, Vec3 forward, int slices, float shift) {
  float near = dot(forward, box.low - eye), far = near;
  for (int corner = 1; corner < 8; ++corner) {
    const float away = dot(forward, corner_of(box, corner) - eye);
    near = min(near, away);
    far = max(far, away);
  }
  near = max(near, 0.0f);
  SmokeSlices out;
  if (!(far > near)) return out;
  out.thickness = (far - near) / float(slices);
  for (int slice = slices - 1; slice >= 0; --slice) {
    const std::vector<Vec3> cuts = cut_box(box, eye, forward, near + (float(slice) + shift) * out.thickness);
    for (std::size_t i = 2; i < cuts.size(); ++i)
      out.triangles.insert(out.triangles.end(), {cuts[0], cuts[i - 1], cuts[i]});
  }
  return out;
}

}  // namespace gyre
