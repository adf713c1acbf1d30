#include "image_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include "json_parts.h"
#include "palpate/vdb/image.h"
#include "scan_options.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// An image with at most so many different integers counts as labels, even if its file does not say
/// so.
constexpr std::size_t kFewValues = 64;
/// If there are more different values than this, they are not counted.
constexpr std::size_t kMostValues = 65536;

/// The directions of the axes in a radiologist's words: "right", "left", ...
std::string axisWords(const std::string& orientation) {
  std::string text;
  for (const char c : orientation) {
    const char* word = c == 'R'   ? "right"
                       : c == 'L' ? "left"
                       : c == 'A' ? "front"
                       : c == 'P' ? "back"
                       : c == 'S' ? "up"
                       : c == 'I' ? "down"
                                  : "?";
    text += (text.empty() ? "" : ", ") + std::string(word);
  }
  return text;
}

/// The number of voxels of each value; nothing if values are not integers, or too many differ.
std::optional<std::map<int, std::size_t>> countValues(const std::vector<float>& values) {
  constexpr float kLargest = 1e9F;
  std::map<int, std::size_t> counts;
  int last = 0;
  std::size_t* count = nullptr;
  for (const float value : values) {
    if (!(std::abs(value) < kLargest) || value != std::floor(value)) return {};
    const int whole = static_cast<int>(value);
    if (count == nullptr || whole != last) count = &counts[last = whole];
    ++*count;
    if (counts.size() > kMostValues) return {};
  }
  return counts;
}

/// Whether integer values are labels rather than gray values: none is below 0, and a voxel next to
/// another one that is not 0 mostly has the same value. A parcel is more than a few voxels wide,
/// while gray values have noise.
bool lookLikeLabels(const std::vector<float>& values) {
  constexpr double kSame = 0.7;
  std::size_t pairs = 0;
  std::size_t same = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (values[n] < 0.0F) return false;
    if (n == 0 || values[n] == 0.0F || values[n - 1] == 0.0F) continue;
    ++pairs;
    same += values[n] == values[n - 1] ? 1U : 0U;
  }
  return static_cast<double>(same) > kSame * static_cast<double>(pairs);
}

std::string colorText(const vdb::LabelColor& c) {
  char text[16];
  const auto byte = [](float v) { return static_cast<unsigned>(std::lround(v * 255.0F)); };
  std::snprintf(text, sizeof text, "#%02X%02X%02X", byte(c[0]), byte(c[1]), byte(c[2]));
  return text;
}

void addLabels(const std::map<int, std::size_t>& counts, const vdb::LabelTable& table,
               FileReport& out) {
  out.json["labels"] = Json::array();
  Table rows({"label", "name", "voxels", "color"});
  std::map<int, std::size_t> all = counts;
  for (const auto& [value, name] : table.names) all.try_emplace(value, 0);
  std::size_t without = 0;
  for (const auto& [value, count] : all) {
    const auto name = table.names.find(value);
    const auto color = table.colors.find(value);
    const bool named = name != table.names.end();
    const std::string hex = color != table.colors.end() ? colorText(color->second) : "";
    out.json["labels"].push_back({{"value", value},
                                  {"name", named ? Json(name->second) : Json()},
                                  {"voxels", count},
                                  {"color", hex.empty() ? Json() : Json(hex)}});
    if (count == 0) {
      ++without;
      continue;
    }
    rows.add({std::to_string(value), named ? name->second : "-", formatCount(count),
              hex.empty() ? "-" : hex});
  }
  out.text += rows.text("  ");
  if (without > 0) {
    out.text += "  " + std::to_string(without) + " more names have no voxels\n";
  }
}

void addValues(const std::vector<float>& values, FileReport& out) {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return;
  out.json["values"] = {low, high};
  out.text += "  values       " + formatNumber(low) + " to " + formatNumber(high) + "\n";
}

std::string rowText(const Mat3& axes, const Vec3& origin, int row) {
  constexpr double kPlusZero = 0.0;  // adding it turns -0 into 0
  char text[128];
  std::snprintf(text, sizeof text, "%12.6g %12.6g %12.6g %12.6g", axes[0][row] * 1e3 + kPlusZero,
                axes[1][row] * 1e3 + kPlusZero, axes[2][row] * 1e3 + kPlusZero,
                origin[row] * 1e3 + kPlusZero);
  return text;
}

}  // namespace

std::string boxText(const Box3& box, double unit, const std::string& name) {
  if (box.isEmpty()) return "empty";
  return formatVector(box.lo / unit) + " to " + formatVector(box.hi / unit) + " " + name;
}

FileReport imageReport(const std::string& file, const InfoOptions& options, Console& console) {
  const vdb::ImageOptions how = imageOptions(options.scan);
  const vdb::ImageInfo info = vdb::readImageInfo(file, how);
  const vdb::Image image = vdb::readImage(file, how);
  for (const auto& note : image.notes) console.note(file + ": " + note);
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index{0.0};
    for (int i = 0; i < 3; ++i) {
      index[i] = ((corner >> i) & 1) != 0 ? info.size[static_cast<std::size_t>(i)] - 1.0 : 0.0;
    }
    box.include(info.axes * index + info.origin);
  }
  const Vec3 spacing(glm::length(info.axes[0]), glm::length(info.axes[1]),
                     glm::length(info.axes[2]));
  const auto size = std::to_string(info.size[0]) + " x " + std::to_string(info.size[1]) + " x " +
                    std::to_string(info.size[2]);
  FileReport out;
  out.json = {{"file", file},
              {"kind", "image"},
              {"format", info.format},
              {"size", info.size},
              {"spacing_m", vectorJson(spacing)},
              {"data_type", info.data_type},
              {"length_unit", info.length_unit},
              {"orientation", info.orientation},
              {"axes_m", Json::array({vectorJson(info.axes[0]), vectorJson(info.axes[1]),
                                      vectorJson(info.axes[2])})},
              {"origin_m", vectorJson(info.origin)},
              {"bounds_m", boxJson(box)},
              {"notes", image.notes}};
  out.text = file + ": an image of " + size + " voxels (" + info.format + ", " + info.data_type +
             ", lengths in " + info.length_unit + ")\n";
  out.text += "  spacing      " + formatNumber(spacing.x * 1e3) + " x " +
              formatNumber(spacing.y * 1e3) + " x " + formatNumber(spacing.z * 1e3) + " mm\n";
  out.text += "  orientation  " + info.orientation + ": its axes run to the " +
              axisWords(info.orientation) +
              (glm::determinant(info.axes) < 0.0 ? "; left-handed" : "") + "\n";
  out.text += "  centers      " + boxText(box, 1e-3, "mm (RAS)") + "\n";
  for (int row = 0; row < 3; ++row) {
    out.text += (row == 0 ? "  affine    " : "            ") +
                rowText(info.axes, info.origin, row) + (row == 0 ? "  (mm, RAS)" : "") + "\n";
  }
  addValues(image.values, out);
  const vdb::LabelTable table =
      options.names.empty() ? image.labels : vdb::readLabelTable(options.names);
  const auto counts = countValues(image.values);
  const bool told = info.is_labels || !options.names.empty();
  if (counts && (told || counts->size() <= kFewValues || lookLikeLabels(image.values))) {
    addLabels(*counts, table, out);
  } else if (told) {
    console.note(file + ": it says that it holds labels, but its values are not whole numbers");
  }
  return out;
}

}  // namespace palpate::tools
