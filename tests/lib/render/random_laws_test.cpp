// Random scenes of a few parts, some of them flush with others, each with its own stiffness. Where
// only one wall is pressed, the force is its law at the proxy, computed here from the regions'
// fields; a scene that is turned, mirrored, scaled and moved feels the same; and closed paths give
// no energy.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "lib/render/energy_loop.h"

namespace palpate::test {
namespace {

/// The numbers of the scenes to run: PALPATE_PARTS_FIRST=100 PALPATE_PARTS_SCENES=1 select them;
/// otherwise the first `usual` ones.
struct Numbers {
  std::uint64_t first = 0;
  std::uint64_t count;

  explicit Numbers(std::uint64_t usual) : count(usual) {
    const auto ask = [](const char* name, std::uint64_t& value) {
      if (const char* text = std::getenv(name)) value = std::strtoull(text, nullptr, 10);
    };
    ask("PALPATE_PARTS_FIRST", first);
    ask("PALPATE_PARTS_SCENES", count);
  }
};

/// The pose of the scene in space: turned by quarters, mirrored, scaled, moved.
struct Pose {
  Mat3 turn{1.0};  // a signed permutation
  double scale = 1.0;
  Vec3 move{0.0, 0.0, 0.0};  // [m]

  [[nodiscard]] Vec3 point(const Vec3& p) const { return scale * (turn * p) + move; }
};

/// A scene made from its number; the same number gives the same scene, in any pose.
class Parts {
 public:
  explicit Parts(std::uint64_t number, const Pose& pose = {}) : random_(number), pose_(pose) {
    std::string materials, layers;
    const int count = 2 + pick(3);
    for (int i = 0; i < count; ++i) {
      const std::string n = std::to_string(i);
      materials += "  m" + n + ": {stiffness: " + numberText(random_.uniform(300.0, 3000.0)) +
                   " N/m" + (pick(3) == 0 ? ", damping: 0.5 N.s/m" : "") + "}\n";
      is_damped_ = is_damped_ || materials.ends_with("N.s/m}\n");
      layers += "  - {name: l" + n + ", inside: " + shape(i) + ", wall: m" + n + "}\n";
    }
    text_ = "palpate: 1\nlength: m\nmaterials:\n" + materials + "layers:\n" + layers;
    scene_ = sceneOf(text_);
  }
  [[nodiscard]] const ScenePtr& scene() const { return scene_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] bool isDamped() const { return is_damped_; }

 private:
  int pick(int n) { return static_cast<int>(random_.uniform(0.0, n)); }
  static std::string numberText(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }
  static std::string list(const Vec3& v) {
    return "[" + numberText(v.x) + ", " + numberText(v.y) + ", " + numberText(v.z) + "]";
  }
  [[nodiscard]] std::string length(double value) const { return numberText(pose_.scale * value); }
  [[nodiscard]] std::string point(const Vec3& p) const { return list(pose_.point(p)); }
  [[nodiscard]] std::string direction(const Vec3& v) const { return list(pose_.turn * v); }
  [[nodiscard]] std::string size(const Vec3& v) const {
    return list(pose_.scale * glm::abs(pose_.turn * v));
  }
  [[nodiscard]] std::string halfSpaceText(const Vec3& at, const Vec3& normal) const {
    return "{half_space: {point: " + point(at) + ", normal: " + direction(normal) + "}}";
  }

  /// A body, or a part of the previous body that is flush with its surface.
  std::string shape(int level) {
    const bool is_part = level > 0 && pick(2) == 0;
    const Vec3 normal = random_.direction();
    const Vec3 at = middle_ + random_.uniform(0.0, 3e-3) * random_.direction();
    if (is_part) return "{intersection: [" + body_ + ", " + halfSpaceText(at, normal) + "]}";
    middle_ = random_.uniform(0.0, 6e-3) * random_.direction();
    const double r = random_.uniform(6e-3, 12e-3);
    const Vec3 sides(random_.uniform(r, 2 * r), random_.uniform(r, 2 * r),
                     random_.uniform(r, 2 * r));
    const Vec3 axis = random_.direction();
    const double height = random_.uniform(r, 2 * r);
    switch (pick(3)) {
      case 0:
        body_ = "{box: {center: " + point(middle_) + ", size: " + size(sides) + "}}";
        break;
      case 1:
        body_ = "{cylinder: {center: " + point(middle_) + ", axis: " + direction(axis) +
                ", radius: " + length(r) + ", height: " + length(height) + "}}";
        break;
      default:
        body_ = "{sphere: {center: " + point(middle_) + ", radius: " + length(r) + "}}";
    }
    return body_;
  }

  Random random_;
  Pose pose_;
  std::string text_;
  std::string body_;
  Vec3 middle_{0.0, 0.0, 0.0};
  bool is_damped_ = false;
  ScenePtr scene_;
};

/// A hand that wanders around the parts, mostly pressing on them by a millimeter or two.
std::vector<Vec3> wander(std::uint64_t seed, int ticks) {
  Random random(seed * 31 + 5);
  std::vector<Vec3> out;
  Vec3 at(0.0, 0.0, 0.03);
  Vec3 way(0.0);
  Vec3 goal(0.0);
  for (int i = 0; i < ticks; ++i) {
    if (i % 700 == 0) goal = random.uniform(0.004, 0.014) * random.direction();
    way += 2e-5 * (goal - at) - 0.03 * way + 2e-7 * random.direction();
    const double length = glm::length(way);
    if (length > 5e-5) way *= 5e-5 / length;
    out.push_back(at += way);
  }
  return out;
}

TEST(RandomParts, EachWallAlonePushesByItsOwnLaw) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const Numbers scenes(slow ? 500 : 60);
  long judged = 0;
  long several = 0;
  for (std::uint64_t number = scenes.first; number < scenes.first + scenes.count; ++number) {
    const Parts parts(number);
    SCOPED_TRACE(parts.text());
    const Scene& scene = *parts.scene();
    const auto renderer = makeRenderer(parts.scene());
    double stiffest = 0.0;
    for (const Material& each : scene.materials()) {
      stiffest = std::max(stiffest, each.stiffness.range().most);
    }
    for (const Vec3& p : wander(number, 4000)) {
      const TickResult r = renderer->update({p, Vec3(0.0), 1e-3});
      const Vec3 press = r.proxy - p;
      const double depth = glm::length(press);
      // For any walls: along the press at most the stiffness of the stop, 1.05 times the stiffest.
      // Across the press at most 3/8 of a difference in stiffness across a seam, times R / (R -
      // depth) where the wall bulges: the proxy moves farther than the hand by that factor. R is at
      // least 6 mm.
      if (depth < 2e-3) {
        ASSERT_LE(glm::length(r.force), 1.2 * stiffest * depth + 1e-9);
      }
      if (!r.contact || depth < 1e-6 || !r.settled) continue;
      int near = 0;
      RegionId wall = kOutside;
      for (RegionId region = 1; region < scene.regions().size(); ++region) {
        // Walls farther away than the depth do not take part in the press.
        if (std::fabs(scene.regions()[region].field->value(r.proxy)) > depth) continue;
        ++near;
        wall = region;
      }
      if (near != 1) {
        ++several;
        continue;
      }
      ++judged;
      const int own = scene.regions()[wall].wall;
      const double stiffness = scene.materials()[static_cast<std::size_t>(own)].stiffness.at(p);
      ASSERT_TRUE(isNear(r.force, stiffness * press, 1e-6 * stiffness * depth + 1e-9));
    }
  }
  std::printf("  %ld ticks at one wall alone, %ld at several\n", judged, several);
  EXPECT_GT(judged, static_cast<long>(scenes.count) * 200);
  EXPECT_GT(several, static_cast<long>(scenes.count) * 200);
}

void expectTheSameAtEveryPose(const Numbers& scenes) {
  Pose turned;
  turned.turn = Mat3(Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));
  Pose mirrored;
  mirrored.turn = Mat3(Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1));
  Pose scaled;
  scaled.scale = 7.3;
  Pose small;
  small.scale = 1e-4;
  Pose moved;
  moved.move = mm(31, -12, 57);
  const std::pair<const char*, Pose> poses[] = {{"turned", turned},
                                                {"mirrored", mirrored},
                                                {"scaled", scaled},
                                                {"small", small},
                                                {"moved", moved}};
  for (const auto& [name, pose] : poses) {
    long ticks = 0;
    long off = 0;
    double worst = 0.0;
    for (std::uint64_t number = scenes.first; number < scenes.first + scenes.count; ++number) {
      const Parts plain(number);
      const Parts posed(number, pose);
      const auto one = makeRenderer(plain.scene());
      const auto other = makeRenderer(posed.scene());
      Vec3 last(0.0);
      bool is_first = true;
      for (const Vec3& p : wander(number, 4000)) {
        const Vec3 velocity = is_first ? Vec3(0.0) : (p - last) / 1e-3;
        is_first = false;
        last = p;
        const TickResult a = one->update({p, velocity, 1e-3});
        const TickResult b =
            other->update({pose.point(p), pose.scale * (pose.turn * velocity), 1e-3});
        if (!a.contact && !b.contact) continue;
        ++ticks;
        const double size = 1e-6 + glm::length(a.force);
        const double error =
            glm::length(b.force - pose.scale * (pose.turn * a.force)) / (pose.scale * size);
        // The proxy rests within 1e-9 of the feature size of its correct place: 1e-11 m, which is
        // 1e-7 of a press of 0.1 mm.
        if (error > 1e-7 && off++ == 0)
          std::printf("  %s: first off in scene %d\n", name, static_cast<int>(number));
        worst = std::max(worst, error);
      }
    }
    std::printf("  %-9s %ld ticks in contact, %ld off, at most by %.2g\n", name, ticks, off, worst);
    EXPECT_EQ(off, 0) << name;
    EXPECT_GT(ticks, static_cast<long>(scenes.count) * 400);
  }
}

TEST(RandomParts, TurnedMirroredScaledAndMovedTheyFeelTheSame) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  expectTheSameAtEveryPose(Numbers(slow ? 300 : 15));
}

// Two faces of the box lead on equally well when the hand breaks through, 12 mm deep. The order of
// the faces used to decide; it differs in the turned scene, and there the proxy ended 10 mm away.
TEST(RandomParts, TheOrderOfABoxsFacesChoosesNoWay) {
  Numbers scene(1);
  scene.first = 94;
  scene.count = 1;
  expectTheSameAtEveryPose(scene);
}

TEST(RandomParts, GiveNoEnergy) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const Numbers scenes(slow ? 400 : 8);
  double most = -kInfinity;
  for (std::uint64_t number = scenes.first; number < scenes.first + scenes.count; ++number) {
    const Parts parts(number);
    Random random(number + 77);
    // The loop goes around a place on the surface of the last part.
    const Field& field = *parts.scene()->regions().back().field;
    Vec3 at = 8e-3 * random.direction();
    for (int i = 0; i < 60; ++i) {
      const FieldSample s = field.sample(at);
      at -= 0.7 * s.value * unitOr(s.gradient, Vec3(0, 0, 1));
    }
    if (std::fabs(field.value(at)) > 1e-4) continue;
    const EnergyLoop loop = randomLoop(random, at, 0.05e-3, 0.6e-3);
    const EnergyGiven given = energyGiven(parts.scene(), mm(0, 0, 40), loop, 32'000);
    most = std::max(most, given.work - given.change);
    EXPECT_LE(given.work, 1e-9 + given.change) << number << "\n" << parts.text();
  }
  std::printf("  at most %.3g J\n", most);
}

}  // namespace
}  // namespace palpate::test
