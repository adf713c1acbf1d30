#pragma once
/// Where the command keeps what takes long to make again.

#include <string>

namespace palpate::tools {

/// $PALPATE_CACHE; else $XDG_CACHE_HOME/palpate, else $HOME/.cache/palpate. Empty, which means nowhere, if the first is "off" or
/// none is an absolute path.
[[nodiscard]] std::string cacheFolder();

}  // namespace palpate::tools
