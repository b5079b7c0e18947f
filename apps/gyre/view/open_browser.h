// Shows an address in the user's browser, where there is one.
#pragma once

#include <string>

namespace gyre {

// False if there is no display, or nothing that opens addresses. Never waits for the browser.
bool open_browser(const std::string& address);

}  // namespace gyre
