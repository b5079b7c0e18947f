// Ctrl-C as a question that a loop asks. The first one asks the loop to end; the second ends the program as usual.
#pragma once

namespace gyre {

void watch_interrupt();
bool interrupted();

}  // namespace gyre
