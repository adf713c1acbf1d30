// The example scenes feel as they did when their traces were stored. Explain a change of numbers
// before storing new ones: PALPATE_REWRITE_TRACES=1 palpate_lib_tests
// --gtest_filter='*StoredTraces*'.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "folders/folders.h"
#include "lib/render/drive.h"
#include "support/stored_trace.h"

namespace palpate::test {
namespace {

const std::string kSource = test::sourceFolder();

/// The scenes that need neither scans nor grids.
const std::vector<std::string>& analyticScenes() {
  static const std::vector<std::string> all = {
      "composite_tube", "container", "crease", "csg",    "csg_part",  "cup",
      "fields",         "flag",      "flank",  "heart",  "lattice",   "lump",
      "metaballs",      "reference", "slab",   "sponge", "valve_tube"};
  return all;
}

/// gtest's own printer puts texts in quotes.
std::string nameOfExample(const ::testing::TestParamInfo<std::string>& example) {
  return example.param;
}

class StoredTraces : public ::testing::TestWithParam<std::string> {};

TEST_P(StoredTraces, AreFeltStill) {
  const ScenePtr scene = sceneNamed(GetParam());
  const std::string folder = kSource + "/tests/lib/render/golden/";
  EXPECT_TRUE(
      compareWithStored(scene, RendererKind::kConstraint, folder + GetParam() + ".constraint.txt"));
  EXPECT_TRUE(compareWithStored(scene, RendererKind::kPaper, folder + GetParam() + ".paper.txt"));
}

INSTANTIATE_TEST_SUITE_P(Examples, StoredTraces, ::testing::ValuesIn(analyticScenes()),
                         nameOfExample);

TEST(StoredTracesOfAll, NoExampleIsForgotten) {
  // The others use images.
  std::set<std::string> known(analyticScenes().begin(), analyticScenes().end());
  for (const char* other : {"contrast", "five_layers", "head", "needle"}) known.insert(other);
  for (const auto& file : std::filesystem::directory_iterator(kSource + "/data/scenes")) {
    if (file.path().extension() != ".yaml") continue;
    EXPECT_TRUE(known.count(file.path().stem().string()) == 1) << file.path();
  }
}

}  // namespace
}  // namespace palpate::test
