// Nodes of quadrature rules.
#pragma once

namespace gyre {

// A node of a Gauss-Legendre rule on [0, 1], and its weight.
struct QuadratureNode {
  double at, weight;
};

}  // namespace gyre
