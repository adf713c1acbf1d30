#pragma once
/// The folder in which the command keeps results that take long to make again.

#include <string>

#include "palpate/vdb/kept_grids.h"

namespace palpate::tools {

/// Mainly for the grids of scenes (vdb/README.md, "Kept grids"). $PALPATE_CACHE; else
/// $XDG_CACHE_HOME/palpate, else $HOME/.cache/palpate. Empty, which means nowhere, if the first is
/// "off" or none is an absolute path.
[[nodiscard]] std::string cacheFolder();

/// From now on nothing is kept (--no-cache).
void keepNothing() noexcept;

/// Sets the bundle that all scenes loaded from now on fill; an empty folder: none.
void fillBundle(const std::string& grids);
[[nodiscard]] vdb::BundleOptions bundleToFill();

}  // namespace palpate::tools
