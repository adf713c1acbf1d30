// RegionLine must find for each point of a line the region that the point has by itself, whichever
// leaves it does not evaluate.

#include "scene/region_line.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "scene/label_share.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

RegionId regionAt(const Partition& partition, const Vec3& p) {
  Signs signs(partition.leaves().size());
  partition.signsAt(p, signs);
  return partition.regionOf(signs);
}

/// Asks for regions along lines in all directions: step by step, by bisection, and at random
/// places. Returns how often the region differed from that of the point before.
int compare(const Partition& partition, const Box3& around, std::uint64_t seed) {
  Random random(seed);
  RegionLine line(partition);
  int changes = 0;
  for (int k = 0; k < 150 && !::testing::Test::HasFailure(); ++k) {
    Vec3 from = random.in(around);
    Vec3 to = random.in(around);
    if (k % 3 == 0) to = from + Vec3(0.0, 0.0, around.size().z);  // along an axis
    line.begin(from, to);
    RegionId last = kOutside;
    const auto ask = [&](double share) {
      const Vec3 p = glm::mix(from, to, share);
      const RegionId region = line.at(p);
      EXPECT_EQ(region, regionAt(partition, p)) << "line " << k << " at " << share;
      changes += region != last ? 1 : 0;
      last = region;
      return region;
    };
    for (int i = 0; i <= 40; ++i) ask(i / 40.0);
    double a = 0.0;
    double b = 1.0;
    const RegionId begin = ask(a);
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (a + b);
      (ask(middle) == begin ? a : b) = middle;
    }
    for (int i = 0; i < 40; ++i) ask(random.uniform(0.0, 1.0));
  }
  return changes;
}

constexpr double kRadius = 0.03;
const Box3 kAround{Vec3(-0.1), Vec3(0.1)};

/// Balls close to each other, so that up to four of them hold a point.
std::vector<LabelField> labels(Random& random, int count) {
  std::vector<LabelField> out;
  for (int i = 0; i < count; ++i) {
    out.push_back({sphere(random.in({Vec3(-0.05), Vec3(0.05)}), kRadius), {i + 1}});
  }
  return out;
}

TEST(RegionLine, SaysOfLabelsWhatTheirPointsSay) {
  for (const int count : {2, 6, 20}) {
    SCOPED_TRACE(count);
    Random random(static_cast<std::uint64_t>(count));
    const SharedLabels shared = shareLabels(labels(random, count));
    EXPECT_GT(compare(Partition(shared.fields, {}, shared.walls), kAround, 7), 500);
  }
}

TEST(RegionLine, SaysOfNestedShapesWhatTheirPointsSay) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.06);
  const FieldPtr half = halfSpace(Vec3(0.0, 0.0, 0.01), Vec3(0.0, 0.3, 1.0));
  const FieldPtr hole = sphere(Vec3(0.02, 0.0, 0.0), 0.02);
  const FieldPtr block = palpate::box(Vec3(0.04, 0.03, 0.025), Vec3(0.1, 0.02, 0.05));
  const std::vector<FieldPtr> layers{complement(ball),
                                     subtract({ball, hole}),
                                     intersect({block, half}),
                                     unite({hole, complement(half)}),
                                     nullptr,
                                     intersect({ball, block, complement(hole)})};
  EXPECT_GT(compare(Partition(layers), kAround, 11), 500);
}

/// More than eight layers are looked up in another way.
TEST(RegionLine, SaysOfManyLayersWhatTheirPointsSay) {
  Random random(5);
  std::vector<FieldPtr> layers{complement(sphere(Vec3(0.0), 0.09))};
  for (int i = 0; i < 20; ++i) layers.push_back(sphere(random.in(kAround), kRadius));
  EXPECT_GT(compare(Partition(layers), kAround, 13), 500);
}

/// Counts how often its value is asked for, and notes whether that was outside its bounds.
class Counted final : public Field {
 public:
  explicit Counted(FieldPtr of) : of_(std::move(of)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override { return of_->sample(p); }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    ++count;
    was_asked_far = was_asked_far || !bounds().grownBy(1e-6).contains(p);
    return of_->value(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return of_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return of_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return of_->lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return of_->featureSize(); }

  mutable int count = 0;
  mutable bool was_asked_far = false;

 private:
  FieldPtr of_;
};

TEST(RegionLine, AsksALeafOnlyWithinItsBoundsAndAWallOnlyBetweenTwoInsides) {
  const auto left = std::make_shared<Counted>(sphere(Vec3(-0.02, 0.0, 0.0), kRadius));
  const auto right = std::make_shared<Counted>(sphere(Vec3(0.02, 0.0, 0.0), kRadius));
  const SharedLabels shared = shareLabels({{left, {1}}, {right, {2}}});
  const Partition partition(shared.fields, {}, shared.walls);
  RegionLine line(partition);
  const Vec3 from(-0.1, 0.001, 0.0);
  const Vec3 to(0.1, 0.001, 0.0);
  line.begin(from, to);
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) static_cast<void>(line.at(glm::mix(from, to, i / 400.0)));
  EXPECT_FALSE(left->was_asked_far);
  EXPECT_FALSE(right->was_asked_far);
  // Each ball is asked for its own leaf along less than a third of the line, and again for the wall
  // between both where they overlap, along a tenth of it.
  EXPECT_GT(left->count, 0);
  EXPECT_LT(left->count, kSteps / 3 + kSteps / 10);
  EXPECT_LT(right->count, kSteps / 3 + kSteps / 10);
}

}  // namespace
}  // namespace palpate::test
