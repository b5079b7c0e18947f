// JSON text. See json_writer.h.
#include "scene/json_writer.h"

#include "scene/number_text.h"

namespace gyre {

void JsonWriter::new_line() {
  out_ += '\n';
  out_.append(2 * levels_.size(), ' ');
}

void JsonWriter::before_value() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) out_ += level.one_line ? ", " : ",";
  level.empty = false;
  if (!level.one_line) new_line();
}

void JsonWriter::begin(char bracket, JsonLayout layout) {
  before_value();
  out_ += bracket;
  const bool one_line = layout == JsonLayout::one_line || (!levels_.empty() && levels_.back().one_line);
  levels_.push_back({one_line, true});
}

void JsonWriter::end(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (!level.empty && !level.one_line) new_line();
  out_ += bracket;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  before_value();
  quote(name);
  out_ += ": ";
  after_key_ = true;
  return *this;
}

void JsonWriter::value(double number) {
  if (!is_finite(number)) return null();
  before_value();
  append_number(out_, number);
}

void JsonWriter::value(float number) {
  if (!is_finite(number)) return null();
  before_value();
  append_number(out_, number);
}

void JsonWriter::value(std::int64_t number) {
  before_value();
  out_ += std::to_string(number);
}

void JsonWriter::value(bool truth) {
  before_value();
  out_ += truth ? "true" : "false";
}

void JsonWriter::value(std::string_view text) {
  before_value();
  quote(text);
}

void JsonWriter::value(Vec3 v) {
  begin_array(JsonLayout::one_line);
  for (int axis = 0; axis < 3; ++axis) value(v[axis]);
  end_array();
}

void JsonWriter::value(DVec3 v) {
  begin_array(JsonLayout::one_line);
  for (int axis = 0; axis < 3; ++axis) value(v[axis]);
  end_array();
}

void JsonWriter::value(Quat q) {
  begin_array(JsonLayout::one_line);
  for (const float part : {q.x, q.y, q.z, q.w}) value(part);
  end_array();
}

void JsonWriter::value(const Sym3& m) {
  begin_array(JsonLayout::one_line);
  for (const float part : {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}) value(part);
  end_array();
}

void JsonWriter::null() {
  before_value();
  out_ += "null";
}

void JsonWriter::quote(std::string_view text) {
  constexpr char kHex[] = "0123456789abcdef";
  out_ += '"';
  for (const char c : text) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out_ += '\\';
      out_ += c;
    } else if (c == '\n') {
      out_ += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      out_ += "\\u00";
      out_ += kHex[byte >> 4];
      out_ += kHex[byte & 15];
    } else {
      out_ += c;
    }
  }
  out_ += '"';
}

std::string JsonWriter::take() {
  out_ += '\n';
  return std::move(out_);
}

}  // namespace gyre
