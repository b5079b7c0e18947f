// What the generated functions need besides the stream: worlds with their owners, recorders in memory.
#pragma once

#include "web/bindings/stream.h"

#include <gyre/replay.h>

namespace gyre::web {

struct OwnWorldHost final : WorldHost {
  explicit OwnWorldHost(World own) : value(std::move(own)) {}
  ~OwnWorldHost() override { recorder.reset(); }
  World& world() override { return value; }
  World value;
};

// The world inside a replay.
struct BorrowedWorldHost final : WorldHost {
  explicit BorrowedWorldHost(World& other) : value(&other) {}
  World& world() override { return *value; }
  World* value;
};

// Made by generate.py: only the fields that were given change.
void get(Call& call, Stepping& out);
void get(Call& call, RecordOptions& out);

struct MemorySink final : ByteSink {
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
};

// Owned by the host of the world that it records.
struct RecorderHost final : Host {
  RecorderHost(World& world, const RecordOptions& options) : recorder(world, sink, options) {}
  MemorySink sink;  // outlives the recorder
  Recorder recorder;
};

template <>
inline Recorder& object<Recorder>(Host* host) {
  return static_cast<RecorderHost*>(host)->recorder;
}

// Threads that JavaScript has ready for us. A world that asks for more gets these: a thread cannot start while the page's own
// thread waits for it.
void limit_threads(WorldDef& def);

}  // namespace gyre::web
