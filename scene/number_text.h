// Numbers to text and back, the same in every locale.
#pragma once

#include <string>
#include <string_view>

namespace gyre {

// The shortest decimal that reads back as the same number. Not for NaN and infinity.
void append_number(std::string& out, double value);
void append_number(std::string& out, float value);

// With `digits` significant digits; NaN and infinity as "nan", "inf" and "-inf".
void append_rounded(std::string& out, double value, int digits);
std::string rounded(double value, int digits = 6);

// A whole token as a decimal number ("-1.5e3"). False if it is anything else or does not fit a double.
bool parse_number(std::string_view token, double& out);

}  // namespace gyre
