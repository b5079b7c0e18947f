// Worlds with their owners, and recorders. See hosts.h.
#include "web/bindings/hosts.h"

#include <emscripten.h>

namespace gyre::web {
int Answer::refused(World& world) {
  const std::span<const Problem> problems = world.problems();
  Error error = make_error(ErrorCode::invalid_argument, "refused");
  if (!problems.empty()) {
    error.code = problems.back().code;
    std::memcpy(error.message, problems.back().message, sizeof error.message);
  }
  return checked(error);
}

void Answer::borrowed(World& world) {
  if (host_->borrowed == nullptr) host_->borrowed = std::make_unique<BorrowedWorldHost>(world);
  static_cast<BorrowedWorldHost&>(*host_->borrowed).value = &world;
  pointer(static_cast<Host*>(host_->borrowed.get()));
}

Host* Answer::make_host(World world) { return new OwnWorldHost(std::move(world)); }

#if defined(__EMSCRIPTEN_PTHREADS__)
EM_JS(int, gyre_idle_workers, (), { return PThread.unusedWorkers.length; });
void limit_threads(WorldDef& def) {
  const int most = 1 + gyre_idle_workers();
  if (def.threads == 0 || def.threads > most) def.threads = most;
}
#else
void limit_threads(WorldDef&) {}
#endif

}  // namespace gyre::web

using namespace gyre;
using namespace gyre::web;

extern "C" {

// Arguments: whether options are given, and these. The answer: the recorder's handle; the world's host owns it.
EMSCRIPTEN_KEEPALIVE int gyre_recorder_start(Host* host) {
  Call call(host);
  Answer answer(host, 0);
  RecordOptions options;
  if (call.given()) get(call, options);
  WorldHost& world = *static_cast<WorldHost*>(host);
  if (world.recorder != nullptr) {
    return answer.checked(make_error(ErrorCode::busy, "record: this world is being recorded already"));
  }
  auto recorder = std::make_unique<RecorderHost>(world.world(), options);
  recorder->world_number = world.world_number;
  if (recorder->recorder.failed()) {
    return answer.checked(make_error(ErrorCode::invalid_argument,
                                     "record: commands or poses must be recorded, frame_interval and hash_interval are at least 1, "
                                     "and pose_accuracy from 1e-12 to 1e5 m"));
  }
  world.recorder = std::move(recorder);
  answer.pointer(static_cast<Host*>(world.recorder.get()));
  return answer.done();
}

// The bytes since the last call; `finish` closes the recording first, and the recorder is gone.
EMSCRIPTEN_KEEPALIVE int gyre_recorder_take(Host* host, int finish) {
  Answer answer(nullptr, 0);
  WorldHost& world = *static_cast<WorldHost*>(host);
  RecorderHost& recorder = static_cast<RecorderHost&>(*world.recorder);
  if (finish != 0) recorder.recorder.finish();
  answer.bytes(std::exchange(recorder.sink.bytes, {}));
  if (finish != 0) world.recorder.reset();
  return answer.done();
}

}  // extern "C"
