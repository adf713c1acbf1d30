#pragma once
/// Where the command keeps what takes long to make again.

#include <string>

#include "palpate/vdb/kept_grids.h"

namespace palpate::tools {

/// Of the grids of scenes above all (vdb/README.md, "Kept grids"). $PALPATE_CACHE; else
/// $XDG_CACHE_HOME/palpate, else $HOME/.cache/palpate. Empty, which means nowhere, if the first is
/// "off" or none is an absolute path.
[[nodiscard]] std::string cacheFolder();

/// From now on it is nowhere (--no-cache).
void keepNothing() noexcept;

/// The bundle that all scenes fill which are loaded from now on; an empty folder: none.
void fillBundle(const std::string& grids);
[[nodiscard]] vdb::BundleOptions bundleToFill();

}  // namespace palpate::tools
