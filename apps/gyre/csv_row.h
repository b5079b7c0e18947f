// Cells of a CSV row (RFC 4180). Each function appends a comma and a cell.
#pragma once

#include "scene/number_text.h"

#include <string>

namespace gyre {

inline void add_number(std::string& row, double value) {
  constexpr int kDigits = 9;  // enough for a float to read back the same
  row += ',';
  append_rounded(row, value, kDigits);
}
inline void add_count(std::string& row, long long count) {
  row += ',';
  row += std::to_string(count);
}
template <class V>
void add_vector(std::string& row, const V& v) {
  for (int axis = 0; axis < 3; ++axis) add_number(row, double(v[axis]));
}

// A name as one cell.
inline void add_text(std::string& row, const std::string& text) {
  row += ',';
  if (text.find_first_of(",\"\n") == std::string::npos) {
    row += text;
    return;
  }
  row += '"';
  for (const char c : text) {
    if (c == '"') row += '"';
    row += c;
  }
  row += '"';
}

}  // namespace gyre
