#include "soft/store/soft_strain.h"

#include "soft/body/element_stress.h"
#include "soft/store/soft_builder.h"

#include <cmath>

namespace gyre {

namespace {

// The products of two edges of a triangle with each other.
struct EdgeProducts {
  double aa, ab, bb;

  EdgeProducts(DVec3 at0, DVec3 at1, DVec3 at2) {
    const DVec3 a = at1 - at0, b = at2 - at0;
    aa = dot(a, a), ab = dot(a, b), bb = dot(b, b);
  }
};

// Squared stretches s solve det(now - s rest) = 0.
double strain_of(const EdgeProducts& rest, const EdgeProducts& now) {
  const double area = rest.aa * rest.bb - rest.ab * rest.ab;
  if (!(area > 0.0)) return 0.0;
  const double mean = 0.5 * (rest.aa * now.bb + rest.bb * now.aa - 2.0 * rest.ab * now.ab) / area;
  const double product = (now.aa * now.bb - now.ab * now.ab) / area;
  const double apart = std::sqrt(max(mean * mean - product, 0.0));
  const double high = std::sqrt(mean + apart) - 1.0, low = std::sqrt(max(mean - apart, 0.0)) - 1.0;
  return largest_of(high, low);
}

void add_cloth(const SoftEntry& entry, Array<float>& out) {
  const Array<DVec3> rest = whole_places(entry);
  const Particles& p = entry.body.particles;
  for (std::size_t t = 0; t < entry.triangles.size(); t += 3) {
    const std::uint32_t a = entry.triangles[t], b = entry.triangles[t + 1], c = entry.triangles[t + 2];
    const EdgeProducts before(rest[a], rest[b], rest[c]),
        now(p.place(int(a)), p.place(int(b)), p.place(int(c)));
    out.push_back(float(strain_of(before, now)));
  }
}

}  // namespace

Array<float> find_strains(const SoftEntry& entry) {
  Array<float> out;
  const Particles& p = entry.body.particles;
  switch (entry.kind) {
    case SoftKind::rope:
      for (int s = 0; s + 1 < p.count; ++s) {
        const double rest = entry.body.chain.rest_length[s];
        out.push_back(float(length(p.place(s + 1) - p.place(s)) / rest - 1.0));
      }
      break;
    case SoftKind::cloth:
      add_cloth(entry, out);
      break;
    case SoftKind::solid: {
      const Array<TetBlock>& blocks = entry.body.continuum.tetrahedra;
      for (std::size_t t = 0; t < blocks.size() * kTetLanes; ++t)
        if (blocks[t / kTetLanes].volume[t % kTetLanes] > 0.0f)
          out.push_back(float(largest_strain(entry.body, t)));
      break;
    }
  }
  return out;
}

}  // namespace gyre
