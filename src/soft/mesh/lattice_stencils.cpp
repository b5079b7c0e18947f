#include "soft/mesh/lattice_stencils.h"

#include <utility>

namespace gyre {
namespace {

constexpr std::uint8_t corner_node(int corner) { return std::uint8_t(5 * corner); }
constexpr std::uint8_t cut_node(int inside, int outside) { return std::uint8_t(4 * inside + outside); }

void add_tetrahedron(StencilTetrahedra& out, std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d,
                     bool mirrored) {
  if (mirrored) std::swap(c, d);
  auto& node = out.node[out.count++];
  node[0] = a, node[1] = b, node[2] = c, node[3] = d;
}

// True if the permutation of four corners is odd.
bool is_odd(int a, int b, int c, int d) {
  const int order[4] = {a, b, c, d};
  bool odd = false;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) odd ^= order[i] > order[j];
  }
  return odd;
}

// The face of the corners a and b inside and n outside keeps a quadrilateral. True if its diagonal goes from corner a to the cut point
// of b, false if it goes from b to that of a. Either joins the cut point of a long edge, or of two short ones, the even corner.
bool diagonal_from_first(int a, int b, int n, const bool (&even)[4]) {
  return is_long_edge(a, b) ? even[a] : is_long_edge(b, n);
}

// A prism of three columns, each from its top to its bottom. Diagonals of the sides leave the top of the column that `first` names
// before `second`, and that of `second` before `third`.
struct Prism {
  std::uint8_t top[3], bottom[3];
};
void add_prism(StencilTetrahedra& out, const Prism& p, int first, int second, int third, bool mirrored) {
  const std::uint8_t a = p.top[first], b = p.top[second], c = p.top[third];
  const std::uint8_t below_a = p.bottom[first], below_b = p.bottom[second], below_c = p.bottom[third];
  add_tetrahedron(out, a, b, c, below_c, mirrored);
  add_tetrahedron(out, a, b, below_c, below_b, mirrored);
  add_tetrahedron(out, a, below_a, below_b, below_c, mirrored);
}

// Three corners inside, n outside.
void cut_off_corner(StencilTetrahedra& out, const int (&in)[3], int n, const bool (&even)[4]) {
  Prism prism{};
  int leaves[3] = {};  // diagonals that leave the top of each column
  for (int i = 0; i < 3; ++i) {
    prism.top[i] = corner_node(in[i]);
    prism.bottom[i] = cut_node(in[i], n);
    for (int j = i + 1; j < 3; ++j) ++leaves[diagonal_from_first(in[i], in[j], n, even) ? i : j];
  }
  int order[3] = {};
  for (int i = 0; i < 3; ++i) order[2 - leaves[i]] = i;
  add_prism(out, prism, order[0], order[1], order[2], is_odd(in[order[0]], in[order[1]], in[order[2]], n));
}

// Corners a and b inside, c and d outside.
void cut_through_middle(StencilTetrahedra& out, int a, int b, int c, int d, const bool (&even)[4]) {
  const Prism prism{{corner_node(a), cut_node(a, c), cut_node(a, d)},
                    {corner_node(b), cut_node(b, c), cut_node(b, d)}};
  int leaves[3] = {};
  ++leaves[diagonal_from_first(a, b, c, even) ? 0 : 1];
  ++leaves[diagonal_from_first(a, b, d, even) ? 0 : 2];
  // The third side lies on the surface, where its diagonal meets no other.
  ++leaves[leaves[1] > leaves[2] ? 1 : leaves[2] > leaves[1] ? 2 : leaves[1] == 0 ? 1 : 2];
  int order[3] = {};
  for (int i = 0; i < 3; ++i) order[2 - leaves[i]] = i;
  const bool is_odd_order = order[0] == 0 ? order[1] == 2 : order[0] == 1 ? order[1] == 0 : order[1] == 1;
  // The columns in order, seen from the top, turn as a-c-d do: (a, c, d, b) has the handedness of (a, b, c, d).
  add_prism(out, prism, order[0], order[1], order[2], is_odd(a, c, d, b) != is_odd_order);
}

}  // namespace

StencilTetrahedra cut_lattice_tetrahedron(const std::int8_t (&side)[4], const bool (&even)[4]) {
  StencilTetrahedra out;
  int in[4] = {}, outside[4] = {}, on[4] = {}, ins = 0, outs = 0, ons = 0;
  for (int i = 0; i < 4; ++i) {
    if (side[i] > 0) in[ins++] = i;
    if (side[i] < 0) outside[outs++] = i;
    if (side[i] == 0) on[ons++] = i;
  }
  if (ins == 0) return out;
  if (outs == 0 || ins == 1) {
    std::uint8_t node[4];
    for (int i = 0; i < 4; ++i) node[i] = side[i] < 0 ? cut_node(in[0], i) : corner_node(i);
    add_tetrahedron(out, node[0], node[1], node[2], node[3], false);
  } else if (ins == 2 && outs == 1) {
    // A pyramid over the quadrilateral, its top on the surface.
    int a = in[0], b = in[1];
    const int n = outside[0];
    if (!diagonal_from_first(a, b, n, even)) std::swap(a, b);
    const bool mirrored = is_odd(a, b, n, on[0]);
    add_tetrahedron(out, corner_node(a), corner_node(b), cut_node(b, n), corner_node(on[0]), mirrored);
    add_tetrahedron(out, corner_node(a), cut_node(b, n), cut_node(a, n), corner_node(on[0]), mirrored);
  } else if (ins == 3) {
    cut_off_corner(out, {in[0], in[1], in[2]}, outside[0], even);
  } else {
    cut_through_middle(out, in[0], in[1], outside[0], outside[1], even);
  }
  return out;
}

}  // namespace gyre
