// JSON text to a document. nlohmann's parser is an explicit stack machine; the events it sends are built into a document
// here, so that depth, number of values and repeated keys are checked while reading. See json_document.h.
#include "scene/json_document.h"

#include <algorithm>
#include <vector>

namespace gyre {
namespace {

// What is open while reading: the container, and where in it the next value goes.
struct Open {
  Json* container = nullptr;
  std::string key;  // of an object
};

class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  DocumentBuilder(std::string_view text, const std::string& file, const SceneLimits& limits)
      : text_(text), file_(file), limits_(limits) {}

  Json take() { return std::move(root_); }

  bool null() override { return add(Json(nullptr)); }
  bool boolean(bool v) override { return add(Json(v)); }
  bool number_integer(number_integer_t v) override { return add(Json(v)); }
  bool number_unsigned(number_unsigned_t v) override { return add(Json(v)); }
  bool number_float(number_float_t v, const string_t&) override { return add(Json(v)); }
  bool string(string_t& v) override { return add(Json(std::move(v))); }
  bool binary(binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool key(string_t& v) override {
    stack_.back().key = std::move(v);
    return true;
  }
  bool end_object() override {
    check_keys();
    stack_.pop_back();
    return true;
  }
  bool end_array() override {
    stack_.pop_back();
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& why) override {
    SceneError error = error_here("not valid JSON: " + plain_words(why.what()));
    // The parser counts bytes from 1; the byte that did not fit is the last one read.
    const std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::string_view before = text_.substr(0, at);
    const std::size_t line_start = before.rfind('\n');
    error.line = 1 + int(std::count(before.begin(), before.end(), '\n'));
    error.column = int(line_start == std::string_view::npos ? at : at - line_start - 1) + 1;
    throw error;
  }

 private:
  Json* add_value(Json value) {
    if (++count_ > limits_.values) {
      throw error_here("more than " + std::to_string(limits_.values) + " values in one file");
    }
    if (stack_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    Json& container = *stack_.back().container;
    if (container.is_array()) {
      auto& items = container.get_ref<Json::array_t&>();
      items.push_back(std::move(value));
      return &items.back();
    }
    // Appended without a search for the key; check_keys looks at all of them when the object ends.
    auto& members = container.get_ref<Json::object_t&>();
    using Members = std::vector<std::pair<const std::string, Json>>;
    static_cast<Members&>(members).emplace_back(std::move(stack_.back().key), std::move(value));
    return &members.back().second;
  }

  bool add(Json value) {
    add_value(std::move(value));
    return true;
  }

  bool open(Json container) {
    if (stack_.size() >= std::size_t(limits_.depth)) {
      throw error_here("nested deeper than " + std::to_string(limits_.depth) + " levels");
    }
    Json* place = add_value(std::move(container));
    stack_.push_back({place, {}});
    return true;
  }

  void check_keys() {
    const auto& members = stack_.back().container->get_ref<const Json::object_t&>();
    std::vector<std::string_view> keys;
    keys.reserve(members.size());
    for (const auto& member : members) keys.emplace_back(member.first);
    std::sort(keys.begin(), keys.end());
    const auto twice = std::adjacent_find(keys.begin(), keys.end());
    if (twice == keys.end()) return;
    SceneError error{file_, 0, 0, pointer(stack_.size() - 1), "the key is given twice, expected once"};
    append_pointer(error.pointer, *twice);
    throw error;
  }

  // Where the first `levels` open containers lead; the last of them is the place itself.
  std::string pointer(std::size_t levels) const {
    std::string out;
    for (std::size_t i = 0; i < levels; ++i) {
      const Json& container = *stack_[i].container;
      if (container.is_array()) {
        out += "/" + std::to_string(container.size() - (i + 1 < stack_.size() ? 1 : 0));
      } else {
        append_key(out, i);
      }
    }
    return out;
  }
  // The key of the member that is being read: already moved into the object once its value has begun.
  void append_key(std::string& out, std::size_t level) const {
    if (level + 1 < stack_.size()) {
      const auto& members = stack_[level].container->get_ref<const Json::object_t&>();
      append_pointer(out, members.back().first);
    } else if (!stack_[level].key.empty()) {
      append_pointer(out, stack_[level].key);
    }
  }

  SceneError error_here(std::string message) const {
    return SceneError{file_, 0, 0, pointer(stack_.size()), std::move(message)};
  }

  // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing value - invalid literal;
  // last read: 'x'; expected ..." without the parts that are said elsewhere.
  static std::string plain_words(std::string_view what) {
    const std::size_t bracket = what.find("] ");
    if (bracket != std::string_view::npos) what.remove_prefix(bracket + 2);
    if (what.substr(0, 14) == "parse error at") {
      const std::size_t colon = what.find(": ");
      if (colon != std::string_view::npos) what.remove_prefix(colon + 2);
    }
    const std::size_t dash = what.find(" - ");
    if (what.substr(0, 12) == "syntax error" && dash != std::string_view::npos) what.remove_prefix(dash + 3);
    std::string out(what);
    const std::size_t read = out.find("; last read: '");
    if (read != std::string::npos) {
      const std::size_t after = out.find("'; expected", read + 14);
      out.erase(read, after == std::string::npos ? std::string::npos : after + 1 - read);
    }
    if (out.size() > 160) out.resize(160);
    for (char& c : out) {
      if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
    }
    return out;
  }

  std::string_view text_;
  const std::string& file_;
  const SceneLimits& limits_;
  Json root_;
  std::vector<Open> stack_;
  std::size_t count_ = 0;
};

void check_bytes(std::string_view text, const std::string& file, const SceneLimits& limits) {
  if (text.size() > limits.file_bytes) {
    throw SceneError{file, 0, 0, "",
                     "found " + std::to_string(text.size()) + " bytes, expected at most " +
                         std::to_string(limits.file_bytes)};
  }
  if (text.empty()) throw SceneError{file, 0, 0, "", "found an empty file, expected a JSON object"};
  const std::string_view start = text.substr(0, 2);
  if (start == "\xff\xfe" || start == "\xfe\xff") {
    throw SceneError{file, 0, 0, "", "found UTF-16 text, expected UTF-8"};
  }
  // The parser would take a zero byte for the end and pass over the rest.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    const std::string_view before = text.substr(0, zero);
    const std::size_t line_start = before.rfind('\n');
    throw SceneError{file, 1 + int(std::count(before.begin(), before.end(), '\n')),
                     int(line_start == std::string_view::npos ? zero : zero - line_start - 1) + 1, "",
                     "not valid JSON: found a zero byte"};
  }
}

}  // namespace

void append_pointer(std::string& pointer, std::string_view key) {
  constexpr char kHex[] = "0123456789abcdef";
  pointer += '/';
  // Keys come from outside: shown in part only, and on one line.
  const bool cut = key.size() > 80;
  for (const char c : key.substr(0, 80)) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else if (byte < 0x20 || byte == 0x7f) {
      pointer += "\\u00";
      pointer += kHex[byte >> 4];
      pointer += kHex[byte & 15];
    } else {
      pointer += c;
    }
  }
  if (cut) pointer += "...";
}

Json parse_document(std::string_view text, const std::string& file, const SceneLimits& limits) {
  check_bytes(text, file, limits);
  DocumentBuilder builder(text, file, limits);
  const char* begin = text.data();
  Json::sax_parse(begin, begin + text.size(), &builder);
  return builder.take();
}

}  // namespace gyre
