#include "soft/elements/rope.h"

namespace gyre {

namespace {

void place_particles(std::span<const DVec3> points, int segments, Particles& particles) {
  particles.resize(segments + 1);
  if (segments + 1 == int(points.size())) {
    for (int i = 0; i <= segments; ++i) particles.set_place(i, points[std::size_t(i)]);
    return;
  }
  double whole = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k) whole += length(points[k] - points[k - 1]);
  std::size_t part = 1;
  double before = 0.0;  // along the line, to the start of the part
  for (int i = 0; i <= segments; ++i) {
    const double along = whole * i / segments;
    double span = length(points[part] - points[part - 1]);
    while (part + 1 < points.size() && before + span < along) {
      before += span;
      ++part;
      span = length(points[part] - points[part - 1]);
    }
    const double share = span > 0.0 ? min((along - before) / span, 1.0) : 0.0;
    particles.set_place(i, points[part - 1] + share * (points[part] - points[part - 1]));
  }
}

}  // namespace

SoftBody rope_along(std::span<const DVec3> points, int segments, const RopeMaterial& material) {
  SoftBody body;
  body.damping = material.damping;
  Particles& particles = body.particles;
  place_particles(points, segments, particles);
  Chain& chain = body.chain;
  chain.stretch_stiffness = material.keeps_length ? 0.0 : double(material.stretch_stiffness);
  chain.bend_stiffness = double(material.bend_stiffness);
  Array<Spring> springs;
  for (int s = 0; s < segments; ++s) {
    const double rest = length(particles.place(s + 1) - particles.place(s));
    chain.rest_length.push_back(rest);
    const float half = float(0.5 * double(material.linear_density) * rest);
    particles.mass[s] += half;
    particles.mass[s + 1] += half;
    springs.push_back(
        {std::uint32_t(s), std::uint32_t(s + 1), float(rest), material.stretch_stiffness / float(rest)});
  }
  chain.tension.assign(std::size_t(segments), 0.0);
  set_springs(body, springs);
  Array<MatrixEntry> entries;
  for (int i = 1; i < segments && material.bend_stiffness > 0.0f; ++i) {
    const double before = chain.rest_length[i - 1], after = chain.rest_length[i];
    const std::uint32_t three[3] = {std::uint32_t(i - 1), std::uint32_t(i), std::uint32_t(i + 1)};
    const double signs[3] = {1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after};
    add_quadratic(entries, three, signs, 2.0 * chain.bend_stiffness / (before + after));
  }
  if (!entries.empty()) set_bending(body, entries);
  return body;
}

}  // namespace gyre
