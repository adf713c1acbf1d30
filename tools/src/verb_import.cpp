#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "import/imported_scene.h"
#include "input_kind.h"
#include "json_parts.h"
#include "output_files.h"
#include "palpate/vdb/scan_surface.h"
#include "scan_options.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTold = 12;
constexpr double kIslandShare = 0.1;  // of a region's largest piece

vdb::Image readScan(const std::string& path, const ImportOptions& options, Console& console) {
  if (inputKind(path) != InputKind::kImage) {
    throw inputError("import.kind", "this is no image",
                     std::string("give ") + (path == options.scan ? "a label image" : "an image") +
                         ": .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or a folder of DICOM files",
                     path);
  }
  vdb::Image image = vdb::readImage(path, imageOptions(options.reading));
  for (const std::string& note : image.notes) console.note(path + ": " + note);
  return image;
}

/// `path`, as seen from the folder of the scene.
std::string seenFrom(const std::string& scene, const std::string& path) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return fs::absolute(path).lexically_normal().lexically_proximate(
      fs::absolute(scene).lexically_normal().parent_path());
}

std::vector<std::vector<int>> labelsOf(const RegionPlan& plan) {
  std::vector<std::vector<int>> labels;
  for (const PlannedRegion& region : plan.regions) labels.push_back(region.labels);
  return labels;
}

/// Stiffness from an image that does not hold what it should is told, not refused: a crop of bone may be
/// bright all over.
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

/// Empty if none is asked for. `image`: the one with grey values, or null.
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

/// A body that lies elsewhere is a mistake; one that some labels stick out of is told of.
void checkBody(const ImportOptions& options, const vdb::Image& labels, const vdb::VoxelMask& body,
               Console& console) {
  std::uint64_t labelled = 0;
  std::uint64_t outside = 0;
  for (std::size_t n = 0; n < body.size(); ++n) {
    if (labels.values[n] == 0.0F) continue;
    ++labelled;
    outside += body[n] == 0 ? 1U : 0U;
  }
  if (outside == 0) return;
  const std::string& file = options.skin ? options.image : options.body;
  if (outside == labelled) {
    throw inputError("import.body", "no labelled voxel is in the body: the two lie apart",
                     "give the body of the same scan", file);
  }
  console.note(file + ": " + formatCount(outside) + " of " + formatCount(labelled) +
               " labelled voxels are not in the body");
}

ImportedScan readAll(const ImportOptions& options, const TissueTable& tissues, Console& console) {
  ImportedScan scan;
  scan.labels = readScan(options.scan, options, console);
  const vdb::NameTable names =
      options.names.empty() ? scan.labels.labels.names : vdb::readLabelTable(options.names).names;
  report(console.progress(), "labels", 0.0);
  scan.plan = planRegions(options, vdb::countLabels(scan.labels), names, tissues);
  std::optional<vdb::Image> grey;
  if (!options.image.empty()) grey = readScan(options.image, options, console);
  if (options.hounsfield) {
    tellOfStiffness(*grey, scan.labels, options, console);
    scan.ct_voxels = grey->values.size();
  }
  scan.image_voxels = scan.labels.values.size() + (grey ? grey->values.size() : 0);
  const vdb::VoxelMask body = bodyOf(options, grey ? &*grey : nullptr, scan, console);
  grey.reset();
  checkBody(options, scan.labels, body, console);
  scan.has_body = !body.empty();
  const std::vector<std::vector<int>> labels = labelsOf(scan.plan);
  const vdb::VoxelMask* const in_body = scan.has_body ? &body : nullptr;
  scan.survey = vdb::surveyLabels(scan.labels, labels, in_body, console.progress());
  if (options.min_island) {
    scan.changes = vdb::changeIslands(
        scan.labels, labels, scan.survey, static_cast<std::uint64_t>(*options.min_island),
        options.islands == "drop" ? vdb::IslandRule::kDrop : vdb::IslandRule::kMerge);
    if (!scan.changes.empty()) {
      scan.survey = vdb::surveyLabels(scan.labels, labels, in_body, console.progress());
    }
  }
  // Slices are often thicker than their voxels are wide; a grid of the same volume holds what is there.
  const double same_volume = std::cbrt(std::abs(glm::determinant(scan.labels.axes)));
  scan.voxel = options.voxel.empty()
                   ? std::round(same_volume * 1e5) * 1e-5  // hundredths of a millimetre
                   : parseLength(options.voxel, {}, "--voxel");
  if (!(scan.voxel > 0.0)) {
    throw Error(ErrorKind::kUsage, {"usage.import", "--voxel must be greater than 0", ""});
  }
  return scan;
}

std::string labelList(const std::vector<int>& labels) {
  std::string text;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::size_t last = i;
    while (last + 1 < labels.size() && labels[last + 1] == labels[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(labels[i]);
    if (last > i) text += (last > i + 1 ? "-" : ",") + std::to_string(labels[last]);
    i = last;
  }
  return text;
}

class ImportReport {
 public:
  ImportReport(const ImportOptions& options, const ImportedScan& scan, const TissueTable& tissues)
      : options_(options), scan_(scan), tissues_(tissues) {}

  Report make(const std::vector<std::string>& written) {
    const vdb::Image& image = scan_.labels;
    report_.json = {{"schema", "palpate.import/1"},
                    {"scan", options_.scan},
                    {"output", written.empty() ? Json() : Json(written.front())},
                    {"size", image.size},
                    {"voxel_size_m", scan_.voxel}};
    regions();
    changes();
    islands();
    cost();
    const auto ports = passages(scan_, tissues_).size();
    report_.json["ports"] = ports;
    report_.text += formatCount(ports) + " ports into regions from what touches them\n";
    if (written.empty()) {
      report_.text += "Nothing was written (--dry-run)\n";
    } else {
      std::string names;
      for (const std::string& file : written) names += (names.empty() ? "" : " and ") + file;
      report_.text += "Wrote " + names + "\n";
    }
    return std::move(report_);
  }

 private:
  void regions() {
    Table table({"region", "labels", "tissue", "voxels", "cm^3", "pieces", "within", "touches"});
    Json json = Json::array();
    const auto add = [&](std::size_t r, const std::string& labels, const std::string& tissue) {
      const vdb::LabelSurvey::Region& region = scan_.survey.regions[r];
      const auto shares = scan_.neighborsOf(r);
      std::string touches;
      Json contacts = Json::array();
      for (std::size_t c = 0; c < shares.size(); ++c) {
        const auto& [other, share] = shares[c];
        contacts.push_back({{"region", other}, {"share", share}});
        if (c < 2) {
          touches += (touches.empty() ? "" : ", ") + other + " " +
                     std::to_string(std::lround(100.0 * share)) + " %";
        }
      }
      if (shares.size() > 2) touches += ", " + std::to_string(shares.size() - 2) + " more";
      table.add({scan_.nameOf(r), labels, tissue, formatCount(region.voxels),
                 cubicCentimetres(region.volume), formatCount(region.pieces.size()),
                 region.within ? scan_.nameOf(*region.within) : "-", touches});
      json.push_back({{"name", scan_.nameOf(r)},
                      {"tissue", tissue},
                      {"voxels", region.voxels},
                      {"volume_m3", region.volume},
                      {"pieces", region.pieces.size()},
                      {"within", region.within ? Json(scan_.nameOf(*region.within)) : Json()},
                      {"touches", contacts},
                      {"border_share", region.border / region.area},
                      {"bounds_m", boxJson(region.bounds)}});
      if (r < scan_.plan.regions.size()) json.back()["labels"] = scan_.plan.regions[r].labels;
    };
    if (scan_.has_body) add(scan_.survey.gap(), "-", "skin, fat");
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const PlannedRegion& region = scan_.plan.regions[r];
      add(r, labelList(region.labels), region.tissue->name);
    }
    report_.json["regions"] = json;
    report_.text += table.text("") + "\n";
  }

  [[nodiscard]] static std::string placeText(const Vec3& place) {
    return formatVector(place * 1e3) + " mm";
  }

  /// Pieces far smaller than the largest of their region, and cavities, with their places.
  void islands() {
    Json found = Json::array();
    std::size_t count = 0;
    std::string text;
    const auto add = [&](const std::string& what, const vdb::LabelSurvey::Piece& piece) {
      const std::string around = scan_.nameOf(piece.around);
      found.push_back({{"region", what},
                       {"voxels", piece.voxels},
                       {"around", around},
                       {"place_m", vectorJson(piece.place)}});
      if (count++ >= kMostTold) return;
      text += "  " + what + ": " + formatCount(piece.voxels) + " at " + placeText(piece.place) +
              ", in " + around + "\n";
    };
    for (std::size_t r = 0; r <= scan_.survey.gap(); ++r) {
      for (const auto& piece : scan_.survey.regions[r].pieces) {
        if (static_cast<double>(piece.voxels) <
            kIslandShare * static_cast<double>(scan_.survey.regions[r].pieces.front().voxels)) {
          add(scan_.nameOf(r), piece);
        }
      }
    }
    for (const auto& piece : scan_.survey.regions[scan_.survey.outside()].pieces) {
      if (!piece.at_border) add("outside", piece);
    }
    report_.json["islands"] = std::move(found);
    if (count == 0) return;
    report_.text += formatCount(count) +
                    " islands (pieces of less than a tenth of their region's "
                    "largest) and cavities are left" +
                    (options_.min_island ? "" : "; --min-island changes small ones") +
                    ". Voxels of each:\n" + text;
    if (count > kMostTold) report_.text += "  and " + formatCount(count - kMostTold) + " more\n";
  }

  void changes() {
    Json changed = Json::array();
    std::string text;
    for (const vdb::IslandChange& change : scan_.changes) {
      const std::string to =
          change.to >= scan_.survey.gap() ? "unlabelled" : scan_.nameOf(change.to);
      if (changed.size() < kMostTold) {
        text += "  " + scan_.nameOf(change.from) + ": " + formatCount(change.voxels) + " at " +
                placeText(change.place) + " became " + to + "\n";
      }
      changed.push_back({{"from", scan_.nameOf(change.from)},
                         {"to", to},
                         {"voxels", change.voxels},
                         {"place_m", vectorJson(change.place)}});
    }
    const std::size_t count = scan_.changes.size();
    report_.json["changed"] = std::move(changed);
    if (count == 0) return;
    report_.text +=
        formatCount(count) + " islands and cavities were changed. Voxels of each:\n" + text;
    if (count > kMostTold) report_.text += "  and " + formatCount(count - kMostTold) + " more\n";
  }

  void cost() {
    GridEstimate sum;
    const auto add = [&](double area, double volume) {
      const GridEstimate one = estimateGrid(area, volume, scan_.voxel);
      sum.active_voxels += one.active_voxels;
      sum.seconds += one.seconds;
    };
    double body = scan_.survey.regions[scan_.survey.gap()].volume;
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const vdb::LabelSurvey::Region& region = scan_.survey.regions[r];
      add(region.area, region.volume);
      body += region.volume;
    }
    // The body's surface is that of the outside, borders and all.
    if (scan_.has_body) add(scan_.survey.regions[scan_.survey.outside()].area, body);
    const double memory = estimateMemory(scan_, tissues_, sum.active_voxels);
    report_.json["estimate"] = {{"active_voxels", std::llround(sum.active_voxels)},
                                {"memory_bytes", std::llround(memory)},
                                {"seconds", sum.seconds}};
    const std::size_t grids = scan_.plan.regions.size() + (scan_.has_body ? 1 : 0);
    report_.text +=
        formatCount(grids) + " grids with voxels of " + formatNumber(scan_.voxel * 1e3, 3) +
        " mm: about " + formatCount(static_cast<std::uint64_t>(std::llround(sum.active_voxels))) +
        " active voxels; to touch them takes " + formatBytes(static_cast<std::uint64_t>(memory)) +
        " and " + formatSeconds(sum.seconds) + " on two cores (estimated from surface areas)\n";
  }

  const ImportOptions& options_;
  const ImportedScan& scan_;
  const TissueTable& tissues_;
  Report report_;
};

/// "a/scan" for "a/scan.yaml".
std::string withoutExtension(const std::string& path) {
  return (fs::path(path).parent_path() / fs::path(path).stem()).string();
}

}  // namespace

Report run(const ImportOptions& options, const GeneralOptions& general, Console& console) {
  const bool is_written = !options.dry_run;
  OutputFiles files(general.force);
  const std::string changed_labels = withoutExtension(options.output) + ".labels.nii.gz";
  if (is_written) {
    if (!hasExtension(options.output, ".yaml") && !hasExtension(options.output, ".yml")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.import", "the output " + options.output + " must end in .yaml", ""});
    }
    const std::vector<std::string> inputs = {options.scan, options.names, options.image,
                                             options.body, options.materials};
    files.announce(options.output, inputs);
    if (options.min_island) files.announce(changed_labels, inputs);
  }
  const TissueTable tissues =
      options.materials.empty() ? ownTissueTable() : readTissueTable(options.materials);
  ImportedScan scan = readAll(options, tissues, console);
  for (const std::string& note : scan.plan.notes) console.note(note);
  if (!scan.has_body) {
    console.note("no --skin and no --body: what has no label is outside");
  }
  std::vector<std::string> written;
  if (is_written) {
    const bool is_changed = options.min_island.has_value();
    const std::string output = options.output;
    const SceneFiles seen = {
        is_changed ? fs::path(changed_labels).filename().string() : seenFrom(output, options.scan),
        seenFrom(output, options.names),
        seenFrom(output, options.skin ? options.image : options.body),
        seenFrom(output, options.image)};
    files.write(output, writeScene(options, scan, tissues, seen));
    written.push_back(output);
    if (is_changed) {
      report(console.progress(), "write labels", -1.0);
      files.write(changed_labels, vdb::encodeLabels(scan.labels, true));
      written.push_back(changed_labels);
    }
    checkStop();
    files.commit();
  }
  return ImportReport(options, scan, tissues).make(written);
}

}  // namespace palpate::tools
