// Marks functions that seldom run: they are kept out of line and small, so that the common path of the caller can be
// inlined.
#pragma once

#if defined(__GNUC__) || defined(__clang__)
#define GYRE_COLD __attribute__((noinline, cold))
#else
#define GYRE_COLD
#endif
