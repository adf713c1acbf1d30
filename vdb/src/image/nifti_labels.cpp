#include "image/nifti_labels.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "image/utf8.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kExtensionHead = 8;  ///< [bytes] size and code of an extension
constexpr std::string_view kCdata = "<![CDATA[";
constexpr std::string_view kCdataEnd = "]]>";

std::uint32_t wordAt(std::span<const unsigned char> bytes, std::size_t at, bool swapped) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  if (!swapped) return word;
  return (word >> 24U) | ((word >> 8U) & 0xFF00U) | ((word << 8U) & 0xFF0000U) | (word << 24U);
}

Error fail(const std::string& path, std::string message) {
  return inputError(
      "nifti.labels", std::move(message),
      "write the file again, or give a table of names beside it and drop the extension", path);
}

/// The value of `name="..."` in a tag.
std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    const std::size_t quote = at + name.size() + 1;
    const bool whole = at > 0 && (tag[at - 1] == ' ' || tag[at - 1] == '\n' || tag[at - 1] == '\t');
    if (!whole || quote >= tag.size() || tag[quote - 1] != '=') continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end == std::string_view::npos) return {};
    return tag.substr(quote + 1, end - quote - 1);
  }
  return {};
}

template <typename Number>
std::optional<Number> numberIn(std::optional<std::string_view> text) {
  if (!text) return {};
  Number value{};
  const auto [end, failure] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (failure != std::errc{} || end != text->data() + text->size()) return {};
  return value;
}

std::string unescaped(std::string_view text) {
  if (text.starts_with(kCdata) && text.ends_with(kCdataEnd)) {
    return std::string(text.substr(kCdata.size(), text.size() - kCdata.size() - kCdataEnd.size()));
  }
  constexpr std::pair<std::string_view, char> kEntities[] = {
      {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto* const entity =
        std::find_if(std::begin(kEntities), std::end(kEntities),
                     [&](const auto& e) { return text.substr(i).starts_with(e.first); });
    out += entity == std::end(kEntities) ? text[i] : entity->second;
    i += entity == std::end(kEntities) ? 1 : entity->first.size();
  }
  return out;
}

LabelTable tableIn(std::string_view xml, const std::string& path) {
  const std::size_t end_of_table = xml.find("</LabelTable>");
  if (end_of_table == std::string_view::npos) throw fail(path, "its table of labels has no end");
  xml = xml.substr(0, end_of_table);
  LabelTable table;
  for (std::size_t at = xml.find("<Label "); at != std::string_view::npos;
       at = xml.find("<Label ", at + 1)) {
    const std::size_t close = xml.find('>', at);
    const std::size_t end = xml.find("</Label>", at);
    if (close == std::string_view::npos || end == std::string_view::npos || end < close) {
      throw fail(path, "an entry of its table of labels has no end");
    }
    const std::string_view tag = xml.substr(at, close - at);
    const auto key = numberIn<int>(attribute(tag, "Key"));
    if (!key) throw fail(path, "an entry of its table of labels has no value: " + std::string(tag));
    const std::string name = asUtf8(unescaped(trimmed(xml.substr(close + 1, end - close - 1))));
    if (name.empty()) continue;
    const auto [entry, is_new] = table.names.emplace(*key, name);
    if (!is_new && entry->second != name) {
      throw fail(path, "its table names label " + std::to_string(*key) + " both `" + entry->second +
                           "` and `" + name + "`");
    }
    const auto red = numberIn<float>(attribute(tag, "Red"));
    const auto green = numberIn<float>(attribute(tag, "Green"));
    const auto blue = numberIn<float>(attribute(tag, "Blue"));
    const auto fits = [](const std::optional<float>& c) { return c && *c >= 0.0F && *c <= 1.0F; };
    if (fits(red) && fits(green) && fits(blue)) table.colors[*key] = {*red, *green, *blue};
  }
  return table;
}

}  // namespace

LabelTable niftiLabels(std::span<const unsigned char> extensions, bool swapped,
                       const std::string& path) {
  constexpr std::uint32_t kComment = 0;
  constexpr std::uint32_t kCaret = 30;
  if (extensions.size() < 4 || extensions[0] == 0) return {};
  std::size_t at = 4;
  while (at + kExtensionHead <= extensions.size()) {
    const std::size_t size = wordAt(extensions, at, swapped);
    const std::uint32_t code = wordAt(extensions, at + 4, swapped);
    // An impossible size ends the list, as in libnifti: padding before the voxels looks like that.
    if (size < kExtensionHead || size > extensions.size() - at) break;
    if (code == kComment || code == kCaret) {
      const std::string_view text(
          reinterpret_cast<const char*>(extensions.data()) + at + kExtensionHead,
          size - kExtensionHead);
      const std::size_t table = text.find("<LabelTable");
      if (table != std::string_view::npos) return tableIn(text.substr(table), path);
    }
    at += size;
  }
  return {};
}

}  // namespace palpate::vdb
