// Files generated from the declarations of scene files and of the command line are up to date, and
// a key that is added at one place appears in all of them.

#include <cstdio>
#include <filesystem>

#include "command_line/verb_words.h"
#include "folders/folders.h"
#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/register.h"
#include "tools/helpers.h"
#include "vocabulary/documents.h"

namespace palpate::testing {
namespace {

const std::string kRoot = test::sourceFolder();

/// What `command` prints when a shell runs it.
std::string printed(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

std::string output(const std::vector<std::string>& arguments) {
  const CommandResult result = runPalpate(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

TEST(SaidOnce, WhatIsCommittedIsWhatTheCommandPrints) {
  const std::string how = "; run tools/generate.sh";
  EXPECT_EQ(textOf(kRoot + "/data/schema/scene-1.json"), output({"help", "scene", "--schema"}))
      << how;
  EXPECT_EQ(textOf(kRoot + "/tools/docs/palpate.1"), output({"help", "--man"})) << how;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    EXPECT_EQ(textOf(kRoot + "/tools/completion/palpate." + shell),
              output({"help", "--completion", shell}))
        << how;
  }
}

TEST(SaidOnce, TheTablesOfTheDocumentsAreWhatTheCommandPrints) {
  int tables = 0;
  for (const char* page : {"/tools/docs/scene.md", "/lib/README.md"}) {
    const std::string text = textOf(kRoot + page);
    const std::string open = "<!-- keys of ";
    for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
      const std::size_t end = text.find(" -->\n", at);
      const std::string map = text.substr(at + open.size(), end - at - open.size());
      const std::size_t start = end + 5;
      EXPECT_EQ(text.substr(start, text.find("<!-- end -->\n", start) - start),
                output({"help", "scene", map, "--markdown"}))
          << page << ": " << map << "; run tools/generate.sh";
      ++tables;
    }
  }
  EXPECT_GE(tables, 10);
}

TEST(SaidOnce, HelpTellsOfAKeyAndSuggests) {
  const std::string text = output({"help", "scene", "opens_at"});
  EXPECT_NE(text.find("port.opens_at"), std::string::npos) << text;
  EXPECT_NE(text.find("force, 0 or more, or a map"), std::string::npos) << text;
  EXPECT_NE(output({"help", "scene", "port.rate"}).find("speed"), std::string::npos);
  EXPECT_NE(output({"help", "scene"}).find("half_space"), std::string::npos);
  const CommandResult slip = runPalpate({"help", "scene", "opens_a"});
  EXPECT_EQ(slip.exit_code, 2);
  EXPECT_NE(slip.err.find("did you mean 'opens_at'?"), std::string::npos) << slip.err;
}

TEST(SaidOnce, AKeyAddedToACopyIsInReaderSchemaPageHelpAndCompletion) {
  auto copy = std::make_shared<Vocabulary>(*vdb::vocabulary());
  copy->add(
      "sphere:\n  keys:\n    squash: {is: number, from: 0, to: 2, default: 1, unit: halves, help: "
      "how "
      "flat it is, remedy: 1 is round}\n",
      "test.yaml");
  SceneRegistry registry;
  registry.vocabulary = copy;
  const auto read = [&](const std::string& keys) {
    return parseScene("palpate: 1\nlength: mm\nfields: {f: {sphere: {center: [0, 0, 0], radius: 1" +
                          keys + "}}}\n",
                      "test.yaml", registry);
  };
  const auto refused = [&](const std::string& keys) -> Problem {
    try {
      (void)read(keys);
    } catch (const Error& error) {
      return error.problem();
    }
    ADD_FAILURE() << "accepted: " << keys;
    return {};
  };
  EXPECT_EQ(read(", squash: 1.5").fields.size(), 1U);
  const Problem range = refused(", squash: 3");
  EXPECT_EQ(range.message, "'squash' must be from 0 to 2 halves");
  EXPECT_EQ(range.hint, "1 is round");
  EXPECT_EQ(range.line, 3);
  EXPECT_EQ(refused(", squash: 1 mm").code, "scene.number");
  EXPECT_EQ(refused(", squahs: 1").hint, "did you mean 'squash'?");
  // The vocabulary that it was copied from does not know the new key.
  registry.vocabulary = sceneVocabulary();
  EXPECT_EQ(refused(", squash: 1").code, "scene.unknown_key");

  const Json schema = Json::parse(tools::schemaText(*copy));
  const Json& key = schema["definitions"]["sphere"]["properties"]["squash"];
  EXPECT_EQ(key["type"], "number");
  EXPECT_EQ(key["minimum"], 0);
  EXPECT_EQ(key["maximum"], 2);
  EXPECT_NE(tools::keyTable(*copy, "field_kind").find("`squash` (number, from 0 to 2 halves"),
            std::string::npos);
  EXPECT_NE(tools::sceneHelp(*copy, "squash").find("how flat it is"), std::string::npos);
  EXPECT_NE(tools::sceneHelp(*copy, "sphere").find("squash"), std::string::npos);
  const tools::VerbWords help{.name = "help"};
  EXPECT_NE(tools::completion("bash", {help}, tools::sceneWords(*copy)).find(" squash "),
            std::string::npos);
}

TEST(SaidOnce, TheManualPageIsSetWithoutWarnings) {
  EXPECT_EQ(printed("groff -man -Tutf8 -ww -z " + kRoot + "/tools/docs/palpate.1 2>&1"), "");
  const std::string page =
      printed("groff -man -Tascii -P-c -P-b -P-u " + kRoot + "/tools/docs/palpate.1");
  for (const char* part : {"NAME", "palpate touch", "--max-force", "EXIT STATUS"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
}

/// The completions that bash offers for the last of these words, one on each line.
std::vector<std::string> offeredByBash(const std::vector<std::string>& words) {
  std::string line = "COMP_WORDS=(";
  for (const std::string& word : words) line += " '" + word + "'";
  const std::string script = "source " + kRoot + "/tools/completion/palpate.bash && " + line +
                             ") && COMP_CWORD=" + std::to_string(words.size() - 1) +
                             " && _palpate && printf \"%s\\n\" \"${COMPREPLY[@]}\"";
  return linesOf(printed("bash -c \"$(cat <<'EOF'\n" + script + "\nEOF\n)\""));
}

TEST(SaidOnce, BashCompletesVerbsOptionsWordsAndKeys) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(offeredByBash({"palpate", "to"}), Words{"touch"});
  EXPECT_EQ(offeredByBash({"palpate", "c"}), (Words{"convert", "check"}));
  EXPECT_EQ(offeredByBash({"palpate", "touch", "--max"}), Words{"--max-force"});
  EXPECT_EQ(offeredByBash({"palpate", "--json", "touch", "--max"}), Words{"--max-force"});
  EXPECT_EQ(offeredByBash({"palpate", "touch", "s.yaml", "--renderer", ""}),
            (Words{"constraint", "paper"}));
  EXPECT_EQ(offeredByBash({"palpate", "help", "sc"}), Words{"scene"});
  EXPECT_EQ(offeredByBash({"palpate", "help", "scene", "opens"}), Words{"opens_at"});
  // Completion of files is left to bash.
  EXPECT_EQ(offeredByBash({"palpate", "touch", "s"}), Words{""});
}

/// The completions that fish offers for a line.
std::vector<std::string> offeredByFish(const std::string& line) {
  const TempFolder home;
  std::vector<std::string> lines =
      linesOf(printed("HOME=" + home.path() + " fish --no-config -c \"source " + kRoot +
                      "/tools/completion/palpate.fish; complete -C '" + line + "'\""));
  // Without the descriptions
  for (std::string& each : lines) each = each.substr(0, each.find('\t'));
  return lines;
}

/// The completions that zsh offers for a line.
std::vector<std::string> offeredByZsh(const std::string& line) {
  const TempFolder folder;
  std::filesystem::create_symlink(kRoot + "/tools/completion/palpate.zsh", folder.path("_palpate"));
  return linesOf(
      printed("zsh -f " + kRoot + "/tests/tools/offered.zsh " + folder.path() + " '" + line + "'"));
}

TEST(SaidOnce, FishAndZshCompleteVerbsOptionsWordsAndKeys) {
  using Words = std::vector<std::string>;
  for (const auto& offered : {offeredByFish, offeredByZsh}) {
    SCOPED_TRACE(offered == offeredByFish ? "fish" : "zsh");
    EXPECT_EQ(offered("palpate to"), Words{"touch"});
    EXPECT_EQ(offered("palpate c"), (Words{"check", "convert"}));
    EXPECT_EQ(offered("palpate touch --max"), Words{"--max-force"});
    EXPECT_EQ(offered("palpate touch s.yaml --renderer "), (Words{"constraint", "paper"}));
    EXPECT_EQ(offered("palpate help sc"), Words{"scene"});
    EXPECT_EQ(offered("palpate help scene opens"), Words{"opens_at"});
  }
}

}  // namespace
}  // namespace palpate::testing
