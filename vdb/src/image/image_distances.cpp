#include "palpate/vdb/image_distances.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/core/stop.h"

namespace palpate::vdb {

std::optional<double> slopeAtZero(const Image& image) {
  const Mat3 to_world = glm::transpose(glm::inverse(image.axes));
  std::vector<double> slopes;
  const auto [nx, ny, nz] = image.size;
  for (int k = 1; k + 1 < nz; ++k) {
    pollStop();
    for (int j = 1; j + 1 < ny; ++j) {
      for (int i = 1; i + 1 < nx; ++i) {
        const float here = image.at(i, j, k);
        const bool is_inside = here < 0.0F;
        if ((image.at(i + 1, j, k) < 0.0F) == is_inside &&
            (image.at(i, j + 1, k) < 0.0F) == is_inside &&
            (image.at(i, j, k + 1) < 0.0F) == is_inside) {
          continue;
        }
        const Vec3 by_index(0.5 * (image.at(i + 1, j, k) - image.at(i - 1, j, k)),
                            0.5 * (image.at(i, j + 1, k) - image.at(i, j - 1, k)),
                            0.5 * (image.at(i, j, k + 1) - image.at(i, j, k - 1)));
        const double slope = glm::length(to_world * by_index);
        if (std::isfinite(slope)) slopes.push_back(slope);
      }
    }
  }
  if (slopes.empty()) return {};
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  return *middle;
}

bool looksLikeDistances(const Image& image) {
  constexpr double kPerMillimeter = 1e3;
  const auto slope = slopeAtZero(image);
  return slope && std::abs(*slope / kPerMillimeter - 1.0) < 0.2;
}

std::string distancesNote(const Image& image) {
  if (!looksLikeDistances(image)) return {};
  return "its values look like signed distances in mm, negative inside; what is above a "
         "threshold is their outside";
}

}  // namespace palpate::vdb
