// Where and why the paper's renderer and the constraint renderer differ on the container: a list
// kept up to date by tests, not hidden.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// The kind of force in each tick: the region (o, l), followed by 0 for none, + away from the
/// ball's center, - towards it, ~ for anything else (drag). Repeated entries are written once.
std::string classesOf(RendererKind kind, const std::vector<Vec3>& path, const std::string& scene) {
  Drive drive(sceneOf(scene), kind);
  std::string all;
  std::string last;
  const auto note = [&](const TickResult& out) {
    std::string now = drive.region().substr(0, 1);
    const double radial = glm::dot(out.force, out.proxy);
    const bool is_radial = out.contact;
    now += glm::length(out.force) < 1e-6 ? "0" : !is_radial ? "~" : radial > 0.0 ? "+" : "-";
    if (now != last) all += (all.empty() ? "" : " ") + now;
    last = now;
  };
  note(drive.to(path.front()));
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int n = static_cast<int>(std::ceil(glm::length(path[i] - path[i - 1]) / 0.25e-3));
    for (int k = 1; k <= n; ++k) note(drive.to(glm::mix(path[i - 1], path[i], double(k) / n)));
  }
  return all;
}

struct Row {
  const char* name;
  std::vector<Vec3> path;
  std::string paper;
  std::string constraint;
  const char* why;
};

std::vector<Row> rows() {
  return {
      {"press from outside",
       {mm(50, 0, 0), mm(39, 0, 0), mm(50, 0, 0)},
       "o0 o+ o0",
       "o0 o+ o0",
       "alike"},
      {"dip in and out by the mouth",
       {mm(0, 0, 30), mm(0, 0, 0), mm(0, 0, 30)},
       "o0 l0 l~ o0",
       "o0 l0 l~ o0",
       "alike here: the drag of the constraint renderer fades in behind the mouth, and the paper "
       "feels nothing in the tick that enters"},
      {"wall from within, and out again",
       {mm(0, 0, 30), mm(0, 0, -42), mm(0, 0, 30)},
       "o0 l0 l~ l- l+ l~ o0",
       "o0 l0 l~ l- l+ l~ l0 o0",
       "on the way back the drag of the syrup is more than the wall's last push; that of the "
       "constraint renderer fades out before the mouth"},
      {"through the glass at the side, up inside, down again by the mouth",
       {mm(50, 0, 0), mm(30, 0, 0), mm(30, 0, 20), mm(30, 0, 0)},
       "o0 o+ o0 l0 l~",
       "o0 o+ l~ o0 l0 l~",
       "the HIP leaves the glass through the mouth; the proxy slides over the rim before it, and "
       "drops in"},
      {"out through the wall from within, over the brim's plane, and down outside (the leak 1-3-4)",
       {mm(0, 0, 30), mm(0, 0, 0), mm(45, 0, 0), mm(45, 0, 25), mm(60, 0, 25), mm(60, 0, 0)},
       "o0 l0 l~ l- l0 l-",
       "o0 l0 l~ l- o0",
       "the paper keeps ENTER_PORT in row 4 and then pulls from outside; the proxy went over the "
       "rim"},
      {"one tick from above the ball into the syrup",
       {mm(0, 0, 50), mm(0, 0, 49.9)},
       "o0",
       "o0",
       "alike (the jump itself is below)"},
  };
}

TEST(Differences, TickClassesOnTheContainer) {
  for (const Row& row : rows()) {
    EXPECT_EQ(classesOf(RendererKind::kPaper, row.path, containerText()), row.paper)
        << row.name << ", paper: " << row.why;
    EXPECT_EQ(classesOf(RendererKind::kConstraint, row.path, containerText()), row.constraint)
        << row.name << ", constraint: " << row.why;
  }
}

TEST(Differences, AJumpOverRow2MissesThePaperPort) {
  // The hand jumps from (out, out) to (in, in) in one tick: Table I does not see its row 2; the
  // constraint renderer's proxy goes through the mouth.
  Drive paper(sceneOf(containerText()), RendererKind::kPaper);
  Drive constraint(sceneOf(containerText()));
  for (Drive* drive : {&paper, &constraint}) {
    (void)drive->to(mm(0, 0, 45));
    (void)drive->to(mm(0, 0, 10));
  }
  EXPECT_EQ(paper.events(), "");
  EXPECT_EQ(paper.region(), "outside");
  EXPECT_EQ(constraint.events(), "mouth");
  EXPECT_EQ(constraint.region(), "liquid");
}

TEST(Differences, TheContactPointOfThePaperDriftsAndTheProxyDoesNot) {
  Drive paper(sceneOf(containerText()), RendererKind::kPaper);
  Drive constraint(sceneOf(containerText()));
  for (Drive* drive : {&paper, &constraint}) (void)drive->walk(mm(39.2, 0, 0));
  // A turn around the equator at a depth of 0.8 mm: d/R = 0.02, so the paper's method lags by some
  // 8 degrees.
  for (double angle = 0.0; angle < 6.283; angle += 0.005) {
    for (Drive* drive : {&paper, &constraint}) {
      (void)drive->to(0.0392 * Vec3(std::cos(angle), std::sin(angle), 0));
    }
  }
  const auto degrees = [](const Drive& drive) {
    const Vec3 f = glm::normalize(drive.last().force);
    const Vec3 u = glm::normalize(drive.hip());
    return std::asin(glm::length(glm::cross(f, u))) * 57.29577951308232;
  };
  EXPECT_GT(degrees(paper), 4.0);
  EXPECT_LT(degrees(paper), 12.0);
  EXPECT_LT(degrees(constraint), 1e-6);
}

TEST(Differences, ThePaperPullsWithFullDampingAndTheConstraintNeverPulls) {
  std::string text = containerText();
  text.replace(text.find("1500 N/m}"), 9, "1500 N/m, damping: 10 N.s/m}");
  Drive paper(sceneOf(text), RendererKind::kPaper);
  Drive constraint(sceneOf(text));
  for (Drive* drive : {&paper, &constraint}) {
    (void)drive->walk(mm(39.5, 0, 0));
    (void)drive->to(
        mm(39.7, 0, 0));  // outward at 0.2 m/s: -2 N of damping against 0.45 N of spring
  }
  EXPECT_NEAR(paper.last().force.x, 1500 * 0.3e-3 - 10 * 0.2, 5e-3);
  EXPECT_EQ(constraint.last().force.x, 0.0);
  EXPECT_TRUE(constraint.last().contact);
}

// The paper's text has wall and syrup together, its table the wall alone: the scene may choose.
TEST(Differences, InTheWallFromWithinBothFeelTheSyrup) {
  Drive paper(sceneOf(containerText()), RendererKind::kPaper);
  Drive constraint(sceneOf(containerText()));
  for (Drive* drive : {&paper, &constraint}) {
    (void)drive->walk(mm(0, 0, 30));
    (void)drive->walk(mm(0, 0, -41));
    (void)drive->to(mm(0.1, 0, -41));  // along the wall at 0.1 m/s
  }
  EXPECT_NEAR(paper.last().force.x, -4 * 0.1, 1e-2);
  EXPECT_NEAR(constraint.last().force.x, -4 * 0.1, 1e-2);
}

TEST(Differences, OpeningForcesAreRefusedByThePaper) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
layers: [{name: skin, inside: {sphere: {center: [0, 0, 0], radius: 30}}}]
ports: [{name: cut, between: [outside, skin], opens_at: 1 N}]
)");
  EXPECT_THROW(Drive(scene, RendererKind::kPaper), Error);
}

}  // namespace
}  // namespace palpate::test
