// Checked access to a JSON document. See scene_fields.h.
#include "scene/scene_fields.h"

#include "scene/number_text.h"

#include <algorithm>
#include <limits>

namespace gyre {
namespace {

std::string number_text(double value) {
  std::string out;
  append_rounded(out, value, 9);
  return out;
}

// How many single-letter changes lead from one word to the other (V. Levenshtein, 1965).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string Range::text() const {
  const bool has_high = high < 1.0e300;
  if (low <= -1.0e300 && !has_high) return "a number";
  if (!has_high) return (open_low ? "a number above " : "a number of at least ") + number_text(low);
  return std::string(open_low ? "a number above " : "a number from ") + number_text(low) +
         (open_low ? " and at most " : " to ") + number_text(high);
}

// ------------------------------------------------------------------------------------------------------------- places

std::string Field::pointer() const {
  std::vector<const Field*> path;
  for (const Field* at = this; at->parent_; at = at->parent_) path.push_back(at);
  std::string out;
  for (std::size_t i = path.size(); i-- > 0;) {
    if (path[i]->in_array_) {
      out += "/" + std::to_string(path[i]->index_);
    } else {
      append_pointer(out, path[i]->key_);
    }
  }
  return out;
}

std::string Field::found() const {
  const Json& v = *value_;
  if (v.is_array()) return "an array of " + std::to_string(v.size());
  if (v.is_object()) return v.empty() ? "an empty object" : "an object";
  if (v.is_number_float()) return number_text(v.get<double>());
  if (!v.is_string()) return v.dump();
  const std::string& text = v.get_ref<const std::string&>();
  constexpr std::size_t kShown = 48;
  std::string out = "\"";
  for (const char c : std::string_view(text).substr(0, kShown)) {
    const unsigned char byte = static_cast<unsigned char>(c);
    out += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return out + (text.size() > kShown ? "...\"" : "\"");
}

void Field::fail(std::string message) const { throw SceneError{*file_, 0, 0, pointer(), std::move(message)}; }
void Field::expected(const std::string& what) const { fail("found " + found() + ", expected " + what); }
void Field::not_supported(const std::string& what) const {
  fail(what + " is not supported by this version of Gyre");
}

// ------------------------------------------------------------------------------------------------------------- values

bool Field::boolean() const {
  if (!value_->is_boolean()) expected("true or false");
  return value_->get<bool>();
}

double Field::number(Range range) const {
  if (!value_->is_number()) expected(range.text());
  const double value = value_->get<double>();
  if (!range.contains(value)) expected(range.text());
  return value;
}

float Field::real(Range range) const {
  const double value = number(range);
  if (absolute(value) > double(std::numeric_limits<float>::max())) expected("a number of at most 3.4e38");
  const float rounded = float(value);
  // A number so small that it rounds to a zero that is not allowed.
  if (!range.contains(double(rounded)) && value != 0.0 && rounded == 0.0f)
    expected("a number of at least 1e-45");
  return rounded;
}

std::int64_t Field::integer(std::int64_t low, std::int64_t high) const {
  const std::string range = "an integer from " + std::to_string(low) + " to " + std::to_string(high);
  if (!value_->is_number()) expected(range);
  if (value_->is_number_unsigned()) {
    const std::uint64_t value = value_->get<std::uint64_t>();
    if (value > std::uint64_t(std::numeric_limits<std::int64_t>::max())) expected(range);
  }
  std::int64_t value = 0;
  if (value_->is_number_integer()) {
    value = value_->get<std::int64_t>();
  } else {
    // 4.0 and 4e0 are integers too.
    const double real = value_->get<double>();
    if (!(absolute(real) < 9.0e15)) expected(range);
    value = std::int64_t(real);
    if (double(value) != real) expected(range);
  }
  if (value < low || value > high) expected(range);
  return value;
}

const std::string& Field::text() const {
  if (!value_->is_string()) expected("a text");
  return value_->get_ref<const std::string&>();
}

std::string Field::name(std::size_t longest) const {
  const std::string& value = text();
  if (value.empty()) expected("a name");
  if (value.size() > longest) expected("a name of at most " + std::to_string(longest) + " bytes");
  for (const char c : value) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) expected("a name without control characters");
  }
  return value;
}

std::size_t Field::array(const char* what, std::int64_t size) const {
  if (!value_->is_array() || (size >= 0 && value_->size() != std::size_t(size))) expected(what);
  return value_->size();
}

Vec3 Field::vec3(Range range) const {
  array("an array of 3 numbers", 3);
  return {element(0).real(range), element(1).real(range), element(2).real(range)};
}

DVec3 Field::place() const {
  array("an array of 3 numbers", 3);
  const Range reach = Range::between(-kFarthest, kFarthest);
  return {element(0).number(reach), element(1).number(reach), element(2).number(reach)};
}

SceneColor Field::color() const {
  constexpr const char* kExpected = "a color as \"#rrggbb\" in hexadecimal digits";
  if (!value_->is_string()) expected(kExpected);
  const std::string& text = value_->get_ref<const std::string&>();
  if (text.size() != 7 || text[0] != '#') expected(kExpected);
  std::uint8_t parts[3] = {};
  for (std::size_t i = 1; i < 7; ++i) {
    const char c = text[i];
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) expected(kExpected);
    std::uint8_t& part = parts[(i - 1) / 2];
    part = std::uint8_t(16 * part + digit);
  }
  return {parts[0], parts[1], parts[2]};
}

Quat Field::orientation() const {
  if (value_->is_object()) {
    Members members(*this, "an orientation");
    if (value_->contains("euler_xyz")) {
      const Vec3 angles = members.need("euler_xyz").vec3();
      members.finish();
      return from_euler({angles.x, angles.y, angles.z, EulerOrder::xyz});
    }
    const Field axis = members.need("axis");
    const Vec3 direction = axis.vec3();
    if (direction == Vec3{}) axis.fail("found a zero vector, expected an axis");
    const float angle = members.need("angle").real();
    members.finish();
    return from_axis_angle(normalized(direction), angle);
  }
  array("a quaternion [x, y, z, w], {\"axis\", \"angle\"} or {\"euler_xyz\"}", 4);
  const double x = element(0).number(), y = element(1).number(), z = element(2).number(),
               w = element(3).number();
  const double largest_part = max(max(absolute(x), absolute(y)), max(absolute(z), absolute(w)));
  if (!(largest_part > 1.0e-30 && largest_part < 1.0e30))
    fail("found a quaternion of length 0, expected length 1");
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  // One of length 1, as far as floats can tell, stays as it is, bit by bit: what was written can be read back.
  const double scale = absolute(size - 1.0) < 1.0e-6 ? 1.0 : 1.0 / size;
  return {float(scale * x), float(scale * y), float(scale * z), float(scale * w)};
}

// ------------------------------------------------------------------------------------------------------------- objects

Members::Members(const Field& field, const char* what) : field_(&field), what_(what) {
  if (!field.json().is_object()) field.expected(what);
}

const Json* Members::lookup(const char* key) {
  known_.emplace_back(key);
  const auto at = field_->json().find(key);
  return at == field_->json().end() ? nullptr : &*at;
}

std::optional<Field> Members::find(const char* key) {
  const Json* value = lookup(key);
  if (!value) return std::nullopt;
  return Field(*value, *field_, key);
}

std::optional<Field> Members::find_value(const char* key) {
  const Json* value = lookup(key);
  if (!value || value->is_null()) return std::nullopt;
  return Field(*value, *field_, key);
}

Field Members::need(const char* key) {
  const Json* value = lookup(key);
  if (!value) {
    // The place named is that of the missing member.
    static const Json kNothing;
    Field(kNothing, *field_, key)
        .fail("found nothing, expected \"" + std::string(key) + "\": " + what_ + " needs it");
  }
  return Field(*value, *field_, key);
}

void Members::refuse(const char* key, const char* why) {
  if (const std::optional<Field> field = find_value(key)) field->fail(why);
}

void Members::finish() const {
  const Json& object = field_->json();
  for (auto member = object.begin(); member != object.end(); ++member) {
    const std::string& key = member.key();
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::string message = "unknown field in " + std::string(what_);
    std::string_view closest;
    std::size_t fewest = 3;
    for (const std::string_view word : known_) {
      if (key.size() > 64) break;
      const std::size_t changes = edit_distance(key, word);
      if (changes < fewest) {
        fewest = changes;
        closest = word;
      }
    }
    message += ", expected ";
    if (!closest.empty()) {
      message += "perhaps \"" + std::string(closest) + "\"";
    } else {
      message += "one of ";
      for (std::size_t i = 0; i < known_.size(); ++i) message += (i ? ", " : "") + std::string(known_[i]);
    }
    Field(*member, *field_, key).fail(message);
  }
}

void Members::read(const char* key, bool& out) {
  if (const std::optional<Field> field = find(key)) out = field->boolean();
}
void Members::read(const char* key, double& out, Range range) {
  if (const std::optional<Field> field = find(key)) out = field->number(range);
}
void Members::read(const char* key, float& out, Range range) {
  if (const std::optional<Field> field = find(key)) out = field->real(range);
}
void Members::read(const char* key, Vec3& out) {
  if (const std::optional<Field> field = find(key)) out = field->vec3();
}
void Members::read(const char* key, Quat& out) {
  if (const std::optional<Field> field = find(key)) out = field->orientation();
}
void Members::read(const char* key, std::optional<float>& out, Range range) {
  if (const std::optional<Field> field = find_value(key)) out = field->real(range);
}

void Members::read(const char* key, std::optional<SceneColor>& out) {
  if (const std::optional<Field> field = find_value(key)) out = field->color();
}

}  // namespace gyre
