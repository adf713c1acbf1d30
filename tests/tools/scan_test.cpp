// Scans of all formats through the verbs: the output of info, names and colors from tables, and
// options for facts that files do not state.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/scan_folder.h"
#include "tools/helpers.h"
#include "tools/png_pixels.h"

namespace palpate::testing {
namespace {

/// 12^3 voxels of 1 mm, two blocks that touch, as a .seg.nrrd with names and colors.
std::string segmentation(const std::string& more = "") {
  std::string text =
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: 12 12 "
      "12\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\nkinds: domain domain domain\nencoding: raw\n"
      "space origin: (-5.5,-5.5,-5.5)\n" +
      more +
      "Segment0_Name:=left part\nSegment0_LabelValue:=4\nSegment0_Color:=0.2 0.4 0.8\n"
      "Segment1_Name:=right part\nSegment1_LabelValue:=7\nSegment1_Color:=0.8 0.2 0.2\n"
      "Segment2_Name:=nowhere\nSegment2_LabelValue:=9\n\n";
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 12; ++i) {
        const bool inside = std::min({i, j, k}) >= 2 && std::max({i, j, k}) <= 9;
        // i runs to the left.
        text += static_cast<char>(!inside ? 0 : i < 6 ? 7 : 4);
      }
    }
  }
  return text;
}

Json infoOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {"info", "--json"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const CommandResult result = runPalpate(all);
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result)["files"][0];
}

TEST(Scan, InfoTellsPlaceUnitAndLabelsWithTheirVoxels) {
  const TempFolder folder;
  const std::string file = folder.file("s.seg.nrrd", segmentation());
  const Json one = infoOf({file});
  EXPECT_EQ(one["format"], "NRRD segmentation");
  EXPECT_EQ(one["length_unit"], "mm");
  EXPECT_EQ(one["orientation"], "LPS");
  EXPECT_NEAR(one["axes_m"][0][0], -0.001, 1e-12);
  EXPECT_NEAR(one["origin_m"][0], 0.0055, 1e-12);
  ASSERT_EQ(one["labels"].size(), 4U);
  EXPECT_EQ(one["labels"][0]["voxels"], 12 * 12 * 12 - 512);
  const Json left = {{"value", 4}, {"name", "left part"}, {"voxels", 256}, {"color", "#3366CC"}};
  EXPECT_EQ(one["labels"][1], left);
  EXPECT_EQ(one["labels"][3]["voxels"], 0);
  const std::string text = runPalpate({"info", file}).out;
  for (const std::string says : {"right part", "256", "#CC3333", "1 more names have no voxels",
                                 "lengths in mm", "left, back, up", "affine"}) {
    EXPECT_NE(text.find(says), std::string::npos) << says << "\n" << text;
  }
  // Another table replaces the file's own.
  const std::string table = folder.file("t.txt", "4 other 10 20 30 255\n");
  EXPECT_EQ(infoOf({file, "--names", table})["labels"][1]["name"], "other");
}

TEST(Scan, AFolderOfSlicesIsAnImageAndAnyOtherIsNone) {
  const std::string data = scanPath("dicom_cthead");
  PALPATE_NEEDS_SCAN(data);
  const Json one = infoOf({data});
  EXPECT_EQ(one["size"], Json::array({64, 64, 93}));
  EXPECT_NEAR(one["spacing_m"][2], 0.0015, 1e-9);
  const CommandResult query = runPalpate({"query", data, "--at", "0,0,0", "--json"});
  EXPECT_EQ(query.exit_code, 0) << query.err;
  const TempFolder empty;
  const CommandResult refused = runPalpate({"info", empty.path()});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("holds no DICOM images"), std::string::npos) << refused.err;
}

TEST(Scan, SegmentsAreBakedByTheirNames) {
  const TempFolder folder;
  (void)folder.file("s.seg.nrrd", segmentation());
  const CommandResult baked = runPalpate(
      {"bake", "s.seg.nrrd", "-o", "s.vdb", "--labels", "* part", "--json"}, folder.path());
  ASSERT_EQ(baked.exit_code, 0) << baked.err;
  const Json grids = infoOf({folder.path("s.vdb")})["grids"];
  ASSERT_EQ(grids.size(), 3U);
  EXPECT_EQ(grids[0]["name"], "left part/surface");
  EXPECT_EQ(grids[2]["name"], "united") << "they touch";
  // Left is at negative x in RAS: indices 6 to 9, plus half a voxel on each side.
  const Json ask = parseOnly(
      runPalpate({"convert", "s.vdb", "-o", "left.stl", "--layer", "left part/surface", "--json"},
                 folder.path()));
  EXPECT_NEAR(ask["bounds_m"]["lo"][0], -0.004, 3e-4);
  EXPECT_NEAR(ask["bounds_m"]["hi"][0], 0.0, 3e-4);
}

// Voxels of 5 mm cannot hold a plate of 1 mm beside a block: every verb that makes the scene's
// grids says so, with the place.
TEST(Scan, WhatAScenesGridsLoseIsTold) {
  const TempFolder folder;
  std::string voxels = segmentation();
  const std::size_t data = voxels.size() - std::size_t{12} * 12 * 12;
  for (std::size_t n = 0; n < std::size_t{12} * 12 * 12; ++n) {
    // The plate is half-way between two planes of voxels.
    const std::size_t i = n % 12, j = n / 12 % 12, k = n / 144;
    const bool inside = (i == 3 || i >= 7) && j >= 2 && j < 10 && k >= 2 && k < 10;
    voxels[data + n] = inside ? 7 : 0;
  }
  (void)folder.file("s.seg.nrrd", voxels);
  const auto scene = [&](const char* voxel) {
    return folder.file("scene.yaml",
                       std::string("palpate: 1\nlength: mm\nimages: {s: {file: s.seg.nrrd}}\n"
                                   "layers:\n  - {name: block, labels: {image: s, match: [7], "
                                   "voxel: ") +
                           voxel + "}}\n");
  };
  const std::string coarse = scene("5");
  const CommandResult checked = runPalpate({"check", coarse, "--json"});
  ASSERT_EQ(checked.exit_code, 0) << checked.err << checked.out;
  const Json file = parseOnly(checked)["files"][0];
  EXPECT_EQ(file["kind"], "scene");
  EXPECT_EQ(file["layers"], 1);
  ASSERT_EQ(file["findings"].size(), 1U) << file;
  const Json& finding = file["findings"][0];
  EXPECT_EQ(finding["code"], "scene.scan_loss");
  EXPECT_GT(finding["count"], 5);
  ASSERT_TRUE(finding["place_m"].is_array());
  for (const Json& at : finding["place_m"]) EXPECT_LT(std::abs(at.get<double>()), 7e-3);
  const Json grid = file["grids"][0];
  EXPECT_EQ(grid["lost_voxels"].get<int>() + grid["filled_voxels"].get<int>(), finding["count"]);
  EXPECT_EQ(grid["lost_at_m"], finding["place_m"]);
  const std::string told = runPalpate({"check", coarse}).out;
  EXPECT_NE(told.find("of the scan"), std::string::npos);
  EXPECT_NE(told.find("labels of s: "), std::string::npos) << told;
  ASSERT_EQ(file["label_centers"].size(), 1U) << file;
  const Json& centers = file["label_centers"][0];
  EXPECT_EQ(centers["image"], "s");
  // The block of 5 x 8 x 8, the plate of 64, and what lies beside them.
  EXPECT_EQ(centers["layers"][1]["layer"], "block");
  EXPECT_EQ(centers["layers"][1]["centers"], 5 * 64 + 64);
  EXPECT_GT(centers["changed"], 5) << "much of the plate is lost";

  const CommandResult drawn = runPalpate(
      {"render", coarse, "-o", folder.path("p.png"), "--plane", "z=0", "--size", "640x400"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(drawn.out.find("of the scan"), std::string::npos) << drawn.out;
  const CommandResult touched =
      runPalpate({"touch", coarse, "--insert", "9,0,0", "5,0,0", "--json"});
  ASSERT_EQ(touched.exit_code, 0) << touched.err;
  EXPECT_EQ(parseOnly(touched)["grids"][0]["lost_voxels"], grid["lost_voxels"]);

  const CommandResult fine = runPalpate({"check", scene("1"), "--json"});
  const Json whole = parseOnly(fine)["files"][0];
  // Four voxels at the plate's corners, which are rounded off.
  EXPECT_LE(whole["grids"][0]["lost_voxels"], 4) << whole;
  EXPECT_LE(whole["label_centers"][0]["changed"], 4) << whole;
  EXPECT_EQ(whole["label_centers"][0]["against_neighbors"], 0) << whole;
  EXPECT_TRUE(whole["label_centers"][0]["against_at_m"].is_null()) << whole;
}

TEST(Scan, PicturesHaveTheColorsOfTheTable) {
  const TempFolder folder;
  (void)folder.file("s.seg.nrrd", segmentation());
  const std::string scene =
      folder.file("scene.yaml",
                  "palpate: 1\nlength: mm\nimages: {s: {file: s.seg.nrrd}}\nlayers:\n"
                  "  - {name: blue, labels: {image: s, match: [\"left part\"]}}\n"
                  "  - {name: red, labels: {image: s, match: [7]}}\n");
  const CommandResult drawn = runPalpate(
      {"render", scene, "-o", folder.path("p.png"), "--plane", "z=0", "--size", "640x400"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Pixels pixels = pixelsOf(textOf(folder.path("p.png")));
  constexpr std::array<std::uint8_t, 3> kBlue = {0x33, 0x66, 0xCC};
  constexpr std::array<std::uint8_t, 3> kRed = {0xCC, 0x33, 0x33};
  const auto blue = std::count(pixels.colors.begin(), pixels.colors.end(), kBlue);
  const auto red = std::count(pixels.colors.begin(), pixels.colors.end(), kRed);
  EXPECT_GT(blue, 1000);
  EXPECT_GT(red, 1000);
}

TEST(Scan, WhatFilesLeaveOpenIsSaidByOptionsAndKeys) {
  const TempFolder folder;
  std::string bare = segmentation();
  const auto cut = [&](const std::string& from, const std::string& to) {
    const std::size_t at = bare.find(from);
    bare.erase(at, bare.find(to) - at);
  };
  cut("space: ", "sizes");
  cut("space directions", "kinds");
  cut("space origin", "Segment0_Name");
  bare.insert(bare.find("kinds"), "spacings: 1 1 2\n");
  (void)folder.file("bare.nrrd", bare);
  const CommandResult refused = runPalpate({"info", "bare.nrrd"}, folder.path());
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("--affine spacing"), std::string::npos) << refused.err;
  const CommandResult read =
      runPalpate({"info", "bare.nrrd", "--affine", "spacing", "--json"}, folder.path());
  EXPECT_EQ(parseOnly(read)["files"][0]["orientation"], "RAS");

  const auto scene = [&](const std::string& keys) {
    const std::string text = "palpate: 1\nlength: mm\nimages: {s: {file: bare.nrrd" + keys +
                             "}}\nlayers:\n  - {name: a, threshold: {image: s, above: 3}}\n";
    return runPalpate({"explain", folder.file("scene.yaml", text)});
  };
  EXPECT_EQ(scene(", affine: spacing").exit_code, 0);
  for (const std::string& keys :
       {std::string(), std::string(", affine: best"), std::string(", affine: spacing, space: up"),
        std::string(", affine: spacing, frame: -1"), std::string(", affine: spacing, frame: 0.5"),
        std::string(", affine: qform"), std::string(", affine: spacing, series: 1.2")}) {
    const CommandResult wrong = scene(keys);
    EXPECT_EQ(wrong.exit_code, 3) << keys;
    EXPECT_NE(wrong.err.find("scene.yaml:3"), std::string::npos) << wrong.err;
  }
}

TEST(Scan, MeshesSayTheirSpaceOrAreTold) {
  const TempFolder folder;
  const std::string triangle = "POINTS 3 float\n0 0 0 1 2 3 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n";
  const std::string plain =
      folder.file("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n" + triangle);
  const std::string slicer = folder.file(
      "b.vtk", "# vtk DataFile Version 3.0\nSPACE=LPS\nASCII\nDATASET POLYDATA\n" + triangle);
  EXPECT_EQ(infoOf({plain})["space"], "RAS");
  EXPECT_NEAR(infoOf({plain, "--space", "LPS"})["bounds_m"]["lo"][1], -0.002, 1e-12);
  EXPECT_NEAR(infoOf({slicer})["bounds_m"]["lo"][1], -0.002, 1e-12);
  EXPECT_EQ(infoOf({slicer})["space_stated"], true);
  EXPECT_NE(runPalpate({"info", plain}).err.find("--space changes that"), std::string::npos);
  EXPECT_NE(runPalpate({"info", slicer}).out.find("LPS, as the file says"), std::string::npos);
  EXPECT_EQ(runPalpate({"info", plain, "--frame", "1"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"info", plain, "--space", "up"}).exit_code, 2);
}

}  // namespace
}  // namespace palpate::testing
