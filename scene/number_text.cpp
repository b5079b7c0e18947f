// Numbers to text and back. printf and strtod follow the program's locale in one thing only, the decimal separator; it is
// exchanged here. See number_text.h.
#include "scene/number_text.h"

#include <gyre/math.h>

#include <clocale>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gyre {
namespace {

// The separator that printf and strtod use at the moment.
std::string_view separator() {
  const char* text = std::localeconv()->decimal_point;
  return text && *text ? std::string_view(text) : std::string_view(".");
}

// printf's text of a number, with a point.
void append_with_point(std::string& out, std::string_view printed) {
  const std::string_view mark = separator();
  const std::size_t at = mark == "." ? std::string_view::npos : printed.find(mark);
  if (at == std::string_view::npos) {
    out += printed;
    return;
  }
  out += printed.substr(0, at);
  out += '.';
  out += printed.substr(at + mark.size());
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Whether the token is an optional sign, digits with at most one point, and an optional exponent.
bool is_decimal(std::string_view token) {
  std::size_t i = 0;
  if (i < token.size() && (token[i] == '-' || token[i] == '+')) ++i;
  std::size_t digits = 0;
  for (; i < token.size() && is_digit(token[i]); ++i) ++digits;
  if (i < token.size() && token[i] == '.') {
    for (++i; i < token.size() && is_digit(token[i]); ++i) ++digits;
  }
  if (digits == 0) return false;
  if (i < token.size() && (token[i] == 'e' || token[i] == 'E')) {
    ++i;
    if (i < token.size() && (token[i] == '-' || token[i] == '+')) ++i;
    const std::size_t first = i;
    while (i < token.size() && is_digit(token[i])) ++i;
    if (i == first) return false;
  }
  return i == token.size();
}

}  // namespace

void append_number(std::string& out, double value) {
  if (value == 0.0 && std::signbit(value)) {
    out += "-0.0";  // readers take -0 for an integer, which has no sign of zero
    return;
  }
  char text[40];
  int size = 0;
  for (int digits = 15; digits <= 17; ++digits) {
    size = std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  append_with_point(out, {text, std::size_t(size)});
}

void append_number(std::string& out, float value) {
  if (value == 0.0f) return append_number(out, double(value));
  char text[40];
  int size = 0;
  for (int digits = 6; digits <= 9; ++digits) {
    size = std::snprintf(text, sizeof text, "%.*g", digits, double(value));
    // As a reader will see it: a double first, then rounded to float.
    if (float(std::strtod(text, nullptr)) == value) break;
  }
  append_with_point(out, {text, std::size_t(size)});
}

void append_rounded(std::string& out, double value, int digits) {
  if (!is_finite(value)) {
    out += value != value ? "nan" : value > 0 ? "inf" : "-inf";
    return;
  }
  char text[64];
  const int size = std::snprintf(text, sizeof text, "%.*g", digits, value);
  append_with_point(out, {text, std::size_t(size)});
}

std::string rounded(double value, int digits) {
  std::string out;
  append_rounded(out, value, digits);
  return out;
}

bool parse_number(std::string_view token, double& out) {
  constexpr std::size_t kLongest = 400;  // more digits than any double has
  if (token.size() > kLongest || !is_decimal(token)) return false;
  std::string text(token);
  const std::size_t point = text.find('.');
  if (point != std::string::npos) text.replace(point, 1, separator());
  const double value = std::strtod(text.c_str(), nullptr);
  if (!is_finite(value)) return false;
  out = value;
  return true;
}

}  // namespace gyre
