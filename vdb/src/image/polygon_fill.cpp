#include "image/polygon_fill.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {

std::vector<std::pair<int, int>> evenOddRuns(const std::vector<std::vector<PixelPoint>>& polygons,
                                             int j, int columns) {
  std::vector<double> crossings;
  for (const std::vector<PixelPoint>& polygon : polygons) {
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      const PixelPoint& a = polygon[n];
      const PixelPoint& b = polygon[(n + 1) % polygon.size()];
      // A corner at the row's height counts for only one of its two edges.
      if ((a.j > j) == (b.j > j)) continue;
      crossings.push_back(a.i + (j - a.j) / (b.j - a.j) * (b.i - a.i));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<std::pair<int, int>> runs;
  const auto pixel = [&](double at) {
    return static_cast<int>(std::clamp(std::ceil(at), 0.0, static_cast<double>(columns)));
  };
  for (std::size_t n = 0; n + 1 < crossings.size(); n += 2) {
    const std::pair<int, int> run(pixel(crossings[n]), pixel(crossings[n + 1]));
    if (run.first < run.second) runs.push_back(run);
  }
  return runs;
}

}  // namespace palpate::vdb
