// Decodes vertices. See soft_coder.h.
#include "io/track/soft_coder.h"

namespace gyre {

namespace {

bool decode_vertices(BitReader& bits, VertexCoding coding, std::span<const std::uint32_t> vertex_counts,
                     TrackedSoft& soft) {
  if (coding == VertexCoding::put) {
    code_soft_put(bits, soft);
    if (bits.failed() || soft.surface >= vertex_counts.size()) return false;
  }
  if (coding == VertexCoding::still) {
    keep_vertices(soft);
    return true;
  }
  // A vertex takes three bits at least, so that a small file cannot ask for much memory.
  const std::uint32_t count = vertex_counts[soft.surface];
  if (3 * std::uint64_t(count) > bits.left()) return false;
  std::vector<RoundedVertex> next(count);
  return code_vertices(bits, coding, next, soft);
}

}  // namespace

bool decode_softs(std::span<const std::byte> bytes, std::span<const std::uint32_t> vertex_counts,
                  std::vector<TrackedSoft>& softs) {
  BitReader bits(bytes);
  std::uint64_t count = 0, index = 0;
  code_count(bits, count, 0);
  if (bits.failed() || count > bits.left()) return false;
  std::vector<TrackedSoft> next;
  std::size_t old = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t gap = 0;
    VertexCoding coding = VertexCoding::put;
    code_soft_head(bits, gap, coding);
    index += gap + (i > 0 ? 1 : 0);
    if (bits.failed() || index > 0xffffffffu) return false;
    while (old < softs.size() && softs[old].index < index) ++old;
    TrackedSoft soft;
    if (coding != VertexCoding::put) {
      if (old >= softs.size() || softs[old].index != index) return false;
      soft = std::move(softs[old++]);
    }
    soft.index = std::uint32_t(index);
    if (!decode_vertices(bits, coding, vertex_counts, soft)) return false;
    next.push_back(std::move(soft));
  }
  softs.swap(next);
  return bits.finished();
}

}  // namespace gyre
