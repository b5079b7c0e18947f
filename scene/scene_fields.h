// Checked access to a JSON document: a Field knows its value and its place, so that every refusal names the place, what was
// found and what was expected. Refusals are thrown as SceneError and caught where the scene folder ends.
#pragma once

#include "scene/json_document.h"
#include "scene/scene.h"

#include <gyre/math.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gyre {

// Allowed numbers.
struct Range {
  double low = -1.0e300, high = 1.0e300;
  bool open_low = false;  // low itself is not allowed

  static constexpr Range any() { return {}; }
  static constexpr Range above(double low) { return {low, 1.0e300, true}; }
  static constexpr Range at_least(double low) { return {low, 1.0e300, false}; }
  static constexpr Range between(double low, double high) { return {low, high, false}; }
  static constexpr Range above_to(double low, double high) { return {low, high, true}; }
  bool contains(double value) const { return (open_low ? value > low : value >= low) && value <= high; }
  std::string text() const;
};

constexpr double kFarthest = 1.0e12;    // m: how far from the origin the engine lets anything be
constexpr double kMaxSurface = 1.0e6;   // friction, damping and other factors
constexpr double kMaxDensity = 1.0e20;

// A word of the format and what it stands for; no value: a word of the format that this version does not have.
template <class T>
struct Choice {
  const char* word;
  std::optional<T> value;
};

class Field {
 public:
  // The whole document.
  Field(const Json& value, const std::string& file) : value_(&value), file_(&file) {}
  // Parts. The parent must outlive its children.
  Field(const Json& value, const Field& parent, std::string_view key)
      : value_(&value), file_(parent.file_), parent_(&parent), key_(key) {}
  Field(const Json& value, const Field& parent, std::size_t index)
      : value_(&value), file_(parent.file_), parent_(&parent), index_(index), in_array_(true) {}

  const Json& json() const { return *value_; }
  const std::string& file() const { return *file_; }
  std::string pointer() const;
  // The value in a few words: -1, "metal", an array of 3, an object.
  std::string found() const;

  [[noreturn]] void fail(std::string message) const;
  [[noreturn]] void expected(const std::string& what) const;       // found X, expected `what`
  [[noreturn]] void not_supported(const std::string& what) const;  // `what` is not supported by this version

  bool is_null() const { return value_->is_null(); }
  bool boolean() const;
  double number(Range range = Range::any()) const;
  float real(Range range = Range::any()) const;  // a float: must fit one
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  const std::string& text() const;
  std::string name(std::size_t longest) const;  // not empty, no control characters
  Vec3 vec3(Range range = Range::any()) const;
  DVec3 place() const;       // a point in the world, within the engine's reach
  Quat orientation() const;  // [x, y, z, w], {"axis", "angle"} or {"euler_xyz"}
  SceneColor color() const;  // "#rrggbb"

  // An array, of `size` elements if that is not negative.
  std::size_t array(const char* what, std::int64_t size = -1) const;
  Field element(std::size_t index) const { return Field((*value_)[index], *this, index); }

  template <class T>
  T choice(std::initializer_list<Choice<T>> choices) const {
    std::string words;
    for (const Choice<T>& one : choices) {
      if (value_->is_string() && value_->get_ref<const std::string&>() == one.word) {
        if (one.value) return *one.value;
        not_supported("\"" + std::string(one.word) + "\"");
      }
      words += (words.empty() ? "\"" : ", \"") + std::string(one.word) + "\"";
    }
    expected("one of " + words);
  }

 private:
  const Json* value_;
  const std::string* file_;
  const Field* parent_ = nullptr;
  std::string_view key_;
  std::size_t index_ = 0;
  bool in_array_ = false;
};

// The members of an object. Every key that is asked for is a known one; finish() refuses the others.
class Members {
 public:
  Members(const Field& field, const char* what);

  // Absent: none. Null counts as absent only with find_value.
  std::optional<Field> find(const char* key);
  std::optional<Field> find_value(const char* key);
  Field need(const char* key);
  // Known to the format, but meaningless here: refused unless it is null.
  void refuse(const char* key, const char* why);
  void finish() const;

  // Leave the default in place when the member is absent.
  void read(const char* key, bool& out);
  void read(const char* key, double& out, Range range = Range::any());
  void read(const char* key, float& out, Range range = Range::any());
  void read(const char* key, Vec3& out);
  void read(const char* key, Quat& out);
  // Null and absent mean none.
  void read(const char* key, std::optional<float>& out, Range range = Range::any());
  void read(const char* key, std::optional<SceneColor>& out);

 private:
  const Json* lookup(const char* key);

  const Field* field_;
  const char* what_;
  std::vector<std::string_view> known_;
};

}  // namespace gyre
