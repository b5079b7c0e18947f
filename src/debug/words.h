// The words of an explanation.
#pragma once

#include <gyre/debug.h>

namespace gyre {

// Fills out.words from everything else in `out`.
void write_words(Explanation& out, BodyId body, const BodyNames& names);

}  // namespace gyre
