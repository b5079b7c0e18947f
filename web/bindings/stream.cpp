// Buffers of arguments and answers, handles, and the last error, for every module. See stream.h.
#include "web/bindings/stream.h"

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

}  // extern "C"
