// palpate import: which regions are connected in scenes of nested tissues, however their labels are
// numbered.

#include <algorithm>
#include <array>
#include <deque>
#include <numeric>
#include <set>

#include "import/imported_scene.h"
#include "palpate/interior/port_machine.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/scene_file.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

using tools::ImportedScan;
using tools::TissueTable;

constexpr std::size_t kLayers = 6;
using Names = std::array<const char*, kLayers>;  ///< from the outside in
using Numbers = std::array<int, kLayers>;

const Names kLimb = {"skin",           "subcutaneous fat",  "vastus muscle",
                     "femoral artery", "patellar ligament", "femur"};
const Names kHead = {"scalp", "skull", "dura mater", "CSF", "white matter", "lateral ventricle"};
const std::set<std::string> kRigid = {"femur", "skull"};

/// Outer radius of each shell [voxels of 1 mm].
double radiusOf(std::size_t layer) { return 8.5 - 1.25 * static_cast<double>(layer); }

/// Shells about the origin; `numbers`: the label of each.
ImportedScan scanOf(const Names& names, const Numbers& numbers, const TissueTable& tissues) {
  constexpr int kReach = 9;
  ImportedScan scan;
  scan.labels.axes = Mat3(1e-3);
  scan.labels.origin = Vec3(-kReach * 1e-3);
  scan.labels.size = {2 * kReach + 1, 2 * kReach + 1, 2 * kReach + 1};
  for (int k = -kReach; k <= kReach; ++k) {
    for (int j = -kReach; j <= kReach; ++j) {
      for (int i = -kReach; i <= kReach; ++i) {
        const double r = std::sqrt(i * i + j * j + k * k);
        int label = 0;
        for (std::size_t n = 0; n < kLayers; ++n) label = r < radiusOf(n) ? numbers[n] : label;
        scan.labels.values.push_back(static_cast<float>(label));
      }
    }
  }
  tools::LabelNames table;
  for (std::size_t n = 0; n < kLayers; ++n) table.names[numbers[n]] = names[n];
  scan.names = table.names;
  scan.counts = vdb::countLabels(scan.labels);
  scan.plan = tools::planRegions({}, scan.counts, table, tissues);
  std::vector<std::vector<int>> labels;
  for (const auto& region : scan.plan.regions) labels.push_back(region.labels);
  scan.survey = vdb::surveyLabels(scan.labels, labels, nullptr);
  scan.voxel = 1e-3;
  return scan;
}

/// The scene that import writes, with spheres in place of the surfaces made from labels: the same
/// layers, walls and ports.
ScenePtr compiled(const ImportedScan& scan, const Numbers& numbers, const TissueTable& tissues) {
  tools::ImportOptions options;
  options.scans = {"labels.nii.gz"};
  std::string text = tools::writeScene(options, scan, tissues, {{"labels.nii.gz"}, "", "", ""});
  const std::size_t images = text.find("images:\n");
  text.erase(images, text.find("# measured", images) - images);
  std::string fields = "fields:\n";
  for (std::size_t n = 0; n < kLayers; ++n) {
    fields += "  s" + std::to_string(n) +
              ": {sphere: {center: [0, 0, 0], radius: " + std::to_string(radiusOf(n)) + "}}\n";
    const std::string shell = n + 1 == kLayers ? "s" + std::to_string(n)
                                               : "{difference: [s" + std::to_string(n) + ", s" +
                                                     std::to_string(n + 1) + "]}";
    // Finds "labels: {image: labels, match: [7], voxel: 0.5}".
    const std::size_t labels =
        text.find("labels: {image: labels, match: [" + std::to_string(numbers[n]) + "], voxel: ");
    text.replace(labels, text.find('}', labels) + 1 - labels, "inside: " + shell);
  }
  return compile(parseScene(text + fields, "made.yaml"));
}

RegionId regionOf(const Scene& scene, const std::string& name) {
  for (RegionId r = 0; r < scene.regions().size(); ++r) {
    if (scene.regions()[r].name == name) return r;
  }
  ADD_FAILURE() << "no region " << name;
  return kOutside;
}

/// All regions that ports and absent walls lead to from `from`, whether or not the regions touch.
std::set<RegionId> walkedFrom(const Scene& scene, RegionId from) {
  std::set<RegionId> met = {from};
  std::deque<RegionId> next = {from};
  const Passages& passages = scene.passages();
  while (!next.empty()) {
    const RegionId here = next.front();
    next.pop_front();
    const auto go = [&](RegionId to) {
      if (met.insert(to).second) next.push_back(to);
    };
    for (RegionId to = 0; to < scene.regions().size(); ++to) {
      if (to != here && passages.wall(here, to).absent) go(to);
    }
    for (const Port& port : passages.ports()) {
      const auto leads = [&](const auto& a, const auto& b) {
        if (std::find(a.begin(), a.end(), here) == a.end()) return;
        for (const RegionId to : b) go(to);
      };
      leads(port.from, port.to);
      leads(port.to, port.from);
    }
  }
  return met;
}

/// The forces of the port that joins two regions: from the first to the second, and back.
std::pair<double, double> forcesBetween(const Scene& scene, const std::string& from,
                                        const std::string& to) {
  const RegionId a = regionOf(scene, from);
  const RegionId b = regionOf(scene, to);
  for (const Port& port : scene.passages().ports()) {
    const auto has = [](const auto& list, RegionId r) {
      return std::find(list.begin(), list.end(), r) != list.end();
    };
    const auto in = port.opens_at.range().most;
    const auto out = port.back.range().most;
    if (has(port.from, a) && has(port.to, b)) return {in, out};
    if (has(port.from, b) && has(port.to, a)) return {out, in};
  }
  return {-1.0, -1.0};
}

class ImportCrossings : public ::testing::TestWithParam<Names> {};

TEST_P(ImportCrossings, NoNumberingLeadsIntoWhatIsRigid) {
  const TissueTable tissues = tools::ownTissueTable();
  const Names names = GetParam();
  Numbers numbers{};
  std::iota(numbers.begin(), numbers.end(), 1);
  std::string first;
  std::size_t seen = 0;
  do {
    const ImportedScan scan = scanOf(names, numbers, tissues);
    const ScenePtr scene = compiled(scan, numbers, tissues);
    std::string shown;
    for (const int n : numbers) shown += std::to_string(n) + " ";
    SCOPED_TRACE(shown);
    for (const Region& start : scene->regions()) {
      if (kRigid.contains(start.name)) continue;
      for (const RegionId met : walkedFrom(*scene, regionOf(*scene, start.name))) {
        ASSERT_FALSE(kRigid.contains(scene->regions()[met].name)) << "from " << start.name;
      }
    }
    // From outside, everything soft in front of the bone can be reached; from the innermost region,
    // everything behind it.
    std::set<std::string> reached;
    for (const RegionId r : walkedFrom(*scene, kOutside)) reached.insert(scene->regions()[r].name);
    for (const RegionId r : walkedFrom(*scene, regionOf(*scene, names[kLayers - 1]))) {
      reached.insert(scene->regions()[r].name);
    }
    for (const char* name : names) {
      if (!kRigid.contains(name)) {
        EXPECT_EQ(reached.count(name), 1U) << name;
      }
    }
    // The forces do not depend on the numbers either.
    std::string forces;
    for (std::size_t n = 0; n + 1 < kLayers; ++n) {
      const auto [in, out] = forcesBetween(*scene, names[n], names[n + 1]);
      forces += std::to_string(in) + " " + std::to_string(out) + "; ";
    }
    if (first.empty()) first = forces;
    ASSERT_EQ(forces, first);
    ++seen;
  } while (std::next_permutation(numbers.begin(), numbers.end()));
  EXPECT_EQ(seen, 720U);
}

INSTANTIATE_TEST_SUITE_P(LimbAndHead, ImportCrossings, ::testing::Values(kLimb, kHead));

TEST(ImportCrossingsOfOne, EachWallRupturesBothWaysAtTheForceOfWhatIsEnteredOrLeft) {
  const TissueTable tissues = tools::ownTissueTable();
  const Numbers numbers = {4, 2, 6, 1, 5, 3};
  const auto force_of = [&](const char* tissue, auto member) {
    return (tissues.find(tissue)->*member)->value;
  };
  using tools::Tissue;
  const ScenePtr limb = compiled(scanOf(kLimb, numbers, tissues), numbers, tissues);
  const auto between = [&](const ScenePtr& scene, const char* a, const char* b) {
    return forcesBetween(*scene, a, b);
  };
  // Leaving the muscle into fat takes as much force as entering it: the same fascia.
  EXPECT_EQ(between(limb, "subcutaneous fat", "vastus muscle"),
            std::pair(force_of("muscle", &Tissue::opens_at), force_of("muscle", &Tissue::back)));
  EXPECT_GE(force_of("muscle", &Tissue::back), force_of("muscle", &Tissue::opens_at));
  EXPECT_EQ(between(limb, "outside", "skin").first, force_of("skin", &Tissue::opens_at));
  EXPECT_EQ(between(limb, "patellar ligament", "femur"), std::pair(-1.0, -1.0));
  const ScenePtr head = compiled(scanOf(kHead, numbers, tissues), numbers, tissues);
  EXPECT_EQ(
      between(head, "white matter", "lateral ventricle"),
      std::pair(force_of("ependyma", &Tissue::opens_at), force_of("ependyma", &Tissue::back)));
  EXPECT_EQ(between(head, "CSF", "white matter").first, force_of("brain", &Tissue::opens_at));
  EXPECT_EQ(between(head, "scalp", "skull"), std::pair(-1.0, -1.0));
  EXPECT_EQ(between(head, "skull", "dura mater"), std::pair(-1.0, -1.0));
}

TEST(ImportCrossingsOfOne, ParcelsOfOneTissueHaveNoWallAndStayRegions) {
  const TissueTable tissues = tools::ownTissueTable();
  const Names parcels = {"precentral gyrus", "postcentral gyrus", "insula",
                         "putamen",          "globus pallidus",   "thalamus"};
  const Numbers numbers = {1, 2, 3, 4, 5, 6};
  const ScenePtr scene = compiled(scanOf(parcels, numbers, tissues), numbers, tissues);
  ASSERT_EQ(scene->regions().size(), 1 + kLayers);
  EXPECT_EQ(scene->passages().ports().size(), 1U);  // from outside
  for (RegionId a = 1; a <= kLayers; ++a) {
    for (RegionId b = 1; b <= kLayers; ++b) {
      if (a != b) {
        EXPECT_TRUE(scene->passages().wall(a, b).absent) << a << " " << b;
      }
    }
    EXPECT_FALSE(scene->passages().wall(a, kOutside).absent);
  }
  // Bones that touch remain separate: each stays closed.
  const Names bones = {"femur", "tibia", "patella", "fibula", "talus", "calcaneus"};
  const ScenePtr joint = compiled(scanOf(bones, numbers, tissues), numbers, tissues);
  EXPECT_TRUE(joint->passages().ports().empty());
  for (RegionId a = 0; a <= kLayers; ++a) {
    EXPECT_EQ(walkedFrom(*joint, a), std::set<RegionId>{a});
  }
}

TEST(ImportCrossingsOfOne, FluidsAndGasesHaveNoWallsOfTheirOwn) {
  const TissueTable tissues = tools::ownTissueTable();
  const Names names = {"blood", "CSF", "third ventricle", "urine", "maxillary sinus", "trachea"};
  const Numbers numbers = {6, 5, 4, 3, 2, 1};
  const ScenePtr scene = compiled(scanOf(names, numbers, tissues), numbers, tissues);
  EXPECT_TRUE(scene->passages().ports().empty());
  for (RegionId a = 1; a <= kLayers; ++a) {
    for (RegionId b = 1; b <= kLayers; ++b) {
      if (a != b) {
        EXPECT_TRUE(scene->passages().wall(a, b).absent) << a << " " << b;
      }
    }
    const int content = scene->regions()[a].content;
    if (content < 0) continue;  // a gas
    EXPECT_EQ(scene->materials()[static_cast<std::size_t>(content)].stiffness.range().most, 0.0);
  }
}

TEST(ImportCrossingsOfOne, ATableSaysWhatIsWrongWithIt) {
  const TempFolder folder;
  const std::string head =
      "palpate_tissues: 1\ntip_radius: {value: 1 mm, basis: assumed, source: x}\n"
      "stiffest: {value: 2000 N/m, basis: assumed, source: x}\n";
  const std::string wall = "stiffness: {value: 9 N/m, basis: assumed, source: x}";
  const std::string opens = "opens_at: {value: 1 N, basis: assumed, source: x}";
  const auto code_of = [&](const std::string& rest) -> std::string {
    try {
      (void)tools::readTissueTable(folder.file("t.yaml", head + rest));
      return "";
    } catch (const Error& error) {
      return error.problem().code;
    }
  };
  EXPECT_EQ(code_of("tissues:\n  a: {class: rigid, " + wall + "}\n"), "");
  EXPECT_EQ(code_of("tissues:\n  a: {class: rigid, " + wall + ", " + opens + "}\n"),
            "tissues.class");
  EXPECT_EQ(code_of("tissues:\n  a: {class: hard, " + wall + "}\n"), "tissues.class");
  EXPECT_EQ(code_of("tissues:\n  a: {class: gas, " + wall + "}\n"), "tissues.class");
  EXPECT_EQ(code_of("tissues:\n  a: {class: solid, lining: b, " + wall + "}\n"), "tissues.class");
  EXPECT_EQ(code_of("tissues:\n  a: {class: fluid, lining: b}\n"), "tissues.lining");
  EXPECT_EQ(code_of("unknown: b\ntissues:\n  a: {" + wall + "}\n"), "tissues.unknown");
}

}  // namespace
}  // namespace palpate::testing
