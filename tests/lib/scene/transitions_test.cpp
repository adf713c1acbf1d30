// The table of transitions, as data.

#include "palpate/scene/transitions.h"

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

std::string told(const Scene& scene) {
  std::string text;
  for (const Transition& t : transitions(scene)) {
    text += scene.regions()[t.from].name + ">" + scene.regions()[t.to].name + " " +
            (t.port ? scene.ports()[*t.port].name : "-") + "\n";
  }
  return text;
}

TEST(Transitions, OfTheShippedScenes) {
  EXPECT_EQ(told(*sceneNamed("container")), "outside>liquid mouth\nliquid>outside mouth\n");
  EXPECT_EQ(told(*sceneNamed("valve_tube")),
            "outside>upstream inlet\nupstream>downstream valve\ndownstream>outside outlet\n");
  EXPECT_EQ(
      told(*sceneNamed("composite_tube")),
      "outside>first port 1\noutside>third port 4\nfirst>outside port 1\nfirst>second port 2\n"
      "second>first port 2\nsecond>third port 3\nthird>outside port 4\nthird>second port 3\n");
  EXPECT_EQ(told(*sceneNamed("cup")), "outside>liquid -\nliquid>outside -\n");
  EXPECT_EQ(told(*sceneNamed("csg")), "");
}

TEST(Transitions, EachWayHasItsOwnForce) {
  const ScenePtr scene = sceneOf(
      "palpate: 1\nlength: mm\nlayers: [{name: a, inside: {sphere: {center: [0, 0, 0], radius: "
      "9}}}]\n"
      "ports: [{name: p, between: [a, outside], opens_at: 2 N, back: 1 N}]\n");
  const std::vector<Transition> rows = transitions(*scene);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].from, kOutside);
  EXPECT_EQ(rows[0].force.at(Vec3(0.0)), 1.0) << "from outside is the way back";
  EXPECT_EQ(rows[1].force.at(Vec3(0.0)), 2.0);
}

}  // namespace
}  // namespace palpate::test
