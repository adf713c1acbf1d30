#include "import/imported_scene.h"

#include <algorithm>
#include <cmath>

#include "import/crossings.h"
#include "import/suggested_way.h"
#include "palpate/core/error.h"
#include "palpate/vdb/text.h"
#include "report.h"
#include "scene_text.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// [voxels] of the band on each side of a surface, the default of scenes.
constexpr double kHalfWidth = 6.0;
// Measured on a pelvis of 28 labels and on five other scans, as the largest memory of `palpate
// touch` at any time: all were within a tenth of this estimate.
constexpr double kBytesOfCommand = 75e6;
constexpr double kBytesPerVoxel = 105.0;     // active voxels of the grids: labels, grid and bricks
constexpr double kBytesPerImageVoxel = 4.0;  // while images are read
/// 16 bits, in blocks of 8^3 with a border; blocks of one value are not stored.
constexpr double kBytesPerMapVoxel = 2.0 * (10.0 * 10.0 * 10.0) / (8.0 * 8.0 * 8.0);
// [s] of processor time, measured on three scans by tests/bench/forecasts.py.
constexpr double kSecondsOfCommand = 0.1;
constexpr double kSecondsPerGrid = 0.022;       // to find how it lies to the other grids
constexpr double kSecondsPerVoxel = 0.15e-6;    // active voxels: to read them and make bricks
constexpr double kSecondsPerVoxelMade = 12e-6;  // to bake, certify and keep them

/// A key or plain name, quoted only if it must be.
std::string word(const std::string& text) {
  const auto is_safe = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const bool starts_well = !text.empty() && !(text[0] >= '0' && text[0] <= '9');
  return starts_well && text != "true" && text != "false" && text != "null" &&
                 std::all_of(text.begin(), text.end(), is_safe)
             ? text
             : sceneWord(text);
}

std::string millimeters(double meters, int digits = 4) {
  return formatNumber(meters * 1e3, digits);
}

class SceneWriter {
 public:
  SceneWriter(const ImportOptions& options, const ImportedScan& scan, const TissueTable& tissues,
              const SceneFiles& files)
      : options_(options),
        scan_(scan),
        tissues_(tissues),
        files_(files),
        crossings_(crossings(scan, tissues)) {}

  std::string write() {
    header();
    images();
    materials();
    layers();
    walls();
    ports();
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + "\n"; }

  void header() {
    const vdb::Image& image = scan_.labels;
    const std::size_t more = options_.scans.size() - 1;
    line("# Made by `palpate import` from " + options_.scan() +
         (more > 0 ? " and " + std::to_string(more) + " more" : "") + ": " +
         std::to_string(image.size[0]) + " x " + std::to_string(image.size[1]) + " x " +
         std::to_string(image.size[2]) + " voxels of " + millimeters(glm::length(image.axes[0])) +
         " x " + millimeters(glm::length(image.axes[1])) + " x " +
         millimeters(glm::length(image.axes[2])) + " mm.");
    line(
        "# It is yours to edit. Lengths are in mm, in the scan's axes "
        "(RAS): x right, y front, z head.");
    const auto point = [](const Vec3& p) {
      return formatNumber(p.x * 1e3) + "," + formatNumber(p.y * 1e3) + "," +
             formatNumber(p.z * 1e3);
    };
    const SuggestedWay way = scan_.way ? *scan_.way : suggestedWay(scan_);
    line("# A probe " + way.what + ", and back:");
    line("#   palpate touch SCENE.yaml --insert " + point(way.from) + " " + point(way.to) +
         " --back --image SCENE.png");
    for (const OpenAir& air : scan_.open_air) {
      line("# " + air.name + " (" + cubicCentimeters(air.volume) +
           " cm^3) is air that reaches the image's border: it is outside, and no layer.");
    }
    if (!scan_.changes.empty()) {
      line("# " + std::to_string(scan_.changes.size()) + " pieces and cavities of less than " +
           std::to_string(*options_.min_island) + " voxels were changed; " + files_.labels.front() +
           " is what came of it.");
    }
    if (scan_.burr_hole) {
      const BurrHole& hole = *scan_.burr_hole;
      line("# A burr hole of " + millimeters(2.0 * hole.radius) + " mm was asked for, from " +
           point(hole.outer) + " to " + point(hole.inner) + " through " + hole.through + "; " +
           files_.labels.front() + " has it.");
    }
    line("palpate: 1");
    line("length: mm");
    // Deep in bone, a wall asks for far more force than any device has, and than a hand should get.
    line(
        "force: {max: 7.9 N, slew: 2000 N/s}  # the most that a Touch X exerts; 2 N more in a "
        "millisecond");
  }

  /// The user's choices where the scan leaves something open. Images that this code writes need no
  /// choices.
  [[nodiscard]] std::string reading() const {
    const ScanOptions& o = options_.reading;
    std::string keys;
    if (!o.affine.empty()) keys += ", affine: " + o.affine;
    if (!o.space.empty()) keys += ", space: " + o.space;
    if (o.frame) keys += ", frame: " + std::to_string(*o.frame);
    if (!o.series.empty()) keys += ", series: " + sceneWord(o.series);
    if (o.resample) keys += ", resample: true";
    return keys;
  }

  void images() {
    line("images:");
    std::string labels = sceneWord(files_.labels.front());
    if (files_.labels.size() > 1) {
      labels += ", with: [";
      for (std::size_t n = 1; n < files_.labels.size(); ++n) {
        labels += (n > 1 ? ", " : "") + sceneWord(files_.labels[n]);
      }
      labels += "]";
    }
    if (!options_.priority.empty() && !scan_.isChanged(options_)) {
      labels += ", priority: [";
      for (std::size_t n = 0; n < options_.priority.size(); ++n) {
        labels += (n > 0 ? ", " : "") + sceneWord(options_.priority[n]);
      }
      labels += "]";
    }
    line("  labels: {file: " + labels +
         (files_.names.empty() ? "" : ", names: " + sceneWord(files_.names)) +
         (scan_.isChanged(options_) ? "" : reading()) + "}");
    if (!files_.body.empty()) line("  body: {file: " + sceneWord(files_.body) + reading() + "}");
    if (options_.hounsfield && !options_.skin) {
      line("  ct: {file: " + sceneWord(files_.image) + reading() + "}");
    }
  }

  [[nodiscard]] bool isMapped(const Tissue& tissue) const {
    return options_.hounsfield && tissue.stiffness_of_ct && tissue.hasWall();
  }

  void number(const char* what, const std::optional<SourcedNumber>& n) {
    if (!n) return;
    line("  #   " + std::string(what) + " " + n->text + ": " + basisName(n->basis) + ": " +
         n->source);
  }

  void materials() {
    const std::vector<const Tissue*> used = tissuesOf(scan_, tissues_);
    line(
        "# measured: the source measured it. derived: computed from what was, as said. assumed: "
        "chosen, for the reason given.");
    line("materials:");
    const bool has_shaft =
        std::any_of(used.begin(), used.end(), [](const Tissue* t) { return t->shaft.has_value(); });
    if (has_shaft) {
      line("  # of every needle's shaft");
      number("spring while it sticks", tissues_.shaft_spring);
      number("Young's modulus E_n", tissues_.shaft_young);
    }
    for (const Tissue* tissue : used) {
      if (!tissue->hasWall() && !tissue->hasContent()) continue;  // air
      const SourcedNumber stiffness =
          tissue->hasWall() ? tissues_.wallStiffness(*tissue) : SourcedNumber{};
      line("  # " + tissue->name);
      if (!tissue->hasWall()) {
        // A fluid is felt as drag only.
      } else if (isMapped(*tissue)) {
        const SourcedTransfer& of_ct = *tissue->stiffness_of_ct;
        line("  #   stiffness by CT number " + of_ct.text + ": " + basisName(of_ct.basis) + ": " +
             of_ct.source);
      } else {
        number("stiffness", stiffness);
      }
      number("damping", tissue->damping);
      number("friction", tissue->friction);
      number("viscosity", tissue->viscosity);
      number("cutting", tissue->cutting);
      number("shaft, sliding,", tissue->shaft);
      number("shaft, sticking,", tissue->shaft_static);
      const std::optional<TissueTable::Lateral> lateral = tissues_.lateral(*tissue);
      if (lateral) {
        number("shaft, sideways,", lateral->stiffness);
        number("and it tears at", lateral->strength);
      }
      std::string entry;
      if (tissue->hasWall()) {
        entry = ", stiffness: " + (isMapped(*tissue)
                                       ? std::string("{image: ") + (options_.skin ? "body" : "ct") +
                                             ", transfer: " + tissue->stiffness_of_ct->text + "}"
                                       : stiffness.text);
      }
      if (tissue->damping) entry += ", damping: " + tissue->damping->text;
      if (tissue->friction) {
        entry += ", friction: {static: " + tissue->friction->text +
                 ", kinetic: " + tissue->friction->text + "}";
      }
      if (tissue->viscosity) entry += ", viscosity: " + tissue->viscosity->text;
      if (tissue->cutting) entry += ", cutting: " + tissue->cutting->text;
      if (tissue->shaft) {
        const SourcedNumber& stick = tissue->shaft_static ? *tissue->shaft_static : *tissue->shaft;
        entry += ", shaft: {stiffness: " + tissues_.shaft_spring->text +
                 ", in: {static: " + stick.text + ", kinetic: " + tissue->shaft->text + "}";
        if (lateral) {
          entry += ", lateral: {stiffness: " + lateral->stiffness.text +
                   ", strength: " + lateral->strength.text + "}";
        }
        entry += "}";
      }
      line("  " + word(tissue->name) + ": {" + entry.substr(2) + "}");
    }
  }

  [[nodiscard]] std::string about(std::size_t r) const {
    const vdb::LabelSurvey::Region& region = scan_.survey.regions[r];
    std::string text = cubicCentimeters(region.volume) + " cm^3";
    if (region.pieces.size() > 1) text += " in " + std::to_string(region.pieces.size()) + " pieces";
    if (region.within) text += ", within " + scan_.nameOf(*region.within);
    std::string touches;
    for (const auto& [name, share] : scan_.neighborsOf(r)) {
      if (share < 0.1) break;
      touches += (touches.empty() ? "; touches " : ", ") + name + " (" +
                 std::to_string(std::lround(100.0 * share)) + " %)";
    }
    return text + touches;
  }

  void layers() {
    const std::string voxel = ", voxel: " + millimeters(scan_.voxel);
    line("layers:   # where two overlap the later one wins, and has the wall");
    if (scan_.has_body) {
      line("  # what in the body has no label: " + about(scan_.survey.gap()));
      const std::string from =
          options_.skin ? "threshold: {image: body, above: " + formatNumber(*options_.skin, 9) +
                              ", keep: largest, fill: true" + voxel + "}"
                        : "labels: {image: body, match: [" + vdb::listOf(scan_.body_labels) + "]" +
                              voxel + "}";
      line("  - {name: " + std::string(kGapName) + ", " + from +
           ", wall: " + word(requireTissue(tissues_, "skin").name) +
           ", content: " + word(requireTissue(tissues_, "fat").name) + "}");
    }
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const PlannedRegion& region = scan_.plan.regions[r];
      line("  # " + (region.is_known ? region.tissue->name : "fits no tissue") + " (" + region.why +
           "): " + about(r));
      line("  - {name: " + word(region.name) + ", labels: {image: labels, match: [" +
           vdb::listOf(region.labels) + "]" + voxel +
           "}, wall: " + (region.tissue->hasWall() ? word(region.tissue->name) : "absent") +
           (region.tissue->hasContent() ? ", content: " + word(region.tissue->name) : "") + "}");
    }
  }

  /// One region, or a list of them.
  [[nodiscard]] std::string regionList(const std::vector<std::size_t>& regions) const {
    std::string text;
    for (const std::size_t one : regions) {
      text += (text.empty() ? "" : ", ") + word(scan_.nameOf(one));
    }
    return regions.size() > 1 ? "[" + text + "]" : text;
  }

  void walls() {
    if (crossings_.walls.empty()) return;
    line(
        "walls:   # in place of the later layer's own: none between parcels of one tissue, of a "
        "fluid what it lies in or its lining");
    for (const WallBetween& one : crossings_.walls) {
      line("  - {between: [" + regionList(one.outer) + ", " + regionList(one.inner) +
           "], wall: " + (one.wall != nullptr ? word(one.wall->name) : "absent") + "}");
    }
  }

  void ports() {
    if (crossings_.ports.empty()) return;
    line(
        "ports:   # `opens_at` from the first to the second, `back` from the second to the first, "
        "`hole`: either way where one is");
    // The tip finds a hole of its own size if it overlaps the hole.
    const std::string hole_at =
        ", hole: {radius: " + millimeters(2.0 * tissues_.tip_radius.value) + " mm, reopens_at: ";
    std::vector<const SourcedNumber*> told;
    for (const Passage& port : crossings_.ports) {
      for (const TissueForce* one : {&port.in, &port.out, &port.reopens}) {
        if (one->force == nullptr ||
            std::find(told.begin(), told.end(), one->force) != told.end()) {
          continue;
        }
        told.push_back(one->force);
        number((one->of->name + ", " + one->what).c_str(), *one->force);
      }
      const bool has_hole = port.reopens.force != nullptr;
      line("  - {name: " + sceneWord(port.name) + ", between: [" + regionList(port.outer) + ", " +
           regionList(port.inner) + "], opens_at: " + port.in.text() +
           (has_hole || port.out.text() != port.in.text() ? ", back: " + port.out.text() : "") +
           (has_hole ? hole_at + port.reopens.text() + "}" : "") + "}");
    }
  }

  const ImportOptions& options_;
  const ImportedScan& scan_;
  const TissueTable& tissues_;
  const SceneFiles& files_;
  Crossings crossings_;
  std::string text_;
};

}  // namespace

std::string cubicCentimeters(double volume) {
  const double value = volume * 1e6;
  return value < 1000.0 ? formatNumber(value, 3) : formatCount(std::llround(value));
}

std::string ImportedScan::nameOf(std::size_t region) const {
  if (region == survey.outside()) return "outside";
  return region == survey.gap() ? kGapName : plan.regions[region].name;
}

std::vector<std::pair<std::string, double>> ImportedScan::neighborsOf(std::size_t region) const {
  const vdb::LabelSurvey::Region& of = survey.regions[region];
  std::vector<std::pair<std::string, double>> shares;
  for (const vdb::LabelSurvey::Contact& contact : of.contacts) {
    const double area = contact.area - (contact.other == survey.outside() ? of.border : 0.0);
    if (area > 1e-9 * contact.area) shares.emplace_back(nameOf(contact.other), area / of.area);
  }
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return shares;
}

double estimateVoxels(double area, double volume, double voxel) {
  // A thin part has fewer voxels inside than the inner half of the band would need.
  const double side = kHalfWidth * area / (voxel * voxel);
  return side + std::min(side, volume / (voxel * voxel * voxel));
}

double estimateSeconds(std::size_t grids, double active_voxels, double to_make) {
  return kSecondsOfCommand + kSecondsPerGrid * static_cast<double>(grids) +
         kSecondsPerVoxel * active_voxels + kSecondsPerVoxelMade * to_make;
}

const Tissue& requireTissue(const TissueTable& tissues, const std::string& name) {
  const Tissue* found = tissues.find(name);
  if (found == nullptr) {
    throw inputError("tissues.missing",
                     "the table has no tissue '" + name + "', which the body needs",
                     "add it, or leave out --skin and --body", tissues.file);
  }
  return *found;
}

std::vector<const Tissue*> tissuesOf(const ImportedScan& scan, const TissueTable& tissues) {
  std::vector<const Tissue*> used;
  const auto use = [&](const Tissue* tissue) {
    if (std::find(used.begin(), used.end(), tissue) == used.end()) used.push_back(tissue);
  };
  if (scan.has_body) {
    use(&requireTissue(tissues, "skin"));
    use(&requireTissue(tissues, "fat"));
  }
  for (const PlannedRegion& region : scan.plan.regions) use(region.tissue);
  for (const PlannedRegion& region : scan.plan.regions) {
    if (!region.tissue->lining.empty()) use(tissues.find(region.tissue->lining));
  }
  return used;
}

double estimateMemory(const ImportedScan& scan, const TissueTable& tissues, double active_voxels) {
  double maps = 0.0;
  for (const Tissue* tissue : tissuesOf(scan, tissues)) {
    if (tissue->stiffness_of_ct) maps += static_cast<double>(scan.ct_voxels);
  }
  return kBytesOfCommand + kBytesPerVoxel * active_voxels +
         kBytesPerImageVoxel * static_cast<double>(scan.image_voxels) + kBytesPerMapVoxel * maps;
}

std::string writeScene(const ImportOptions& options, const ImportedScan& scan,
                       const TissueTable& tissues, const SceneFiles& files) {
  return SceneWriter(options, scan, tissues, files).write();
}

}  // namespace palpate::tools
