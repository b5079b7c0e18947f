// Writes JSON text: objects over several lines, or on one line where asked (vectors, small records).
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gyre {

enum class JsonLayout : std::uint8_t { lines, one_line };

// begin_/end_ pairs nest; inside an object each value is preceded by key(). Inside something on one line, all is on one line.
class JsonWriter {
 public:
  void begin_object(JsonLayout layout = JsonLayout::lines) { begin('{', layout); }
  void end_object() { end('}'); }
  void begin_array(JsonLayout layout = JsonLayout::lines) { begin('[', layout); }
  void end_array() { end(']'); }

  JsonWriter& key(std::string_view name);
  void value(double number);  // null if it is not finite
  void value(float number);
  void value(std::int64_t number);
  void value(int number) { value(std::int64_t(number)); }
  void value(bool truth);
  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(Vec3 v);
  void value(DVec3 v);
  void value(Quat q);
  void value(const Sym3& m);
  void null();

  template <class T>
  void field(std::string_view name, const T& v) {
    key(name).value(v);
  }

  // The text, with a final newline.
  std::string take();

 private:
  struct Level {
    bool one_line = false;
    bool empty = true;
  };
  void begin(char bracket, JsonLayout layout);
  void end(char bracket);
  void before_value();
  void new_line();
  void quote(std::string_view text);

  std::string out_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace gyre
