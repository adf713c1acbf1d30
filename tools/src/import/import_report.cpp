#include "import/import_report.h"

#include <algorithm>
#include <cmath>

#include "import/crossings.h"
#include "json_parts.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kMostTold = 12;
constexpr double kIslandShare = 0.1;  // of a region's largest piece

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
  ImportReport(const ImportOptions& options, const ImportedScan& scan, const TissueTable& tissues,
               const NeedleWay* way, const std::set<std::string>& kept)
      : options_(options), scan_(scan), tissues_(tissues), way_(way), kept_(kept) {}

  Report make(const std::vector<std::string>& written) {
    const vdb::Image& image = scan_.labels;
    report_.json = {{"schema", "palpate.import/1"},
                    {"scan", options_.scan()},
                    {"output", written.empty() ? Json() : Json(written.front())},
                    {"size", image.size},
                    {"voxel_size_m", scan_.voxel}};
    regions();
    labels();
    unknown();
    openAir();
    changes();
    islands();
    cost();
    const auto ports = crossings(scan_, tissues_).ports.size();
    report_.json["ports"] = ports;
    report_.text += formatCount(ports) + " ports between regions that touch\n";
    way();
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
    Table table(
        {"region", "labels", "tissue", "why", "voxels", "cm^3", "pieces", "within", "touches"});
    Json json = Json::array();
    const auto add = [&](std::size_t r, const std::string& labels, const std::string& tissue,
                         TissueClass kind, const std::string& why) {
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
      table.add({scan_.nameOf(r), labels, tissue, why, formatCount(region.voxels),
                 cubicCentimeters(region.volume), formatCount(region.pieces.size()),
                 region.within ? scan_.nameOf(*region.within) : "-", touches});
      json.push_back({{"name", scan_.nameOf(r)},
                      {"tissue", tissue},
                      {"class", className(kind)},
                      {"why", why},
                      {"voxels", region.voxels},
                      {"volume_m3", region.volume},
                      {"pieces", region.pieces.size()},
                      {"within", region.within ? Json(scan_.nameOf(*region.within)) : Json()},
                      {"touches", contacts},
                      {"border_share", region.border / region.area},
                      {"bounds_m", boxJson(region.bounds)}});
      if (r < scan_.plan.regions.size()) json.back()["labels"] = scan_.plan.regions[r].labels;
    };
    if (scan_.has_body) {
      add(scan_.survey.gap(), "-", "skin, fat", TissueClass::kSolid, "no label, in the body");
    }
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const PlannedRegion& region = scan_.plan.regions[r];
      add(r, labelList(region.labels), region.tissue->name, region.tissue->kind, whyOf(region));
    }
    report_.json["regions"] = json;
    report_.text += table.text("") + "\n";
  }

  [[nodiscard]] static std::string whyOf(const PlannedRegion& region) {
    return region.is_known ? region.why : "nothing fits: " + region.why;
  }

  [[nodiscard]] double volumeOf(int label) const {
    const auto at = scan_.counts.find(label);
    const double voxels = at == scan_.counts.end() ? 0.0 : static_cast<double>(at->second);
    return voxels * std::abs(glm::determinant(scan_.labels.axes));
  }

  /// Lists each label by itself; a region of joined labels has several.
  void labels() {
    Json json = Json::array();
    const auto add = [&](const std::vector<int>& labels, const Json& more) {
      for (const int label : labels) {
        const auto name = scan_.names.find(label);
        Json one = {{"label", label},
                    {"name", name == scan_.names.end() ? Json() : Json(name->second)},
                    {"volume_m3", volumeOf(label)}};
        one.update(more);
        json.push_back(std::move(one));
      }
    };
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const PlannedRegion& region = scan_.plan.regions[r];
      Json touches = Json::array();
      for (const auto& [other, share] : scan_.neighborsOf(r)) touches.push_back(other);
      add(region.labels, {{"region", region.name},
                          {"tissue", region.tissue->name},
                          {"class", className(region.tissue->kind)},
                          {"why", whyOf(region)},
                          {"known", region.is_known},
                          {"touches", touches}});
    }
    for (const OpenAir& air : scan_.open_air) {
      add(air.labels, {{"region", "outside"},
                       {"tissue", "air"},
                       {"class", className(TissueClass::kGas)},
                       {"why", air.why + "; it reaches the image's border"},
                       {"known", true},
                       {"touches", Json::array()}});
    }
    report_.json["labels"] = std::move(json);
  }

  /// Lists labels without a tissue, the largest first: nothing is guessed silently.
  void unknown() {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      if (!scan_.plan.regions[r].is_known) found.emplace_back(scan_.survey.regions[r].volume, r);
    }
    std::sort(found.rbegin(), found.rend());
    Json json = Json::array();
    std::string text;
    for (const auto& [volume, r] : found) {
      const PlannedRegion& region = scan_.plan.regions[r];
      json.push_back({{"name", region.name},
                      {"labels", region.labels},
                      {"volume_m3", volume},
                      {"felt_as", region.tissue->name},
                      {"why", region.why}});
      text += "  " + region.name + ": " + cubicCentimeters(volume) + " cm^3, " + region.why + "\n";
    }
    report_.json["unmatched"] = std::move(json);
    if (found.empty()) return;
    const PlannedRegion& first = scan_.plan.regions[found.front().second];
    report_.text += formatCount(found.size()) + " regions fit no tissue and are felt as " +
                    first.tissue->name + "; give them one with --tissue \"" + first.name +
                    "=bone\":\n" + text;
  }

  void openAir() {
    Json json = Json::array();
    for (const OpenAir& air : scan_.open_air) {
      json.push_back({{"name", air.name}, {"labels", air.labels}, {"volume_m3", air.volume}});
      report_.text += air.name + " (" + cubicCentimeters(air.volume) +
                      " cm^3) is air that reaches the image's border, so it belongs to outside\n";
    }
    report_.json["outside"] = std::move(json);
  }

  [[nodiscard]] static std::string placeText(const Vec3& place) {
    return formatVector(place * 1e3) + " mm";
  }

  /// Lists pieces far smaller than the largest one of their region, and cavities, with their
  /// places.
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
                    "largest) and cavities remain" +
                    (options_.min_island ? "" : "; --min-island VOXELS removes small ones") +
                    ". Voxels of each:\n" + text;
    if (count > kMostTold) report_.text += "  and " + formatCount(count - kMostTold) + " more\n";
  }

  void changes() {
    Json changed = Json::array();
    std::string text;
    for (const vdb::IslandChange& change : scan_.changes) {
      const std::string to =
          change.to >= scan_.survey.gap() ? "unlabeled" : scan_.nameOf(change.to);
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

  /// Describes the requested way: what it leads through, and what is felt.
  void way() {
    if (way_ == nullptr) return;
    Table table({"tissues on the way", "tissue", "mm", "N to get in", "N at its end"});
    Json parts = Json::array();
    for (const WayPart& part : way_->parts) {
      const bool is_gap = part.region == scan_.survey.gap();
      const std::string tissue =
          is_gap ? "skin, fat" : scan_.plan.regions[part.region].tissue->name;
      table.add({scan_.nameOf(part.region), tissue, formatNumber(part.length * 1e3, 3),
                 formatNumber(part.rupture, 3), formatNumber(part.force, 3)});
      parts.push_back({{"region", scan_.nameOf(part.region)},
                       {"tissue", tissue},
                       {"length_m", part.length},
                       {"rupture_N", part.rupture},
                       {"force_N", part.force}});
    }
    report_.json["way"] = {{"target", way_->target},
                           {"from_m", vectorJson(way_->from)},
                           {"entry_m", vectorJson(way_->entry)},
                           {"to_m", vectorJson(way_->to)},
                           {"length_m", way_->length()},
                           {"clearance_m", way_->clearance},
                           {"peak_force_N", way_->peak},
                           {"parts", parts}};
    if (scan_.burr_hole) {
      const BurrHole& hole = *scan_.burr_hole;
      report_.json["way"]["burr_hole"] = {{"diameter_m", 2.0 * hole.radius},
                                          {"outer_m", vectorJson(hole.outer)},
                                          {"inner_m", vectorJson(hole.inner)},
                                          {"voxels", hole.voxels},
                                          {"through", hole.through}};
      report_.text += "Burr hole of " + formatNumber(2e3 * hole.radius) + " mm through " +
                      hole.through + ", from " + placeText(hole.outer) + " to " +
                      placeText(hole.inner) + "\n";
    }
    report_.text += "To " + way_->target + ": " + formatNumber(way_->length() * 1e3, 4) +
                    " mm from " + placeText(way_->entry) + " to " + placeText(way_->to) +
                    ", at most " + formatNumber(way_->peak, 3) + " N (predicted)\n" +
                    table.text("") + "\n";
  }

  void cost() {
    double voxels = 0.0;
    double voxels_to_make = 0.0;
    std::size_t kept = 0;
    const auto add = [&](std::size_t region, double area, double volume) {
      const double active = estimateVoxels(area, volume, scan_.voxel);
      const bool is_kept = kept_.contains(scan_.nameOf(region));
      voxels += active;
      voxels_to_make += is_kept ? 0.0 : active;
      kept += is_kept ? 1U : 0U;
    };
    double body = scan_.survey.regions[scan_.survey.gap()].volume;
    for (std::size_t r = 0; r < scan_.plan.regions.size(); ++r) {
      const vdb::LabelSurvey::Region& region = scan_.survey.regions[r];
      add(r, region.area, region.volume);
      body += region.volume;
    }
    // The body's surface is that of the outside, including its area on the image's border.
    if (scan_.has_body) {
      add(scan_.survey.gap(), scan_.survey.regions[scan_.survey.outside()].area, body);
    }
    const std::size_t grids = scan_.plan.regions.size() + (scan_.has_body ? 1 : 0);
    const double memory = estimateMemory(scan_, tissues_, voxels);
    const double seconds = estimateSeconds(grids, voxels, voxels_to_make);
    report_.json["estimate"] = {{"active_voxels", std::llround(voxels)},
                                {"memory_bytes", std::llround(memory)},
                                {"kept_grids", kept},
                                {"processor_seconds", seconds}};
    report_.text +=
        formatCount(grids) + " grids with voxels of " + formatNumber(scan_.voxel * 1e3, 3) +
        " mm: about " + formatCount(static_cast<std::uint64_t>(std::llround(voxels))) +
        " active voxels; to touch them takes " + formatBytes(static_cast<std::uint64_t>(memory)) +
        " and " + formatSeconds(seconds) + " of processor time (estimated from surface areas" +
        (kept == 0 ? "" : "; " + formatCount(kept) + " are kept from before") + ")\n";
  }

  const ImportOptions& options_;
  const ImportedScan& scan_;
  const TissueTable& tissues_;
  const NeedleWay* way_;
  const std::set<std::string>& kept_;
  Report report_;
};

}  // namespace

Report importReport(const ImportOptions& options, const ImportedScan& scan,
                    const TissueTable& tissues, const NeedleWay* way,
                    const std::vector<std::string>& written, const std::set<std::string>& kept) {
  return ImportReport(options, scan, tissues, way, kept).make(written);
}

}  // namespace palpate::tools
