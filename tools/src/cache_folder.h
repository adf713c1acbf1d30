#pragma once
/// The folder in which the command keeps results that take long to make again.

#include <string>

#include "palpate/vdb/kept_grids.h"

namespace palpate::tools {

/// Mainly for the grids of scenes (vdb/README.md, "Kept grids"): $PALPATE_CACHE if it is set, else
/// $XDG_CACHE_HOME/palpate, else $HOME/.cache/palpate. Empty, so that nothing is kept, if
/// $PALPATE_CACHE is not an absolute path ("off"), or if no absolute path is found.
[[nodiscard]] std::string cacheFolder();

/// Nothing is kept from now on (--no-cache).
void keepNothing() noexcept;

/// Sets the bundle that all scenes loaded from now on fill; an empty folder: none.
void fillBundle(const std::string& grids);
[[nodiscard]] vdb::BundleOptions bundleToFill();

}  // namespace palpate::tools
