// `palpate bench contact`: errors within bounds on scenes whose truth is known, and well-formed
// files. Times are printed, never asserted.

#include <iterator>
#include <map>
#include <sstream>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

const Json& resultOf(const Json& report, const std::string& scene, const std::string& renderer) {
  for (const Json& row : report["results"]) {
    if (row["scene"] == scene && row["renderer"] == renderer) return row;
  }
  static const Json none = Json::object();
  ADD_FAILURE() << "no result for " << scene << ", " << renderer;
  return none;
}

/// A single run along the path, unless the arguments say otherwise.
std::vector<std::string> quickBench(std::vector<std::string> more) {
  std::vector<std::string> all = {"bench",   "contact", "--repeat", "1",
                                  "--paced", "0",       "--cold",   "0"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// The table's row of that scene, split at spaces.
std::vector<std::string> textRow(const std::string& text, const std::string& heading,
                                 const std::string& scene, const std::string& renderer) {
  bool is_here = false;
  for (const std::string& line : linesOf(text)) {
    std::istringstream in(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
    if (line.find(heading) != std::string::npos) is_here = true;
    if (is_here && words.size() > 2 && words[0] == scene && words[1] == renderer) return words;
  }
  ADD_FAILURE() << "no row for " << scene << ", " << renderer << " under " << heading << " in\n"
                << text;
  return std::vector<std::string>(20);
}

TEST(Bench, NamesTheMachineAndJudgesTheSphere) {
  const CommandResult result = runPalpate(quickBench({"--scene", "sphere", "--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = parseOnly(result);
  EXPECT_EQ(report["schema"], "palpate.bench/1");
  for (const char* key : {"cpu", "compiler", "system"}) {
    EXPECT_TRUE(report["machine"][key].is_string() && report["machine"][key] != "") << key;
  }
  EXPECT_EQ(report["results"].size(), 2U);

  // Ten rounds at 0.2 m/s, 49 mm from the center: 2 pi 49 mm / 0.2 mm a round.
  const Json& good = resultOf(report, "sphere", "constraint");
  EXPECT_EQ(good["ticks"], 15394);
  EXPECT_EQ(good["judged"], 15394);
  EXPECT_EQ(good["missed"], 0);
  // Analytic contact has to be exact to 1e-6 degree and 1e-6 of the magnitude; the true turn is
  // 0.244 degree.
  EXPECT_LE(good["direction_error_degrees"]["max"].get<double>(), 1e-6);
  EXPECT_LE(good["magnitude_error"]["max"].get<double>(), 1e-6);
  EXPECT_LE(good["largest_turn_degrees"].get<double>(), 0.245);
  EXPECT_NEAR(good["true_largest_turn_degrees"].get<double>(), 0.244, 0.0005);
  EXPECT_NEAR(good["largest_step_N"].get<double>(), good["true_largest_step_N"].get<double>(),
              1e-9);
  const Json& ns = good["tick_ns"];
  EXPECT_LE(ns["median"].get<double>(), ns["p99"].get<double>());
  EXPECT_LE(ns["p99"].get<double>(), ns["p99.9"].get<double>());
  EXPECT_LE(ns["p99.9"].get<double>(), ns["max"].get<double>());

  // The paper's algorithm drifts off (reference: 8 degrees a revolution at this depth).
  const Json& paper = resultOf(report, "sphere", "paper");
  EXPECT_GE(paper["direction_error_degrees"]["max"].get<double>(), 8.0);
}

TEST(Bench, EveryCheapSceneAgreesWithItsTruth) {
  std::vector<std::string> arguments = quickBench({"--renderer", "constraint", "--json"});
  const std::vector<std::string> scenes = {
      "sphere-deep", "sphere-small", "sphere-hollow", "quadric", "box-edge",  "box-room",
      "crease",      "groove",       "container",     "balls-1", "box-corner"};
  for (const std::string& scene : scenes) {
    arguments.emplace_back("--scene");
    arguments.push_back(scene);
  }
  const CommandResult result = runPalpate(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = parseOnly(result);
  EXPECT_EQ(report["results"].size(), scenes.size());
  for (const std::string& scene : scenes) {
    const Json& row = resultOf(report, scene, "constraint");
    EXPECT_GT(row["judged"].get<int>(), 1000) << scene;
    EXPECT_EQ(row["missed"], 0) << scene;
    EXPECT_LE(row["force_error"]["max"].get<double>(), 1e-6) << scene;
  }
}

TEST(Bench, CornersOfThreeCurvedWallsAreAsTheOracleHasThem) {
  const Json report =
      parseOnly(runPalpate(quickBench({"--renderer", "constraint", "--json", "--scene",
                                       "three-balls", "--scene", "three-hollow"})));
  for (const char* scene : {"three-balls", "three-hollow"}) {
    const Json& row = resultOf(report, scene, "constraint");
    // The oracle judges every sixteenth tick, and none of these has two answers.
    EXPECT_NEAR(row["judged"].get<double>(), row["ticks"].get<double>() / 16.0, 1.0) << scene;
    EXPECT_EQ(row["missed"], 0) << scene;
    EXPECT_LE(row["force_error"]["max"].get<double>(), 1e-6) << scene;
    EXPECT_EQ(row["unsettled"]["ticks"], 0) << scene;
  }
}

TEST(Bench, EveryTickAboutATipIsJudged) {
  const Json report = parseOnly(runPalpate(quickBench(
      {"--renderer", "constraint", "--json", "--scene", "cone-tip", "--scene", "cone-wide"})));
  for (const char* scene : {"cone-tip", "cone-wide"}) {
    const Json& row = resultOf(report, scene, "constraint");
    EXPECT_EQ(row["judged"], row["ticks"]) << scene;
    EXPECT_EQ(row["missed"], 0) << scene;
    // The proxy keeps up with the hand: the force is that of the formula, except for the distance
    // that the proxy still has to slide.
    EXPECT_LE(row["magnitude_error"]["max"].get<double>(), 0.01) << scene;
  }
}

TEST(Bench, WhatIsNotJudgedMeasuredOrSaidIsADashAndNoNumber) {
  const Json report =
      parseOnly(runPalpate(quickBench({"--scene", "lump", "--scene", "groove", "--json"})));
  const Json& lump = resultOf(report, "lump", "constraint");
  for (const char* key : {"judged", "missed", "direction_error_degrees", "magnitude_error",
                          "force_error", "paced_tick_ns", "cold_tick_ns"}) {
    ASSERT_TRUE(lump.contains(key)) << key;
    EXPECT_TRUE(lump[key].is_null()) << key << " is " << lump[key];
  }
  EXPECT_GT(lump["ticks"], 1000);
  const Json& unsettled = lump["unsettled"];
  EXPECT_TRUE(unsettled["ticks"].is_number_unsigned() && unsettled["longest_run"].is_number());
  EXPECT_LE(unsettled["longest_run"], unsettled["ticks"]);
  EXPECT_NEAR(unsettled["share"].get<double>() * lump["ticks"].get<double>(),
              unsettled["ticks"].get<double>(), 1e-6);
  // In a scene without composite walls the paper's renderer has forces, but does not report whether
  // it settled.
  EXPECT_TRUE(resultOf(report, "groove", "paper")["unsettled"].is_null());

  const TempFolder folder;
  const CommandResult text = runPalpate(
      quickBench({"--scene", "lump", "--scene", "groove", "--csv", "a.csv", "--svg", "a.svg"}),
      folder.path());
  ASSERT_EQ(text.exit_code, 0) << text.err;
  // scene renderer judged dir max mag max missed step true turn true unsettled run
  const auto errors = textRow(text.out, "judged", "lump", "constraint");
  ASSERT_EQ(errors.size(), 14U);
  for (const std::size_t i : {2U, 3U, 4U, 5U, 6U, 7U, 9U, 11U}) EXPECT_EQ(errors[i], "-") << i;
  EXPECT_NE(errors[12], "-");
  const auto paper = textRow(text.out, "judged", "groove", "paper");
  ASSERT_EQ(paper.size(), 14U);
  EXPECT_EQ(paper[12] + paper[13], "--");
  EXPECT_NE(paper[2], "-");
  // scene renderer ticks median p99 p99.9 max paced p99.9 cold p99.9
  const auto times = textRow(text.out, "hot median", "lump", "constraint");
  ASSERT_EQ(times.size(), 11U);
  for (std::size_t i = 7; i < 11; ++i) EXPECT_EQ(times[i], "-") << i;

  const auto lines = linesOf(textOf(folder.path() + "/a.csv"));
  const auto heading = cellsOf(lines[0]);
  std::vector<std::string> cells;
  for (const std::string& line : lines) {
    if (line.starts_with("lump,constraint,")) cells = cellsOf(line);
  }
  ASSERT_EQ(cells.size(), heading.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_open = heading[i].starts_with("judged") || heading[i].starts_with("missed") ||
                         heading[i].starts_with("direction") ||
                         heading[i].starts_with("magnitude") ||
                         heading[i].starts_with("force_error") || heading[i].starts_with("true") ||
                         heading[i].starts_with("paced") || heading[i].starts_with("cold");
    EXPECT_EQ(cells[i].empty(), is_open) << heading[i] << " = " << cells[i];
  }
  // A row without an error has no mark in the picture of error over time.
  const std::string svg = textOf(folder.path() + "/a.svg");
  EXPECT_NE(svg.find(">2</text>"), std::string::npos);
  EXPECT_EQ(svg.find(">2</text>"), svg.rfind(">2</text>"));  // only in the key
}

TEST(Bench, TicksAtTheirPaceAndColdOnesStandBesideTheHot) {
  const std::vector<std::string> arguments = {
      "bench", "contact", "--scene", "groove", "--repeat",   "1",         "--paced",
      "40",    "--cold",  "3",       "--json", "--renderer", "constraint"};
  const CommandResult result = runPalpate(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json report = parseOnly(result);
  EXPECT_EQ(report["paced_ticks"], 40);
  EXPECT_EQ(report["cold_ticks"], 3);
  const Json& row = resultOf(report, "groove", "constraint");
  // Ten stretches of four ticks; and a cold tick for each third of the path.
  EXPECT_GE(row["paced_tick_ns"]["ticks"], 40);
  EXPECT_LE(row["paced_tick_ns"]["ticks"], 44);
  EXPECT_GE(row["cold_tick_ns"]["ticks"], 3);
  EXPECT_LE(row["cold_tick_ns"]["ticks"], 4);
  for (const char* key : {"paced_tick_ns", "cold_tick_ns"}) {
    EXPECT_GT(row[key]["median"].get<double>(), 0.0) << key;
    EXPECT_LE(row[key]["median"], row[key]["p99.9"]) << key;
  }
}

TEST(Bench, WritesATableAndAPlot) {
  const TempFolder folder;
  const std::vector<std::string> arguments =
      quickBench({"--scene", "groove", "--csv", "a.csv", "--svg", "a.svg"});
  const CommandResult result = runPalpate(arguments, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(filesIn(folder.path()), (std::vector<std::string>{"a.csv", "a.svg"}));
  EXPECT_NE(result.out.find("groove"), std::string::npos);

  const auto lines = linesOf(textOf(folder.path() + "/a.csv"));
  ASSERT_EQ(lines.size(), 3U);  // the heading and two renderers
  const auto heading = cellsOf(lines[0]);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = cellsOf(lines[i]);
    ASSERT_EQ(cells.size(), heading.size());
    std::map<std::string, std::string> row;
    for (std::size_t k = 0; k < cells.size(); ++k) row[heading[k]] = cells[k];
    EXPECT_EQ(row["scene"], "groove");
    EXPECT_EQ(row["renderer"], i == 1 ? "constraint" : "paper");
    EXPECT_GT(std::stod(row["median_ns"]), 0.0);
    if (i == 1) {
      EXPECT_LE(std::stod(row["force_error_max"]), 1e-6);
    }
  }

  const std::string svg = textOf(folder.path() + "/a.svg");
  EXPECT_EQ(svg.find("<svg "), 0U);
  EXPECT_TRUE(isWellFormed(svg));
  for (const char* word : {"groove", "constraint", "paper", "median time of a tick [ns]"}) {
    EXPECT_NE(svg.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);

  // No file is overwritten without --force.
  EXPECT_EQ(runPalpate(arguments, folder.path()).exit_code, 1);
  EXPECT_EQ(textOf(folder.path() + "/a.svg"), svg);
}

TEST(Bench, WrongUseExitsTwo) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"bench"},
                                             {"bench", "speed"},
                                             {"bench", "contact", "--scene", "spheer"},
                                             {"bench", "contact", "--repeat", "0"},
                                             {"bench", "contact", "--paced", "-1"},
                                             {"bench", "contact", "--cold", "few"},
                                             {"bench", "contact", "--renderer", "papyrus"}}) {
    const CommandResult result = runPalpate(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
  }
  EXPECT_NE(
      runPalpate({"bench", "contact", "--scene", "spheer"}).err.find("did you mean 'sphere'?"),
      std::string::npos);
}

TEST(Bench, HelpNamesEveryScene) {
  // An unknown name that resembles none of the scenes lists them all.
  const std::string list = runPalpate({"bench", "contact", "--scene", "qqqqqqqqqq"}).err;
  const std::string help = runPalpate({"bench", "--help"}).out;
  const std::size_t at = list.find("it has ");
  ASSERT_NE(at, std::string::npos) << list;
  for (std::string name : cellsOf(linesOf(list.substr(at + 7)).front())) {
    name.erase(0, name.find_first_not_of(' '));
    EXPECT_NE(help.find(name), std::string::npos) << name;
  }
}

TEST(Bench, ATermSignalLeavesNothing) {
  const TempFolder folder;
  const CommandResult result = runInterrupted(
      {"bench", "contact", "--scene", "sphere", "--repeat", "100000", "--csv", "a.csv"},
      folder.path());
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(filesIn(folder.path()).empty());
}

}  // namespace
}  // namespace palpate::testing
