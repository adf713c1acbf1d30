#include "scene_map.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "palpate/core/text.h"
#include "palpate/vdb/material_grid.h"
#include "palpate/vdb/text.h"
#include "scene_grid.h"
#include "scene_image.h"

namespace palpate::vdb {
namespace {

/// Relative to the range of a transfer function: far below what a hand can tell apart (some
/// percent), and within reach of 16 bits.
constexpr double kDefaultTolerance = 1e-5;

/// Reads a quantity of `kind` [SI unit], a length also in the scene's unit, or a number for a
/// ratio; nothing if it is none of these.
std::optional<double> quantityOf(const SceneLoader& loader, const Node& node,
                                 std::optional<Dimension> dimension) {
  if (node.kind != Node::Kind::kScalar || node.quoted) return {};
  if (!dimension || *dimension == Dimension::kLength) {
    if (const auto number = parseNumber(node.text)) {
      return dimension ? *number * loader.metersPerUnit() : *number;
    }
    if (!dimension) return {};
  }
  const Quantity quantity = parseQuantity(node.text, *dimension);
  if (quantity.status != Quantity::Status::kOk) return {};
  return quantity.si;
}

std::string unitsOf(std::optional<Dimension> dimension) {
  return dimension ? "a number with its unit: " + std::string(unitHelp(*dimension))
                   : std::string("a number without a unit");
}

/// [SI unit] -1 if it is not given.
double readTolerance(const MapReader& reader, const ParameterKind& of) {
  const Node* node = reader.find("tolerance");
  if (node == nullptr) return -1.0;
  const auto value = quantityOf(reader.loader(), *node, of.dimension);
  if (!value || !(*value > 0.0)) {
    throw reader.errorAt("tolerance", "scene.range",
                         "'tolerance' must be more than 0, in the unit of '" + of.key + "'",
                         "write " + unitsOf(of.dimension));
  }
  return *value;
}

Transfer readTransfer(const MapReader& reader, const ParameterKind& of) {
  const Node& list = *reader.find("transfer");
  const Document& document = reader.loader().document();
  const std::string form = of.dimension ? "transfer: [[-100, 200 " : "transfer: [[-100, 0.2";
  const std::string unit =
      of.dimension
          ? std::string(unitHelp(*of.dimension)).substr(0, unitHelp(*of.dimension).find(' '))
          : "";
  const std::string hint =
      of.dimension ? form + unit + "], [300, 2000 " + unit + "]]" : form + "], [300, 0.6]]";
  if (list.kind != Node::Kind::kSequence || list.items.empty()) {
    throw document.error(list.mark, "scene.kind", "'transfer' must be a list of points", hint);
  }
  Transfer transfer;
  for (const Node& item : list.items) {
    if (item.kind != Node::Kind::kSequence || item.items.size() != 2) {
      throw document.error(
          item.mark, "scene.kind",
          "a point of 'transfer' is a pair: an image's value, and '" + of.key + "' there", hint);
    }
    const Node& from = item.items[0];
    const auto value = from.kind == Node::Kind::kScalar && !from.quoted ? parseNumber(from.text)
                                                                        : std::optional<double>();
    if (!value) {
      throw document.error(from.mark, "scene.kind", "an image's value is a number", hint);
    }
    const auto to = quantityOf(reader.loader(), item.items[1], of.dimension);
    if (!to || (*to < 0.0 && !of.is_signed)) {
      throw document.error(item.items[1].mark, "scene.quantity",
                           "this is not a '" + of.key + (of.is_signed ? "'" : "' of 0 or more"),
                           "write " + unitsOf(of.dimension));
    }
    if (!transfer.empty() && !(*value > transfer.back().first)) {
      throw document.error(from.mark, "scene.range",
                           "the points of 'transfer' must go from smaller to larger image values",
                           "sort them, and give each value once");
    }
    transfer.emplace_back(*value, *to);
  }
  return transfer;
}

/// Adds a note on what the reader decided.
void tell(const RegisterOptions& options, const ParameterKind& of, const MaterialGrid& grid) {
  if (!options.on_note) return;
  const Quantisation& how = grid.info().quantisation;
  if (how.bits == 32) return;
  const std::string unit =
      of.dimension
          ? ' ' + std::string(unitHelp(*of.dimension)).substr(0, unitHelp(*of.dimension).find(' '))
          : "";
  options.on_note(of.key + " from " + grid.info().source + ": " + std::to_string(how.bits) +
                  " bits a voxel, off by " + shortNumber(how.error, 2) + unit + " at most");
}

template <typename Make>
MaterialGridPtr madeAt(const MapReader& reader, std::string_view key, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kInput) throw;
    throw atKey(reader, key, error);
  }
}

}  // namespace

MaterialMapPtr readGridMap(const MapReader& reader, const ParameterKind& of,
                           const RegisterOptions& options) {
  const MapReader inner = reader.map("grid");
  const std::string path = readExistingFile(inner, "file");
  MaterialGridRequest request;
  request.name = inner.text("name");
  request.dimension = of.dimension;
  request.unit_if_missing = inner.text("unit");
  request.length_unit_if_missing = inner.text("units");
  request.tolerance = std::max(0.0, readTolerance(inner, of));
  request.max_memory = options.max_memory;
  const MaterialGridPtr grid =
      madeAt(inner, "file", [&] { return readMaterialGrid(path, request); });
  tell(options, of, *grid);
  return grid;
}

MaterialMapPtr readImageMap(const MapReader& reader, const ParameterKind& of,
                            const RegisterOptions& options) {
  const auto image = std::static_pointer_cast<SceneImage>(
      reader.loader().image(reader.text("image"), reader.find("image")->mark));
  const Transfer transfer = readTransfer(reader, of);
  double tolerance = readTolerance(reader, of);
  if (tolerance < 0.0) {
    const auto [low, high] =
        std::minmax_element(transfer.begin(), transfer.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; });
    tolerance = kDefaultTolerance * (high->second - low->second);
  }
  const MaterialGridPtr grid = madeAt(reader, "image", [&] {
    return materialFromImage(image->file->image(), transfer, tolerance, options.max_memory);
  });
  tell(options, of, *grid);
  return grid;
}

}  // namespace palpate::vdb
