#include "solver/rest/resting_tree.h"

#include "math/rotation.h"

namespace gyre {

namespace {

// 1/s, at which errors of position are removed.
constexpr float kErrorRate = 10.0f;
// Separation at rest, as a share of the size: nearer points need no correction.
constexpr float kMaxRestSeparation = 1.0e-6f;

// Shares >= 0 of the points of a patch that put the centre of pressure at (x, y) of the contact plane: their
// sum is 1 and their mean point is (x, y). False if it lies outside the patch.
bool share_pressure(const float (&px)[4], const float (&py)[4], int count, float x, float y, float (&shares)[4]) {
  for (float& share : shares) share = 0.0f;
  // The most even shares first: 1/n each plus a linear function of the position.
  float mx = 0.0f, my = 0.0f;
  for (int k = 0; k < count; ++k) mx += px[k], my += py[k];
  mx /= float(count), my /= float(count);
  float xx = 0.0f, yy = 0.0f, xy = 0.0f;
  for (int k = 0; k < count; ++k) {
    const float dx = px[k] - mx, dy = py[k] - my;
    xx += dx * dx, yy += dy * dy, xy += dx * dy;
  }
  const float det = xx * yy - xy * xy;
  if (!(det > 1.0e-6f * square(xx + yy))) return false;
  const float a = (yy * (x - mx) - xy * (y - my)) / det;
  const float b = (xx * (y - my) - xy * (x - mx)) / det;
  bool even = true;
  for (int k = 0; k < count; ++k) {
    shares[k] = 1.0f / float(count) + a * (px[k] - mx) + b * (py[k] - my);
    even = even && shares[k] >= 0.0f;
  }
  if (even) return true;
  // Near the rim: the triangle of points around (x, y) with the largest smallest share.
  float best = -1.0e-6f;
  bool found = false;
  float chosen[4] = {};
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        const float area = (px[j] - px[i]) * (py[k] - py[i]) - (px[k] - px[i]) * (py[j] - py[i]);
        if (absolute(area) <= 1.0e-6f * (xx + yy)) continue;
        const float v = ((x - px[i]) * (py[k] - py[i]) - (px[k] - px[i]) * (y - py[i])) / area;
        const float w = ((px[j] - px[i]) * (y - py[i]) - (x - px[i]) * (py[j] - py[i])) / area;
        const float u = 1.0f - v - w;
        const float smallest = min(u, min(v, w));
        if (smallest < best) continue;
        best = smallest;
        found = true;
        for (float& share : chosen) share = 0.0f;
        chosen[i] = max(u, 0.0f), chosen[j] = max(v, 0.0f), chosen[k] = max(w, 0.0f);
      }
    }
  }
  for (int k = 0; k < 4; ++k) shares[k] = chosen[k];
  return found;
}

// The arm of a contact point on the node's body.
Vec3 arm_of(const TreeNode& node, const ContactConstraint& constraint, int k) {
  const ContactPointState& point = constraint.manifold->points[k];
  return node.sign > 0.0f ? point.from_b : point.from_a;
}

// The wrench (force and torque impulse about the contact's first anchor) of the contact's impulses on B.
void current_wrench(const ContactImpulse& impulse, const ContactConstraint& constraint, Vec3 origin,
                    Vec3& force, Vec3& torque) {
  const Manifold& manifold = *constraint.manifold;
  force = impulse.friction;
  torque = cross(impulse.friction_from_b - origin, impulse.friction) + impulse.twist * manifold.normal + impulse.rolling;
  for (int k = 0; k < manifold.count; ++k) {
    const Vec3 p = impulse.normal[k] * manifold.normal;
    force += p;
    torque += cross(manifold.points[k].from_b - origin, p);
  }
}

// Finds impulses of points, friction and twist with this wrench on B about `origin`; false if the contact
// cannot carry it.
bool solve_wrench(const ContactConstraint& constraint, Vec3 origin, Vec3 force, Vec3 torque,
                  ContactImpulse& impulse) {
  const Manifold& manifold = *constraint.manifold;
  const Vec3 n = manifold.normal;
  const float load = dot(force, n);
  if (!(load > 0.0f)) return false;
  const Vec3 tangential = force - load * n;
  const Vec3 u = any_perpendicular(n), v = cross(n, u);
  float px[4] = {}, py[4] = {};
  float height = 0.0f;
  for (int k = 0; k < manifold.count; ++k) {
    const Vec3 p = manifold.points[k].from_b - origin;
    px[k] = dot(p, u), py[k] = dot(p, v);
    height += dot(p, n) / float(manifold.count);
  }
  // The normal impulses act at (x, y), the tangential one at (x, y, height): torque = r x force.
  const float x = (height * dot(tangential, u) - dot(torque, v)) / load;
  const float y = (height * dot(tangential, v) + dot(torque, u)) / load;
  float shares[4];
  if (!share_pressure(px, py, manifold.count, x, y, shares)) return false;
  // The twist that remains with the friction at the kernels' centre of friction.
  const Vec3 at = impulse.friction_from_b - origin;
  const float twist = dot(torque, n) - dot(cross(at, tangential), n);
  const float slide = constraint.static_friction * load;
  const float twist_limit = impulse.twist_per_normal * load;
  if (!(slide > 0.0f) && length_squared(tangential) > 0.0f) return false;
  const float slide_use = slide > 0.0f ? length_squared(tangential) / square(slide) : 0.0f;
  const float twist_use = twist_limit > 0.0f ? square(twist / twist_limit) : (absolute(twist) > 1.0e-6f * load ? 2.0f : 0.0f);
  if (slide_use + twist_use > 1.0f) return false;
  for (int k = 0; k < 4; ++k) impulse.normal[k] = load * shares[k];
  impulse.friction = tangential;
  impulse.twist = twist_limit > 0.0f ? twist : 0.0f;
  impulse.rolling = {};
  return true;
}

TreeCorrection correction_of(const ContactConstraint& constraint, const BodyMotion* a, const BodyMotion* b) {
  const Manifold& manifold = *constraint.manifold;
  const Vec3 n = manifold.normal;
  const int count = manifold.count;
  TreeCorrection c;
  float separations[4] = {};
  float mean = 0.0f;
  for (int k = 0; k < count; ++k) {
    const ContactPointState& point = manifold.points[k];
    Vec3 displacement;
    if (b != nullptr) displacement += b->delta_position + cross(b->delta_rotation, point.from_b);
    if (a != nullptr) displacement -= a->delta_position + cross(a->delta_rotation, point.from_a);
    separations[k] = point.separation + dot(displacement, n);
    mean += separations[k] / float(count);
    c.middle += (1.0f / float(count)) * point.from_b;
  }
  const Vec3 u = any_perpendicular(n), v = cross(n, u);
  float xx = 0.0f, yy = 0.0f, xy = 0.0f, xs = 0.0f, ys = 0.0f;
  for (int k = 0; k < count; ++k) {
    const Vec3 p = manifold.points[k].from_b - c.middle;
    const float x = dot(p, u), y = dot(p, v), s = separations[k] - mean;
    xx += x * x, yy += y * y, xy += x * y, xs += x * s, ys += y * s;
  }
  const float det = xx * yy - xy * xy;
  c.velocity = clamp(-kErrorRate * mean, -constraint.pushout_speed, constraint.pushout_speed) * n;
  if (det > 0.0f) {
    // s = slope_u x + slope_v y; a tilt w gives w x p . n = w . (p x n).
    const float slope_u = (yy * xs - xy * ys) / det, slope_v = (xx * ys - xy * xs) / det;
    c.tilt = -kErrorRate * (slope_v * u - slope_u * v);
  }
  return c;
}

// True if the iterations left every body practically at rest, in position.
bool is_at_rest(const RestingTree& tree, const TreeSolve& s) {
  for (std::uint32_t i = tree.begin; i < tree.end; ++i) {
    const TreeNode& node = s.nodes[i];
    const BodyMotion& motion = s.motion[node.body];
    if (largest(absolute(motion.linear_velocity)) > node.rest_speed ||
        largest(absolute(motion.angular_velocity)) > node.rest_spin) {
      return false;
    }
    const ContactConstraint& constraint = s.constraints[node.constraint];
    for (int k = 0; k < constraint.manifold->count; ++k) {
      if (absolute(constraint.manifold->points[k].separation) > kMaxRestSeparation * constraint.size)
        return false;
    }
  }
  return true;
}

void halt_tree(const RestingTree& tree, const TreeSolve& s) {
  for (std::uint32_t i = tree.begin; i < tree.end; ++i) {
    BodyMotion& motion = s.motion[s.nodes[i].body];
    motion.linear_velocity = motion.angular_velocity = {};
  }
}

}  // namespace

void solve_tree(const RestingTree& tree, const TreeSolve& s) {
  if (is_at_rest(tree, s)) return halt_tree(tree, s);
  const DVec3 base = s.nodes[tree.begin].center;
  for (std::uint32_t i = tree.begin; i < tree.end; ++i) {
    const TreeNode& node = s.nodes[i];
    const ContactConstraint& constraint = s.constraints[node.constraint];
    const BodyMotion& motion = s.motion[node.body];
    TreeScratch& work = s.work[i];
    const DVec3 arm(arm_of(node, constraint, 0));
    work.point = node.center - base + arm;
    work.momentum = double(node.mass) * DVec3(motion.linear_velocity);
    const Sym3 inertia = rotate_inertia(node.orientation, node.inertia);
    work.spin = DVec3(inertia * motion.angular_velocity) - cross(arm, work.momentum);
  }
  // Leaves to root: sums the momentum beyond each contact, about that contact.
  for (std::uint32_t i = tree.end; i-- > tree.begin;) {
    const TreeNode& node = s.nodes[i];
    TreeScratch& work = s.work[i];
    const ContactConstraint& constraint = s.constraints[node.constraint];
    s.kernels->read_impulse(s.blocks, int(node.block), int(node.lane), work.impulse);
    // The change that stops the subtree acts on the node's body; the manifold counts impulses on B.
    const Vec3 origin = constraint.manifold->points[0].from_b;
    Vec3 force, torque;
    current_wrench(work.impulse, constraint, origin, force, torque);
    force -= node.sign * to_float(work.momentum);
    torque -= node.sign * to_float(work.spin);
    if (!solve_wrench(constraint, origin, force, torque, work.impulse)) return;
    if (node.parent >= 0) {
      TreeScratch& below = s.work[std::size_t(node.parent)];
      below.momentum += work.momentum;
      below.spin += work.spin + cross(work.point - below.point, work.momentum);
    }
  }
  // Root to leaves: writes the impulses, and finds velocities that remove errors of position. They are
  // applied as displacements over the step, and the velocities are zero.
  for (std::uint32_t i = tree.begin; i < tree.end; ++i) {
    const TreeNode& node = s.nodes[i];
    TreeScratch& work = s.work[i];
    const ContactConstraint& constraint = s.constraints[node.constraint];
    s.kernels->write_impulse(s.blocks, int(node.block), int(node.lane), work.impulse);
    const BodyMotion* a = constraint.body_a == kNoBody ? nullptr : &s.motion[constraint.body_a];
    const BodyMotion* b = constraint.body_b == kNoBody ? nullptr : &s.motion[constraint.body_b];
    work.correction = correction_of(constraint, a, b);
  }
  for (std::uint32_t i = tree.begin; i < tree.end; ++i) {
    const TreeNode& node = s.nodes[i];
    TreeScratch& work = s.work[i];
    const ContactConstraint& constraint = s.constraints[node.constraint];
    Vec3 linear, angular;
    if (node.parent >= 0) {
      const TreeScratch& below = s.work[std::size_t(node.parent)];
      const Vec3 offset = difference(node.center, s.nodes[std::size_t(node.parent)].center);
      angular = below.angular;
      linear = below.linear + cross(angular, offset);
    }
    // The correction is that of B against A at the middle of the patch; `middle_own` is the middle from the
    // body's centre.
    const TreeCorrection& c = work.correction;
    const Vec3 middle_own = c.middle + arm_of(node, constraint, 0) - constraint.manifold->points[0].from_b;
    const Vec3 tilt = node.sign * c.tilt;
    work.linear = linear + node.sign * c.velocity + cross(tilt, -middle_own);
    work.angular = angular + tilt;
    BodyMotion& motion = s.motion[node.body];
    motion.linear_velocity = motion.angular_velocity = {};
    motion.delta_position += s.step * work.linear;
    motion.delta_rotation += s.step * work.angular;
  }
}

}  // namespace gyre
