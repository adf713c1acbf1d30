#include "image/dicom_contours.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "image/dicom_codes.h"
#include "image/dicom_series.h"
#include "image/image_parts.h"
#include "image/planes.h"
#include "image/polygon_fill.h"
#include "image/structures.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/core/text.h"

namespace palpate::vdb {
namespace {

using namespace dicom;

constexpr std::uint32_t kFrameOfReference = 0x30060010;
constexpr std::uint32_t kStudy = 0x30060012;
constexpr std::uint32_t kSeries = 0x30060014;
constexpr std::uint32_t kRois = 0x30060020;
constexpr std::uint32_t kRoiNumber = 0x30060022;
constexpr std::uint32_t kRoiName = 0x30060026;
constexpr std::uint32_t kColor = 0x3006002A;
constexpr std::uint32_t kRoiContours = 0x30060039;
constexpr std::uint32_t kContours = 0x30060040;
constexpr std::uint32_t kGeometry = 0x30060042;
constexpr std::uint32_t kPointCount = 0x30060046;
constexpr std::uint32_t kContourData = 0x30060050;
constexpr std::uint32_t kObservations = 0x30060080;
constexpr std::uint32_t kReferredRoi = 0x30060084;
constexpr std::uint32_t kRoiCode = 0x30060086;

/// [share of a step] A contour that is farther from its slice was drawn on another one.
constexpr double kOnSlice = 0.1;
/// [mm] Largest pixel width of a grid that is made here because no series gives one.
constexpr double kOwnPixel = 1.0;
/// Most voxels of such a grid: more come only from a damaged coordinate.
constexpr double kMostVoxels = 1e9;

using Contour = std::vector<Vec3>;  ///< [mm], LPS

struct Roi {
  std::string name;
  std::vector<Contour> contours;
};

struct StructureSet {
  std::string path;
  std::vector<Roi> rois;
  LabelTable table;
  LabelCodes codes;
  std::string series;  ///< UID; empty if the file refers to none
  std::vector<std::string> notes;
};

Error fail(const DicomItem& of, const char* code, std::string message, std::string hint = {}) {
  return inputError(code, std::move(message), std::move(hint), of.path);
}

/// An integer, which DICOM writes as text.
int wholeAt(const DicomItem& item, std::uint32_t tag, const char* name) {
  if (item.text(tag).empty()) {
    throw fail(item, "dicom.contours", std::string("a structure has no ") + name);
  }
  const double number = item.numbers(tag, 1).front();
  constexpr double kMost = 2147483647.0;
  if (number != std::floor(number) || std::abs(number) > kMost) {
    throw fail(item, "dicom.value", std::string(name) + " is '" + item.text(tag) + "'");
  }
  return static_cast<int>(number);
}

Contour contourOf(const DicomItem& item, const std::string& roi) {
  const std::vector<double> numbers = item.numbers(kContourData, 0);
  const std::size_t points = numbers.size() / 3;
  const bool is_counted = !item.text(kPointCount).empty();
  if (numbers.size() % 3 != 0 ||
      (is_counted && item.numbers(kPointCount, 1).front() != static_cast<double>(points))) {
    throw fail(item, "dicom.contours",
               "a contour of '" + roi + "' claims " +
                   (is_counted ? item.text(kPointCount) : std::string("some")) +
                   " points but has " + std::to_string(numbers.size()) +
                   " numbers (a point has three)",
               "fetch or write the file again");
  }
  Contour contour;
  for (std::size_t n = 0; n < points; ++n) {
    contour.emplace_back(numbers[3 * n], numbers[3 * n + 1], numbers[3 * n + 2]);
  }
  return contour;
}

/// Reads the closed contours of a structure; returns how many others it has.
std::size_t readContours(const DicomItem& of, Roi& roi) {
  std::size_t others = 0;
  for (const DicomItem& item : of.items(kContours)) {
    const std::string kind = item.text(kGeometry);
    if (kind != "CLOSED_PLANAR" && kind != "CLOSEDPLANAR_XOR") {
      ++others;
      continue;
    }
    Contour contour = contourOf(item, roi.name);
    if (contour.size() < 3) {
      ++others;
    } else {
      roi.contours.push_back(std::move(contour));
    }
  }
  return others;
}

StructureSet readSet(const std::string& path) {
  const DicomElements file = readDicomElements(path, DicomDepth::kSequencesToo);
  StructureSet out;
  out.path = path;
  std::map<int, int> label_of;
  for (const DicomItem& item : file.items(kRois)) {
    const int number = wholeAt(item, kRoiNumber, "ROINumber");
    const int label = static_cast<int>(out.rois.size()) + 1;
    std::string name = item.text(kRoiName);
    if (name.empty()) name = "structure " + std::to_string(number);
    if (!label_of.emplace(number, label).second) {
      throw fail(item, "dicom.contours",
                 "structure '" + name + "' has number " + std::to_string(number) +
                     ", as another structure has",
                 "save the structure set again");
    }
    out.table.names[label] = name;
    out.rois.push_back({std::move(name), {}});
  }
  if (out.rois.empty()) throw fail(file, "dicom.contours", "the file describes no structure");
  std::size_t others = 0;
  for (const DicomItem& item : file.items(kRoiContours)) {
    const int number = wholeAt(item, kReferredRoi, "ReferencedROINumber");
    const auto at = label_of.find(number);
    if (at == label_of.end()) {
      throw fail(item, "dicom.contours",
                 "some contours belong to structure " + std::to_string(number) +
                     ", which the file does not describe",
                 "save the structure set again");
    }
    others += readContours(item, out.rois[static_cast<std::size_t>(at->second) - 1]);
    if (!item.text(kColor).empty()) {
      const std::vector<double> color = item.numbers(kColor, 3);
      const auto share = [](double c) {
        return static_cast<float>(std::clamp(c / 255.0, 0.0, 1.0));
      };
      out.table.colors[at->second] = {share(color[0]), share(color[1]), share(color[2])};
    }
  }
  for (const DicomItem& item : file.items(kObservations)) {
    if (item.text(kReferredRoi).empty()) continue;
    const auto at = label_of.find(wholeAt(item, kReferredRoi, "ReferencedROINumber"));
    const auto code = codeIn(item, kRoiCode);
    if (at != label_of.end() && code) out.codes[at->second] = *code;
  }
  const DicomItem* const frame = file.first(kFrameOfReference);
  const DicomItem* const study = frame == nullptr ? nullptr : frame->first(kStudy);
  const DicomItem* const series = study == nullptr ? nullptr : study->first(kSeries);
  if (series != nullptr) out.series = series->text(kSeriesUid);
  if (others > 0) {
    out.notes.push_back(std::to_string(others) +
                        " contours that are points or open lines were ignored");
  }
  return out;
}

struct ContourGrid {
  std::array<int, 3> size{};
  Place place;  ///< [m], RAS
};

/// The grid of the series in the same folder; nothing if the series is not there.
std::optional<ContourGrid> gridOfSeries(StructureSet& set) {
  if (set.series.empty()) return {};
  std::filesystem::path folder = std::filesystem::path(set.path).parent_path();
  if (folder.empty()) folder = ".";
  try {
    const DicomSeries series = findDicomSeries(folder.string(), set.series, false);
    set.notes.insert(set.notes.end(), series.notes.begin(), series.notes.end());
    return ContourGrid{series.size, series.place};
  } catch (const Error& error) {
    // The series may lie elsewhere, which is not an error here; damage to it is reported.
    const std::string& code = error.problem().code;
    if (code != "dicom.series" && code != "dicom.missing") throw;
    return {};
  }
}

/// A grid around all contours, with pixels as wide as the step between planes, but at most
/// kOwnPixel.
ContourGrid ownGrid(StructureSet& set) {
  PlaneSet planes;
  Box3 box;
  for (const Roi& roi : set.rois) {
    for (const Contour& contour : roi.contours) {
      planes.positions.emplace_back(0.0, 0.0, contour.front().z);
      for (const Vec3& point : contour) {
        box.include(point);
        if (std::abs(point.z - contour.front().z) <= 1e-2) continue;
        throw inputError("dicom.contours",
                         "the contours of '" + roi.name +
                             "' are not axial, and the series on which they were drawn is not in "
                             "the folder",
                         "put the series' files into the folder of the structure set", set.path);
      }
    }
  }
  if (planes.positions.empty()) {
    throw inputError("dicom.contours", "no structure has a closed contour", {}, set.path);
  }
  // One empty plane before the first and behind the last plane of a structure.
  constexpr int kMargin = 1;
  PlaneGrid along = planeGrid(planes, kMargin, set.path, set.notes);
  const double pixel = std::min(kOwnPixel, glm::length(along.step));
  planes.row_spacing = planes.column_spacing = pixel;
  ContourGrid grid;
  double voxels = along.count;
  for (int axis = 0; axis < 2; ++axis) {
    const double pixels = std::ceil((box.hi[axis] - box.lo[axis]) / pixel) + 5.0;
    voxels *= pixels;
    if (!(voxels < kMostVoxels)) {
      throw inputError("dicom.contours",
                       "the contours reach over " + shortNumber(box.hi[axis] - box.lo[axis], 4) +
                           " mm, which would be " + shortNumber(voxels, 4) + " voxels",
                       "put the series that they were drawn on beside them", set.path);
    }
    grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(pixels);
    along.first[axis] = box.lo[axis] - 2.0 * pixel;
  }
  grid.size[2] = along.count;
  grid.place = placeOf(planes, along, set.path);
  set.notes.push_back(
      "the series that the contours were drawn on is not in the folder: their voxels "
      "are " +
      shortNumber(pixel, 4) + " x " + shortNumber(pixel, 4) + " x " +
      shortNumber(glm::length(along.step), 4) + " mm");
  return grid;
}

/// Slice -> polygons on it, in pixels.
std::map<int, std::vector<std::vector<PixelPoint>>> polygonsOf(const Roi& roi,
                                                               const ContourGrid& grid,
                                                               const std::string& path,
                                                               std::size_t& outside) {
  const Mat3 to_index = glm::inverse(grid.place.axes);
  std::map<int, std::vector<std::vector<PixelPoint>>> out;
  for (const Contour& contour : roi.contours) {
    std::vector<PixelPoint> polygon;
    int slice = 0;
    for (const Vec3& point : contour) {
      const Vec3 ras = Vec3(-point.x, -point.y, point.z) * 1e-3;
      const Vec3 index = to_index * (ras - grid.place.origin);
      if (polygon.empty()) slice = static_cast<int>(std::lround(std::clamp(index.z, -1e6, 1e6)));
      if (!(std::abs(index.z - slice) <= kOnSlice)) {
        throw inputError("dicom.contours",
                         "a contour of '" + roi.name + "' lies between two slices, at slice " +
                             shortNumber(index.z, 5) + " (counted from 0), near (" +
                             shortNumber(point.x, 5) + ", " + shortNumber(point.y, 5) + ", " +
                             shortNumber(point.z, 5) + ") mm (left, back, up)",
                         "put the series that it was drawn on beside it", path);
      }
      polygon.push_back({index.x, index.y});
    }
    if (slice < 0 || slice >= grid.size[2]) {
      ++outside;
    } else {
      out[slice].push_back(std::move(polygon));
    }
  }
  return out;
}

ContourGrid gridOf(StructureSet& set) {
  const auto grid = gridOfSeries(set);
  return grid ? *grid : ownGrid(set);
}

}  // namespace

bool isDicomStructureSet(const DicomElements& file) {
  const std::string kind =
      file.has(kStorageClass) ? file.text(kStorageClass) : file.text(kSopClass);
  return kind == "1.2.840.10008.5.1.4.1.1.481.3";
}

Image readDicomStructureSet(const std::string& path, const ImageOptions& options) {
  StructureSet set = readSet(path);
  const ContourGrid grid = gridOf(set);
  const auto columns = static_cast<std::uint64_t>(grid.size[0]);
  const auto rows = static_cast<std::uint64_t>(grid.size[1]);
  std::vector<Structure> structures;
  std::size_t outside = 0;
  for (const Roi& roi : set.rois) {
    Structure one{roi.name, static_cast<int>(structures.size()) + 1, {}, 0};
    for (const auto& [slice, polygons] : polygonsOf(roi, grid, path, outside)) {
      pollStop();
      for (std::uint64_t j = 0; j < rows; ++j) {
        const std::uint64_t row = (static_cast<std::uint64_t>(slice) * rows + j) * columns;
        for (const auto& [first, end] : evenOddRuns(polygons, static_cast<int>(j), grid.size[0])) {
          one.add(row + static_cast<std::uint64_t>(first), row + static_cast<std::uint64_t>(end));
        }
      }
    }
    structures.push_back(std::move(one));
  }
  if (outside > 0) {
    set.notes.push_back(std::to_string(outside) + " contours lie beyond the first or last slice");
  }
  Image image = emptyImage(path, grid.size, grid.place, set.notes);
  image.labels = set.table;
  image.values = mergeStructures(structures, "structures", options.priority, image);
  return image;
}

ImageInfo readDicomStructureSetInfo(const std::string& path) {
  StructureSet set = readSet(path);
  const ContourGrid grid = gridOf(set);
  ImageInfo info = infoOf(grid.size, grid.place, set.notes);
  info.data_type = "contours";
  info.format = "DICOM structure set";
  info.labels = set.table;
  info.is_labels = true;
  return info;
}

LabelCodes readDicomStructureSetCodes(const std::string& path) { return readSet(path).codes; }

}  // namespace palpate::vdb
