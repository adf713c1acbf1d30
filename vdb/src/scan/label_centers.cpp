#include "palpate/vdb/label_centers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

namespace palpate::vdb {
namespace {

class Counter {
 public:
  Counter(const Image& image, const std::map<int, int>& part_of,
          const std::function<int(const Vec3&)>& part_at)
      : image_(image), part_at_(part_at), parts_(image.values.size(), kNoPart) {
    tbb::parallel_for(0, image.size[2], [&](int k) {
      std::size_t n = placeOf(0, 0, k);
      const std::size_t end = placeOf(0, 0, k + 1);
      float last = 0.0F;
      int part = partOf(part_of, last);
      for (; n < end; ++n) {
        const float label = image.values[n];
        if (label != last) part = partOf(part_of, last = label);
        parts_[n] = part;
      }
    });
  }

  LabelCenters run() {
    std::vector<LabelCenters> slices(static_cast<std::size_t>(image_.size[2]));
    tbb::parallel_for(0, image_.size[2],
                      [&](int k) { countSlice(k, slices[static_cast<std::size_t>(k)]); });
    LabelCenters sum;
    for (const LabelCenters& slice : slices) {
      for (const auto& [part, count] : slice.parts) {
        for (CenterCount* to : {&sum.parts[part], &sum.all}) {
          to->centers += count.centers;
          to->changed += count.changed;
          to->against += count.against;
        }
      }
      if (!sum.place) sum.place = slice.place;
    }
    return sum;
  }

 private:
  [[nodiscard]] static int partOf(const std::map<int, int>& part_of, float label) {
    const auto found = part_of.find(static_cast<int>(label));
    return found == part_of.end() || static_cast<float>(found->first) != label ? kNoPart
                                                                               : found->second;
  }
  [[nodiscard]] std::size_t placeOf(int i, int j, int k) const noexcept {
    const auto [nx, ny, nz] = image_.size;
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(nx) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(ny) * static_cast<std::size_t>(k));
  }

  /// Of the voxels at most `reach` away along each axis, itself not, how many are there and how
  /// many have the same part.
  struct Near {
    int all = 0;
    int same = 0;
  };
  [[nodiscard]] Near near(int i, int j, int k, int reach) const noexcept {
    const int own = parts_[placeOf(i, j, k)];
    Near near;
    for (int z = std::max(0, k - reach); z <= std::min(image_.size[2] - 1, k + reach); ++z) {
      for (int y = std::max(0, j - reach); y <= std::min(image_.size[1] - 1, j + reach); ++y) {
        const int first = std::max(0, i - reach);
        const int last = std::min(image_.size[0] - 1, i + reach);
        const std::size_t row = placeOf(0, y, z);
        for (int x = first; x <= last; ++x) {
          near.same += parts_[row + static_cast<std::size_t>(x)] == own ? 1 : 0;
        }
        near.all += last - first + 1;
      }
    }
    return {near.all - 1, near.same - 1};
  }

  void countSlice(int k, LabelCenters& to) const {
    for (int j = 0; j < image_.size[1]; ++j) {
      for (int i = 0; i < image_.size[0]; ++i) {
        const int own = parts_[placeOf(i, j, k)];
        const Near around = near(i, j, k, 1);
        const bool is_beside = around.same < around.all;
        if (own == kNoPart && !is_beside) continue;
        CenterCount& count = to.parts[own];
        ++count.centers;
        if (!is_beside) {
          const Near farther = near(i, j, k, 2);
          if (farther.same == farther.all) continue;
        }
        const Vec3 p = image_.toWorld(Vec3(i, j, k));
        const int now = part_at_(p);
        if (now == own || now == kOtherPart) continue;
        ++count.changed;
        if (2 * around.same < around.all) continue;
        ++count.against;
        if (!to.place) to.place = p;
      }
    }
  }

  const Image& image_;
  const std::function<int(const Vec3&)>& part_at_;
  std::vector<int> parts_;
};

}  // namespace

LabelCenters countCenters(const Image& image, const std::map<int, int>& part_of,
                          const std::function<int(const Vec3&)>& part_at) {
  return Counter(image, part_of, part_at).run();
}

}  // namespace palpate::vdb
