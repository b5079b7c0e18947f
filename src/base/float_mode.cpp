// Access to the control register of floats on x86 (MXCSR, Intel SDM 1, 10.2.3) and 64-bit ARM (FPCR, Arm ARM C5.2.8).
// WebAssembly has only the required mode.
#include "base/float_mode.h"

#if (defined(__SSE2__) || defined(_M_X64)) && !defined(__EMSCRIPTEN__)
#include <xmmintrin.h>
#elif defined(_M_ARM64)
#include <intrin.h>
#endif

namespace gyre {

namespace {

#if defined(__EMSCRIPTEN__)

std::uint64_t read_mode() { return 0; }
void write_mode(std::uint64_t) {}
constexpr std::uint64_t required_mode(std::uint64_t mode) { return mode; }

#elif defined(__SSE2__) || defined(_M_X64)

std::uint64_t read_mode() { return _mm_getcsr(); }
void write_mode(std::uint64_t mode) { _mm_setcsr(static_cast<unsigned>(mode)); }
// All traps masked, rounding to nearest, flush-to-zero and denormals-are-zero off: the state at power-up.
constexpr std::uint64_t required_mode(std::uint64_t) { return 0x1f80; }

#elif defined(__aarch64__) || defined(_M_ARM64)

#if defined(_M_ARM64)
std::uint64_t read_mode() { return static_cast<std::uint64_t>(_ReadStatusReg(ARM64_FPCR)); }
void write_mode(std::uint64_t mode) { _WriteStatusReg(ARM64_FPCR, static_cast<__int64>(mode)); }
#else
std::uint64_t read_mode() {
  std::uint64_t mode;
  __asm__ __volatile__("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
void write_mode(std::uint64_t mode) { __asm__ __volatile__("msr fpcr, %0" : : "r"(mode) : "memory"); }
#endif
// Cleared: FIZ, AH, NEP (bits 0 to 2), trap enables (8 to 12, 15), FZ16 (19), rounding (22, 23), FZ (24), DN (25).
constexpr std::uint64_t required_mode(std::uint64_t mode) { return mode & ~std::uint64_t{0x03c89f07}; }

#else

std::uint64_t read_mode() { return 0; }
void write_mode(std::uint64_t) {}
constexpr std::uint64_t required_mode(std::uint64_t mode) { return mode; }

#endif

}  // namespace

FloatMode::FloatMode() : saved_(read_mode()) { write_mode(required_mode(saved_)); }

FloatMode::~FloatMode() { write_mode(saved_); }

}  // namespace gyre
