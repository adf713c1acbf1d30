#include "saving.h"

#include <chrono>

#include "palpate/interior/partition.h"
#include "palpate/vdb/level_set.h"

namespace palpate::tools {
namespace {

double surfaceOf(const Box3& box) {
  const Vec3 size = box.size();
  return 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

}  // namespace

Saving costOf(const std::string& file, Purpose purpose, Console& console) {
  const auto start = std::chrono::steady_clock::now();
  const LoadedScene loaded(file, console);
  const ScenePtr scene = loaded.compile(purpose);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::uint64_t bytes = 0;
  for (const Leaf& leaf : scene->partition().leaves()) bytes += vdb::memoryOf(*leaf.field);
  return {bytes, took.count()};
}

std::optional<Saving> savingOf(const LoadedScene& loaded, const Scene& scene) {
  double made = 0.0;
  double bytes = 0.0;
  double seconds = 0.0;
  for (const vdb::GridRecord& grid : loaded.grids()) {
    if (!grid.info.bounds.isBounded()) continue;
    made += surfaceOf(grid.info.bounds);
    bytes += static_cast<double>(grid.info.memory);
    seconds += grid.seconds;
  }
  double left = 0.0;
  for (std::size_t i = 1; i < scene.regions().size(); ++i) {
    if (scene.regions()[i].left_out.empty()) continue;
    const auto box = loaded.description().layers[i - 1].inside->bounds();
    if (box && box->isBounded()) left += surfaceOf(*box);
  }
  if (left == 0.0 || made == 0.0) return std::nullopt;
  return Saving{static_cast<std::uint64_t>(bytes * left / made), seconds * left / made};
}

}  // namespace palpate::tools
