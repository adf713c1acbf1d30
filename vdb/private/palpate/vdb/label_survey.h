#pragma once
/// What a label image holds: how much of each region, in how many pieces, and what touches what.
///
/// A region is a set of labels. Voxels that are in no region are the gap if they are in the body,
/// and outside if not; without a body, all of them are outside. Voxels of a region hang together
/// across faces, others across faces and edges, as for the surfaces of scans. Set-up only, on any
/// thread.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "palpate/core/progress.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// 1 or 0 for each voxel of an image, in its order.
using VoxelMask = std::vector<std::uint8_t>;

/// The voxels of `grid` that are in the body: the largest piece of `image` brighter than `above`,
/// with its cavities filled, which is what `threshold: {above, keep: largest, fill: true}` of a
/// scene is made from. Where the two images differ in place, the voxel of `image` that is nearest
/// counts.
/// @throws Error (kInput, "scan.empty") if nothing is brighter.
[[nodiscard]] VoxelMask bodyMask(const Image& image, double above, const Image& grid,
                                 const Progress& progress = {});

/// The voxels of `grid` where `image` is not 0.
[[nodiscard]] VoxelMask labelMask(const Image& image, const Image& grid);

/// Voxels of each label, 0 included.
/// @throws Error (kInput, "labels.not_labels"), naming a voxel, for values that are not whole
/// numbers from 0 to 65535, and for images whose values change with almost every voxel, as gray
/// values do.
[[nodiscard]] std::map<int, std::uint64_t> countLabels(const Image& image);

class LabelRuns;

struct LabelSurvey {
  /// Voxels of one region that hang together.
  struct Piece {
    std::uint64_t voxels = 0;
    Vec3 place{0.0, 0.0, 0.0};  ///< [m] center of one of its voxels
    bool at_border = false;     ///< of the image
    std::size_t around = 0;     ///< the region that most of its faces touch; outside() if none
    std::size_t id = 0;         ///< for changeIslands()
  };
  struct Contact {
    std::size_t other = 0;  ///< a region, gap() or outside(), to which the image's border counts
    double area = 0.0;      ///< [m2] of the surface between the two, about
  };
  struct Region {
    std::uint64_t voxels = 0;
    double volume = 0.0;  ///< [m3]
    double area = 0.0;  ///< [m2] two thirds of its voxels' faces: their mean excess over a surface
    Box3 bounds;        ///< [m] of its voxels' centers
    bool at_border = false;
    double border = 0.0;            ///< [m2] of its area that the image's border cuts off
    std::vector<Piece> pieces;      ///< the largest first
    std::vector<Contact> contacts;  ///< the largest first
    /// The innermost region that every way to it from outside, voxel by voxel, leads through. What
    /// the image's border cuts is not open to outside there, unless nothing in the image is
    /// outside.
    std::optional<std::size_t> within;
  };

  std::vector<Region> regions;  ///< those asked for, then the gap, then outside
  std::shared_ptr<const LabelRuns> runs;

  [[nodiscard]] std::size_t gap() const noexcept { return regions.size() - 2; }
  [[nodiscard]] std::size_t outside() const noexcept { return regions.size() - 1; }
};

/// `regions`: the labels of each; no label may be in two. `body` may be null.
[[nodiscard]] LabelSurvey surveyLabels(const Image& image,
                                       const std::vector<std::vector<int>>& regions,
                                       const VoxelMask* body, const Progress& progress = {});

enum class IslandRule {
  kMerge,  ///< becomes part of what is around it
  kDrop    ///< becomes unlabeled
};

/// A piece of a region, or an unlabeled cavity, that was changed.
struct IslandChange {
  std::size_t from = 0;  ///< region, gap() or outside()
  std::size_t to = 0;
  std::uint64_t voxels = 0;
  Vec3 place{0.0, 0.0, 0.0};  ///< [m]
};

/// Changes, in `image`, pieces of less than `smaller_than` voxels, of which the largest of a region
/// is none. Unlabeled cavities that do not reach the image's border are filled with what is around
/// them by kMerge, and left by kDrop. `survey` and `regions` are those of the image before. What
/// was changed, the largest first.
std::vector<IslandChange> changeIslands(Image& image, const std::vector<std::vector<int>>& regions,
                                        const LabelSurvey& survey, std::uint64_t smaller_than,
                                        IslandRule rule);

}  // namespace palpate::vdb
