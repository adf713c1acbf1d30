#pragma once
/// Contents of a label image: how much of each region, in how many pieces, and what touches what.
///
/// A region is a set of labels. Voxels that are in no region are the gap if they are in the body,
/// and outside if not; without a body, all of them are outside. Voxels of a region are connected
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

/// The voxels of `grid` that are in the body: the largest connected component of `image` brighter
/// than `above`, with its cavities filled. `threshold: {above, keep: largest, fill: true}` of a
/// scene is made from the same voxels. Where the two images differ in place, the nearest voxel of
/// `image` counts.
/// @throws Error (kInput, "scan.empty") if nothing is brighter.
[[nodiscard]] VoxelMask bodyMask(const Image& image, double above, const Image& grid,
                                 const Progress& progress = {});

/// The voxels of `grid` where `image` is not 0.
[[nodiscard]] VoxelMask labelMask(const Image& image, const Image& grid);

/// Number of voxels of each label, 0 included.
/// @throws Error (kInput, "labels.not_labels"), naming a voxel, for values that are not whole
/// numbers from 0 to 65535, and for images whose values change with almost every voxel, as gray
/// values do.
[[nodiscard]] std::map<int, std::uint64_t> countLabels(const Image& image);

class LabelRuns;

struct LabelSurvey {
  /// A connected component of the voxels of one region.
  struct Piece {
    std::uint64_t voxels = 0;
    Vec3 place{0.0, 0.0, 0.0};  ///< [m] center of one of its voxels
    bool at_border = false;     ///< of the image
    std::size_t around = 0;     ///< the region that most of its faces touch; outside() if none
    std::size_t id = 0;         ///< for changeIslands()
  };
  struct Contact {
    /// A region, gap() or outside(); the image's border counts as outside()
    std::size_t other = 0;
    double area = 0.0;  ///< [m2] of the surface between the two, approximately
  };
  struct Region {
    std::uint64_t voxels = 0;
    double volume = 0.0;  ///< [m3]
    double area = 0.0;    ///< [m2] two thirds of its voxels' faces: a voxelized surface has 3/2 of
                          ///< the true area on the mean
    Box3 bounds;          ///< [m] of its voxels' centers
    bool at_border = false;
    double border = 0.0;            ///< [m2] of its area that the image's border cuts off
    std::vector<Piece> pieces;      ///< the largest first
    std::vector<Contact> contacts;  ///< the largest first
    /// The innermost region that every voxel path from outside to this region leads through. Where
    /// the image's border cuts a region, it is not open to outside, unless nothing in the image is
    /// outside.
    std::optional<std::size_t> within;
  };

  std::vector<Region> regions;  ///< those asked for, then the gap, then outside
  std::shared_ptr<const LabelRuns> runs;

  [[nodiscard]] std::size_t gap() const noexcept { return regions.size() - 2; }
  [[nodiscard]] std::size_t outside() const noexcept { return regions.size() - 1; }
};

/// `regions`: the labels of each; no label may be in two of them. `body` may be null.
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

/// Changes, in `image`, pieces of less than `smaller_than` voxels, but never the largest piece of a
/// region. kMerge fills unlabeled cavities that do not reach the image's border with the region
/// around them; kDrop leaves them. `survey` and `regions` are those of the image before. Returns
/// the changes, the largest first.
std::vector<IslandChange> changeIslands(Image& image, const std::vector<std::vector<int>>& regions,
                                        const LabelSurvey& survey, std::uint64_t smaller_than,
                                        IslandRule rule);

}  // namespace palpate::vdb
