#include "scan/cliff_faces.h"

#include "scan/thin_parts.h"

namespace palpate::vdb {
namespace {

constexpr int kFar = 64;        ///< [voxels] a face that is level longer than this may be tilted
constexpr int kMostStep = 2;    ///< [voxels] a higher one is a cliff
constexpr int kRoundEdges = 2;  ///< [voxels] faces are free nearer to a cliff than this

class Face {
 public:
  Face(const Mask& mask, const std::array<int, 3>& at, std::size_t axis, int way) noexcept
      : mask_(mask), at_(at), axis_(axis), way_(way), side_(isInside(at)) {}

  /// Whether the face ends in a cliff, far enough away, or with the image.
  [[nodiscard]] bool endsInCliff(std::size_t along, int way) const noexcept {
    for (int n = 1; n <= kFar; ++n) {
      std::array<int, 3> next = at_;
      next[along] += n * way;
      if (!isIn(mask_, next)) return true;
      if (isLevel(next, 0)) continue;
      for (int step = 1; step <= kMostStep; ++step) {
        if (isLevel(next, step) || isLevel(next, -step)) return false;
      }
      return n >= kRoundEdges;
    }
    return false;
  }

 private:
  [[nodiscard]] bool isInside(const std::array<int, 3>& at) const noexcept {
    return mask_.inside[static_cast<std::size_t>(mask_.at(at[0], at[1], at[2]))] != 0;
  }
  /// Whether the face is there, `step` voxels higher.
  [[nodiscard]] bool isLevel(std::array<int, 3> at, int step) const noexcept {
    at[axis_] += way_ * step;
    std::array<int, 3> beyond = at;
    beyond[axis_] += way_;
    return isIn(mask_, at) && isIn(mask_, beyond) && isInside(at) == side_ &&
           isInside(beyond) != side_;
  }

  const Mask& mask_;
  std::array<int, 3> at_;
  std::size_t axis_;
  int way_;
  bool side_;
};

}  // namespace

std::optional<int> cliffFaceAxis(const Mask& mask, const std::array<int, 3>& at) noexcept {
  const auto strides = mask.strides();
  const std::ptrdiff_t here = mask.at(at[0], at[1], at[2]);
  const std::uint8_t side = mask.inside[static_cast<std::size_t>(here)];
  int axis = -1;
  int way = 0;
  for (int a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      std::array<int, 3> next = at;
      next[static_cast<std::size_t>(a)] += step;
      if (!isIn(mask, next)) continue;
      const std::ptrdiff_t there = here + step * strides[static_cast<std::size_t>(a)];
      if (mask.inside[static_cast<std::size_t>(there)] == side) continue;
      if (axis >= 0) return std::nullopt;
      axis = a;
      way = step;
    }
  }
  if (axis < 0) return std::nullopt;
  const Face face(mask, at, static_cast<std::size_t>(axis), way);
  for (int a = 1; a < 3; ++a) {
    const auto along = static_cast<std::size_t>((axis + a) % 3);
    if (!face.endsInCliff(along, -1) || !face.endsInCliff(along, 1)) return std::nullopt;
  }
  return axis;
}

}  // namespace palpate::vdb
