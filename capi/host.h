// The objects behind the handles of the C interface, and the last error of each thread.
#pragma once

#include <gyre/articulation.h>
#include <gyre/debug.h>
#include <gyre/gyre.h>
#include <gyre/replay.h>
#include <gyre/track.h>

#include <gyre/c/gyre.h>

#include <optional>
#include <string>
#include <vector>

// A world: its own, or one that something else owns (a replay, a scene, a batch).
struct GyreWorld {
  GyreWorld() = default;
  explicit GyreWorld(gyre::World world) : own(std::move(world)), value(&*own) {}
  ~GyreWorld();  // ends the recorders of the world
  GyreWorld(const GyreWorld&) = delete;
  GyreWorld& operator=(const GyreWorld&) = delete;

  std::optional<gyre::World> own;
  gyre::World* value = nullptr;
  std::vector<GyreRecorder*> recorders;
};

struct GyreGeometry {
  explicit GyreGeometry(gyre::Geometry geometry) : own(std::move(geometry)) {}
  gyre::Geometry own;
  gyre::Geometry* value = &own;
};

struct GyreRollback {
  explicit GyreRollback(gyre::Rollback rollback) : own(std::move(rollback)) {}
  gyre::Rollback own;
  gyre::Rollback* value = &own;
};

struct GyreReplay {
  explicit GyreReplay(gyre::Replay replay) : own(std::move(replay)) {}
  gyre::Replay own;
  gyre::Replay* value = &own;
  GyreWorld world;
};

struct GyrePoseTrack {
  explicit GyrePoseTrack(gyre::PoseTrack track) : own(std::move(track)) {}
  gyre::PoseTrack own;
  gyre::PoseTrack* value = &own;
};

// A function of the program as the destination of a recording.
struct GyreByteSink final : gyre::ByteSink {
  bool write(std::span<const std::byte> bytes) override {
    return function(user, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  GyreWriteFunction function = nullptr;
  void* user = nullptr;
};
// After the end of its world a recorder has no value, and its functions refuse.
struct GyreRecorder {
  ~GyreRecorder();

  GyreByteSink sink;  // outlives the recorder
  std::optional<gyre::Recorder> own;
  gyre::Recorder* value = nullptr;
  GyreWorld* world = nullptr;
};

namespace gyre::c {

// Each sets the last error of this thread.
void refuse_text(ErrorCode code, const std::string& text);
void refuse(const Error& error);
void refuse_null(const char* function);
void refuse_size(const char* name, std::size_t found, std::size_t most);
void refuse_command(const World& world);
GyreErrorCode checked(const Error& error);
inline GyreWorld* borrowed(GyreReplay& replay) {
  replay.world.value = &replay.value->world();
  return &replay.world;
}

}  // namespace gyre::c
