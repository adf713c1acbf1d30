// The command line: help, suggestions, exit codes, and the single object that --json promises.

#include "folders/folders.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

const std::vector<std::string> kVerbs = {"touch",   "import", "bake",   "info",  "check", "query",
                                         "explain", "render", "report", "bench", "pack"};

TEST(Usage, HelpListsEveryVerbWithAnExample) {
  const CommandResult result = runPalpate({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const std::string& verb : kVerbs) {
    EXPECT_NE(result.out.find("\n  " + verb + " "), std::string::npos) << verb;
    EXPECT_NE(result.out.find("            palpate " + verb + " "), std::string::npos) << verb;
  }
}

TEST(Usage, EveryVerbHasHelpThatNeedsNoOtherArgument) {
  for (const std::string& verb : kVerbs) {
    const CommandResult result = runPalpate({verb, "--help"});
    EXPECT_EQ(result.exit_code, 0) << verb;
    EXPECT_NE(result.out.find("Usage: palpate " + verb), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("--json"), std::string::npos) << verb;
    EXPECT_EQ(runPalpate({"help", verb}).out, result.out);
  }
}

TEST(Usage, VersionIsOneLine) {
  const CommandResult result = runPalpate({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(linesOf(result.out).size(), 1U);
  EXPECT_EQ(result.out.find("palpate "), 0U);
}

TEST(Usage, SlipsAreUsageErrorsWithASuggestion) {
  const CommandResult verb = runPalpate({"tuoch"});
  EXPECT_EQ(verb.exit_code, 2);
  EXPECT_EQ(verb.out, "");
  EXPECT_NE(verb.err.find("did you mean 'touch'?"), std::string::npos) << verb.err;

  const CommandResult option =
      runPalpate({"render", "scene.yaml", "--plain", "x=1", "-o", "a.png"});
  EXPECT_EQ(option.exit_code, 2);
  EXPECT_NE(option.err.find("did you mean --plane?"), std::string::npos) << option.err;
}

struct Wrong {
  std::vector<std::string> arguments;
  std::string says;  // a part of the message or hint
};

void PrintTo(const Wrong& wrong, std::ostream* out) {
  for (const std::string& argument : wrong.arguments) *out << argument << " ";
}

class WrongUsage : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongUsage, ExitsTwoAndSaysWhy) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  const CommandResult text = runPalpate(GetParam().arguments, folder.path());
  EXPECT_EQ(text.exit_code, 2) << text.out << text.err;
  EXPECT_EQ(text.out, "");
  EXPECT_NE(text.err.find(GetParam().says), std::string::npos) << text.err;

  std::vector<std::string> arguments = GetParam().arguments;
  arguments.emplace_back("--json");
  const CommandResult result = runPalpate(arguments, folder.path());
  EXPECT_EQ(result.exit_code, 2);
  Json json = parseOnly(result);
  EXPECT_EQ(json["schema"], "palpate.error/1");
  EXPECT_TRUE(json["error"]["code"].is_string());
  EXPECT_TRUE(json["error"]["message"].is_string());
  for (const char* key : {"hint", "file", "line", "column"})
    EXPECT_TRUE(json["error"].contains(key));
  EXPECT_EQ(filesIn(folder.path()), std::vector<std::string>{"c.yaml"});
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongUsage,
    ::testing::Values(
        Wrong{{}, "verb"}, Wrong{{"touch"}, "GRID is missing"},
        Wrong{{"touch", "c.yaml"}, "exactly one of --path"},
        Wrong{{"touch", "c.yaml", "--tap", "0,0,0", "--press", "0,0,0"}, "more than one motion"},
        Wrong{{"touch", "c.yaml", "--press", "0,0"}, "not three numbers"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--taps", "2"}, "does not apply to --press"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--normal", "0,0,0"}, "no direction"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--depth", "3 N"}, "--depth"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--speed", "0"}, "greater than 0"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--rate", "-1"}, "--rate"},
        Wrong{{"touch", "c.yaml", "--insert", "0,0,0"}, "two points"},
        Wrong{{"touch", "c.yaml", "--stroke", "0,0,0", "1,0,0", "2,0,0"}, "two points"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--hold", "1e9"}, "20 million ticks"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--renderer", "papyrus"}, "papyrus"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--max-force", "0"},
              "--max-force must be greater than 0"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--max-force", "-3N"}, "greater than 0"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--max-force", "3 mm"}, "N (also mN, kN)"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--max-force", "nan"}, "a number means N"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--max-force", "3", "--max-force", "4"},
              "--max-force"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--slew", "0"}, "--slew must be greater"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--slew", "100N"}, "N/s (also mN/s"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--slew", "fast"}, "a number means N/s"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--ramp", "0"}, "--ramp must be greater"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--ramp", "3Hz"}, "s (also ms, us)"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--trace", "a", "--image", "a"}, ".png"},
        Wrong{{"touch", "c.yaml", "--press", "0,0,0", "--trace", "c.yaml"},
              "would replace the input"},
        Wrong{{"touch", "c.yaml", "d.yaml", "--press", "0,0,0"}, "unexpected argument 'd.yaml'"},
        Wrong{{"touch", "c.yaml", "--insert", "0,0,60", "0,0"}, "'0,0' is not a point"},
        Wrong{{"bake", "c.yaml"}, "-o OUT.vdb is missing"},
        Wrong{{"bake", "c.yaml", "-o", "a.nii"}, "must end in .vdb"},
        Wrong{{"bake", "c.yaml", "-o", "a.vdb", "--voxel", "0"}, "greater than 0"},
        Wrong{{"bake", "c.yaml", "-o", "a.vdb", "--above", "3"}, "--above applies to images"},
        Wrong{{"info"}, "FILE is missing"}, Wrong{{"query", "c.yaml"}, "no points"},
        Wrong{{"query", "c.yaml", "--at", "1,2,x"}, "not three numbers"},
        Wrong{{"render", "c.yaml"}, "-o OUT.png is missing"},
        Wrong{{"render", "c.yaml", "-o", "a.jpg"}, "must end in .png"},
        Wrong{{"render", "c.yaml", "-o", "a.png", "--plane", "w=3"}, "--plane"},
        Wrong{{"render", "c.yaml", "-o", "a.png", "--cut", "1,2,3"}, "--cut"},
        Wrong{{"render", "c.yaml", "-o", "a.png", "--size", "10x10"}, "--size"},
        Wrong{{"--fast", "info", "c.yaml"}, "'--fast' cannot stand before the verb"}));

TEST(Usage, GeneralOptionsMayStandBeforeTheVerb) {
  const TempFolder folder;
  const CommandResult result = runPalpate({"--json", "info", folder.file("c.yaml", kContainer)});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(parseOnly(result)["schema"], "palpate.info/1");
}

TEST(Usage, PointsMayBeNegativeAndNeverSwallowWhatFollows) {
  const TempFolder folder;
  (void)folder.file("c.yaml", kContainer);
  const CommandResult result =
      runPalpate({"query", "--at", "-10,2,3", "-.5,0,0", "c.yaml", "--json"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  Json json = parseOnly(result);
  ASSERT_EQ(json["points"].size(), 2U);
  EXPECT_EQ(json["points"][0]["at"], Json::array({-10.0, 2.0, 3.0}));
  EXPECT_EQ(json["points"][1]["at"], Json::array({-0.5, 0.0, 0.0}));
}

TEST(Usage, TheReferenceInTheReadmeIsWhatTheCommandPrints) {
  const CommandResult result = runPalpate({"help", "--markdown"});
  EXPECT_EQ(result.exit_code, 0);
  const std::string readme = textOf(test::sourceFolder() + "/tools/README.md");
  EXPECT_NE(readme.find(result.out), std::string::npos)
      << "tools/README.md is out of date: put what `palpate help --markdown` prints between the "
         "marks";
}

}  // namespace
}  // namespace palpate::testing
