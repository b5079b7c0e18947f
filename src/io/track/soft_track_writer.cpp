// Encodes the vertices of frames. See soft_track_writer.h and soft_coder.h.
#include "io/track/soft_track_writer.h"

#include "base/hash.h"
#include "io/track/track_format.h"

#include <bit>

namespace gyre {

std::uint32_t SoftTrackWriter::surface_of(const SoftEntry& entry, Emit emit) {
  ByteWriter payload;
  write_track_soft(payload, entry.kind, entry.radius, std::uint32_t(entry.body.particles.count),
                   entry.triangles.view());
  const auto next = std::uint32_t(surface_numbers_.size());
  const std::uint64_t hash = hash_bytes(payload.view().data(), payload.size());
  const std::uint32_t number = surface_numbers_.find_or_insert(hash, next);
  if (number == next) emit(ChunkKind::track_soft, payload.view());
  return number;
}

// A vertex that is not finite keeps its last place, or the origin.
void SoftTrackWriter::round_vertices(const SoftEntry& entry, const TrackedSoft& old) {
  const Particles& p = entry.body.particles;
  next_.assign(std::size_t(p.count), RoundedVertex{});
  for (int i = 0; i < p.count; ++i) {
    const DVec3 place{p.x[i], p.y[i], p.z[i]};
    RoundedVertex& vertex = next_[std::size_t(i)];
    if (is_finite(place)) {
      for (int k = 0; k < 3; ++k) vertex[std::size_t(k)] = round_coordinate(place[k], steps_);
    } else if (old.now.size() == next_.size()) {
      vertex = old.now[std::size_t(i)];
    }
  }
}

// The coding with the fewest bits, by the sizes of the differences.
VertexCoding SoftTrackWriter::best_coding(const TrackedSoft& soft) const {
  if (soft.now == next_) return VertexCoding::still;
  std::uint64_t alone = 0, beside = 0;
  RoundedVertex last{};
  for (std::size_t i = 0; i < next_.size(); ++i) {
    const RoundedVertex inert = predict_vertex(soft, i, {});
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t error = next_[i][k] - inert[k];
      alone += std::uint64_t(std::bit_width(fold_sign(error)));
      beside += std::uint64_t(std::bit_width(fold_sign(error - last[k])));
      last[k] = error;
    }
  }
  return beside < alone ? VertexCoding::neighbor : VertexCoding::inertia;
}

bool SoftTrackWriter::write_soft(BitWriter& bits, const SoftStore& store, std::uint32_t index,
                                 std::uint64_t gap, TrackedSoft& soft, bool known, Emit emit) {
  const SoftEntry& entry = store.entries[index];
  round_vertices(entry, soft);
  // One that was torn has more vertices and another surface.
  known = known && soft.now.size() == next_.size();
  VertexCoding coding = known ? best_coding(soft) : VertexCoding::put;
  const std::uint32_t old_surface = soft.surface;
  if (!known) soft.surface = surface_of(entry, emit);
  const bool same_surface = soft.surface == old_surface;
  code_soft_head(bits, gap, coding);
  if (coding == VertexCoding::put) {
    soft.sizes[0] = soft.sizes[1] = soft.sizes[2] = -1;
    code_soft_put(bits, soft);
  }
  if (coding == VertexCoding::still) {
    keep_vertices(soft);
  } else {
    code_vertices(bits, coding, next_, soft);
  }
  return same_surface;
}

bool SoftTrackWriter::frame(const SoftStore& store, bool key, Emit emit) {
  if (store.empty() && softs_.empty()) return false;
  BitWriter bits;
  std::uint64_t count = store.ids.size();
  code_count(bits, count, 0);
  std::vector<TrackedSoft> present;
  present.reserve(store.ids.size());
  bool changed = softs_.size() != store.ids.size();
  std::size_t old = 0;
  std::uint64_t expected = 0;
  store.ids.for_each_live([&](std::uint32_t index) {
    const auto generation = std::uint16_t(store.ids.generation(index));
    while (old < softs_.size() && softs_[old].index < index) ++old;
    const bool existed =
        old < softs_.size() && softs_[old].index == index && softs_[old].generation == generation;
    TrackedSoft soft;
    if (existed) soft = std::move(softs_[old++]);
    soft.index = index;
    soft.generation = generation;
    if (!write_soft(bits, store, index, index - expected, soft, existed && !key, emit) || !existed)
      changed = true;
    expected = std::uint64_t(index) + 1;
    present.push_back(std::move(soft));
  });
  softs_ = std::move(present);
  if (!softs_.empty()) emit(ChunkKind::track_vertices, bits.take());
  return changed;
}

}  // namespace gyre
