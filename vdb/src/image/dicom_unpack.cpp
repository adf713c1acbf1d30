#include "image/dicom_unpack.h"

#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <sstream>
#include <string_view>

#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

/// Whether GDCM is known to unpack this kind well: RLE, and JPEG (lossless, lossy, JPEG-LS and
/// 2000).
bool isKnownPacking(const std::string& syntax) {
  constexpr std::string_view kRle = "1.2.840.10008.1.2.5";
  constexpr std::string_view kJpeg = "1.2.840.10008.1.2.4.";
  if (syntax == kRle) return true;
  if (!syntax.starts_with(kJpeg)) return false;
  const std::string_view kind = std::string_view(syntax).substr(kJpeg.size());
  return kind == "50" || kind == "51" || kind == "57" || kind == "70" || kind == "80" ||
         kind == "81" || kind == "90" || kind == "91";
}

/// Writes a file of explicit, little-endian elements.
class Writer {
 public:
  void number(std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
      bytes_ += static_cast<char>(value >> (8U * static_cast<unsigned>(i)));
  }
  void tag(std::uint32_t tag) {
    number(tag >> 16U, 2);
    number(tag & 0xFFFFU, 2);
  }
  void text(std::uint32_t t, const char* vr, std::string value) {
    if (value.size() % 2 == 1) value += std::string_view(vr) == "UI" ? '\0' : ' ';
    tag(t);
    bytes_ += vr;
    number(static_cast<std::uint32_t>(value.size()), 2);
    bytes_ += value;
  }
  void shortNumber(std::uint32_t t, int value) {
    tag(t);
    bytes_ += "US";
    number(2, 2);
    number(static_cast<std::uint32_t>(value), 2);
  }
  void raw(std::string_view bytes) { bytes_ += bytes; }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

std::string fileOf(const DicomElements& slice, const std::vector<std::string>& fragments) {
  const std::string ct = "1.2.840.10008.5.1.4.1.1.2";
  const std::string uid = "2.25.1";
  Writer meta;
  meta.tag(0x00020001);
  meta.raw(std::string_view("OB\0\0\2\0\0\0\0\1", 10));
  meta.text(0x00020002, "UI", ct);
  meta.text(0x00020003, "UI", uid);
  meta.text(0x00020010, "UI", slice.transfer_syntax);
  meta.text(0x00020012, "UI", "2.25.2");
  Writer out;
  out.raw(std::string(128, '\0'));
  out.raw("DICM");
  out.tag(0x00020000);
  out.raw(std::string_view("UL\4\0", 4));
  out.number(static_cast<std::uint32_t>(meta.bytes().size()), 4);
  out.raw(meta.bytes());
  out.text(0x00080016, "UI", ct);
  out.text(0x00080018, "UI", uid);
  const auto copied = [&](std::uint32_t tag) {
    out.shortNumber(tag, slice.shortAt(tag).value_or(0));
  };
  out.shortNumber(dicom::kSamplesPerPixel, 1);
  out.text(dicom::kPhotometric, "CS", "MONOCHROME2");
  copied(dicom::kRows);
  copied(dicom::kColumns);
  copied(dicom::kBitsAllocated);
  copied(dicom::kBitsStored);
  out.shortNumber(dicom::kHighBit, slice.shortAt(dicom::kBitsStored).value_or(1) - 1);
  copied(dicom::kPixelRepresentation);
  out.tag(dicom::kPixelData);
  out.raw(std::string_view("OB\0\0\xFF\xFF\xFF\xFF", 8));
  bool is_table = true;
  for (const std::string& fragment : fragments) {
    out.tag(0xFFFEE000);
    // A single frame needs no table of offsets, and a damaged table would mislead GDCM.
    const std::string_view bytes = std::exchange(is_table, false) ? std::string_view() : fragment;
    out.number(static_cast<std::uint32_t>(bytes.size() + bytes.size() % 2), 4);
    out.raw(bytes);
    if (bytes.size() % 2 == 1) out.raw(std::string_view("\0", 1));
  }
  out.tag(0xFFFEE0DD);
  out.number(0, 4);
  return out.bytes();
}

}  // namespace

std::string unpackDicom(const DicomElements& slice, const std::vector<std::string>& fragments) {
  const auto fail = [&](const std::string& what) {
    return inputError("dicom.pixels", "the pixels cannot be unpacked: " + what,
                      "save the series uncompressed (gdcmconv --raw)", slice.path);
  };
  if (!isKnownPacking(slice.transfer_syntax)) {
    throw fail("their transfer syntax is '" + slice.transfer_syntax.substr(0, 64) + "'");
  }
  if (fragments.size() < 2) throw fail("there are none");
  gdcm::Trace::WarningOff();  // it would write to stderr
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  std::istringstream stream(fileOf(slice, fragments));
  gdcm::ImageReader reader;
  reader.SetStream(stream);
  if (!reader.Read()) throw fail("GDCM does not read them");
  const gdcm::Image& image = reader.GetImage();
  const auto rows = static_cast<unsigned>(slice.shortAt(dicom::kRows).value_or(0));
  const auto columns = static_cast<unsigned>(slice.shortAt(dicom::kColumns).value_or(0));
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  std::string raw(image.GetBufferLength(), '\0');
  if (image.GetDimension(0) != columns || image.GetDimension(1) != rows ||
      format.GetSamplesPerPixel() != 1 ||
      raw.size() != std::size_t{rows} * columns * format.GetPixelSize() ||
      format.GetBitsAllocated() != slice.shortAt(dicom::kBitsAllocated).value_or(0)) {
    throw fail("they are not those that the header describes");
  }
  if (!image.GetBuffer(raw.data())) throw fail("their data are damaged");
  return raw;
}

}  // namespace palpate::vdb
