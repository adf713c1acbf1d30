#include "palpate/core/error.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(FormatProblem, TellsOnlyWhatIsKnown) {
  EXPECT_EQ(formatProblem({"a.b", "no such layer 'x'"}), "error: no such layer 'x'");
  EXPECT_EQ(formatProblem({"a.b", "it is empty", "", "scene.yaml"}),
            "scene.yaml: error: it is empty");
  EXPECT_EQ(formatProblem({"a.b", "bad", "", "scene.yaml", 3}), "scene.yaml:3: error: bad");
  EXPECT_EQ(formatProblem({"a.b", "bad", "", "scene.yaml", 3, 7}), "scene.yaml:3:7: error: bad");
}

TEST(FormatProblem, PutsTheCaretUnderTheColumnAndTheHintLast) {
  EXPECT_EQ(formatProblem({"a.b", "bad", "mend it", "s.yaml", 2, 4, "k: v"}),
            "s.yaml:2:4: error: bad\n  k: v\n     ^\nhint: mend it");
}

TEST(FormatProblem, RepeatsTabsBeforeTheCaret) {
  EXPECT_EQ(formatProblem({"a.b", "bad", "", "s.yaml", 2, 3, "\tkv"}),
            "s.yaml:2:3: error: bad\n  \tkv\n  \t ^");
}

TEST(FormatProblem, PutsTheCaretBehindAShortLine) {
  EXPECT_EQ(formatProblem({"a.b", "value missing", "", "s.yaml", 2, 4, "k:"}),
            "s.yaml:2:4: error: value missing\n  k:\n     ^");
}

TEST(FormatProblem, LeavesTheCaretOutWithoutAColumn) {
  EXPECT_EQ(formatProblem({"a.b", "bad", "", "s.yaml", 2, 0, "line"}),
            "s.yaml:2: error: bad\n  line");
}

TEST(Error, KeepsKindAndProblemAndReadsAsTheFormattedText) {
  const Error error(ErrorKind::kDevice, {"device.gone", "unplugged", "plug it in"});
  EXPECT_EQ(error.kind(), ErrorKind::kDevice);
  EXPECT_EQ(error.problem().code, "device.gone");
  EXPECT_STREQ(error.what(), "error: unplugged\nhint: plug it in");
}

TEST(Error, InputErrorIsOfKindInput) {
  const Error error = inputError("mesh.empty", "no faces", "give another", "a.stl");
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().file, "a.stl");
  EXPECT_EQ(error.problem().hint, "give another");
}

}  // namespace
}  // namespace palpate
