#include "import/kept_layers.h"

#include <functional>
#include <utility>
#include <vector>

#include "cache_folder.h"
#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/kept_grids.h"

namespace palpate::tools {

std::set<std::string> keptLayers(const std::string& text, const std::string& file) try {
  std::vector<std::pair<std::string, std::function<bool()>>> sources;
  vdb::RegisterOptions options;
  options.cache_folder = cacheFolder();
  vdb::BundleOptions asking;
  asking.on_source = [&](const std::string& what, std::function<bool()> is_kept) {
    sources.emplace_back(what, std::move(is_kept));
  };
  SceneRegistry registry;
  vdb::registerKinds(registry, options, asking);
  const SceneDescription scene = parseScene(text, file, registry);
  std::set<std::string> kept;
  for (const auto& [what, is_kept] : sources) {
    if (is_kept()) kept.insert(what);
  }
  return kept;
} catch (const Error& error) {
  if (error.kind() == ErrorKind::kCancelled) throw;
  return {};
}

}  // namespace palpate::tools
