#include "cache_folder.h"

#include <cstdlib>

namespace palpate::tools {
namespace {

/// An absolute path, or nothing.
std::string pathIn(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && value[0] == '/' ? value : "";
}

bool keeps_nothing = false;
vdb::BundleOptions to_fill;

}  // namespace

void keepNothing() noexcept { keeps_nothing = true; }

void fillBundle(const std::string& grids) { to_fill = {grids, !grids.empty()}; }

vdb::BundleOptions bundleToFill() { return to_fill; }

std::string cacheFolder() {
  if (keeps_nothing) return {};
  if (std::getenv("PALPATE_CACHE") != nullptr) return pathIn("PALPATE_CACHE");
  const std::string shared = pathIn("XDG_CACHE_HOME");
  if (!shared.empty()) return shared + "/palpate";
  const std::string home = pathIn("HOME");
  return home.empty() ? "" : home + "/.cache/palpate";
}

}  // namespace palpate::tools
