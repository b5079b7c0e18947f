#include "rigid/solve/rolling_contacts.h"

#include "geometry/shape/support.h"
#include "rigid/batch/solve_batch.h"
#include "task/parallel.h"
#include "task/parallel_filter.h"

namespace gyre {

namespace {

constexpr int kRollersPerBlock = 32;

// Least relative rotation in a step (rad) for which the point is advanced.
constexpr float kMinTurn = 1.0e-4f;
// Rotation in half a sub-step (rad) up to which the change of the rotation axis is fully computed.
constexpr float kLargestTurn = 0.2f;
// Largest path of a contact round its rim in a step (rad) for a single advance.
constexpr float kMaxRound = 0.3f;
// Path of a contact in a sub-step, as a share of its arm, above which it loses energy.
constexpr float kMaxRun = 0.02f;
// Rotation in a step (rad) above which all contacts of a body are advanced, whatever its shape.
constexpr float kFastSpin = 0.5f;
// Rotation (rad) of a kinematic neighbour above which a body does not count as fast-spinning.
constexpr float kCarried = 0.05f;
// Mean distance of the load from the middle of a ball's patch, as a share of the radius.
constexpr float kBallPatch = 5.0e-3f;
// A point is on the rim if it lies in the direction of the lowest point (cosine) and at the radius of the surface (share of the radius),
// and if the axis leans from the normal by more than kMinLean (sine). Below that the lowest point is noise.
constexpr float kSameDirection = 0.9999f, kSameRadius = 0.01f, kMinLean = 1.0e-3f;

bool is_flat(const Shape& shape) {
  return !is_convex(shape.kind) || (shape.kind == ShapeKind::hull) ||
         (shape.kind == ShapeKind::box && shape.radius == 0.0f);
}

// Returns the radius of the surface at a height above the middle of the shape.
float radius_at(const Shape& shape, float height) {
  if (shape.kind == ShapeKind::cylinder) return shape.radius;
  return shape.radius * clamp(0.5f * (1.0f - height / shape.extents.y), 0.0f, 1.0f);
}

// The unit vector towards the other shape at a right angle to the axis, and the sine of the angle between axis and outward normal.
struct Lowest {
  Vec3 direction;
  float lean;
  Lowest(Vec3 outward, Vec3 axis) {
    const Vec3 across = outward - dot(outward, axis) * axis;
    lean = length(across);
    direction = lean > 0.0f ? across / lean : Vec3{};
  }
};

RollingPoint describe_point(const Shape& shape, const RollingContact& rolling, Quat orientation, Vec3 arm,
                            float separation) {
  RollingPoint point;
  point.first_arm = arm;
  point.first_separation = separation;
  const Vec3 half_gap = (0.5f * separation) * rolling.outward;
  const Vec3 on_surface = arm - half_gap;
  if (core_radius(shape) > 0.0f) {
    point.reach = core_radius(shape);
    point.core = rotate_inverse(orientation, on_surface - point.reach * rolling.outward);
    point.rest = half_gap;
    return point;
  }
  if (shape.kind != ShapeKind::cylinder && shape.kind != ShapeKind::cone) {
    point.core = rotate_inverse(orientation, arm);
    return point;
  }
  const Vec3 axis = rotate(orientation, rolling.axis);
  const Vec3 from_middle = on_surface - rotate(orientation, rolling.center);
  const float height = dot(from_middle, axis);
  const Vec3 across = from_middle - height * axis;
  const float radius = radius_at(shape, height);
  const Lowest lowest(rolling.outward, axis);
  point.on_rim = lowest.lean > kMinLean && dot(across, lowest.direction) >= kSameDirection * length(across) &&
                 absolute(length(across) - radius) <= kSameRadius * shape.radius;
  if (!point.on_rim) {
    point.core = rotate_inverse(orientation, arm);
    return point;
  }
  point.reach = length(across);
  point.core = rolling.center + height * rolling.axis;
  point.rest = arm - (rotate(orientation, point.core) + point.reach * lowest.direction);
  return point;
}

// True if the point runs so far round a rim in a step that one advance to its middle is too coarse.
bool runs_far(const RigidWorld& w, const ColliderShape& collider, const RollingSides& rolling, Vec3 outward,
              float seconds) {
  if (core_radius(collider.shape) > 0.0f) return false;
  const BodyMotion still;
  const BodyMotion& motion = w.bodies.motion[std::size_t(rolling.body)];
  const BodyMotion& other = rolling.other == kNoBody ? still : w.bodies.motion[std::size_t(rolling.other)];
  const Quat orientation = w.bodies.orientations[std::size_t(rolling.body)];
  const Vec3 axis = rotate(orientation, rotate(collider.body_from_shape.orientation, Vec3{0, 1, 0}));
  const float tilting = length(cross(motion.angular_velocity - other.angular_velocity, axis));
  return seconds * tilting > kMaxRound * Lowest(outward, axis).lean;
}

// True if motion of the contact point matters.
bool rolls(const RigidWorld& w, const Shape& shape, const RollingSides& rolling, float seconds) {
  const Vec3 spin = w.bodies.motion[std::size_t(rolling.body)].angular_velocity;
  const Vec3 other_spin =
      rolling.other == kNoBody ? Vec3{} : w.bodies.motion[std::size_t(rolling.other)].angular_velocity;
  if (!(seconds * length(spin - other_spin) > kMinTurn)) return false;
  if (shape.kind != ShapeKind::sphere || rolling.center != Vec3{}) return true;
  // Below a ball's centre the point is fixed for the ball, so only the other body can be affected.
  return rolling.other != kNoBody &&
         (other_spin != Vec3{} || w.bodies.inertia[std::size_t(rolling.other)].inverse_mass > 0.0f);
}

// True if the contact carried load in the last step, or touches already.
bool may_bear(const Manifold& manifold) {
  for (int k = 0; k < manifold.count; ++k) {
    if (manifold.points[k].normal_impulse > 0.0f || manifold.points[k].separation <= 0.0f) return true;
  }
  return false;
}

// Tells if a contact alone carries a body: it is the only one with load in the last step, or the only one at all. A body held from several
// sides does not roll on its rim, and there may be thousands.
class Bearers {
 public:
  // `pairs`: indices of the constraints' bodies in the batch. `bodies`: the number of bodies in it.
  Bearers(std::span<const ContactConstraint> constraints, std::span<const ColoringPair> pairs,
          std::size_t bodies, Arena& arena)
      : counts_(arena.make<Count>(bodies)) {
    for (Count& count : counts_) count = {};
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      for (const std::uint32_t place : {pairs[i].a, pairs[i].b}) {
        if (place == ColoringPair::kNone) continue;
        Count& count = counts_[place];
        count.all = std::uint8_t(count.all < 2 ? count.all + 1 : 2);
        count.loaded = std::uint8_t(count.loaded < 2 ? count.loaded + constraints[i].loaded : 2);
      }
    }
  }
  bool is_alone(const ContactConstraint& constraint, std::uint32_t place) const {
    if (place == ColoringPair::kNone) return false;
    const Count count = counts_[place];
    return constraint.loaded ? count.loaded == 1 : count.loaded == 0 && count.all == 1;
  }

 private:
  struct Count {
    std::uint8_t all = 0, loaded = 0;  // numbers of constraints, at most 2
  };
  std::span<Count> counts_;
};

// Finds the fast-spinning bodies of a batch, by index. A body beside a rotating kinematic one is left out: that one carries it along, and
// its surface moves.
class FastSpinningContacts {
 public:
  FastSpinningContacts(const RigidWorld& w, const ContactLists& lists, std::span<const std::uint32_t> bodies,
                       float seconds, Arena& arena)
      : fast_spinning_(arena.make<bool>(bodies.size())) {
    const auto spin = [&](std::size_t body) {
      return length_squared(w.bodies.motion[body].angular_velocity);
    };
    const float most = kFastSpin / seconds, carried = kCarried / seconds;  // rad/s
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      fast_spinning_[i] = spin(bodies[i]) > most * most;
      any_ = any_ || fast_spinning_[i];
    }
    if (!any_) return;
    for (std::size_t i = 0; i < lists.constraints.size(); ++i) {
      const ColoringPair places = lists.pairs[i];
      const auto look = [&](std::uint32_t place, std::uint32_t other_place, std::int32_t other) {
        if (has(place) && other_place == ColoringPair::kNone && other != kNoBody &&
            spin(std::size_t(other)) > carried * carried)
          fast_spinning_[place] = false;
      };
      look(places.a, places.b, lists.constraints[i].body_b);
      look(places.b, places.a, lists.constraints[i].body_a);
    }
  }
  bool has(std::uint32_t place) const {
    return any_ && place != ColoringPair::kNone && fast_spinning_[place];
  }
  bool has(ColoringPair places) const { return has(places.a) || has(places.b); }

 private:
  std::span<bool> fast_spinning_;
  bool any_ = false;
};

// Sets the body that moves the points, and returns its shape.
const ColliderShape& set_sides(const RigidWorld& w, const Contact& contact,
                               const ContactConstraint& constraint, bool is_b, RollingSides& rolling) {
  rolling.body = is_b ? constraint.body_b : constraint.body_a;
  rolling.other = is_b ? constraint.body_a : constraint.body_b;
  rolling.side = is_b ? 1.0f : -1.0f;
  const ColliderShape& collider = w.shapes.colliders[is_b ? contact.shape_b : contact.shape_a];
  rolling.center = collider.body_from_shape.position - w.bodies.masses[std::size_t(rolling.body)].center;
  return collider;
}

// Chooses the faster of two fast-spinning bodies, if its motion matters. A round body on a flat fast-spinning one rolls as on any other.
bool choose_fast_spinning(const RigidWorld& w, const Contact& contact, const ContactConstraint& constraint,
                          ColoringPair places, const FastSpinningContacts& is_fast_spinning, float seconds,
                          RollingSides& rolling) {
  const auto spin = [&](std::int32_t body) {
    return length_squared(w.bodies.motion[std::size_t(body)].angular_velocity);
  };
  const bool is_b = is_fast_spinning.has(places.b) &&
                    (!is_fast_spinning.has(places.a) || spin(constraint.body_b) >= spin(constraint.body_a));
  rolling.once = false;
  return rolls(w, set_sides(w, contact, constraint, is_b, rolling).shape, rolling, seconds);
}

// Chooses the body that rolls; false if none does.
bool choose_rolling(const RigidWorld& w, const Contact& contact, const ContactConstraint& constraint,
                    ColoringPair places, const Bearers& bearers, float seconds, RollingSides& rolling) {
  const bool flat_a = is_flat(w.shapes.colliders[contact.shape_a].shape);
  const ColliderShape& collider = set_sides(w, contact, constraint, flat_a, rolling);
  if (!rolls(w, collider.shape, rolling, seconds)) return false;
  const Vec3 outward = -rolling.side * constraint.manifold->normal;
  rolling.once = !bearers.is_alone(constraint, flat_a ? places.b : places.a) &&
                 !runs_far(w, collider, rolling, outward, seconds);
  return true;
}

void describe(const RigidWorld& w, const Contact& contact, const Manifold& manifold,
              RollingContact& rolling) {
  const bool is_b = rolling.side > 0.0f;
  const ColliderShape& collider = w.shapes.colliders[is_b ? contact.shape_b : contact.shape_a];
  rolling.axis = rotate(collider.body_from_shape.orientation, Vec3{0, 1, 0});
  rolling.outward = -rolling.side * manifold.normal;
  rolling.offset = rolling.side * (manifold.points[0].from_a - manifold.points[0].from_b);
  rolling.count = manifold.count;
  for (int k = 0; k < manifold.count; ++k) {
    const ContactPointState& point = manifold.points[k];
    rolling.points[k] =
        describe_point(collider.shape, rolling, w.bodies.orientations[std::size_t(rolling.body)],
                       is_b ? point.from_b : point.from_a, point.separation);
    rolling.on_rim = rolling.on_rim || rolling.points[k].on_rim;
    rolling.arms.now.from_a[k] = point.from_a;
    rolling.arms.now.from_b[k] = point.from_b;
  }
}

Quat turned_on(Quat q, Vec3 turn) {
  return normalized(Quat{0.5f * turn.x, 0.5f * turn.y, 0.5f * turn.z, 1.0f} * q);
}

// The change of a free body's angular velocity in a time at constant angular momentum, to first order, for rotations that are not too large
// for that.
Vec3 free_change(const RigidWorld& w, std::size_t body, Quat orientation, float seconds) {
  const BodyMass& mass = w.bodies.masses[body];
  if (mass.isotropic != 0 || w.bodies.flags[body].locked_angular != 0 || mass.inverse_mass == 0.0f) return {};
  const Vec3 spin = rotate_inverse(orientation, w.bodies.motion[body].angular_velocity);
  const float turn = seconds * length(spin);
  const float share = turn > kLargestTurn ? kLargestTurn / turn : 1.0f;
  return rotate(orientation, (share * seconds) * (mass.inverse_inertia * cross(mass.inertia * spin, spin)));
}

// The points of a contact at an orientation of the curved body.
struct PointsPlace {
  const RollingContact& rolling;
  Quat orientation;
  Vec3 lowest;  // of rims

  PointsPlace(const RollingContact& rolls, Quat q) : rolling(rolls), orientation(q) {
    if (rolls.on_rim) lowest = Lowest(rolls.outward, rotate(q, rolls.axis)).direction;
  }
  Vec3 arm_of(const RollingPoint& point) const {
    const Vec3 direction = point.on_rim ? lowest : rolling.outward;
    return rotate(orientation, point.core) + point.reach * direction + point.rest;
  }
};

// The share of the path to the middle of the sub-step at which impulses act. The leapfrog scheme at times gains energy if the contact runs
// far in a sub-step. Impulses at the place where speeds are taken lose energy.
float share_of_run(Vec3 arm, Vec3 middle_arm) {
  const float run = 2.0f * length(middle_arm - arm), most = kMaxRun * length(arm);
  return run > most ? min(run / most - 1.0f, 1.0f) : 0.0f;
}

}  // namespace

float contact_patch_spin_friction(const RigidWorld& w, const Contact& contact,
                                  const ContactConstraint& constraint) {
  if (constraint.manifold->count != 1) return 0.0f;
  const float a = core_radius(w.shapes.colliders[contact.shape_a].shape);
  const float b = core_radius(w.shapes.colliders[contact.shape_b].shape);
  if (a == 0.0f && b == 0.0f) return 0.0f;
  // Two balls touch like one ball of the combined curvature on a plane.
  const float radius = a == 0.0f ? b : b == 0.0f ? a : a * (b / (a + b));
  return constraint.dynamic_friction * kBallPatch * radius;
}

bool may_roll(const RigidWorld& w, const Contact& contact, const ContactConstraint& constraint) {
  if (contact.recycled != 0) return false;
  const bool flat_a = is_flat(w.shapes.colliders[contact.shape_a].shape);
  const bool flat_b = is_flat(w.shapes.colliders[contact.shape_b].shape);
  if (flat_a == flat_b) return false;
  return (flat_a ? constraint.body_b : constraint.body_a) != kNoBody && may_bear(*constraint.manifold);
}

RollingContacts find_rolling_contacts(RigidWorld& w, const ContactLists& lists,
                                      std::span<const std::uint32_t> bodies, float seconds, Arena& arena,
                                      TaskSystem& tasks) {
  const std::span<const ContactConstraint> constraints = lists.constraints;
  const auto contact_of = [&](std::uint32_t i) -> const Contact& {
    return w.contacts.contacts[lists.slots[i]];
  };
  RollingContacts all;
  const FastSpinningContacts is_fast_spinning(w, lists, bodies, seconds, arena);
  const auto may_roll = [&](std::uint32_t i) {
    return constraints[i].can_roll || is_fast_spinning.has(lists.pairs[i]);
  };
  const std::span<const std::uint32_t> candidates =
      parallel_filter(tasks, arena, constraints.size(), may_roll).list;
  const std::size_t count = candidates.size();
  if (count == 0) return all;
  const Bearers bearers(constraints, lists.pairs, bodies.size(), arena);
  const std::span<RollingSides> sides = arena.make<RollingSides>(count);
  for_blocks(tasks, int(count), kRollersPerBlock, [&](int begin, int end, int) {
    for (std::size_t k = std::size_t(begin); k < std::size_t(end); ++k) {
      const std::uint32_t i = candidates[k];
      const Contact& contact = contact_of(i);
      const ColoringPair places = lists.pairs[i];
      const bool flat_a = constraints[i].can_roll && is_flat(w.shapes.colliders[contact.shape_a].shape);
      const bool is_fast_spinning_here = !constraints[i].can_roll
                                             ? is_fast_spinning.has(places)
                                             : is_fast_spinning.has(flat_a ? places.b : places.a);
      const bool chosen =
          is_fast_spinning_here
              ? choose_fast_spinning(w, contact, constraints[i], places, is_fast_spinning, seconds, sides[k])
              : constraints[i].can_roll &&
                    choose_rolling(w, contact, constraints[i], places, bearers, seconds, sides[k]);
      sides[k].constraint = chosen ? i : kNotRolling;
    }
  });
  std::uint32_t found = 0;
  for (const RollingSides& each : sides)
    if (each.constraint != kNotRolling) sides[found++] = each;
  if (found == 0) return all;
  all.contacts = arena.make<RollingContact>(found);
  all.of_constraint = arena.make<std::uint32_t>(constraints.size());
  for (std::uint32_t& place : all.of_constraint) place = kNotRolling;
  for (std::uint32_t n = 0; n < found; ++n) {
    for (const std::int32_t body : {sides[n].body, sides[n].other})
      if (body != kNoBody) w.bodies.flags[std::size_t(body)].constraint_use = kPoseRead;
    all.of_constraint[sides[n].constraint] = n;
  }
  for_blocks(tasks, int(found), kRollersPerBlock, [&](int begin, int end, int) {
    for (std::size_t n = std::size_t(begin); n < std::size_t(end); ++n) {
      RollingContact& rolling = all.contacts[n] = {};
      static_cast<RollingSides&>(rolling) = sides[n];
      describe(w, contact_of(rolling.constraint), *constraints[rolling.constraint].manifold, rolling);
    }
  });
  return all;
}

// Reads no manifold, because manifolds are far apart in memory. The rolling contact holds all data by now.
void advance_contact_point(const RigidWorld& w, RollingContact& rolling, float ahead) {
  const std::size_t body = std::size_t(rolling.body);
  const BodyMotion still;
  const BodyMotion& motion = w.bodies.motion[body];
  const BodyMotion& other = rolling.other == kNoBody ? still : w.bodies.motion[std::size_t(rolling.other)];
  const Quat now = w.bodies.orientations[body];
  const PointsPlace place(rolling, now),
      middle_place(rolling, turned_on(now, ahead * motion.angular_velocity));
  const Vec3 offset = rolling.offset + (motion.delta_position - other.delta_position);
  const Vec3 middle_offset = offset + ahead * (motion.linear_velocity - other.linear_velocity);
  const auto put = [&](PointArmPairs& pairs, int k, Vec3 arm, Vec3 apart) {
    pairs.from_a[k] = rolling.side > 0.0f ? arm + apart : arm;
    pairs.from_b[k] = rolling.side > 0.0f ? arm : arm + apart;
  };
  AdvancedArms& arms = rolling.arms;
  arms.count = rolling.count;
  arms.before = arms.now;
  for (int k = 0; k < rolling.count; ++k) {
    const RollingPoint& point = rolling.points[k];
    const Vec3 arm = place.arm_of(point), middle_arm = middle_place.arm_of(point);
    const float share = rolling.once ? 1.0f : share_of_run(arm, middle_arm);
    put(arms.now, k, arm + share * (middle_arm - arm), offset + share * (middle_offset - offset));
    put(arms.middle, k, middle_arm, middle_offset);
    // The surfaces approach by the outward growth of the arm, less the part that is due to the rotation of the body.
    arms.separation[k] = point.first_separation - dot(arm - point.first_arm, rolling.outward) +
                         dot(cross(motion.delta_rotation, middle_arm), rolling.outward);
  }
  if (!rolling.once) rolling.drift = free_change(w, body, now, ahead);
}

}  // namespace gyre
