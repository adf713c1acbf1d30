#include "image/masks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "image/image_parts.h"
#include "image/structures.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

/// [voxels] Tolerance between headers of one grid that several programs wrote in single precision
/// or with six digits.
constexpr double kSameGrid = 0.01;

constexpr const char* kExtensions[] = {".nii.gz",   ".nii",  ".seg.nrrd", ".nrrd",
                                       ".seg.nhdr", ".nhdr", ".mha",      ".mhd"};

/// "liver" for "masks/liver.nii.gz"; nothing if the name is not that of a mask.
std::string maskName(const std::string& path) {
  const std::string name = fileName(path);
  for (const char* const extension : kExtensions) {
    if (!hasExtension(name, extension)) continue;
    return name.substr(0, name.size() - std::string_view(extension).size());
  }
  return {};
}

/// The options for reading a single mask.
ImageOptions ofOne(const ImageOptions& options) {
  ImageOptions one = options;
  one.with.clear();
  one.priority.clear();
  return one;
}

struct Grid {
  std::array<int, 3> size{};
  Place place;
};

std::string gridText(const Grid& grid) {
  std::string text = shapeText(grid.size) + " voxels of ";
  for (int axis = 0; axis < 3; ++axis) {
    text += (axis == 0 ? "" : " x ") + shortNumber(glm::length(grid.place.axes[axis]) * 1e3, 4);
  }
  return text + " mm, axes " + orientationCodes(grid.place.axes);
}

std::string vectorText(const Vec3& v, double unit) {
  // Rounded first, so that no -0 is printed.
  const auto number = [&](double value) {
    return shortNumber(std::round(value * unit * 1e3) / 1e3 + 0.0, 4);
  };
  return "(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
}

/// Throws if `other` does not have the same voxels as `grid`.
void requireSameGrid(const Grid& grid, const std::string& path, const Grid& other,
                     const std::string& other_path) {
  if (grid.size == other.size && disagreement(grid.place, other.place, grid.size) <= kSameGrid) {
    return;
  }
  Place moved = other.place;
  moved.origin = grid.place.origin;
  const bool same_axes = disagreement(grid.place, moved, grid.size) <= kSameGrid;
  std::string what;
  if (same_axes) {
    const Vec3 shift = other.place.origin - grid.place.origin;
    const Vec3 voxels = glm::inverse(grid.place.axes) * shift;
    what = "it is shifted by " + vectorText(shift, 1e3) + " mm (right, front, up), or " +
           vectorText(voxels, 1.0) + " voxels, from " + fileName(path);
    if (grid.size != other.size) {
      what +=
          ", and of " + shapeText(other.size) + " voxels where that has " + shapeText(grid.size);
    }
  } else {
    what = "its voxels lie on another grid than those of " + fileName(path) + ": " +
           gridText(other) + " here, " + gridText(grid) + " there";
  }
  throw inputError("masks.grid", what,
                   "write all masks on one grid (with nearest neighbors), or leave this one out",
                   other_path);
}

/// @throws Error if two masks have one name.
LabelTable tableOf(const std::vector<std::string>& files) {
  LabelTable table;
  std::map<std::string, std::string> known;
  for (std::size_t n = 0; n < files.size(); ++n) {
    const std::string name = maskName(files[n]);
    if (name.empty()) {
      throw inputError(
          "masks.format", "this file is not a mask by its name",
          "masks are NIfTI (.nii .nii.gz), NRRD (.nrrd .nhdr) or MetaImage (.mha .mhd)", files[n]);
    }
    const auto [at, is_new] = known.emplace(name, files[n]);
    if (!is_new) {
      throw inputError("masks.name", "it has the same name as " + at->second + ": '" + name + "'",
                       "give each mask a name of its own", files[n]);
    }
    table.names[static_cast<int>(n) + 1] = name;
  }
  return table;
}

/// Collects notes, so that one shared by many masks appears once.
class MaskNotes {
 public:
  void add(const std::string& path, const std::vector<std::string>& notes) {
    for (const std::string& note : notes) {
      auto& [first, count] = of_[note];
      if (count++ == 0) {
        first = fileName(path);
        order_.push_back(note);
      }
    }
  }
  void tell(std::vector<std::string>& notes) const {
    for (const std::string& note : order_) {
      const auto& [first, count] = of_.at(note);
      notes.push_back(first + (count > 1 ? " and " + std::to_string(count - 1) + " more" : "") +
                      ": " + note);
    }
  }

 private:
  std::map<std::string, std::pair<std::string, std::size_t>> of_;
  std::vector<std::string> order_;
};

Structure structureOf(const Image& image, const std::string& name, int label) {
  Structure out;
  out.name = name;
  out.label = label;
  std::uint64_t first = 0;
  for (std::uint64_t at = 0; at < image.values.size(); ++at) {
    const float value = image.values[at];
    if (value == 0.0F || std::isnan(value)) continue;
    if (out.voxels == 0) first = at;
    if (value != image.values[first]) {
      const auto place = [&](std::uint64_t voxel) {
        const auto nx = static_cast<std::uint64_t>(image.size[0]);
        const auto ny = static_cast<std::uint64_t>(image.size[1]);
        return shortNumber(static_cast<double>(image.values[voxel]), 6) + " at voxel " +
               std::to_string(voxel % nx) + ", " + std::to_string(voxel / nx % ny) + ", " +
               std::to_string(voxel / nx / ny);
      };
      throw inputError("masks.values",
                       "it is not a mask: its values are " + place(first) + " and " + place(at),
                       "a mask has one value besides 0; give an image of several labels alone, and "
                       "keep gray values out of the folder of masks",
                       image.source);
    }
    out.add(at, at + 1);
  }
  return out;
}

}  // namespace

bool isMaskFolder(const std::string& path) { return !maskFiles(path, {}).empty(); }

std::vector<std::string> maskFiles(const std::string& path, const std::vector<std::string>& with) {
  std::vector<std::string> files;
  if (!with.empty()) {
    files = {path};
    files.insert(files.end(), with.begin(), with.end());
    return files;
  }
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(path, failure)) {
    const std::string file = entry.path().string();
    // Files whose name begins with a dot come from a file manager.
    const bool is_hidden = fileName(file).starts_with('.');
    if (!is_hidden && entry.is_regular_file(failure) && !maskName(file).empty()) {
      files.push_back(file);
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

Image readMasks(const std::string& path, const ImageOptions& options) try {
  const std::vector<std::string> files = maskFiles(path, options.with);
  Image image;
  MaskNotes notes;
  std::vector<Structure> structures;
  image.labels = tableOf(files);
  Grid grid;
  for (std::size_t n = 0; n < files.size(); ++n) {
    pollStop();
    const Image mask = readImage(files[n], ofOne(options));
    const Grid here{mask.size, {mask.axes, mask.origin}};
    if (n == 0) grid = here;
    requireSameGrid(grid, files.front(), here, files[n]);
    const int label = static_cast<int>(n) + 1;
    structures.push_back(structureOf(mask, image.labels.names.at(label), label));
    if (mask.labels.colors.size() == 1) {
      image.labels.colors[label] = mask.labels.colors.begin()->second;
    }
    notes.add(files[n], mask.notes);
  }
  LabelTable table = std::move(image.labels);
  image = emptyImage(path, grid.size, grid.place, {});
  image.labels = std::move(table);
  notes.tell(image.notes);
  image.values = mergeStructures(structures, "masks", options.priority, image);
  return image;
} catch (const std::bad_alloc&) {
  throw notEnoughMemory("masks", path);
}

ImageInfo readMasksInfo(const std::string& path, const ImageOptions& options) {
  const std::vector<std::string> files = maskFiles(path, options.with);
  LabelTable table = tableOf(files);
  ImageInfo info;
  MaskNotes notes;
  Grid grid;
  for (std::size_t n = 0; n < files.size(); ++n) {
    pollStop();
    ImageInfo mask = readImageInfo(files[n], ofOne(options));
    const Grid here{mask.size, {mask.axes, mask.origin}};
    if (mask.labels.colors.size() == 1) {
      table.colors[static_cast<int>(n) + 1] = mask.labels.colors.begin()->second;
    }
    notes.add(files[n], mask.notes);
    if (n == 0) {
      grid = here;
      info = std::move(mask);
    }
    requireSameGrid(grid, files.front(), here, files[n]);
  }
  info.notes.clear();
  notes.tell(info.notes);
  info.format = std::to_string(files.size()) + " masks, " + info.format;
  info.labels = std::move(table);
  info.is_labels = true;
  return info;
}

LabelCodes readMaskCodes(const std::string& path, const ImageOptions& options) {
  LabelCodes codes;
  const std::vector<std::string> files = maskFiles(path, options.with);
  for (std::size_t n = 0; n < files.size(); ++n) {
    const LabelCodes of_one = readLabelCodes(files[n], ofOne(options));
    if (of_one.size() == 1) codes[static_cast<int>(n) + 1] = of_one.begin()->second;
  }
  return codes;
}

}  // namespace palpate::vdb
