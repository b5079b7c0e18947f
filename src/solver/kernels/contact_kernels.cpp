// Chooses the kernels for this machine when a world is made.
#include "base/processor.h"
#include "solver/contact/contact_block.h"

namespace gyre {

extern const ContactKernels kContactKernels_w1;
extern const ContactKernels kContactKernels_sse2;
#if defined(__x86_64__)
extern const ContactKernels kContactKernels_avx2;
extern const ContactKernels kContactKernels_avx512;
extern const ContactKernels kContactKernels_avx512vl;
#endif

const ContactKernels& select_contact_kernels(int width) {
  const int lanes = lanes_for(width);
#if defined(__x86_64__)
  if (lanes >= 16) return kContactKernels_avx512;
  // Eight lanes with the instructions and registers of a processor that has sixteen. (If the user sets a
  // width of eight, it is that of any AVX2.)
  if (width == 0 && lanes == 8 && max_lanes() == 16) return kContactKernels_avx512vl;
  if (lanes >= 8) return kContactKernels_avx2;
#endif
  if constexpr (kLanesOfAll >= 4) {
    if (lanes >= 4) return kContactKernels_sse2;
  }
  return kContactKernels_w1;
}

const ContactKernels& narrower_kernels(const ContactKernels& kernels) {
#if defined(__x86_64__)
  // Eight lanes use half as much memory, and two bodies fit in one register of doubles. (Four lanes have
  // other instructions.)
  if (&kernels == &kContactKernels_avx512) return kContactKernels_avx512vl;
#endif
  return kernels;
}

}  // namespace gyre
