#include "image/dicom_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "image/header_text.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"

namespace palpate::vdb {
namespace {

constexpr std::uint32_t kUndefined = 0xFFFFFFFFU;
constexpr std::uint32_t kItem = 0xFFFEE000U;
constexpr std::uint32_t kItemEnd = 0xFFFEE00DU;
constexpr std::uint32_t kSequenceEnd = 0xFFFEE0DDU;
constexpr std::uint32_t kTransferSyntax = 0x00020010U;
constexpr std::size_t kPreamble = 128;
constexpr std::size_t kLongestText = 4096;
constexpr int kDeepest = 32;

/// Tags of sequences. Where values carry no type (VR), nothing else tells sequences from bytes.
/// First those of segmentations, then those of structure sets.
constexpr std::array<std::uint32_t, 16> kSequences = {
    0x00620002, 0x0062000A, 0x0062000F, 0x00209113, 0x00209116, 0x00289110, 0x52009229, 0x52009230,
    0x30060010, 0x30060012, 0x30060014, 0x30060020, 0x30060039, 0x30060040, 0x30060080, 0x30060086};

class Walker {
 public:
  Walker(const std::string& bytes, DicomElements& out, DicomDepth depth)
      : bytes_(bytes), out_(out), into_(&out), is_deep_(depth == DicomDepth::kSequencesToo) {}

  void walk() {
    at_ = kPreamble + 4;
    // The file's meta information is always explicit and little endian.
    while (at_ + 4 <= bytes_.size() && number(at_, 2) == 0x0002) element(bytes_.size(), 0);
    const std::string& syntax = out_.transfer_syntax;
    if (syntax == "1.2.840.10008.1.2.1.99") {
      throw inputError("dicom.encoding", "the whole data set is deflated, which cannot be read",
                       "save it without (dcmdjpeg, gdcmconv --raw)", out_.path);
    }
    explicit_ = syntax != "1.2.840.10008.1.2";
    big_ = out_.big_endian = syntax == "1.2.840.10008.1.2.2";
    while (at_ < bytes_.size()) element(bytes_.size(), 0);
  }

 private:
  [[noreturn]] void failShort() const {
    throw inputError("dicom.truncated",
                     "the file is cut short: an element reaches beyond its " +
                         std::to_string(bytes_.size()) + " bytes",
                     "fetch or write the file again", out_.path);
  }
  [[noreturn]] void failDamaged(const std::string& what) const {
    throw inputError("dicom.damaged", what + " at byte " + std::to_string(at_),
                     "fetch or write the file again", out_.path);
  }

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at + size > bytes_.size()) failShort();
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = big_ ? at + i : at + size - 1 - i;
      value = (value << 8U) | static_cast<unsigned char>(bytes_[from]);
    }
    return value;
  }

  std::uint32_t takeTag() {
    const std::uint32_t group = number(at_, 2);
    const std::uint32_t tag = (group << 16U) | number(at_ + 2, 2);
    at_ += 4;
    return tag;
  }

  std::uint32_t takeLength() {
    const std::uint32_t length = number(at_, 4);
    at_ += 4;
    return length;
  }

  void skip(std::uint32_t length, std::size_t end) {
    if (length > end - at_) {
      if (end == bytes_.size()) failShort();
      failDamaged("an element is longer than the sequence or item that holds it,");
    }
    at_ += length;
  }

  /// One element that ends before `end`.
  void element(std::size_t end, int depth) {
    if (depth > kDeepest) failDamaged("sequences are nested too deeply,");
    const std::uint32_t tag = takeTag();
    if ((tag >> 16U) == 0xFFFE) failDamaged("an item outside of a sequence");
    std::string_view vr;
    std::uint32_t length = 0;
    if (explicit_) {
      if (at_ + 4 > bytes_.size()) failShort();
      vr = std::string_view(bytes_).substr(at_, 2);
      // All types (VR) of PS3.5, table 6.2-1, whose lengths have 2 or 4 bytes. For any other type
      // the format of the length is unknown.
      constexpr std::array<std::string_view, 21> kShort = {
          "AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO",
          "LT", "PN", "SH", "SL", "SS", "ST", "TM", "UI", "UL", "US"};
      constexpr std::array<std::string_view, 13> kLong = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                          "SV", "UC", "UN", "UR", "UT", "UV"};
      if (std::find(kShort.begin(), kShort.end(), vr) == kShort.end() &&
          std::find(kLong.begin(), kLong.end(), vr) == kLong.end()) {
        failDamaged("no value representation");
      }
      if (std::find(kLong.begin(), kLong.end(), vr) != kLong.end()) {
        at_ += 4;
        length = takeLength();
      } else {
        length = number(at_ + 2, 2);
        at_ += 4;
      }
    } else {
      length = takeLength();
    }
    if (++elements_ % 1024 == 0) pollStop();
    if (tag == dicom::kPixelData && depth == 0) {
      out_.pixels_are_words = vr != "OB";
      return pixels(length);
    }
    if (length == kUndefined) {
      // A sequence of unknown type (UN) within an explicit file has implicit elements.
      const bool was_explicit = explicit_;
      if (vr == "UN") explicit_ = false;
      items(bytes_.size(), true, depth, tag);
      explicit_ = was_explicit;
      return;
    }
    const std::size_t begin = at_;
    skip(length, end);
    const bool is_sequence =
        vr == "SQ" || (is_deep_ && vr.empty() &&
                       std::find(kSequences.begin(), kSequences.end(), tag) != kSequences.end());
    if (is_sequence) {
      at_ = begin;
      items(begin + length, false, depth, tag);
    } else if (is_deep_ || (depth == 0 && length <= kLongestText)) {
      keep(tag, bytes_.substr(begin, length));
    }
  }

  void keep(std::uint32_t tag, std::string value) {
    if (tag == kTransferSyntax) {
      out_.transfer_syntax = trimmed(value.substr(0, value.find('\0')));
    }
    into_->texts[tag] = std::move(value);
  }

  /// Reads the items of the sequence `of` up to `end`, or up to its end mark.
  void items(std::size_t end, bool until_mark, int depth, std::uint32_t of) {
    DicomItem& holder = *into_;
    while (until_mark || at_ < end) {
      const std::uint32_t tag = takeTag();
      const std::uint32_t length = takeLength();
      if (tag == kSequenceEnd && until_mark) return;
      if (tag != kItem) failDamaged("no item in a sequence");
      if (is_deep_) {
        into_ = &holder.sequences[of].emplace_back();
        into_->path = out_.path;
        into_->big_endian = big_;
      }
      if (length != kUndefined) {
        const std::size_t item_begin = at_;
        skip(length, end);
        const std::size_t item_end = at_;
        at_ = item_begin;
        while (at_ < item_end) element(item_end, depth + 1);
        into_ = &holder;
        continue;
      }
      while (number(at_, 2) != 0xFFFE) element(end, depth + 1);
      if (takeTag() != kItemEnd) failDamaged("an item without an end");
      takeLength();
      into_ = &holder;
    }
  }

  void pixels(std::uint32_t length) {
    if (out_.has_pixels) failDamaged("pixel data for the second time");
    out_.has_pixels = true;
    if (length != kUndefined) {
      out_.pixel_bytes = length;
      out_.pixels = {{at_, length}};
      skip(length, bytes_.size());
      return;
    }
    out_.packed = true;
    for (;;) {
      const std::uint32_t tag = takeTag();
      const std::uint32_t size = takeLength();
      if (tag == kSequenceEnd) return;
      if (tag != kItem || size == kUndefined) failDamaged("no fragment of pixel data");
      out_.pixels.push_back({at_, size});
      skip(size, bytes_.size());
    }
  }

  const std::string& bytes_;
  DicomElements& out_;
  DicomItem* into_;  ///< the item that the present element belongs to
  bool is_deep_;     ///< keep sequences as well
  std::size_t at_ = 0;
  std::uint64_t elements_ = 0;
  bool explicit_ = true;
  bool big_ = false;
};

std::string tagName(std::uint32_t tag) {
  char name[16];
  std::snprintf(name, sizeof name, "(%04X,%04X)", tag >> 16U, tag & 0xFFFFU);
  return name;
}

}  // namespace

std::string DicomItem::text(std::uint32_t tag) const {
  const auto at = texts.find(tag);
  if (at == texts.end()) return {};
  return std::string(trimmed(std::string_view(at->second).substr(0, at->second.find('\0'))));
}

std::vector<double> DicomItem::numbers(std::uint32_t tag, std::size_t count) const {
  std::string words = text(tag);
  std::replace(words.begin(), words.end(), '\\', ' ');
  const auto list = numbersIn<double>(words);
  const bool finite =
      list && std::all_of(list->begin(), list->end(), [](double v) { return std::isfinite(v); });
  if (!finite || (count > 0 && list->size() != count)) {
    constexpr std::size_t kMostShown = 80;
    throw inputError("dicom.value",
                     tagName(tag) + " is '" + text(tag).substr(0, kMostShown) + "', not " +
                         (count > 0 ? std::to_string(count) + " " : "") +
                         (count == 1 ? "number" : "numbers"),
                     {}, path);
  }
  return *list;
}

std::vector<int> DicomItem::shorts(std::uint32_t tag, std::size_t count) const {
  const auto at = texts.find(tag);
  if (at == texts.end()) return {};
  if (at->second.size() != 2 * count) {
    throw inputError(
        "dicom.value",
        tagName(tag) + " must hold " +
            (count == 1 ? "two bytes" : std::to_string(count) + " numbers of two bytes each"),
        {}, path);
  }
  std::vector<int> out;
  for (std::size_t n = 0; n < count; ++n) {
    const auto first = static_cast<unsigned char>(at->second[2 * n]);
    const auto second = static_cast<unsigned char>(at->second[2 * n + 1]);
    out.push_back(big_endian ? first * 256 + second : second * 256 + first);
  }
  return out;
}

std::optional<int> DicomItem::shortAt(std::uint32_t tag) const {
  const std::vector<int> one = shorts(tag, 1);
  return one.empty() ? std::nullopt : std::optional(one.front());
}

const std::vector<DicomItem>& DicomItem::items(std::uint32_t tag) const {
  static const std::vector<DicomItem> none;
  const auto at = sequences.find(tag);
  return at == sequences.end() ? none : at->second;
}

const DicomItem* DicomItem::first(std::uint32_t tag) const {
  const std::vector<DicomItem>& all = items(tag);
  return all.empty() ? nullptr : &all.front();
}

DicomElements readDicomElements(const std::string& path, DicomDepth depth) {
  std::error_code failure;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, failure)) file.open(path, std::ios::binary);
  if (!file.is_open()) {
    throw inputError("dicom.unreadable", "the file cannot be opened for reading", {}, path);
  }
  std::string bytes;
  std::vector<char> chunk(std::size_t{1} << 16U);
  while (file) {
    pollStop();
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    bytes.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (bytes.size() < kPreamble + 4 || bytes.compare(kPreamble, 4, "DICM") != 0) {
    throw inputError("dicom.format", "this is not a DICOM file: DICM is not at byte 128",
                     "name a folder with one DICOM series, or a file of it", path);
  }
  DicomElements out;
  out.path = path;
  Walker(bytes, out, depth).walk();
  return out;
}

}  // namespace palpate::vdb
