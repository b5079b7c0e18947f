// The text of an explanation.
#pragma once

#include <gyre/debug.h>

namespace gyre {

// Writes out.words from the rest of `out`.
void write_words(Explanation& out, BodyId body, const BodyNames& names);

}  // namespace gyre
