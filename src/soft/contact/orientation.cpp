#include "soft/contact/orientation.h"

namespace gyre {

namespace {

constexpr double kHalfUlp = 0x1p-53;                             // the largest relative error of one rounding
constexpr double kFilter3 = (7.0 + 56.0 * kHalfUlp) * kHalfUlp;  // relative error bound of a 3x3 determinant
constexpr double kFilter2 = (3.0 + 16.0 * kHalfUlp) * kHalfUlp;  // relative error bound of a 2x2 determinant

// A number as high + low, without rounding.
struct TwoDoubles {
  double high, low;
};

TwoDoubles exact_plus(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}
TwoDoubles exact_minus(double a, double b) { return exact_plus(a, -b); }

// Halves of 26 bits, so that their products are exact (Dekker).
TwoDoubles split(double a) {
  const double c = 0x1.0000002p27 * a, high = c - (c - a);
  return {high, a - high};
}
TwoDoubles exact_product(double a, double b) {
  const double product = a * b;
  const TwoDoubles p = split(a), q = split(b);
  const double error = ((product - p.high * q.high) - p.low * q.high) - p.high * q.low;
  return {product, p.low * q.low - error};
}

// A sum of doubles that do not overlap, the smallest first, none of them zero.
template <int Room>
struct Expansion {
  double term[Room];
  int count = 0;

  void push(double value) {
    if (value != 0.0) term[count++] = value;
  }
  int sign() const { return count == 0 ? 0 : term[count - 1] > 0.0 ? 1 : -1; }
};

Expansion<2> expand(TwoDoubles a) {
  Expansion<2> out;
  out.push(a.low);
  out.push(a.high);
  return out;
}

// Adds one double (Shewchuk's GROW-EXPANSION).
template <int Room>
void grow(Expansion<Room>& sum, double value) {
  double carry = value;
  int kept = 0;
  for (int i = 0; i < sum.count; ++i) {
    const TwoDoubles two = exact_plus(carry, sum.term[i]);
    carry = two.high;
    if (two.low != 0.0) sum.term[kept++] = two.low;
  }
  if (carry != 0.0) sum.term[kept++] = carry;
  sum.count = kept;
}

template <int A, int B>
Expansion<2 * A * B> product(const Expansion<A>& a, const Expansion<B>& b) {
  Expansion<2 * A * B> out;
  for (int i = 0; i < a.count; ++i) {
    for (int k = 0; k < b.count; ++k) {
      const TwoDoubles two = exact_product(a.term[i], b.term[k]);
      grow(out, two.low);
      grow(out, two.high);
    }
  }
  return out;
}

template <int A, int B>
Expansion<A + B> plus(const Expansion<A>& a, const Expansion<B>& b, double sign) {
  Expansion<A + B> out;
  for (int i = 0; i < a.count; ++i) out.push(a.term[i]);
  for (int i = 0; i < b.count; ++i) grow(out, sign * b.term[i]);
  return out;
}

int exact_orient3(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 corner[3] = {a, b, c};
  Expansion<2> x[3], y[3], z[3];
  for (int i = 0; i < 3; ++i) {
    x[i] = expand(exact_minus(corner[i].x, d.x));
    y[i] = expand(exact_minus(corner[i].y, d.y));
    z[i] = expand(exact_minus(corner[i].z, d.z));
  }
  const auto part = [&](int i, int j, int k) {
    return product(x[i], plus(product(y[j], z[k]), product(z[j], y[k]), -1.0));
  };
  return plus(plus(part(0, 1, 2), part(1, 2, 0), 1.0), part(2, 0, 1), 1.0).sign();
}

int sign_of(double value) { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; }

}  // namespace

int orient3(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 p = a - d, q = b - d, r = c - d;
  const double yz = q.y * r.z, zy = q.z * r.y;
  const double zx = r.y * p.z, xz = r.z * p.y;
  const double xy = p.y * q.z, yx = p.z * q.y;
  const double volume = p.x * (yz - zy) + q.x * (zx - xz) + r.x * (xy - yx);
  const double magnitude = (absolute(yz) + absolute(zy)) * absolute(p.x) +
                           (absolute(zx) + absolute(xz)) * absolute(q.x) +
                           (absolute(xy) + absolute(yx)) * absolute(r.x);
  if (absolute(volume) > kFilter3 * magnitude) return sign_of(volume);
  return exact_orient3(a, b, c, d);
}

int orient2(PlanePoint a, PlanePoint b, PlanePoint c) {
  const double left = (a.u - c.u) * (b.v - c.v), right = (a.v - c.v) * (b.u - c.u);
  const double area = left - right;
  if (absolute(area) > kFilter2 * (absolute(left) + absolute(right))) return sign_of(area);
  const auto side = [](double p, double q) { return expand(exact_minus(p, q)); };
  return plus(product(side(a.u, c.u), side(b.v, c.v)), product(side(a.v, c.v), side(b.u, c.u)), -1.0).sign();
}

}  // namespace gyre
