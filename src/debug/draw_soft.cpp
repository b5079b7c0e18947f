// Draws ropes, cloths and solids. See draw_soft.h.
#include "debug/draw_soft.h"

#include "base/container/flat_map.h"
#include "soft/store/soft_point.h"

namespace gyre {

namespace {

constexpr Color kAwake{245, 145, 44, 255}, kAsleep{66, 135, 245, 255};
constexpr Color kPinned{235, 64, 52, 255}, kAttached{66, 135, 245, 255};
constexpr Color kIdle{150, 150, 150, 255}, kPressing{72, 199, 92, 255};

Vec3 place_of(const SoftEntry& entry, std::uint32_t particle, const Painter& paint) {
  const Particles& p = entry.body.particles;
  const int i = int(particle);
  return difference({p.x[i], p.y[i], p.z[i]}, paint.options().origin);
}

template <class Fn>
void for_each_edge(const SoftEntry& entry, Fn&& fn) {
  if (entry.kind == SoftKind::rope) {
    for (std::uint32_t i = 0; i + 1 < std::uint32_t(entry.body.particles.count); ++i) fn(i, i + 1);
    return;
  }
  FlatMap<std::uint8_t> seen;
  const std::span<const std::uint32_t> corners = entry.triangles.view();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t a = corners[i], b = corners[i % 3 == 2 ? i - 2 : i + 1];
    std::uint8_t& drawn = seen.find_or_insert(std::uint64_t(min(a, b)) << 32 | max(a, b));
    if (drawn == 0) fn(a, b);
    drawn = 1;
  }
}

}  // namespace

void draw_soft_edges(const SoftStore& softs, Painter& paint) {
  paint.begin(DrawLayer::soft_edges);
  std::uint32_t number = 0;
  softs.for_each([&](const SoftEntry& entry) {
    Color color = entry.is_awake() ? kAwake : kAsleep;
    if (paint.options().color_by == ColorBy::island) color = color_of_number(number);
    ++number;
    for_each_edge(entry, [&](std::uint32_t a, std::uint32_t b) {
      paint.line(place_of(entry, a, paint), place_of(entry, b, paint), color);
    });
    for (const SoftAttachment& attachment : entry.attachments.view())
      paint.point(place_of(entry, attachment.particle, paint),
                  attachment.body == kWorldAnchor ? kPinned : kAttached);
    for (const SoftPointAttachment& point : entry.points.view())
      paint.point(difference(place_of(entry, point), paint.options().origin), point.body == kWorldAnchor ? kPinned : kAttached);
  });
}

void draw_soft_contacts(const SoftStore& softs, Painter& paint) {
  paint.begin(DrawLayer::soft_contacts);
  softs.for_each([&](const SoftEntry& entry) {
    for (const SoftContact& contact : entry.contacts.view()) {
      const Vec3 at = place_of(entry, contact.particle, paint);
      const Color color = contact.impulse == Vec3{} ? kIdle : kPressing;
      paint.point(at, color);
      paint.line(at, at + entry.size * contact.normal, color);
    }
  });
}

}  // namespace gyre
