// Before a function that seldom runs: it is made small and stays out of line, so that the usual way around it is short enough to be
// inlined where it is called.
#pragma once

#if defined(__GNUC__) || defined(__clang__)
#define GYRE_COLD __attribute__((noinline, cold))
#else
#define GYRE_COLD
#endif
