// Writes the message of an Error with printf's formatting, cut to the size of the message, so that the report of a
// failure never allocates and never fails.
#include <gyre/result.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace gyre {

Error make_error(ErrorCode code, const char* format, ...) {
  Error error;
  error.code = code;
  std::va_list arguments;
  va_start(arguments, format);
  // A format that cannot be converted leaves an unspecified buffer; the message must still be text.
  if (std::vsnprintf(error.message, sizeof error.message, format, arguments) < 0) error.message[0] = '\0';
  va_end(arguments);
  return error;
}

void stop_at_error(const Error& error) {
  std::fprintf(stderr, "gyre: the value of a Result that holds an error: %s\n", error.message);
  std::fflush(stderr);
  std::abort();
}

}  // namespace gyre
