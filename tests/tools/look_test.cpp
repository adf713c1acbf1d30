// palpate info, query, explain and render: their output for known inputs.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "tools/helpers.h"
#include "tools/png_pixels.h"
#include "vdb/nifti_writer.h"

namespace palpate::testing {
namespace {

Json jsonOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = arguments;
  all.emplace_back("--json");
  const CommandResult result = runPalpate(all);
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  return parseOnly(result);
}

TEST(Info, AnImageWithItsPlaceInSpace) {
  const TempFolder folder;
  vdb::test::NiftiFile image;  // 4 x 5 x 6, 2 mm, origin (-3, -4, -5) mm
  const auto bytes = vdb::test::bytesOf(image);
  const std::string file =
      folder.file("i.nii", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  Json json = jsonOf({"info", file});
  EXPECT_EQ(json["schema"], "palpate.info/1");
  Json one = json["files"][0];
  EXPECT_EQ(one["kind"], "image");
  EXPECT_EQ(one["size"], Json::array({4, 5, 6}));
  EXPECT_EQ(one["orientation"], "RAS");
  EXPECT_NEAR(one["spacing_m"][0], 0.002, 1e-9);
  EXPECT_NEAR(one["origin_m"][2], -0.005, 1e-9);
  EXPECT_NEAR(one["bounds_m"]["hi"][0], 0.003, 1e-9);  // center of the last voxel: -3 + 3 * 2
  EXPECT_NE(runPalpate({"info", file}).out.find("right, front, up"), std::string::npos);
}

TEST(Info, AMeshWithItsHoles) {
  const TempFolder folder;
  const std::string file =
      folder.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  Json one = jsonOf({"info", file, "--units", "cm"})["files"][0];
  EXPECT_EQ(one["kind"], "mesh");
  EXPECT_EQ(one["triangles"], 3);
  EXPECT_EQ(one["closed"], false);
  EXPECT_EQ(one["boundary_edges"], 3);
  EXPECT_NEAR(one["bounds_m"]["hi"][0], 0.01, 1e-12);
}

TEST(Info, SeveralFilesInOneObject) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  Json json = jsonOf({"info", scene, scenePath("valve_tube.yaml")});
  ASSERT_EQ(json["files"].size(), 2U);
  EXPECT_EQ(json["files"][0]["layers"][0]["name"], "liquid");
  EXPECT_EQ(json["files"][0]["ports"][0]["name"], "mouth");
  EXPECT_EQ(json["files"][1]["layers"].size(), 2U);
}

TEST(Query, ASceneAtPointsInItsOwnUnit) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  Json json = jsonOf({"query", scene, "--at", "0,0,13", "0,0,16"});
  EXPECT_EQ(json["schema"], "palpate.query/1");
  EXPECT_EQ(json["length_unit"], "mm");
  ASSERT_EQ(json["points"].size(), 2U);
  Json inside = json["points"][0];
  EXPECT_EQ(inside["region"], "liquid");
  EXPECT_EQ(inside["content"]["name"], "syrup");
  EXPECT_EQ(inside["wall"]["stiffness_N_per_m"], 1500.0);
  ASSERT_EQ(inside["fields"].size(), 1U);
  EXPECT_NEAR(inside["fields"][0]["value"], -2.0, 1e-12);  // 2 mm below the brim
  EXPECT_NEAR(inside["fields"][0]["gradient"][2], 1.0, 1e-12);
  EXPECT_EQ(json["points"][1]["region"], "outside");
  EXPECT_TRUE(json["points"][1]["content"].is_null());

  Json bowl = jsonOf({"query", scene, "--at", "0,0,13", "--field", "bowl"});
  ASSERT_EQ(bowl["points"][0]["fields"].size(), 1U);
  EXPECT_NEAR(bowl["points"][0]["fields"][0]["value"], 13.0 - 40.0, 1e-12);
  EXPECT_EQ(bowl["points"][0]["fields"][0]["metric"], "exact");
}

TEST(Query, PointsFromAFile) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  const std::string points = folder.file("p.csv", "x,y,z\r\n0,0,13\r\n\r\n0, 0, 16\r\n");
  Json json = jsonOf({"query", scene, "--points", points});
  ASSERT_EQ(json["points"].size(), 2U);
  EXPECT_EQ(json["points"][1]["region"], "outside");
}

TEST(Query, AnImageBetweenItsVoxels) {
  const TempFolder folder;
  vdb::test::NiftiFile image;
  image.values.assign(4 * 5 * 6, 0.0);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = 10.0 * static_cast<double>(i % 4);
  const auto bytes = vdb::test::bytesOf(image);
  const std::string file =
      folder.file("i.nii", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  // x starts at -3 mm in steps of 2 mm, each 10 brighter: at -0.5 mm the value is 12.5.
  const CommandResult result = runPalpate({"query", file, "--at", "-0.5,0,0", "40,0,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json json = parseOnly(result);
  EXPECT_NEAR(json["points"][0]["value"], 12.5, 1e-5);
  EXPECT_TRUE(json["points"][1]["value"].is_null());
  EXPECT_NE(result.err.find("1 of 2 points lie outside"), std::string::npos) << result.err;
}

TEST(Explain, TheContainer) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  Json json = jsonOf({"explain", scene});
  EXPECT_EQ(json["schema"], "palpate.explain/1");
  EXPECT_EQ(json["start"], "outside");
  ASSERT_EQ(json["regions"].size(), 2U);
  EXPECT_EQ(json["regions"][1]["name"], "liquid");
  EXPECT_EQ(json["regions"][1]["reachable"], true);
  ASSERT_EQ(json["walls"].size(), 1U);
  EXPECT_EQ(json["walls"][0]["from_first"]["material"]["name"], "glass");
  ASSERT_EQ(json["transitions"].size(), 2U);
  EXPECT_EQ(json["transitions"][0]["from"], "outside");
  EXPECT_EQ(json["transitions"][0]["port"], "mouth");
  EXPECT_EQ(json["transitions"][0]["to"], "liquid");
  EXPECT_EQ(json["transitions"][0]["conditions"], Json::array({"on brim"}));
}

TEST(Explain, AValveHasNoTransitionBack) {
  Json json = jsonOf({"explain", scenePath("valve_tube.yaml")});
  std::vector<std::string> moves;
  for (const Json& t : json["transitions"]) {
    moves.push_back(t["from"].get<std::string>() + ">" + t["to"].get<std::string>());
  }
  EXPECT_EQ(moves, (std::vector<std::string>{"outside>upstream", "upstream>downstream",
                                             "downstream>outside"}));
  EXPECT_EQ(json["transitions"][1]["conditions"], Json::array({"on leaflets", "after inlet"}));
}

// The table of transitions as a picture: a node for each region, an arrow for each row.
TEST(Explain, DrawsItsTable) {
  const TempFolder folder;
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++found;
    }
    return found;
  };
  for (const char* name : {"composite_tube", "cup", "valve_tube", "csg"}) {
    const std::string file = folder.path(std::string(name) + ".svg");
    Json json = jsonOf({"explain", scenePath(std::string(name) + ".yaml"), "--svg", file});
    EXPECT_EQ(json["svg"], file);
    const std::string svg = textOf(file);
    EXPECT_EQ(count(svg, "marker-end"), static_cast<int>(json["transitions"].size())) << name;
    EXPECT_EQ(count(svg, " rx='10'"), static_cast<int>(json["regions"].size())) << name;
    for (const Json& region : json["regions"]) {
      EXPECT_GE(count(svg, ">" + region["name"].get<std::string>() + "<"), 1) << name;
    }
    for (const Json& t : json["transitions"]) {
      const std::string label = t["port"].is_null() ? "no wall" : t["port"].get<std::string>();
      EXPECT_GE(count(svg, ">" + label + "<"), 1) << name;
      for (const Json& condition : t["conditions"]) {
        EXPECT_GE(count(svg, ">" + condition.get<std::string>() + "<"), 1) << name;
      }
    }
  }
  const CommandResult again = runPalpate(
      {"explain", scenePath("cup.yaml"), "--svg", folder.path("cup.svg")}, folder.path());
  EXPECT_EQ(again.exit_code, 1) << "nothing is overwritten unasked";
}

TEST(Explain, WhatIsLeftOutIsNamedWithTheReasonAndTheSaving) {
  const TempFolder folder;
  (void)folder.file("a.obj",
                    "v 10 0 0\nv -10 0 0\nv 0 10 0\nv 0 -10 0\nv 0 0 10\nv 0 0 -10\n"
                    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  const std::string scene = folder.file("s.yaml", R"(palpate: 1
length: mm
device: {workspace: {box: {center: [0, 0, 0], size: [60, 60, 60]}}}
fields:
  near: {mesh: {file: a.obj, voxel: 0.5}}
  far: {mesh: {file: a.obj, units: cm, voxel: 0.5}}
layers:
  - {name: near, inside: near}
  - {name: inner, inside: {mesh: {file: a.obj, units: mm, voxel: 0.5}}}
  - {name: far, inside: {transform: {field: {sphere: {center: [0, 0, 0], radius: 5}}, translate: [500, 0, 0]}}}
)");
  Json json = jsonOf({"explain", scene});
  EXPECT_EQ(json["device"]["reach"][1], Json::array({30.0, 30.0, 30.0}));
  EXPECT_TRUE(json["regions"][3]["left_out"].is_null()) << "a formula costs nothing";
  for (const Json& source : json["sources"]) {
    EXPECT_EQ(source["made"], source["name"] != "far") << source;
  }
  const std::string moved = folder.file("m.yaml", R"(palpate: 1
length: mm
device: {offset: [300, 0, 0], workspace: {sphere: {center: [0, 0, 0], radius: 20}}}
layers:
  - {name: near, inside: {mesh: {file: a.obj, voxel: 0.5}}}
  - {name: here, inside: {sphere: {center: [300, 0, 0], radius: 5}}}
)");
  json = jsonOf({"explain", moved});
  EXPECT_EQ(json["regions"][1]["left_out"], "it lies outside the device's workspace");
  EXPECT_EQ(json["sources"][0]["made"], false);
  EXPECT_EQ(json["sources"][0]["why_not"], "it lies outside the device's workspace");
  EXPECT_TRUE(json["saved_estimate"].is_null()) << "no grid was made that tells what one costs";
  const std::string text = runPalpate({"explain", moved}).out;
  EXPECT_NE(text.find("The device reaches from (280, -20, -20) to (320, 20, 20)"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("no: it lies outside the device's workspace"), std::string::npos) << text;
}

TEST(Explain, MeasuresWhatTheWorkspaceSaves) {
  const TempFolder folder;
  // A device like a needle's tip, at the top of a ball of 60 mm.
  const std::string scene = folder.file("s.yaml", R"(palpate: 1
length: mm
device: {offset: [0, 0, 30], workspace: {box: {center: [0, 0, 0], size: [20, 20, 20]}}}
layers:
  - {name: ball, inside: {baked: {field: {sphere: {center: [0, 0, 0], radius: 30}}, voxel: 0.5, parts: whole}}}
  - {name: far, inside: {baked: {field: {sphere: {center: [0, 0, -60], radius: 20}}, voxel: 0.5, parts: whole}}}
)");
  const Json json = jsonOf({"explain", scene, "--measure"});
  EXPECT_EQ(json["sources"][0]["only_in_reach"], true);
  EXPECT_EQ(json["sources"][0]["made"], true);
  EXPECT_EQ(json["sources"][1]["made"], false);
  const double whole = json["measured"]["whole"]["memory_bytes"].get<double>();
  const double needed = json["measured"]["needed"]["memory_bytes"].get<double>();
  EXPECT_GT(needed, 0.0);
  // A cap of 23.5 mm of the larger ball (its area is 11310 mm^2, the other's 5027): less than 2000
  // mm^2.
  EXPECT_LT(needed, 0.2 * whole);
  EXPECT_GT(json["measured"]["needed"]["seconds"].get<double>(), 0.0);
  EXPECT_TRUE(jsonOf({"explain", scene})["measured"].is_null());
}

TEST(Explain, SheetsAndTheirMaterials) {
  Json json = jsonOf({"explain", scenePath("flag.yaml")});
  ASSERT_EQ(json["sheets"].size(), 2U);
  EXPECT_EQ(json["sheets"][0]["name"], "flag");
  EXPECT_EQ(json["sheets"][0]["where"], true);
  Json canvas = json["sheets"][0]["wall"]["material"];
  EXPECT_EQ(canvas["name"], "canvas");
  EXPECT_NEAR(canvas["texture"]["amplitude_m"], 1e-4, 1e-15);
  EXPECT_NEAR(canvas["texture"]["wavelength_m"], 2e-3, 1e-15);
  const std::string text = runPalpate({"explain", scenePath("flag.yaml")}).out;
  EXPECT_NE(text.find("flag      canvas (600 N/m)"), std::string::npos) << text;
  Json info = jsonOf({"info", scenePath("flag.yaml")})["files"][0];
  ASSERT_EQ(info["sheets"].size(), 2U);
  EXPECT_EQ(info["sheets"][1]["name"], "membrane");
  EXPECT_EQ(info["sheets"][1]["wall"], "skin");
}

// Whatever the fields are made from, explain, info, query and render accept every shipped analytic
// scene.
TEST(EveryVerb, TakesTheShippedScenes) {
  for (const char* name : {"container", "csg_part", "valve_tube", "fields", "sponge", "flag",
                           "composite_tube", "cup", "metaballs", "heart", "csg"}) {
    const TempFolder folder;
    const std::string scene = scenePath(std::string(name) + ".yaml");
    EXPECT_GE(jsonOf({"explain", scene})["regions"].size(), 2U) << name;
    EXPECT_EQ(jsonOf({"info", scene})["files"][0]["kind"], "scene") << name;
    EXPECT_EQ(jsonOf({"query", scene, "--at", "0,0,14"})["points"].size(), 1U) << name;
    const CommandResult drawn = runPalpate(
        {"render", scene, "-o", "s.png", "--plane", "y=0", "--size", "480x360"}, folder.path());
    EXPECT_EQ(drawn.exit_code, 0) << name << drawn.err;
  }
}

TEST(Explain, WhatCannotBeEnteredIsNamedWithTheReason) {
  const TempFolder folder;
  const std::string scene = folder.file("s.yaml", R"(palpate: 1
length: mm
fields:
  a: {sphere: {center: [0, 0, 0], radius: 20}}
  b: {sphere: {center: [0, 0, 0], radius: 10}}
layers:
  - {name: shell, inside: a}
  - {name: core, inside: b}
ports:
  - {name: hole, between: [outside, shell]}
)");
  Json json = jsonOf({"explain", scene});
  EXPECT_EQ(json["regions"][1]["reachable"], true);
  EXPECT_EQ(json["regions"][2]["reachable"], false);
  EXPECT_EQ(json["regions"][2]["why_unreachable"], "no port leads into it");
  const std::string text = runPalpate({"explain", scene}).out;
  EXPECT_NE(text.find("core: no port leads into it"), std::string::npos) << text;
}

TEST(Explain, WhatIsNeitherShownNorRefutedIsUndecided) {
  // A port whose extent contains no part of its wall, as far as sampling shows.
  const TempFolder folder;
  const std::string scene = folder.file("s.yaml", R"(palpate: 1
length: mm
fields:
  far: {sphere: {center: [0, 0, 90], radius: 5}}
layers:
  - {name: shell, inside: {sphere: {center: [0, 0, 0], radius: 40}}}
  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 20}}}
ports:
  - {name: gate, between: [outside, shell], where: far}
)");
  const Json json = jsonOf({"explain", scene});
  const std::vector<std::string> expected = {"yes", "undecided", "no"};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(json["regions"][i]["reach"], expected[i]) << i;
  }
  EXPECT_EQ(json["regions"][1]["reachable"], true) << "it is made as if it could be entered";
  EXPECT_EQ(json["ports"][0]["reach"], "undecided");
  const std::string text = runPalpate({"explain", scene}).out;
  EXPECT_NE(text.find("default wall (1000 N/m)  undecided"), std::string::npos) << text;
}

std::uint32_t bigEndian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

TEST(Render, APictureOfTheSizeAskedFor) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  const std::string out = folder.path("p.png");
  Json json = jsonOf({"render", scene, "-o", out, "--size", "640x400", "--plane", "x=5"});
  EXPECT_EQ(json["schema"], "palpate.render/1");
  EXPECT_EQ(json["plane"]["normal"], Json::array({1.0, 0.0, 0.0}));
  EXPECT_NEAR(json["plane"]["point_m"][0], 0.005, 1e-12);
  const std::string png = textOf(out);
  ASSERT_GT(png.size(), 2000U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(bigEndian(png, 16), 640U);
  EXPECT_EQ(bigEndian(png, 20), 400U);

  EXPECT_EQ(runPalpate({"render", scene, "-o", out}).exit_code, 1);  // it exists
  EXPECT_EQ(textOf(out), png);
}

TEST(Render, ManyRegionsWithLongNamesCanBeToldApart) {
  const TempFolder folder;
  std::string scene = "palpate: 1\nlength: mm\nlayers:\n";
  constexpr int kRegions = 28;
  for (int n = 0; n < kRegions; ++n) {
    const std::string x = std::to_string(10 * n % 140);
    const std::string y = std::to_string(n / 14 * 30);
    scene += "  - {name: " + std::string(n % 2 == 0 ? "" : "musculus_with_a_name_as_long_as_") +
             "region_" + std::to_string(n) + ", inside: {box: {center: [" + x + ", " + y +
             ", 0], size: [8, 20, 20]}}}\n";
  }
  (void)folder.file("many.yaml", scene);
  const CommandResult drawn =
      runPalpate({"render", "many.yaml", "-o", "p.png", "--plane", "z=0"}, folder.path());
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const Pixels pixels = pixelsOf(textOf(folder.path("p.png")));
  std::map<std::array<std::uint8_t, 3>, int> count;
  for (const auto& color : pixels.colors) ++count[color];
  const auto wide =
      std::count_if(count.begin(), count.end(), [](const auto& c) { return c.second > 400; });
  EXPECT_GE(wide, kRegions);
  // The legend does not touch the edge.
  for (std::size_t y = 0; y < pixels.height; ++y) {
    for (std::size_t x = pixels.width - 6; x < pixels.width; ++x) {
      ASSERT_EQ(pixels.at(x, y), (std::array<std::uint8_t, 3>{255, 255, 255})) << x << " " << y;
    }
  }
}

TEST(Render, SheetsStandInSpace) {
  // A plate without thickness above a slab, behind the cut: the section does not meet it.
  const auto scene = [](const std::string& sheets) {
    return "palpate: 1\nlength: mm\nfields:\n"
           "  plate: {half_space: {point: [0, 20, 0], normal: [0, 1, 0]}}\n"
           "  around: {sphere: {center: [0, 20, 20], radius: 12}}\n"
           "materials: {skin: {stiffness: 100 N/m}}\n"
           "layers:\n"
           "  - {name: slab, inside: {box: {center: [0, 0, -10], size: [80, 80, 10]}}}\n"
           "  - {name: post, inside: {box: {center: [38, 38, 20], size: [2, 2, 50]}}}\n" +
           sheets;
  };
  const TempFolder folder;
  const auto drawn = [&](const std::string& name, const std::string& sheets) {
    (void)folder.file(name + ".yaml", scene(sheets));
    const CommandResult result = runPalpate(
        {"render", name + ".yaml", "-o", name + ".png", "--plane", "y=-10", "--size", "800x500"},
        folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return pixelsOf(textOf(folder.path(name + ".png")));
  };
  const Pixels without = drawn("s", "");
  const Pixels with = drawn("t", "sheets: [{name: flag, on: plate, where: around, wall: skin}]\n");
  ASSERT_EQ(with.width, 800U);
  ASSERT_EQ(with.colors.size(), without.colors.size());
  std::size_t changed = 0;
  std::size_t lo_x = with.width, hi_x = 0, lo_y = with.height, hi_y = 0;
  // Below the titles, which contain the file's name. Rays go on in other steps where there is a
  // sheet, so edges of the slab and the post may be found a fraction of a pixel elsewhere: single
  // pixels do not count, and nothing at the post does.
  for (std::size_t y = 60; y < with.height; ++y) {
    for (std::size_t x = 0; x < with.width - 50; ++x) {
      // A larger difference than an error of the place of a surface along its ray would make.
      const auto differs = [&](std::size_t at) {
        return std::abs(with.at(at, y)[0] - without.at(at, y)[0]) >= 40;
      };
      if (!differs(x) || x == 0 || (!differs(x - 1) && !differs(x + 1))) continue;
      ++changed;
      lo_x = std::min(lo_x, x);
      hi_x = std::max(hi_x, x);
      lo_y = std::min(lo_y, y);
      hi_y = std::max(hi_y, y);
    }
  }
  // A disk of 24 mm, seen from 35 degrees to the side and 24 degrees above: an ellipse that fills
  // three quarters of its box. It must lie in the right part, where the view in space is.
  ASSERT_GT(changed, 1000U);
  EXPECT_GT(lo_x, 500U);
  const double width = static_cast<double>(hi_x - lo_x + 1);
  const double height = static_cast<double>(hi_y - lo_y + 1);
  EXPECT_NEAR(width / height, 0.86, 0.1);
  EXPECT_NEAR(static_cast<double>(changed) / (width * height), 0.77, 0.06);
}

TEST(Render, CutsAlongTheTrace) {
  const TempFolder folder;
  const std::string scene = folder.file("c.yaml", kContainer);
  const std::string trace = folder.path("t.csv");
  // A path in the plane x = 7 mm, not along an axis.
  ASSERT_EQ(
      runPalpate({"touch", scene, "--insert", "7,-10,30", "7,0,0", "7,10,10", "--trace", trace})
          .exit_code,
      0);
  Json json = jsonOf({"render", scene, "-o", folder.path("p.png"), "--trace", trace});
  EXPECT_NEAR(std::abs(json["plane"]["normal"][0].get<double>()), 1.0, 1e-9);
  EXPECT_NEAR(json["plane"]["point_m"][0], 0.007, 1e-9);
}

TEST(Render, AnyPlaneAndScenesWithoutEdges) {
  const TempFolder folder;
  const std::string endless = folder.file("h.yaml", R"(palpate: 1
length: mm
fields:
  h: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
layers:
  - {name: ground, inside: h}
)");
  Json json = jsonOf({"render", endless, "-o", folder.path("h.png"), "--cut", "0,0,0,1,1,0.5"});
  Json n = json["plane"]["normal"];
  EXPECT_NEAR(n[0].get<double>(), 1.0 / 1.5, 1e-9);
  EXPECT_NEAR(n[2].get<double>(), 0.5 / 1.5, 1e-9);
}

}  // namespace
}  // namespace palpate::testing
