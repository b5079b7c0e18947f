// How values cross the border to C. The functions for each struct are made by generate.py from the public headers.
//
// A plain value has the same bytes on both sides (static_assert says so) and is copied as bytes; arrays of plain values are handed over in
// place. take() fills a C++ value from a C one, give() the reverse. Answers with arrays are kept by the calling thread until its next call
// of the same function.
#pragma once

#include "capi/host.h"

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

namespace gyre {

namespace c {

// Arrays of C structs that an answer points to.
class Arena {
 public:
  template <class T>
  T* rows(std::size_t count) {
    if (count == 0) return nullptr;
    blocks_.push_back(std::make_unique<std::byte[]>(count * sizeof(T)));
    return new (blocks_.back().get()) T[count]{};
  }
  void clear() { blocks_.clear(); }

 private:
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
};

// An answer and its arrays. `In` lives on between calls, so that tables keep their memory.
template <class In, class Out>
struct Kept {
  In value{};
  Out out{};
  Arena arena;
};

template <class To, class From>
To same(const From& from) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}
template <class From, class To>
void copy(const From& from, To& to) {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To>);
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
}

// An array of plain values, in place.
template <class To, class From>
std::span<To> view(From* rows, std::size_t count) {
  static_assert(sizeof(To) == sizeof(From));
  return {reinterpret_cast<To*>(rows), rows != nullptr ? count : 0};
}

}  // namespace c

// These stand where templates below find them by their C++ arguments.
void take(const GyreAnyShape& in, AnyShape& out);
void give(const AnyShape& in, GyreAnyShape& out, c::Arena& arena);
void take(const GyreRecordOptions& in, RecordOptions& out);
void give(const RecordOptions& in, GyreRecordOptions& out, c::Arena& arena);
void take(const GyreMotor& in, Motor& out);

namespace c {

// ------------------------------------------------------------------------------------------------------- definitions

// The C struct with the default of every field.
template <class In, class Out>
Out default_of() {
  Arena arena;
  Out out{};
  give(In{}, out, arena);
  return out;
}

// Reads a definition that may be shorter than ours, because the caller was compiled with an earlier header. Null: the defaults.
template <class In, class Out>
bool take_definition(const In* in, Out& out, const char* name) {
  if (in == nullptr) return true;
  if (in->size < sizeof in->size || in->size > sizeof(In)) {
    refuse_size(name, in->size, sizeof(In));
    return false;
  }
  In whole = default_of<Out, In>();
  std::memcpy(static_cast<void*>(&whole), static_cast<const void*>(in), in->size);
  take(whole, out);
  return true;
}

// An array of definitions: all of the size of the first.
template <class In, class Out>
bool take_definitions(const In* rows, std::size_t count, std::vector<Out>& out, const char* name) {
  if (rows == nullptr) return true;
  out.resize(count);
  const std::size_t stride = count > 0 ? rows->size : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const void* const at = reinterpret_cast<const char*>(rows) + i * stride;
    if (!take_definition(static_cast<const In*>(at), out[i], name)) return false;
  }
  return true;
}

// Fills as much of a definition as the caller's header knows.
template <class In, class Out>
void give_definition(const In& in, Out* out, Arena& arena) {
  if (out == nullptr) return;
  Out whole{};
  give(in, whole, arena);
  const std::uint32_t size =
      out->size != 0 && out->size < sizeof(Out) ? out->size : std::uint32_t(sizeof(Out));
  whole.size = size;
  std::memcpy(static_cast<void*>(out), static_cast<const void*>(&whole), size);
}
template <class In, class Out>
void init_definition(Out* out, std::size_t size) {
  if (out == nullptr || size < sizeof out->size) return;
  Out whole = default_of<In, Out>();
  if (size > sizeof whole) std::memset(static_cast<void*>(out), 0, size);
  whole.size = static_cast<std::uint32_t>(size);
  std::memcpy(static_cast<void*>(out), static_cast<const void*>(&whole),
              size < sizeof whole ? size : sizeof whole);
}

template <class In, class Out>
void take_rows(const In* rows, std::size_t count, std::vector<Out>& out) {
  out.resize(rows != nullptr ? count : 0);
  for (std::size_t i = 0; i < out.size(); ++i) take(rows[i], out[i]);
}
template <class Out, class In>
const Out* give_rows(std::span<const In> in, Arena& arena) {
  Out* const rows = arena.rows<Out>(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) give(in[i], rows[i], arena);
  return rows;
}

// ----------------------------------------------------------------------------------------------------------- answers

inline void set_count(std::size_t* out, std::size_t count) {
  if (out != nullptr) *out = count;
}
// A command of the world: where it was refused, the reason becomes the last error.
template <class Out, class In>
Out command(World& world, const In& done) {
  if (!done) refuse_command(world);
  return same<Out>(done);
}
template <class Handle, class T>
Handle* made(Result<T> result) {
  if (result) return new Handle(*std::move(result));
  refuse(result.error());
  return nullptr;
}

}  // namespace c

}  // namespace gyre
