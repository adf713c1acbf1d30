#include "image/dicom_pixels.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>

#include "child/child.h"
#include "image/dicom_unpack.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

/// Bits above the stored ones may hold overlays, and for negative numbers they may hold anything.
std::int32_t storedBits(std::uint32_t value, int bits, bool is_signed) noexcept {
  const std::uint32_t mask = (std::uint32_t{1} << static_cast<unsigned>(bits)) - 1;
  const std::uint32_t sign = std::uint32_t{1} << static_cast<unsigned>(bits - 1);
  std::uint32_t v = value & mask;
  if (is_signed && (v & sign) != 0) v |= ~mask;
  return static_cast<std::int32_t>(v);
}

std::string bytesOf(std::ifstream& file, const PixelPart& part, const std::string& path) {
  std::string bytes(part.size, '\0');
  file.seekg(static_cast<std::streamoff>(part.begin));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) {
    throw inputError("dicom.truncated", "the file became shorter while it was read",
                     "fetch or write the file again", path);
  }
  return bytes;
}

/// Low byte first, as GDCM returns pixels, whatever the file's byte order is.
std::string plainPixels(const DicomElements& slice, int allocated) {
  std::ifstream file(slice.path, std::ios::binary);
  std::string bytes = bytesOf(file, slice.pixels.front(), slice.path);
  // In words of big-endian order the bytes are swapped in pairs, even if a pixel is one byte.
  if (slice.big_endian && (allocated == 16 || slice.pixels_are_words)) {
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
  }
  return bytes;
}

/// Refuses pixels packed more tightly than any useful image: such a file is damaged, and would only
/// get memory allocated for it.
void requireLikely(const DicomElements& slice, std::uint64_t bytes) {
  constexpr std::uint64_t kBestRatio = 4096;
  constexpr std::uint64_t kAlwaysLikely = std::uint64_t{1} << 24U;
  std::uint64_t packed = 0;
  for (const PixelPart& part : slice.pixels) packed += part.size;
  if (bytes <= kAlwaysLikely || bytes / kBestRatio <= packed) return;
  throw inputError("dicom.pixels",
                   "the pixels cannot be unpacked: " + std::to_string(packed) +
                       " bytes are to become " + std::to_string(bytes),
                   "fetch or write the file again", slice.path);
}

std::string packedPixels(const DicomElements& slice) {
  std::ifstream file(slice.path, std::ios::binary);
  std::vector<std::string> fragments;
  for (const PixelPart& part : slice.pixels) fragments.push_back(bytesOf(file, part, slice.path));
  return unpackDicom(slice, fragments);
}

std::vector<std::int32_t> valuesOf(const DicomElements& slice) {
  const auto rows = static_cast<std::size_t>(slice.shortAt(dicom::kRows).value_or(0));
  const auto columns = static_cast<std::size_t>(slice.shortAt(dicom::kColumns).value_or(0));
  const int bits = slice.shortAt(dicom::kBitsStored).value_or(0);
  const int allocated = slice.shortAt(dicom::kBitsAllocated).value_or(0);
  const bool is_signed = slice.shortAt(dicom::kPixelRepresentation).value_or(0) == 1;
  if (slice.packed) requireLikely(slice, std::uint64_t{2} * rows * columns);
  const std::string raw = slice.packed ? packedPixels(slice) : plainPixels(slice, allocated);
  std::vector<std::int32_t> out(rows * columns);
  const std::size_t step = allocated == 8 ? 1 : 2;
  if (raw.size() < out.size() * step) {
    throw inputError("dicom.pixels", "the pixels cannot be unpacked: some are missing",
                     "fetch or write the file again", slice.path);
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::uint32_t value = static_cast<unsigned char>(raw[i * step]);
    if (step == 2)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(raw[2 * i + 1])) << 8U;
    out[i] = storedBits(value, bits, is_signed);
  }
  return out;
}

}  // namespace

std::vector<std::vector<std::int32_t>> readDicomPixels(const std::vector<DicomElements>& slices) {
  std::vector<std::vector<std::int32_t>> out(slices.size());
  const bool any_packed =
      std::any_of(slices.begin(), slices.end(), [](const DicomElements& s) { return s.packed; });
  if (!any_packed || !libraryLimits().in_child) {
    for (std::size_t i = 0; i < slices.size(); ++i) {
      pollStop();
      out[i] = valuesOf(slices[i]);
    }
    return out;
  }
  // One child for all slices; if it dies, nobody knows at which slice.
  ChildTask task{0, "dicom.pixels", "GDCM",
                 "the file may be damaged; save the series uncompressed (gdcmconv --raw)",
                 slices.front().path};
  for (const DicomElements& slice : slices) {
    for (const PixelPart& part : slice.pixels) task.file_bytes += part.size;
  }
  ChildReader result = runInChild(task, [&](ChildWriter& child) {
    for (const DicomElements& slice : slices) child.put(valuesOf(slice));
  });
  for (auto& values : out) values = result.takeAll<std::int32_t>();
  return out;
}

}  // namespace palpate::vdb
