#include "scene_baking.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "palpate/scene/scene_file.h"
#include "palpate/scene/suggestion.h"

namespace palpate::tools {
namespace {

constexpr double kDefaultVoxelsPerSide = 128.0;

}  // namespace

Error bakeUsageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.bake", std::move(message), std::move(hint)});
}

void checkSceneOptions(const BakeOptions& options, const SceneDescription& description) {
  const std::pair<bool, const char*> misplaced[] = {
      {!options.units.empty(), "--units applies to meshes; a scene names its unit"},
      {!options.sign.empty(), "--sign applies to meshes"},
      {!options.shell.empty(), "--shell applies to meshes"},
      {options.smooth.has_value(), "--smooth applies to meshes"},
      {options.above.has_value(), "--above applies to images"},
      {options.distances, "--distances applies to images"},
      {!options.labels.empty(), "--labels applies to images"}};
  for (const auto& [given, message] : misplaced) {
    if (given) throw bakeUsageError(message);
  }
  std::vector<std::string_view> names;
  for (const auto& layer : description.layers) names.push_back(layer.name);
  for (const std::string& wanted : options.layers) {
    if (std::find(names.begin(), names.end(), wanted) != names.end()) continue;
    throw inputError("scene.unknown_layer", "there is no layer '" + wanted + "'",
                     suggestionFor(wanted, names, "palpate info names the layers"), options.input);
  }
}

bool isAskedFor(const BakeOptions& options, const std::string& layer) {
  return options.layers.empty() ||
         std::find(options.layers.begin(), options.layers.end(), layer) != options.layers.end();
}

double askedVoxel(const BakeOptions& options, const LengthUnit& unit) {
  if (options.voxel.empty()) return 0.0;
  const double voxel = parseLength(options.voxel, unit, "--voxel");
  if (!(voxel > 0.0)) throw bakeUsageError("--voxel must be greater than 0");
  return voxel;
}

double defaultVoxel(const LengthUnit& unit, const Box3& bounds, const std::string& what,
                    Console& console) {
  const Vec3 size = bounds.size();
  const double voxel = std::max({size.x, size.y, size.z}) / kDefaultVoxelsPerSide;
  console.note(what + ": voxels of " + formatNumber(voxel / unit.meters, 3) + " " + unit.name +
               ", 1/128 of the longest side; --voxel sets another size");
  return voxel;
}

std::uint64_t memoryLeft(const BakeOptions& options, std::uint64_t taken) {
  if (options.max_memory.empty()) return 0;
  const std::uint64_t allowed = parseBytes(options.max_memory, "--max-memory");
  return allowed > taken ? allowed - taken : 1;
}

Error withMemoryHint(const Error& error) {
  Problem problem = error.problem();
  if (problem.code == "bake.memory") problem.hint += "; --max-memory sets the limit";
  return {error.kind(), std::move(problem)};
}

vdb::BakeOptions gridOptions(const BakeOptions& options, const std::string& layer, double voxel,
                             const std::string& unit, const std::string& source,
                             std::uint64_t taken) {
  vdb::BakeOptions bake;
  bake.max_memory = memoryLeft(options, taken);
  bake.voxel_size = voxel;
  bake.half_width = options.half_width;
  bake.name = layer + "/surface";
  bake.length_unit = unit;
  bake.metadata = {{"layer", layer}, {"source", source}};
  return bake;
}

void requireBounds(const Field& field, const std::string& layer, const std::string& file) {
  if (field.bounds().isBounded()) return;
  throw inputError("bake.unbounded", "layer '" + layer + "' reaches to infinity",
                   "bake the others with --layer, or cut it in the scene: inside: "
                   "{intersection: [it, a box]}",
                   file);
}

}  // namespace palpate::tools
