#include "image/dicom_pixels.h"

#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <cstring>

#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

template <typename T>
void widen(const std::vector<char>& raw, std::vector<std::int32_t>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    T value;
    std::memcpy(&value, raw.data() + i * sizeof(T), sizeof(T));
    out[i] = static_cast<std::int32_t>(value);
  }
}

/// Bits above the stored ones may hold overlays, and of negative numbers anything.
void keepStoredBits(std::vector<std::int32_t>& values, int bits, bool is_signed) {
  const std::uint32_t mask = (std::uint32_t{1} << static_cast<unsigned>(bits)) - 1;
  const std::uint32_t sign = std::uint32_t{1} << static_cast<unsigned>(bits - 1);
  for (std::int32_t& value : values) {
    std::uint32_t v = static_cast<std::uint32_t>(value) & mask;
    if (is_signed && (v & sign) != 0) v |= ~mask;
    value = static_cast<std::int32_t>(v);
  }
}

}  // namespace

std::vector<std::int32_t> readDicomPixels(const DicomElements& elements) {
  const auto fail = [&](const std::string& what) {
    return inputError("dicom.pixels", "the pixels cannot be unpacked: " + what,
                      "save the series uncompressed (gdcmconv --raw)", elements.path);
  };
  gdcm::Trace::WarningOff();  // it talks on stderr
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  gdcm::ImageReader reader;
  reader.SetFileName(elements.path.c_str());
  if (!reader.Read()) throw fail("GDCM does not read the file");
  const gdcm::Image& image = reader.GetImage();
  const auto rows = static_cast<unsigned>(elements.shortAt(dicom::kRows).value_or(0));
  const auto columns = static_cast<unsigned>(elements.shortAt(dicom::kColumns).value_or(0));
  const int bits = elements.shortAt(dicom::kBitsStored).value_or(0);
  const int allocated = elements.shortAt(dicom::kBitsAllocated).value_or(0);
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const std::size_t count = std::size_t{rows} * columns;
  const std::size_t bytes = format.GetPixelSize();
  std::vector<char> raw(image.GetBufferLength());
  if (image.GetDimension(0) != columns || image.GetDimension(1) != rows ||
      format.GetSamplesPerPixel() != 1 || raw.size() != count * bytes ||
      format.GetBitsAllocated() != allocated) {
    throw fail("they are not those that the header describes");
  }
  if (!image.GetBuffer(raw.data())) throw fail("their data are damaged");
  std::vector<std::int32_t> out(count);
  const bool is_signed = elements.shortAt(dicom::kPixelRepresentation).value_or(0) == 1;
  if (bytes == 1) {
    is_signed ? widen<std::int8_t>(raw, out) : widen<std::uint8_t>(raw, out);
  } else {
    is_signed ? widen<std::int16_t>(raw, out) : widen<std::uint16_t>(raw, out);
  }
  keepStoredBits(out, bits, is_signed);
  return out;
}

}  // namespace palpate::vdb
