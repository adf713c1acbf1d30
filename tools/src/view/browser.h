#pragma once
/// Opens a page in the user's browser, if there is one.

#include <string>

namespace palpate::tools {

/// False if there is no desktop here, or no xdg-open.
[[nodiscard]] bool openBrowser(const std::string& url);

}  // namespace palpate::tools
