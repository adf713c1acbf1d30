#include "image/planes.h"

#include <algorithm>
#include <cmath>

#include "palpate/core/error.h"
#include "palpate/core/text.h"

namespace palpate::vdb {
namespace {

/// [mm] Positions of one plane can differ by this much if written with six digits.
constexpr double kSamePlane = 1e-3;
/// [share of a step] The same tolerance as for slices of a series.
constexpr double kEvenSteps = 0.05;
/// No scan has more planes; more come from a damaged position.
constexpr double kMostPlanes = 4096.0;

/// How far the worst of `heights` is off a multiple of `step`, in steps.
double unevenness(const std::vector<double>& heights, double step) {
  double worst = 0.0;
  for (const double height : heights) {
    const double at = (height - heights.front()) / step;
    worst = std::max(worst, std::abs(at - std::round(at)));
  }
  return worst;
}

}  // namespace

PlaneGrid planeGrid(const PlaneSet& planes, int margin, const std::string& path,
                    std::vector<std::string>& notes) {
  const Vec3 normal = glm::cross(planes.along_row, planes.along_column);
  std::vector<double> heights;
  for (const Vec3& position : planes.positions) heights.push_back(glm::dot(position, normal));
  std::sort(heights.begin(), heights.end());
  const auto same = [](double a, double b) { return b - a < kSamePlane; };
  heights.erase(std::unique(heights.begin(), heights.end(), same), heights.end());
  double least = 0.0;
  for (std::size_t n = 1; n < heights.size(); ++n) {
    const double gap = heights[n] - heights[n - 1];
    least = n == 1 ? gap : std::min(least, gap);
  }
  double step = planes.stated_step;
  if (!(step > 0.0) || unevenness(heights, step) > kEvenSteps) {
    if (step > 0.0 && least > 0.0) {
      notes.push_back(
          "the header gives a step of " + shortNumber(step, 4) +
          " mm between planes, but the planes lie otherwise: the smallest gap is used, " +
          shortNumber(least, 4) + " mm");
    }
    step = least;
  }
  if (!(step > 0.0)) {
    throw inputError("dicom.spacing", "all of it lies in one plane, whose thickness is not given",
                     {}, path);
  }
  if (unevenness(heights, step) > kEvenSteps) {
    throw inputError("dicom.spacing",
                     "the planes are not evenly spaced: the least gap is " + shortNumber(least, 4) +
                         " mm, and others are not multiples of it",
                     "resample the scan evenly before it is segmented", path);
  }
  const double across = (heights.back() - heights.front()) / step;
  if (!(across < kMostPlanes)) {
    throw inputError("dicom.spacing",
                     "the planes lie from " + shortNumber(heights.front(), 4) + " to " +
                         shortNumber(heights.back(), 4) + " mm, " + shortNumber(step, 4) +
                         " mm apart, which cannot be",
                     "fetch or write the file again", path);
  }
  PlaneGrid grid;
  std::size_t lowest = 0;
  std::size_t highest = 0;
  for (std::size_t n = 0; n < planes.positions.size(); ++n) {
    const double height = glm::dot(planes.positions[n], normal);
    grid.index.push_back(static_cast<int>(std::lround((height - heights.front()) / step)));
    if (grid.index[n] < grid.index[lowest]) lowest = n;
    if (grid.index[n] > grid.index[highest]) highest = n;
  }
  const int last = grid.index[highest];
  grid.first = planes.positions[lowest];
  // With a tilted gantry the planes do not lie straight above one another.
  grid.step = last > 0 ? (planes.positions[highest] - grid.first) / static_cast<double>(last)
                       : step * normal;
  for (std::size_t n = 0; n < planes.positions.size(); ++n) {
    const Vec3 expected = grid.first + static_cast<double>(grid.index[n]) * grid.step;
    const double off = glm::length(planes.positions[n] - expected);
    if (off <= kEvenSteps * step) continue;
    throw inputError("dicom.spacing",
                     "plane " + std::to_string(n + 1) + " is " + shortNumber(off, 3) +
                         " mm off the line that the others' positions are on",
                     "resample the scan evenly before it is segmented", path);
  }
  grid.first -= static_cast<double>(margin) * grid.step;
  for (int& index : grid.index) index += margin;
  grid.count = last + 1 + 2 * margin;
  return grid;
}

Place placeOf(const PlaneSet& planes, const PlaneGrid& grid, const std::string& path) {
  Place lps;
  lps.axes[0] = planes.along_row * planes.column_spacing;
  lps.axes[1] = planes.along_column * planes.row_spacing;
  lps.axes[2] = grid.step;
  lps.origin = grid.first;
  Place place = scaled(turned(lps), 1e-3);
  if (!isUsable(place)) {
    throw inputError("dicom.singular", "the planes' positions give the voxels no volume", {}, path);
  }
  return place;
}

}  // namespace palpate::vdb
