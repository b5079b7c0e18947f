// A proxy is the entry of a shape in the broad phase: a fat box, a filter, and whether it moves. Proxies have the
// indices of shapes; a broad phase knows no bodies.
#pragma once

#include <gyre/defs.h>
#include <gyre/math.h>

#include <cstdint>

namespace gyre {

enum class ProxyMotion : std::uint8_t {
  none,    // the slot is empty
  fixed,   // never moves by itself: two fixed proxies pair only if one is a sensor
  moving,  // kinematic or dynamic
};

struct Proxy {
  Aabb fat_box;  // world frame, rounded outward, with a margin so that it changes rarely
  Filter filter;
  std::uint32_t body = 0;  // proxies of one body never pair
  ProxyMotion motion = ProxyMotion::none;
  bool sensor = false;
  bool pushes = true;  // dynamic: a pair needs at least one, unless one is a sensor
};

// True if the proxy has no pairs with others of its kind: it is fixed and no sensor. A fixed sensor reports fixed shapes, too.
constexpr bool is_scenery(const Proxy& proxy) { return proxy.motion == ProxyMotion::fixed && !proxy.sensor; }

// True if the two may pair, whatever their boxes.
constexpr bool may_pair(const Proxy& a, const Proxy& b) {
  if (a.motion == ProxyMotion::none || b.motion == ProxyMotion::none || a.body == b.body) return false;
  if (is_scenery(a) && is_scenery(b)) return false;
  if (a.sensor && b.sensor) return false;
  if (!a.sensor && !b.sensor && !a.pushes && !b.pushes) return false;
  if (a.filter.group != 0 && a.filter.group == b.filter.group) return a.filter.group > 0;
  return (a.filter.layer & b.filter.collides_with) != 0 && (b.filter.layer & a.filter.collides_with) != 0;
}

// The key of an unordered pair: the lower index in the high half, so that sorted keys go by the lower one.
constexpr std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t(a) << 32 | b) : (std::uint64_t(b) << 32 | a);
}

}  // namespace gyre
