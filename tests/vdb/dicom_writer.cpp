#include "vdb/dicom_writer.h"

namespace palpate::vdb::test {
namespace {

void put(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xFFU);
}

class Writer {
 public:
  explicit Writer(bool implicit) : implicit_(implicit) {}

  void text(std::uint32_t group, std::uint32_t element, const char* vr, std::string value) {
    if (value.empty()) return;
    if (value.size() % 2 != 0) value += std::string(vr) == "UI" ? '\0' : ' ';
    head(group, element, vr, static_cast<std::uint32_t>(value.size()));
    out += value;
  }
  void number(std::uint32_t group, std::uint32_t element, int value) {
    head(group, element, "US", 2);
    put(out, static_cast<std::uint32_t>(value), 2);
  }
  void head(std::uint32_t group, std::uint32_t element, const std::string& vr,
            std::uint32_t length) {
    put(out, group, 2);
    put(out, element, 2);
    const bool is_long = vr == "OW" || vr == "SQ" || vr == "OB";
    if (!implicit_) {
      out += vr;
      put(out, is_long ? 0 : length, 2);
    }
    if (implicit_ || is_long) put(out, length, 4);
  }
  void item(std::uint32_t element, std::uint32_t length) {
    put(out, 0xFFFE, 2);
    put(out, element, 2);
    put(out, length, 4);
  }

  std::string out;

 private:
  bool implicit_;
};

}  // namespace

std::string bytesOf(const DicomFile& file) {
  Writer meta(false);
  meta.text(0x0002, 0x0002, "UI", file.storage_class);
  meta.text(0x0002, 0x0003, "UI", "1.2.3.4");
  meta.text(0x0002, 0x0010, "UI", file.is_implicit ? "1.2.840.10008.1.2" : "1.2.840.10008.1.2.1");
  Writer length(false);
  length.head(0x0002, 0x0000, "UL", 4);
  put(length.out, static_cast<std::uint32_t>(meta.out.size()), 4);

  Writer w(file.is_implicit);
  w.text(0x0008, 0x0016, "UI", file.storage_class);
  w.text(0x0008, 0x0018, "UI", "1.2.3.4");
  w.text(0x0008, 0x0060, "CS", "CT");
  if (file.with_sequence) {
    constexpr std::uint32_t kUndefined = 0xFFFFFFFFU;
    w.head(0x0008, 0x1140, "SQ", kUndefined);
    w.item(0xE000, kUndefined);
    // A decoy in a nested sequence: only the outermost position counts.
    w.text(0x0020, 0x0032, "DS", "7\\7\\7");
    w.item(0xE00D, 0);
    w.item(0xE0DD, 0);
  }
  w.text(0x0018, 0x1120, "DS", file.tilt);
  w.text(0x0020, 0x000E, "UI", file.series);
  w.text(0x0020, 0x0032, "DS", file.position);
  w.text(0x0020, 0x0037, "DS", file.orientation);
  w.number(0x0028, 0x0002, 1);
  w.text(0x0028, 0x0004, "CS", file.photometric);
  w.text(0x0028, 0x0008, "IS", file.frames);
  w.number(0x0028, 0x0010, file.rows);
  w.number(0x0028, 0x0011, file.columns);
  w.text(0x0028, 0x0030, "DS", file.spacing);
  w.number(0x0028, 0x0100, 16);
  w.number(0x0028, 0x0101, file.bits_stored);
  w.number(0x0028, 0x0102, file.bits_stored - 1);
  w.number(0x0028, 0x0103, file.is_signed ? 1 : 0);
  w.text(0x0028, 0x1052, "DS", file.intercept);
  w.text(0x0028, 0x1053, "DS", file.slope);
  const int count = file.rows * file.columns;
  const std::string front = std::string(128, '\0') + "DICM" + length.out + meta.out;
  if (!file.with_pixels) return front + w.out;
  w.head(0x7FE0, 0x0010, "OW", static_cast<std::uint32_t>(2 * count + file.pixel_bytes_off));
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    put(w.out, static_cast<std::uint32_t>(file.pixels.empty() ? i : file.pixels.at(at)), 2);
  }
  if (file.pixel_bytes_off < 0) {
    w.out.resize(w.out.size() - static_cast<std::size_t>(-file.pixel_bytes_off));
  } else {
    w.out.append(static_cast<std::size_t>(file.pixel_bytes_off), '\0');
  }
  return front + w.out;
}

}  // namespace palpate::vdb::test
