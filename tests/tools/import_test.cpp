// palpate import: scenes from label images that the tests write.

#include <cmath>
#include <functional>

#include "tools/helpers.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

using vdb::test::bytesOf;
using vdb::test::gzipped;
using vdb::test::NiftiFile;

/// Writes a label image to `folder`, with voxels of 1 mm, the middle one at the origin.
std::string writeLabels(const TempFolder& folder, const std::string& name, int size,
                        const std::function<double(int, int, int)>& label) {
  NiftiFile file;
  file.dim = {size, size, size};
  const int middle = (size - 1) / 2;
  const double first = -middle;
  file.sform = {{{1, 0, 0, first}, {0, 1, 0, first}, {0, 0, 1, first}}};
  file.pixdim = {1, 1, 1, 1};
  file.datatype = 16;  // float
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        file.values.push_back(label(i - middle, j - middle, k - middle));
      }
    }
  }
  const auto bytes = gzipped(bytesOf(file));
  return folder.file(name,
                     std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// A leg along z: a body of radius 18 mm, muscle within 13 mm, bone within 6 mm; 41 voxels long.
void writeLeg(const TempFolder& folder) {
  (void)writeLabels(folder, "leg.nii.gz", 41, [](int x, int y, int) {
    const double r = std::hypot(x, y);
    return r < 6 ? 2 : r < 13 ? 1 : 0;
  });
  (void)writeLabels(folder, "body.nii.gz", 41,
                    [](int x, int y, int) { return std::hypot(x, y) < 18 ? 1 : 0; });
  (void)folder.file("names.csv", "value,name\n0,background\n1,vastus muscle\n2,femur\n3,none\n");
}

const Json* find(const Json& list, const std::string& name) {
  for (const Json& one : list) {
    if (one["name"] == name) return &one;
  }
  ADD_FAILURE() << "no " << name;
  return nullptr;
}

Json imported(const TempFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "import");
  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result);
}

TEST(Import, AProbeGoesThroughSkinFatAndMuscleAndStopsAtTheBone) {
  const TempFolder folder;
  writeLeg(folder);
  const Json json = imported(
      folder, {"leg.nii.gz", "--names", "names.csv", "--body", "body.nii.gz", "-o", "leg.yaml"});
  EXPECT_EQ(json["schema"], "palpate.import/1");
  EXPECT_EQ(filesIn(folder.path()),
            (std::vector<std::string>{"body.nii.gz", "leg.nii.gz", "leg.yaml", "names.csv"}));
  const Json muscle = *find(json["regions"], "vastus muscle");
  EXPECT_EQ(muscle["tissue"], "muscle");
  EXPECT_EQ(muscle["labels"], Json::array({1}));
  EXPECT_EQ(find(json["regions"], "femur")->at("tissue"), "bone");
  EXPECT_EQ(find(json["regions"], "soft_tissue")->at("tissue"), "skin, fat");
  EXPECT_EQ(json["ports"], 2);  // into the skin and the muscle, not into the bone

  // The needle moves along y at 10 mm/s, slow enough to neglect damping: a wall opens at its force.
  const CommandResult touch = runPalpate({"touch", "leg.yaml", "--insert", "0,30,0", "0,-9,0",
                                          "--speed", "10mm/s", "--trace", "t.csv", "--json"},
                                         folder.path());
  ASSERT_EQ(touch.exit_code, 0) << touch.err;
  std::vector<std::string> order;
  std::vector<double> entered;  // [mm] y of the proxy in the first tick in each region
  double last_y = 0.0;
  double hip = 0.0;
  const std::vector<std::string> rows = linesOf(textOf(folder.path("t.csv")));
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const std::vector<std::string> cells = cellsOf(rows[row]);
    last_y = std::stod(cells[5]) * 1e3;
    hip = std::stod(cells[2]) * 1e3;
    const std::string& region = cells[10];
    if (!order.empty() && order.back() == region) continue;
    order.push_back(region);
    entered.push_back(last_y);
  }
  ASSERT_EQ(order, (std::vector<std::string>{"outside", "soft_tissue", "vastus muscle"}));
  EXPECT_NEAR(hip, -9.0, 0.1);
  // The needle rests on the bone: the surface is between the centers at 5 and 6 mm.
  EXPECT_NEAR(last_y, 5.5, 0.5);

  // The peak in front of each wall is its port's opening force; friction acts only along the wall.
  // In the fat a needle also feels the cutting force, and friction along the part of its shaft that
  // is inside.
  const Json told = parseOnly(touch);
  const std::map<std::string, double> peak = [&] {
    std::map<std::string, double> of;
    for (const Json& region : told["regions"]) of[region["region"]] = region["peak_force_N"];
    return of;
  }();
  EXPECT_NEAR(peak.at("outside"), 2.78, 0.03);
  // From the skin, half-way between the centers at 17 and 18 mm, to the muscle's wall, where the
  // proxy waits at once: the hand is already beyond it when the skin opens.
  const double shaft = 35.0 * (17.5 - entered[1]) * 1e-3;
  EXPECT_NEAR(peak.at("soft_tissue"), 1.5 + 0.2 + shaft, 0.05);
}

TEST(Import, LabelsBecomeRegionsByValueRangeNameAndPattern) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 21,
                    [](int x, int, int) { return (x + 10) / 3; });  // 0 to 6
  (void)folder.file("n.csv",
                    "value,name\n1,rib_1\n2,rib_2\n3,liver\n4,spleen\n5,5-6\n6,odd; \"name\"\n");
  const auto regions = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"l.nii.gz", "--names", "n.csv", "--dry-run"});
    std::map<std::string, Json> of;
    const Json json = imported(folder, arguments);
    for (const Json& region : json["regions"]) {
      of[region["name"]] = region["labels"];
    }
    return of;
  };
  using Regions = std::map<std::string, Json>;
  EXPECT_EQ(regions({}), (Regions{{"rib_1", {1}},
                                  {"rib_2", {2}},
                                  {"liver", {3}},
                                  {"spleen", {4}},
                                  {"5-6", {5}},
                                  {"odd_ _name_", {6}}}));
  EXPECT_EQ(regions({"--labels", "liver,6"}), (Regions{{"liver", {3}}, {"odd_ _name_", {6}}}));
  EXPECT_EQ(regions({"--labels", "2-4"}),
            (Regions{{"rib_2", {2}}, {"liver", {3}}, {"spleen", {4}}}));
  EXPECT_EQ(regions({"--labels", "3", "--region", "ribs=rib_*", "--region", "rest=5-6,spleen"}),
            (Regions{{"liver", {3}}, {"ribs", {1, 2}}, {"rest", {4, 5, 6}}}));
  EXPECT_EQ(filesIn(folder.path()), (std::vector<std::string>{"l.nii.gz", "n.csv"}));
}

TEST(Import, NestingIsFoundAndShown) {
  const TempFolder folder;
  (void)writeLabels(folder, "v.nii.gz", 25, [](int x, int y, int z) {
    const double r = std::hypot(x, y, z);
    return r < 5 ? 50 : r < 8 ? 49 : 0;
  });
  const Json json = imported(folder, {"v.nii.gz", "--dry-run"});
  EXPECT_TRUE(json["output"].is_null());
  EXPECT_EQ(find(json["regions"], "label_50")->at("within"), "label_49");
  EXPECT_TRUE(find(json["regions"], "label_49")->at("within").is_null());
  const CommandResult text = runPalpate({"import", "v.nii.gz", "--dry-run"}, folder.path());
  EXPECT_NE(text.out.find("label_49 100 %"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("Nothing was written"), std::string::npos) << text.out;
}

TEST(Import, IslandsAreToldAndChangedOnRequest) {
  const TempFolder folder;
  const auto label = [](int x, int y, int z) {
    if (x == 0 && y == 0 && z == 0) return 0;   // a cavity
    if (x == -9 && y == 9 && z == 9) return 1;  // a speck in the air
    return std::hypot(x, y, z) < 6 ? 1 : 0;
  };
  (void)writeLabels(folder, "l.nii.gz", 21, label);
  const Json told = imported(folder, {"l.nii.gz", "-o", "told.yaml"});
  ASSERT_EQ(told["islands"].size(), 2U);
  EXPECT_TRUE(told["changed"].empty());
  EXPECT_EQ(told["islands"][0]["region"], "label_1");
  EXPECT_NEAR(told["islands"][0]["place_m"][0].get<double>(), -9e-3, 1e-9);
  EXPECT_NE(textOf(folder.path("told.yaml")).find("\"l.nii.gz\""), std::string::npos);

  const Json changed = imported(folder, {"l.nii.gz", "--min-island", "2", "-o", "new.yaml"});
  EXPECT_EQ(changed["changed"].size(), 2U);
  EXPECT_TRUE(changed["islands"].empty());
  EXPECT_EQ(find(changed["regions"], "label_1")->at("pieces"), 1);
  EXPECT_NE(textOf(folder.path("new.yaml")).find("\"new.labels.nii.gz\""), std::string::npos);
  // The output is a label image with the same voxels, except the two changed ones.
  const Json again = imported(folder, {"new.labels.nii.gz", "--dry-run"});
  EXPECT_EQ(again["size"], changed["size"]);
  EXPECT_EQ(find(again["regions"], "label_1")->at("voxels"),
            find(told["regions"], "label_1")->at("voxels"));
  EXPECT_EQ(find(again["regions"], "label_1")->at("bounds_m"),
            find(changed["regions"], "label_1")->at("bounds_m"));

  const Json dropped =
      imported(folder, {"l.nii.gz", "--min-island", "2", "--islands", "drop", "--dry-run"});
  ASSERT_EQ(dropped["changed"].size(), 1U);
  EXPECT_EQ(dropped["changed"][0]["to"], "unlabeled");
}

TEST(Import, TheSkinIsFoundInGrayValues) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 31,
                    [](int x, int y, int z) { return std::hypot(x, y, z) < 5 ? 1 : 0; });
  // A CT: air, a body with an air-filled cavity, and a table beside it.
  (void)writeLabels(folder, "ct.nii.gz", 31, [](int x, int y, int z) {
    const double r = std::hypot(x, y, z);
    if (y < -13) return 200.0;
    return r < 11 && std::hypot(x - 7, y, z) > 2 ? 40.0 : -1000.0;
  });
  const Json json =
      imported(folder, {"l.nii.gz", "--image", "ct.nii.gz", "--skin", "-300", "-o", "s.yaml"});
  const Json gap = *find(json["regions"], "soft_tissue");
  const Json label = *find(json["regions"], "label_1");
  // The ball of 11, with its cavity filled, without the ball of 5 and without the table.
  std::uint64_t expected = 0;
  for (int x = -15; x <= 15; ++x) {
    for (int y = -15; y <= 15; ++y) {
      for (int z = -15; z <= 15; ++z) {
        const double r = std::hypot(x, y, z);
        expected += r < 11 && r >= 5 ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(gap["voxels"], expected);
  EXPECT_EQ(label["within"], "soft_tissue");
  EXPECT_NE(textOf(folder.path("s.yaml")).find("threshold: {image: body, above: -300"),
            std::string::npos);
  // The resulting scene agrees: query the regions at these places.
  const CommandResult query = runPalpate(
      {"query", "s.yaml", "--json", "--at", "0,0,0", "7,0,0", "0,10,0", "0,12.5,0", "0,-14,0"},
      folder.path());
  ASSERT_EQ(query.exit_code, 0) << query.err;
  std::vector<std::string> regions;
  const Json points = parseOnly(query)["points"];
  for (const Json& point : points) regions.push_back(point["region"]);
  EXPECT_EQ(regions, (std::vector<std::string>{"label_1", "soft_tissue", "soft_tissue", "outside",
                                               "outside"}));
}

TEST(Import, MaterialsComeFromTheTableThatIsGiven) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 11,
                    [](int x, int y, int z) { return std::hypot(x, y, z) < 4 ? 1 : 0; });
  (void)folder.file("t.yaml", R"(palpate_tissues: 1
tip_radius: {value: 2 mm, basis: assumed, source: mine}
stiffest: {value: 1000 N/m, basis: assumed, source: mine}
tissues:
  jelly:
    labels: ["*"]
    shear: {value: 10 kPa, basis: measured, source: "a rheometer"}
    poisson: {value: 0.5, basis: assumed, source: water}
    opens_at: {value: 0.25 N, basis: assumed, source: mine}
)");
  ASSERT_EQ(imported(folder, {"l.nii.gz", "--materials", "t.yaml", "-o", "s.yaml"})["ports"], 1);
  const std::string scene = textOf(folder.path("s.yaml"));
  // K = 2 a E / (1 - nu^2) with E = 2 G (1 + nu): 2 * 0.002 * 30000 / 0.75.
  EXPECT_NE(scene.find("jelly: {stiffness: 160 N/m}"), std::string::npos) << scene;
  EXPECT_NE(scene.find("measured: a rheometer"), std::string::npos) << scene;
  EXPECT_NE(scene.find("opens_at: 0.25 N}"), std::string::npos) << scene;
  EXPECT_EQ(runPalpate({"explain", "s.yaml"}, folder.path()).exit_code, 0);
}

TEST(Import, TheProjectsTableGivesEveryNumberASourceAndFitsTheNamesInUse) {
  const TempFolder folder;
  const std::map<std::string, std::string> tissue_of = {{"rib_left_1", "bone"},
                                                        {"costal_cartilages", "cartilage"},
                                                        {"vertebrae_L3", "bone"},
                                                        {"hip_right", "bone"},
                                                        {"gluteus_maximus_left", "muscle"},
                                                        {"autochthon_left", "muscle"},
                                                        {"Tibialis anterior muscle", "muscle"},
                                                        {"tibia_left", "bone"},
                                                        {"lung_upper_lobe_left", "lung"},
                                                        {"pulmonary_vein", "vein"},
                                                        {"gallbladder", "gallbladder"},
                                                        {"urinary_bladder", "hollow_organ"},
                                                        {"spinal_cord", "nerve"},
                                                        {"Thalamus_L", "brain"},
                                                        {"mandible", "bone"},
                                                        {"submandibular_gland", "soft_tissue"},
                                                        {"portal_vein_and_splenic_vein", "vein"},
                                                        {"Skin", "skin"},
                                                        {"subcutaneous fat", "fat"},
                                                        {"trachea", "airway"},
                                                        {"left_vertebral_artery", "vessel"},
                                                        {"cranial_nerve", "nerve"},
                                                        {"rib1", "bone"}};
  std::string names = "value,name\n";
  std::vector<std::string> order;
  for (const auto& [name, tissue] : tissue_of) {
    order.push_back(name);
    names += std::to_string(order.size()) + "," + name + "\n";
  }
  (void)folder.file("n.csv", names);
  (void)writeLabels(folder, "l.nii.gz", 25, [&](int x, int, int) {
    return std::min<int>(x + 13, static_cast<int>(order.size()));
  });
  const Json json = imported(folder, {"l.nii.gz", "--names", "n.csv", "-o", "s.yaml"});
  EXPECT_EQ(json["regions"].size(), order.size());
  for (const Json& region : json["regions"]) {
    EXPECT_EQ(region["tissue"], tissue_of.at(region["name"])) << region["name"];
  }
  // Each line with a number says where the number comes from.
  for (const std::string& line : linesOf(textOf(folder.path("s.yaml")))) {
    if (!line.starts_with("  #   ")) continue;
    const bool is_sourced = line.find(": measured: ") != std::string::npos ||
                            line.find(": derived: ") != std::string::npos ||
                            line.find(": assumed: ") != std::string::npos;
    EXPECT_TRUE(is_sourced) << line;
  }
  EXPECT_EQ(runPalpate({"info", "s.yaml"}, folder.path()).exit_code, 0);
}

TEST(Import, StiffnessComesFromCtNumbersOnRequest) {
  const TempFolder folder;
  writeLeg(folder);
  // A CT of it: air, fat, muscle that is dense in front and fatty behind, and bone that is softer
  // behind.
  (void)writeLabels(folder, "ct.nii.gz", 41, [](int x, int y, int) {
    const double r = std::hypot(x, y);
    if (r < 6) return y > 0 ? 1500.0 : 100.0;
    if (r < 13) return y > 0 ? 50.0 : -25.0;
    return r < 18 ? -100.0 : -1000.0;
  });
  const std::vector<std::string> common = {"leg.nii.gz", "--names", "names.csv", "--image",
                                           "ct.nii.gz"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = common;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  (void)imported(folder, with({"--skin", "-300", "--hounsfield", "-o", "s.yaml"}));
  (void)imported(folder, with({"--body", "body.nii.gz", "--hounsfield", "-o", "b.yaml"}));
  const std::string scene = textOf(folder.path("s.yaml"));
  EXPECT_NE(
      scene.find("muscle: {stiffness: {image: body, transfer: [[-100, 65.5 N/m], [50, 156 N/m]]}"),
      std::string::npos)
      << scene;
  EXPECT_NE(scene.find("stiffness by CT number [[100, 1000 N/m], [1500, 2000 N/m]]: assumed: "),
            std::string::npos);
  EXPECT_NE(textOf(folder.path("b.yaml")).find("bone: {stiffness: {image: ct, transfer: "),
            std::string::npos);

  // At places whose neighbors have the same CT number, the stiffness is the transfer function of
  // that number.
  for (const std::string& file : {std::string("s.yaml"), std::string("b.yaml")}) {
    const CommandResult query = runPalpate(
        {"query", file, "--json", "--at", "0,9.5,0", "0,-9.5,0", "0,15.5,0", "0,2.5,0", "0,-2.5,0"},
        folder.path());
    ASSERT_EQ(query.exit_code, 0) << query.err;
    const Json points = parseOnly(query)["points"];
    const auto stiffness = [&](std::size_t n, const char* of) {
      return points[n][of]["stiffness_N_per_m"].get<double>();
    };
    // 16 bits for the range of the table's points: the error is far below 0.1 N/m.
    EXPECT_NEAR(stiffness(0, "content"), 156.0, 0.1);
    EXPECT_NEAR(stiffness(1, "content"), 65.5 + 75.0 / 150.0 * (156.0 - 65.5), 0.1);
    EXPECT_NEAR(stiffness(2, "content"), 65.5, 0.1);
    EXPECT_NEAR(stiffness(3, "wall"), 2000.0, 0.1);
    EXPECT_NEAR(stiffness(4, "wall"), 1000.0, 0.1);
  }
  // An image that is not a CT, or does not cover the labels, is reported.
  (void)writeLabels(folder, "mr.nii.gz", 21, [](int x, int y, int z) { return 100 + x + y + z; });
  const CommandResult told = runPalpate(
      {"import", "leg.nii.gz", "--image", "mr.nii.gz", "--hounsfield", "--dry-run"}, folder.path());
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_NE(told.err.find("is it a CT?"), std::string::npos) << told.err;
  EXPECT_NE(told.err.find("reach beyond it"), std::string::npos) << told.err;
}

TEST(Import, LabelsWithoutNamesAreToldToHaveOneTissue) {
  const TempFolder folder;
  writeLeg(folder);
  const CommandResult bare = runPalpate({"import", "leg.nii.gz", "--dry-run"}, folder.path());
  EXPECT_NE(bare.err.find("taken for soft_tissue; give names (--names FILE)"), std::string::npos)
      << bare.err;
  const CommandResult named =
      runPalpate({"import", "leg.nii.gz", "--names", "names.csv", "--dry-run"}, folder.path());
  EXPECT_EQ(named.err.find("taken for"), std::string::npos) << named.err;
}

/// The tissue of each label in a report, by the label's name or else its number.
std::map<std::string, std::string> tissuesIn(const Json& json) {
  std::map<std::string, std::string> of;
  for (const Json& label : json["labels"]) {
    const std::string name = label["name"].is_null() ? std::to_string(label["label"].get<int>())
                                                     : label["name"].get<std::string>();
    of[name] = label["tissue"];
  }
  return of;
}

using Tissues = std::map<std::string, std::string>;

TEST(Import, WhatFitsNoTissueIsListedWithItsVolumeAndGivenOneOnRequest) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 21, [](int x, int, int) { return (x + 10) / 5; });
  (void)folder.file("n.csv", "value,name\n1,R-C-X\n2,Outer Blob\n3,femur\n4,seen nowhere\n");
  const std::vector<std::string> common = {"l.nii.gz", "--names", "n.csv", "--dry-run"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = common;
    all.insert(all.end(), more.begin(), more.end());
    return imported(folder, all);
  };
  const Json plain = with({});
  ASSERT_EQ(plain["unmatched"].size(), 3U);
  // 5 slices of 21 x 21 voxels of 1 mm; one slice for the last label.
  EXPECT_NEAR(plain["unmatched"][0]["volume_m3"].get<double>(), 5 * 441e-9, 1e-15);
  EXPECT_EQ(plain["unmatched"][2]["name"], "seen nowhere");
  EXPECT_NEAR(plain["unmatched"][2]["volume_m3"].get<double>(), 441e-9, 1e-15);
  EXPECT_EQ(find(plain["regions"], "femur")->at("why"), "word \"femur\"");
  EXPECT_EQ(find(plain["regions"], "femur")->at("class"), "rigid");
  for (const Json& label : plain["labels"]) {
    EXPECT_EQ(label["known"], label["name"] == "femur");
    EXPECT_FALSE(label["touches"].empty());
  }
  const CommandResult text =
      runPalpate({"import", "l.nii.gz", "--names", "n.csv", "--dry-run"}, folder.path());
  EXPECT_NE(text.out.find("3 regions fit no tissue"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("R-C-X: 2.21 cm^3"), std::string::npos) << text.out;

  (void)folder.file("t.txt", "# mine\n\nouter-*=bone\r\nnot here=fat\nseen nowhere = nerve\n");
  const Json given =
      with({"--tissue-file", "t.txt", "--tissue", "1=liver", "--tissue", "4=muscle", "--strict"});
  EXPECT_TRUE(given["unmatched"].empty());
  EXPECT_EQ(tissuesIn(given), (Tissues{{"R-C-X", "liver"},
                                       {"Outer Blob", "bone"},
                                       {"femur", "bone"},
                                       {"seen nowhere", "muscle"}}));
  EXPECT_EQ(find(given["regions"], "R-C-X")->at("why"), "--tissue 1=liver");
  // The last option wins, whatever a name says.
  EXPECT_EQ(tissuesIn(with({"--tissue", "3=fat", "--tissue", "2-3=brain"}))["femur"], "brain");
  // Joined regions are judged by their own name, or by a tissue that all of their labels share.
  const Json joined = with({"--region", "bones=2-3", "--region", "rest=1,4"});
  EXPECT_EQ(find(joined["regions"], "bones")->at("tissue"), "bone");
  EXPECT_EQ(joined["labels"].size(), 4U);
}

TEST(Import, NumbersOfFreeSurferNeedNoNames) {
  const TempFolder folder;
  (void)writeLabels(folder, "aseg.nii.gz", 15, [](int x, int, int) {
    return x < -3 ? 1035 : x < 0 ? 2 : x < 3 ? 4 : x < 5 ? 24 : 9999;
  });
  const Json json = imported(folder, {"aseg.nii.gz", "--codes", "freesurfer", "--dry-run"});
  EXPECT_EQ(tissuesIn(json), (Tissues{{"1035", "brain"},
                                      {"2", "brain"},
                                      {"4", "ventricle"},
                                      {"24", "csf"},
                                      {"9999", "soft_tissue"}}));
  EXPECT_EQ(json["unmatched"].size(), 1U);
}

TEST(Import, AirThatReachesTheBorderIsOutside) {
  const TempFolder folder;
  // A head in air, with a sinus that is labeled as air too.
  const auto labels = [&](bool has_sinus) {
    (void)writeLabels(folder, "head.nii.gz", 31, [&](int x, int y, int z) {
      if (has_sinus && std::hypot(x, y, z) < 4) return 1;
      return std::hypot(x, y, z) < 12 ? 2 : 1;
    });
  };
  (void)folder.file("n.csv", "value,name\n1,Air\n2,white matter\n");
  (void)writeLabels(folder, "body.nii.gz", 31,
                    [](int x, int y, int z) { return std::hypot(x, y, z) < 12 ? 1 : 0; });
  const std::vector<std::string> bare = {"head.nii.gz", "--names", "n.csv",
                                         "-o",          "s.yaml",  "--force"};
  std::vector<std::string> in_body = bare;
  in_body.insert(in_body.end(), {"--body", "body.nii.gz"});
  for (const bool has_sinus : {false, true}) {
    labels(has_sinus);
    const Json json = imported(folder, bare);
    ASSERT_EQ(json["regions"].size(), 1U);
    ASSERT_EQ(json["outside"].size(), 1U);
    EXPECT_EQ(json["outside"][0]["name"], "Air");
    EXPECT_GT(json["outside"][0]["volume_m3"].get<double>(), 1e-6);
    EXPECT_EQ(tissuesIn(json).at("Air"), "air");
    EXPECT_NE(textOf(folder.path("s.yaml")).find("# Air ("), std::string::npos);
  }
  // Without a body both are outside; with one, the part inside it must not become flesh.
  const Json query = parseOnly(
      runPalpate({"query", "s.yaml", "--json", "--at", "0,0,0", "0,8,0", "0,14,0"}, folder.path()));
  EXPECT_EQ(query["points"][0]["region"], "outside");
  EXPECT_EQ(query["points"][1]["region"], "white matter");
  EXPECT_EQ(query["points"][2]["region"], "outside");
  const Json kept = imported(folder, in_body);
  EXPECT_TRUE(kept["outside"].empty());
  EXPECT_EQ(find(kept["regions"], "Air")->at("class"), "gas");
  labels(false);
  EXPECT_EQ(imported(folder, in_body)["outside"].size(), 1U);
}

TEST(Import, TheSuggestedTouchIsOneThatAHandCanHold) {
  const TempFolder folder;
  writeLeg(folder);
  (void)imported(folder,
                 {"leg.nii.gz", "--names", "names.csv", "--body", "body.nii.gz", "-o", "leg.yaml"});
  std::vector<std::string> arguments;
  for (const std::string& line : linesOf(textOf(folder.path("leg.yaml")))) {
    const std::size_t at = line.find("palpate touch SCENE.yaml ");
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(at + std::string("palpate ").size()));
    for (std::string word; words >> word;) {
      arguments.push_back(word == "SCENE.yaml"  ? "leg.yaml"
                          : word == "SCENE.png" ? "leg.png"
                                                : word);
    }
    break;
  }
  ASSERT_FALSE(arguments.empty());
  arguments.insert(arguments.end(), {"--speed", "20mm/s", "--json"});
  const CommandResult touch = runPalpate(arguments, folder.path());
  ASSERT_EQ(touch.exit_code, 0) << touch.err;
  double peak = 0.0;
  const Json told = parseOnly(touch);
  for (const Json& region : told["regions"])
    peak = std::max(peak, region["peak_force_N"].get<double>());
  EXPECT_GT(told["regions"].size(), 2U);
  // A millimeter into a wall of at most 2000 N/m, in addition to the forces on the way.
  EXPECT_LT(peak, 5.0);
}

TEST(Import, AScanInTheSceneFolderIsNamedFromThere) {
  const TempFolder folder;
  writeLeg(folder);
  (void)imported(folder, {folder.path("leg.nii.gz"), "-o", folder.path("leg.yaml")});
  EXPECT_NE(textOf(folder.path("leg.yaml")).find("labels: {file: \"leg.nii.gz\""),
            std::string::npos);
}

TEST(Import, RangesOfLabelsAreThoseOfBakeToo) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 21, [](int x, int y, int z) {
    return std::hypot(x, y, z) < 8 ? 1 + (x + 10) / 4 : 0;  // 1 to 5
  });
  const CommandResult baked =
      runPalpate({"bake", "l.nii.gz", "--labels", "2-4", "-o", "l.vdb", "--json"}, folder.path());
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  for (const char* name : {"label_2", "label_3", "label_4"}) {
    EXPECT_NE(baked.out.find(name), std::string::npos) << name;
  }
  EXPECT_EQ(baked.out.find("label_5"), std::string::npos);
  const CommandResult none =
      runPalpate({"bake", "l.nii.gz", "--labels", "7-9", "-o", "n.vdb", "--json"}, folder.path());
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_EQ(parseOnly(none)["error"]["code"], "labels.no_voxels");
}

TEST(Import, InfoCountsManyLabelsWithoutNames) {
  const TempFolder folder;
  // 125 parcels of 5^3 voxels, and gray values with as many different numbers.
  const auto parcel = [](int x, int y, int z) {
    return 1 + (x + 12) / 5 + 5 * ((y + 12) / 5) + 25 * ((z + 12) / 5);
  };
  (void)writeLabels(folder, "parcels.nii.gz", 25, parcel);
  (void)writeLabels(folder, "gray.nii.gz", 25, [](int x, int y, int z) {
    return 1 + (7 * x * x + 11 * y * y + 13 * z * z) % 125;
  });
  const auto info = [&](const char* file) {
    return parseOnly(runPalpate({"info", file, "--json"}, folder.path()))["files"][0];
  };
  const Json labels = info("parcels.nii.gz")["labels"];
  ASSERT_EQ(labels.size(), 125U);
  for (const Json& label : labels) EXPECT_EQ(label["voxels"], 125);
  EXPECT_FALSE(info("gray.nii.gz").contains("labels"));
}

TEST(Import, AStopLeavesNothingBehind) {
  const TempFolder folder;
  (void)writeLabels(folder, "l.nii.gz", 200,
                    [](int x, int y, int z) { return (x * y * z) % 97 == 0 ? 1 : 0; });
  std::filesystem::rename(folder.path("l.nii.gz"), folder.path("big.nii.gz"));
  // It prints a note once it has read the image, which has no unit.
  const CommandResult result = runInterrupted(
      {"import", "big.nii.gz", "--labels", "1,1", "--min-island", "3", "-o", "s.yaml"},
      folder.path(), SIGINT);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(filesIn(folder.path()), std::vector<std::string>{"big.nii.gz"});
}

struct Bad {
  std::vector<std::string> arguments;
  int exit_code;
  std::string code;
  std::string says;  // a part of the message
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.code << " " << bad.says; }

class ImportRefuses : public ::testing::TestWithParam<Bad> {};

TEST_P(ImportRefuses, WithOneErrorAndNoFile) {
  const TempFolder folder;
  writeLeg(folder);
  (void)writeLabels(folder, "gray.nii.gz", 11, [](int x, int y, int z) { return x * y * z + 0.5; });
  (void)writeLabels(folder, "zero.nii.gz", 11, [](int, int, int) { return 0; });
  (void)writeLabels(folder, "apart.nii.gz", 41, [](int x, int, int) { return x > 14 ? 1 : 0; });
  (void)folder.file("there.yaml", "palpate: 1\n");
  (void)folder.file("bad_table.yaml",
                    "palpate_tissues: 1\ntip_radius: {value: 1, basis: guessed}\n");
  for (const auto& [name, more] : std::map<std::string, std::string>{
           {"transfer.yaml",
            "stiffness_of_ct: {value: [[50, 100 N/m], [0, 60 N/m]], basis: assumed, source: x}"},
           {"transfer_0.yaml",
            "stiffness_of_ct: {value: [[50, 0 N/m]], basis: assumed, source: x}"},
           {"transfer_1.yaml", "stiffness_of_ct: {value: 100 N/m, basis: assumed, source: x}"},
           {"spring.yaml", "shaft: {value: 40 N/m, basis: assumed, source: x}"},
           {"cutting.yaml", "cutting: {value: 0.5, basis: assumed, source: x}"},
           {"static.yaml", "shaft_static: {value: 40 N/m, basis: assumed, source: x}"}}) {
    (void)folder.file(name, R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: x}
stiffest: {value: 2000 N/m, basis: assumed, source: x}
tissues:
  all:
    labels: ["*"]
    stiffness: {value: 1000 N/m, basis: assumed, source: x}
    )" + more + "\n");
  }
  (void)folder.file("no_skin.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: x}
stiffest: {value: 2000 N/m, basis: assumed, source: x}
tissues:
  bone: {labels: ["*"], stiffness: {value: 1000 N/m, basis: assumed, source: x}}
)");
  (void)folder.file("few.yaml", R"(palpate_tissues: 1
tip_radius: {value: 1 mm, basis: assumed, source: x}
stiffest: {value: 2000 N/m, basis: assumed, source: x}
tissues:
  bone: {labels: ["femur"], stiffness: {value: 1000 N/m, basis: assumed, source: x}}
)");
  const std::vector<std::string> before = filesIn(folder.path());
  std::vector<std::string> arguments = GetParam().arguments;
  arguments.insert(arguments.begin(), "import");
  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.out << result.err;
  const Json json = parseOnly(result);
  EXPECT_EQ(json["error"]["code"], GetParam().code);
  EXPECT_NE(result.out.find(GetParam().says), std::string::npos) << result.out;
  EXPECT_EQ(filesIn(folder.path()), before);
}

INSTANTIATE_TEST_SUITE_P(
    All, ImportRefuses,
    ::testing::Values(
        Bad{{}, 2, "usage.command_line", "SCAN is missing"},
        Bad{{"leg.nii.gz"}, 2, "usage.command_line", "-o SCENE.yaml is missing"},
        Bad{{"leg.nii.gz", "-o", "s.vdb"}, 2, "usage.import", "must end in .yaml"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--skin", "3"}, 2, "usage.command_line", "--image"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--image", "gray.nii.gz"},
            2,
            "usage.command_line",
            "--skin"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--image", "gray.nii.gz", "--skin", "3", "--body",
             "body.nii.gz"},
            2,
            "usage.command_line",
            "both"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--islands", "drop"},
            2,
            "usage.command_line",
            "--min-island"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--min-island", "0"},
            2,
            "usage.command_line",
            "--min-island"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--voxel", "0"}, 2, "usage.import", "--voxel"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--region", "muscle"}, 2, "usage.import", "NAME=LABELS"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--region", "outside=1"},
            2,
            "usage.import",
            "cannot be called"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--region", "a=1", "--region", "b=1-2"},
            2,
            "usage.import",
            "in the regions"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--labels", "9-3"}, 2, "usage.import", "empty"},
        Bad{{"leg.nii.gz", "-o", "there.yaml"}, 1, "output.exists", "--force"},
        Bad{{"leg.nii.gz", "-o", "no/s.yaml"}, 1, "output.no_folder", "mkdir"},
        Bad{{"none.nii.gz", "-o", "s.yaml"}, 3, "file.missing", "none.nii.gz"},
        Bad{{"names.csv", "-o", "s.yaml"}, 3, "file.unknown_kind", "names.csv"},
        Bad{{"there.yaml", "-o", "s.yaml"}, 3, "import.kind", "label image"},
        Bad{{"gray.nii.gz", "-o", "s.yaml"}, 3, "labels.not_labels", "voxel (0, 0, 0)"},
        Bad{{"zero.nii.gz", "-o", "s.yaml"}, 3, "labels.none", "all of its voxels are 0"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--labels", "7"},
            3,
            "labels.no_voxels",
            "the image holds 1, 2"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--labels", "0"}, 3, "labels.background", "--body"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--labels", "femur"}, 3, "labels.no_names", "names"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--names", "names.csv", "--labels", "fermur"},
            3,
            "labels.unknown",
            "did you mean `femur`"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--names", "names.csv", "--labels", "none"},
            3,
            "labels.no_voxels",
            "none"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--body", "zero.nii.gz"},
            3,
            "scan.empty",
            "0 everywhere"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--body", "gray.nii.gz"},
            3,
            "labels.not_labels",
            "gray.nii.gz"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--body", "apart.nii.gz"},
            3,
            "import.body",
            "lie apart"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--image", "gray.nii.gz", "--skin", "1e9"},
            3,
            "scan.empty",
            "lower threshold"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "bad_table.yaml"},
            3,
            "tissues.value",
            "1 mm"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--hounsfield"}, 2, "usage.command_line", "--image"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "transfer.yaml"},
            3,
            "tissues.transfer",
            "do not rise"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "transfer_0.yaml"},
            3,
            "tissues.transfer",
            "not a stiffness above 0"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "transfer_1.yaml"},
            3,
            "tissues.transfer",
            "list of points"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "spring.yaml"},
            3,
            "tissues.shaft",
            "shaft_spring"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "static.yaml"},
            3,
            "tissues.shaft",
            "less than its 'shaft'"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "cutting.yaml"},
            3,
            "tissues.value",
            "2.8 N"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "few.yaml"},
            3,
            "tissues.none",
            "label_1"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--strict"}, 3, "tissues.unmatched", "label_2 ("},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--tissue", "bone"}, 2, "usage.import", "LABELS=TISSUE"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--tissue", "1=bon"},
            2,
            "usage.import",
            "did you mean 'bone'"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--names", "names.csv", "--tissue", "femurr=bone"},
            2,
            "usage.import",
            "did you mean 'femur'"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--tissue-file", "names.csv"},
            3,
            "tissues.line",
            "line 1"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--tissue-file", "none.txt"},
            3,
            "file.missing",
            "none.txt"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--codes", "aal"}, 2, "usage.command_line", "--codes"},
        Bad{{"leg.nii.gz", "-o", "s.yaml", "--materials", "no_skin.yaml", "--body", "body.nii.gz"},
            3,
            "tissues.missing",
            "skin"}));

}  // namespace
}  // namespace palpate::testing
