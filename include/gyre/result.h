// Result<T>: what anything fed by outside data returns. Gyre throws no exceptions.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace gyre {

enum class ErrorCode : std::uint8_t {
  none,
  invalid_argument,  // a value is outside its allowed range, not finite, or contradicts another
  invalid_geometry,  // points or triangles that do not make the shape that was asked for
  invalid_data,      // bytes that are not a snapshot or recording, or a damaged one
  unsupported,       // data of a newer format, or a combination that Gyre does not have
  stale_id,          // the object of an id does not exist (any more), or is another world's
  busy,              // the world is in the middle of a step
  cancelled,         // a progress callback asked to stop
  unstable,          // an explicit scheme cannot follow what it is to compute: it will gain energy
};

// A code, and words that name the object, the field, what was found and what is allowed.
struct Error {
  ErrorCode code = ErrorCode::none;
  char message[232] = {};
};

// printf-style; text that does not fit is cut. Returns the error.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
Error make_error(ErrorCode code, const char* format, ...);

// A value or an error. `if (Result<World> made = World::create(...)) use(*made); else print(made.error().message);`
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(const Error& error) : error_(error) {}

  explicit operator bool() const { return value_.has_value(); }
  bool has_value() const { return value_.has_value(); }
  // The value. Only when there is one.
  T& operator*() & { return *value_; }
  const T& operator*() const& { return *value_; }
  T&& operator*() && { return std::move(*value_); }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }
  // The error; code none when there is a value.
  const Error& error() const { return error_; }

 private:
  std::optional<T> value_;
  Error error_;
};

}  // namespace gyre
