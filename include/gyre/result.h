// Result<T>: the return type of functions that take data from outside. Gyre throws no exceptions.
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
  unstable,          // what is computed is not to be relied on yet: an explicit scheme that gains energy, or soft matter that crosses
};

// An error code, and a message that names the object, the field, the value found and the range allowed. As a truth value it is
// true when there is an error: `if (const Error error = restore_snapshot(world, bytes)) print(error.message);`
struct Error {
  ErrorCode code = ErrorCode::none;
  char message[232] = {};

  constexpr explicit operator bool() const { return code != ErrorCode::none; }
  constexpr bool ok() const { return code == ErrorCode::none; }
};

// Makes an error with a message in the style of printf. A message that does not fit is cut.
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
Error make_error(ErrorCode code, const char* format, ...);

// Prints the error's message to stderr and ends the program.
[[noreturn]] void stop_at_error(const Error& error);

// A value or an error. `if (Result<World> made = World::create(...)) use(*made); else print(made.error().message);`
// Taking the value of an error prints the error and ends the program, in every build type.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(const Error& error) : error_(error) {}

  explicit operator bool() const { return value_.has_value(); }
  bool has_value() const { return value_.has_value(); }
  // The value; an error ends the program.
  T& operator*() & { return checked(value_); }
  const T& operator*() const& { return checked(value_); }
  T&& operator*() && { return std::move(checked(value_)); }
  T* operator->() { return &checked(value_); }
  const T* operator->() const { return &checked(value_); }
  // The error; its code is none when there is a value.
  const Error& error() const { return error_; }

 private:
  template <class Optional>
  auto& checked(Optional& value) const {
    if (!value.has_value()) stop_at_error(error_);
    return *value;
  }

  std::optional<T> value_;
  Error error_;
};

}  // namespace gyre
