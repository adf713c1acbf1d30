#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "palpate/scene/scene_file.h"
#include "scene/messages.h"

namespace palpate {
namespace {

const std::vector<std::string_view> kKeys = {"stiffness", "damping", "friction", "viscosity",
                                             "flow"};

TEST(Suggest, OneSlipOfAnyKindIsFound) {
  for (const std::string_view key : kKeys) {
    const std::string word(key);
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::string dropped = word;
      dropped.erase(i, 1);
      EXPECT_EQ(suggest(dropped, kKeys), word) << dropped;
      std::string doubled = word;
      doubled.insert(i, 1, word[i]);
      EXPECT_EQ(suggest(doubled, kKeys), word) << doubled;
      std::string replaced = word;
      replaced[i] = 'q';
      EXPECT_EQ(suggest(replaced, kKeys), word) << replaced;
      if (i + 1 < word.size()) {
        std::string swapped = word;
        std::swap(swapped[i], swapped[i + 1]);
        EXPECT_EQ(suggest(swapped, kKeys), word) << swapped;
      }
    }
  }
}

TEST(Messages, ListThirtyTwoNamesAndHowManyThereAre) {
  const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int i = 1; i <= 33; ++i) all.push_back("n" + std::to_string(i));
    return all;
  }();
  const std::vector<std::string_view> few(names.begin(), names.begin() + 32);
  const std::vector<std::string_view> many(names.begin(), names.end());
  EXPECT_TRUE(listed(few).ends_with("n31, n32"));
  EXPECT_EQ(listed(many), listed(few) + ", ... (33 in all)");
}

TEST(Suggest, CaseAndSeparatorsAreSlipsToo) {
  const std::vector<std::string_view> kinds = {"half_space", "sphere", "box"};
  EXPECT_EQ(suggest("Sphere", kinds), "sphere");
  EXPECT_EQ(suggest("HALF-SPACE", kinds), "half_space");
  EXPECT_EQ(suggest("halfspace", kinds), "half_space");
  EXPECT_EQ(suggest("bx", kinds), "box");
}

TEST(Suggest, ASwapCountsOnce) {
  // Two swaps in six letters: within a third of the length only if each swap counts once.
  const std::vector<std::string_view> names = {"abcdef"};
  EXPECT_EQ(suggest("bacdfe", names), "abcdef");
}

TEST(Suggest, TheNearestWinsAndNothingFarIsOffered) {
  const std::vector<std::string_view> names = {"static", "statics", "kinetic"};
  EXPECT_EQ(suggest("staticss", names), "statics");
  EXPECT_EQ(suggest("viscosity", names), "");
  EXPECT_EQ(suggest("", names), "");
  EXPECT_EQ(suggest("x", std::vector<std::string_view>{"y"}), "");
  EXPECT_EQ(suggest("static", std::vector<std::string_view>{}), "");
  EXPECT_EQ(suggest(std::string(100000, 'a'), names), "");
}

// The definition itself, without optimization.
bool matchesByDefinition(std::string_view glob, std::string_view name) {
  if (glob.empty()) return name.empty();
  if (glob[0] == '*') {
    return matchesByDefinition(glob.substr(1), name) ||
           (!name.empty() && matchesByDefinition(glob, name.substr(1)));
  }
  return !name.empty() && (glob[0] == '?' || glob[0] == name[0]) &&
         matchesByDefinition(glob.substr(1), name.substr(1));
}

// Every text of `letters` that is at most `longest` long.
std::vector<std::string> allTexts(std::string_view letters, std::size_t longest) {
  std::vector<std::string> texts{""};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].size() == longest) continue;
    for (const char c : letters) texts.push_back(texts[i] + c);
  }
  return texts;
}

TEST(Glob, EveryShortPatternAgreesWithTheDefinition) {
  const std::vector<std::string> names = allTexts("ab", 5);
  for (const std::string& glob : allTexts("ab*?", 4)) {
    for (const std::string& name : names) {
      ASSERT_EQ(matchesGlob(glob, name), matchesByDefinition(glob, name)) << glob << " " << name;
    }
  }
}

TEST(Glob, EverythingElseIsLiteral) {
  EXPECT_TRUE(matchesGlob("Thalamus_[LR]", "Thalamus_[LR]"));
  EXPECT_FALSE(matchesGlob("Thalamus_[LR]", "Thalamus_L"));
  EXPECT_FALSE(matchesGlob("skull", "Skull"));
  EXPECT_TRUE(matchesGlob("a.b\\", "a.b\\"));
}

TEST(Glob, AQuestionMarkIsOneCharacterNotOneByte) {
  EXPECT_TRUE(matchesGlob("n?ud", "n\xC5\x93ud"));
  EXPECT_FALSE(matchesGlob("n??ud", "n\xC5\x93ud"));
  EXPECT_TRUE(matchesGlob("*?d", "\xC5\x93ud"));
}

TEST(Glob, ManyStarsTakeNoTime) {
  std::string glob;
  for (int i = 0; i < 30; ++i) glob += "*a";
  EXPECT_FALSE(matchesGlob(glob + "b", std::string(2000, 'a')));
}

}  // namespace
}  // namespace palpate
