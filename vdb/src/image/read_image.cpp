#include <algorithm>
#include <filesystem>

#include "image/header_text.h"
#include "image/masks.h"
#include "image/readers.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

enum class Format { kNifti, kNrrd, kMetaImage, kDicom, kMasks };

bool endsWith(const std::string& path, std::initializer_list<const char*> extensions) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const char* extension) { return hasExtension(path, extension); });
}

std::optional<Format> formatOf(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) {
    if (isDicomFolder(path)) return Format::kDicom;
    return isMaskFolder(path) ? std::optional(Format::kMasks) : std::nullopt;
  }
  if (endsWith(path, {".nii", ".nii.gz"})) return Format::kNifti;
  if (endsWith(path, {".nrrd", ".nhdr"})) return Format::kNrrd;
  if (endsWith(path, {".mha", ".mhd"})) return Format::kMetaImage;
  if (endsWith(path, {".dcm", ".ima"})) return Format::kDicom;
  const bool no_extension = std::filesystem::path(path).extension().empty();
  if (no_extension && isDicomFile(path)) return Format::kDicom;
  return {};
}

Format requireFormat(const std::string& path, const ImageOptions& options) {
  if (!options.with.empty()) return Format::kMasks;
  if (const auto format = formatOf(path)) return *format;
  std::error_code failure;
  const bool is_folder = std::filesystem::is_directory(path, failure);
  throw inputError(
      is_folder ? "dicom.missing" : "image.format",
      is_folder ? "the folder holds no DICOM images and no masks"
                : "cannot tell from its name what kind of image this is",
      "known are NIfTI (.nii .nii.gz), NRRD (.nrrd .nhdr), MetaImage (.mha .mhd), and folders of "
      "DICOM series or of masks",
      path);
}

/// Refuses options that a format does not use: an option without effect is a mistake.
void checkOptions(Format format, const ImageOptions& options, const std::string& path) {
  const auto refuse = [&](bool given, const std::string& what, const char* formats) {
    if (!given) return;
    throw inputError("image.option", what + " applies to " + formats, "leave it out", path);
  };
  refuse(format != Format::kDicom && !options.series.empty(), "a series", "DICOM folders");
  refuse(format != Format::kDicom && options.resample, "resampling", "DICOM series");
  // Each mask is checked by itself.
  if (format == Format::kMasks) return;
  refuse(format != Format::kDicom && !options.priority.empty(), "a priority",
         "structures that were segmented one by one");
  const bool nifti = format == Format::kNifti;
  const bool nrrd = format == Format::kNrrd;
  const AffineChoice affine = options.affine;
  refuse(!nifti && (affine == AffineChoice::kSform || affine == AffineChoice::kQform),
         "affine: sform or qform", "NIfTI files");
  refuse(!nifti && !nrrd && affine == AffineChoice::kSpacing, "affine: spacing",
         "NIfTI and NRRD files");
  refuse(!nrrd && options.space != Space::kStated, "the space of an image", "NRRD files");
  refuse(format == Format::kDicom && options.frame.has_value(), "a frame",
         "files of four dimensions");
}

}  // namespace

bool isImageFile(const std::string& path) { return formatOf(path).has_value(); }

Image readImage(const std::string& path, const ImageOptions& options) {
  const Format format = requireFormat(path, options);
  checkOptions(format, options, path);
  switch (format) {
    case Format::kNrrd:
      return readNrrd(path, options);
    case Format::kMetaImage:
      return readMetaImage(path, options);
    case Format::kDicom:
      return readDicom(path, options);
    case Format::kMasks:
      return readMasks(path, options);
    case Format::kNifti:
      break;
  }
  return readNifti(path, options);
}

ImageInfo readImageInfo(const std::string& path, const ImageOptions& options) {
  const Format format = requireFormat(path, options);
  checkOptions(format, options, path);
  switch (format) {
    case Format::kNrrd:
      return readNrrdInfo(path, options);
    case Format::kMetaImage:
      return readMetaImageInfo(path, options);
    case Format::kDicom:
      return readDicomInfo(path, options);
    case Format::kMasks:
      return readMasksInfo(path, options);
    case Format::kNifti:
      break;
  }
  return readNiftiInfo(path, options);
}

LabelCodes readLabelCodes(const std::string& path, const ImageOptions& options) {
  switch (requireFormat(path, options)) {
    case Format::kNrrd:
      return readNrrdCodes(path, options);
    case Format::kMasks:
      return readMaskCodes(path, options);
    case Format::kDicom:
      return readDicomCodes(path, options);
    case Format::kMetaImage:
    case Format::kNifti:
      break;
  }
  return {};
}

}  // namespace palpate::vdb
