#pragma once
/// The elements of a DICOM file, found by one walk through the file.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace palpate::vdb {

/// Position of a piece of pixel data in a file.
struct PixelPart {
  std::uint64_t begin = 0;  ///< [bytes]
  std::uint64_t size = 0;
};

/// A data set: the whole of a file, or an item of a sequence.
struct DicomItem {
  std::string path;  ///< the file that it comes from
  bool big_endian = false;
  std::map<std::uint32_t, std::string> texts;  ///< values, without padding
  std::map<std::uint32_t, std::vector<DicomItem>> sequences;

  [[nodiscard]] bool has(std::uint32_t tag) const { return texts.contains(tag); }
  /// The text, without blanks at its ends; empty if there is none.
  [[nodiscard]] std::string text(std::uint32_t tag) const;
  /// The numbers of a text such as "1\-2.5". There must be `count` of them; 0: any number. @throws
  /// Error (kInput, dicom.value)
  [[nodiscard]] std::vector<double> numbers(std::uint32_t tag, std::size_t count) const;
  /// An unsigned short. @throws Error (kInput, dicom.value)
  [[nodiscard]] std::optional<int> shortAt(std::uint32_t tag) const;
  /// `count` unsigned shorts; empty if the element is not there. @throws Error (kInput,
  /// dicom.value)
  [[nodiscard]] std::vector<int> shorts(std::uint32_t tag, std::size_t count) const;
  /// The items of a sequence; empty if it is not there.
  [[nodiscard]] const std::vector<DicomItem>& items(std::uint32_t tag) const;
  /// The first item of a sequence; null if there is none.
  [[nodiscard]] const DicomItem* first(std::uint32_t tag) const;
};

/// GDCM reads missing parts of a file as zeros, or ends the process on an assertion. Therefore this
/// code walks every file: every length must fit, every sequence must end. GDCM then sees only the
/// bytes of packed pixels. The outermost level has short values only, and no sequences, unless the
/// caller asks for them.
struct DicomElements : DicomItem {
  std::string transfer_syntax;
  bool has_pixels = false;
  bool packed = false;            ///< pixel data in fragments
  bool pixels_are_words = false;  ///< written as words of 16 bits (OW)
  std::uint64_t pixel_bytes = 0;  ///< size of pixel data that are not packed
  std::vector<PixelPart> pixels;  ///< one part, or the fragments after their table of offsets
};

enum class DicomDepth { kOutermost, kSequencesToo };

/// @throws Error (kInput): dicom.format, dicom.truncated, dicom.damaged, dicom.encoding.
[[nodiscard]] DicomElements readDicomElements(const std::string& path,
                                              DicomDepth depth = DicomDepth::kOutermost);

namespace dicom {

inline constexpr std::uint32_t kStorageClass = 0x00020002;
inline constexpr std::uint32_t kSopClass = 0x00080016;
inline constexpr std::uint32_t kCodeValue = 0x00080100;
inline constexpr std::uint32_t kCodeScheme = 0x00080102;
inline constexpr std::uint32_t kCodeMeaning = 0x00080104;
inline constexpr std::uint32_t kModality = 0x00080060;
inline constexpr std::uint32_t kSeriesDescription = 0x0008103E;
inline constexpr std::uint32_t kGantryTilt = 0x00181120;
inline constexpr std::uint32_t kSeriesUid = 0x0020000E;
inline constexpr std::uint32_t kPosition = 0x00200032;
inline constexpr std::uint32_t kOrientation = 0x00200037;
inline constexpr std::uint32_t kSamplesPerPixel = 0x00280002;
inline constexpr std::uint32_t kPhotometric = 0x00280004;
inline constexpr std::uint32_t kFrames = 0x00280008;
inline constexpr std::uint32_t kRows = 0x00280010;
inline constexpr std::uint32_t kColumns = 0x00280011;
inline constexpr std::uint32_t kPixelSpacing = 0x00280030;
inline constexpr std::uint32_t kBitsAllocated = 0x00280100;
inline constexpr std::uint32_t kBitsStored = 0x00280101;
inline constexpr std::uint32_t kHighBit = 0x00280102;
inline constexpr std::uint32_t kPixelRepresentation = 0x00280103;
inline constexpr std::uint32_t kIntercept = 0x00281052;
inline constexpr std::uint32_t kSlope = 0x00281053;
inline constexpr std::uint32_t kLossy = 0x00282110;
inline constexpr std::uint32_t kModalityTable = 0x00283000;
inline constexpr std::uint32_t kPixelData = 0x7FE00010;

}  // namespace dicom

}  // namespace palpate::vdb
