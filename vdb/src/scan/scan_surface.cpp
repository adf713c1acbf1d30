#include "palpate/vdb/scan_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "scan/label_partition.h"
#include "scan/lattice.h"
#include "scan/lattice_spline.h"
#include "scan/mask.h"
#include "scan/net_field.h"
#include "scan/surface_net.h"

namespace palpate::vdb {
namespace {

// Shares of the time, measured on the skin of a head at 1 mm with two cores; the rest is bake()'s.
constexpr double kMaskDone = 0.15;
constexpr double kLatticeDone = 0.18;
constexpr double kSurfaceDone = 0.25;
constexpr double kNearestDone = 0.5;

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

double smallestSpacing(const Image& image) {
  double smallest = glm::length(image.axes[0]);
  for (int a = 1; a < 3; ++a) smallest = std::min(smallest, glm::length(image.axes[a]));
  return smallest;
}

/// `band` holds the lattice's values around the surface.
LevelSet bakeLattice(const Lattice& lattice, const Band& band, const Mask& mask, const Image& image,
                     double voxel_size, BakeOptions bake, const Progress& progress) {
  report(progress, "surface", kLatticeDone);
  const Mesh mesh = surfaceNet(lattice, image);
  if (voxel_size > 0.0) {
    bake.voxel_size = voxel_size;
  } else if (!(bake.voxel_size > 0.0)) {
    bake.voxel_size = smallestSpacing(image);
  }
  bake.metadata["source"] = image.source;
  bake.metadata["frame"] = "RAS";
  report(progress, "distances", kSurfaceDone);
  const LatticeSpline spline(band, mask, image.axes,
                             image.toWorld(Vec3(mask.first[0], mask.first[1], mask.first[2])));
  const NetField field(mesh, lattice, image, (bake.half_width + 0.1) * bake.voxel_size, &spline);
  Progress rest;
  if (progress) {
    rest = [&](std::string_view, double fraction) {
      return progress("bake", kNearestDone + (1.0 - kNearestDone) * std::max(fraction, 0.0));
    };
  }
  return palpate::vdb::bake(field, bake, rest);
}

}  // namespace

LevelSet surfaceFromThreshold(const Image& image, const ThresholdOptions& options,
                              const BakeOptions& bake, const Progress& progress) {
  report(progress, "threshold", 0.0);
  if (!std::isfinite(options.above)) {
    throw inputError("scan.threshold", "the threshold is " + shortNumber(options.above),
                     "give a finite intensity", image.source);
  }
  const auto is_above = [&](float value) { return static_cast<double>(value) > options.above; };
  Mask mask = maskOf(image, is_above, kBandMargin);
  if (mask.inside.empty()) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const float value : image.values) largest = std::fmax(largest, static_cast<double>(value));
    throw inputError("scan.empty",
                     "nothing in the image lies above " + shortNumber(options.above) +
                         "; its largest value is " + shortNumber(largest),
                     "choose a lower threshold", image.source);
  }
  if (options.largest_component) keepLargestPiece(mask);
  if (options.fill) fillCavities(mask);
  report(progress, "threshold", kMaskDone);
  BakeOptions with_source = bake;
  with_source.metadata["threshold"] = "above " + shortNumber(options.above) +
                                      (options.largest_component ? ", largest piece" : "") +
                                      (options.fill ? ", filled" : "");
  const Lattice lattice = latticeOfThreshold(image, options.above, mask);
  const Vec3 lengths(glm::length(image.axes[0]), glm::length(image.axes[1]),
                     glm::length(image.axes[2]));
  const Band band = bandOfLattice(lattice, mask, lengths / smallestSpacing(image));
  return bakeLattice(lattice, band, mask, image, options.voxel_size, std::move(with_source),
                     progress);
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

LevelSet LabelSurfaces::surface(std::size_t layer, double voxel_size, const BakeOptions& bake,
                                const Progress& progress) {
  report(progress, "labels", 0.0);
  const Image& image = impl_->image;
  Progress smoothing;
  double last = 0.0;
  if (progress) {
    // Neighbors are smoothed too, one after the other.
    smoothing = [&](std::string_view what, double fraction) {
      last = std::max(last, kLatticeDone * fraction);
      return progress(what, last);
    };
  }
  const MaskedBand found = impl_->partition.layer(layer, smoothing);
  std::string list;
  for (const int label : impl_->layers[layer]) {
    list += (list.empty() ? "" : ", ") + std::to_string(label);
  }
  if (found.mask.inside.empty()) {
    throw inputError(
        "scan.empty",
        list.empty() ? "no label is asked for" : "no voxel of the image has the label " + list,
        "name labels that the image holds", image.source);
  }
  BakeOptions with_source = bake;
  with_source.metadata["labels"] = list;
  return bakeLattice(latticeOf(found.band, found.mask), found.band, found.mask, image, voxel_size,
                     std::move(with_source), progress);
}

LevelSet surfaceFromLabels(const Image& image, const LabelOptions& options, const BakeOptions& bake,
                           const Progress& progress) {
  return LabelSurfaces(image, {options.values}).surface(0, options.voxel_size, bake, progress);
}

}  // namespace palpate::vdb
