#include "palpate/vdb/scan_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palpate/core/text.h"
#include "palpate/vdb/text.h"
#include "scan/keep_centers.h"
#include "scan/label_partition.h"
#include "scan/lattice.h"
#include "scan/lattice_spline.h"
#include "scan/mask.h"
#include "scan/redistance.h"
#include "scan/scan_loss.h"

namespace palpate::vdb {
namespace {

// Shares of the total time, measured on the skin of a head at 1 mm with two cores; the rest is for
// the distances.
constexpr double kMaskDone = 0.3;
constexpr double kBandDone = 0.5;

/// Printed with all digits of a float.
std::string levelText(double value) { return shortNumber(value, 9); }

double smallestSpacing(const Image& image) {
  double smallest = glm::length(image.axes[0]);
  for (int a = 1; a < 3; ++a) smallest = std::min(smallest, glm::length(image.axes[a]));
  return smallest;
}

/// [m] The center of a grid's voxel (0, 0, 0) for which the centers of the image's voxels are
/// centers of the grid's voxels, along each axis of the world where the image's steps are whole
/// voxels. Parts as thin as a voxel are held best this way, and each center is on the side that its
/// value says.
Vec3 phaseOf(const Image& image, double voxel) {
  constexpr double kWhole = 1e-4;  // [voxels] that an axis or a step may be off, from end to end
  Vec3 phase(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    bool is_whole = true;
    for (int a = 0; a < 3; ++a) {
      const double steps = image.axes[a][axis] / voxel;
      const double off = std::abs(steps - std::round(steps)) *
                         static_cast<double>(image.size[static_cast<std::size_t>(a)]);
      is_whole = is_whole && off < kWhole;
    }
    const double first = image.origin[axis] / voxel;
    if (is_whole) phase[axis] = (first - std::round(first)) * voxel;
  }
  return phase;
}

/// Bakes the surface of a band of values, which has the mask's sign everywhere.
LevelSet bakeBand(const MaskedBand& of, const Image& image, double voxel_size, BakeOptions bake,
                  const Progress& progress) {
  const Band& band = of.band;
  const Mask& mask = of.mask;
  if (voxel_size > 0.0) {
    bake.voxel_size = voxel_size;
  } else if (!(bake.voxel_size > 0.0)) {
    bake.voxel_size = smallestSpacing(image);
  }
  bake.metadata["source"] = image.source;
  bake.metadata["frame"] = "RAS";
  const Vec3 phase = phaseOf(image, bake.voxel_size);
  const Vec3 first = image.toWorld(Vec3(mask.first[0], mask.first[1], mask.first[2]));
  const LatticeSpline spline(band, mask, image.axes, first - phase);
  Progress rest;
  if (progress) {
    rest = [&](std::string_view what, double fraction) {
      return progress(what, kBandDone + (1.0 - kBandDone) * std::max(fraction, 0.0));
    };
  }
  const std::optional<Box3> box = bake.box;
  bake.box.reset();
  BakeOptions wide = bake;
  if (box) wide.half_width += kCubicHalfWidth;
  const LevelSet whole = bakeSpline(
      spline, band, mask, image, wide, rest, phase, [&](const openvdb::FloatGrid::Ptr& grid) {
        keepCenters(grid, of, image, phase, checkOptions(wide), wide.length_unit);
      });
  const auto lost = metadataOf(findLoss(whole, band, mask, of.neighbors, image));
  if (!box) return whole.named(whole.info().name, lost);
  // The faces where a box cuts are flat: those of the baked field.
  bake.box = box;
  bake.metadata.insert(lost.begin(), lost.end());
  return palpate::vdb::bake(*gridField(whole), bake, {});
}

std::string sideOf(bool is_below) { return is_below ? "below " : "above "; }

Error nothingThere(const Image& image, bool is_below, double level) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double last = is_below ? kNone : -kNone;
  for (const float value : image.values) {
    last = is_below ? std::fmin(last, static_cast<double>(value))
                    : std::fmax(last, static_cast<double>(value));
  }
  return inputError(
      "scan.empty",
      "nothing in the image lies " + sideOf(is_below) + levelText(level) +
          (is_below ? "; its smallest value is " : "; its largest value is ") + levelText(last),
      is_below ? "choose a higher threshold" : "choose a lower threshold", image.source);
}

}  // namespace

LevelSet surfaceFromThreshold(const Image& image, const ThresholdOptions& options,
                              const BakeOptions& bake, const Progress& progress) {
  report(progress, "threshold", 0.0);
  const bool is_below = options.below.has_value();
  const double level = options.below.value_or(options.above);
  if (!std::isfinite(level)) {
    throw inputError("scan.threshold", "the threshold is " + levelText(level),
                     "give a finite intensity", image.source);
  }
  const auto is_inside = [&](float value) {
    return is_below ? static_cast<double>(value) < level : static_cast<double>(value) > level;
  };
  Mask mask = maskOf(image, is_inside, kBandMargin);
  if (mask.inside.empty()) throw nothingThere(image, is_below, level);
  if (options.largest_component) keepLargestPiece(mask);
  if (options.fill) fillCavities(mask);
  report(progress, "threshold", kMaskDone);
  BakeOptions with_source = bake;
  with_source.metadata["threshold"] = sideOf(is_below) + levelText(level) +
                                      (options.largest_component ? ", largest piece" : "") +
                                      (options.fill ? ", filled" : "");
  const Vec3 lengths(glm::length(image.axes[0]), glm::length(image.axes[1]),
                     glm::length(image.axes[2]));
  Band band = bandOfThreshold(image, level, mask, lengths / smallestSpacing(image));
  return bakeBand({std::move(mask), std::move(band)}, image, options.voxel_size,
                  std::move(with_source), progress);
}

struct LabelSurfaces::Impl {
  Impl(const Image& of, std::vector<std::vector<int>> labels)
      : image(of), layers(std::move(labels)), partition(of, layers) {}
  const Image& image;
  std::vector<std::vector<int>> layers;
  LabelPartition partition;
};

LabelSurfaces::LabelSurfaces(const Image& image, std::vector<std::vector<int>> layers)
    : impl_(std::make_unique<Impl>(image, std::move(layers))) {}

LabelSurfaces::~LabelSurfaces() = default;

namespace {

/// Progress of several smoothings, one after another, as the first part of the whole.
Progress smoothingOf(const Progress& progress) {
  if (!progress) return {};
  return [&progress, last = 0.0](std::string_view what, double fraction) mutable {
    last = std::max(last, kBandDone * fraction);
    return progress(what, last);
  };
}

}  // namespace

LevelSet LabelSurfaces::surface(std::size_t layer, double voxel_size, const BakeOptions& bake,
                                const Progress& progress, LabelEdge edge) {
  report(progress, "labels", 0.0);
  const MaskedBand found = impl_->partition.layer(layer, edge, smoothingOf(progress));
  const std::string list = listOf(impl_->layers[layer]);
  if (found.mask.inside.empty()) {
    throw inputError(
        "scan.empty",
        list.empty() ? "no label is asked for" : "no voxel of the image has the label " + list,
        "name labels that the image holds", impl_->image.source);
  }
  BakeOptions with_source = bake;
  with_source.metadata["labels"] = list;
  return bakeBand(found, impl_->image, voxel_size, std::move(with_source), progress);
}

std::optional<LevelSet> LabelSurfaces::united(double voxel_size, const BakeOptions& bake,
                                              const Progress& progress) {
  report(progress, "labels", 0.0);
  const std::optional<MaskedBand> found = impl_->partition.unite(smoothingOf(progress));
  if (!found) return {};
  std::vector<int> all;
  for (const std::vector<int>& layer : impl_->layers) {
    all.insert(all.end(), layer.begin(), layer.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  BakeOptions with_source = bake;
  with_source.metadata["labels"] = listOf(all);
  return bakeBand(*found, impl_->image, voxel_size, std::move(with_source), progress);
}

LevelSet surfaceFromLabels(const Image& image, const LabelOptions& options, const BakeOptions& bake,
                           const Progress& progress) {
  return LabelSurfaces(image, {options.values}).surface(0, options.voxel_size, bake, progress);
}

}  // namespace palpate::vdb
