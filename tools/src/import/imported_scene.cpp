#include "import/imported_scene.h"

#include <algorithm>
#include <cmath>

#include "palpate/core/error.h"
#include "palpate/vdb/text.h"
#include "report.h"
#include "scene_text.h"
#include "text.h"

namespace palpate::tools {
namespace {

/// [voxels] on each side of a surface, as scenes have it.
constexpr double kHalfWidth = 6.0;
// Measured on a pelvis of 28 labels and five other scans, as the most that `palpate touch` had at a time: all were within a tenth
// of this.
constexpr double kBytesOfCommand = 75e6;
constexpr double kBytesPerVoxel = 105.0;     // active, of the grids: labels, grid and bricks
constexpr double kBytesPerImageVoxel = 4.0;  // as they are read
/// 16 bits in blocks of 8^3 with a rim; those of one value are not stored.
constexpr double kBytesPerMapVoxel = 2.0 * (10.0 * 10.0 * 10.0) / (8.0 * 8.0 * 8.0);
// With two cores.
constexpr double kSecondsPerVoxel = 5e-6;

/// As a key or a plain name, quoted only where it must be.
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

std::string millimetres(double metres, int digits = 4) {
  return formatNumber(metres * 1e3, digits);
}

class SceneWriter {
 public:
  SceneWriter(const ImportOptions& options, const ImportedScan& scan, const TissueTable& tissues,
              const SceneFiles& files)
      : options_(options), scan_(scan), tissues_(tissues), files_(files) {}

  std::string write() {
    header();
    images();
    materials();
    layers();
    ports();
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + "\n"; }

  void header() {
    const vdb::Image& image = scan_.labels;
    line("# Made by `palpate import` from " + options_.scan + ": " + std::to_string(image.size[0]) +
         " x " + std::to_string(image.size[1]) + " x " + std::to_string(image.size[2]) +
         " voxels of " + millimetres(glm::length(image.axes[0])) + " x " +
         millimetres(glm::length(image.axes[1])) + " x " + millimetres(glm::length(image.axes[2])) +
         " mm.");
    line(
        "# It is yours to edit. Lengths are in mm, in the scan's axes "
        "(RAS): x right, y front, z head.");
    Box3 box;
    for (std::size_t r = 0; r < scan_.survey.outside(); ++r) {
      const Box3& bounds = scan_.survey.regions[r].bounds;
      if (bounds.isEmpty()) continue;
      box.include(bounds.lo);
      box.include(bounds.hi);
    }
    const Vec3 middle = box.center() * 1e3;
    const auto point = [](const Vec3& p) {
      return formatNumber(std::round(p.x)) + "," + formatNumber(std::round(p.y)) + "," +
             formatNumber(std::round(p.z));
    };
    line("# A probe from the front to the middle, and back:");
    line("#   palpate touch SCENE.yaml --insert " +
         point(Vec3(middle.x, box.hi.y * 1e3 + 20.0, middle.z)) + " " + point(middle) +
         " --back --image SCENE.png");
    if (!scan_.changes.empty()) {
      line("# " + std::to_string(scan_.changes.size()) + " pieces and cavities of less than " +
           std::to_string(*options_.min_island) + " voxels were changed; " + files_.labels +
           " is what came of it.");
    }
    line("palpate: 1");
    line("length: mm");
  }

  /// What was asked for where the scan leaves something open; images that are written here leave nothing open.
  [[nodiscard]] std::string reading() const {
    const ScanOptions& o = options_.reading;
    std::string keys;
    if (!o.affine.empty()) keys += ", affine: " + o.affine;
    if (!o.space.empty()) keys += ", space: " + o.space;
    if (o.frame) keys += ", frame: " + std::to_string(*o.frame);
    if (!o.series.empty()) keys += ", series: " + sceneWord(o.series);
    return keys;
  }

  void images() {
    line("images:");
    line("  labels: {file: " + sceneWord(files_.labels) +
         (files_.names.empty() ? "" : ", names: " + sceneWord(files_.names)) +
         (options_.min_island ? "" : reading()) + "}");
    if (!files_.body.empty()) line("  body: {file: " + sceneWord(files_.body) + reading() + "}");
    if (options_.hounsfield && !options_.skin) {
      line("  ct: {file: " + sceneWord(files_.image) + reading() + "}");
    }
  }

  [[nodiscard]] bool isMapped(const Tissue& tissue) const {
    return options_.hounsfield && tissue.stiffness_of_ct;
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
      const SourcedNumber stiffness = tissues_.wallStiffness(*tissue);
      line("  # " + tissue->name);
      if (isMapped(*tissue)) {
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
      std::string entry = "  " + word(tissue->name) + ": {stiffness: ";
      entry += isMapped(*tissue) ? std::string("{image: ") + (options_.skin ? "body" : "ct") +
                                       ", transfer: " + tissue->stiffness_of_ct->text + "}"
                                 : stiffness.text;
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
      line(entry + "}");
    }
  }

  [[nodiscard]] std::string about(std::size_t r) const {
    const vdb::LabelSurvey::Region& region = scan_.survey.regions[r];
    std::string text = cubicCentimetres(region.volume) + " cm^3";
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
    const std::string voxel = ", voxel: " + millimetres(scan_.voxel);
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
      line("  # " + about(r));
      line("  - {name: " + word(region.name) + ", labels: {image: labels, match: " + "[" +
           vdb::listOf(region.labels) + "]" + voxel + "}, wall: " + word(region.tissue->name) +
           (region.tissue->hasContent() ? ", content: " + word(region.tissue->name) : "") + "}");
    }
  }

  void ports() {
    const std::vector<Passage> all = passages(scan_, tissues_);
    if (all.empty()) return;
    line(
        "ports:   # into each region from those that touch it and come before it; `opens_at` on "
        "the "
        "way in, `back` on the way out and in a hole");
    // A tip that overlaps a hole of its own size finds it.
    const std::string hole_at =
        ", hole: {radius: " + millimetres(2.0 * tissues_.tip_radius.value) + " mm, reopens_at: ";
    std::vector<const Tissue*> told;
    for (const Passage& passage : all) {
      const Tissue& tissue = *passage.through;
      if (std::find(told.begin(), told.end(), &tissue) == told.end()) {
        told.push_back(&tissue);
        line("  # " + tissue.name);
        number("opens_at", tissue.opens_at);
        number("back", tissue.back);
      }
      std::string outer;
      for (const std::size_t one : passage.outer) {
        outer += (outer.empty() ? "" : ", ") + word(scan_.nameOf(one));
      }
      if (passage.outer.size() > 1) outer = "[" + outer + "]";
      const std::string inner = scan_.nameOf(passage.inner);
      line("  - {name: " + sceneWord("into " + inner) + ", between: [" + outer + ", " +
           word(inner) + "], opens_at: " + tissue.opens_at->text +
           (tissue.back ? ", back: " + tissue.back->text + hole_at + tissue.back->text + "}" : "") +
           "}");
    }
  }

  const ImportOptions& options_;
  const ImportedScan& scan_;
  const TissueTable& tissues_;
  const SceneFiles& files_;
  std::string text_;
};

}  // namespace

std::string cubicCentimetres(double volume) {
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

GridEstimate estimateGrid(double area, double volume, double voxel) {
  GridEstimate estimate;
  // What is thin has less inside than a band is wide.
  const double side = kHalfWidth * area / (voxel * voxel);
  estimate.active_voxels = side + std::min(side, volume / (voxel * voxel * voxel));
  estimate.seconds = estimate.active_voxels * kSecondsPerVoxel;
  return estimate;
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

std::vector<Passage> passages(const ImportedScan& scan, const TissueTable& tissues) {
  std::vector<Passage> found;
  const vdb::LabelSurvey& survey = scan.survey;
  if (scan.has_body) {
    const Tissue& skin = requireTissue(tissues, "skin");
    if (skin.opens_at) found.push_back({{survey.outside()}, survey.gap(), &skin});
  }
  // The gap is the outermost layer, then come the regions as they are listed.
  for (std::size_t inner = 0; inner < survey.gap(); ++inner) {
    const Tissue* tissue = scan.plan.regions[inner].tissue;
    if (!tissue->opens_at) continue;
    std::vector<std::size_t> outer;
    for (const vdb::LabelSurvey::Contact& contact : survey.regions[inner].contacts) {
      const bool is_region = contact.other < survey.gap();
      if (is_region && contact.other > inner) continue;  // that one's wall
      if (contact.other == survey.outside()) {
        // The image's border is closed, and the skin is what leads into a body.
        const double free = contact.area - survey.regions[inner].border;
        if (scan.has_body || free <= 1e-9 * contact.area) continue;
      }
      outer.push_back(contact.other);
    }
    // In the order of the layers, outside and the gap before them.
    std::sort(outer.begin(), outer.end(), [&](std::size_t a, std::size_t b) {
      const auto rank = [&](std::size_t r) { return r >= survey.gap() ? 0 : r + 1; };
      return rank(a) < rank(b);
    });
    if (!outer.empty()) found.push_back({std::move(outer), inner, tissue});
  }
  return found;
}

std::string writeScene(const ImportOptions& options, const ImportedScan& scan,
                       const TissueTable& tissues, const SceneFiles& files) {
  return SceneWriter(options, scan, tissues, files).write();
}

}  // namespace palpate::tools
