#include "image/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "image/dicom_segments.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;
using namespace dicom;

/// Tolerance for directions and spacings of slices of one volume, and steps between them: files
/// write them with about five digits.
constexpr double kSameDirection = 1e-4;
constexpr double kEvenSteps = 0.05;   ///< [share of a step]
constexpr double kShearToTell = 0.1;  ///< [degrees]
constexpr double kTiltToDoubt = 0.5;  ///< [degrees]
constexpr const char* kWithoutPixels[] = {"11.", "66.", "88.", "104.", "481."};
constexpr double kDegrees = 180.0 / std::numbers::pi;

struct Slice {
  DicomElements elements;
  Vec3 position{0.0};  ///< [mm], LPS
  Vec3 along_row{0.0};
  Vec3 along_column{0.0};
  double row_spacing = 0.0;     ///< [mm] from row to row
  double column_spacing = 0.0;  ///< [mm]
  double height = 0.0;          ///< [mm] along the slices' normal
};

std::string nameOf(const Slice& slice) { return fileName(slice.elements.path); }

void checkPixels(const DicomElements& e) {
  const auto fail = [&](const char* code, const std::string& what, const std::string& hint = {}) {
    return inputError(code, what, hint, e.path);
  };
  if (e.has(kFrames) && e.numbers(kFrames, 1).front() > 1) {
    throw fail("dicom.multiframe", "the file holds " + e.text(kFrames) + " frames, not a slice",
               "convert it to NIfTI (dcm2niix)");
  }
  const int allocated = e.shortAt(kBitsAllocated).value_or(0);
  const int stored = e.shortAt(kBitsStored).value_or(0);
  const int samples = e.shortAt(kSamplesPerPixel).value_or(1);
  const std::string photometric = e.text(kPhotometric);
  if (samples != 1 || (photometric != "MONOCHROME1" && photometric != "MONOCHROME2")) {
    throw fail("dicom.data_type", "pixels of kind '" + photometric + "' are not single numbers");
  }
  if ((allocated != 8 && allocated != 16) || stored < 1 || stored > allocated ||
      e.shortAt(kHighBit).value_or(stored - 1) != stored - 1) {
    throw fail("dicom.data_type",
               "pixels of " + std::to_string(stored) + " bits in " + std::to_string(allocated) +
                   " cannot be read",
               "save the series with 8 or 16 bits a pixel");
  }
  if (e.has(kModalityTable)) {
    throw fail("dicom.data_type", "pixel values go through a table (Modality LUT)",
               "save the series with slope and intercept");
  }
  const auto wanted = static_cast<std::uint64_t>(e.shortAt(kRows).value_or(0)) *
                      static_cast<std::uint64_t>(e.shortAt(kColumns).value_or(0)) *
                      static_cast<std::uint64_t>(allocated / 8);
  // One byte of padding may fill up to an even length.
  if (!e.packed && (e.pixel_bytes < wanted || e.pixel_bytes > wanted + 1)) {
    throw fail(e.pixel_bytes < wanted ? "dicom.truncated" : "dicom.pixels",
               "the file holds " + std::to_string(e.pixel_bytes) +
                   " bytes of pixels, and its header asks for " + std::to_string(wanted),
               "fetch or write the file again");
  }
}

Slice sliceOf(DicomElements elements) {
  checkPixels(elements);
  for (const auto& [tag, name] : {std::pair{kPosition, "ImagePositionPatient"},
                                  {kOrientation, "ImageOrientationPatient"},
                                  {kPixelSpacing, "PixelSpacing"}}) {
    if (elements.text(tag).empty()) {
      throw inputError("dicom.no_affine",
                       std::string("the file has no ") + name + ", so nothing says where it lies",
                       {}, elements.path);
    }
  }
  Slice s;
  const auto position = elements.numbers(kPosition, 3);
  const auto directions = elements.numbers(kOrientation, 6);
  const auto spacing = elements.numbers(kPixelSpacing, 2);
  s.position = {position[0], position[1], position[2]};
  s.along_row = {directions[0], directions[1], directions[2]};
  s.along_column = {directions[3], directions[4], directions[5]};
  s.row_spacing = spacing[0];
  s.column_spacing = spacing[1];
  const bool unit = std::abs(glm::length(s.along_row) - 1.0) < 1e-3 &&
                    std::abs(glm::length(s.along_column) - 1.0) < 1e-3 &&
                    std::abs(glm::dot(s.along_row, s.along_column)) < 1e-3;
  if (!unit) {
    throw inputError("dicom.orientation",
                     "ImageOrientationPatient is '" + elements.text(kOrientation) +
                         "', not two unit vectors at right angles",
                     {}, elements.path);
  }
  if (!(s.row_spacing > 0.0) || !(s.column_spacing > 0.0)) {
    throw inputError("dicom.spacing", "PixelSpacing is '" + elements.text(kPixelSpacing) + "'", {},
                     elements.path);
  }
  s.height = glm::dot(s.position, glm::cross(s.along_row, s.along_column));
  s.elements = std::move(elements);
  return s;
}

/// Throws if `s` does not belong to the same volume as `first`.
void requireSame(const Slice& first, const Slice& s) {
  const auto differs = [&](const std::string& what) {
    return inputError(
        "dicom.mixed",
        "its " + what + " differs from that of " + nameOf(first) + " in the same series",
        "keep the files of one volume in a folder of their own", s.elements.path);
  };
  for (const auto& [tag, name] :
       {std::pair{kRows, "number of rows"}, {kColumns, "number of columns"}}) {
    if (first.elements.shortAt(tag) != s.elements.shortAt(tag)) throw differs(name);
  }
  if (glm::length(first.along_row - s.along_row) > kSameDirection ||
      glm::length(first.along_column - s.along_column) > kSameDirection) {
    throw differs("orientation");
  }
  if (std::abs(first.row_spacing - s.row_spacing) > kSameDirection * first.row_spacing ||
      std::abs(first.column_spacing - s.column_spacing) > kSameDirection * first.column_spacing) {
    throw differs("pixel spacing");
  }
}

/// How slices follow one another.
struct Stack {
  Vec3 step{0.0};       ///< [mm] from slice to slice, on average
  double usual = 0.0;   ///< [mm] along the normal, the median
  double widest = 0.0;  ///< [mm]
  std::string uneven;   ///< why they are not evenly spaced on a line; empty: they are
};

/// Throws if two slices lie in the same place.
Stack stackOf(const std::vector<Slice>& slices, const std::string& path) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    gaps.push_back(slices[i].height - slices[i - 1].height);
    if (gaps.back() < 1e-3) {
      throw inputError(
          "dicom.duplicate",
          nameOf(slices[i - 1]) + " and " + nameOf(slices[i]) + " lie in the same place",
          "a series over time, or files twice: keep one volume in a folder of its own", path);
    }
  }
  std::vector<double> ordered = gaps;
  std::sort(ordered.begin(), ordered.end());
  Stack out;
  out.usual = ordered[ordered.size() / 2];
  out.widest = ordered.back();
  out.step =
      (slices.back().position - slices.front().position) / static_cast<double>(slices.size() - 1);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (std::abs(gaps[i] - out.usual) <= kEvenSteps * out.usual) continue;
    out.uneven = "slices are not evenly spaced: from " + nameOf(slices[i]) + " to " +
                 nameOf(slices[i + 1]) + " it is " + shortNumber(gaps[i], 3) + " mm, elsewhere " +
                 shortNumber(out.usual, 3) +
                 (gaps[i] > 1.5 * out.usual ? "; a slice may be missing" : "");
    return out;
  }
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const Vec3 expected = slices.front().position + static_cast<double>(i) * out.step;
    const double off = glm::length(slices[i].position - expected);
    if (off <= kEvenSteps * glm::length(out.step)) continue;
    out.uneven = nameOf(slices[i]) + " is " + shortNumber(off, 3) +
                 " mm off the line that the others' positions are on";
    return out;
  }
  return out;
}

/// [degrees] The angle between the step from slice to slice and the slices' normal.
double shearOf(const Slice& first, const Vec3& step) {
  const Vec3 normal = glm::cross(first.along_row, first.along_column);
  return std::acos(std::clamp(glm::dot(glm::normalize(step), normal), -1.0, 1.0)) * kDegrees;
}

std::vector<SlicePlace> placesOf(const std::vector<Slice>& slices) {
  const Slice& first = slices.front();
  std::vector<SlicePlace> out;
  for (const Slice& s : slices) {
    const Vec3 moved = s.position - first.position;
    out.push_back({s.height - first.height, glm::dot(moved, first.along_row) / first.column_spacing,
                   glm::dot(moved, first.along_column) / first.row_spacing});
  }
  return out;
}

/// Adds notes for the user about a series that was read.
void tell(const std::vector<Slice>& slices, const Stack& stack, const DicomSeries& series,
          std::vector<std::string>& notes) {
  const Slice& first = slices.front();
  const double shear = shearOf(first, stack.step);
  if (series.even) {
    std::string why = stack.uneven;
    if (why.empty()) {
      why = "the slices are sheared by " + shortNumber(shear, 3) + " degrees (a tilted gantry)";
    }
    notes.push_back(why + ": resampled on " + shapeText(series.size) +
                    " voxels with right angles, " + shortNumber(series.even->step, 4) +
                    " mm from slice to slice; values between two slices, at most " +
                    shortNumber(stack.widest, 4) + " mm apart, are linear");
  } else if (shear > kShearToTell) {
    notes.push_back("the slices are sheared by " + shortNumber(shear, 3) +
                    " degrees (a tilted gantry); the voxels are kept sheared");
  }
  const DicomElements& e = first.elements;
  if (!e.text(kGantryTilt).empty()) {
    const double tilt = std::abs(e.numbers(kGantryTilt, 1).front());
    if (tilt > kTiltToDoubt && std::abs(tilt - shear) > kTiltToDoubt) {
      notes.push_back("GantryDetectorTilt says " + shortNumber(tilt, 3) +
                      " degrees, the slices' positions " + shortNumber(shear, 3) +
                      ": the positions count");
    }
  }
  if (e.text(kSeriesUid).empty()) {
    notes.emplace_back("the files have no SeriesInstanceUID: they are taken for one series");
  }
  if (e.text(kPhotometric) == "MONOCHROME1") {
    notes.emplace_back("MONOCHROME1: small values are bright; they are taken as stored");
  }
  if (e.text(kLossy) == "01") notes.emplace_back("the pixels went through lossy compression");
}

/// Whether a file is of a kind that has no pixels: a folder's index, presentation states, raw data,
/// reports, plans. If any other file lacks pixels, it was cut short.
bool needsNoPixels(const DicomElements& e) {
  const std::string kind = e.text(kStorageClass);
  const std::string images = "1.2.840.10008.5.1.4.1.1.";
  if (kind == "1.2.840.10008.1.3.10" || kind == images + "66") return true;
  return std::any_of(std::begin(kWithoutPixels), std::end(kWithoutPixels),
                     [&](const char* group) { return kind.starts_with(images + group); });
}

/// How many files of a folder are not slices.
struct LeftOut {
  std::size_t without_pixels = 0;
  std::size_t segmentations = 0;
};

/// The series of the folder by UID, and the files that belong to none.
std::map<std::string, std::vector<DicomElements>> seriesIn(const fs::path& folder,
                                                           LeftOut& left_out) {
  std::map<std::string, std::vector<DicomElements>> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_regular_file() || !isDicomFile(entry.path().string())) continue;
    DicomElements elements = readDicomElements(entry.path().string());
    if (isDicomSegmentation(elements)) {
      ++left_out.segmentations;
      continue;
    }
    if (!elements.has_pixels) {
      if (!needsNoPixels(elements)) {
        throw inputError("dicom.truncated", "the file has no pixel data",
                         "fetch or write the file again", elements.path);
      }
      ++left_out.without_pixels;
      continue;
    }
    out[elements.text(kSeriesUid)].push_back(std::move(elements));
  }
  return out;
}

std::vector<DicomElements> chosenSeries(const std::string& path, const std::string& wanted,
                                        LeftOut& left_out) {
  const bool is_folder = fs::is_directory(path);
  fs::path folder = is_folder ? fs::path(path) : fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  std::string uid = wanted;
  if (!is_folder && uid.empty()) uid = readDicomElements(path).text(kSeriesUid);
  auto series = seriesIn(folder, left_out);
  if (series.empty()) {
    throw inputError("dicom.missing", "the folder holds no DICOM images", {}, path);
  }
  if (is_folder && wanted.empty()) {
    if (series.size() == 1) return std::move(series.begin()->second);
  } else if (const auto at = series.find(uid); at != series.end()) {
    return std::move(at->second);
  }
  std::string list;
  for (const auto& [name, files] : series) {
    list += (list.empty() ? "" : ", ") + (name.empty() ? "(none)" : name) + " (" +
            std::to_string(files.size()) + " files" +
            (files.front().text(kSeriesDescription).empty()
                 ? ""
                 : ", " + files.front().text(kSeriesDescription)) +
            ")";
  }
  throw inputError("dicom.series",
                   wanted.empty() ? "the folder holds several series: " + list
                                  : "there is no series '" + wanted + "' here, but: " + list,
                   "choose one by its UID: series: UID (on the command line --series UID)", path);
}

}  // namespace

bool isDicomFile(const std::string& path) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) return false;  // a reader of a pipe would wait for ever
  std::ifstream file(path, std::ios::binary);
  char head[132] = {};
  file.read(head, sizeof head);
  return file.gcount() == sizeof head && std::string_view(head + 128, 4) == "DICM";
}

bool isDicomFolder(const std::string& path) {
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(path, failure)) {
    if (entry.is_regular_file(failure) && isDicomFile(entry.path().string())) return true;
  }
  return false;
}

DicomSeries findDicomSeries(const std::string& path, const std::string& wanted, bool resample) {
  std::error_code failure;
  if (!fs::exists(path, failure))
    throw inputError("dicom.missing", "no such file or folder", {}, path);
  LeftOut left_out;
  std::vector<Slice> slices;
  for (DicomElements& elements : chosenSeries(path, wanted, left_out)) {
    slices.push_back(sliceOf(std::move(elements)));
  }
  // First sort by name, so that errors do not depend on the folder's order.
  std::sort(slices.begin(), slices.end(),
            [](const Slice& a, const Slice& b) { return a.elements.path < b.elements.path; });
  for (const Slice& s : slices) requireSame(slices.front(), s);
  std::stable_sort(slices.begin(), slices.end(),
                   [](const Slice& a, const Slice& b) { return a.height < b.height; });
  const Slice& first = slices.front();
  const int rows = first.elements.shortAt(kRows).value_or(0);
  const int columns = first.elements.shortAt(kColumns).value_or(0);
  if (slices.size() < 2 || rows < 2 || columns < 2) {
    throw inputError("dicom.dimensions",
                     "the series is of " + std::to_string(columns) + " x " + std::to_string(rows) +
                         " x " + std::to_string(slices.size()) +
                         " voxels; at least two along each axis are needed",
                     "keep all files of the series in one folder", path);
  }
  DicomSeries out;
  const Stack stack = stackOf(slices, path);
  if (!stack.uneven.empty() && !resample) {
    throw inputError("dicom.spacing", stack.uneven,
                     "complete the series, or have it resampled: resample: true (on the command "
                     "line --resample)",
                     path);
  }
  Place lps;
  lps.axes[0] = first.along_row * first.column_spacing;
  lps.axes[1] = first.along_column * first.row_spacing;
  lps.axes[2] = stack.step;
  lps.origin = first.position;
  out.size = {columns, rows, static_cast<int>(slices.size())};
  if (resample && (!stack.uneven.empty() || shearOf(first, stack.step) > kShearToTell)) {
    lps.axes[2] = glm::cross(first.along_row, first.along_column);
    out.places = placesOf(slices);
    out.even = evenSlices(out.places, stack.usual, columns, rows, lps);
    lps = out.even->place;
    out.size = out.even->size;
  }
  out.place = scaled(turned(lps), 1e-3);
  if (!isUsable(out.place)) {
    throw inputError("dicom.singular", "the slices' positions give the voxels no volume", {}, path);
  }
  tell(slices, stack, out, out.notes);
  if (left_out.without_pixels > 0) {
    out.notes.push_back(std::to_string(left_out.without_pixels) +
                        " DICOM files without pixels were ignored");
  }
  if (left_out.segmentations > 0) {
    out.notes.push_back(std::to_string(left_out.segmentations) +
                        " DICOM segmentations were ignored; to read one, name its file");
  }
  for (Slice& s : slices) out.slices.push_back(std::move(s.elements));
  return out;
}

}  // namespace palpate::vdb
