// Writes the ropes, cloths and solids of each frame of a track: their surfaces once, their vertices in every frame. It emits nothing
// for a world without them. It never changes the world.
#pragma once

#include "base/container/flat_map.h"
#include "base/function_ref.h"
#include "io/chunk/chunks.h"
#include "io/track/soft_coder.h"
#include "soft/store/soft_store.h"

namespace gyre {

class SoftTrackWriter {
 public:
  using Emit = FunctionRef<void(ChunkKind, std::span<const std::byte>)>;
  explicit SoftTrackWriter(PoseSteps steps) : steps_(steps) {}

  // Emits new surfaces, then the vertices of the frame. True if the set of bodies or their surfaces differs from that of the last frame.
  bool frame(const SoftStore& store, bool key, Emit emit);

 private:
  std::uint32_t surface_of(const SoftEntry& entry, Emit emit);
  void round_vertices(const SoftEntry& entry, const TrackedSoft& old);
  VertexCoding best_coding(const TrackedSoft& soft) const;
  bool write_soft(BitWriter& bits, const SoftStore& store, std::uint32_t index, std::uint64_t gap,
                  TrackedSoft& soft, bool known, Emit emit);

  PoseSteps steps_;
  std::vector<TrackedSoft> softs_;          // of the last frame, by index
  FlatMap<std::uint32_t> surface_numbers_;  // by hash of the written surface
  std::vector<RoundedVertex> next_;         // of the body in hand
};

}  // namespace gyre
