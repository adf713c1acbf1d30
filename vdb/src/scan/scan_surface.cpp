#include "palpate/vdb/scan_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "scan/lattice.h"
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

LevelSet bakeLattice(const Lattice& lattice, const Image& image, double voxel_size,
                     BakeOptions bake, const Progress& progress) {
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
  const NetField field(mesh, lattice, image, (bake.half_width + 0.1) * bake.voxel_size);
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
  const auto is_above = [&](float value) { return static_cast<double>(value) > options.above; };
  Mask mask = maskOf(image, is_above, 1);
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
  return bakeLattice(latticeOfThreshold(image, options.above, mask), image, options.voxel_size,
                     std::move(with_source), progress);
}

LevelSet surfaceFromLabels(const Image& image, const LabelOptions& options, const BakeOptions& bake,
                           const Progress& progress) {
  report(progress, "labels", 0.0);
  const auto is_label = [&](float value) {
    return std::any_of(options.values.begin(), options.values.end(),
                       [&](int label) { return static_cast<float>(label) == value; });
  };
  const Mask mask = maskOf(image, is_label, kLabelMargin);
  std::string list;
  for (const int label : options.values) list += (list.empty() ? "" : ", ") + std::to_string(label);
  if (mask.inside.empty()) {
    throw inputError(
        "scan.empty",
        list.empty() ? "no label is asked for" : "no voxel of the image has the label " + list,
        "name labels that the image holds", image.source);
  }
  report(progress, "labels", kMaskDone);
  BakeOptions with_source = bake;
  with_source.metadata["labels"] = list;
  return bakeLattice(latticeOfLabels(mask), image, options.voxel_size, std::move(with_source),
                     progress);
}

}  // namespace palpate::vdb
