#include "soft/solver/rigid_modes.h"

#include "math/dense.h"
#include "math/rotation.h"

namespace gyre {

namespace {

DVec3 row_of(const VectorRows& rows, int i) {
  return {double(rows.x[i]), double(rows.y[i]), double(rows.z[i])};
}

// The angular velocity that gives the angular momentum `momentum` with the inertia [xx, yy, zz, xy, xz, yz]. About an axis in which all
// mass lies there is none.
DVec3 turn_of(const double (&inertia)[6], DVec3 momentum) {
  const double matrix[3][3] = {{inertia[0], inertia[3], inertia[4]},
                               {inertia[3], inertia[1], inertia[5]},
                               {inertia[4], inertia[5], inertia[2]}};
  const Ldlt<3, double> factors = factor_ldlt(matrix, 1.0e-9);
  double turn[3] = {momentum.x, momentum.y, momentum.z};
  solve_ldlt(factors, turn);
  return {turn[0], turn[1], turn[2]};
}

// Of a body about its centre of mass: [xx, yy, zz, xy, xz, yz], kg m^2.
struct Inertia {
  double parts[6] = {};

  void add(double mass, DVec3 arm) {
    parts[0] += mass * (arm.y * arm.y + arm.z * arm.z);
    parts[1] += mass * (arm.x * arm.x + arm.z * arm.z);
    parts[2] += mass * (arm.x * arm.x + arm.y * arm.y);
    parts[3] -= mass * arm.x * arm.y;
    parts[4] -= mass * arm.x * arm.z;
    parts[5] -= mass * arm.y * arm.z;
  }
};
DVec3 turn_of(const Inertia& inertia, DVec3 momentum) { return turn_of(inertia.parts, momentum); }

// Sums over a piece.
struct PieceSums {
  double mass = 0.0;
  DVec3 origin{};  // its first particle, from which places are taken
  bool any = false;
  DVec3 first{}, linear{}, center{};
  Inertia inertia;
  DVec3 angular{};

  void add(double m, DVec3 place, DVec3 momentum) {
    if (!any) origin = place;
    any = true;
    mass += m;
    first += m * (place - origin);
    linear += momentum;
  }
  void set_center() { center = mass > 0.0 ? origin + first / mass : origin; }
};

}  // namespace

void keep_momentum(const SoftBody& body, const VectorRows& impulses, const VectorRows& change, double ahead,
                   const ByPiece<DVec3>& moments) {
  const Particles& particles = body.particles;
  const auto place = [&](int i) {
    return ahead == 0.0 ? particles.place(i)
                        : particles.place(i) + ahead * (DVec3(particles.velocity(i)) + row_of(change, i));
  };
  const auto missing = [&](int i) {
    return row_of(impulses, i) - double(particles.mass[i]) * row_of(change, i);
  };
  ByPiece<PieceSums> sums(body.pieces());
  for (int i = 0; i < particles.count; ++i)
    sums[body.piece_of(i)].add(double(particles.mass[i]), place(i), missing(i));
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k].set_center();
    sums[k].angular = moments[moments.size() == sums.size() ? k : 0];
  }
  for (int i = 0; i < particles.count; ++i) {
    PieceSums& piece = sums[body.piece_of(i)];
    const DVec3 arm = place(i) - piece.center;
    piece.inertia.add(double(particles.mass[i]), arm);
    piece.angular += cross(arm, missing(i));
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (sums[k].mass > 0.0) sums[k].linear = sums[k].linear / sums[k].mass;
    sums[k].angular = turn_of(sums[k].inertia, sums[k].angular);
  }
  for (int i = 0; i < particles.count; ++i) {
    const PieceSums& piece = sums[body.piece_of(i)];
    if (!(piece.mass > 0.0)) continue;
    const DVec3 more = piece.linear + cross(piece.angular, place(i) - piece.center);
    change.x[i] = float(double(change.x[i]) + more.x);
    change.y[i] = float(double(change.y[i]) + more.y);
    change.z[i] = float(double(change.z[i]) + more.z);
  }
}

void keep_linear_momentum(const Particles& particles, std::span<const CarriedInertia> carried,
                          const VectorRows& impulses, const VectorRows& change) {
  double mass[3][3] = {};
  DVec3 linear{};
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    for (int k = 0; k < 3; ++k) mass[k][k] += m;
    linear += row_of(impulses, i) - m * row_of(change, i);
  }
  for (const CarriedInertia& one : carried) {
    const Sym3& m = one.inertia;
    const float rows[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) mass[r][c] += double(rows[r][c]);
    linear = linear - DVec3(m * to_float(row_of(change, one.particle)));
  }
  double push[3] = {linear.x, linear.y, linear.z};
  solve_ldlt(factor_ldlt(mass), push);
  for (int i = 0; i < particles.count; ++i) {
    change.x[i] = float(double(change.x[i]) + push[0]);
    change.y[i] = float(double(change.y[i]) + push[1]);
    change.z[i] = float(double(change.z[i]) + push[2]);
  }
}

ByPiece<RigidMotion> rigid_motions(const SoftBody& body, double seconds) {
  const Particles& particles = body.particles;
  ByPiece<PieceSums> sums(body.pieces());
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    sums[body.piece_of(i)].add(m, particles.place(i), m * DVec3(particles.velocity(i)));
  }
  ByPiece<RigidMotion> motions(body.pieces());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k].set_center();
    motions[k].center = sums[k].center;
    if (sums[k].mass > 0.0) motions[k].velocity = sums[k].linear / sums[k].mass;
  }
  for (int i = 0; i < particles.count; ++i) {
    const std::size_t k = body.piece_of(i);
    const double m = double(particles.mass[i]);
    const DVec3 arm = particles.place(i) - motions[k].center;
    sums[k].inertia.add(m, arm);
    motions[k].momentum += m * cross(arm, DVec3(particles.velocity(i)) - motions[k].velocity);
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    RigidMotion& motion = motions[k];
    motion.spin = turn_of(sums[k].inertia, motion.momentum);
    const DQuat half = exponential_map(0.5 * seconds * motion.spin);
    motion.turn = seconds * rotate(half, turn_of(sums[k].inertia, rotate_inverse(half, motion.momentum)));
  }
  return motions;
}

void add_turning_forces(SoftBody& body) {
  Particles& particles = body.particles;
  const ByPiece<RigidMotion> motions = rigid_motions(body);
  ByPiece<PieceSums> sums(body.pieces());
  const auto centrifugal = [&](DVec3 spin, DVec3 arm) { return -cross(spin, cross(spin, arm)); };
  for (int i = 0; i < particles.count; ++i) {
    const std::size_t k = body.piece_of(i);
    const double m = double(particles.mass[i]);
    const DVec3 arm = particles.place(i) - motions[k].center;
    sums[k].inertia.add(m, arm);
    sums[k].angular += m * cross(arm, centrifugal(motions[k].spin, arm));
  }
  // rad/s^2, of the spin
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k].angular = turn_of(sums[k].inertia, sums[k].angular);
  for (int i = 0; i < particles.count; ++i) {
    const std::size_t k = body.piece_of(i);
    const DVec3 arm = particles.place(i) - motions[k].center;
    const DVec3 force =
        double(particles.mass[i]) * (centrifugal(motions[k].spin, arm) - cross(sums[k].angular, arm));
    particles.fx[i] += float(force.x), particles.fy[i] += float(force.y), particles.fz[i] += float(force.z);
  }
}

void turn_along_arcs(SoftBody& body, const ByPiece<RigidMotion>& motions, double seconds) {
  Particles& particles = body.particles;
  ByPiece<PieceSums> sums(body.pieces());
  ByPiece<DQuat> turns(body.pieces());
  for (std::size_t k = 0; k < motions.size(); ++k) {
    turns[k] = exponential_map(motions[k].turn);
    sums[k].center = motions[k].center + seconds * motions[k].velocity;
  }
  for (int i = 0; i < particles.count; ++i) {
    const std::size_t k = body.piece_of(i);
    const RigidMotion& motion = motions[k];
    // Before the move, and without the turning in it.
    const DVec3 velocity = DVec3(particles.velocity(i)) - motion.velocity;
    const DVec3 start = particles.place(i) - seconds * DVec3(particles.velocity(i)) - motion.center;
    const DVec3 own = velocity - cross(motion.spin, start);
    const DVec3 arm = rotate(turns[k], start + seconds * own);
    particles.set_place(i, sums[k].center + arm);
    particles.set_velocity(i, to_float(motion.velocity + rotate(turns[k], own)));
    sums[k].inertia.add(double(particles.mass[i]), arm);
  }
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k].angular = turn_of(sums[k].inertia, motions[k].momentum);
  for (int i = 0; i < particles.count; ++i) {
    const PieceSums& piece = sums[body.piece_of(i)];
    particles.set_velocity(
        i, to_float(DVec3(particles.velocity(i)) + cross(piece.angular, particles.place(i) - piece.center)));
  }
}

}  // namespace gyre
