// Sums that stand for integrals.
#pragma once

namespace gyre {

// Where on [0, 1] a rule of Gauss and Legendre looks, and how much what it sees there counts.
struct QuadratureNode {
  double at, weight;
};

}  // namespace gyre
