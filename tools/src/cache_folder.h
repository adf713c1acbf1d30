#pragma once
/// Where the command keeps what takes long to make again.

#include <string>

namespace palpate::tools {

/// Of the grids of scenes above all (vdb/README.md, "Kept grids"). $PALPATE_CACHE; else $XDG_CACHE_HOME/palpate, else
/// $HOME/.cache/palpate. Empty, which means nowhere, if the first is "off" or none is an absolute path, and with --no-cache.
[[nodiscard]] std::string cacheFolder();

/// What --no-cache sets: one command has one cache, however many scenes it loads.
[[nodiscard]] bool& noCache() noexcept;

}  // namespace palpate::tools
