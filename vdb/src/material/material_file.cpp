#include "material/material_file.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "grid/vdb_file.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"
#include "palpate/version.h"

namespace palpate::vdb {
namespace {

constexpr const char* kUnit = "unit";
constexpr const char* kQuantised = "palpate:quantised";
/// More voxels than this are a mistake, or would exceed the index of a block.
constexpr double kMostVoxels = 2147483647.0;

std::string textOf(const openvdb::GridBase& grid, const char* key) {
  const openvdb::Metadata::ConstPtr value = grid[key];
  return value ? value->str() : std::string();
}

/// Parses "16 bits, least 200, step 0.03"; nothing if the text differs in any way.
Quantisation quantisationOf(const openvdb::GridBase& grid) {
  Quantisation how;
  const std::string text = textOf(grid, kQuantised);
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto number = [&](std::string_view before, auto& value) {
    if (!std::string_view(at, static_cast<std::size_t>(end - at)).starts_with(before)) return false;
    const auto [next, error] = std::from_chars(at + before.size(), end, value);
    at = next;
    return error == std::errc();
  };
  if (!number("", how.bits) || !number(" bits, least ", how.least) ||
      !number(", step ", how.step) || !number(", error ", how.error) || at != end ||
      (how.bits != 8 && how.bits != 16)) {
    return {};
  }
  return how;
}

void requireFogVolume(const openvdb::GridBase& grid, const std::string& path) {
  const std::string name = "grid '" + grid.getName() + "'";
  if (const std::string type = typeOf(grid); type != "FloatGrid") {
    throw inputError("vdb.type", name + " is a " + type + "; a material is read from floats",
                     "write it as a FloatGrid", path);
  }
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    throw inputError(
        "vdb.class", name + " is a level set: it holds distances, not a parameter of a material",
        "name a fog volume, such as skin/stiffness; palpate info lists the grids", path);
  }
}

/// Factor from the unit of the grid's values to SI units.
double valueScale(const openvdb::GridBase& grid, const MaterialGridRequest& request,
                  const std::string& path) {
  std::string unit = textOf(grid, kUnit);
  if (unit.empty()) unit = request.unit_if_missing;
  const std::string name = "grid '" + grid.getName() + "'";
  if (!request.dimension) {
    if (unit.empty() || unit == "1") return 1.0;
    throw inputError("vdb.value_unit",
                     name + " has the unit " + unit + ", but the parameter is a ratio and has none",
                     "name a grid of ratios, whose metadata has no 'unit' or the unit 1", path);
  }
  const std::string known(unitHelp(*request.dimension));
  if (unit.empty()) {
    throw inputError("vdb.no_value_unit", name + " does not say in which unit its values are",
                     "write it as string metadata 'unit' into the grid, or give it in the scene: "
                     "unit: " +
                         known,
                     path);
  }
  const Quantity one = parseQuantity("1 " + unit, *request.dimension);
  if (one.status != Quantity::Status::kOk) {
    throw inputError("vdb.value_unit",
                     name + " has the unit '" + unit + "', which does not fit the parameter",
                     "its unit must be " + known, path);
  }
  return one.si;
}

/// Finds the place of voxel (0, 0, 0) of `box`, and the steps from voxel to voxel [m].
void placeOf(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box, double meters,
             const std::string& path, Image& image) {
  if (!grid.transform().isLinear()) {
    throw inputError("vdb.transform",
                     "grid '" + grid.getName() + "' is a frustum, whose voxels grow with the depth",
                     "resample it into voxels of one size", path);
  }
  const auto world = [&](const openvdb::Vec3d& index) {
    const openvdb::Vec3d p = grid.indexToWorld(index);
    return Vec3(p.x(), p.y(), p.z()) * meters;
  };
  // The axes come from the map's own matrix, because differences of far points would lose digits.
  const openvdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) image.axes[axis][i] = m(axis, i) * meters;
  }
  image.origin = world(box.min().asVec3d());
  const double volume = glm::determinant(image.axes);
  if (!std::isfinite(volume) || volume == 0.0 || !isFinite(image.origin)) {
    throw inputError("vdb.transform", "the voxels of grid '" + grid.getName() + "' have no volume",
                     "the file may be damaged; write it again", path);
  }
}

Image denseOf(const openvdb::FloatGrid& grid, double meters, double scale,
              const std::string& path) {
  const std::string name = "grid '" + grid.getName() + "'";
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) throw inputError("vdb.empty", name + " has no active voxels", "", path);
  Image image;
  double count = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = static_cast<double>(box.max()[axis]) - box.min()[axis] + 1.0;
    count *= length;
    if (!(count <= kMostVoxels)) {
      throw inputError("vdb.large", name + " spans more than 2^31 voxels",
                       "remove distant voxels, or write it with larger voxels", path);
    }
    image.size[static_cast<std::size_t>(axis)] = static_cast<int>(length);
  }
  placeOf(grid, box, meters, path, image);
  image.values.assign(static_cast<std::size_t>(count), std::numeric_limits<float>::quiet_NaN());
  for (auto on = grid.cbeginValueOn(); on; ++on) {
    const float value = *on;
    if (!std::isfinite(value)) {
      throw inputError("vdb.not_finite", name + " has voxels that are not numbers",
                       "the file may be damaged; write it again", path);
    }
    const auto si = static_cast<float>(static_cast<double>(value) * scale);
    openvdb::CoordBBox tile;
    on.getBoundingBox(tile);
    for (int z = tile.min().z(); z <= tile.max().z(); ++z) {
      for (int y = tile.min().y(); y <= tile.max().y(); ++y) {
        const openvdb::Coord first = openvdb::Coord(tile.min().x(), y, z) - box.min();
        const std::size_t at =
            static_cast<std::size_t>(first.x()) +
            static_cast<std::size_t>(image.size[0]) *
                (static_cast<std::size_t>(first.y()) +
                 static_cast<std::size_t>(image.size[1]) * static_cast<std::size_t>(first.z()));
        const auto row = image.values.begin() + static_cast<std::ptrdiff_t>(at);
        std::fill(row, row + (tile.max().x() - tile.min().x() + 1), si);
      }
    }
  }
  return image;
}

openvdb::math::Transform::Ptr transformOf(const Image& image, double meters) {
  const Mat3 axes = image.axes / meters;
  const Vec3 origin = image.origin / meters;
  const double voxel = axes[0].x;
  if (voxel > 0.0 && axes == Mat3(voxel)) {
    auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    transform->postTranslate(openvdb::Vec3d(origin.x, origin.y, origin.z));
    return transform;
  }
  openvdb::Mat4d m = openvdb::Mat4d::identity();
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) m(axis, i) = axes[axis][i];
    m(3, axis) = origin[axis];
  }
  return openvdb::math::Transform::createLinearTransform(m);
}

}  // namespace

openvdb::FloatGrid::Ptr toOpenVdb(const NamedMaterialGrid& named) {
  initializeOpenVdb();
  const Image image = named.grid->voxels();
  const std::optional<double> meters = metersPer(named.length_unit);
  if (!meters) {
    throw inputError("unit.unknown", "unknown length unit '" + named.length_unit + "'",
                     "use m, cm, mm or um");
  }
  auto grid = openvdb::FloatGrid::create(0.0F);
  grid->setTransform(transformOf(image, *meters));
  auto writer = grid->getAccessor();
  std::size_t n = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i) {
        writer.setValueOn(openvdb::Coord(i, j, k), image.values[n++]);
      }
    }
  }
  grid->pruneGrid();
  grid->setName(named.name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator("palpate");
  const auto note = [&](const std::string& key, const std::string& text) {
    grid->insertMeta(key, openvdb::StringMetadata(text));
  };
  note("frame", "world");
  for (const auto& [key, value] : named.metadata) note(key, value);
  note("length_unit", named.length_unit);
  note(kUnit, named.unit);
  const MaterialMap::Range range = named.grid->range();
  note("range", exactNumber(range.least) + " to " + exactNumber(range.most) + " " + named.unit);
  note("palpate:version", PALPATE_VERSION_STRING);
  if (const Quantisation& how = named.grid->info().quantisation; how.bits != 32) {
    note(kQuantised, std::to_string(how.bits) + " bits, least " + exactNumber(how.least) +
                         ", step " + exactNumber(how.step) + ", error " + exactNumber(how.error));
  }
  note("tolerance", exactNumber(named.grid->info().quantisation.error) + " " + named.unit);
  return grid;
}

MaterialGridPtr readMaterialGrid(const std::string& path, const MaterialGridRequest& request) {
  VdbFile file(path);
  const VdbArchive::Entry& entry = file.choose(request.name);
  requireFogVolume(*entry.grid, path);
  const double scale = valueScale(*entry.grid, request, path);
  const std::string unit = unitOf(*entry.grid, request.length_unit_if_missing, path);
  const std::optional<double> meters = metersPer(unit);
  if (!meters) {
    throw inputError("unit.unknown", "unknown length unit '" + unit + "'", "use m, cm, mm or um",
                     path);
  }
  return readingFrom(path, [&] {
    const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.read(entry));
    Image image = denseOf(*grid, *meters, scale, path);
    image.source = path + ": " + entry.name();
    // In another unit the quantization steps would be different.
    const Quantisation known = scale == 1.0 ? quantisationOf(*grid) : Quantisation{};
    return std::make_shared<const MaterialGrid>(std::move(image), request.tolerance, known,
                                                request.max_memory);
  });
}

}  // namespace palpate::vdb
