#include "palpate/core/progress.h"

#include <gtest/gtest.h>

#include <string>

namespace palpate {
namespace {

TEST(Progress, AnEmptyFunctionNeitherReportsNorStops) {
  EXPECT_NO_THROW(report({}, "baking", 0.5));
}

TEST(Progress, HandsOnWhatIsDone) {
  std::string what;
  double fraction = 0.0;
  const Progress progress = [&](std::string_view w, double f) {
    what = w;
    fraction = f;
    return true;
  };
  report(progress, "baking skin", 0.25);
  EXPECT_EQ(what, "baking skin");
  EXPECT_EQ(fraction, 0.25);
}

TEST(Progress, RefusalThrowsCancelled) {
  const Progress progress = [](std::string_view, double) { return false; };
  try {
    report(progress, "baking", -1.0);
    FAIL() << "was not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  }
}

}  // namespace
}  // namespace palpate
