#include "vdb_grid_name.h"

#include <algorithm>

#include "palpate/vdb/io.h"

namespace palpate::tools {

std::string gridName(const std::string& file, const std::string& name) {
  if (name.empty()) return name;
  const auto grids = vdb::listVdb(file);
  const auto has = [&](const std::string& wanted) {
    return std::any_of(grids.begin(), grids.end(),
                       [&](const vdb::VdbGridSummary& grid) { return grid.name == wanted; });
  };
  return !has(name) && has(name + "/surface") ? name + "/surface" : name;
}

}  // namespace palpate::tools
