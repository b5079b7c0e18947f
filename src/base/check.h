// Checks of the engine's own promises. GYRE_ASSERT is cheap and is compiled in where NDEBUG is not defined, or
// GYRE_ENABLE_ASSERTS is. GYRE_VALIDATE_ONLY keeps a statement that walks whole structures, in builds with
// GYRE_VALIDATE=1. Wrong input from outside is never handled here: that is what Result and problems() are for.
#pragma once

namespace gyre {

// Told what did not hold: the condition as written, the same in words, and where.
using CheckHandler = void (*)(const char* condition, const char* words, const char* file, int line);

// Replaces what happens when a check fails; null brings back the default, which prints to stderr and aborts. A handler
// that returns lets the program go on (tests do that); the state is then suspect. Safe to call from any thread.
void set_check_handler(CheckHandler handler);

// Calls the handler.
void check_failed(const char* condition, const char* words, const char* file, int line);

#if !defined(NDEBUG) || defined(GYRE_ENABLE_ASSERTS)
constexpr bool kAssertsActive = true;
#define GYRE_ASSERT(condition, words) \
  ((condition) ? static_cast<void>(0) : ::gyre::check_failed(#condition, words, __FILE__, __LINE__))
#else
constexpr bool kAssertsActive = false;
// Not evaluated, but what it names still counts as used and must still compile.
#define GYRE_ASSERT(condition, words) static_cast<void>(sizeof(!(condition)))
#endif

#if defined(GYRE_VALIDATE) && GYRE_VALIDATE
#define GYRE_VALIDATE_ONLY(...) \
  do {                          \
    __VA_ARGS__;                \
  } while (false)
#else
#define GYRE_VALIDATE_ONLY(...) static_cast<void>(0)
#endif

}  // namespace gyre
