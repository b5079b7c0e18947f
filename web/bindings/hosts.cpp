// Handles, buffers, errors and recorders. See stream.h and hosts.h.
#include "web/bindings/hosts.h"

#include <emscripten.h>

#include <cstdlib>

namespace gyre::web {
namespace {

constexpr std::size_t kFirstDoubles = 8192;

std::vector<double>& arguments() {
  static std::vector<double> buffer(kFirstDoubles);
  return buffer;
}
std::vector<double>& answers() {
  static std::vector<double> buffer;
  return buffer;
}
Error& last_error() {
  static Error error;
  return error;
}

// By the lowest five bits: the latest world that has them.
std::uint16_t world_numbers[32] = {};

// Of functions without a host.
std::vector<std::unique_ptr<Store>>& free_stores() {
  static std::vector<std::unique_ptr<Store>> stores;
  return stores;
}

Store* store_of(Host* host, int function) {
  std::vector<std::unique_ptr<Store>>& stores = host != nullptr ? host->stores : free_stores();
  const std::size_t at = static_cast<std::size_t>(function);
  if (stores.size() <= at) stores.resize(at + 1);
  if (stores[at] == nullptr) stores[at] = std::make_unique<Store>();
  stores[at]->used = 0;
  return stores[at].get();
}

}  // namespace

Host* find_host(double handle) {
  return reinterpret_cast<Host*>(static_cast<std::uintptr_t>(handle));
}
std::uint16_t world_number_of(int low_bits) { return world_numbers[low_bits & 31]; }
void remember_world_number(std::uint16_t number) { world_numbers[number & 31] = number; }

double handle_of(std::uint32_t index, std::uint16_t generation, std::uint16_t world) {
  if (generation == 0) return 0.0;
  return double(index) + 4294967296.0 * (double(generation) + 65536.0 * double(world & 31));
}

Call::Call(Host* host) : host_(host), at_(arguments().data()) {}
Call::~Call() {
  for (void* memory : bytes_) std::free(memory);
}

std::span<const std::byte> Call::bytes() {
  void* const memory = reinterpret_cast<void*>(static_cast<std::uintptr_t>(next()));
  bytes_.push_back(memory);
  return {static_cast<const std::byte*>(memory), static_cast<std::size_t>(next())};
}

Answer::Answer(Host* host, int function) : host_(host), store_(store_of(host, function)) { answers().clear(); }

void Answer::number(double value) { answers().push_back(value); }

void Answer::bytes(std::vector<std::byte> bytes) {
  static std::vector<std::byte> kept;
  kept = std::move(bytes);
  pointer(kept.data());
  number(double(kept.size()));
}

void Answer::saw_world(std::uint16_t number) {
  if (number == 0) return;
  remember_world_number(number);
  if (host_ != nullptr) host_->world_number = number;
}

int Answer::done() {
  if (answers().empty()) answers().push_back(0.0);
  return static_cast<int>(reinterpret_cast<std::uintptr_t>(answers().data()));
}

int Answer::checked(const Error& error) {
  if (error.ok()) return done();
  last_error() = error;
  return 0;
}

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

// Room for so many doubles of arguments; returns the buffer's address, with what was in it.
EMSCRIPTEN_KEEPALIVE int gyre_arguments(int doubles) {
  std::vector<double>& buffer = arguments();
  if (buffer.size() < static_cast<std::size_t>(doubles)) buffer.resize(static_cast<std::size_t>(doubles));
  return static_cast<int>(reinterpret_cast<std::uintptr_t>(buffer.data()));
}

EMSCRIPTEN_KEEPALIVE int gyre_arguments_size() { return static_cast<int>(arguments().size()); }

EMSCRIPTEN_KEEPALIVE int gyre_allocate(int bytes) {
  return static_cast<int>(reinterpret_cast<std::uintptr_t>(std::malloc(static_cast<std::size_t>(bytes > 0 ? bytes : 1))));
}

EMSCRIPTEN_KEEPALIVE void gyre_free(void* memory) { std::free(memory); }

// Why the last function refused: code and text.
EMSCRIPTEN_KEEPALIVE int gyre_error() {
  Answer answer(nullptr, 0);
  answer.number(double(last_error().code));
  put_text(answer, last_error().message);
  return answer.done();
}

EMSCRIPTEN_KEEPALIVE void gyre_release(Host* host) { delete host; }

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
