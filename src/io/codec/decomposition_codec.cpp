// Decompositions as bytes: a mark, the key, the report, the hulls, and a hash of all of these. See
// gyre/decomposition.h.
#include "base/hash.h"
#include "io/codec/bytes.h"
#include "io/codec/geometry_codec.h"

#include <gyre/decomposition.h>

namespace gyre {
namespace {

constexpr std::uint64_t kMark = 0x31'50'4d'43'44'52'59'47u;  // "GYRDCMP1"

Error bad_decomposition(const char* what) {
  return make_error(ErrorCode::invalid_data, "decomposition: %s", what);
}

// Calls visit(field) for every number of the report, in the order of the file.
template <class Report, class Visit>
void each_field(Report& r, Visit&& visit) {
  visit(r.mesh.open_edges);
  visit(r.mesh.non_manifold_edges);
  visit(r.mesh.flipped_triangles);
  visit(r.mesh.degenerate_triangles);
  visit(r.mesh.openness);
  visit(r.mesh.shell);
  visit(r.size);
  visit(r.shell_thickness);
  visit(r.overhang);
  visit(r.overhang_bound);
  visit(r.depth);
  visit(r.uncovered);
  visit(r.sample_spacing);
  visit(r.solid_volume);
  visit(r.hull_volume);
  visit(r.excess_volume);
  visit(r.missing_volume);
  visit(r.within_concavity);
}

}  // namespace

std::vector<std::byte> save_decomposition(const Decomposition& decomposition, std::uint64_t key) {
  ByteWriter out;
  out.put(kMark);
  out.put(key);
  each_field(decomposition.stats, [&](auto field) { out.put(field); });
  out.put(std::uint64_t(decomposition.hulls.size()));
  for (const Geometry& hull : decomposition.hulls) write_geometry(out, hull);
  out.put(hash_bytes(out.view().data(), out.size()));
  return out.take();
}

Result<Decomposition> load_decomposition(std::span<const std::byte> bytes, std::uint64_t key) {
  constexpr std::size_t kHash = 8;
  if (bytes.size() < 3 * kHash) return bad_decomposition("the bytes end too soon");
  const std::span<const std::byte> content = bytes.first(bytes.size() - kHash);
  ByteReader in(content);
  if (in.get<std::uint64_t>() != kMark)
    return bad_decomposition("these bytes are none, or of another version");
  if (in.get<std::uint64_t>() != key)
    return bad_decomposition("these bytes are of another mesh, other settings or another version");
  if (load_little<std::uint64_t>(bytes.data() + content.size()) != hash_bytes(content.data(), content.size()))
    return bad_decomposition("the bytes are damaged");
  Decomposition out;
  each_field(out.stats, [&](auto& field) { field = in.get<std::remove_reference_t<decltype(field)>>(); });
  const std::size_t count = in.get_count(1 + 2 * sizeof(std::uint64_t));
  const GeometryTable none;
  for (std::size_t i = 0; i < count; ++i) {
    const Result<Geometry> hull = read_geometry(in, none);
    if (!hull) return hull.error();
    if (hull->kind() != ShapeKind::hull) return bad_decomposition("something in it is no hull");
    out.hulls.push_back(*hull);
  }
  if (in.failed() || !in.finished()) return bad_decomposition("the bytes are not what they say");
  return out;
}

}  // namespace gyre
