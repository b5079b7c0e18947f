// Checks of the engine's own invariants. GYRE_ASSERT is cheap; it is compiled in without NDEBUG or with
// GYRE_ENABLE_ASSERTS. GYRE_VALIDATE_ONLY keeps a statement that visits whole structures, in builds with
// GYRE_VALIDATE=1. Wrong input from outside is never handled here; Result and problems() are for that.
#pragma once

namespace gyre {

// Receives a failed check: the condition as written, the same in words, and its location.
using CheckHandler = void (*)(const char* condition, const char* words, const char* file, int line);

// Replaces the handler of failed checks; null restores the default, which prints to stderr and aborts. If a handler
// returns, as in tests, the program continues with a suspect state. Safe to call from any thread.
void set_check_handler(CheckHandler handler);

// Calls the handler.
void check_failed(const char* condition, const char* words, const char* file, int line);

#if !defined(NDEBUG) || defined(GYRE_ENABLE_ASSERTS)
constexpr bool kAssertsActive = true;
#define GYRE_ASSERT(condition, words) \
  ((condition) ? static_cast<void>(0) : ::gyre::check_failed(#condition, words, __FILE__, __LINE__))
#else
constexpr bool kAssertsActive = false;
// Not evaluated, but the names in it count as used and must compile.
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
