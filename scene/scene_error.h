// What is wrong with a scene and where: the file, the place in it as a JSON pointer, what was found and what was expected.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace gyre {

struct SceneError {
  std::string file;
  int line = 0, column = 0;  // of text that is not JSON at all; 0 otherwise
  std::string pointer;       // RFC 6901: /bodies/3/shapes/0/radius; empty: the document as a whole
  std::string message;       // "found -1, expected a number above 0"

  // All of it on one line.
  std::string text() const {
    std::string out = file;
    if (line > 0) out += ":" + std::to_string(line) + ":" + std::to_string(column);
    if (!pointer.empty()) out += ": " + pointer;
    return out + ": " + message;
  }
};

// A value or what is wrong with the scene.
template <class T>
class [[nodiscard]] SceneResult {
 public:
  SceneResult(T value) : value_(std::move(value)) {}
  SceneResult(SceneError error) : error_(std::move(error)) {}

  explicit operator bool() const { return value_.has_value(); }
  T& operator*() & { return *value_; }
  const T& operator*() const& { return *value_; }
  T&& operator*() && { return std::move(*value_); }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }
  const SceneError& error() const { return error_; }

 private:
  std::optional<T> value_;
  SceneError error_;
};

}  // namespace gyre
