// The reader of a map receives the parameter that it is for, the unit, and whether negative values
// have a meaning.

#include <gtest/gtest.h>

#include <map>

#include "palpate/scene/scene_file.h"
#include "support/test_maps.h"

namespace palpate {
namespace {

TEST(MapKinds, AReaderIsToldWhatItsMapIsOf) {
  std::map<std::string, ParameterKind> asked;
  SceneRegistry registry;
  registry.maps["field"] = [&](MapReader& reader, const ParameterKind& kind) {
    asked[reader.requireText("field")] = kind;
    return testing::flatMap(0.1);
  };
  (void)parseScene(
      "palpate: 1\n"
      "length: mm\n"
      "materials:\n"
      "  wall: {stiffness: {field: K}, damping: {field: D}, friction: {static: {field: mu}}}\n"
      "  flow: {viscosity: {field: B}, flow: [{field: vx}, 0 m/s, {field: vz}]}\n",
      "test.yaml", registry);
  const auto expect_kind = [&](const std::string& name, const std::string& key,
                               std::optional<Dimension> dimension, bool is_signed) {
    ASSERT_EQ(asked.count(name), 1U) << name;
    EXPECT_EQ(asked[name].key, key);
    EXPECT_EQ(asked[name].dimension, dimension) << name;
    EXPECT_EQ(asked[name].is_signed, is_signed) << name;
  };
  expect_kind("K", "stiffness", Dimension::kStiffness, false);
  expect_kind("D", "damping", Dimension::kDamping, false);
  expect_kind("mu", "static", std::nullopt, false);
  expect_kind("B", "viscosity", Dimension::kDamping, false);
  // A medium may flow in both directions.
  expect_kind("vx", "flow", Dimension::kVelocity, true);
  expect_kind("vz", "flow", Dimension::kVelocity, true);
}

}  // namespace
}  // namespace palpate
