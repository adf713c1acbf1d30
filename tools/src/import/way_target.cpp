#include "import/way_target.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>
#include <vector>

#include "import/region_sampler.h"
#include "palpate/core/error.h"
#include "palpate/vdb/scan_surface.h"
#include "slicer_markups.h"
#include "text.h"

namespace palpate::tools {
namespace {

struct Labels {
  std::string name;
  std::size_t region;
  std::vector<int> labels;
};

Labels labelsOf(const ImportedScan& scan, const std::string& target) {
  const std::vector<PlannedRegion>& regions = scan.plan.regions;
  const auto named = std::find_if(regions.begin(), regions.end(), [&](const PlannedRegion& region) {
    return region.name == target;
  });
  if (named != regions.end()) {
    return {target, static_cast<std::size_t>(named - regions.begin()), named->labels};
  }
  const std::vector<int> wanted = vdb::resolveLabels({target}, scan.names, scan.labels.source);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    std::vector<int> labels;
    for (const int label : regions[r].labels) {
      if (std::find(wanted.begin(), wanted.end(), label) != wanted.end()) labels.push_back(label);
    }
    if (labels.empty()) continue;
    const auto name = scan.names.find(labels.front());
    return {name != scan.names.end() ? name->second : target, r, labels};
  }
  throw inputError("import.target", "'" + target + "' is not in any region of this scene",
                   "give a label that the image holds and --labels takes in", scan.labels.source);
}

/// The target's voxels in their bounding box, with a border of other voxels around.
class Depths {
 public:
  Depths(const vdb::Image& image, const std::vector<int>& labels) : image_(image) {
    box(labels);
    depth_.assign(size_[0] * size_[1] * size_[2], 0.0F);
    const std::array<int, 3> first = first_;
    for (std::size_t k = 1; k + 1 < size_[2]; ++k) {
      for (std::size_t j = 1; j + 1 < size_[1]; ++j) {
        for (std::size_t i = 1; i + 1 < size_[0]; ++i) {
          const int label = static_cast<int>(image.at(first[0] + static_cast<int>(i) - 1,
                                                      first[1] + static_cast<int>(j) - 1,
                                                      first[2] + static_cast<int>(k) - 1));
          if (std::find(labels.begin(), labels.end(), label) != labels.end()) {
            depth_[at(i, j, k)] = kFar;
          }
        }
      }
    }
  }

  /// [m] The center of the deepest voxel.
  [[nodiscard]] Vec3 deepest() {
    sweep(true);
    sweep(false);
    const auto most = std::max_element(depth_.begin(), depth_.end());
    std::size_t n = static_cast<std::size_t>(most - depth_.begin());
    Vec3 index;
    for (std::size_t a = 0; a < 3; ++a) {
      index[static_cast<int>(a)] = first_[a] + static_cast<int>(n % size_[a]) - 1;
      n /= size_[a];
    }
    return image_.toWorld(index);
  }

 private:
  static constexpr float kFar = 1e9F;

  void box(const std::vector<int>& labels) {
    std::array<int, 3> last = {-1, -1, -1};
    first_ = image_.size;
    for (int k = 0; k < image_.size[2]; ++k) {
      for (int j = 0; j < image_.size[1]; ++j) {
        for (int i = 0; i < image_.size[0]; ++i) {
          const int label = static_cast<int>(image_.at(i, j, k));
          if (std::find(labels.begin(), labels.end(), label) == labels.end()) continue;
          const std::array<int, 3> here = {i, j, k};
          for (std::size_t a = 0; a < 3; ++a) {
            first_[a] = std::min(first_[a], here[a]);
            last[a] = std::max(last[a], here[a]);
          }
        }
      }
    }
    if (last[0] < 0) {
      throw inputError("import.target", "--min-island has removed all voxels of the target",
                       "give a smaller number", image_.source);
    }
    for (std::size_t a = 0; a < 3; ++a)
      size_[a] = static_cast<std::size_t>(last[a] - first_[a]) + 3;
  }

  [[nodiscard]] std::size_t at(std::size_t i, std::size_t j, std::size_t k) const {
    return i + size_[0] * (j + size_[1] * k);
  }

  /// One of two sweeps of a chamfer distance over the 26 steps to neighbors. The result is at most
  /// a tenth longer than the straight distance (Borgefors 1986, Distance transformations in digital
  /// images), which is accurate enough to find the deepest voxel.
  void sweep(bool forward) {
    const int way = forward ? -1 : 1;
    for (std::size_t nk = 1; nk + 1 < size_[2]; ++nk) {
      for (std::size_t nj = 1; nj + 1 < size_[1]; ++nj) {
        for (std::size_t ni = 1; ni + 1 < size_[0]; ++ni) {
          const std::size_t i = forward ? ni : size_[0] - 1 - ni;
          const std::size_t j = forward ? nj : size_[1] - 1 - nj;
          const std::size_t k = forward ? nk : size_[2] - 1 - nk;
          float& here = depth_[at(i, j, k)];
          if (here == 0.0F) continue;
          for (int dk = -1; dk <= 1; ++dk) {
            for (int dj = -1; dj <= 1; ++dj) {
              for (int di = -1; di <= 1; ++di) {
                const int order = di + 3 * (dj + 3 * dk);
                if (order * way <= 0) continue;
                const auto length = static_cast<float>(glm::length(image_.axes * Vec3(di, dj, dk)));
                const float other =
                    depth_[at(i + static_cast<std::size_t>(di), j + static_cast<std::size_t>(dj),
                              k + static_cast<std::size_t>(dk))];
                here = std::min(here, other + length);
              }
            }
          }
        }
      }
    }
  }

  const vdb::Image& image_;
  std::array<int, 3> first_{};
  std::array<std::size_t, 3> size_{};
  std::vector<float> depth_;
};

/// Whether `label` has the word in it, in any case: "Entry-1".
bool says(const std::string& label, const std::string& word) {
  std::string lower = label;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower.find(word) != std::string::npos;
}

WayTarget markedTarget(const ImportedScan& scan, const std::string& file) {
  std::vector<MarkupPoint> points;
  for (const Markup& markup : readMarkups(file)) {
    points.insert(points.end(), markup.points.begin(), markup.points.end());
  }
  if (points.empty() || points.size() > 2) {
    throw inputError("import.target", "the file has " + std::to_string(points.size()) + " points",
                     "keep one, the target, or two, the entry and the target", file);
  }
  const bool is_turned = points.size() == 2 && (says(points.front().label, "target") ||
                                                says(points.back().label, "entry"));
  if (is_turned) std::swap(points.front(), points.back());
  WayTarget out;
  out.place = points.back().position;
  out.name = points.back().label.empty() ? "the marked point" : points.back().label;
  if (points.size() == 2) {
    out.entry = points.front().position;
    if (glm::length(*out.entry - out.place) < 1e-3) {
      throw inputError("import.target", "its two points are less than 1 mm apart",
                       "an entry lies where the needle goes in", file);
    }
  }
  out.region = RegionSampler(scan).at(out.place).region;
  if (out.region == scan.survey.outside()) {
    throw inputError("import.target",
                     "'" + out.name + "' at " + formatVector(1e3 * out.place, 5) +
                         " mm (RAS) is outside the body",
                     "mark it in the image that the labels are of, in the same patient space",
                     file);
  }
  return out;
}

}  // namespace

WayTarget wayTarget(const ImportedScan& scan, const std::string& target) {
  if (isMarkupsName(target)) return markedTarget(scan, target);
  const Labels found = labelsOf(scan, target);
  return {found.name, found.region, Depths(scan.labels, found.labels).deepest()};
}

}  // namespace palpate::tools
