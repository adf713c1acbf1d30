#include "stand_in.h"

#include <charconv>
#include <optional>
#include <sstream>

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"
#include "scene_image.h"

namespace palpate::vdb {
namespace {

constexpr const char* kVersion = "1";
constexpr std::size_t kKeyDigits = 32;

/// In double quotes, with the escapes of YAML and JSON.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20U || byte == 0x7fU) {
      constexpr const char* kDigits = "0123456789abcdef";
      out += std::string("\\x") + kDigits[byte >> 4U] + kDigits[byte & 15U];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

template <typename Number>
Number numberOf(const Document& document, const Node& node) {
  Number value{};
  const char* const end = node.text.data() + node.text.size();
  const auto [at, failed] = std::from_chars(node.text.data(), end, value);
  if (node.kind != Node::Kind::kScalar || failed != std::errc() || at != end) {
    throw document.error(node.mark, "pack.stand_in", "this is not a number",
                         "pack the scene again");
  }
  return value;
}

}  // namespace

bool isStandIn(const std::string& path) { return hasExtension(path, ".scan.yaml"); }

std::string scanStandIn(const std::string& file, const ImageOptions& options) {
  const ImageInfo info = readImageInfo(file, options);
  ImageFile image(file, options, std::make_shared<Notes>(nullptr));
  const std::string& key = image.contentKey();
  if (!image.state().isKnown()) {
    throw inputError("pack.unreadable", "not all of its files can be read", {}, file);
  }
  std::ostringstream out;
  out.precision(9);
  out << "# Stands for a scan that is not in this bundle: its layers' grids are, under its hash.\n"
      << "palpate_scan: " << kVersion << "\nname: " << quoted(fileName(file))
      << "\nformat: " << quoted(info.format) << "\nsize: [" << info.size[0] << ", " << info.size[1]
      << ", " << info.size[2] << "]\ncontent: " << quoted(key)
      << "\nholds: " << (info.is_labels ? "labels" : "values") << "\nlabels:\n";
  for (const auto& [value, name] : info.labels.names) {
    out << "  - {value: " << value << ", name: " << quoted(name);
    const auto color = info.labels.colors.find(value);
    if (color != info.labels.colors.end()) {
      const LabelColor& c = color->second;
      out << ", color: [" << c[0] << ", " << c[1] << ", " << c[2] << "]";
    }
    out << "}\n";
  }
  return out.str();
}

StandIn readStandIn(const std::string& path) {
  const auto document = readDocument(path);
  const Node& root = document->root;
  const Node* version = root.find("palpate_scan");
  const Node* content = root.find("content");
  if (version == nullptr || version->text != kVersion || content == nullptr ||
      content->text.size() != kKeyDigits) {
    throw inputError("pack.stand_in", "this does not stand for a scan", "pack the scene again",
                     path);
  }
  StandIn out;
  out.content_key = content->text;
  const Node* holds = root.find("holds");
  out.is_labels = holds != nullptr && holds->text == "labels";
  const Node* labels = root.find("labels");
  if (labels == nullptr) return out;
  for (const Node& item : labels->items) {
    const Node* value = item.find("value");
    const Node* name = item.find("name");
    if (value == nullptr || name == nullptr) {
      throw document->error(item.mark, "pack.stand_in", "a label has a value and a name",
                            "pack the scene again");
    }
    const int label = numberOf<int>(*document, *value);
    out.labels.names[label] = name->text;
    const Node* color = item.find("color");
    if (color == nullptr || color->items.size() != 3) continue;
    LabelColor& c = out.labels.colors[label];
    for (std::size_t i = 0; i < 3; ++i) c[i] = numberOf<float>(*document, color->items[i]);
  }
  return out;
}

}  // namespace palpate::vdb
