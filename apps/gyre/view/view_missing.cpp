// gyre view in a build without the library that serves: says what to install. See view.h.
#include "exit_code.h"
#include "view/view.h"

#include <cstdio>

namespace gyre {

int view(const ViewOptions&) {
  std::fprintf(stderr,
               "gyre: this gyre was built without a server, for want of cpp-httplib; install "
               "libcpp-httplib-dev (Debian's "
               "name), then configure and build again\n");
  return kExitInvalid;
}

}  // namespace gyre
