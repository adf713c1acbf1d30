#include <cstdint>
#include <initializer_list>

#include "fuzz/seeds.h"

namespace palpate::fuzz {
namespace {

void put(std::string& to, std::uint32_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(number >> (8 * i));
}

/// One element, explicit little endian. `tag` holds group and element, as in 0x00080016.
std::string element(std::uint32_t tag, const std::string& vr, std::string value) {
  if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
  std::string out;
  put(out, tag >> 16, 2);
  put(out, tag & 0xFFFFU, 2);
  out += vr;
  const bool is_long = vr == "SQ" || vr == "OB" || vr == "OW";
  if (is_long) put(out, 0, 2);
  put(out, static_cast<std::uint32_t>(value.size()), is_long ? 4 : 2);
  return out + value;
}

std::string shorts(std::uint32_t tag, std::initializer_list<std::uint32_t> values) {
  std::string value;
  for (const std::uint32_t v : values) put(value, v, 2);
  return element(tag, "US", value);
}

std::string sequence(std::uint32_t tag, const std::vector<std::string>& items) {
  std::string value;
  for (const std::string& item : items) {
    put(value, 0xE000FFFE, 4);
    put(value, static_cast<std::uint32_t>(item.size()), 4);
    value += item;
  }
  return element(tag, "SQ", value);
}

std::string fileOf(const std::string& storage_class, const std::string& elements) {
  const std::string meta = element(0x00020002, "UI", storage_class) +
                           element(0x00020003, "UI", "1.2.3.4") +
                           element(0x00020010, "UI", "1.2.840.10008.1.2.1");
  std::string length;
  put(length, static_cast<std::uint32_t>(meta.size()), 4);
  return std::string(128, '\0') + "DICM" + element(0x00020000, "UL", length) + meta +
         element(0x00080016, "UI", storage_class) + element(0x00080018, "UI", "1.2.3.4") + elements;
}

std::string liver(std::uint32_t tag) {
  return sequence(tag, {element(0x00080100, "SH", "10200004") + element(0x00080102, "SH", "SCT") +
                        element(0x00080104, "LO", "Liver")});
}

enum class Kind { kBinary, kFractional, kLabelMap };

/// Two segments of 4 x 3 pixels on two planes; a label map has both in each frame.
std::string segmentation(Kind kind) {
  const bool is_map = kind == Kind::kLabelMap;
  std::vector<std::string> segments;
  std::vector<std::string> frames;
  for (std::uint32_t n = 1; n <= 2; ++n) {
    segments.push_back(shorts(0x00620004, {n}) + element(0x00620005, "LO", "part") +
                       shorts(0x0062000D, {34885, 53485, 50171}) + liver(0x0062000F));
  }
  for (std::uint32_t n = 1; n <= (is_map ? 1U : 2U); ++n) {
    for (const char* const place : {"0\\0\\0", "0\\0\\2"}) {
      frames.push_back(sequence(0x00209113, {element(0x00200032, "DS", place)}) +
                       (is_map ? "" : sequence(0x0062000A, {shorts(0x0062000B, {n})})));
    }
  }
  std::string pixels;
  if (kind == Kind::kBinary) {
    // 48 bits: in the frames of the first segment the upper half of the pixels is set, in those of
    // the second the rest.
    pixels = std::string("\x3F\x00\x3F\x00\xFC\x0F", 6);
  } else {
    for (int i = 0; i < 12 * static_cast<int>(frames.size()); ++i) {
      pixels += static_cast<char>(is_map ? i % 3 : (i < 24) == (i % 12 < 6) ? 200 : 20);
    }
  }
  const std::uint32_t bits = kind == Kind::kBinary ? 1 : 8;
  const char* const type = is_map                      ? "LABELMAP"
                           : kind == Kind::kFractional ? "FRACTIONAL"
                                                       : "BINARY";
  const std::string shared =
      sequence(0x00209116, {element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")}) +
      sequence(0x00289110, {element(0x00180050, "DS", "2") + element(0x00180088, "DS", "2") +
                            element(0x00280030, "DS", "1\\1")});
  return fileOf(std::string("1.2.840.10008.5.1.4.1.1.66.") + (is_map ? "7" : "4"),
                element(0x00080060, "CS", "SEG") + element(0x0020000E, "UI", "1.2.3") +
                    shorts(0x00280002, {1}) + element(0x00280004, "CS", "MONOCHROME2") +
                    element(0x00280008, "IS", std::to_string(frames.size())) +
                    shorts(0x00280010, {3}) + shorts(0x00280011, {4}) + shorts(0x00280100, {bits}) +
                    shorts(0x00280101, {bits}) + shorts(0x00280102, {bits - 1}) +
                    shorts(0x00280103, {0}) + element(0x00620001, "CS", type) +
                    sequence(0x00620002, segments) +
                    (kind == Kind::kFractional ? shorts(0x0062000E, {200}) : "") +
                    sequence(0x52009229, {shared}) + sequence(0x52009230, frames) +
                    element(0x7FE00010, "OB", pixels));
}

/// A rectangle with a hole on each slice of the series that readers.cpp puts beside the file.
std::string structureSet() {
  std::vector<std::string> loops;
  for (const char* const z : {"1", "2"}) {
    for (const int step : {1, 2}) {
      std::string points;
      // 6 columns of 0.5 mm, 4 rows of 2 mm.
      for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        points += (points.empty() ? "" : "\\") + std::to_string(x * (5 - step)) + "." +
                  std::to_string(step) + "\\" + std::to_string(y * (7 - step)) + "." +
                  std::to_string(step) + "\\" + z;
      }
      loops.push_back(element(0x30060042, "CS", "CLOSED_PLANAR") + element(0x30060046, "IS", "4") +
                      element(0x30060050, "DS", points));
    }
  }
  const std::string series = sequence(0x30060014, {element(0x0020000E, "UI", "1.2.3")});
  return fileOf(
      "1.2.840.10008.5.1.4.1.1.481.3",
      element(0x00080060, "CS", "RTSTRUCT") + element(0x0020000E, "UI", "1.2.9") +
          sequence(0x30060010, {sequence(0x30060012, {series})}) +
          sequence(0x30060020,
                   {element(0x30060022, "IS", "3") + element(0x30060026, "LO", "roi")}) +
          sequence(0x30060039, {element(0x3006002A, "IS", "255\\0\\51") +
                                sequence(0x30060040, loops) + element(0x30060084, "IS", "3")}) +
          sequence(0x30060080, {element(0x30060084, "IS", "3") + liver(0x30060086)}));
}

}  // namespace

std::vector<std::string> segmentSeeds() {
  return {segmentation(Kind::kBinary), segmentation(Kind::kFractional),
          segmentation(Kind::kLabelMap), structureSet()};
}

}  // namespace palpate::fuzz
