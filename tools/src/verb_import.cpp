#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <tuple>

#include "import/burr_hole.h"
#include "import/import_report.h"
#include "import/imported_scene.h"
#include "import/kept_layers.h"
#include "import/models.h"
#include "import/needle_way.h"
#include "input_kind.h"
#include "output_files.h"
#include "palpate/vdb/label_codes.h"
#include "palpate/vdb/scan_surface.h"
#include "palpate/vdb/text.h"
#include "scan_options.h"
#include "slicer_markups.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

/// [m] A way keeps 2 mm from bone.
constexpr double kNarrowestHole = 2.0 * kClearance;
constexpr double kWidestHole = 0.06;

void requireImage(const std::string& path, const std::string& what) {
  if (inputKind(path) == InputKind::kImage) return;
  throw inputError("import.kind", "this is not an image",
                   "give " + what +
                       ": .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd, a folder of DICOM files or of "
                       "masks",
                   path);
}

vdb::Image readNoted(const std::string& path, const vdb::ImageOptions& how, Console& console) {
  vdb::Image image = vdb::readImage(path, how);
  for (const std::string& note : image.notes) console.note(path + ": " + note);
  return image;
}

/// The options for the label image; it may have several files, unlike all other images.
vdb::ImageOptions labelOptions(const ImportOptions& options) {
  vdb::ImageOptions how = imageOptions(options.reading);
  how.with.assign(options.scans.begin() + 1, options.scans.end());
  how.priority = options.priority;
  return how;
}

vdb::Image readScan(const std::string& path, const ImportOptions& options, Console& console) {
  requireImage(path, "an image");
  return readNoted(path, imageOptions(options.reading), console);
}

/// `path` relative to the folder of the scene. An absolute path stays absolute, unless it is in
/// that folder or below it, so that the folder can be moved.
std::string seenFrom(const std::string& scene, const std::string& path) {
  if (path.empty()) return path;
  const fs::path folder = fs::absolute(scene).lexically_normal().parent_path();
  const fs::path seen = fs::absolute(path).lexically_normal().lexically_proximate(folder);
  const bool is_beneath = !seen.empty() && *seen.begin() != "..";
  return fs::path(path).is_absolute() && !is_beneath ? path : seen.string();
}

std::vector<std::vector<int>> labelsOf(const RegionPlan& plan) {
  std::vector<std::vector<int>> labels;
  for (const PlannedRegion& region : plan.regions) labels.push_back(region.labels);
  return labels;
}

/// An image for stiffness with unexpected values gets a note, and is not refused: a crop of bone
/// may be bright all over.
void tellOfStiffness(const vdb::Image& image, const vdb::Image& labels,
                     const ImportOptions& options, Console& console) {
  constexpr float kDarkest = -20.0F;  // [HU] fat is darker
  if (std::none_of(image.values.begin(), image.values.end(),
                   [](float value) { return value < kDarkest; })) {
    console.note(options.image +
                 ": no voxel is below -20, as fat and air are in Hounsfield units; is it a CT?");
  }
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int axis = 0; axis < 3; ++axis) {
      const int last = labels.size[static_cast<std::size_t>(axis)] - 1;
      index[axis] = ((corner >> axis) & 1) != 0 ? last : 0;
    }
    const Vec3 at = image.toIndex(labels.toWorld(index));
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] >= -1.0 && at[axis] <= image.size[static_cast<std::size_t>(axis)]) continue;
      console.note(options.image +
                   ": the labels reach beyond it; there, stiffness is that of its border");
      return;
    }
  }
}

/// The voxels of the body; empty if no body is requested. `image`: the one with gray values, or
/// null.
vdb::VoxelMask bodyOf(const ImportOptions& options, const vdb::Image* image, ImportedScan& scan,
                      Console& console) {
  if (!options.body.empty()) {
    const vdb::Image mask = readScan(options.body, options, console);
    scan.image_voxels += mask.values.size();
    for (const auto& [label, voxels] : vdb::countLabels(mask)) {
      if (label != 0) scan.body_labels.push_back(label);
    }
    if (scan.body_labels.empty()) {
      throw inputError("scan.empty", "the mask of the body is 0 everywhere",
                       "give one that is not 0 in the body", options.body);
    }
    return vdb::labelMask(mask, scan.labels);
  }
  if (!options.skin) return {};
  return vdb::bodyMask(*image, *options.skin, scan.labels, console.progress());
}

/// Air that reaches the border of the image is the outside, not a region. With a body, a label of
/// air that has parts inside it (a sinus) stays a region; otherwise these parts would become part
/// of the body's rest.
void leaveOutAir(ImportedScan& scan, Console& console) {
  std::vector<PlannedRegion> kept;
  for (std::size_t r = 0; r < scan.plan.regions.size(); ++r) {
    PlannedRegion& region = scan.plan.regions[r];
    const vdb::LabelSurvey::Region& found = scan.survey.regions[r];
    const bool is_air = region.tissue->kind == TissueClass::kGas && region.tissue->lining.empty();
    if (!is_air || !found.at_border) {
      kept.push_back(std::move(region));
      continue;
    }
    const auto is_enclosed = [](const auto& piece) { return !piece.at_border; };
    if (scan.has_body && std::any_of(found.pieces.begin(), found.pieces.end(), is_enclosed)) {
      console.note(
          "'" + region.name +
          "' holds air both around and inside the body: it becomes a region without walls of "
          "its own, open to outside");
      kept.push_back(std::move(region));
      continue;
    }
    scan.open_air.push_back({region.name, region.labels, region.why, found.voxels, found.volume});
  }
  // If there is nothing but air, keep it.
  if (kept.empty()) {
    scan.open_air.clear();
    return;
  }
  for (const OpenAir& air : scan.open_air) {
    console.note("'" + air.name + "' (" + cubicCentimeters(air.volume) +
                 " cm^3) is air that reaches the image's border: it is outside, and no region");
  }
  scan.plan.regions = std::move(kept);
}

/// A body at another place is a mistake; a body that some labels stick out of gets a note.
void checkBody(const ImportOptions& options, const ImportedScan& scan, Console& console) {
  const vdb::VoxelMask& body = scan.body;
  std::uint64_t labelled = 0;
  std::uint64_t outside = 0;
  std::set<int> around;
  for (const OpenAir& air : scan.open_air) around.insert(air.labels.begin(), air.labels.end());
  for (std::size_t n = 0; n < body.size(); ++n) {
    const float label = scan.labels.values[n];
    if (label == 0.0F || (!around.empty() && around.contains(static_cast<int>(label)))) continue;
    ++labelled;
    outside += body[n] == 0 ? 1U : 0U;
  }
  if (outside == 0) return;
  const std::string& file = options.skin ? options.image : options.body;
  if (outside == labelled) {
    throw inputError("import.body", "no labeled voxel lies in the body: labels and body lie apart",
                     "give the body of the same scan", file);
  }
  console.note(file + ": " + formatCount(outside) + " of " + formatCount(labelled) +
               " labeled voxels are not in the body");
}

/// @throws Error that lists the labels without a tissue.
void refuseUnknown(const ImportOptions& options, const ImportedScan& scan) {
  const double voxel = std::abs(glm::determinant(scan.labels.axes));
  std::string text;
  std::size_t count = 0;
  for (const PlannedRegion& region : scan.plan.regions) {
    if (region.is_known) continue;
    std::uint64_t voxels = 0;
    for (const int label : region.labels) voxels += scan.counts.at(label);
    text += (count++ == 0 ? "" : ", ") + region.name + " (" +
            cubicCentimeters(voxel * static_cast<double>(voxels)) + " cm^3)";
  }
  if (count == 0) return;
  throw inputError("tissues.unmatched", formatCount(count) + " regions fit no tissue: " + text,
                   "give them one: --tissue \"NAME=bone\", or leave out --strict", options.scan());
}

ImportedScan readAll(const ImportOptions& options, const TissueTable& tissues, Console& console) {
  ImportedScan scan;
  LabelNames table;
  if (areModels(options.scans)) {
    scan.is_relabeled = true;
    scan.labels = readModels(options, console);
    table.names = scan.labels.labels.names;
  } else {
    for (const std::string& file : options.scans) requireImage(file, "a label image");
    const vdb::ImageOptions how = labelOptions(options);
    scan.labels = readNoted(options.scan(), how, console);
    table = {
        options.names.empty() ? scan.labels.labels.names : vdb::readLabelTable(options.names).names,
        vdb::readLabelCodes(options.scan(), how)};
  }
  scan.names = table.names;
  report(console.progress(), "labels", 0.0);
  scan.counts = vdb::countLabels(scan.labels);
  scan.plan = planRegions(options, scan.counts, table, tissues);
  if (options.strict) refuseUnknown(options, scan);
  std::optional<vdb::Image> gray;
  if (!options.image.empty()) gray = readScan(options.image, options, console);
  if (options.hounsfield) {
    tellOfStiffness(*gray, scan.labels, options, console);
    scan.ct_voxels = gray->values.size();
  }
  scan.image_voxels = scan.labels.values.size() + (gray ? gray->values.size() : 0);
  scan.body = bodyOf(options, gray ? &*gray : nullptr, scan, console);
  gray.reset();
  scan.has_body = !scan.body.empty();
  const vdb::VoxelMask* const in_body = scan.has_body ? &scan.body : nullptr;
  std::vector<std::vector<int>> labels = labelsOf(scan.plan);
  scan.survey = vdb::surveyLabels(scan.labels, labels, in_body, console.progress());
  leaveOutAir(scan, console);
  checkBody(options, scan, console);
  if (!scan.open_air.empty()) {
    labels = labelsOf(scan.plan);
    scan.survey = vdb::surveyLabels(scan.labels, labels, in_body, console.progress());
  }
  if (options.min_island) {
    scan.changes = vdb::changeIslands(
        scan.labels, labels, scan.survey, static_cast<std::uint64_t>(*options.min_island),
        options.islands == "drop" ? vdb::IslandRule::kDrop : vdb::IslandRule::kMerge);
    if (!scan.changes.empty()) {
      scan.survey = vdb::surveyLabels(scan.labels, labels, in_body, console.progress());
    }
  }
  // Slices are often thicker than their voxels are wide; cubic voxels of the same volume resolve
  // the contents.
  const double same_volume = std::cbrt(std::abs(glm::determinant(scan.labels.axes)));
  scan.voxel = options.voxel.empty()
                   ? std::round(same_volume * 1e5) * 1e-5  // hundredths of a millimeter
                   : parseLength(options.voxel, {}, "--voxel");
  if (!(scan.voxel > 0.0)) {
    throw Error(ErrorKind::kUsage, {"usage.import", "--voxel must be greater than 0", ""});
  }
  return scan;
}

/// Prints one note for all unknown labels; the report lists them.
void tellUnknown(const ImportedScan& scan, Console& console) {
  double volume = 0.0;
  std::size_t count = 0;
  const Tissue* felt_as = nullptr;
  for (std::size_t r = 0; r < scan.plan.regions.size(); ++r) {
    if (scan.plan.regions[r].is_known) continue;
    ++count;
    volume += scan.survey.regions[r].volume;
    felt_as = scan.plan.regions[r].tissue;
  }
  if (count == 0 || scan.names.empty()) return;
  console.note(formatCount(count) + " regions (" + cubicCentimeters(volume) +
               " cm^3) fit no tissue and are felt as " + felt_as->name +
               "; --tissue gives them one, --strict refuses them");
}

/// "a/scan" for "a/scan.yaml".
std::string withoutExtension(const std::string& path) {
  return (fs::path(path).parent_path() / fs::path(path).stem()).string();
}

/// Drills the requested hole along the shortest way through bone. Returns the target with that
/// way's entry.
WayTarget drilled(const ImportOptions& options, const TissueTable& tissues, const WayTarget& target,
                  ImportedScan& scan, Console& console) {
  const double radius = 0.5 * parseLength(options.burr_hole, {}, "--burr-hole");
  const NeedleWay through = needleWay(scan, tissues, target, true);
  scan.burr_hole = drill(scan, tissues, through, target, radius);
  scan.survey = vdb::surveyLabels(scan.labels, labelsOf(scan.plan),
                                  scan.has_body ? &scan.body : nullptr, console.progress());
  WayTarget again = wayTarget(scan, options.to);
  again.place = through.to;
  again.entry = through.entry;
  return again;
}

void checkWay(const ImportOptions& options) {
  for (const auto& [given, name, does] :
       {std::tuple{!options.way.empty(), "--way", "writes the way that --to finds"},
        {!options.burr_hole.empty(), "--burr-hole", "opens bone on the way that --to finds"}}) {
    if (!given || !options.to.empty()) continue;
    throw Error(ErrorKind::kUsage,
                {"usage.import", std::string(name) + " " + does, "give --to TARGET"});
  }
  if (!options.burr_hole.empty()) {
    const double width = parseLength(options.burr_hole, {}, "--burr-hole");
    if (!(width >= kNarrowestHole && width <= kWidestHole)) {
      throw Error(ErrorKind::kUsage, {"usage.import",
                                      "--burr-hole is " + formatNumber(1e3 * width) +
                                          " mm, permitted is from 4 to 60 mm",
                                      "a common burr hole is 14 mm wide"});
    }
  }
  if (!options.way.empty() && !isMarkupsName(options.way)) {
    throw Error(ErrorKind::kUsage,
                {"usage.import", "the way " + options.way + " must end in .mrk.json", ""});
  }
}

}  // namespace

Report run(const ImportOptions& options, const GeneralOptions& general, Console& console) {
  const bool is_written = !options.dry_run;
  const bool is_relabeled =
      options.min_island || !options.burr_hole.empty() || areModels(options.scans);
  checkWay(options);
  OutputFiles files(general);
  const std::string changed_labels = withoutExtension(options.output) + ".labels.nii.gz";
  if (is_written) {
    if (!vdb::hasExtension(options.output, ".yaml") && !vdb::hasExtension(options.output, ".yml")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.import", "the output " + options.output + " must end in .yaml", ""});
    }
    std::vector<std::string> inputs = {options.names, options.image, options.body,
                                       options.materials, options.tissue_file};
    inputs.insert(inputs.end(), options.scans.begin(), options.scans.end());
    files.announce(options.output, inputs);
    if (is_relabeled) files.announce(changed_labels, inputs);
    if (!options.way.empty()) {
      inputs.push_back(options.to);
      files.announce(options.way, inputs);
    }
  }
  const TissueTable tissues =
      options.materials.empty() ? ownTissueTable() : readTissueTable(options.materials);
  ImportedScan scan = readAll(options, tissues, console);
  for (const std::string& note : scan.plan.notes) console.note(note);
  tellUnknown(scan, console);
  if (!scan.has_body) {
    console.note("without --skin or --body, voxels without a label belong to outside");
  }
  std::optional<NeedleWay> way;
  if (!options.to.empty()) {
    report(console.progress(), "way to " + options.to, -1.0);
    WayTarget target = wayTarget(scan, options.to);
    if (!options.burr_hole.empty()) target = drilled(options, tissues, target, scan, console);
    way = needleWay(scan, tissues, target);
    scan.way = suggestedWay(*way);
    if (way->clearance == 0.0) {
      console.note("the way to '" + way->target + "' passes within " +
                   formatNumber(kClearance * 1e3) + " mm of what it must not touch");
    }
  }
  // A dry run may name no output. Its forecast looks for kept grids as a scene here would.
  const std::string output = options.output.empty() ? "scene.yaml" : options.output;
  std::vector<std::string> labels = {vdb::fileName(changed_labels)};
  if (!is_relabeled) {
    labels.clear();
    for (const std::string& file : options.scans) labels.push_back(seenFrom(output, file));
  }
  // The table of names for models has numbers of files, not of labels.
  const std::string names = scan.is_relabeled ? "" : options.names;
  const SceneFiles seen = {labels, seenFrom(output, names),
                           seenFrom(output, options.skin ? options.image : options.body),
                           seenFrom(output, options.image)};
  const std::string text = writeScene(options, scan, tissues, seen);
  std::vector<std::string> written;
  if (is_written) {
    files.write(output, text);
    written.push_back(output);
    if (is_relabeled) {
      report(console.progress(), "write labels", -1.0);
      files.write(changed_labels, vdb::encodeLabels(scan.labels, true));
      written.push_back(changed_labels);
    }
    if (way && !options.way.empty()) {
      files.write(options.way, wayMarkups(*way));
      written.push_back(options.way);
    }
    checkStop();
    files.commit();
  }
  return importReport(options, scan, tissues, way ? &*way : nullptr, written,
                      keptLayers(text, output));
}

}  // namespace palpate::tools
