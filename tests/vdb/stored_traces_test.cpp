// The example scenes of scans feel as they did when their traces were stored; scenes of fields
// alone are tested with the library. PALPATE_REWRITE_TRACES=1 palpate_vdb_tests
// --gtest_filter='*StoredTracesOfScans*' stores them anew.

#include <gtest/gtest.h>

#include "folders/folders.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/register.h"
#include "support/stored_trace.h"

namespace palpate::test {
namespace {

class StoredTracesOfScans : public ::testing::TestWithParam<const char*> {};

TEST_P(StoredTracesOfScans, AreFeltStill) {
  const std::string name = GetParam();
  SceneRegistry registry;
  vdb::registerKinds(registry, {});
  const ScenePtr scene = compile(
      readScene(palpate::test::sourceFolder() + "/data/scenes/" + name + ".yaml", registry));
  const std::string golden = palpate::test::sourceFolder() + "/tests/vdb/golden/" + name;
  EXPECT_TRUE(compareWithStored(scene, RendererKind::kConstraint, golden + ".constraint.txt"));
  EXPECT_TRUE(compareWithStored(scene, RendererKind::kPaper, golden + ".paper.txt"));
}

INSTANTIATE_TEST_SUITE_P(Examples, StoredTracesOfScans,
                         ::testing::Values("head", "needle", "five_layers"),
                         [](const auto& one) { return std::string(one.param); });

}  // namespace
}  // namespace palpate::test
